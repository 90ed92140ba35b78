//! Real boundaries with known verdicts, when they lie beside the checkout: see `../shared/data`.

use serde_json::Value;
use std::collections::BTreeMap;
use std::path::PathBuf;
use trigrade::domain::validate::{Fault, Plc, validate};
use trigrade::domain::{Domain, Place};
use trigrade::format::domain_file::{DomainForm, ReadOptions, read_domain};

struct Case {
    name: String,
    class: String,
    verdict: String,
    files: Vec<String>,
}

fn folder() -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/data/polygons"))
}

/// The cases of the manifest; none when the data is not there.
fn cases() -> Vec<Case> {
    let Ok(text) = std::fs::read_to_string(folder().join("MANIFEST.json")) else {
        return Vec::new();
    };
    let manifest: Value = serde_json::from_str(&text).expect("the manifest is JSON");
    let string = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let case = |case: &Value| Case {
        name: string(&case["name"]),
        class: string(&case["class"]),
        verdict: string(&case["verdict"]),
        files: case["files"].as_array().into_iter().flatten().map(string).collect(),
    };
    manifest["cases"].as_array().into_iter().flatten().map(case).collect()
}

fn read(file: &str) -> Domain {
    let path = folder().join(file);
    let bytes = std::fs::read(&path).expect("a listed file is there");
    let form = DomainForm::from_path(&path).expect("a known extension");
    read_domain(&bytes, form, &ReadOptions::default()).unwrap_or_else(|e| panic!("{file}: {e}"))
}

fn json(case: &Case) -> Result<Plc, Vec<Fault>> {
    validate(&read(&format!("{}.json", case.name)))
}

// spec: D16 D17
#[test]
fn verdicts_on_real_boundaries() {
    let mut table: BTreeMap<(String, String, String), usize> = BTreeMap::new();
    let mut wrong = Vec::new();
    for case in cases() {
        let found = json(&case);
        let ids: Vec<&str> = match &found {
            Ok(_) => vec!["sound"],
            Err(faults) => {
                let mut ids: Vec<&str> = faults.iter().map(Fault::id).collect();
                ids.dedup();
                ids
            }
        };
        let key = (case.class.clone(), case.verdict.clone(), ids.join(" "));
        *table.entry(key).or_default() += 1;
        let says =
            |faults: &[Fault]| faults.iter().all(|f| f.places().iter().all(|p| **p != Place::Made));
        let right = match (case.verdict.as_str(), case.class.as_str(), &found) {
            ("mesh", _, found) => found.is_ok(),
            ("error", _, Err(faults)) => !faults.is_empty() && says(faults),
            ("error", _, Ok(_)) => false,
            (_, "touching" | "pslg-hanging", found) => found.is_ok(),
            (_, "duplicate-points" | "pslg-duplicate-points" | "pslg-crossing", found) => {
                found.is_err()
            }
            _ => true,
        };
        if !right {
            wrong.push(format!("{} ({}): {}", case.name, case.class, listed(&found)));
        }
    }
    for ((class, verdict, ids), count) in &table {
        println!("{count:4} {class:24} {verdict:14} {ids}");
    }
    assert!(wrong.is_empty(), "{} wrong:\n{}", wrong.len(), wrong.join("\n"));
}

fn listed(found: &Result<Plc, Vec<Fault>>) -> String {
    match found {
        Ok(_) => "sound".to_owned(),
        Err(faults) => {
            faults.iter().take(3).map(|f| format!("{} {f}", f.id())).collect::<Vec<_>>().join("; ")
        }
    }
}

/// The segments of a complex as pairs of points, which do not depend on how points are numbered.
fn segments(plc: &Plc) -> Vec<[[u64; 2]; 2]> {
    let ends = |s: &trigrade::domain::validate::PlcSegment| {
        let mut ends = s.vertices.map(|v| plc.points[v as usize].key());
        ends.sort_unstable();
        ends
    };
    let mut all: Vec<_> = plc.segments.iter().map(ends).collect();
    all.sort_unstable();
    all
}

// spec: X10
#[test]
fn json_and_poly_of_a_case_agree() {
    let (mut compared, mut wrong) = (0, Vec::new());
    for case in cases() {
        let poly = format!("{}.poly", case.name);
        // A PSLG was wrapped into a box in its JSON file only.
        if !case.files.contains(&poly) || case.class.starts_with("pslg") {
            continue;
        }
        compared += 1;
        match (json(&case), validate(&read(&poly))) {
            (Ok(from_json), Ok(from_poly)) if segments(&from_json) == segments(&from_poly) => {}
            (from_json, from_poly) => wrong.push(format!(
                "{} ({}): {} | {}",
                case.name,
                case.class,
                listed(&from_json),
                listed(&from_poly)
            )),
        }
    }
    println!("{compared} cases compared");
    assert!(wrong.is_empty(), "{} differ:\n{}", wrong.len(), wrong.join("\n"));
}
