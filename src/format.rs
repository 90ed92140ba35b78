//! Files: readers and writers of meshes and domains, one file a format.
//!
//! Readers take bytes and return plain arrays; a fault gives an error with its line (or byte) and
//! the rule of `SPEC.md` that it breaks. Nothing is repaired: a reference to a point that does not
//! exist is reported in [`MeshData::bad_references`], a cell that is no triangle is counted in
//! [`MeshData::other_cells`]. Memory is bounded by the size of the input: a declared count is
//! checked against the bytes that follow before anything is allocated.

mod abaqus;
pub mod airfoil;
mod assemble;
pub mod bpt;
mod curve_json;
mod domain_builder;
pub mod domain_file;
pub mod domain_json;
mod domain_json_plain;
mod error;
mod fort14;
pub mod geojson;
pub mod iges;
mod medit;
pub mod mesh_json;
pub mod model_file;
pub mod model_json;
mod msh;
mod msh22;
mod msh41;
pub mod msh_view;
mod netgen_vol;
pub mod node_data;
mod node_ele;
pub mod nurbs_json;
mod obj;
mod off;
mod ply;
pub mod points;
pub mod poly;
mod scalar;
mod scan;
mod sms_2dm;
#[cfg(feature = "step")]
pub mod step;
mod stl;
mod su2;
#[cfg(test)]
mod tests;
mod text;
mod view;
pub mod voronoi_json;
pub mod voronoi_obj;
mod vtk_cell;
mod vtk_legacy;
mod vtu;

pub use error::{At, ReadError, ReadFault, WriteError};
pub use view::MeshView;

use crate::mesh::MeshData;
use std::io::Write;
use std::path::Path;
use text::TextOut;

/// A form of mesh files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum MeshForm {
    /// Gmsh MSH 2.2 or 4.1, ASCII or binary.
    Msh,
    /// Triangle's `.ele` with its `.node` and `.edge`.
    NodeEle,
    /// Geomview OFF.
    Off,
    /// VTK XML unstructured grid.
    Vtu,
    /// VTK legacy file, ASCII or binary.
    VtkLegacy,
    /// Medit `.mesh`, and `.meshb` to be read.
    Medit,
    /// SU2 native mesh.
    Su2,
    /// Wavefront OBJ.
    Obj,
    /// Stanford PLY, ASCII or binary.
    Ply,
    /// STL, ASCII or binary.
    Stl,
    /// Netgen `.vol`; read only.
    NetgenVol,
    /// ADCIRC grid `fort.14`; read only.
    Fort14,
    /// SMS `.2dm`; read only.
    Sms2dm,
    /// Abaqus input file; read only.
    Abaqus,
}

impl std::fmt::Display for MeshForm {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

impl MeshForm {
    /// Every form.
    pub const ALL: [Self; 14] = [
        Self::Msh,
        Self::NodeEle,
        Self::Off,
        Self::Vtu,
        Self::VtkLegacy,
        Self::Medit,
        Self::Su2,
        Self::Obj,
        Self::Ply,
        Self::Stl,
        Self::NetgenVol,
        Self::Fort14,
        Self::Sms2dm,
        Self::Abaqus,
    ];

    /// The form's name, as users know it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Msh => "Gmsh MSH",
            Self::NodeEle => "Triangle .node/.ele",
            Self::Off => "OFF",
            Self::Vtu => "VTU",
            Self::VtkLegacy => "VTK legacy",
            Self::Medit => "Medit",
            Self::Su2 => "SU2",
            Self::Obj => "OBJ",
            Self::Ply => "PLY",
            Self::Stl => "STL",
            Self::NetgenVol => "Netgen .vol",
            Self::Fort14 => "ADCIRC fort.14",
            Self::Sms2dm => "SMS .2dm",
            Self::Abaqus => "Abaqus .inp",
        }
    }

    /// The form of a file with this extension (without the dot, in any case), if it is a mesh's.
    #[must_use]
    pub fn from_extension(extension: &str) -> Option<Self> {
        Some(match extension.to_ascii_lowercase().as_str() {
            "msh" => Self::Msh,
            "ele" => Self::NodeEle,
            "off" => Self::Off,
            "vtu" => Self::Vtu,
            "vtk" => Self::VtkLegacy,
            "mesh" | "meshb" => Self::Medit,
            "su2" => Self::Su2,
            "obj" => Self::Obj,
            "ply" => Self::Ply,
            "stl" => Self::Stl,
            "vol" => Self::NetgenVol,
            "14" | "grd" => Self::Fort14,
            "2dm" => Self::Sms2dm,
            "inp" => Self::Abaqus,
            _ => return None,
        })
    }

    /// The form of a file with this name.
    #[must_use]
    pub fn from_path(path: &Path) -> Option<Self> {
        Self::from_extension(path.extension()?.to_str()?)
    }

    /// The form that the first bytes of a file show, if they show one. Triangle's and ADCIRC's
    /// files start with nothing but numbers or a title, and OBJ files with anything: those are known
    /// by their names only.
    #[must_use]
    pub fn sniff(bytes: &[u8]) -> Option<Self> {
        const STARTS: [(&[u8], MeshForm); 15] = [
            (b"$MeshFormat", MeshForm::Msh),
            (b"$Comments", MeshForm::Msh),
            (b"OFF", MeshForm::Off),
            (b"COFF", MeshForm::Off),
            (b"NOFF", MeshForm::Off),
            (b"<VTKFile", MeshForm::Vtu),
            (b"<?xml", MeshForm::Vtu),
            (b"# vtk DataFile", MeshForm::VtkLegacy),
            (b"MeshVersionFormatted", MeshForm::Medit),
            (b"NDIME", MeshForm::Su2),
            (b"ply", MeshForm::Ply),
            (b"solid", MeshForm::Stl),
            (b"mesh3d", MeshForm::NetgenVol),
            (b"MESH2D", MeshForm::Sms2dm),
            (b"*", MeshForm::Abaqus),
        ];
        let mut text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
        loop {
            if let Some((_, form)) = STARTS.iter().find(|(start, _)| text.starts_with(start)) {
                return Some(*form);
            }
            // Comments may stand before the word that tells.
            if !text.starts_with(b"#") && !text.starts_with(b"%") {
                return None;
            }
            let end = memchr::memchr(b'\n', text)?;
            text = text[end..].trim_ascii_start();
        }
    }

    /// Whether the form is written.
    #[must_use]
    pub const fn is_written(self) -> bool {
        !matches!(self, Self::NetgenVol | Self::Fort14 | Self::Sms2dm | Self::Abaqus)
    }

    /// Whether a file of this form can be written with numbers in this encoding.
    #[must_use]
    pub fn has_encoding(self, encoding: Encoding) -> bool {
        match encoding {
            Encoding::Ascii => self.is_written(),
            Encoding::Binary => {
                matches!(self, Self::Msh | Self::Vtu | Self::VtkLegacy | Self::Ply | Self::Stl)
            }
            Encoding::Compressed => self == Self::Vtu,
        }
    }

    /// Whether a file of this form, as written here, says which edges have which marker.
    #[must_use]
    pub const fn carries_edges(self) -> bool {
        self.is_written() && !matches!(self, Self::Off | Self::Obj | Self::Ply | Self::Stl)
    }

    /// Whether a file of this form, as written here, says which region a triangle is in.
    #[must_use]
    pub const fn carries_regions(self) -> bool {
        self.is_written()
            && !matches!(self, Self::Off | Self::Obj | Self::Ply | Self::Stl | Self::Su2)
    }

    /// The files that a mesh of this form has beside its main one: the caller reads them into
    /// [`ReadOptions`], and writes them with [`write_companion`].
    #[must_use]
    pub const fn companions(self) -> &'static [Companion] {
        match self {
            Self::NodeEle => &[Companion::Nodes, Companion::Edges],
            _ => &[],
        }
    }
}

/// A file beside the main file of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Companion {
    /// Triangle's `.node`: the points. Required; a `.poly` may stand in for it.
    Nodes,
    /// Triangle's `.edge`: marked edges. Optional.
    Edges,
}

impl Companion {
    /// Its extension, without the dot.
    #[must_use]
    pub const fn extension(self) -> &'static str {
        match self {
            Self::Nodes => "node",
            Self::Edges => "edge",
        }
    }
}

/// How to read a mesh.
#[derive(Clone, Copy, Debug, Default)]
pub struct ReadOptions<'a> {
    /// Split each quadrilateral (a, b, c, d) into (a, b, c) and (a, c, d) instead of counting it
    /// among [`MeshData::other_cells`].
    pub split_quads: bool,
    /// The bytes of [`Companion::Nodes`]: a `.node` or `.poly` file.
    pub nodes: Option<&'a [u8]>,
    /// The bytes of [`Companion::Edges`].
    pub edges: Option<&'a [u8]>,
}

/// How numbers are written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Encoding {
    /// As text: decimals that read back to the same bits.
    #[default]
    Ascii,
    /// As raw little-endian values (VTU: in base64).
    Binary,
    /// As [`Encoding::Binary`], compressed by zlib; VTU only.
    Compressed,
}

impl Encoding {
    const fn name(self) -> &'static str {
        match self {
            Self::Ascii => "ASCII",
            Self::Binary => "binary",
            Self::Compressed => "compressed",
        }
    }
}

/// A version of Gmsh's MSH form.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MshVersion {
    /// 2.2, which most other programs read.
    V22,
    /// 4.1, Gmsh's own since 2019.
    #[default]
    V41,
}

/// How to write a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WriteOptions {
    /// Text or binary.
    pub encoding: Encoding,
    /// Version of an MSH file.
    pub msh_version: MshVersion,
}

/// A reader, as the table [`READERS`] has it.
pub type Reader = fn(&[u8], &ReadOptions) -> Result<MeshData, ReadError>;

/// The reader of every form.
pub const READERS: [(MeshForm, Reader); MeshForm::ALL.len()] = [
    (MeshForm::Msh, msh::read),
    (MeshForm::NodeEle, node_ele::read),
    (MeshForm::Off, off::read),
    (MeshForm::Vtu, vtu::read),
    (MeshForm::VtkLegacy, vtk_legacy::read),
    (MeshForm::Medit, medit::read),
    (MeshForm::Su2, su2::read),
    (MeshForm::Obj, obj::read),
    (MeshForm::Ply, ply::read),
    (MeshForm::Stl, stl::read),
    (MeshForm::NetgenVol, netgen_vol::read),
    (MeshForm::Fort14, fort14::read),
    (MeshForm::Sms2dm, sms_2dm::read),
    (MeshForm::Abaqus, abaqus::read),
];

/// Reads a mesh file: nothing repaired, nothing dropped.
///
/// # Errors
/// The first fault, with its line or byte offset and the rule of SPEC 13.2 that it breaks.
///
/// # Complexity
/// Time linear in the size of the input (with a logarithm where point numbers have large gaps);
/// memory at most proportional to it.
///
/// ```
/// use trigrade::format::{MeshForm, MeshView, ReadOptions, WriteOptions, read_mesh, write_mesh};
/// let off = b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
/// let mesh = read_mesh(off, MeshForm::Off, &ReadOptions::default())?;
/// assert_eq!(mesh.triangles, [[0, 1, 2]]);
///
/// let mut vtu = Vec::new();
/// write_mesh(MeshView::from(&mesh), MeshForm::Vtu, WriteOptions::default(), &mut vtu)?;
/// assert_eq!(read_mesh(&vtu, MeshForm::Vtu, &ReadOptions::default())?.points, mesh.points);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read_mesh(
    bytes: &[u8],
    form: MeshForm,
    options: &ReadOptions,
) -> Result<MeshData, ReadError> {
    match READERS.iter().find(|(known, _)| *known == form) {
        Some((_, reader)) => reader(bytes, options),
        None => Err(ReadError { file: "", at: At::Byte(0), fault: ReadFault::UnknownForm }),
    }
}

/// Writes the main file of a mesh; [`MeshForm::companions`] names the others.
///
/// What the form cannot carry is left out: [`MeshView::dropped_by`] says it beforehand.
///
/// # Errors
/// [`WriteError`]; the output may then hold a part of the file.
pub fn write_mesh(
    mesh: MeshView,
    form: MeshForm,
    options: WriteOptions,
    out: &mut dyn Write,
) -> Result<(), WriteError> {
    if !form.is_written() {
        return Err(WriteError::ReadOnly(form));
    }
    mesh.validate()?;
    let is_binary = options.encoding == Encoding::Binary;
    if !form.has_encoding(options.encoding) {
        return Err(WriteError::Encoding { form, encoding: options.encoding.name() });
    }
    use MeshForm::{Msh, Obj, Off, Su2, VtkLegacy, Vtu};
    if mesh.has_quads() && !matches!(form, Msh | Vtu | VtkLegacy | Off | Obj | Su2) {
        return Err(WriteError::Carry { form, what: "the quadrilaterals of a grid" });
    }
    let mut text = TextOut::new(out);
    match form {
        MeshForm::Msh if options.msh_version == MshVersion::V22 => {
            msh22::write(mesh, is_binary, &mut text)?;
        }
        MeshForm::Msh => msh41::write(mesh, is_binary, &mut text)?,
        MeshForm::NodeEle => node_ele::write_triangles(mesh, &mut text)?,
        MeshForm::Off => off::write(mesh, &mut text)?,
        MeshForm::Vtu => vtu::write(mesh, options.encoding, &mut text)?,
        MeshForm::VtkLegacy => vtk_legacy::write(mesh, is_binary, &mut text)?,
        MeshForm::Medit => medit::write(mesh, &mut text)?,
        MeshForm::Su2 => su2::write(mesh, &mut text)?,
        MeshForm::Obj => obj::write(mesh, &mut text)?,
        MeshForm::Ply => ply::write(mesh, is_binary, &mut text)?,
        MeshForm::Stl => stl::write(mesh, is_binary, &mut text)?,
        MeshForm::NetgenVol | MeshForm::Fort14 | MeshForm::Sms2dm | MeshForm::Abaqus => {
            return Err(WriteError::ReadOnly(form));
        }
    }
    Ok(text.finish()?)
}

/// Writes a file that stands beside the main one.
///
/// # Errors
/// [`WriteError`]; the output may then hold a part of the file.
pub fn write_companion(
    mesh: MeshView,
    companion: Companion,
    out: &mut dyn Write,
) -> Result<(), WriteError> {
    mesh.validate()?;
    let mut text = TextOut::new(out);
    match companion {
        Companion::Nodes => node_ele::write_nodes(mesh, &mut text)?,
        Companion::Edges => node_ele::write_edges(mesh, &mut text)?,
    }
    Ok(text.finish()?)
}
