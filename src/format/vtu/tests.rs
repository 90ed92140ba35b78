//! What only VTU files can do: expand, share data, nest XML, have pieces.

use crate::format::{MeshForm, ReadError, ReadOptions, read_mesh};
use crate::mesh::{BadReference, MeshData};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use std::io::Write;

fn read(text: impl AsRef<[u8]>) -> Result<MeshData, ReadError> {
    read_mesh(text.as_ref(), MeshForm::Vtu, &ReadOptions::default())
}

fn file(attributes: &str, content: &str) -> String {
    format!(
        "<VTKFile type=\"UnstructuredGrid\" {attributes}>\n<UnstructuredGrid>\n{content}\n\
         </UnstructuredGrid>\n</VTKFile>\n"
    )
}

/// A piece with one triangle over `points` points, as text.
fn piece(points: &str, corners: &str) -> String {
    let count = points.split_whitespace().count() / 3;
    format!(
        "<Piece NumberOfPoints=\"{count}\" NumberOfCells=\"1\">\n\
         <Points><DataArray type=\"Float64\">{points}</DataArray></Points>\n<Cells>\n\
         <DataArray type=\"Int32\" Name=\"connectivity\">{corners}</DataArray>\n\
         <DataArray type=\"Int32\" Name=\"offsets\">3</DataArray>\n\
         <DataArray type=\"Int32\" Name=\"types\">5</DataArray>\n</Cells></Piece>"
    )
}

const POINTS: &str = "0 0 0 1 0 0 0 1 0";

// spec: X20
#[test]
fn pieces_follow_each_other() {
    let mesh =
        read(file("", &(piece(POINTS, "0 1 2") + &piece("5 5 0 6 5 0 5 6 0", "2 0 1")))).unwrap();
    assert_eq!(mesh.points.len(), 6);
    assert_eq!(mesh.triangles, [[0, 1, 2], [5, 3, 4]]);
}

// spec: X24
#[test]
fn a_corner_beyond_its_own_piece_is_a_bad_reference() {
    let mesh = read(file("", &(piece(POINTS, "0 1 3") + &piece(POINTS, "0 -1 2")))).unwrap();
    let bad = |triangle, corner, value| BadReference { triangle, corner, value };
    assert_eq!(mesh.bad_references, [bad(0, 2, 3), bad(1, 1, -1)]);
}

// spec: X29
#[test]
fn document_types_and_entities_are_not_expanded() {
    let bomb = "<!DOCTYPE x [<!ENTITY a \"aaaaaaaa\"><!ENTITY b \"&a;&a;&a;\">]>\n";
    let error = read(bomb.to_owned() + &file("", &piece(POINTS, "0 1 2"))).unwrap_err();
    assert_eq!(error.rule(), "X26", "{error}");
    let error = read(file("", &piece("0 0 0 1 0 0 0 1 &#48;", "0 1 2"))).unwrap_err();
    assert_eq!(error.rule(), "X20", "{error}");
    assert!(
        error.to_string().starts_with("line 4: expected a coordinate, found `&#48;`"),
        "{error}"
    );
}

// spec: X20
#[test]
fn deep_nesting_does_no_harm() {
    let deep = "<a>".repeat(200_000);
    assert!(read(file("", &deep)).is_err());
    let closed = deep.clone() + &"</a>".repeat(200_000);
    assert!(read(file("", &(closed + &piece(POINTS, "0 1 2")))).is_ok());
    assert!(read(deep).is_err());
}

/// One compressed array of coordinates that claims `blocks` blocks of `block` bytes.
fn compressed(points: u64, [blocks, block, last]: [u64; 3], data: &[&[u8]]) -> String {
    let mut header = vec![blocks, block, last];
    header.extend(data.iter().map(|data| data.len() as u64));
    let header: Vec<u8> = header.iter().flat_map(|number| number.to_le_bytes()).collect();
    let text = STANDARD.encode(header) + &STANDARD.encode(data.concat());
    let attributes = "header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\"";
    let content = format!(
        "<Piece NumberOfPoints=\"{points}\" NumberOfCells=\"0\"><Points>\
         <DataArray type=\"Float64\" format=\"binary\">{text}</DataArray></Points></Piece>"
    );
    file(attributes, &content)
}

fn zlib(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

// spec: X29
#[test]
fn blocks_that_are_what_they_claim_are_read() {
    let block = zlib(&[0; 48]);
    let mesh = read(compressed(5, [3, 48, 24], &[&block, &block, &zlib(&[0; 24])])).unwrap();
    assert_eq!(mesh.points, [[0.0; 3]; 5]);
}

// spec: X29
#[test]
fn a_bomb_is_refused_by_its_header() {
    // 32 MB of zeros in 32 kB, by counts that fit: more than 16 MiB and 256 times the file.
    let points = (32 << 20) / 24;
    let block = zlib(&vec![0; 24 * points as usize]);
    let error = read(compressed(points, [1, 24 * points, 0], &[&block])).unwrap_err();
    assert_eq!(error.rule(), "X29", "{error}");
    // Claims beyond any memory, in a small file.
    for [blocks, block_size, last] in [[1, 1 << 50, 0], [1, u64::MAX, 0], [2, 1 << 62, 1 << 62]] {
        let data: Vec<&[u8]> = vec![&block[..16]; blocks as usize];
        let error = read(compressed(1 << 40, [blocks, block_size, last], &data)).unwrap_err();
        assert_eq!(error.rule(), "X29", "{error}");
    }
}

// spec: X29
#[test]
fn a_block_that_expands_beyond_its_claim_is_refused() {
    let bomb = zlib(&vec![0; 1 << 20]);
    let error = read(compressed(1, [1, 24, 0], &[&bomb])).unwrap_err();
    assert_eq!(error.rule(), "X20", "{error}");
    let error = read(compressed(2, [1, 48, 0], &[&zlib(&[0; 24])])).unwrap_err();
    assert_eq!(error.rule(), "X20", "{error}");
    let error = read(compressed(1, [1, 24, 0], &[b"no zlib data"])).unwrap_err();
    assert_eq!(error.rule(), "X20", "{error}");
}

// spec: X22
#[test]
fn counts_that_contradict_the_data_are_refused() {
    let block = zlib(&[0; 24]);
    for (points, numbers) in [(2, [1, 24, 0]), (0, [1, 24, 0]), (1 << 61, [1, 24, 0])] {
        let error = read(compressed(points, numbers, &[&block])).unwrap_err();
        assert_eq!(error.rule(), "X22", "{error}");
    }
    for blocks in [2, 1 << 40, u64::MAX] {
        let error = read(compressed(1, [blocks, 24, 0], &[&block])).unwrap_err();
        assert!(matches!(error.rule(), "X20" | "X21" | "X22" | "X29"), "{error}");
    }
    let with = |count: &str| piece(POINTS, "0 1 2").replace("NumberOfPoints=\"3\"", count);
    for count in ["NumberOfPoints=\"2\"", "NumberOfPoints=\"-3\"", "NumberOfPoints=\"\"", ""] {
        assert_eq!(read(file("", &with(count))).unwrap_err().rule(), "X20", "{count}");
    }
    for count in ["NumberOfPoints=\"1099511627776\"", "NumberOfPoints=\"18446744073709551615\""] {
        assert_eq!(read(file("", &with(count))).unwrap_err().rule(), "X22", "{count}");
    }
}

// spec: X29
#[test]
fn arrays_that_share_data_do_not_multiply_it() {
    // 1000 pieces of 100,000 points each, all of them the same 2.4 MB.
    let count = 100_000_u64;
    let piece = format!(
        "<Piece NumberOfPoints=\"{count}\" NumberOfCells=\"0\"><Points><DataArray \
         type=\"Float64\" format=\"appended\" offset=\"0\"/></Points></Piece>"
    );
    let mut bytes = b"<VTKFile type=\"UnstructuredGrid\" header_type=\"UInt64\">".to_vec();
    bytes.extend(piece.repeat(1000).bytes());
    bytes.extend(b"<AppendedData encoding=\"raw\">_");
    bytes.extend((24 * count).to_le_bytes());
    bytes.extend(vec![0; 24 * count as usize]);
    bytes.extend(b"</AppendedData></VTKFile>");
    let error = read(&bytes).unwrap_err();
    assert_eq!(error.rule(), "X29", "{error}");
}

// spec: X20
#[test]
fn cells_that_contradict_each_other_are_refused() {
    let good = piece(POINTS, "0 1 2");
    for (what, with) in [
        (">3<", ">4<"),
        (">3<", ">-3<"),
        (">3<", ">2<"),
        (">5<", ">9<"),
        (">5<", ">3<"),
        ("\"offsets\"", "\"other\""),
        ("\"types\"", "\"other\""),
        ("\"connectivity\"", "\"other\""),
        ("Float64", "Float80"),
        ("<Points>", "<Other>"),
    ] {
        let error = read(file("", &good.replace(what, with))).unwrap_err();
        assert!(matches!(error.rule(), "X20" | "X22"), "{what} {with}: {error}");
    }
}

// spec: X26
#[test]
fn kinds_of_files_that_are_not_read_are_named() {
    let good = piece(POINTS, "0 1 2");
    let error = read(file("", &good).replace("UnstructuredGrid\"", "PolyData\"")).unwrap_err();
    assert!(
        error.to_string().contains("a VTK file of type `PolyData` is not supported"),
        "{error}"
    );
    let lz4 = "compressor=\"vtkLZ4DataCompressor\"";
    assert!(read(file(lz4, &good)).is_ok(), "text is not compressed");
    let binary = good.replacen("type=\"Float64\"", "type=\"Float64\" format=\"binary\"", 1);
    assert_eq!(read(file(lz4, &binary)).unwrap_err().rule(), "X26");
}

// spec: X20
#[test]
fn broken_xml_and_odd_attributes_are_refused() {
    let good = file("", &piece(POINTS, "0 1 2"));
    for (what, with) in [
        ("</Points>", "</Pointz>"),
        ("</VTKFile>", ""),
        ("<VTKFile", "<Other"),
        ("type=\"UnstructuredGrid\"", "type=\"UnstructuredGrid"),
        ("type=\"UnstructuredGrid\"", "type=\"UnstructuredGrid\" byte_order=\"PDP\""),
        ("type=\"UnstructuredGrid\"", "type=\"UnstructuredGrid\" header_type=\"Int8\""),
        ("type=\"Float64\"", "type=\"Float64\" format=\"base85\""),
        ("type=\"Float64\"", "type=\"Float64\" format=\"appended\" offset=\"0\""),
        ("type=\"Float64\"", "type=\"Float64\" format=\"appended\""),
    ] {
        let error = read(good.replacen(what, with, 1)).unwrap_err();
        assert!(matches!(error.rule(), "X20" | "X21"), "{what} {with}: {error}");
    }
}
