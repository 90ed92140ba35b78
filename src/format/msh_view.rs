//! Views at the nodes of MSH files (`$NodeData`), among them the parameters (u, v) of points: a view
//! `uv` of vectors (u, v, 0).
//!
//! A view of vectors, because a view of numbers at nodes is what Gmsh and trigrade take for a size
//! field.
//!
//! Source: the Gmsh reference manual, "Gmsh file formats".

use crate::format::ReadOptions;
use crate::format::error::ReadError;
use crate::format::msh::{self, Codec};
use crate::format::scan::Scanner;
use crate::format::text::TextOut;
use crate::mesh::MeshData;
use memchr::memmem;
use std::io;

/// Name of the view.
const NAME: &str = "\"uv\"";

/// Writes the view; nothing where there are no parameters.
pub(crate) fn write(uv: &[[f64; 2]], is_binary: bool, out: &mut TextOut) -> io::Result<()> {
    if uv.is_empty() {
        return Ok(());
    }
    // One name, the time 0, and the integers step, components, entries.
    out.text(&format!("$NodeData\n1\n{NAME}\n1\n0\n3\n0\n3\n{}\n", uv.len()))?;
    for (number, &[u, v]) in (1_i32..).zip(uv) {
        if is_binary {
            out.bytes(&number.to_le_bytes())?;
            [u, v, 0.0].iter().try_for_each(|value| out.bytes(&value.to_le_bytes()))?;
        } else {
            out.integer(i64::from(number), b' ')?;
            out.float(u, b' ')?;
            out.float(v, b' ')?;
            out.float(0.0, b'\n')?;
        }
    }
    out.text(if is_binary { "\n$EndNodeData\n" } else { "$EndNodeData\n" })
}

/// The parameters (u, v) that an MSH file has for its points, in the order of its points; NaN where
/// it has none for a point, `None` where it has no view `uv`.
///
/// # Errors
/// The first fault of the mesh or the view, with its place.
pub fn read_parameters(bytes: &[u8]) -> Result<Option<Vec<[f64; 2]>>, ReadError> {
    let mesh = msh::read(bytes, &ReadOptions::default())?;
    let view = read(bytes, &mesh, Codec::point, |name| name == Some(NAME.as_bytes()))?;
    Ok(view.map(|values| values.into_iter().map(|[u, v, _]| [u, v]).collect()))
}

/// The first view at nodes with `N` components and a name that is wanted: its values in the order of
/// the points of `mesh`, which was read from the same bytes; NaN where it has none for a point. `value`
/// reads the components at a node.
///
/// # Errors
/// The first fault of the view, with its place.
pub(crate) fn read<const N: usize>(
    bytes: &[u8],
    mesh: &MeshData,
    value: impl Fn(Codec, &mut Scanner) -> Result<[f64; N], ReadError>,
    is_wanted: impl Fn(Option<&[u8]>) -> bool,
) -> Result<Option<Vec<[f64; N]>>, ReadError> {
    let mut order: Vec<(i64, usize)> = mesh.point_numbers.iter().copied().zip(0..).collect();
    if order.is_empty() {
        order = (0..mesh.points.len()).map(|i| (i as i64, i)).collect();
    }
    order.sort_unstable();
    let codec = msh::codec(bytes)?;
    for start in memmem::find_iter(bytes, b"$NodeData") {
        let mut scanner = Scanner::within(bytes, start);
        scanner.expect("$NodeData")?;
        let (name, [_, components, entries]) = read_tags(&mut scanner)?;
        if components != N as i64 || !is_wanted(name) {
            continue;
        }
        if codec.endian.is_some() {
            scanner.rest_of_line();
            scanner.set_binary();
        }
        let mut values = vec![[f64::NAN; N]; mesh.points.len()];
        for _ in 0..scanner.check_count("values", entries, codec.bytes(1, 0, N))? {
            let number = codec.int(&mut scanner, "a node number")?;
            let value = value(codec, &mut scanner)?;
            match order.binary_search_by_key(&number, |entry| entry.0) {
                Ok(place) => values[order[place].1] = value,
                Err(_) => {
                    let found = number.to_string();
                    return Err(scanner.malformed("the number of a node", found.as_bytes()));
                }
            }
        }
        scanner.expect("$EndNodeData")?;
        return Ok(Some(values));
    }
    Ok(None)
}

/// The tags before the values: the first of the strings, which is the name, the reals, and the
/// integers time step, components, entries.
fn read_tags<'a>(scanner: &mut Scanner<'a>) -> Result<(Option<&'a [u8]>, [i64; 3]), ReadError> {
    let strings = scanner.count("string tags", 2)?;
    scanner.rest_of_line();
    let names: Vec<&[u8]> = (0..strings).map(|_| scanner.rest_of_line()).collect();
    for _ in 0..scanner.count("real tags", 2)? {
        scanner.float("a real tag")?;
    }
    let mut integers = [0; 3];
    for place in 0..scanner.count("integer tags", 2)? {
        let tag = scanner.integer("an integer tag")?;
        if let Some(integer) = integers.get_mut(place) {
            *integer = tag;
        }
    }
    Ok((names.first().copied(), integers))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::{Encoding, MeshForm, MeshView, WriteOptions, write_mesh};

    fn mesh() -> MeshData {
        MeshData {
            points: vec![[0.0; 3], [1.0, 0.0, 0.5], [0.0, 1.0, 0.25]],
            triangles: vec![[0, 1, 2]],
            ..MeshData::default()
        }
    }

    const UV: [[f64; 2]; 3] = [[0.1, -2.0], [1.0 / 3.0, 1e-300], [7.0, 0.0]];

    fn written(encoding: Encoding, msh_version: crate::format::MshVersion) -> Vec<u8> {
        let mesh = mesh();
        let mut bytes = Vec::new();
        let view = MeshView::from(&mesh).with_parameters(&UV);
        let options = WriteOptions { encoding, msh_version };
        write_mesh(view, MeshForm::Msh, options, &mut bytes).expect("a mesh");
        bytes
    }

    // spec: X70
    #[test]
    fn parameters_come_back_to_the_bit_from_both_versions_and_encodings() {
        use crate::format::{MshVersion, ReadOptions, read_mesh};
        for version in [MshVersion::V22, MshVersion::V41] {
            for encoding in [Encoding::Ascii, Encoding::Binary] {
                let bytes = written(encoding, version);
                assert_eq!(read_parameters(&bytes).expect("sound"), Some(UV.to_vec()));
                let back = read_mesh(&bytes, MeshForm::Msh, &ReadOptions::default());
                assert_eq!(back.expect("a mesh").points, mesh().points);
                let size = crate::format::node_data::read_node_data(
                    &bytes,
                    crate::format::node_data::NodeDataForm::Msh,
                );
                assert!(size.is_err(), "parameters are no size field");
            }
        }
    }

    // spec: X70
    #[test]
    fn a_file_without_parameters_has_none_and_gaps_are_nan() {
        let text = String::from_utf8(written(Encoding::Ascii, Default::default())).expect("text");
        let start = text.find("$NodeData").expect("a view");
        assert_eq!(read_parameters(&text.as_bytes()[..start]).expect("sound"), None);
        let other = text.replace("\"uv\"", "\"wind\"");
        assert_eq!(read_parameters(other.as_bytes()).expect("sound"), None);
        let part = text.replace("0\n3\n3\n1 0.1 -2 0\n", "0\n3\n2\n");
        assert_ne!(part, text);
        let found = read_parameters(part.as_bytes()).expect("sound").expect("a view");
        assert!(found[0][0].is_nan() && found[1..] == UV[1..], "{found:?}");
    }

    // spec: X70
    #[test]
    fn views_that_lie_are_refused() {
        let text = String::from_utf8(written(Encoding::Ascii, Default::default())).expect("text");
        for (from, to, word) in [
            ("0\n3\n3\n1 0.1", "0\n3\n1099511627776\n1 0.1", "declared"),
            ("\n1 0.1 -2 0\n", "\n9 0.1 -2 0\n", "number of a node"),
            ("\n1 0.1 -2 0\n", "\n1 0.1 minus 0\n", "coordinate of a node"),
            ("0\n3\n3\n1 0.1", "0\n3\n2\n1 0.1", "$EndNodeData"),
        ] {
            let broken = text.replacen(from, to, 1);
            assert_ne!(broken, text, "{from}");
            let told = read_parameters(broken.as_bytes()).expect_err(to).to_string();
            assert!(told.contains(word), "{to}: {told}");
        }
    }
}
