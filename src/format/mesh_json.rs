//! A triangulation as JSON: written, for programs that read nothing else.
//!
//! The schema is `schemas/triangulation-1.schema.json`. Numbers are the shortest decimals that read
//! back to the same bits, so the file is written by hand and not by way of a tree of values.

use super::error::WriteError;
use super::text::TextOut;
use super::view::MeshView;
use std::io::{self, Write};

/// The value of the key `schema`.
pub const SCHEMA: &str = "trigrade-triangulation/1";

/// Writes a triangulation: points with two coordinates, or three if some z is not +0.0.
///
/// # Errors
/// A mesh that names points it does not have; coordinates that are not finite, which JSON cannot
/// carry; an output that fails.
pub fn write(mesh: MeshView, out: &mut dyn Write) -> Result<(), WriteError> {
    mesh.validate()?;
    if mesh.points().flatten().any(|c| !c.is_finite()) {
        let error = io::Error::new(io::ErrorKind::InvalidData, "JSON has only finite numbers");
        return Err(WriteError::Io(error));
    }
    let mut text = TextOut::new(out);
    text.text(&format!("{{\"schema\":\"{SCHEMA}\",\n\"points\":["))?;
    let dimension = if mesh.is_plane() { 2 } else { 3 };
    list(&mut text, mesh.points(), |text, point| numbers(text, &point[..dimension]))?;
    text.text("],\n\"triangles\":[")?;
    list(&mut text, mesh.triangles(), |text, t| integers(text, &t.map(i64::from)))?;
    text.text("],\n\"edges\":[")?;
    list(&mut text, mesh.edges(), |text, edge| {
        let [a, b] = edge.vertices.map(i64::from);
        integers(text, &[a, b, i64::from(edge.marker)])
    })?;
    text.text("]")?;
    if mesh.has_regions() {
        let regions: Vec<i64> =
            (0..mesh.triangles().len()).map(|i| i64::from(mesh.region(i, 0))).collect();
        text.text(",\n\"regions\":")?;
        integers(&mut text, &regions)?;
    }
    text.text("}\n")?;
    Ok(text.finish()?)
}

/// Items with commas between, a line each.
pub(super) fn list<'a, T>(
    text: &mut TextOut<'a>,
    items: impl IntoIterator<Item = T>,
    mut write: impl FnMut(&mut TextOut<'a>, T) -> io::Result<()>,
) -> io::Result<()> {
    for (i, item) in items.into_iter().enumerate() {
        text.text(if i == 0 { "\n" } else { ",\n" })?;
        write(text, item)?;
    }
    Ok(())
}

/// An array of finite numbers.
pub(super) fn numbers(text: &mut TextOut, values: &[f64]) -> io::Result<()> {
    let mut before = b'[';
    for &value in values {
        text.bytes(&[before])?;
        text.number(value)?;
        before = b',';
    }
    text.text(if values.is_empty() { "[]" } else { "]" })
}

/// An array of integers.
pub(super) fn integers(text: &mut TextOut, values: &[i64]) -> io::Result<()> {
    text.bytes(b"[")?;
    for (i, &value) in values.iter().enumerate() {
        text.text(if i == 0 { "" } else { "," })?;
        text.text(&value.to_string())?;
    }
    text.bytes(b"]")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{MarkedEdge, MeshData};
    use serde_json::Value;

    fn written(mesh: &MeshData) -> Value {
        let mut bytes = Vec::new();
        write(mesh.into(), &mut bytes).expect("sound");
        serde_json::from_slice(&bytes).expect("JSON")
    }

    fn square() -> MeshData {
        MeshData {
            points: vec![[0.0; 3], [1.0, -0.0, 0.0], [5e-324, 1.7e308, 0.0], [0.1, 1e21, 0.0]],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            edges: vec![MarkedEdge { vertices: [0, 1], marker: -7 }],
            ..MeshData::default()
        }
    }

    // spec: X46
    #[test]
    fn a_triangulation_meets_its_schema_and_keeps_every_bit() {
        let schema = include_str!("../../schemas/triangulation-1.schema.json");
        let schema: Value = serde_json::from_str(schema).expect("JSON");
        let schema = jsonschema::validator_for(&schema).expect("a schema");
        let with_regions = MeshData { regions: vec![3, -1], ..square() };
        let mut space = square();
        space.points[0][2] = 2.5;
        for mesh in [square(), with_regions, space, MeshData::default()] {
            let value = written(&mesh);
            let errors: Vec<String> = schema.iter_errors(&value).map(|e| e.to_string()).collect();
            assert!(errors.is_empty(), "{errors:?}");
            let points = value["points"].as_array().expect("an array");
            for (point, back) in mesh.points.iter().zip(points) {
                for (c, back) in point.iter().zip(back.as_array().expect("a point")) {
                    assert_eq!(back.as_f64().expect("a number").to_bits(), c.to_bits());
                }
            }
            assert_eq!(value["triangles"], serde_json::json!(mesh.triangles));
        }
        assert_eq!(written(&square())["edges"], serde_json::json!([[0, 1, -7]]));
    }

    // spec: !X46
    #[test]
    fn what_json_cannot_say_is_refused() {
        let mut mesh = square();
        mesh.points[1][0] = f64::NAN;
        assert!(write((&mesh).into(), &mut Vec::new()).is_err());
        let mut mesh = square();
        mesh.triangles[0][0] = 9;
        assert!(matches!(
            write((&mesh).into(), &mut Vec::new()),
            Err(WriteError::BadReference { .. })
        ));
    }
}
