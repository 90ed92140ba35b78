//! NURBS surfaces as JSON, in the two layouts that NURBS-Python (geomdl) made common.
//!
//! Its own export: `{"shape": {"type": "surface", "data": [{"degree_u", "degree_v", "knotvector_u",
//! "knotvector_v", "size_u", "size_v", "control_points": {"points": [[x, y, z], ...], "weights"}}]}}`
//! with the points of v running faster. And one surface a file: `{"degree_u", "degree_v", "knots_u",
//! "knots_v", "control_points": [[[x, y, z, w], ...], ...]}`, rows with u constant. In both, a point
//! may have its weight as a fourth number; coordinates are not multiplied by it.
//!
//! Keys that say nothing of the shape are left out of account: such files carry samples and settings.

use super::domain_file::{DomainReadError, Problem, without_mark};
use super::domain_json::{Item, Path, Read, parse};
use crate::model::{Model, Patch};
use crate::surface::{Surface, Tensor};
use crate::vector::Vector;
use serde_json::Value;

/// Whether JSON is a NURBS surface of one of these layouts.
#[must_use]
pub fn is_nurbs(value: &Value) -> bool {
    value.get("shape").is_some()
        || (value.get("degree_u").is_some() && value.get("degree_v").is_some())
}

/// Reads NURBS surfaces; they are named and marked by their number from 1.
///
/// # Errors
/// What keeps the file from being understood, with its line or JSON path.
pub fn read(bytes: &[u8]) -> Result<Model, DomainReadError> {
    let value = parse(without_mark(bytes))?;
    let root = Item { value: &value, path: &Path::Root };
    let mut model = Model::default();
    let mut add = |tensor: Tensor| {
        model.patches.push(Patch::plain(model.patches.len(), Surface::Tensor(tensor)));
    };
    if value.get("shape").is_none() {
        add(surface(root, ["knots_u", "knots_v"])?);
        return Ok(model);
    }
    root.required("shape", |shape| {
        shape.key("type", |item| match item.value.as_str() {
            Some("surface") => Ok(()),
            _ => Err(item.expected("the type 'surface'")),
        })?;
        shape.required("data", |data| {
            data.each("an array of surfaces", |item| {
                add(surface(item, ["knotvector_u", "knotvector_v"])?);
                Ok(())
            })
        })
    })?;
    Ok(model)
}

/// Control points with their weights.
type Weighted = (Vector, f64);

fn surface(item: Item, knots: [&'static str; 2]) -> Read<Tensor> {
    let degree = |key| item.required(key, |item| item.degree());
    let degrees = [degree("degree_u")?, degree("degree_v")?];
    let list = |key| item.required(key, |item: Item| item.numbers());
    let knots = [list(knots[0])?, list(knots[1])?];
    let rows = item.required("control_points", |points| match points.value {
        Value::Object(_) => flat_net(item, points),
        _ => nested_net(points),
    })?;
    let part = |of: fn(&Weighted) -> Vector| -> Vec<Vec<Vector>> {
        rows.iter().map(|row| row.iter().map(of).collect()).collect()
    };
    let points = part(|weighted| weighted.0);
    let is_rational = rows.iter().flatten().any(|(_, weight)| *weight != 1.0);
    let weights: Vec<Vec<f64>> = match is_rational {
        true => rows.iter().map(|row| row.iter().map(|(_, weight)| *weight).collect()).collect(),
        false => Vec::new(),
    };
    Tensor::new(degrees, knots, &points, &weights).map_err(|error| item.error(error.into()))
}

/// `[x, y, z]` or `[x, y, z, w]`.
fn weighted(item: Item) -> Read<Weighted> {
    match item.numbers()?[..] {
        [x, y, z] => Ok(([x, y, z], 1.0)),
        [x, y, z, w] => Ok(([x, y, z], w)),
        _ => Err(item.expected("a control point [x, y, z] or [x, y, z, w]")),
    }
}

fn weighted_list(item: Item) -> Read<Vec<Weighted>> {
    let mut list = Vec::new();
    item.each("an array of control points", |item| {
        list.push(weighted(item)?);
        Ok(())
    })?;
    Ok(list)
}

fn nested_net(item: Item) -> Read<Vec<Vec<Weighted>>> {
    let mut rows = Vec::new();
    item.each("an array of rows of control points", |item| {
        rows.push(weighted_list(item)?);
        Ok(())
    })?;
    Ok(rows)
}

/// Points in one list, v faster, with `size_u` rows of `size_v`; weights beside them.
fn flat_net(surface: Item, item: Item) -> Read<Vec<Vec<Weighted>>> {
    let mut list = item.required("points", weighted_list)?;
    if let Some(weights) = item.key("weights", |item| item.numbers())? {
        if weights.len() != list.len() {
            let (found, expected) = (weights.len(), list.len());
            return Err(item.error(Problem::Length { what: "weights", found, expected }));
        }
        list.iter_mut().zip(weights).for_each(|(point, weight)| point.1 = weight);
    }
    let size =
        |key| surface.required(key, |item| item.integer("a number of control points", 1, 1 << 24));
    let (rows, columns) = (size("size_u")? as usize, size("size_v")? as usize);
    if rows * columns != list.len() {
        let (found, expected) = (list.len(), rows * columns);
        return Err(item.error(Problem::Length { what: "control points", found, expected }));
    }
    Ok(list.chunks(columns).map(<[Weighted]>::to_vec).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    const ONE: &str = r#"{"degree_u": 1, "degree_v": 1, "knots_u": [0, 0, 1, 1], "knots_v": [0, 0, 1, 1],
        "control_points": [[[0, 0, 0, 1], [0, 1, 0, 1]], [[1, 0, 0, 1], [1, 1, 2, 3]]], "more": 1}"#;
    const EXPORTED: &str = r#"{"shape": {"type": "surface", "count": 1, "data": [{"rational": true, "degree_u": 1,
        "degree_v": 1, "knotvector_u": [0, 0, 1, 1], "knotvector_v": [0, 0, 1, 1], "size_u": 2, "size_v": 2,
        "control_points": {"points": [[0, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 2]], "weights": [1, 1, 1, 3]}}]}}"#;

    // spec: X61
    #[test]
    fn both_layouts_give_the_same_surface() {
        let [one, exported] = [ONE, EXPORTED].map(|text| read(text.as_bytes()).expect("read"));
        assert_eq!(one, exported);
        assert_eq!(one.patches[0].surface.at(1.0, 1.0), [1.0, 1.0, 2.0]);
        assert_eq!(one.patches[0].surface.at(0.5, 0.5), [4.0 / 6.0, 4.0 / 6.0, 1.0]);
        let is = |text| is_nurbs(&serde_json::from_str(text).expect("JSON"));
        assert!(is(ONE) && is(EXPORTED) && !is(r#"{"patches": []}"#));
    }

    // spec: X61
    #[test]
    fn what_is_no_surface_is_refused_with_its_path() {
        let cases = [
            (ONE, r#""degree_v": 1"#, r#""degree_v": 0"#, "$.degree_v"),
            (ONE, r#""degree_u": 1, "#, "", "degree_u"),
            (ONE, "[0, 0, 1, 1], \"knots_v", "[0, 0, 1], \"knots_v", "knots"),
            (ONE, "[1, 1, 2, 3]", "[1, 1]", "$.control_points[1][1]"),
            (ONE, ", [0, 1, 0, 1]]", "]", "row 1 of the control net"),
            (ONE, "[1, 1, 2, 3]", "[1, 1, 2, 0]", "weight"),
            (EXPORTED, r#""surface""#, r#""curve""#, "$.shape.type"),
            (EXPORTED, r#""size_u": 2"#, r#""size_u": 3"#, "4 control points, but there must be 6"),
            (EXPORTED, "[1, 1, 1, 3]", "[1, 3]", "2 weights"),
            (EXPORTED, r#""size_u": 2, "#, "", "size_u"),
        ];
        for (text, from, to, expected) in cases {
            let broken = text.replacen(from, to, 1);
            assert_ne!(broken, text, "{from}");
            let error = read(broken.as_bytes()).expect_err(to).to_string();
            assert!(error.contains(expected), "{to:?}: {error}");
        }
    }
}
