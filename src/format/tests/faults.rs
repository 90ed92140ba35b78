//! Files that are wrong in one way: the message, its place and its rule.

use super::*;

fn fault(form: MeshForm, text: &str) -> String {
    let nodes = b"3 2 0 0\n1 0 0\n2 1 0\n3 0 1\n";
    let options = ReadOptions { nodes: Some(nodes), ..ReadOptions::default() };
    match read_mesh(text.as_bytes(), form, &options) {
        Ok(mesh) => panic!("{form} reads {text:?} as {mesh:?}"),
        Err(error) => error.to_string(),
    }
}

/// Every text gives a message that starts as expected and ends in the rule.
fn assert_faults(form: MeshForm, cases: &[(&str, &str, &str)]) {
    for (text, start, rule) in cases {
        let message = fault(form, text);
        let end = format!("(SPEC {rule})");
        assert!(message.starts_with(start) && message.ends_with(&end), "{text:?}: {message}");
    }
}

// spec: X20 X21 X22 X26
#[test]
fn msh_22() {
    let with = |rest: &str| format!("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n{rest}");
    let nodes = "$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n";
    let elements = |rest: &str| with(&format!("{nodes}$Elements\n{rest}\n$EndElements\n"));
    assert_faults(
        MeshForm::Msh,
        &[
            (
                "$MeshFormat\n4.0 0 8\n$EndMeshFormat\n",
                "line 2: MSH version 4.0 is not supp",
                "X26",
            ),
            (
                "$MeshFormat\n1.0 0 8\n$EndMeshFormat\n",
                "line 2: MSH version 1.0 is not supp",
                "X26",
            ),
            ("$MeshFormat\n2.2 2 8\n", "line 2: expected the file type, 0 or 1, found `2`", "X20"),
            ("$MeshFormat\n2.2 1 4\n", "line 2: expected the data size 8, found `4`", "X20"),
            ("$MeshFormat\n2.2 1 8\n\x02\0\0\0", "byte 24: expected the binary integer 1", "X20"),
            ("$NOD\n1\n", "line 1: expected `$MeshFormat`, found `$NOD`", "X20"),
            (&with(""), "line 4: the file ends where `$Nodes` should stand", "X21"),
            (&with(nodes), "line 10: the file ends where `$Elements` should stand", "X21"),
            (&with("$EndNodes\n"), "line 4: expected a section such as `$Nodes`", "X20"),
            (
                &with("$Nodes\n3\n1 0 0 0\n"),
                "line 5: 3 nodes are declared, but the file has",
                "X22",
            ),
            (&with(&format!("{nodes}{nodes}")), "line 11: expected one `$Nodes`", "X20"),
            (&with("$Nodes\n0\n"), "line 6: the file ends where `$EndNodes` should stand", "X21"),
            (&with("$Other\n0\n"), "line 6: the file ends where `$EndOther` should stand", "X21"),
            (
                &with("$ParametricNodes\n"),
                "line 4: a section `$ParametricNodes` is not supp",
                "X26",
            ),
            (
                &elements("1\n1 2 2 1 1 1 2"),
                "line 13: expected a node of an element, found `$En",
                "X20",
            ),
            (
                &elements("1\n1 2 2 1 1 1 2 3 4"),
                "line 12: expected `$EndElements`, found `4`",
                "X20",
            ),
            (&elements("2\n1 2 2 1 1 1 2 3"), "line 13: expected an element number, found", "X20"),
            (&elements("1\n1 77 2 1 1 1 2 3"), "line 12: Gmsh element type 77 is not supp", "X26"),
            (&elements("1\n1 2 -1 1 2 3"), "line 12: -1 tags of an element are declared", "X22"),
            (
                &elements("1\n1 2 1 9999999999 1 2 3"),
                "line 12: `9999999999` is beyond the range",
                "X23",
            ),
            (
                &elements("1\n1 2 2 1 1 1 2 3,0"),
                "line 12: expected a node of an element, fou",
                "X20",
            ),
        ],
    );
}

// spec: X20 X22
#[test]
fn msh_41() {
    let with = |rest: &str| format!("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n{rest}");
    let nodes = "$Nodes\n1 2 1 2\n2 1 0 2\n1\n2\n0 0 0\n1 0 0\n$EndNodes\n";
    let elements = |rest: &str| with(&format!("{nodes}$Elements\n{rest}\n$EndElements\n"));
    assert_faults(
        MeshForm::Msh,
        &[
            (
                &with("$Nodes\n1 3 1 2\n2 1 0 2\n1\n2\n0 0 0\n1 0 0\n$EndNodes\n"),
                "line 10: 3 nodes are",
                "X22",
            ),
            (
                &with("$Nodes\n1 1 1 2\n2 1 0 2\n1\n2\n0 0 0\n1 0 0\n$EndNodes\n"),
                "line 10: 1 nodes are",
                "X22",
            ),
            (
                &with("$Nodes\n1 1 1 1\n2 1 2 1\n1\n0 0 0\n"),
                "line 6: expected 0 or 1 for parametric",
                "X20",
            ),
            (
                &with("$Nodes\n1 2 1 2\n2 1 0 2\n1\n1\n0 0 0\n1 0 0\n"),
                "line 10: point number 1 is given",
                "X24",
            ),
            (&with("$Entities\n0 0 -1 0\n"), "line 5: -1 entities are declared", "X22"),
            (&with("$Entities\n0 0 1 0\n1 0 0 0 0 0 0 99\n"), "line 6: 99 physical groups", "X22"),
            (
                &elements("1 2 1 2\n2 1 2 1\n1 1 2 2"),
                "line 15: 2 elements are declared, but",
                "X22",
            ),
            (&elements("1 1 1 1\n2 1 2 2\n1 1 2 2"), "line 16: expected an element number", "X20"),
            (&elements("9999 1 1 1\n2 1 2 1\n1 1 2 2"), "line 13: 9999 blocks are declared", "X22"),
        ],
    );
}

// spec: X20 X22
#[test]
fn off() {
    assert_faults(
        MeshForm::Off,
        &[
            ("OOF\n1 1 1\n", "line 1: expected `OFF`, found `OOF`", "X20"),
            ("OFF BINARY\n1 1 1\n", "line 1: a binary OFF file is not supported", "X26"),
            ("4OFF\n1 1 1\n", "line 1: expected the number of points, found `4OFF`", "X20"),
            ("OFF\n1 0 0\n0 0 0\n3 0 0 0\n", "line 4: expected the end of the file after", "X20"),
            (
                "OFF\n1 1 0\n0 0 0\n",
                "line 4: the file ends where the number of corners of a",
                "X21",
            ),
            ("OFF\n1 1 0\n0 0 0\n-3 0 0 0\n", "line 4: -3 corners of a face are declared", "X22"),
            (
                "OFF\n1 1 0\n0 0 0\n3 0 0 0.5\n",
                "line 4: expected a corner of a face, found `0.",
                "X20",
            ),
        ],
    );
}

// spec: X20 X22 X24
#[test]
fn node_ele() {
    assert_faults(
        MeshForm::NodeEle,
        &[
            ("1 5 0\n1 1 2 3\n", "line 1: expected 3, 4 or 6 nodes per triangle, found `5`", "X20"),
            ("2 3 0\n1 1 2 3\n", "line 1: 2 triangles are declared, but the file has room", "X22"),
            ("1 3 0\n1 1 2 3 4\n", "line 2: expected the end of the line of a triangle", "X20"),
            ("1 3 0 0\n1 1 2 3\n", "line 1: expected the end of the first line, found `0`", "X20"),
            ("1 3 -1\n1 1 2 3\n", "line 1: -1 attributes are declared", "X22"),
            ("1 3 0\n1 1 2 x\n", "line 2: expected a corner of a triangle, found `x`", "X20"),
        ],
    );
    let read = |nodes: &str, edges: Option<&str>| {
        let options = ReadOptions {
            nodes: Some(nodes.as_bytes()),
            edges: edges.map(str::as_bytes),
            ..ReadOptions::default()
        };
        let result = read_mesh(b"0 3 0\n", MeshForm::NodeEle, &options);
        result.unwrap_err().to_string()
    };
    assert!(read("1 2 0 0\n1 0 x\n", None).starts_with(".node: line 2: expected the y coordinate"));
    assert!(read("2 2 0 0\n1 0 0\n1 0 1\n", None).starts_with(".node: line 3: point number 1 is"));
    assert!(read("1 4 0 0\n1 0 0\n", None).starts_with(".node: line 1: expected the dimension"));
    assert!(read("1 2 0 0\n1 0 0 9\n", None).starts_with(".node: line 2: expected the end of the"));
    assert!(
        read("1 2 0 0\n1 0 0\n", Some("1 1\n1 1\n")).starts_with(".edge: line 3: the file ends")
    );
    let error = read_mesh(b"0 3 0\n", MeshForm::NodeEle, &ReadOptions::default()).unwrap_err();
    assert!(error.to_string().contains("stand in a .node file beside it, which is missing"));
}

// spec: X20 X22 X26
#[test]
fn vtk_legacy() {
    let with = |rest: &str| format!("# vtk DataFile Version 2.0\nt\nASCII\n{rest}");
    let grid = |rest: &str| {
        with(&format!("DATASET UNSTRUCTURED_GRID\nPOINTS 3 float\n0 0 0 1 0 0 0 1 0\n{rest}"))
    };
    assert_faults(
        MeshForm::VtkLegacy,
        &[
            ("# vtk\n", "line 2: expected `# vtk DataFile Version`, found `# vtk`", "X20"),
            ("# vtk DataFile Version 2.0\nt\nTEXT\n", "line 3: expected ASCII or BINARY", "X20"),
            (
                &with("DATASET STRUCTURED_GRID\n"),
                "line 4: a dataset of type `structured_grid` is",
                "X26",
            ),
            (
                &with("DATASET UNSTRUCTURED_GRID\n"),
                "line 5: the file ends where the points sh",
                "X21",
            ),
            (&grid(""), "line 7: the file ends where the cells should stand", "X21"),
            (&grid("CELLS 1 4\n3 0 1 2\n"), "line 9: 1 cells are declared, but there are 0", "X22"),
            (&grid("CELLS 2 4\n3 0 1 2\n"), "line 8: 2 cells are declared, but there are 1", "X22"),
            (&grid("CELLS 1 4\n4 0 1 2\n"), "line 8: expected a number of corners within", "X20"),
            (&grid("CELLS 1 4\n-3 0 1 2\n"), "line 8: expected a number of corners within", "X20"),
            (
                &grid("CELLS 1 4\n3 0 1 2\nCELL_TYPES 2\n5 5\n"),
                "line 11: 1 cells are declared",
                "X22",
            ),
            (
                &grid("CELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n9\n"),
                "line 11: expected a quadrilateral",
                "X20",
            ),
            (
                &grid("CELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n5\nCELL_DATA 1\nSCALARS s int\n"),
                "line 13: the file ends where the values of an array",
                "X21",
            ),
            (&grid("POINTS 1 float\n0 0 0\n"), "line 7: expected one list of points", "X20"),
            (&grid("SOMETHING else\n"), "line 7: expected a keyword such as `POINTS`", "X20"),
            (
                &with("DATASET POLYDATA\nPOINTS 9 float\n0 0 0\n"),
                "line 5: 9 points are declared",
                "X22",
            ),
            (
                &with("DATASET POLYDATA\nPOINTS 1 quad\n0 0 0\n"),
                "line 5: expected a number type",
                "X20",
            ),
        ],
    );
}

// spec: X20 X21 X22 X26
#[test]
fn medit() {
    let with = |rest: &str| format!("MeshVersionFormatted 1\nDimension 2\n{rest}");
    assert_faults(
        MeshForm::Medit,
        &[
            ("MFEM mesh v1.0\n", "line 1: an MFEM mesh is not supported", "X26"),
            ("Dimension 2\n", "line 1: expected `MeshVersionFormatted`", "X20"),
            (
                "MeshVersionFormatted 1\nDimension 4\n",
                "line 2: expected the dimension, 2 or 3",
                "X20",
            ),
            (
                "MeshVersionFormatted 1\nVertices 1\n0 0 0\n",
                "line 2: expected `Dimension` before",
                "X20",
            ),
            (&with("End\n"), "line 3: expected `Vertices`, found `End`", "X20"),
            (&with("Vertices 1\n0 0 0\n"), "line 5: the file ends where a keyword such as", "X21"),
            (
                &with("Vertices 2\n0 0 0\nEnd\n"),
                "line 5: expected the x coordinate of a point",
                "X20",
            ),
            (
                &with("Vertices 0\nTriangles 9\n1 2 3 0\nEnd"),
                "line 4: 9 items of a list are",
                "X22",
            ),
            (&with("Vertices 0\nNonsense 0\nEnd\n"), "line 4: expected a keyword such as", "X20"),
            ("\x01\0\0\0\x09\0\0\0", "byte 8: Medit version 9 is not supported", "X26"),
            (
                "\x01\0\0\0\x01\0\0\0\x36\0\0\0",
                "byte 12: expected the dimension before the end",
                "X20",
            ),
            (
                "\x01\0\0\0\x01\0\0\0\x03\0\0\0\x01\0\0\0\x02\0\0\0",
                "byte 20: expected the next k",
                "X20",
            ),
        ],
    );
}

// spec: X20 X22 X26
#[test]
fn su2() {
    let points = "NPOIN= 3\n0 0\n1 0\n0 1\n";
    let with = |rest: &str| format!("NDIME= 2\nNELEM= 1\n5 0 1 2\n{points}{rest}");
    assert_faults(
        MeshForm::Su2,
        &[
            ("NDIME= 4\n", "line 1: expected the dimension, 2 or 3, found `4`", "X20"),
            ("NDIME 2\n", "line 1: expected a key such as `NPOIN=`, found `NDIME 2`", "X20"),
            ("NPOIN= 1\n0 0\n", "line 1: expected `NDIME=` before points", "X20"),
            ("NDIME= 2\nNZONE= 2\n", "line 2: a mesh of several zones is not supported", "X26"),
            ("NDIME= 2\nNELEM= 0\n", "line 3: the file ends where `NPOIN=` should stand", "X21"),
            ("NDIME= 2\nNPOIN= 0\n", "line 3: the file ends where `NELEM=` should stand", "X21"),
            ("NDIME= 2\nNELEM= 1\n77 0 1 2\n", "line 3: expected a VTK cell type such as 5", "X20"),
            (&with("NMARK= 1\n"), "line 9: 1 markers are declared, but there are 0", "X22"),
            (&with("MARKER_ELEMS= 1\n3 0 1\n"), "line 8: expected `MARKER_TAG=` before", "X20"),
            (
                &with("MARKER_TAG= a\nMARKER_ELEMS= 5\n3 0 1\n"),
                "line 9: 5 elements of a marker",
                "X22",
            ),
            (&with("0 0\n"), "line 8: expected a key such as `NPOIN=`", "X20"),
        ],
    );
}

// spec: X20 X21 X22
#[test]
fn obj_and_netgen() {
    assert_faults(
        MeshForm::Obj,
        &[
            ("# nothing\n", "line 2: the file ends where a vertex should stand", "X21"),
            ("v 0 0\nf 1 2 3\n", "line 2: expected the z coordinate, found `f`", "X20"),
            ("v 0 0 0\nf 1 2\n", "line 2: expected a face with three or more corners", "X20"),
            ("v 0 0 0\nf 1 2 x\n", "line 2: expected the number of a vertex, found `x`", "X20"),
            ("v 0 0 0\nf 1 2 \\\n3\n", "line 2: a continued line is not supported", "X26"),
            ("v 0 0 0\nhello\n", "line 2: expected a statement such as `v` or `f`", "X20"),
        ],
    );
    assert_faults(
        MeshForm::NetgenVol,
        &[
            ("mesh4d\n", "line 1: expected `mesh3d`, found `mesh4d`", "X20"),
            ("mesh3d\npoints\n0\n", "line 4: the file ends where a keyword such as", "X21"),
            ("mesh3d\nendmesh\n", "line 2: expected `points` before `endmesh`", "X20"),
            ("mesh3d\npoints\n5\n0 0 0\nendmesh\n", "line 3: 5 points are declared", "X22"),
            (
                "mesh3d\nsurfaceelements\n1\n1 1 0 0 5 1 2 3 4 5\n",
                "line 4: expected 3, 4, 6 or 8",
                "X20",
            ),
            ("mesh3d\n7\n", "line 2: expected a keyword such as `points`, found `7`", "X20"),
        ],
    );
}

// spec: X20 X22
#[test]
fn ply() {
    let vertex = "element vertex 1\nproperty float x\nproperty float y\n";
    let with = |rest: &str| format!("ply\nformat ascii 1.0\n{rest}");
    let body = |rest: &str| with(&format!("{vertex}{rest}"));
    assert_faults(
        MeshForm::Ply,
        &[
            ("plx\n", "line 1: expected `ply`, found `plx`", "X20"),
            ("ply\nformat text 1.0\n", "line 2: expected ascii or binary_little_endian", "X20"),
            ("ply\nformat ascii 2.0\n", "line 2: expected `1.0`, found `2.0`", "X20"),
            (&with("property float x\n"), "line 3: expected `element` before", "X20"),
            (
                &with("element vertex 1\nproperty real x\n"),
                "line 4: expected a number type such",
                "X20",
            ),
            (
                &with("element vertex 1\nproperty float x\nend_header\n0\n"),
                "line 6: expected vertices",
                "X20",
            ),
            (&with("end_header\n"), "line 4: expected `element vertex`, found `end_header`", "X20"),
            (&with("nonsense\n"), "line 3: expected `element`, `property` or `end_header`", "X20"),
            (
                &body("end_header\n"),
                "line 7: 1 vertices are declared, but the file has room",
                "X22",
            ),
            (&body("end_header\n0 x\n"), "line 7: expected a coordinate, found `x`", "X20"),
            (
                &body("element face 1\nend_header\n0 0\n3 0 0 0\n"),
                "line 8: expected faces with a",
                "X20",
            ),
            (
                &body("element edge 1\nproperty int a\nend_header\n0 0\n3\n"),
                "line 9: expected edges",
                "X20",
            ),
            (
                &body("element x 99\nproperty list uchar int i\nend_header\n0 0\n2 1 1\n"),
                "line 9: 99",
                "X22",
            ),
            (
                &body("element x 1\nproperty list char int i\nend_header\n0 0\n-2 1 1\n"),
                "line 10: -2",
                "X22",
            ),
        ],
    );
}

// spec: X20 X22
#[test]
fn stl() {
    let facet =
        "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n";
    let binary = "x".repeat(80) + "\x02\0\0\0" + &"\0".repeat(50);
    assert_faults(
        MeshForm::Stl,
        &[
            ("solid\n", "line 2: the file ends where `facet` or `endsolid` should", "X21"),
            (&format!("solid\n{facet}"), "line 8: the file ends where `endfacet` should", "X21"),
            (&format!("solid\n{facet}facet"), "line 8: expected `endfacet`, found `facet`", "X20"),
            (
                &format!("solid\n{}", facet.replace("vertex 1", "1")),
                "line 5: expected `vertex`",
                "X20",
            ),
            (&format!("solid\n{}", facet.replace("1 0 0", "1 0")), "line 6: expected the z", "X20"),
            ("solid\nendsolid\nsolid", "line 3: the file ends where `facet` or `endsolid`", "X21"),
            ("no stl at all", "byte 0: the file ends where a header of 80 bytes", "X21"),
            (&binary, "byte 84: 2 triangles are declared, but the file has room for 1", "X22"),
            (
                &(binary.replace('\x02', "\x01") + "more"),
                "byte 84: 1 triangles are declared, but th",
                "X22",
            ),
        ],
    );
}

// spec: X20 X21 X22
#[test]
fn fort14_sms_and_abaqus() {
    let grid = |rest: &str| format!("t\n1 3\n1 0 0 5\n2 1 0 5\n3 0 1 5\n1 3 1 2 3\n{rest}");
    assert_faults(
        MeshForm::Fort14,
        &[
            ("title\n1 9\n1 0 0 1\n", "line 2: 9 nodes are declared, but the file has room", "X22"),
            (
                "t\n1 2\n1 0 0 5\n2 1 0 5\n1 6 1 2 3\n",
                "line 5: expected 3 or 4 corners, found `6`",
                "X20",
            ),
            ("t\n0 2\n1 0 0 5\n1 1 0 5\n", "line 4: point number 1 is given twice", "X24"),
            (&grid("1\n2\n3\n1\n2\n"), "line 12: the file ends where a node of a boundary", "X21"),
            (&grid("-1\n0\n"), "line 7: -1 boundary segments are declared", "X22"),
            (
                &grid("0\n0\n1\n2\n2\n"),
                "line 11: 2 nodes of a boundary segment are declared",
                "X22",
            ),
        ],
    );
    assert_faults(
        MeshForm::Sms2dm,
        &[
            ("MESH3D\n", "line 1: expected `MESH2D`, found `MESH3D`", "X20"),
            ("MESH2D\nE3T 1 1 2 3 1\n", "line 3: the file ends where a node card `ND`", "X21"),
            (
                "MESH2D\nND 1 0 x 0\n",
                "line 2: expected the y coordinate of a point, found `x`",
                "X20",
            ),
            ("MESH2D\nND 1 0 0 0\nND 1 0 0 0\n", "line 3: point number 1 is given twice", "X24"),
            (
                "MESH2D\nND 1 0 0 0\nE3T 1 1 1\n",
                "line 4: the file ends where a node of an elem",
                "X21",
            ),
            (
                "MESH2D\nND 1 0 0 0\nNS 1\n",
                "line 4: the file ends where the end of a node string",
                "X21",
            ),
            ("MESH2D\nND 1 0 0 0\n1 2 3\n", "line 3: expected a card such as `E3T` or `ND`", "X20"),
        ],
    );
    assert_faults(
        MeshForm::Abaqus,
        &[
            ("1, 0, 0\n", "line 1: expected a keyword such as `*NODE`, found `1, 0, 0`", "X20"),
            ("*HEADING\n", "line 2: the file ends where a node after `*NODE` should stand", "X21"),
            ("*NODE\n1, 0, 0,x\n", "line 2: expected a coordinate of a node, found `x`", "X20"),
            ("*NODE\n1, 0, 0\n1, 0, 0\n", "line 3: point number 1 is given twice", "X24"),
            ("*NODE\n1,0\n*ELEMENT\n1,1\n", "line 3: expected `*ELEMENT` with TYPE=", "X20"),
            (
                "*NODE\n1,0\n*ELEMENT,TYPE=S3\n1,1,1\n",
                "line 4: expected as many nodes as the type",
                "X20",
            ),
            (
                "*NODE\n1,0\n*ELEMENT,TYPE=S3\n1,1,1,\n",
                "line 5: the file ends where the rest of",
                "X21",
            ),
            ("*NODE\n1,0\n*NGEN\n1,9\n", "line 3: the keyword *NGEN is not supported", "X26"),
        ],
    );
}
