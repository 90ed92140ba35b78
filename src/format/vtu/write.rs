//! Writing VTU files.

use crate::format::Encoding;
use crate::format::text::TextOut;
use crate::format::view::{Face, MeshView};
use crate::format::vtk_cell::{LINE, QUADRILATERAL, TRIANGLE};
use base64::engine::general_purpose::STANDARD;
use base64::write::EncoderWriter;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesEnd, BytesStart, Event};
use std::io::{self, BufWriter, Write};

/// Bytes that are compressed at a time: VTK allows any number, and suggests 32 KiB.
const BLOCK_BYTES: usize = 1 << 18;

/// A number of a data array.
trait Value: Copy {
    /// VTK's name of the type.
    const TYPE: &'static str;
    fn write_text(self, out: &mut TextOut) -> io::Result<()>;
    fn write_bytes(self, out: &mut impl Write) -> io::Result<()>;
}

impl Value for f64 {
    const TYPE: &'static str = "Float64";
    fn write_text(self, out: &mut TextOut) -> io::Result<()> {
        out.float(self, b'\n')
    }
    fn write_bytes(self, out: &mut impl Write) -> io::Result<()> {
        out.write_all(&self.to_le_bytes())
    }
}

macro_rules! impl_integer_value {
    ($type:ty, $name:literal) => {
        impl Value for $type {
            const TYPE: &'static str = $name;
            fn write_text(self, out: &mut TextOut) -> io::Result<()> {
                out.integer(i64::from(self), b'\n')
            }
            fn write_bytes(self, out: &mut impl Write) -> io::Result<()> {
                out.write_all(&self.to_le_bytes())
            }
        }
    };
}

impl_integer_value!(u8, "UInt8");
impl_integer_value!(i32, "Int32");
impl_integer_value!(i64, "Int64");

/// Writes a VTU file.
pub(crate) fn write(mesh: MeshView, encoding: Encoding, out: &mut TextOut) -> io::Result<()> {
    let mut xml = VtuWriter { xml: Writer::new(out), encoding };
    xml.xml.write_event(Event::Decl(BytesDecl::new("1.0", None, None)))?;
    let mut file = BytesStart::new("VTKFile");
    file.push_attribute(("type", "UnstructuredGrid"));
    file.push_attribute(("version", "1.0"));
    file.push_attribute(("byte_order", "LittleEndian"));
    file.push_attribute(("header_type", "UInt64"));
    if encoding == Encoding::Compressed {
        file.push_attribute(("compressor", "vtkZLibDataCompressor"));
    }
    xml.element(file, |xml| xml.element(BytesStart::new("UnstructuredGrid"), |xml| xml.piece(mesh)))
}

struct VtuWriter<'x, 'w> {
    xml: Writer<&'x mut TextOut<'w>>,
    encoding: Encoding,
}

impl VtuWriter<'_, '_> {
    /// An element on lines of its own.
    fn element(
        &mut self,
        start: BytesStart,
        content: impl FnOnce(&mut Self) -> io::Result<()>,
    ) -> io::Result<()> {
        let name = start.name().as_ref().to_vec();
        let name = String::from_utf8_lossy(&name);
        self.xml.get_mut().bytes(b"\n")?;
        self.xml.write_event(Event::Start(start))?;
        content(self)?;
        self.xml.get_mut().bytes(b"\n")?;
        self.xml.write_event(Event::End(BytesEnd::new(name)))
    }

    fn piece(&mut self, mesh: MeshView) -> io::Result<()> {
        let cells = mesh.face_count() + mesh.edges().len();
        let mut piece = BytesStart::new("Piece");
        piece.push_attribute(("NumberOfPoints", mesh.point_count().to_string().as_str()));
        piece.push_attribute(("NumberOfCells", cells.to_string().as_str()));
        self.element(piece, |xml| {
            xml.element(BytesStart::new("Points"), |xml| {
                let count = 3 * mesh.point_count();
                xml.data_array("Points", 3, count, || mesh.points().flatten())
            })?;
            xml.element(BytesStart::new("Cells"), |xml| xml.cells(mesh))?;
            xml.element(BytesStart::new("CellData"), |xml| xml.cell_data(mesh))?;
            match mesh.parameters() {
                [] => Ok(()),
                uv => xml.element(BytesStart::new("PointData"), |xml| {
                    xml.data_array("uv", 2, 2 * uv.len(), || uv.iter().copied().flatten())
                }),
            }
        })
    }

    fn cells(&mut self, mesh: MeshView) -> io::Result<()> {
        let (faces, corners, edges) = (mesh.face_count(), mesh.corner_count(), mesh.edges());
        self.data_array("connectivity", 1, corners + 2 * edges.len(), || {
            let ends = edges.iter().flat_map(|edge| edge.vertices);
            let of_face = |face: Face| (0..face.corners().len()).map(move |i| face.corners()[i]);
            mesh.faces().flat_map(of_face).chain(ends).map(i64::from)
        })?;
        let cells = faces + edges.len();
        self.data_array("offsets", 1, cells, || {
            let ends = mesh.faces().scan(0, |end, face| {
                *end += face.corners().len() as i64;
                Some(*end)
            });
            ends.chain((1..=edges.len() as i64).map(move |rank| corners as i64 + 2 * rank))
        })?;
        self.data_array("types", 1, cells, || {
            let quads = mesh.quad_count();
            std::iter::repeat_n(QUADRILATERAL as u8, quads)
                .chain(std::iter::repeat_n(TRIANGLE as u8, faces - quads))
                .chain(std::iter::repeat_n(LINE as u8, edges.len()))
        })
    }

    fn cell_data(&mut self, mesh: MeshView) -> io::Result<()> {
        let (faces, edges) = (mesh.face_count(), mesh.edges());
        let cells = faces + edges.len();
        self.data_array("region", 1, cells, || {
            let of_faces = (0..faces).map(|index| mesh.face_region(index, 0));
            of_faces.chain(std::iter::repeat_n(0, edges.len()))
        })?;
        self.data_array("marker", 1, cells, || {
            let of_edges = edges.iter().map(|edge| edge.marker);
            std::iter::repeat_n(0, faces).chain(of_edges)
        })
    }

    /// A `DataArray` of `count` values.
    fn data_array<T: Value, I: Iterator<Item = T>>(
        &mut self,
        name: &str,
        components: usize,
        count: usize,
        values: impl Fn() -> I,
    ) -> io::Result<()> {
        let mut start = BytesStart::new("DataArray");
        start.push_attribute(("type", T::TYPE));
        start.push_attribute(("Name", name));
        start.push_attribute(("NumberOfComponents", components.to_string().as_str()));
        let format = if self.encoding == Encoding::Ascii { "ascii" } else { "binary" };
        start.push_attribute(("format", format));
        let encoding = self.encoding;
        self.element(start, |xml| {
            let out = xml.xml.get_mut();
            out.bytes(b"\n")?;
            match encoding {
                Encoding::Ascii => values().try_for_each(|value| value.write_text(out)),
                Encoding::Binary => write_base64(count, values(), out),
                Encoding::Compressed => write_compressed(values(), out),
            }
        })
    }
}

/// The number of bytes and the bytes, in one base64 stream.
fn write_base64<T: Value>(
    count: usize,
    values: impl Iterator<Item = T>,
    out: &mut TextOut,
) -> io::Result<()> {
    // The encoder is slow on writes of a few bytes each.
    let mut base64 = BufWriter::new(EncoderWriter::new(out, &STANDARD));
    base64.write_all(&((count * size_of::<T>()) as u64).to_le_bytes())?;
    for value in values {
        value.write_bytes(&mut base64)?;
    }
    base64.into_inner()?.finish().map(drop)
}

/// Number of blocks, bytes of a block and of a shorter last one (or 0), compressed bytes of each,
/// in one base64 stream; the compressed blocks in another.
fn write_compressed<T: Value>(
    values: impl Iterator<Item = T>,
    out: &mut TextOut,
) -> io::Result<()> {
    let mut header = vec![0_u64, BLOCK_BYTES as u64, 0];
    let (mut block, mut data) = (Vec::with_capacity(BLOCK_BYTES), Vec::new());
    for value in values {
        value.write_bytes(&mut block)?;
        if block.len() == BLOCK_BYTES {
            compress_block(&mut block, &mut header, &mut data)?;
        }
    }
    header[2] = block.len() as u64;
    if !block.is_empty() {
        compress_block(&mut block, &mut header, &mut data)?;
    }
    let header: Vec<u8> = header.iter().flat_map(|number| number.to_le_bytes()).collect();
    for bytes in [header, data] {
        let mut base64 = EncoderWriter::new(&mut *out, &STANDARD);
        base64.write_all(&bytes)?;
        base64.finish()?;
    }
    Ok(())
}

fn compress_block(
    block: &mut Vec<u8>,
    header: &mut Vec<u64>,
    data: &mut Vec<u8>,
) -> io::Result<()> {
    let start = data.len();
    let mut encoder = ZlibEncoder::new(&mut *data, Compression::fast());
    encoder.write_all(block)?;
    encoder.finish()?;
    header[0] += 1;
    header.push((data.len() - start) as u64);
    block.clear();
    Ok(())
}
