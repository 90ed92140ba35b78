//! Points as JSON: an array of positions, or an object of which `points` is the only key. Any other
//! object is a domain.

use super::{PointFile, PointReadError, PointSet, THIRD};
use crate::format::domain_file::{DomainForm, DomainReadError, Problem, ReadOptions};
use crate::format::domain_file::{read_domain, without_mark};
use crate::format::domain_json::{Item, Path, parse};
use crate::point::Point2;
use serde_json::Value;

/// Reads points or a domain.
///
/// # Errors
/// What keeps the file from being understood, with its line or JSON path.
pub(super) fn read(bytes: &[u8]) -> Result<PointFile, PointReadError> {
    let bytes = without_mark(bytes);
    let value: Value = parse(bytes)?;
    let root = Item { value: &value, path: &Path::Root };
    let is_points = |keys: &serde_json::Map<String, Value>| {
        keys.contains_key("points") && keys.keys().all(|key| key == "points" || key == "comment")
    };
    match &value {
        Value::Object(keys) if is_points(keys) => {
            let set = root.key("points", positions)?.unwrap_or_default();
            Ok(PointFile::Points(set))
        }
        Value::Object(_) => {
            drop(value);
            let domain = read_domain(bytes, DomainForm::Json, &ReadOptions::default())?;
            Ok(PointFile::Domain(Box::new(domain)))
        }
        _ => Ok(PointFile::Points(positions(root)?)),
    }
}

fn positions(item: Item) -> Result<PointSet, DomainReadError> {
    let mut set = PointSet::default();
    let mut has_third = false;
    item.each("an array of points", |item| {
        let [x, y, rest @ ..] = item.value.as_array().map(Vec::as_slice).unwrap_or_default() else {
            return item.position().map(|point| set.points.push(point));
        };
        if rest.len() > 1 {
            let found = format!("{} numbers", 2 + rest.len());
            return Err(item.error(Problem::Expected { what: "a point [x, y]", found }));
        }
        let number = |value, i| Item { value, path: &Path::Index(item.path, i) }.number();
        set.points.push(Point2::new(number(x, 0)?, number(y, 1)?));
        if let [z] = rest {
            number(z, 2)?;
            has_third = true;
        }
        Ok(())
    })?;
    set.left_out.extend(has_third.then(|| THIRD.to_owned()));
    Ok(set)
}
