//! Bytes that are no mesh: an error with its place, never a panic, never more memory than the
//! input earns.

use super::*;
use proptest::prelude::*;

fn read_text(text: &str, form: MeshForm) -> Result<MeshData, ReadError> {
    read_mesh(text.as_bytes(), form, &ReadOptions::default())
}

/// Reads by every reader, with the bytes also as points and edges; whatever comes must be sound.
pub(super) fn read_by_all(bytes: &[u8]) {
    for (form, read) in READERS {
        for split_quads in [false, true] {
            let options = ReadOptions { split_quads, nodes: Some(bytes), edges: None };
            assert_sound(form, bytes.len(), read(bytes, &options));
        }
    }
}

/// A result that keeps the promises of [`MeshData`] and of [`ReadError`].
pub(super) fn assert_sound(form: MeshForm, size: usize, result: Result<MeshData, ReadError>) {
    match result {
        Ok(mesh) => {
            let count = mesh.points.len() as u32;
            let is_known = |&index: &u32| index < count || index == crate::mesh::NO_POINT;
            assert!(mesh.triangles.iter().flatten().all(is_known), "{form}");
            assert!(mesh.edges.iter().flat_map(|e| e.vertices).all(|index| index < count));
            let bad = mesh.triangles.iter().flatten().filter(|&&i| i >= count).count();
            assert_eq!(bad, mesh.bad_references.len(), "{form}");
            assert!(mesh.regions.is_empty() || mesh.regions.len() == mesh.triangles.len());
            // A compressed VTU may hold more than its size.
            let items = mesh.points.len() + mesh.triangles.len();
            assert!(form == MeshForm::Vtu || items <= size + 1, "{form}");
        }
        Err(error) => {
            let text = error.to_string();
            assert!(text.contains("line ") || text.contains("byte "), "{form}: {text}");
            assert!(text.contains(&format!("(SPEC {})", error.rule())), "{form}: {text}");
        }
    }
}

// spec: X20 X21
#[test]
fn truncation_at_every_byte_is_an_error_or_a_sound_mesh() {
    for (form, options) in ways() {
        let files = Files::write(&square(), form, options);
        for length in 0..files.main.len() {
            let cut = Files { main: files.main[..length].to_vec(), ..files.clone() };
            assert_sound(form, files.main.len(), cut.read(form));
        }
    }
}

// spec: X21
#[test]
fn counted_forms_notice_every_missing_item() {
    for (form, options) in ways() {
        let files = Files::write(&square(), form, options);
        // The last number may lose digits unnoticed where nothing marks the end of the file.
        let last = files.main.trim_ascii_end().iter().rposition(|b| b.is_ascii_whitespace());
        // OBJ counts nothing; the sections after the triangles of VTK and SU2 hold markers only.
        if matches!(form, MeshForm::Obj | MeshForm::VtkLegacy | MeshForm::Su2) {
            continue;
        }
        let safe =
            if options.encoding == Encoding::Ascii { last.unwrap() } else { files.main.len() - 1 };
        for length in 0..safe {
            let cut = Files { main: files.main[..length].to_vec(), ..files.clone() };
            let result = cut.read(form);
            assert!(result.is_err(), "{form} {options:?} cut to {length} bytes reads");
        }
    }
}

// spec: X20
#[test]
fn one_changed_byte_does_no_harm() {
    for (form, options) in ways() {
        let files = Files::write(&square(), form, options);
        for position in 0..files.main.len() {
            for byte in [0, b'-', b'9', b' ', b'\n', b'e', 0xff, files.main[position] ^ 1] {
                let mut cut = files.clone();
                cut.main[position] = byte;
                let size = cut.main.len() + cut.nodes.as_ref().map_or(0, Vec::len);
                assert_sound(form, size, cut.read(form));
            }
        }
        for position in 0..files.nodes.as_ref().map_or(0, Vec::len) {
            let mut cut = files.clone();
            cut.nodes.as_mut().unwrap()[position] = b'9';
            let size = cut.main.len() + cut.nodes.as_ref().unwrap().len();
            assert_sound(form, size, cut.read(form));
        }
    }
}

proptest! {
    // spec: X32
    #[test]
    fn random_bytes_do_no_harm(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        read_by_all(&bytes);
    }

    // spec: X32
    #[test]
    fn spliced_files_do_no_harm(way in any::<prop::sample::Index>(), cut in any::<[prop::sample::Index; 3]>()) {
        let ways = ways();
        let (form, options) = ways[way.index(ways.len())];
        let mut files = Files::write(&square(), form, options);
        let length = files.main.len();
        let [from, to, at] = cut.map(|index| index.index(length));
        let piece = files.main[from.min(to)..from.max(to)].to_vec();
        files.main.splice(at..at, piece);
        assert_sound(form, 2 * length, files.read(form));
        read_by_all(&files.main);
    }
}

// spec: X20
#[test]
fn windows_line_ends_and_a_missing_last_newline_change_nothing() {
    let ascii = ways().into_iter().filter(|way| way.1.encoding == Encoding::Ascii);
    for (form, options) in ascii {
        let files = Files::write(&square(), form, options);
        let mesh = files.read(form).unwrap();
        let crlf = |bytes: &[u8]| {
            let text = String::from_utf8(bytes.to_vec()).unwrap();
            text.trim_end().replace('\n', "\r\n").into_bytes()
        };
        let files = Files {
            main: crlf(&files.main),
            nodes: files.nodes.as_deref().map(crlf),
            edges: files.edges.as_deref().map(crlf),
        };
        assert_eq!(files.read(form).unwrap(), mesh, "{form}");
    }
}

// spec: X23
#[test]
fn a_literal_beyond_f64_is_refused() {
    for literal in ["1e400", "-1e999999999999", &"9".repeat(400)] {
        let text = format!("OFF\n3 1 0\n0 0 0\n1 {literal} 0\n0 1 0\n3 0 1 2\n");
        let error = read_text(&text, MeshForm::Off).unwrap_err();
        assert_eq!(error.rule(), "X23", "{error}");
        assert_eq!(error.at, At::Line(4));
    }
}

// spec: X23
#[test]
fn literals_that_are_no_decimals_are_refused() {
    for literal in ["1,5", "0x10", "1.2.3", "--1", "1e", "e5", "d5", "1_000", "\u{661}", "1.0f"] {
        let text = format!("OFF\n3 1 0\n0 0 0\n1 {literal} 0\n0 1 0\n3 0 1 2\n");
        let error = read_text(&text, MeshForm::Off).unwrap_err();
        assert_eq!((error.rule(), error.at), ("X20", At::Line(4)), "{literal}: {error}");
    }
}

// spec: X23
#[test]
fn long_literals_and_subnormals_are_rounded_to_the_nearest() {
    let nearest = |literal: &str| {
        let text = format!("OFF\n1 0 0\n{literal} 0 0\n");
        read_text(&text, MeshForm::Off).unwrap().points[0][0]
    };
    assert_eq!(nearest("9007199254740993"), 9_007_199_254_740_992.0);
    assert_eq!(
        nearest(&format!("9007199254740993.{}1", "0".repeat(1000))),
        9_007_199_254_740_994.0
    );
    assert_eq!(nearest("4.9e-324"), 5e-324);
    assert_eq!(nearest("1e-400"), 0.0);
    assert_eq!(nearest("-1.5D+03"), -1500.0);
    assert!(nearest("nan").is_nan());
    assert_eq!(nearest("-inf"), f64::NEG_INFINITY);
}

// spec: X22
#[test]
fn counts_beyond_the_file_are_refused_before_memory_is_reserved() {
    for count in ["-1", "1099511627776", "4294967296", "999999999999999999", "100"] {
        for text in [
            format!("OFF\n{count} 1 0\n0 0 0\n"),
            format!("OFF\n1 {count} 0\n0 0 0\n"),
            format!("OFF\n1 1 0\n0 0 0\n{count} 0 0 0\n"),
        ] {
            let error = read_text(&text, MeshForm::Off).unwrap_err();
            assert_eq!(error.rule(), "X22", "{error}");
        }
        for text in [
            format!("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{count}\n1 0 0 0\n"),
            format!("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 {count} 1 1\n"),
            format!("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n{count} 1 1 1\n"),
            format!("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 1 1 1\n2 1 0 {count}\n"),
        ] {
            let error = read_text(&text, MeshForm::Msh).unwrap_err();
            assert_eq!(error.rule(), "X22", "{error}");
        }
    }
    let error = read_text("OFF\n99999999999999999999999 1 0\n", MeshForm::Off).unwrap_err();
    assert_eq!(error.rule(), "X23", "{error}");
}

// spec: X20
#[test]
fn an_empty_file_is_an_error_in_every_form() {
    for text in ["", "\n\n", " \t\r\n", "\u{feff}"] {
        for (form, read) in READERS {
            let options = ReadOptions { nodes: Some(b""), ..ReadOptions::default() };
            let error = read(text.as_bytes(), &options).expect_err(form.name());
            assert_eq!(error.rule(), "X21", "{form}: {error}");
        }
    }
}
