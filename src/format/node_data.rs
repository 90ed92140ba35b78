//! Meshes with a number at each node, from which a size field is interpolated: Gmsh's `$NodeData`
//! in an MSH file, Gmsh's parsed views (`.pos`), and the point data of a VTU file.
//!
//! Source: the Gmsh reference manual, "Gmsh file formats" and "Post-processing module"; for VTU see
//! the reader of its meshes.

use crate::format::error::ReadError;
use crate::format::msh::{self, Codec};
use crate::format::scan::Scanner;
use crate::format::{ReadOptions, msh_view, vtu};
use crate::mesh::MeshData;
use std::path::Path;

/// A form of files with numbers at nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NodeDataForm {
    /// Gmsh MSH 2.2 or 4.1 with a section `$NodeData`.
    Msh,
    /// A parsed view of Gmsh.
    Pos,
    /// VTU with an array of point data.
    Vtu,
}

impl NodeDataForm {
    /// The form of a file with this name.
    #[must_use]
    pub fn from_path(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "msh" => Some(Self::Msh),
            "pos" => Some(Self::Pos),
            "vtu" => Some(Self::Vtu),
            _ => None,
        }
    }
}

/// Triangles and a number at each of their points.
///
/// # Shapes and units
/// `points: [n][2]` (z is dropped), `values: [n]`, NaN where the file gives none, `triangles:
/// [m][3]`, indices as the file has them: they may name no point.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NodeData {
    /// Nodes.
    pub points: Vec<[f64; 2]>,
    /// The number at each.
    pub values: Vec<f64>,
    /// Triangles; quadrilaterals are split.
    pub triangles: Vec<[u32; 3]>,
}

/// Reads a mesh with a number at each node; of several sets the first of one component.
///
/// # Errors
/// The first fault with its place.
pub fn read_node_data(bytes: &[u8], form: NodeDataForm) -> Result<NodeData, ReadError> {
    match form {
        NodeDataForm::Msh => read_msh(bytes),
        NodeDataForm::Pos => read_pos(bytes),
        NodeDataForm::Vtu => {
            let (mesh, values) = vtu::read_point_data(bytes)?;
            Ok(NodeData::of(mesh, values))
        }
    }
}

const QUADS: ReadOptions = ReadOptions { split_quads: true, nodes: None, edges: None };

impl NodeData {
    fn of(mesh: MeshData, mut values: Vec<f64>) -> Self {
        values.resize(mesh.points.len(), f64::NAN);
        let points = mesh.points.iter().map(|&[x, y, _]| [x, y]).collect();
        Self { points, values, triangles: mesh.triangles }
    }
}

fn read_msh(bytes: &[u8]) -> Result<NodeData, ReadError> {
    let mesh = msh::read(bytes, &QUADS)?;
    let value =
        |codec: Codec, scanner: &mut Scanner| Ok([codec.float(scanner, "the value at a node")?]);
    match msh_view::read(bytes, &mesh, value, |_| true)? {
        Some(values) => Ok(NodeData::of(mesh, values.into_iter().map(|[value]| value).collect())),
        None => {
            let scanner = Scanner::within(bytes, bytes.len());
            Err(scanner.malformed("a section `$NodeData` of one component", b""))
        }
    }
}

/// An element of a parsed view: name, number of nodes, and the triangles it is made of.
type PosElement = (&'static [u8], usize, &'static [[u32; 3]]);

const POS_ELEMENTS: [PosElement; 6] = [
    (b"SP", 1, &[]),
    (b"SL", 2, &[]),
    (b"ST", 3, &[[0, 1, 2]]),
    (b"SQ", 4, &[[0, 1, 2], [0, 2, 3]]),
    (b"SS", 4, &[]),
    (b"SH", 8, &[]),
];

fn read_pos(bytes: &[u8]) -> Result<NodeData, ReadError> {
    let mut view = View { bytes, at: 0 };
    view.skip_blank();
    if !view.take_word(b"View") {
        return Err(view.malformed("the word `View`"));
    }
    view.skip_blank();
    if view.peek() == Some(b'"') {
        view.at += 1;
        view.at += memchr::memchr(b'"', view.rest()).ok_or_else(|| view.malformed("`\"`"))? + 1;
    }
    view.punctuation(b'{')?;
    let mut data = NodeData::default();
    loop {
        view.skip_blank();
        if view.peek() == Some(b'}') {
            break;
        }
        read_pos_element(&mut view, &mut data)?;
    }
    if data.triangles.is_empty() {
        return Err(view.malformed("a scalar triangle such as `ST(...){...};` before `}`"));
    }
    Ok(data)
}

/// `ST(x, y, z, ...){v, v, v};`, of several time steps the first.
fn read_pos_element(view: &mut View, data: &mut NodeData) -> Result<(), ReadError> {
    let element = POS_ELEMENTS.iter().find(|(name, ..)| view.rest().starts_with(name));
    let Some(&(name, nodes, triangles)) = element else {
        return Err(view.malformed("a scalar element such as `ST`"));
    };
    view.at += name.len();
    let coordinates = view.list(b'(', b')', 3 * nodes)?;
    let values = view.list(b'{', b'}', nodes)?;
    view.punctuation(b';')?;
    if triangles.is_empty() {
        return Ok(());
    }
    let first = data.points.len() as u32;
    data.points.extend(coordinates.chunks_exact(3).map(|c| [c[0], c[1]]));
    data.values.extend(&values[..nodes]);
    data.triangles.extend(triangles.iter().map(|t| t.map(|corner| first + corner)));
    Ok(())
}

/// A cursor over a parsed view, where numbers touch punctuation.
struct View<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> View<'a> {
    fn rest(&self) -> &'a [u8] {
        &self.bytes[self.at..]
    }

    fn peek(&self) -> Option<u8> {
        self.bytes.get(self.at).copied()
    }

    fn malformed(&self, expected: &str) -> ReadError {
        Scanner::within(self.bytes, self.at).malformed(expected, self.rest())
    }

    /// Blanks, and comments as in C++.
    fn skip_blank(&mut self) {
        loop {
            let blank = self.rest().iter().take_while(|byte| byte.is_ascii_whitespace()).count();
            self.at += blank;
            if !self.rest().starts_with(b"//") {
                return;
            }
            self.at += memchr::memchr(b'\n', self.rest()).unwrap_or(self.rest().len());
        }
    }

    fn take_word(&mut self, word: &[u8]) -> bool {
        let is_there = self.rest().starts_with(word);
        self.at += if is_there { word.len() } else { 0 };
        is_there
    }

    fn punctuation(&mut self, wanted: u8) -> Result<(), ReadError> {
        self.skip_blank();
        if self.peek() != Some(wanted) {
            return Err(self.malformed(&format!("`{}`", wanted as char)));
        }
        self.at += 1;
        Ok(())
    }

    /// At least `least` numbers between two brackets; a multiple of it.
    fn list(&mut self, open: u8, close: u8, least: usize) -> Result<Vec<f64>, ReadError> {
        self.punctuation(open)?;
        let mut numbers = Vec::new();
        loop {
            self.skip_blank();
            let is_number = |b: &&u8| b.is_ascii_alphanumeric() || b"+-.".contains(*b);
            let length = self.rest().iter().take_while(is_number).count();
            let mut scanner = Scanner::within(self.bytes, self.at);
            numbers.push(scanner.parse_float(&self.rest()[..length], "a number")?);
            self.at += length;
            self.skip_blank();
            match self.peek() {
                Some(b',') => self.at += 1,
                Some(byte) if byte == close && numbers.len() % least == 0 => {
                    self.at += 1;
                    return Ok(numbers);
                }
                _ => return Err(self.malformed(&format!("{least} numbers in brackets"))),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn msh(data: &str) -> Vec<u8> {
        format!(
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n10 0 0 0\n20 1 0 0\n30 1 1 0\n\
             40 0 1 0\n$EndNodes\n$Elements\n1\n1 3 2 1 1 10 20 30 40\n$EndElements\n{data}"
        )
        .into_bytes()
    }

    const NODE_DATA: &str =
        "$NodeData\n1\n\"h\"\n1\n0.0\n3\n0\n1\n4\n40 4\n10 1\n20 2.5\n30 3\n$EndNodeData\n";

    // spec: X49
    #[test]
    fn node_data_of_an_msh_file_goes_by_node_numbers() {
        let data = read_node_data(&msh(NODE_DATA), NodeDataForm::Msh).unwrap();
        assert_eq!(data.values, [1.0, 2.5, 3.0, 4.0]);
        assert_eq!(data.triangles, [[0, 1, 2], [0, 2, 3]]);
        let vector = "$NodeData\n1\n\"v\"\n1\n0\n3\n0\n3\n1\n10 1 2 3\n$EndNodeData\n";
        let data = read_node_data(&msh(&(vector.to_owned() + NODE_DATA)), NodeDataForm::Msh);
        assert_eq!(data.unwrap().values[1], 2.5, "vectors are passed over");
    }

    // spec: X49
    #[test]
    fn nodes_without_a_value_have_nan() {
        let part = "$NodeData\n0\n0\n3\n0\n1\n1\n20 7\n$EndNodeData\n";
        let data = read_node_data(&msh(part), NodeDataForm::Msh).unwrap();
        assert_eq!(data.values[1], 7.0);
        assert!(data.values[0].is_nan() && data.values[3].is_nan());
    }

    // spec: !X49
    #[test]
    fn msh_files_without_sound_data_are_refused() {
        for (data, word) in [
            ("", "$NodeData"),
            ("$NodeData\n0\n0\n3\n0\n1\n1\n99 7\n$EndNodeData\n", "number of a node"),
            ("$NodeData\n0\n0\n3\n0\n1\n1099511627776\n20 7\n$EndNodeData\n", "declared"),
            ("$NodeData\n0\n0\n3\n0\n1\n1\n20 seven\n$EndNodeData\n", "value"),
            ("$NodeData\n0\n0\n3\n0\n1\n2\n20 7\n", "ends"),
        ] {
            let error = read_node_data(&msh(data), NodeDataForm::Msh).unwrap_err();
            assert!(error.to_string().contains(word), "{data}: {error}");
        }
    }

    // spec: X49
    #[test]
    fn parsed_views_have_scalar_triangles_and_quadrilaterals() {
        let text = "// sizes\nView \"h\" {\nSP(0,0,0){1};\n\
                    ST(0, 0, 0, 1,0,0 , 0,1,0){0.1,2e-1,.3, 9,9,9};\n\
                    SQ(0,0,0,1,0,0,1,1,0,0,1,0){1,2,3,4};\n};\n";
        let data = read_node_data(text.as_bytes(), NodeDataForm::Pos).unwrap();
        assert_eq!(data.points.len(), 7);
        assert_eq!(data.values, [0.1, 0.2, 0.3, 1.0, 2.0, 3.0, 4.0]);
        assert_eq!(data.triangles, [[0, 1, 2], [3, 4, 5], [3, 5, 6]]);
    }

    // spec: !X49
    #[test]
    fn broken_views_are_refused_with_their_line() {
        for (text, line) in [
            ("", 1),
            ("Mesh", 1),
            ("View \"h", 1),
            ("View \"h\" {\n};\n", 2),
            ("View \"h\" {\nVT(0,0,0){1};\n};", 2),
            ("View \"h\" {\n\nST(0,0,0,1,0,0,0,1){1,2,3};\n};", 3),
            ("View \"h\" {\nST(0,0,0,1,0,0,0,1,0){1,2};\n};", 2),
            ("View \"h\" {\nST(0,0,0,1,0,0,0,1,x){1,2,3};\n};", 2),
            ("View \"h\" {\nST(0,0,0,1,0,0,0,1,0){1,2,3}", 2),
        ] {
            let error = read_node_data(text.as_bytes(), NodeDataForm::Pos).unwrap_err();
            assert!(error.to_string().starts_with(&format!("line {line}:")), "{text}: {error}");
        }
    }

    // spec: X49
    #[test]
    fn the_first_point_array_of_a_vtu_file_counts() {
        let text = "<VTKFile type=\"UnstructuredGrid\">\n<UnstructuredGrid>\n\
            <Piece NumberOfPoints=\"3\" NumberOfCells=\"1\">\n\
            <PointData><DataArray type=\"Float64\" Name=\"v\" NumberOfComponents=\"3\">1 2 3 4 5 6 7 8 9\
            </DataArray><DataArray type=\"Float64\" Name=\"h\">0.5 0.25 2</DataArray></PointData>\n\
            <Points><DataArray type=\"Float64\">0 0 0 1 0 0 0 1 0</DataArray></Points>\n<Cells>\n\
            <DataArray type=\"Int32\" Name=\"connectivity\">0 1 2</DataArray>\n\
            <DataArray type=\"Int32\" Name=\"offsets\">3</DataArray>\n\
            <DataArray type=\"Int32\" Name=\"types\">5</DataArray>\n</Cells></Piece>\n\
            </UnstructuredGrid>\n</VTKFile>\n";
        let data = read_node_data(text.as_bytes(), NodeDataForm::Vtu).unwrap();
        assert_eq!(data.values, [0.5, 0.25, 2.0]);
        let without = text.replace("PointData", "FieldData");
        assert!(read_node_data(without.as_bytes(), NodeDataForm::Vtu).is_err());
    }
}
