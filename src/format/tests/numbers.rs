//! Numbers of points and cells: gaps, duplicates, references that lead nowhere.

use super::*;
use crate::mesh::{BadEdge, BadReference, NO_POINT};

fn read(text: &str, form: MeshForm) -> MeshData {
    let result = read_mesh(text.as_bytes(), form, &ReadOptions::default());
    result.unwrap_or_else(|error| panic!("{text:?}: {error}"))
}

fn msh(numbers: [&str; 3], corners: &str) -> Result<MeshData, ReadError> {
    let [a, b, c] = numbers;
    let text = format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n{a} 0 0 0\n{b} 1 0 0\n{c} 0 1 0\n\
         $EndNodes\n$Elements\n1\n1 2 0 {corners}\n$EndElements\n"
    );
    read_mesh(text.as_bytes(), MeshForm::Msh, &ReadOptions::default())
}

// spec: X24
#[test]
fn numbers_of_points_may_have_gaps_and_any_order() {
    for (numbers, corners) in [
        (["1", "2", "3"], "1 2 3"),
        (["0", "1", "2"], "0 1 2"),
        (["7", "5", "6"], "7 5 6"),
        (["-1", "5", "0"], "-1 5 0"),
        (["1000000000000", "1", "-1000000000000"], "1000000000000 1 -1000000000000"),
    ] {
        let mesh = msh(numbers, corners).unwrap();
        assert_eq!(mesh.triangles, [[0, 1, 2]], "{numbers:?}");
        let own: Vec<i64> = numbers.iter().map(|number| number.parse().unwrap()).collect();
        assert_eq!(mesh.point_numbers, if own == [0, 1, 2] { vec![] } else { own });
    }
}

// spec: X24
#[test]
fn a_number_given_twice_is_an_error() {
    for numbers in [["1", "2", "1"], ["1000000000000", "3", "1000000000000"]] {
        let error = msh(numbers, "1 2 3").unwrap_err();
        assert_eq!(error.fault, ReadFault::Duplicate { number: numbers[0].parse().unwrap() });
    }
}

// spec: X24
#[test]
fn a_reference_to_no_point_is_reported_and_not_an_error() {
    for (numbers, bad) in [
        (["1", "2", "3"], "4"),
        (["1", "2", "3"], "0"),
        (["1", "2", "3"], "-7"),
        (["1", "2", "3"], "999999999999999999"),
        (["1", "2", "3"], "4294967296"),
        (["1", "3", "5"], "4"),
        (["1", "3", "5"], "-999999999999999999"),
        (["1", "3", "5000000000"], "5000000001"),
    ] {
        let mesh = msh(numbers, &format!("{} {bad} {}", numbers[0], numbers[2])).unwrap();
        let value = bad.parse().unwrap();
        assert_eq!(mesh.triangles, [[0, NO_POINT, 2]], "{numbers:?} {bad}");
        assert_eq!(mesh.bad_references, [BadReference { triangle: 0, corner: 1, value }]);
    }
}

// spec: X24
#[test]
fn bad_references_are_found_whatever_the_order_of_the_lists() {
    let text = "NDIME= 2\nNELEM= 2\n5 0 3 -1\n5 2 1 4294967295\nNPOIN= 3\n0 0\n1 0\n0 1\nNMARK= 1\n\
                MARKER_TAG= wall\nMARKER_ELEMS= 3\n3 0 1\n3 1 3\n3 -2 0\n";
    let mesh = read(text, MeshForm::Su2);
    assert_eq!(mesh.triangles, [[0, NO_POINT, NO_POINT], [2, 1, NO_POINT]]);
    let bad = |triangle, corner, value| BadReference { triangle, corner, value };
    assert_eq!(mesh.bad_references, [bad(0, 1, 3), bad(0, 2, -1), bad(1, 2, 4_294_967_295)]);
    assert_eq!(mesh.edges, [edge([0, 1], 1)]);
    let bad = |edge, value, line| BadEdge { edge, value, line: Some(line) };
    assert_eq!(mesh.bad_edges, [bad(2, -2, 14), bad(1, 3, 13)]);
}

// spec: X20
#[test]
fn obj_numbers_count_back_from_the_latest_vertex() {
    let mesh = read(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 1 1 0\nf -1 2 -2\nf 0 -5 4\n",
        MeshForm::Obj,
    );
    assert_eq!(mesh.triangles, [[0, 1, 2], [3, 1, 2], [NO_POINT, NO_POINT, 3]]);
    let values: Vec<i64> = mesh.bad_references.iter().map(|bad| bad.value).collect();
    assert_eq!(values, [0, -5]);
}

// spec: X20
#[test]
fn su2_tags_that_are_names_are_numbered() {
    let with = |a: &str, b: &str| {
        let text = format!(
            "NDIME= 2\nNELEM= 1\n5 0 1 2\nNPOIN= 3\n0 0 0\n1 0 1\n0 1 2\nNMARK= 2\nMARKER_TAG= {a}\n\
             MARKER_ELEMS= 1\n3 0 1\nMARKER_TAG={b}\nMARKER_ELEMS = 1\n3 1 2\nFFD_NBOX= 1\n1.5 2\n"
        );
        read(&text, MeshForm::Su2).edges.iter().map(|edge| edge.marker).collect::<Vec<_>>()
    };
    assert_eq!(with("wall", "inlet"), [1, 2]);
    assert_eq!(with("12", "-3"), [12, -3]);
    assert_eq!(with("12", "inlet"), [1, 2]);
}

// spec: X20
#[test]
fn adcirc_islands_are_closed() {
    let text =
        "t\n1 3\n1 0 0 5\n2 1 0 5\n3 0 1 5\n1 3 1 2 3\n0\n0\n2\n6\n3 1\n1\n2\n3\n3 0\n1\n2\n3\n";
    let mesh = read(text, MeshForm::Fort14);
    let expected = [([0, 1], 1), ([1, 2], 1), ([2, 0], 1), ([0, 1], 0), ([1, 2], 0)];
    assert_eq!(mesh.edges, expected.map(|(ends, marker)| edge(ends, marker)));
}

// spec: X25
#[test]
fn other_cells_are_counted_by_kind() {
    let text =
        "*NODE\n1,0,0\n*ELEMENT,TYPE=C3D4\n1,1,1,1,1\n2,1,1,1,1\n*ELEMENT,TYPE=S6\n3,1,1,1,1,1,1\n";
    let kinds = |mesh: MeshData| -> Vec<(String, u64)> {
        mesh.other_cells.into_iter().map(|other| (other.kind, other.count)).collect()
    };
    let expected = [("element C3D4 with 4 nodes", 2), ("element S6 with 6 nodes", 1)];
    assert_eq!(kinds(read(text, MeshForm::Abaqus)), expected.map(|(k, n)| (k.to_owned(), n)));
    let text = "OFF 5 3 0\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n5 0 1 2 3 4\n1 0\n5 4 3 2 1 0\n";
    let expected = [("point", 1), ("polygon with 5 corners", 2)];
    assert_eq!(kinds(read(text, MeshForm::Off)), expected.map(|(k, n)| (k.to_owned(), n)));
    let text = "MeshVersionFormatted 2 Dimension 3 Vertices 1 0 0 0 0 Tetrahedra 2 1 1 1 1 0 1 1 1 1 0 \
                Corners 1 1 Normals 1 0 0 1 End";
    let expected = [("Tetrahedra (Medit)", 2)];
    assert_eq!(kinds(read(text, MeshForm::Medit)), expected.map(|(k, n)| (k.to_owned(), n)));
}

// spec: X25
#[test]
fn attributes_that_are_no_integers_are_no_regions() {
    let nodes = b"3 2 0 0\n1 0 0\n2 1 0\n3 0 1\n";
    let options = ReadOptions { nodes: Some(nodes), ..ReadOptions::default() };
    let regions =
        |ele: &str| read_mesh(ele.as_bytes(), MeshForm::NodeEle, &options).unwrap().regions;
    assert_eq!(regions("2 3 1\n1 1 2 3 4\n2 1 2 3 5.0\n"), [4, 5]);
    assert!(regions("2 3 1\n1 1 2 3 4\n2 1 2 3 5.5\n").is_empty());
    assert!(regions("1 3 2\n1 1 2 3 1e300 4\n").is_empty());
}
