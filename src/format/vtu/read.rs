//! Reading VTU files.
//!
//! XML entities are not expanded and document type declarations are refused, so no text grows by
//! being read (SPEC X26).

use crate::format::ReadOptions;
use crate::format::assemble::Assembler;
use crate::format::error::{At, ReadError, ReadFault};
use crate::format::scalar::Scalar;
use crate::format::scan::{Endian, Scanner, excerpt};
use crate::format::vtk_cell::{self, Cells};
use crate::format::vtu::data::{
    Array, Coding, Compression, Decoder, Source, expansion_limit, place,
};
use crate::mesh::MeshData;
use memchr::{memchr, memmem};
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

/// Reads a VTU file: ASCII, base64 or appended (raw or base64), compressed by zlib or not, of either
/// byte order; pieces follow each other.
///
/// # Errors
/// The first fault with its line, or its byte offset within raw data.
pub fn read(bytes: &[u8], options: &ReadOptions) -> Result<MeshData, ReadError> {
    let outline = Outline::read(bytes)?;
    let left = expansion_limit(bytes.len());
    let mut decoder = Decoder { bytes, coding: outline.coding, left, digits: None };
    let mut mesh = Assembler::new(0, options.split_quads);
    let mut first_cell = 0;
    for piece in &outline.pieces {
        read_piece(&mut decoder, piece, first_cell, &mut mesh)?;
        first_cell += piece.cells as i64;
    }
    let mut data = mesh.finish(&Scanner::new(bytes))?;
    data.decimal_digits = decoder.digits;
    Ok(data)
}

/// Reads a VTU file and its first array of floats of one component at the points.
///
/// # Errors
/// As [`read`], and where a piece has no such array.
pub(crate) fn read_point_data(bytes: &[u8]) -> Result<(MeshData, Vec<f64>), ReadError> {
    let options = ReadOptions { split_quads: true, ..ReadOptions::default() };
    let mesh = read(bytes, &options)?;
    let outline = Outline::read(bytes)?;
    let left = expansion_limit(bytes.len());
    let mut decoder = Decoder { bytes, coding: outline.coding, left, digits: None };
    let mut values = Vec::new();
    for piece in outline.pieces.iter().filter(|piece| piece.points > 0) {
        let Some(array) = piece.point_array else {
            let expected = "an array of floats of one component in `PointData`".to_owned();
            let fault = ReadFault::Malformed { expected, found: String::new() };
            return Err(ReadError { file: "", at: place(bytes, piece.offset), fault });
        };
        values.extend(decoder.floats(array, "values at points", piece.points)?);
    }
    Ok((mesh, values))
}

fn read_piece(
    decoder: &mut Decoder,
    piece: &Piece,
    first_cell: i64,
    mesh: &mut Assembler,
) -> Result<(), ReadError> {
    let bytes = decoder.bytes;
    let missing = |expected: &str| {
        let fault = ReadFault::Malformed { expected: expected.to_owned(), found: String::new() };
        ReadError { file: "", at: place(bytes, piece.offset), fault }
    };
    let (points, cells) = (piece.points, piece.cells);
    let array = match piece.coordinates {
        Some(array) => Some(array),
        None if points == 0 => None,
        None => return Err(missing("a DataArray of points")),
    };
    let first_point = mesh.point_count();
    if let Some(array) = array {
        let values = decoder.floats(array, "coordinates", points.saturating_mul(3))?;
        mesh.reserve_points(values.len() / 3);
        for &point in values.as_chunks::<3>().0 {
            mesh.point(point, None);
        }
    }
    if mesh.point_count() >= u32::MAX as usize {
        return Err(missing("fewer than 2^32 points"));
    }
    mesh.window(first_point, mesh.point_count() - first_point);
    if cells == 0 {
        return Ok(());
    }
    let array = |name: &str| {
        let array = piece.array(name.as_bytes());
        array.ok_or_else(|| missing(&format!("the array `{name}` of cells")))
    };
    let ends = decoder.integers(array("offsets")?, "offsets", cells)?;
    let corners = u64::try_from(ends.last().copied().unwrap_or(0));
    let corners = corners.map_err(|_| missing("offsets that are not negative"))?;
    let cells = Cells {
        connectivity: decoder.integers(array("connectivity")?, "corners of cells", corners)?,
        ends,
        types: decoder.integers(array("types")?, "types", cells)?,
        regions: piece.markers(decoder, &vtk_cell::REGION_ARRAYS)?,
        markers: piece.markers(decoder, &vtk_cell::MARKER_ARRAYS)?,
    };
    cells.assemble(mesh, first_cell).map_err(missing)
}

/// A `Piece` element.
#[derive(Debug)]
struct Piece {
    /// Where it stands in the file.
    offset: usize,
    points: u64,
    cells: u64,
    coordinates: Option<Array>,
    /// The first array of floats of one component in `PointData`.
    point_array: Option<Array>,
    /// The arrays of `Cells` and `CellData` by name.
    arrays: Vec<(Vec<u8>, Array)>,
}

impl Piece {
    fn array(&self, name: &[u8]) -> Option<Array> {
        self.arrays.iter().find(|entry| entry.0 == name).map(|entry| entry.1)
    }

    /// The first integer array with one of these names; empty when there is none.
    fn markers(&self, decoder: &mut Decoder, names: &[&[u8]]) -> Result<Vec<i64>, ReadError> {
        let array = names.iter().find_map(|name| self.array(name));
        match array.filter(|array| array.scalar.is_integer()) {
            Some(array) => decoder.integers(array, "cell markers", self.cells),
            None => Ok(Vec::new()),
        }
    }
}

/// Which element the arrays belong to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Section {
    Points,
    Cells,
    PointData,
    Other,
}

/// What the XML of a file says, without the values of its arrays.
struct Outline {
    coding: Coding,
    pieces: Vec<Piece>,
}

/// Reads the XML.
struct OutlineReader<'a> {
    bytes: &'a [u8],
    xml: Reader<&'a [u8]>,
    coding: Option<Coding>,
    pieces: Vec<Piece>,
    section: Section,
    /// Start of appended data and whether it is raw.
    appended: Option<(usize, bool)>,
    is_closed: bool,
}

impl Outline {
    fn read(bytes: &[u8]) -> Result<Self, ReadError> {
        let mut reader = OutlineReader {
            bytes,
            xml: Reader::from_reader(bytes),
            coding: None,
            pieces: Vec::new(),
            section: Section::Other,
            appended: None,
            is_closed: false,
        };
        while reader.next()? {}
        reader.finish()
    }
}

impl<'a> OutlineReader<'a> {
    fn position(&self) -> usize {
        self.xml.buffer_position() as usize
    }

    #[cold]
    fn fail(&self, fault: ReadFault) -> ReadError {
        let offset = (self.xml.error_position() as usize).max(self.position());
        ReadError { file: "", at: place(self.bytes, offset), fault }
    }

    #[cold]
    fn malformed(&self, expected: &str, found: &[u8]) -> ReadError {
        let (expected, found) = (expected.to_owned(), excerpt(found));
        self.fail(ReadFault::Malformed { expected, found })
    }

    #[cold]
    fn unsupported(&self, what: &str, advice: &'static str) -> ReadError {
        self.fail(ReadFault::Unsupported { what: what.to_owned(), advice })
    }

    /// Reads one event; false at the end, or where raw data starts.
    fn next(&mut self) -> Result<bool, ReadError> {
        let event = match self.xml.read_event() {
            Ok(event) => event,
            Err(error) => {
                let text = error.to_string();
                return Err(self.malformed("well-formed XML", text.as_bytes()));
            }
        };
        match event {
            Event::Start(element) => return self.element(&element, false),
            Event::Empty(element) => return self.element(&element, true),
            Event::End(element) => self.is_closed |= element.name().as_ref() == b"VTKFile",
            Event::DocType(_) => {
                return Err(self.unsupported("a document type declaration", "remove it"));
            }
            Event::Eof => return Ok(false),
            _ => {}
        }
        Ok(true)
    }

    fn element(&mut self, element: &BytesStart, is_empty: bool) -> Result<bool, ReadError> {
        match element.name().as_ref() {
            b"VTKFile" => self.coding = Some(self.file(element)?),
            _ if self.coding.is_none() => {
                return Err(self.malformed("the element `VTKFile`", element));
            }
            b"Piece" => self.piece(element)?,
            b"Points" => self.section = Section::Points,
            b"Cells" | b"CellData" => self.section = Section::Cells,
            b"PointData" => self.section = Section::PointData,
            b"FieldData" => self.section = Section::Other,
            b"DataArray" => self.data_array(element, is_empty)?,
            b"AppendedData" => return self.appended_data(element),
            _ => {}
        }
        Ok(true)
    }

    /// The value of an attribute, not unescaped: none that matters here has an escape.
    fn attribute(&self, element: &BytesStart, name: &str) -> Result<Option<Vec<u8>>, ReadError> {
        match element.try_get_attribute(name) {
            Ok(attribute) => Ok(attribute.map(|attribute| attribute.value.into_owned())),
            Err(error) => {
                Err(self.malformed("well-formed attributes", error.to_string().as_bytes()))
            }
        }
    }

    fn count(&self, element: &BytesStart, name: &str) -> Result<u64, ReadError> {
        let value = self.attribute(element, name)?.unwrap_or_default();
        let text = std::str::from_utf8(&value).unwrap_or_default();
        text.trim().parse().map_err(|_| self.malformed(&format!("a count {name}"), &value))
    }

    fn file(&self, element: &BytesStart) -> Result<Coding, ReadError> {
        let kind = self.attribute(element, "type")?.unwrap_or_default();
        if kind != b"UnstructuredGrid" {
            let what = format!("a VTK file of type `{}`", excerpt(&kind));
            return Err(self.unsupported(&what, "save it as an UnstructuredGrid"));
        }
        let endian = match self.attribute(element, "byte_order")?.as_deref() {
            Some(b"LittleEndian") | None => Endian::Little,
            Some(b"BigEndian") => Endian::Big,
            Some(other) => return Err(self.malformed("LittleEndian or BigEndian", other)),
        };
        let header = match self.attribute(element, "header_type")?.as_deref() {
            Some(b"UInt32") | None => Scalar::U32,
            Some(b"UInt64") => Scalar::U64,
            Some(other) => return Err(self.malformed("header_type UInt32 or UInt64", other)),
        };
        let compression = match self.attribute(element, "compressor")?.as_deref() {
            None | Some(b"") => Compression::None,
            Some(b"vtkZLibDataCompressor") => Compression::Zlib,
            // ASCII arrays of such a file can be read all the same.
            Some(_) => Compression::Other,
        };
        Ok(Coding { endian, header, compression })
    }

    fn piece(&mut self, element: &BytesStart) -> Result<(), ReadError> {
        self.section = Section::Other;
        self.pieces.push(Piece {
            offset: self.position(),
            points: self.count(element, "NumberOfPoints")?,
            cells: self.count(element, "NumberOfCells")?,
            coordinates: None,
            point_array: None,
            arrays: Vec::new(),
        });
        Ok(())
    }

    fn data_array(&mut self, element: &BytesStart, is_empty: bool) -> Result<(), ReadError> {
        let start = self.position();
        let mut end = start;
        if !is_empty {
            let span = self.xml.read_to_end(element.name()).map_err(|error| {
                self.malformed("the end of a DataArray", error.to_string().as_bytes())
            })?;
            // VTK puts `InformationKey` elements after the values.
            let content = &self.bytes[start..span.end as usize];
            end = start + memchr(b'<', content).unwrap_or(content.len());
        }
        let is_vector = !matches!(
            self.attribute(element, "NumberOfComponents")?.as_deref(),
            None | Some(b"1" | b"0" | b"")
        );
        if self.section == Section::Other || self.section == Section::PointData && is_vector {
            return Ok(());
        }
        let source = match self.attribute(element, "format")?.as_deref() {
            Some(b"ascii") | None => Source::Ascii { start, end },
            Some(b"binary") => Source::Base64 { start, end },
            // The place of appended data is known at the end: until then, offsets from its start.
            Some(b"appended") => {
                let offset = self.count(element, "offset")?;
                let start = usize::try_from(offset).unwrap_or(usize::MAX);
                Source::Raw { start, end: 0 }
            }
            Some(other) => return Err(self.malformed("ascii, binary or appended", other)),
        };
        let name = self.attribute(element, "type")?.unwrap_or_default();
        // Cell data may be of types, such as String, that matter only where they are asked for.
        let Some(scalar) = Scalar::from_vtu_name(&name) else {
            return match self.section {
                Section::Points => Err(self.malformed("a number type such as Float64", &name)),
                _ => Ok(()),
            };
        };
        let (section, name) = (self.section, self.attribute(element, "Name")?.unwrap_or_default());
        let Some(piece) = self.pieces.last_mut() else {
            return Err(self.malformed("the element `Piece` before arrays", element));
        };
        let array = Array { scalar, source };
        match section {
            Section::Points => piece.coordinates = Some(array),
            Section::PointData if scalar.is_integer() => {}
            Section::PointData => {
                piece.point_array.get_or_insert(array);
            }
            _ => piece.arrays.push((name, array)),
        }
        Ok(())
    }

    /// Data after the XML: starts after an underscore.
    fn appended_data(&mut self, element: &BytesStart) -> Result<bool, ReadError> {
        let is_raw = match self.attribute(element, "encoding")?.as_deref() {
            Some(b"raw") => true,
            Some(b"base64") | None => false,
            Some(other) => return Err(self.malformed("the encoding raw or base64", other)),
        };
        let rest = &self.bytes[self.position()..];
        let blank = rest.iter().take_while(|byte| byte.is_ascii_whitespace()).count();
        if rest.get(blank) != Some(&b'_') {
            return Err(self.malformed("`_` before appended data", &rest[blank..]));
        }
        self.appended = Some((self.position() + blank + 1, is_raw));
        // Raw bytes are no XML: the end tags are looked for from the back.
        self.is_closed = self.bytes.trim_ascii_end().ends_with(b"</VTKFile>");
        Ok(false)
    }

    /// Gives appended arrays their places.
    fn finish(mut self) -> Result<Outline, ReadError> {
        let Some(coding) = self.coding.filter(|_| self.is_closed) else {
            let expected = "the end tag `</VTKFile>`".to_owned();
            let at = place(self.bytes, self.bytes.len());
            return Err(ReadError { file: "", at, fault: ReadFault::Truncated { expected } });
        };
        let (bytes, appended) = (self.bytes, self.appended);
        let data_end = appended.and_then(|_| memmem::rfind(bytes, b"</AppendedData>"));
        for piece in &mut self.pieces {
            let arrays = piece.arrays.iter_mut().map(|entry| &mut entry.1);
            for array in arrays.chain(&mut piece.coordinates).chain(&mut piece.point_array) {
                let Source::Raw { start: offset, .. } = array.source else { continue };
                array.source = appended
                    .zip(data_end)
                    .and_then(|((data, is_raw), end)| {
                        let start = data.checked_add(offset).filter(|&start| start <= end)?;
                        let raw = Source::Raw { start, end };
                        Some(if is_raw { raw } else { Source::Base64 { start, end } })
                    })
                    .ok_or_else(|| {
                        let expected = format!("appended data at offset {offset}");
                        let at = At::Byte(bytes.len() as u64);
                        ReadError { file: "", at, fault: ReadFault::Truncated { expected } }
                    })?;
            }
        }
        Ok(Outline { coding, pieces: self.pieces })
    }
}
