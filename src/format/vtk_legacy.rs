//! VTK's legacy files (`.vtk`): unstructured grids and polygonal data, ASCII or binary.
//!
//! Source: "VTK File Formats", the simple legacy formats, with the offsets and connectivity arrays
//! of version 5.1. Numbers of binary files are big-endian.

use crate::format::ReadOptions;
use crate::format::assemble::Assembler;
use crate::format::error::{ReadError, ReadFault};
use crate::format::scalar::Scalar;
use crate::format::scan::{Endian, Scanner};
use crate::format::text::TextOut;
use crate::format::view::MeshView;
use crate::format::vtk_cell::{
    Cells, LINE, MARKER_ARRAYS, POLYGON, QUADRILATERAL, REGION_ARRAYS, TRIANGLE,
};
use crate::mesh::MeshData;
use std::io;

/// Reads a legacy VTK file.
///
/// # Errors
/// The first fault with its line, or its byte offset when the file is binary.
pub fn read(bytes: &[u8], options: &ReadOptions) -> Result<MeshData, ReadError> {
    let mut scanner = Scanner::new(bytes);
    let is_binary = read_header(&mut scanner)?;
    let mut reader = VtkReader {
        scanner,
        is_binary,
        mesh: Assembler::new(0, options.split_quads),
        cells: Cells::default(),
        has_points: false,
        has_cells: false,
        cell_data: None,
    };
    while !reader.scanner.is_at_end() {
        reader.section()?;
    }
    reader.finish()
}

/// The three lines before the data; whether numbers are binary.
fn read_header(scanner: &mut Scanner) -> Result<bool, ReadError> {
    if scanner.is_at_end() {
        return Err(scanner.malformed("`# vtk DataFile Version`", b""));
    }
    let first = scanner.rest_of_line();
    if !first.to_ascii_lowercase().starts_with(b"# vtk datafile version") {
        return Err(scanner.malformed("`# vtk DataFile Version`", first));
    }
    scanner.rest_of_line();
    match scanner.token("ASCII or BINARY")?.to_ascii_uppercase().as_slice() {
        b"ASCII" => Ok(false),
        b"BINARY" => {
            scanner.rest_of_line();
            scanner.set_binary();
            Ok(true)
        }
        other => Err(scanner.malformed("ASCII or BINARY", other)),
    }
}

struct VtkReader<'a> {
    scanner: Scanner<'a>,
    is_binary: bool,
    mesh: Assembler,
    cells: Cells,
    has_points: bool,
    has_cells: bool,
    /// Number of values of the arrays at hand, and whether they belong to cells.
    cell_data: Option<(usize, bool)>,
}

impl VtkReader<'_> {
    /// A keyword, in lower case.
    fn keyword(&mut self) -> Result<String, ReadError> {
        let token = self.scanner.token("a keyword such as `POINTS`")?;
        Ok(String::from_utf8_lossy(token).to_ascii_lowercase())
    }

    fn section(&mut self) -> Result<(), ReadError> {
        let keyword = self.keyword()?;
        match keyword.as_str() {
            "dataset" => self.dataset(),
            "points" => self.points(),
            "cells" => self.cell_lists(None),
            "vertices" => self.cell_lists(Some((1, 2))),
            "lines" => self.cell_lists(Some((LINE, 4))),
            "polygons" => self.cell_lists(Some((POLYGON, POLYGON))),
            "triangle_strips" => self.cell_lists(Some((6, 6))),
            "cell_types" => self.cell_types(),
            "metadata" => {
                self.metadata();
                Ok(())
            }
            "cell_data" | "point_data" => {
                let count = self.scanner.count("values of an array", 0)?;
                self.cell_data = Some((count, keyword == "cell_data"));
                Ok(())
            }
            _ => self.attribute(&keyword),
        }
    }

    fn dataset(&mut self) -> Result<(), ReadError> {
        match self.keyword()?.as_str() {
            "unstructured_grid" | "polydata" => Ok(()),
            other => {
                let what = format!("a dataset of type `{}`", other.escape_debug());
                Err(self.scanner.unsupported(what, "save it as an unstructured grid"))
            }
        }
    }

    /// The type of an array.
    fn scalar(&mut self) -> Result<Scalar, ReadError> {
        let name = self.keyword()?;
        Scalar::from_vtk_name(&name).ok_or_else(|| {
            self.scanner.malformed("a number type such as `double`", name.as_bytes())
        })
    }

    /// Goes to the values of an array: binary ones start on the next line.
    fn start_values(&mut self) {
        if self.is_binary {
            self.scanner.rest_of_line();
        }
    }

    /// Skips an array of strings: a line each as text, else a length and bytes each.
    fn skip_strings(&mut self, count: u64) -> Result<(), ReadError> {
        self.scanner.rest_of_line();
        let count = self.check(Scalar::U8, "strings", count.saturating_mul(2))? / 2;
        for _ in 0..count {
            if !self.is_binary {
                self.scanner.rest_of_line();
                continue;
            }
            // The two highest bits say how many bytes the length takes.
            let expected = "the length of a string";
            let first = self.scanner.rest().first().copied().unwrap_or(0);
            let (scalar, mask) = match first >> 6 {
                3 => (Scalar::U8, 0x3f),
                2 => (Scalar::U16, 0x3fff),
                1 => (Scalar::U32, 0x3fff_ffff),
                _ => (Scalar::U64, i64::MAX),
            };
            let bytes = self.scanner.take(scalar.size(), expected)?;
            let length = scalar.integer(bytes, Endian::Big) & mask;
            let length = self.scanner.check_count("characters of a string", length, 1)?;
            self.scanner.take(length, "a string")?;
        }
        Ok(())
    }

    /// Checks that `count` values can follow.
    fn check(&self, scalar: Scalar, what: &'static str, count: u64) -> Result<usize, ReadError> {
        let bytes_each = if self.is_binary { scalar.size() } else { 2 };
        let declared = i64::try_from(count).unwrap_or(i64::MAX);
        self.scanner.check_count(what, declared, bytes_each)
    }

    fn integers(
        &mut self,
        scalar: Scalar,
        what: &'static str,
        count: u64,
    ) -> Result<Vec<i64>, ReadError> {
        self.start_values();
        let count = self.check(scalar, what, count)?;
        if self.is_binary {
            let bytes = self.scanner.take(count * scalar.size(), what)?;
            return Ok(scalar.integers(bytes, Endian::Big));
        }
        (0..count).map(|_| self.scanner.integer("an integer")).collect()
    }

    /// Skips the values of an array.
    fn skip_values(&mut self, scalar: Scalar, count: u64) -> Result<(), ReadError> {
        self.start_values();
        let count = self.check(scalar, "values of an array", count)?;
        if self.is_binary {
            return self.scanner.take(count * scalar.size(), "the values of an array").map(drop);
        }
        (0..count).try_for_each(|_| self.scanner.token("the values of an array").map(drop))
    }

    fn points(&mut self) -> Result<(), ReadError> {
        if self.has_points {
            return Err(self.scanner.malformed("one list of points", b"POINTS"));
        }
        self.has_points = true;
        let count = self.scanner.count("points", 3)?;
        let scalar = self.scalar()?;
        self.start_values();
        self.check(scalar, "coordinates", 3 * count as u64)?;
        self.mesh.reserve_points(count);
        if self.is_binary {
            let bytes = self.scanner.take(3 * count * scalar.size(), "the coordinates")?;
            for &point in scalar.floats(bytes, Endian::Big).as_chunks::<3>().0 {
                self.mesh.point(point, None);
            }
            return Ok(());
        }
        for _ in 0..count {
            self.scanner.skip_blank();
            let line = self.scanner.line();
            let point = self.scanner.point(3)?;
            self.mesh.point(point, line);
        }
        Ok(())
    }

    /// A list of cells. `types` are the codes of a cell with the fewest corners and with more; in an
    /// unstructured grid `CELL_TYPES` says them.
    fn cell_lists(&mut self, types: Option<(i64, i64)>) -> Result<(), ReadError> {
        self.has_cells = true;
        let first = self.scanner.integer("the number of cells")?;
        let second = self.scanner.integer("the size of the list of cells")?;
        let mut peek = self.scanner.clone();
        let (corners, ends) = if peek.token("cells").is_ok_and(|word| word == b"OFFSETS") {
            self.offsets_and_connectivity(first, second)?
        } else {
            self.counted_cells(first, second)?
        };
        let base = self.cells.connectivity.len() as i64;
        let mut start = 0;
        for end in ends {
            if let Some((few, more)) = types {
                let length = end.saturating_sub(start);
                let is_few = length == if few == LINE { 2 } else { 1 };
                self.cells.types.push(if is_few { few } else { more });
            }
            start = end;
            self.cells.ends.push(base.saturating_add(end));
        }
        self.cells.connectivity.extend(corners);
        Ok(())
    }

    /// Version 5.1: `first` offsets, one more than cells, and `second` corners.
    fn offsets_and_connectivity(
        &mut self,
        first: i64,
        second: i64,
    ) -> Result<(Vec<i64>, Vec<i64>), ReadError> {
        let count = |scanner: &Scanner, what, count| scanner.check_count(what, count, 1);
        let offsets = count(&self.scanner, "offsets of cells", first)? as u64;
        let corners = count(&self.scanner, "corners of cells", second)? as u64;
        self.scanner.expect("OFFSETS")?;
        let scalar = self.scalar()?;
        let mut ends = self.integers(scalar, "offsets of cells", offsets)?;
        self.scanner.expect("CONNECTIVITY")?;
        let scalar = self.scalar()?;
        let corners = self.integers(scalar, "corners of cells", corners)?;
        if !ends.is_empty() {
            ends.remove(0);
        }
        Ok((corners, ends))
    }

    /// `cells` times: a count and as many corners; `size` integers in all.
    fn counted_cells(&mut self, cells: i64, size: i64) -> Result<(Vec<i64>, Vec<i64>), ReadError> {
        let cells = self.scanner.check_count("cells", cells, 2)?;
        let size = self.scanner.check_count("integers of cells", size, 2)?;
        let values = self.integers(Scalar::I32, "integers of cells", size as u64)?;
        let mut corners = Vec::with_capacity(size.saturating_sub(cells));
        let mut ends = Vec::with_capacity(cells);
        let mut rest = values.as_slice();
        while let Some((&count, after)) = rest.split_first() {
            let cell = usize::try_from(count).ok().and_then(|count| after.split_at_checked(count));
            let Some((cell, after)) = cell else {
                let found = count.to_string();
                let expected = "a number of corners within the list of cells";
                return Err(self.scanner.malformed(expected, found.as_bytes()));
            };
            corners.extend_from_slice(cell);
            ends.push(corners.len() as i64);
            rest = after;
        }
        if ends.len() != cells {
            let (declared, present) = (cells as i64, ends.len() as u64);
            return Err(self.scanner.fail(ReadFault::Mismatch {
                what: "cells",
                declared,
                present,
            }));
        }
        Ok((corners, ends))
    }

    fn cell_types(&mut self) -> Result<(), ReadError> {
        let count = self.scanner.count("cell types", 1)?;
        self.cells.types = self.integers(Scalar::I32, "cell types", count as u64)?;
        Ok(())
    }

    /// Information about arrays, up to an empty line.
    fn metadata(&mut self) {
        self.scanner.rest_of_line();
        while !self.scanner.rest().is_empty() && !self.scanner.rest_of_line().is_empty() {}
    }

    /// An array of `CELL_DATA` or `POINT_DATA`, or a field before them.
    fn attribute(&mut self, keyword: &str) -> Result<(), ReadError> {
        let count = self.cell_data.map_or(0, |data| data.0) as u64;
        if keyword == "field" {
            return self.field();
        }
        let name = self.scanner.token("the name of an array")?.to_vec();
        let components = match keyword {
            "scalars" => return self.scalars(&name, count),
            "lookup_table" => {
                let size = self.scanner.count("colours", 0)? as u64;
                return self.skip_colours(4 * size);
            }
            "color_scalars" => {
                let components = self.scanner.count("colour components", 0)? as u64;
                return self.skip_colours(components.saturating_mul(count));
            }
            "texture_coordinates" => self.scanner.count("texture coordinates", 0)? as u64,
            "vectors" | "normals" => 3,
            "tensors" => 9,
            "global_ids" | "pedigree_ids" => 1,
            _ => {
                let expected = "a keyword such as `POINTS`, `CELLS` or `CELL_DATA`";
                return Err(self.scanner.malformed(expected, keyword.as_bytes()));
            }
        };
        let scalar = self.scalar()?;
        self.skip_values(scalar, count.saturating_mul(components))
    }

    /// Colours are bytes in binary files, decimals in text.
    fn skip_colours(&mut self, count: u64) -> Result<(), ReadError> {
        self.skip_values(Scalar::U8, count)
    }

    fn scalars(&mut self, name: &[u8], count: u64) -> Result<(), ReadError> {
        let scalar = self.scalar()?;
        let components = self.scanner.integer_on_line("the number of components")?.unwrap_or(1);
        let components = self.scanner.check_count("components", components, 1)? as u64;
        let mut peek = self.scanner.clone();
        if peek.token("values").is_ok_and(|word| word.eq_ignore_ascii_case(b"LOOKUP_TABLE")) {
            self.scanner.token("`LOOKUP_TABLE`")?;
            self.scanner.token("the name of a lookup table")?;
        }
        self.array(name, scalar, count.saturating_mul(components))
    }

    /// `FIELD name n`, then n times `name components tuples type` and the values.
    fn field(&mut self) -> Result<(), ReadError> {
        self.scanner.token("the name of a field")?;
        let arrays = self.scanner.count("arrays of a field", 8)?;
        for _ in 0..arrays {
            let mut name = self.scanner.token("the name of an array")?.to_vec();
            while name == b"METADATA" {
                self.metadata();
                name = self.scanner.token("the name of an array")?.to_vec();
            }
            let components = self.scanner.count("components", 0)? as u64;
            let tuples = self.scanner.count("values of an array", 0)? as u64;
            let count = components.saturating_mul(tuples);
            if self.scanner.peek() == b"string" {
                self.skip_strings(count)?;
                continue;
            }
            let scalar = self.scalar()?;
            self.array(&name, scalar, count)?;
        }
        Ok(())
    }

    /// Keeps the array if it marks cells.
    fn array(&mut self, name: &[u8], scalar: Scalar, count: u64) -> Result<(), ReadError> {
        let rank = |names: &[&[u8]]| names.iter().position(|known| *known == name);
        let ranks = (rank(&REGION_ARRAYS), rank(&MARKER_ARRAYS));
        let is_cell_data = self.cell_data == usize::try_from(count).ok().map(|count| (count, true));
        if ranks == (None, None) || !is_cell_data || !scalar.is_integer() {
            return self.skip_values(scalar, count);
        }
        let values = self.integers(scalar, "values of an array", count)?;
        if ranks.0 == Some(0) || (ranks.0.is_some() && self.cells.regions.is_empty()) {
            self.cells.regions.clone_from(&values);
        }
        if ranks.1 == Some(0) || (ranks.1.is_some() && self.cells.markers.is_empty()) {
            self.cells.markers = values;
        }
        Ok(())
    }

    fn finish(mut self) -> Result<MeshData, ReadError> {
        if !self.has_points || !self.has_cells {
            let missing = if self.has_points { "the cells" } else { "the points" };
            return Err(self.scanner.malformed(missing, b""));
        }
        if self.cells.types.len() != self.cells.ends.len() {
            let (what, present) = ("cells", self.cells.types.len() as u64);
            let declared = self.cells.ends.len() as i64;
            return Err(self.scanner.fail(ReadFault::Mismatch { what, declared, present }));
        }
        let result = self.cells.assemble(&mut self.mesh, 0);
        result.map_err(|expected| {
            let found = "another number of corners".to_owned();
            let expected = expected.to_owned();
            self.scanner.fail(ReadFault::Malformed { expected, found })
        })?;
        self.mesh.finish(&self.scanner)
    }
}

/// Writes a legacy VTK file of version 2.0, which every reader knows: triangles, then marked edges
/// as lines, with the cell arrays `region` and `marker`.
pub(crate) fn write(mesh: MeshView, is_binary: bool, out: &mut TextOut) -> io::Result<()> {
    let mut out = Out { out, is_binary };
    let (faces, quads, edges) = (mesh.face_count(), mesh.quad_count(), mesh.edges());
    let cells = faces + edges.len();
    let encoding = if is_binary { "BINARY" } else { "ASCII" };
    out.line(&format!("# vtk DataFile Version 2.0\ntriangulation\n{encoding}"))?;
    out.line("DATASET UNSTRUCTURED_GRID")?;
    out.line(&format!("POINTS {} double", mesh.point_count()))?;
    for point in mesh.points() {
        out.point(point)?;
    }
    out.end(&format!("CELLS {cells} {}", mesh.corner_count() + faces + 3 * edges.len()))?;
    for face in mesh.faces() {
        let corners = face.corners().len();
        let mut row = [corners as i32; 5];
        row[1..].iter_mut().zip(face.corners()).for_each(|(slot, &v)| *slot = v as i32);
        out.integers(&row[..=corners])?;
    }
    for edge in edges {
        out.integers(&[2, edge.vertices[0] as i32, edge.vertices[1] as i32])?;
    }
    let kind = |index: usize| match index {
        index if index < quads => QUADRILATERAL,
        index if index < faces => TRIANGLE,
        _ => LINE,
    };
    out.end(&format!("CELL_TYPES {cells}"))?;
    for index in 0..cells {
        out.integers(&[kind(index) as i32])?;
    }
    out.end(&format!("CELL_DATA {cells}\nFIELD FieldData 2\nregion 1 {cells} int"))?;
    for index in 0..cells {
        out.integers(&[if index < faces { mesh.face_region(index, 0) } else { 0 }])?;
    }
    out.end(&format!("marker 1 {cells} int"))?;
    for index in 0..cells {
        let edge = index.checked_sub(faces).map(|index| edges[index]);
        out.integers(&[edge.map_or(0, |edge| edge.marker)])?;
    }
    let uv = mesh.parameters();
    if !uv.is_empty() {
        let count = uv.len();
        out.end(&format!("POINT_DATA {count}\nFIELD FieldData 1\nuv 2 {count} double"))?;
        uv.iter().try_for_each(|&pair| out.pair(pair))?;
    }
    if is_binary { out.line("") } else { Ok(()) }
}

struct Out<'o, 'w> {
    out: &'o mut TextOut<'w>,
    is_binary: bool,
}

impl Out<'_, '_> {
    fn line(&mut self, text: &str) -> io::Result<()> {
        self.out.text(text)?;
        self.out.bytes(b"\n")
    }

    /// Ends binary values and starts the next section.
    fn end(&mut self, text: &str) -> io::Result<()> {
        if self.is_binary {
            self.out.bytes(b"\n")?;
        }
        self.line(text)
    }

    fn pair(&mut self, [u, v]: [f64; 2]) -> io::Result<()> {
        if self.is_binary {
            return [u, v].iter().try_for_each(|c| self.out.bytes(&c.to_be_bytes()));
        }
        self.out.float(u, b' ')?;
        self.out.float(v, b'\n')
    }

    fn point(&mut self, [x, y, z]: [f64; 3]) -> io::Result<()> {
        if self.is_binary {
            return [x, y, z].iter().try_for_each(|c| self.out.bytes(&c.to_be_bytes()));
        }
        self.out.float(x, b' ')?;
        self.out.float(y, b' ')?;
        self.out.float(z, b'\n')
    }

    fn integers(&mut self, values: &[i32]) -> io::Result<()> {
        if self.is_binary {
            return values.iter().try_for_each(|value| self.out.bytes(&value.to_be_bytes()));
        }
        for (index, &value) in values.iter().enumerate() {
            let end = if index + 1 == values.len() { b'\n' } else { b' ' };
            self.out.integer(i64::from(value), end)?;
        }
        Ok(())
    }
}
