use super::*;
use proptest::prelude::*;

fn read(text: &[u8], form: PointForm) -> Result<PointFile, PointReadError> {
    read_points(text, form, None)
}

fn set(text: impl AsRef<[u8]>, form: PointForm) -> PointSet {
    match read(text.as_ref(), form).expect("sound") {
        PointFile::Points(set) => set,
        PointFile::Domain(domain) => panic!("points, not {domain:?}"),
    }
}

fn points(text: impl AsRef<[u8]>, form: PointForm) -> Vec<[f64; 2]> {
    set(text, form).points.into_iter().map(Into::into).collect()
}

#[track_caller]
fn assert_faults(form: PointForm, cases: &[(&str, &str, &str)]) {
    for (text, start, rule) in cases {
        let error = read(text.as_bytes(), form).expect_err(text);
        assert!(error.to_string().starts_with(start), "{text:?}: {error}");
        assert_eq!(error.rule(), *rule, "{text:?}: {error}");
    }
}

const FOUR: [[f64; 2]; 4] = [[0.0, 0.0], [1.5, -2.0], [1e300, 5e-324], [0.0, 0.0]];

// spec: X40
#[test]
fn every_form_gives_the_same_points() {
    for (form, text) in [
        (PointForm::Node, "4 2 0 0\n1 0 0\n2 1.5 -2\n3 1e300 5e-324\n4 0 0\n"),
        (PointForm::Xyz, "# points\n0 0\n1.5\t-2 # two\n\n 1e300 5e-324\n0 0"),
        (PointForm::Csv, "0,0\n1.5,-2\n1e300,5e-324\n0,0\n"),
        (PointForm::Csv, "\u{feff}x;y\r\n0;0\r\n1.5;-2\r\n\r\n# no\r\n1e300;5e-324\r\n0;0"),
        (PointForm::Csv, "x\ty\n0\t0\n1.5\t-2\n1e300\t5e-324\n\"0\"\t 0 \n"),
        (PointForm::Json, "[[0,0],[1.5,-2],[1e300,5e-324],[0,0]]"),
        (PointForm::Json, "{\"comment\":1,\"points\":[[0,0],[1.5,-2],[1e300,5e-324],[0,0]]}"),
    ] {
        assert_eq!(points(text, form), FOUR, "{text}");
        assert!(set(text, form).left_out.is_empty(), "{text}");
    }
}

// spec: X40
#[test]
fn domains_are_read_as_domains() {
    for (form, text) in [
        (PointForm::Json, "{\"outer\":[[0,0],[1,0],[0,1]]}"),
        (PointForm::Json, "{\"type\":\"Point\",\"coordinates\":[1,2]}"),
        (PointForm::Json, "{\"points\":[[0,0]],\"segments\":[],\"loops\":[]}"),
        (PointForm::Domain(DomainForm::GeoJson), "{\"type\":\"Point\",\"coordinates\":[1,2]}"),
        (PointForm::Domain(DomainForm::Poly), "1 2 0 0\n1 0 0\n0 0\n0\n"),
    ] {
        assert!(matches!(read(text.as_bytes(), form), Ok(PointFile::Domain(_))), "{text}");
    }
}

// spec: X41
#[test]
fn what_is_left_out_is_said() {
    let said = |text: &str, form| set(text, form).left_out;
    assert_eq!(said("1 2 3\n4 5\n", PointForm::Xyz), [THIRD]);
    assert_eq!(said("1 2 3 red\n", PointForm::Xyz), [THIRD, "columns beyond the third"]);
    assert_eq!(said("[[1,2,3]]", PointForm::Json), [THIRD]);
    assert_eq!(said("1 3 0 0\n1 1 2 3\n", PointForm::Node), [THIRD]);
    assert!(said("1 3 0 0\n1 1 2 0\n", PointForm::Node).is_empty());
    assert_eq!(said("1,2,3\n", PointForm::Csv), ["column 3"]);
    assert_eq!(said("y,name,x\n1,a,2\n", PointForm::Csv), ["column `name`"]);
    let wide = "x,y,a,b,c,d,e,f\n1,2,3,4,5,6,7,8\n";
    assert_eq!(said(wide, PointForm::Csv), ["columns `a`, `b`, `c`, `d`, 2 more"]);
}

// spec: X42
#[test]
fn names_choose_the_columns_of_a_csv_file() {
    for text in [
        "y,x\n2,1\n",
        "id,Y,X\n7,2,1\n",
        "name,lat,lon\na,2,1\n",
        "Northing,Easting\n2,1\n",
        "a,b\n1,2\n",
        "\"first name\",\"x,y\",z\n1,2,3\n",
        "1,2\n",
    ] {
        assert_eq!(points(text, PointForm::Csv), [[1.0, 2.0]], "{text}");
    }
    assert!(points("x,y\n", PointForm::Csv).is_empty());
}

// spec: X40
#[test]
fn points_keep_their_lines() {
    let lines = |text: &str, form| {
        let set = set(text, form);
        (0..set.points.len() as u32).map(|i| set.lines.line(i)).collect::<Vec<_>>()
    };
    assert_eq!(lines("x,y\n1,2\n\n3,4\n", PointForm::Csv), [Some(2), Some(4)]);
    assert_eq!(lines("# no\n1 2\n3 4\n\n5 6", PointForm::Xyz), [Some(2), Some(3), Some(5)]);
    assert_eq!(lines("1 2 0 0\n\n1 5 6\n", PointForm::Node), [Some(3)]);
}

// spec: X2 X20 X23 X43
#[test]
fn text_that_is_no_point_is_refused_with_its_line() {
    assert_faults(
        PointForm::Xyz,
        &[
            ("1 2\n3\n4 5\n", "line 2: expected two coordinates in a line", "X20"),
            ("1 2\nx y\n", "line 2: expected the x coordinate of a point, found `x`", "X20"),
            ("1,5 2\n", "line 1: expected the x coordinate of a point, found `1,5`", "X20"),
            ("1 1e999\n", "line 1: `1e999` is beyond the range of f64", "X23"),
            ("1 2\n1 nan\n", "line 2: `NaN` is beyond the range of finite", "X23"),
            ("-inf 0\n", "line 1: `-inf` is beyond", "X23"),
        ],
    );
    assert_faults(
        PointForm::Csv,
        &[
            ("1 2\n", "line 1: expected columns separated by commas", "X20"),
            ("x,y\n1\n", "line 2: expected columns separated by commas", "X20"),
            ("x,y\n1,2\n3,\n", "line 3: expected the y coordinate of a point", "X20"),
            ("x,y\nx,y\n", "line 2: expected the x coordinate of a point, found `x`", "X20"),
            ("1,2\nx,y\n", "line 2: expected the x coordinate of a point, found `x`", "X20"),
            ("1;2\n1,5;2\n", "line 2: expected the x coordinate of a point, found `1,5`", "X20"),
            ("1,inf\n", "line 1: `inf` is beyond the range of finite", "X23"),
            ("1,1e400\n", "line 1: `1e400` is beyond the range of f64", "X23"),
        ],
    );
    assert_faults(
        PointForm::Json,
        &[
            ("[[1]]", "$[0]: expected a point [x, y], found an array of 1", "X4"),
            ("[[1,2,3,4]]", "$[0]: expected a point [x, y], found 4 numbers", "X4"),
            ("[[1,\"2\"]]", "$[0][1]: expected a number", "X4"),
            ("[1,2]", "$[0]: expected a point", "X4"),
            ("7", "$: expected an array of points", "X4"),
            ("[[1,1e999]]", "line 1: this is not JSON: number out of range", "X1"),
            ("[[1,NaN]]", "line 1: this is not JSON", "X1"),
            ("{\"points\":3}", "$.points: expected an array of points", "X4"),
            ("[[1,2]", "line 1: this is not JSON: EOF", "X1"),
        ],
    );
    assert_faults(
        PointForm::Node,
        &[
            ("9 2 0 0\n1 0 0\n", "line 1: 9 points are declared", "X22"),
            ("1 2 0 0\n1 0 nan\n", "line 2: `NaN`", "X23"),
            ("1 2 0 0\n1 0 0\n2 1 1\n", "line 3: expected the end of the file", "X20"),
        ],
    );
}

/// A `NumPy` file.
fn npy(header: &str, data: &[u8]) -> Vec<u8> {
    let mut file = b"\x93NUMPY\x01\x00".to_vec();
    file.extend((header.len() as u16).to_le_bytes());
    file.extend(header.as_bytes());
    file.extend(data);
    file
}

fn header(descr: &str, by_columns: bool, shape: &str) -> String {
    let order = if by_columns { "True" } else { "False" };
    format!("{{'descr': '{descr}', 'fortran_order': {order}, 'shape': {shape}, }}          \n")
}

// spec: X44
#[test]
fn numpy_arrays_of_every_type_and_order() {
    // 1, 2; 3, 4; 5, 6 by rows.
    let rows = [1, 2, 3, 4, 5, 6];
    let columns = [1, 3, 5, 2, 4, 6];
    let expected = [[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]];
    for (order, by_columns) in [(rows, false), (columns, true)] {
        for size in [1, 2, 4, 8] {
            for (mark, kinds) in [('<', "iuf"), ('>', "iuf")] {
                for kind in kinds.chars().filter(|&k| k != 'f' || size >= 4) {
                    let bytes = |v: i64| -> Vec<u8> {
                        let mut bytes = match (kind, size) {
                            ('f', 4) => (v as f32).to_le_bytes().to_vec(),
                            ('f', _) => (v as f64).to_le_bytes().to_vec(),
                            _ => v.to_le_bytes()[..size].to_vec(),
                        };
                        if mark == '>' {
                            bytes.reverse();
                        }
                        bytes
                    };
                    let data: Vec<u8> = order.into_iter().flat_map(bytes).collect();
                    let head = header(&format!("{mark}{kind}{size}"), by_columns, "(3, 2)");
                    assert_eq!(points(npy(&head, &data), PointForm::Npy), expected, "{head}");
                }
            }
        }
    }
    let negative = npy(&header("|i1", false, "(1, 2)"), &[0xff, 0x80]);
    assert_eq!(points(negative, PointForm::Npy), [[-1.0, -128.0]]);
    let large = npy(&header("<u8", false, "(1, 2)"), &[0xff; 16]);
    assert_eq!(points(large, PointForm::Npy), [[2.0_f64.powi(64); 2]]);
}

// spec: X41 X44
#[test]
fn a_numpy_array_of_three_columns_loses_the_third() {
    let data: Vec<u8> = [1.0_f64, 2.0, 3.0].iter().flat_map(|v| v.to_le_bytes()).collect();
    let set = set(npy(&header("<f8", false, "(1, 3)"), &data), PointForm::Npy);
    assert_eq!((set.points, set.left_out), (vec![Point2::new(1.0, 2.0)], vec![THIRD.to_owned()]));
    assert!(points(npy(&header("<f8", false, "(0, 2)"), &[]), PointForm::Npy).is_empty());
}

// spec: X22 X26 X44
#[test]
fn numpy_files_that_lie_are_refused_without_memory() {
    let nan = [f64::NAN.to_le_bytes(), 0.0_f64.to_le_bytes()].concat();
    let cases = [
        (b"PK\x03\x04 zipped".to_vec(), "X20"),
        (b"\x93NUMPY".to_vec(), "X21"),
        (b"\x93NUMPY\x07\x00\x00\x00\x00\x00".to_vec(), "X26"),
        (b"\x93NUMPY\x02\x00\xff\xff\xff\xffabc".to_vec(), "X21"),
        (npy("{}", &[]), "X20"),
        (npy(&header("<f8", false, "(1099511627776, 2)"), &[0; 64]), "X22"),
        (npy(&header("<f8", false, "(999999999999999999, 3)"), &[0; 64]), "X22"),
        (npy(&header("<f8", false, "(9999999999999999999, 2)"), &[0; 64]), "X23"),
        (npy(&header("<f8", false, "(2, 2)"), &[0; 31]), "X22"),
        (npy(&header("<f8", false, "(2, 2)"), &[0; 33]), "X22"),
        (npy(&header("<f8", false, "(-1, 2)"), &[]), "X20"),
        (npy(&header("<f8", false, "(4,)"), &[0; 32]), "X20"),
        (npy(&header("<f8", false, "(2, 4)"), &[0; 64]), "X20"),
        (npy(&header("<f8", false, "(1, 2, 2)"), &[0; 32]), "X20"),
        (npy(&header("<f8", false, "("), &[0; 32]), "X20"),
        (npy(&header("<f2", false, "(1, 2)"), &[0; 4]), "X26"),
        (npy(&header("<c16", false, "(1, 2)"), &[0; 32]), "X26"),
        (npy(&header("|O", false, "(1, 2)"), &[0; 32]), "X26"),
        (npy(&header("f8", false, "(1, 2)"), &[0; 16]), "X20"),
        (npy("{'descr': [('x', '<f8')], 'fortran_order': False, 'shape': (1, 2)}", &[]), "X26"),
        (npy("{'descr': '<f8', 'fortran_order': Maybe, 'shape': (1, 2)}", &[]), "X20"),
        (npy(&header("<f8", false, "(1, 2)"), &nan), "X23"),
    ];
    for (file, rule) in cases {
        let text = String::from_utf8_lossy(&file).into_owned();
        let error = read(&file, PointForm::Npy).expect_err(&text);
        assert_eq!(error.rule(), rule, "{text}: {error}");
        assert!(error.to_string().starts_with("byte "), "{error}");
    }
}

#[test]
fn extensions_name_forms() {
    for extension in PointForm::EXTENSIONS.split(", ") {
        assert!(PointForm::from_extension(&extension.to_uppercase()).is_some(), "{extension}");
    }
    for other in ["", "off", "msh", "csv2", "npz"] {
        assert_eq!(PointForm::from_extension(other), None, "{other}");
    }
}

const TABLES: [PointForm; 5] =
    [PointForm::Node, PointForm::Csv, PointForm::Xyz, PointForm::Npy, PointForm::Json];

proptest! {
    // spec: X45
    #[test]
    fn any_bytes_are_read_or_refused(
        bytes in prop::collection::vec(any::<u8>(), 0..200), form in 0..TABLES.len(),
    ) {
        match read(&bytes, TABLES[form]) {
            Ok(PointFile::Points(set)) => {
                prop_assert!(set.points.len() <= bytes.len());
                prop_assert!(set.points.iter().all(|p| p.is_finite()));
            }
            Ok(PointFile::Domain(_)) => {}
            Err(error) => prop_assert!(!error.rule().is_empty() && !error.to_string().is_empty()),
        }
    }

    // spec: X40
    #[test]
    fn any_finite_points_survive_every_text_form(
        values in prop::collection::vec(any::<[f64; 2]>(), 0..20),
    ) {
        let values: Vec<[f64; 2]> =
            values.into_iter().filter(|v| v.iter().all(|c| c.is_finite())).collect();
        let lines = |between: &str| -> String {
            values.iter().map(|[x, y]| format!("{x:e}{between}{y:e}\n")).collect()
        };
        prop_assert_eq!(&points(lines(" "), PointForm::Xyz), &values);
        prop_assert_eq!(&points(lines(","), PointForm::Csv), &values);
        prop_assert_eq!(&points(serde_json::to_string(&values).unwrap(), PointForm::Json), &values);
        let data: Vec<u8> = values.iter().flatten().flat_map(|v| v.to_le_bytes()).collect();
        let file = npy(&header("<f8", false, &format!("({}, 2)", values.len())), &data);
        prop_assert_eq!(&points(file, PointForm::Npy), &values);
    }
}
