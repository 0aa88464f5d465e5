//! Every format there and back, packed and not: to the last bit, and nothing on the way that a
//! person is not told.

use std::fs;
use std::path::Path;

use proptest::prelude::*;
use quadmend::io::{
    self, Destination, FORMATS, Format, Loaded, OBJ, OFF, PLY, PLY_ASCII, PLY_BIG_ENDIAN,
    ReadError, ReadFault, ReadOptions, STL,
};
use quadmend::mesh::{Point, PolyMesh, shapes};

/// Formats that can be written.
const WRITTEN: [Format; 5] = [OBJ, PLY, PLY_ASCII, PLY_BIG_ENDIAN, OFF];

fn read(format: Format, bytes: &[u8]) -> Result<Loaded, ReadError> {
    format.read(bytes, "in", &ReadOptions::default())
}

fn load(format: Format, bytes: impl AsRef<[u8]>) -> Loaded {
    read(format, bytes.as_ref()).unwrap_or_else(|e| panic!("{e}"))
}

#[track_caller]
fn refused(format: Format, bytes: impl AsRef<[u8]>, parts: &[&str]) {
    let error = read(format, bytes.as_ref()).map(|loaded| loaded.mesh).unwrap_err().to_string();
    for part in parts {
        assert!(error.contains(part), "no `{part}` in: {error}");
    }
    assert!(error.len() < 300, "{error}");
}

fn bits(mesh: &PolyMesh) -> Vec<[u64; 3]> {
    mesh.points().iter().map(|p| [p.x.to_bits(), p.y.to_bits(), p.z.to_bits()]).collect()
}

fn assert_same(a: &PolyMesh, b: &PolyMesh) {
    assert_eq!((bits(a), a.corners(), a.offsets()), (bits(b), b.corners(), b.offsets()));
}

// There and back.

/// Polygons of any degree on numbers of every size.
fn odd_mesh() -> PolyMesh {
    let numbers = [0.1 + 0.2, -0.0, 5e-324, 1e100, -1.0 / 3.0, 1e16, 123_456_789.123_456_79];
    let point = |i: usize| Point::new(numbers[i % 7], numbers[(i + 1) % 7], numbers[(i + 3) % 7]);
    let faces = [vec![0, 1, 2], vec![], vec![4], vec![5, 6], (0..300).collect(), vec![3, 2, 1, 0]];
    PolyMesh::new((0..300).map(point).collect(), faces).unwrap()
}

#[test]
fn every_format_keeps_every_bit_in_files_packed_or_not() {
    let folder = tempfile::tempdir().unwrap();
    for (mesh, what) in [(odd_mesh(), "odd"), (shapes::torus(12, 7), "torus")] {
        for format in WRITTEN {
            for end in ["", ".gz", ".GZ"] {
                let name = format!("{what}-{}.{}{end}", format.name, format.extensions[0]);
                let path = folder.path().join(name);
                Destination::new(&path, Some(format)).unwrap().write(&mesh).unwrap();
                let loaded = io::read(&path).unwrap();
                assert_same(&loaded.mesh, &mesh);
                assert_eq!(loaded.warnings, [], "{}", path.display());
                let packed = fs::read(&path).unwrap().starts_with(b"\x1f\x8b");
                assert_eq!(packed, !end.is_empty());
            }
        }
    }
}

#[test]
fn the_format_is_told_by_the_name() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = shapes::grid(2, 2);
    for (name, start) in [
        ("a.ply", "ply\nformat binary_little"),
        ("a.off", "OFF"),
        ("a.OFF", "OFF"),
        ("a.b.obj", "v "),
    ] {
        let path = folder.path().join(name);
        io::write(&path, &mesh).unwrap();
        assert!(fs::read(&path).unwrap().starts_with(start.as_bytes()), "{name}");
    }
    for name in ["a", "a.gz", "a.xyz.gz", "a.stl", "a.stl.gz"] {
        let error = io::write(&folder.path().join(name), &mesh).unwrap_err().to_string();
        assert!(error.contains(".obj, .ply, .off, each also with .gz"), "{error}");
    }
}

#[test]
fn the_same_mesh_packs_to_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let [a, b] = ["a.ply.gz", "b.ply.gz"].map(|name| {
        let path = folder.path().join(name);
        io::write(&path, &shapes::torus(9, 9)).unwrap();
        fs::read(path).unwrap()
    });
    assert!(a == b);
}

#[test]
fn colours_of_views_are_written_and_dropped_with_a_warning() {
    let mesh = shapes::grid(3, 2);
    let colours = vec![[1.0, 0.5, 0.0]; mesh.vertex_count()];
    for format in WRITTEN {
        let loaded = load(format, format.bytes(&mesh, Some(&colours)));
        assert_same(&loaded.mesh, &mesh);
        assert!(loaded.warnings[0].to_string().contains("colours"), "{}", format.name);
    }
}

fn coordinate() -> impl Strategy<Value = f64> {
    let any = any::<f64>().prop_filter("in range", |x| x.is_finite() && x.abs() <= 1e100);
    prop_oneof![any, -1.0..1.0]
}

proptest! {
    #[test]
    fn any_soup_comes_back_from_any_format(
        points in prop::collection::vec([coordinate(), coordinate(), coordinate()], 1..30),
        faces in prop::collection::vec(
            prop::collection::vec(any::<prop::sample::Index>(), 0..9), 1..20),
    ) {
        let n = points.len();
        let faces = faces.iter().map(|f| f.iter().map(|i| i.index(n) as u32).collect::<Vec<_>>());
        let mesh = PolyMesh::new(points.into_iter().map(Point::from).collect(), faces).unwrap();
        for format in WRITTEN {
            assert_same(&load(format, format.bytes(&mesh, None)).mesh, &mesh);
        }
    }

    #[test]
    fn any_cut_or_changed_file_is_read_or_refused(
        cut in any::<prop::sample::Index>(),
        at in any::<prop::sample::Index>(),
        byte in any::<u8>(),
    ) {
        for format in WRITTEN {
            let mut bytes = format.bytes(&shapes::cube(2), None);
            let _ = read(format, &bytes[..cut.index(bytes.len())]);
            let at = at.index(bytes.len());
            bytes[at] = byte;
            let _ = read(format, &bytes);
        }
    }
}

// PLY.

const PLY_HEADER: &str = "ply\nformat ascii 1.0\ncomment caf\u{e9}\nelement vertex 3\n\
     property float x\nproperty float y\nproperty float z\n";
const PLY_FACE: &str = "element face 1\nproperty list uchar int vertex_index\nend_header\n";
const PLY_DATA: &str = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

#[test]
fn ply_of_other_programs_is_understood() {
    let plain = load(PLY, [PLY_HEADER, PLY_FACE, PLY_DATA].concat()).mesh;
    assert_eq!(plain.face(0), [0, 1, 2]);
    // Other properties, other elements, faces before vertices, Windows line ends.
    let text = "ply\nformat ascii 1.0\nobj_info x\nelement face 1\n\
        property uint8 flags\nproperty list uint8 uint32 vertex_indices\n\
        property list uchar float texcoord\nelement nothing 99999999999\nelement edge 1\n\
        property int vertex1\nproperty int vertex2\nelement vertex 3\nproperty uchar red\n\
        property float64 x\nproperty list int int more\nproperty float64 y\nproperty float64 z\n\
        end_header\n\n7 3 0 1 2 2 .5 .5\n0 1\n9 0 1 5 0 0\n9 1 0 0 0\n9 0 2 1 1 1 0\n";
    for text in [text.to_owned(), text.replace('\n', "\r\n"), text.replace('\n', "\r")] {
        let loaded = load(PLY, text);
        assert_same(&loaded.mesh, &plain);
        let warning = loaded.warnings[0].to_string();
        for what in ["elements other than", "values of vertices", "values of faces"] {
            assert!(warning.contains(what), "{warning}");
        }
    }
}

#[test]
fn ply_in_binary_has_all_types_in_both_orders() {
    let header = |order: &str| {
        format!(
            "ply\nformat binary_{order}_endian 1.0\nelement vertex 3\nproperty float x\n\
             property short y\nproperty char z\nproperty list ushort double rest\n\
             element face 1\nproperty list int ushort vertex_indices\nend_header\n"
        )
        .into_bytes()
    };
    let (mut little, mut big) = (header("little"), header("big"));
    for [x, y, z] in [[0.5_f32, -2.0, 3.0], [1.0, 0.0, -1.0], [0.0, 300.0, 0.0]] {
        little.extend(x.to_le_bytes().into_iter().chain((y as i16).to_le_bytes()));
        big.extend(x.to_be_bytes().into_iter().chain((y as i16).to_be_bytes()));
        for (bytes, one) in [(&mut little, 1_u16.to_le_bytes()), (&mut big, 1_u16.to_be_bytes())] {
            bytes.push(z as i8 as u8);
            bytes.extend(one);
            bytes.extend([0; 8]);
        }
    }
    little.extend(3_i32.to_le_bytes());
    big.extend(3_i32.to_be_bytes());
    for v in [2_u16, 1, 0] {
        little.extend(v.to_le_bytes());
        big.extend(v.to_be_bytes());
    }
    let mesh = load(PLY, &little).mesh;
    assert_eq!((mesh.points()[0], mesh.face(0)), (Point::new(0.5, -2.0, 3.0), &[2, 1, 0][..]));
    assert_eq!(mesh.points()[2], Point::new(0.0, 300.0, 0.0));
    assert_same(&load(PLY, &big).mesh, &mesh);
    refused(PLY, &little[..little.len() - 1], &["0 of 1 elements `face`", "cut"]);
    refused(PLY, &little[..little.len() - 10], &["0 of 1 elements `face`"]);
    little.push(7);
    refused(PLY, &little, &["goes on after"]);
}

#[test]
fn ply_says_what_is_wrong_and_where() {
    let with = |data: &str| [PLY_HEADER, PLY_FACE, data].concat();
    refused(PLY, with("0 0 0\n1 0 0\n"), &["in:12", "2 of 3 elements `vertex`", "cut"]);
    refused(PLY, with("0 0 0\n1 0\n0 1 0\n3 0 1 2\n"), &["in:12", "fewer values", "`1 0`"]);
    refused(PLY, with("0 0 0\n1 0 0 0\n0 1 0\n3 0 1 2\n"), &["in:12", "more values"]);
    refused(PLY, with("0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n"), &["in:12", "vertex 2", "NaN"]);
    refused(PLY, with("0 0 0\n1,5 0 0\n0 1 0\n3 0 1 2\n"), &["in:12", "comma", "`1,5`"]);
    refused(PLY, with("0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"), &["in:14", "vertex 3", "0 to 2"]);
    refused(PLY, with("0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n"), &["in:14", "vertex -1"]);
    refused(PLY, with("0 0 0\n1 0 0\n0 1 0\n3 0 1 1.5\n"), &["vertex 1.5"]);
    refused(PLY, with("0 0 0\n1 0 0\n0 1 0\n-3 0 1 1\n"), &["length is no count"]);
    refused(PLY, with("0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 1 2\n"), &["goes on after"]);
    let header = |text: &str| format!("ply\n{text}\nend_header\n");
    refused(PLY, "", &["empty"]);
    refused(PLY, "plyx\n", &["in:1", "`ply`"]);
    refused(PLY, "ply\n", &["cut"]);
    refused(PLY, header(""), &["without `format`"]);
    refused(PLY, header("format ascii 2.0"), &["in:2", "no part"]);
    refused(PLY, header("format binary_middle_endian 1.0"), &["format that is not known"]);
    refused(PLY, header("property int x"), &["property that is not understood"]);
    refused(PLY, header("element vertex many"), &["no whole number"]);
    refused(PLY, header("element vertex -3"), &["no whole number"]);
    refused(PLY, header("element vertex 1\nelement vertex 1"), &["declared before"]);
    refused(PLY, header("element vertex 1\nproperty quad x"), &["not understood"]);
    refused(PLY, header("format ascii 1.0\nelement vertex 1\nproperty int x"), &["x, y and z"]);
    refused(PLY, header("format ascii 1.0\nelement face 1\nproperty int x"), &["vertex_indices"]);
    refused(PLY, header("format ascii 1.0"), &["empty"]);
    refused(PLY, [PLY_HEADER, "end_header\n0 0 0\n0 0 0\n0 0 0\n"].concat(), &["point cloud"]);
}

// OFF.

#[test]
fn off_of_other_programs_is_understood() {
    let plain = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    let mesh = load(OFF, plain).mesh;
    assert_eq!(mesh.face(0), [0, 1, 2]);
    for other in [
        "OFF 3 1\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2",
        "\u{feff}# made by hand\nOFF # it is\n\n3 1 3\n0 0 0 # origin\n\n1 0 0\n0 1 0\n3 0 1 2\n\n",
        "OFF\r\n3 1 0\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 2\r\n",
    ] {
        let loaded = load(OFF, other);
        assert_same(&loaded.mesh, &mesh);
        assert_eq!(loaded.warnings, []);
    }
    let text = "NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2 255 0 0\n";
    let loaded = load(OFF, text);
    assert_same(&loaded.mesh, &mesh);
    let warning = loaded.warnings[0].to_string();
    assert!(warning.contains("normals") && warning.contains("colours of faces"), "{warning}");
}

#[test]
fn off_says_what_is_wrong_and_where() {
    refused(OFF, "OBJ\n3 1 0\n", &["in:1", "no OFF"]);
    refused(OFF, "4OFF\n3 1 0\n", &["4OFF", "three dimensions"]);
    refused(OFF, "OFF BINARY\n\0\0\0", &["binary OFF"]);
    refused(OFF, "OFF\n", &["cut"]);
    refused(OFF, "OFF\n3\n", &["numbers of vertices and faces"]);
    refused(OFF, "OFF\n3 one 0\n", &["in:2", "no count"]);
    refused(OFF, "OFF\n3 1 0\n0 0 0\n1 0 0\n", &["2 of 3 vertices"]);
    refused(OFF, "OFF\n1 1 0\n0 0\n1 0\n", &["in:3", "fewer than three"]);
    refused(OFF, "OFF\n1 2 0\n0 0 0\n1 0\n", &["1 of 2 faces"]);
    refused(OFF, "OFF\n1 1 0\n0 0 0\n3 0 0\n", &["in:4", "too few corners"]);
    refused(OFF, "OFF\n1 1 0\n0 0 0\n3 0 0 1\n", &["face 1 names vertex 1", "0 to 0"]);
    refused(OFF, "OFF\n1 1 0\n0 0 inf\n3 0 0 0\n", &["in:3", "`inf`"]);
    refused(OFF, "OFF\n1 1 0\n0 0 0\n1 0\n1 0\n", &["goes on after"]);
    refused(OFF, "OFF\n1 0 0\n0 0 0\n", &["no faces"]);
    refused(OFF, "OFF\n0 0 0\n", &["empty"]);
}

// STL.

const STL_TEXT: &str = "solid two\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n\
     vertex 0.1 1 0\nendloop\nendfacet\nfacet normal 0 0 1\n  outer loop\n  vertex 1 0 0\n\
     vertex 1 1 0\nvertex 0.1 1 -0\nendloop\nendfacet\nendsolid two\n";

fn stl_binary(start: &[u8], triangles: &[[[f32; 3]; 3]]) -> Vec<u8> {
    let mut bytes = start.to_vec();
    bytes.resize(80, b' ');
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for triangle in triangles {
        bytes.extend([0; 12]);
        triangle.iter().flatten().for_each(|x| bytes.extend(x.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

#[test]
fn stl_triangles_share_the_vertices_in_one_place() {
    let mesh = load(STL, STL_TEXT).mesh;
    assert_eq!(mesh.faces().collect::<Vec<_>>(), [[0, 1, 2], [1, 3, 2]]);
    assert_eq!(mesh.points()[2], Point::new(0.1, 1.0, 0.0), "text has more than 32 bits");
    assert_same(&load(STL, STL_TEXT.replace('\n', "\r\n")).mesh, &mesh);
    let two =
        [[[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]], [[1., 0., 0.], [1., 1., 0.], [0., 1., -0.]]];
    for start in [&b"binary"[..], b"solid like a text"] {
        let binary = load(STL, stl_binary(start, &two)).mesh;
        assert_eq!(binary.corners(), mesh.corners());
    }
}

#[test]
fn stl_says_what_is_wrong_and_where() {
    refused(
        STL,
        "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0\n",
        &["in:4", "three coordinates"],
    );
    refused(STL, "solid\nouter loop\nvertex 0 0 0\nendloop\n", &["in:4", "three vertices"]);
    refused(STL, "solid\nfacet\nouter loop\nvertex 0 0 nan\n", &["in:4", "`nan`"]);
    refused(STL, "solid\nvertx 0 0 0\n", &["in:2", "no STL statement"]);
    refused(STL, &STL_TEXT[..STL_TEXT.len() - 14], &["cut"]);
    refused(STL, "solid nothing\nendsolid nothing\n", &["empty"]);
    let binary = stl_binary(b"", &[[[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]]]);
    refused(STL, &binary[..40], &["0 of 1 headers"]);
    refused(STL, &binary[..100], &["0 of 1 triangles"]);
    refused(STL, [&binary[..], b"x"].concat(), &["goes on after"]);
    refused(STL, stl_binary(b"", &[[[0., 0., f32::NAN]; 3]]), &["vertex 1", "NaN"]);
    refused(STL, stl_binary(b"", &[]), &["empty"]);
}

// Limits.

fn within(options: &ReadOptions, format: Format, bytes: &[u8]) -> Result<Loaded, ReadError> {
    format.read(bytes, "in", options)
}

#[test]
fn limits_are_kept_by_every_reader_and_name_their_knob() {
    let mesh = shapes::grid(4, 4);
    let default = ReadOptions::default;
    for format in WRITTEN {
        let bytes = format.bytes(&mesh, None);
        for (exact, less, knob) in [
            (
                ReadOptions { vertices: 25, ..default() },
                ReadOptions { vertices: 24, ..default() },
                "read.vertices",
            ),
            (
                ReadOptions { faces: 16, ..default() },
                ReadOptions { faces: 15, ..default() },
                "read.faces",
            ),
            (
                ReadOptions { degree: 4, ..default() },
                ReadOptions { degree: 3, ..default() },
                "read.degree",
            ),
        ] {
            assert!(within(&exact, format, &bytes).is_ok(), "{} {knob}", format.name);
            let error = within(&less, format, &bytes).unwrap_err();
            assert!(matches!(error.fault, ReadFault::TooMany { .. }));
            assert!(error.to_string().contains(knob), "{error}");
        }
    }
}

#[test]
fn headers_cannot_claim_memory_or_time() {
    let ply = |rest: &str| format!("ply\nformat binary_little_endian 1.0\n{rest}end_header\n");
    let face = "element face 2000000000\nproperty list uint uint vertex_indices\n";
    let xyz = "property char x\nproperty char y\nproperty char z\n";
    refused(PLY, ply(&format!("element vertex 2000000000\n{xyz}{face}")), &["0 of 2000000000"]);
    refused(PLY, ply(&format!("element vertex 99999999999\n{xyz}")), &["read.vertices"]);
    refused(PLY, ply(face), &["0 of 2000000000"]);
    refused(PLY, ply("element nothing 18446744073709551615\n"), &["empty"]);
    let mut list = ply(&format!(
        "element vertex 1\n{xyz}element face 1\n\
        property list uint uint vertex_indices\n"
    ))
    .into_bytes();
    list.extend([0; 3]);
    list.extend(u32::MAX.to_le_bytes());
    refused(PLY, &list, &["0 of 1 elements `face`"]);
    list.extend(vec![0; 1_000_000]);
    refused(PLY, &list, &["read.degree"]);
    refused(OFF, "OFF\n2000000000 2000000000 0\n0 0 0\n", &["1 of 2000000000 vertices"]);
    refused(OFF, "OFF\n1 1 0\n0 0 0\n4000000000 0 0\n", &["too few corners"]);
    refused(OFF, "OFF 18446744073709551615 1\n", &["read.vertices"]);
    let mut stl = stl_binary(b"", &[]);
    stl[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    refused(STL, &stl, &["read.faces"]);
    stl[80..84].copy_from_slice(&1_000_000_000_u32.to_le_bytes());
    refused(STL, &stl, &["0 of 1000000000 triangles"]);
    refused(OBJ, "v 0 0 0\nf 1 2000000000 2\n", &["in:2", "vertex 2000000000"]);
}

fn gzip(bytes: &[u8]) -> Vec<u8> {
    use std::io::Write;
    let mut packed = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
    packed.write_all(bytes).unwrap();
    packed.finish().unwrap()
}

#[test]
fn bombs_are_refused_and_the_limit_can_be_moved() {
    let blank = gzip(&b" ".repeat(80 << 20));
    assert!(blank.len() < 100_000);
    refused(OBJ, &blank, &["unpacks to more than 100 times", "read.expansion"]);
    let more = ReadOptions { expansion: 2000, ..ReadOptions::default() };
    assert!(matches!(within(&more, OBJ, &blank).unwrap_err().fault, ReadFault::Empty));
}

#[test]
fn damaged_packed_files_are_told() {
    let packed = gzip(&OBJ.bytes(&shapes::grid(20, 20), None));
    for end in [3, 20, packed.len() / 2, packed.len() - 1] {
        refused(OBJ, &packed[..end], &["gzip data is damaged or was cut"]);
    }
    let mut changed = packed.clone();
    let last = changed.len() - 5;
    changed[last] ^= 1;
    refused(OBJ, &changed, &["gzip"]);
    // Several packed files one after the other are one, as `gzip -d` has it.
    let two = [gzip(b"v 0 0 0\nv 1 0 0\nv 0 1 0\n"), gzip(b"f 1 2 3\n")].concat();
    assert_eq!(load(OBJ, two).mesh.face_count(), 1);
}

#[test]
fn names_and_registry_agree() {
    for format in FORMATS {
        let named = Format::named(format.name).unwrap();
        assert_eq!((named.name, named.is_written()), (format.name, format.name != "stl"));
    }
    assert!(Format::named("dxf").is_none());
    let error = io::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("README.md").as_path());
    assert!(error.unwrap_err().to_string().contains(".obj, .ply, .off, .stl, each also with .gz"));
}

// Streams.

/// Runs `quadmend convert - --to dual` on these bytes, and gives standard output.
fn through_pipes(name: &str, bytes: &[u8]) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let input = folder.path().join("in");
    fs::write(&input, bytes).unwrap();
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_quadmend"))
        .args(["convert", "-", "--to", "dual", "-o", "-", "--format", name])
        .stdin(fs::File::open(input).unwrap())
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    output.stdout
}

#[test]
fn standard_input_is_recognised_and_standard_output_is_what_was_asked_for() {
    let mesh = shapes::torus(9, 7);
    let dual = load(OBJ, through_pipes("obj", &OBJ.bytes(&mesh, None))).mesh;
    for format in WRITTEN {
        for bytes in [format.bytes(&mesh, None), gzip(&format.bytes(&mesh, None))] {
            let written = through_pipes(format.name, &bytes);
            assert_same(&load(format, written).mesh, &dual);
        }
    }
    let triangles = through_pipes("off", STL_TEXT.as_bytes());
    assert!(triangles.starts_with(b"COFF"));
}
