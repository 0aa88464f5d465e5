//! Reading and writing OBJ files: the traps of the format, the messages of bad files, and the
//! exact round trip.

use std::path::Path;

use proptest::prelude::*;
use quadmend::io::{self, Loaded, OBJ, ReadError, ReadFault, ReadOptions};
use quadmend::mesh::{Point, PolyMesh};

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

fn load(text: &str) -> Loaded {
    OBJ.read(text.as_bytes(), "in.obj", &ReadOptions::default()).unwrap_or_else(|e| panic!("{e}"))
}

fn faces(text: &str) -> Vec<Vec<u32>> {
    load(text).mesh.faces().map(<[u32]>::to_vec).collect()
}

fn fault(bytes: impl AsRef<[u8]>) -> ReadError {
    match OBJ.read(bytes.as_ref(), "in.obj", &ReadOptions::default()) {
        Ok(loaded) => panic!("was read: {loaded:?}"),
        Err(error) => error,
    }
}

/// Asserts that the message names the file, the line and all of `parts`.
fn assert_names(error: &ReadError, line: usize, parts: &[&str]) {
    let message = error.to_string();
    assert!(message.starts_with(&format!("in.obj:{line}: ")), "{message}");
    for part in parts {
        assert!(message.contains(part), "no `{part}` in: {message}");
    }
}

fn square_and(rest: &str) -> String {
    format!("{SQUARE}{rest}")
}

// The traps of the format and of the parser.

#[test]
fn groups_and_materials_do_not_tear_the_mesh() {
    let text = square_and(
        "v 2 0 0\nv 2 1 0\nmtllib a.mtl\no left\ng one\nf 1 2 3 4\nusemtl red\ng two\nf 2 5 6 3\n",
    );
    let Loaded { mesh, warnings, .. } = load(&text);
    assert_eq!(mesh.vertex_count(), 6);
    assert_eq!(mesh.face(1), [1, 4, 5, 2]);
    assert_eq!(mesh.group_names(), ["", "one", "two"]);
    assert_eq!(mesh.groups(), [1, 2]);
    assert_eq!(warnings.len(), 1);
    let message = warnings[0].to_string();
    assert!(message.contains("in.obj: materials") && message.contains("line 7"), "{message}");
}

#[test]
fn a_group_may_be_left_and_entered_again() {
    let text = square_and("f 1 2 3\ng a  b #c\nf 1 2 4\ng\nf 2 3 4\ng a b\nf 1 3 4\ng unused\n");
    let mesh = load(&text).mesh;
    assert_eq!(mesh.group_names(), ["", "a b"]);
    assert_eq!(mesh.groups(), [0, 1, 0, 1]);
}

#[test]
fn line_elements_are_no_faces() {
    let text = square_and("l 1 2 3\np 1\nf 1 2 3 4\n");
    assert_eq!(faces(&text), [[0, 1, 2, 3]]);
    assert!(load(&text).warnings[0].to_string().contains("lines and points"));
}

#[test]
fn vertices_keep_the_order_of_the_file() {
    let text = square_and("v 9 9 9\nf 4 3 2 1\n");
    let mesh = load(&text).mesh;
    assert_eq!(mesh.face(0), [3, 2, 1, 0]);
    assert_eq!(mesh.points()[4], Point::new(9.0, 9.0, 9.0));
}

#[test]
fn triangle_meshes_have_faces() {
    assert_eq!(faces("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), [[0, 1, 2]]);
    assert_eq!(faces(&square_and("f 1 2 3\nf 1 3 4\n")), [[0, 1, 2], [0, 2, 3]]);
}

#[test]
fn continuations_and_trailing_comments_are_understood() {
    let text = "v 0 0 \\\n0 # origin\nv 1 0 0# x\nv 1 1 0\nf 1 \\\r\n 2 \\\r\n 3 # ok \\\nf 3 2 1";
    assert_eq!(faces(text), [[0, 1, 2], [2, 1, 0]]);
}

#[test]
fn texture_and_normal_indices_are_taken_off() {
    let text = square_and("vt 0 0\nvn 0 0 1\nf 1/1 2//1 3/1/1 4\n");
    assert_eq!(faces(&text), [[0, 1, 2, 3]]);
    let message = load(&text).warnings[0].to_string();
    assert!(message.contains("texture coordinates, normals"), "{message}");
}

#[test]
fn negative_indices_count_back_from_the_face() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 0 0 1\nf -1 -2 -3\n";
    assert_eq!(faces(text), [[0, 1, 2], [3, 2, 1]]);
}

#[test]
fn faces_may_come_before_their_vertices() {
    assert_eq!(faces(&format!("f 1 2 3 4\n{SQUARE}")), [[0, 1, 2, 3]]);
}

#[test]
fn degenerate_faces_are_left_for_mending() {
    let text = square_and("f\nf 1\nf 1 2\nf 1 1 2 2\nf 1 2 1 2 1\n");
    let want: [&[u32]; 5] = [&[], &[0], &[0, 1], &[0, 0, 1, 1], &[0, 1, 0, 1, 0]];
    assert_eq!(faces(&text), want);
}

#[test]
fn colours_and_weights_do_not_move_vertices() {
    let mesh = load("v 2 0 0 2\nv 1 0 0 .5 .5 .5\nv 0 1 0 1 1 1 1\nf 1 2 3\n").mesh;
    assert_eq!(mesh.points()[0], Point::new(2.0, 0.0, 0.0));
}

#[test]
fn line_ends_marks_and_blanks_of_all_systems_are_accepted() {
    let text = square_and("f 1 2 3 4\n");
    let want = load(&text);
    for other in [
        text.replace('\n', "\r\n"),
        text.replace('\n', "\r"),
        format!("\u{feff}{text}"),
        text.replace(' ', " \t "),
        text.replace('\n', "  \n\n"),
        text.trim_end().to_owned(),
    ] {
        let got = load(&other);
        assert_eq!(
            (got.mesh, got.warnings),
            (want.mesh.clone(), want.warnings.clone()),
            "{other:?}"
        );
    }
}

#[test]
fn comments_may_be_in_any_encoding() {
    let mut bytes = b"# caf\xe9 C:\\\n".to_vec();
    bytes.extend_from_slice(square_and("f 1 2 3 4\n").as_bytes());
    assert!(OBJ.read(&bytes[..], "in.obj", &ReadOptions::default()).is_ok());
}

// Bad input, and what it is told.

#[test]
fn syntax_errors_name_file_line_and_words() {
    assert_names(&fault("v 0 0\n"), 1, &["fewer than three coordinates", "`v 0 0`"]);
    assert_names(&fault("v 0 zero 0\nf 1\n"), 1, &["no number", "`zero`"]);
    assert_names(&fault(square_and("f 1 2 x\n")), 5, &["no whole number", "`x`", "7/8/9"]);
    assert_names(&fault(square_and("f 1 2 3.5\n")), 5, &["`3.5`"]);
    assert_names(&fault(square_and("f 1 2 /3\n")), 5, &["`/3`"]);
    assert_names(&fault(square_and("f 1 2 3/4/5/6\n")), 5, &["`3/4/5/6`"]);
    assert_names(&fault(square_and("\nface 1 2 3\n")), 6, &["no OBJ statement", "`face 1 2 3`"]);
    assert_names(&fault("v 1\u{a0}2 3 4\nf 1 1 1\n"), 1, &["no number"]);
}

#[test]
fn decimal_commas_are_explained() {
    let error = fault("v 0 0 0\n\nv 1,5 2,0 3,0\nf 1 2 2\n");
    assert_names(&error, 3, &["comma", "`1,5`", "point"]);
}

#[test]
fn indices_out_of_range_name_the_line() {
    let message = |face: &str| fault(square_and(face));
    assert_names(&message("f 1 2 3\nf 1 2 5\n"), 6, &["face 2", "vertex 5", "vertices 1 to 4"]);
    assert_names(&message("f 0 1 2\n"), 5, &["vertex 0"]);
    assert_names(&message("f 1 2 -5\n"), 5, &["vertex -5"]);
    assert_names(&message("f 1 2 99999999999999999999999\n"), 5, &["vertex 9999"]);
    assert_names(&message("f 1 2 -9223372036854775808\n"), 5, &["vertex -9223"]);
    assert_names(&fault("f 1 2 3\n"), 1, &["vertex 1"]);
}

#[test]
fn numbers_that_are_not_finite_name_the_line() {
    for word in ["nan", "NaN", "inf", "-Infinity", "1e999", "-1e400", "1e101"] {
        let error = fault(format!("v 0 0 0\n# c\nv 0 {word} 0\nv 1 1 1\nf 1 2 3\n"));
        assert_names(&error, 3, &["vertex 2", word, "finite"]);
    }
}

#[test]
fn empty_files_are_refused() {
    for text in ["", "\n\n", "# only a comment\n", "\u{feff}", "g a\ns 1\n"] {
        assert!(matches!(fault(text).fault, ReadFault::Empty), "{text:?}");
    }
}

#[test]
fn files_without_faces_are_refused() {
    let error = fault(SQUARE);
    assert!(matches!(error.fault, ReadFault::NoFaces { vertices: 4 }));
    assert!(error.to_string().contains("4 vertices but no faces"));
}

#[test]
fn binary_junk_is_refused() {
    let error = fault(b"\x7fELF\x01\0\0");
    assert!(matches!(error.fault, ReadFault::Binary { offset: 5 }));
    assert_names(&error, 1, &["byte 5"]);
    let error = fault(b"\x1f\x8c\x08\x08\x9d");
    assert!(matches!(error.fault, ReadFault::Syntax { .. }));
    assert!(!error.to_string().contains('\x1f'), "{error:?}");
}

#[test]
fn other_encodings_are_refused() {
    let utf16: Vec<u8> = "\u{feff}v 0 0 0".encode_utf16().flat_map(u16::to_le_bytes).collect();
    assert!(matches!(fault(utf16).fault, ReadFault::NotUtf8));
    let mut latin = SQUARE.as_bytes().to_vec();
    latin.extend_from_slice(b"g caf\xe9\nf 1 2 3\n");
    assert_names(&fault(latin), 5, &["UTF-8"]);
}

#[test]
fn a_file_cut_in_the_middle_is_refused() {
    for end in ["f 1 2", "f 1 ", "f", "v 1 2", "v 1 2 \\", "f 1 2 3 \\\n"] {
        let error = fault(square_and(&format!("f 1 2 3 4\n{end}")));
        assert_names(&error, 6, &["was cut"]);
    }
}

#[test]
fn long_words_are_shortened_in_messages() {
    let error = fault(format!("v 0 0 {}\n", "x".repeat(1_000_000)));
    assert!(error.to_string().len() < 200);
}

#[test]
fn missing_files_folders_and_unknown_names_are_told_apart() {
    let folder = tempfile::tempdir().unwrap();
    let message = |name: &str| io::read(&folder.path().join(name)).unwrap_err();
    assert!(matches!(message("no.obj").fault, ReadFault::Missing));
    assert!(message("no.obj").to_string().contains("no.obj: no such file"));
    assert!(matches!(message("no.such").fault, ReadFault::Missing));
    assert!(matches!(message("").fault, ReadFault::Directory));
    std::fs::write(folder.path().join("a.xyz"), "1").unwrap();
    assert!(message("a.xyz").to_string().contains("`.xyz`"));
    assert!(message("a.xyz").to_string().contains(".obj"));
    std::fs::write(folder.path().join("a"), "1").unwrap();
    assert!(matches!(message("a").fault, ReadFault::UnknownFormat { .. }));
}

#[cfg(unix)]
#[test]
fn unreadable_files_are_told() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("secret.obj");
    std::fs::write(&path, SQUARE).unwrap();
    std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o000)).unwrap();
    // The superuser may read it all the same.
    if std::fs::read(&path).is_err() {
        let error = io::read(&path).unwrap_err();
        assert!(matches!(error.fault, ReadFault::Unreadable(_)), "{error}");
    }
}

#[test]
fn upper_case_extensions_are_known() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("A.OBJ");
    let mesh = load(&square_and("f 1 2 3 4\n")).mesh;
    io::write(&path, &mesh).unwrap();
    assert_eq!(io::read(&path).unwrap().mesh, mesh);
    let refused = io::write(Path::new("a.xyz"), &mesh).unwrap_err();
    assert!(refused.to_string().contains("`.xyz`"));
}

// Writing.

fn written(mesh: &PolyMesh) -> String {
    String::from_utf8(OBJ.bytes(mesh, None)).unwrap()
}

#[test]
fn what_is_written_is_short_and_plain() {
    let points = vec![Point::new(0.1, -0.0, 1e-300), Point::new(3.0, 1e16, 1e-5)];
    let mesh = PolyMesh::new(points, [[0, 1, 0]]).unwrap();
    assert_eq!(written(&mesh), "v 0.1 -0 1e-300\nv 3 1e16 0.00001\nf 1 2 1\n");
}

#[test]
fn groups_are_written_where_there_are_any() {
    let text = square_and("f 1 2 3\ng a b\nf 1 2 4\ng c\\#d\nf 1 2 4\ng\nf 2 3 4\n");
    let mesh = load(&text).mesh;
    assert!(written(&mesh).contains("g\nf 1 2 3\ng a b\nf 1 2 4\ng c\\#d\n"));
    assert_eq!(load(&written(&mesh)).mesh, mesh);
}

#[test]
fn awkward_group_names_cannot_break_the_file() {
    let mesh = load(&square_and("f 1 2 3 4\n")).mesh;
    let names = vec!["x\nv 1 2 #y\\".to_owned()];
    let text = written(&mesh.with_groups(vec![0], names));
    assert!(text.contains("\ng x v 1 2 _y_\nf"), "{text}");
    assert_eq!(load(&text).mesh.face_count(), 1);
}

fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        any::<f64>().prop_filter("in range", |x| x.is_finite() && x.abs() <= 1e100),
        -1.0..1.0,
        (-9..9_i32, -320..100_i32).prop_map(|(m, e)| f64::from(m) * 10_f64.powi(e)),
        any::<i64>().prop_map(|i| i as f64 / 3.0),
        Just(f64::MIN_POSITIVE),
        Just(5e-324),
        Just(0.1 + 0.2),
    ]
}

fn soup() -> impl Strategy<Value = PolyMesh> {
    let points = prop::collection::vec([coordinate(), coordinate(), coordinate()], 1..40);
    let faces = prop::collection::vec(
        (prop::collection::vec(any::<prop::sample::Index>(), 0..9), 0..3_u32),
        1..30,
    );
    (points, faces).prop_map(|(points, faces)| {
        let n = points.len();
        let corners = faces.iter().map(|(f, _)| f.iter().map(|i| i.index(n) as u32).collect());
        let mesh = PolyMesh::new(points.into_iter().map(Point::from).collect(), {
            let corners: Vec<Vec<u32>> = corners.collect();
            corners
        });
        let names = ["", "wing", "nut 2"].map(str::to_owned).to_vec();
        mesh.unwrap().with_groups(faces.iter().map(|&(_, g)| g).collect(), names)
    })
}

proptest! {
    #[test]
    fn a_mesh_written_and_read_is_the_same_mesh(mesh in soup()) {
        let again = load(&written(&mesh)).mesh;
        let bits = |m: &PolyMesh| -> Vec<[u64; 3]> {
            m.points().iter().map(|p| [p.x.to_bits(), p.y.to_bits(), p.z.to_bits()]).collect()
        };
        prop_assert_eq!(bits(&again), bits(&mesh));
        prop_assert_eq!(again.corners(), mesh.corners());
        prop_assert_eq!(again.offsets(), mesh.offsets());
        let name = |m: &PolyMesh, f: usize| m.group_names()[m.groups()[f] as usize].clone();
        for f in 0..mesh.face_count() {
            prop_assert_eq!(name(&again, f), name(&mesh, f));
        }
    }

    #[test]
    fn no_bytes_make_the_reader_panic(
        lines in prop::collection::vec("(v|f|g|o|l|vt|#|)[ -9/\\\\.e#\t]{0,20}(\n|\r\n|\\\\\n|)", 0..30)
    ) {
        let _ = OBJ.read(lines.concat().as_bytes(), "in.obj", &ReadOptions::default());
    }

    #[test]
    fn no_junk_makes_the_reader_panic(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        let _ = OBJ.read(&bytes[..], "in.obj", &ReadOptions::default());
    }
}
