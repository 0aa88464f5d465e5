//! Bad and odd files, each kind by its name: every one gives a right answer or a clear error with
//! exit code 3, soon, and never a part of a file.

use std::f64::consts::TAU;
use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use quadmend::io::{self, OFF, PLY, PLY_ASCII};
use quadmend::mesh::{Point, PolyMesh, check, shapes};

/// Longer than the slowest takes on a busy machine.
const PATIENCE: Duration = Duration::from_secs(60);

/// What becomes of a file.
enum Fate {
    /// A clean mesh with so many faces (or `EDITED`), and all of these words on standard error.
    Cleaned(usize, &'static [&'static str]),
    /// Exit code 3, and all of these words.
    Refused(&'static [&'static str]),
}

use Fate::{Cleaned, Refused};

/// As many faces as edits leave.
const EDITED: usize = usize::MAX;

/// Runs the command in a folder, and ends it if it hangs.
fn run(folder: &Path, arguments: &[&str]) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_quadmend"))
        .current_dir(folder)
        .args(arguments)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let began = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if began.elapsed() > PATIENCE {
            child.kill().unwrap();
            panic!("{arguments:?} hangs");
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    child.wait_with_output().unwrap()
}

/// Cleans `name`, perhaps on a reference, and compares what becomes of it with `fate`.
fn judge(folder: &Path, name: &str, reference: Option<&str>, fate: &Fate) {
    let mut arguments = vec!["clean", name, "-o", "out.ply", "--set", "measure.samples=1000"];
    arguments.extend(reference.iter().flat_map(|r| ["-r", r]));
    let output = run(folder, &arguments);
    let told = String::from_utf8(output.stderr).unwrap();
    let what = reference.unwrap_or(name);
    assert!(!told.contains("panicked"), "{what}: {told}");
    let (codes, words) = match fate {
        Cleaned(_, words) => (&[0, 1][..], words),
        Refused(words) => (&[3][..], words),
    };
    let code = output.status.code().unwrap_or_else(|| panic!("{what} ends by a signal: {told}"));
    assert!(codes.contains(&code), "{what}: exit code {code}: {told}");
    for word in *words {
        assert!(told.contains(word), "{what}: no `{word}` in: {told}");
    }
    let written = folder.join("out.ply");
    match fate {
        Cleaned(faces, _) => {
            let mesh = io::read(&written).unwrap().mesh;
            let faces = if *faces == EDITED { mesh.face_count() } else { *faces };
            assert_eq!((check(&mesh), mesh.face_count()), (Ok(()), faces), "{what}");
            fs::remove_file(written).unwrap();
        }
        Refused(_) => {
            assert!(!written.exists(), "{what}: something was written");
            assert!(told.contains("error: ") && told.contains(name), "{what}: {told}");
        }
    }
    let left = fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name());
    let left: Vec<_> = left.filter(|n| n.to_string_lossy().contains("quadmend-")).collect();
    assert!(left.is_empty(), "{what}: {left:?}");
}

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";

#[test]
fn files_with_wrong_text_are_refused_and_odd_ones_are_read() {
    let square = |more: &str| format!("{SQUARE}{more}").into_bytes();
    let utf16: Vec<u8> = SQUARE.encode_utf16().flat_map(u16::to_le_bytes).collect();
    let marked = [b"\xff\xfe", &utf16[..]].concat();
    let commas = SQUARE.replace("v 1 0 0", "v 1,5 0 0").into_bytes();
    let ply = |mesh: &PolyMesh| PLY.bytes(mesh, None);
    let cube = shapes::cube(2);
    let mut cut = ply(&cube);
    cut.truncate(cut.len() / 2);
    let text = String::from_utf8(PLY_ASCII.bytes(&cube, None)).unwrap();
    let many = text.replace("element face 24", "element face 4000000000");
    let off = String::from_utf8(OFF.bytes(&cube, None)).unwrap();
    let cases: Vec<(&str, Vec<u8>, Fate)> = vec![
        ("empty.obj", vec![], Refused(&["empty"])),
        ("blank.obj", b"\n \n\t\n".to_vec(), Refused(&["empty"])),
        ("comment.obj", b"# nothing\n".to_vec(), Refused(&["empty"])),
        ("word.obj", square("hello\n"), Refused(&["word.obj:6", "no OBJ statement"])),
        ("two-coordinates.obj", square("v 1 2\n"), Refused(&[":6", "fewer than three"])),
        ("no-number.obj", square("v 1 2 x\n"), Refused(&[":6", "`x`"])),
        ("no-index.obj", square("f 1 2 x\n"), Refused(&[":6", "`x`"])),
        ("index-too-large.obj", square("f 1 2 9\n"), Refused(&[":6", "vertex 9", "1 to 4"])),
        ("index-zero.obj", square("f 0 1 2\n"), Refused(&[":6", "vertex 0"])),
        ("index-too-negative.obj", square("f -1 -2 -9\n"), Refused(&[":6", "vertex -9"])),
        ("index-fraction.obj", square("f 1 2 1.5\n"), Refused(&[":6", "`1.5`"])),
        (
            "index-beyond-64-bits.obj",
            square("f 1 2 99999999999999999999\n"),
            Refused(&["vertex 99999"]),
        ),
        ("nan.obj", square("v nan 0 0\n"), Refused(&[":6", "vertex 5", "`nan`"])),
        ("infinite.obj", square("v 0 -inf 0\n"), Refused(&[":6", "`-inf`"])),
        ("overflow.obj", square("v 0 0 1e999\n"), Refused(&[":6", "`1e999`"])),
        ("beyond-1e100.obj", square("v 0 0 1e101\n"), Refused(&["1e100"])),
        ("decimal-commas.obj", commas, Refused(&[":2", "comma", "`1,5`"])),
        ("cut-in-a-vertex.obj", square("v 0 0"), Refused(&["was cut"])),
        ("cut-in-a-face.obj", square("f 1 2"), Refused(&["was cut"])),
        ("utf-16.obj", marked, Refused(&["UTF-8"])),
        ("utf-16-without-mark.obj", utf16, Refused(&["not a text file"])),
        ("zeros.obj", vec![0; 1000], Refused(&["not a text file", "byte 0"])),
        ("picture.obj", b"\x89PNG\r\n\x1a\n".to_vec(), Refused(&["no OBJ statement"])),
        ("ply-named-obj.obj", text.clone().into_bytes(), Refused(&["ply-named-obj.obj:1"])),
        ("obj-named-ply.ply", SQUARE.into(), Refused(&["`ply`"])),
        ("obj-named-off.off", SQUARE.into(), Refused(&["no OFF"])),
        ("obj-named-stl.stl", SQUARE.into(), Refused(&["cut"])),
        ("not-packed.obj.gz", b"\x1f\x8bnothing".to_vec(), Refused(&["gzip data"])),
        ("unknown.xyz", SQUARE.into(), Refused(&[".xyz", ".obj, .ply"])),
        ("cut.ply", cut, Refused(&["elements `vertex`"])),
        ("header-claims-too-much.ply", many.into_bytes(), Refused(&["read.faces"])),
        ("header-cut.ply", text.as_bytes()[..40].to_vec(), Refused(&["header"])),
        (
            "wrong-index.ply",
            text.replacen("\n 4 ", "\n 4 9", 1).into_bytes(),
            Refused(&["face 1 names vertex 9"]),
        ),
        (
            "too-few-faces.off",
            off.replace("26 24 0", "26 25 0").into_bytes(),
            Refused(&["24 of 25"]),
        ),
        (
            "too-many-faces.off",
            off.replace("26 24 0", "26 23 0").into_bytes(),
            Refused(&["goes on"]),
        ),
        ("point-cloud.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\n".to_vec(), Refused(&["no faces"])),
        ("one-vertex.obj", b"v 0 0 0\n".to_vec(), Refused(&["1 vertices but no faces"])),
        ("windows.obj", SQUARE.replace('\n', "\r\n").into(), Cleaned(1, &[])),
        ("old-mac.obj", SQUARE.replace('\n', "\r").into(), Cleaned(1, &[])),
        ("marked.obj", format!("\u{feff}{SQUARE}").into(), Cleaned(1, &[])),
        ("no-last-line-end.obj", SQUARE.trim_end().into(), Cleaned(1, &[])),
        ("degree-0-1-2.obj", square("f\nf 1\nf 1 2\n"), Cleaned(1, &["3 degenerate faces"])),
        ("one-corner-thrice.obj", square("f 1 1 1\n"), Cleaned(1, &["1 degenerate face"])),
        ("twice-the-same.obj", square("f 2 3 4 1\n"), Cleaned(1, &["1 duplicate face"])),
        ("colours.obj", SQUARE.replace(" 0\n", " 0 1 0 0\n").into(), Cleaned(1, &["colours"])),
        ("windows.ply", text.replace('\n', "\r\n").into(), Cleaned(24, &[])),
        ("ply-in-binary.ply", ply(&cube), Cleaned(24, &[])),
    ];
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes, fate) in &cases {
        fs::write(folder.path().join(name), bytes).unwrap();
        judge(folder.path(), name, None, fate);
    }
    fs::create_dir(folder.path().join("folder.obj")).unwrap();
    judge(folder.path(), "folder.obj", None, &Refused(&["is a folder"]));
    judge(folder.path(), "missing.obj", None, &Refused(&["no such file"]));
}

// Odd meshes.

fn mesh<F: AsRef<[u32]>>(points: Vec<[f64; 3]>, faces: impl IntoIterator<Item = F>) -> PolyMesh {
    PolyMesh::new(points.into_iter().map(Point::from).collect(), faces).unwrap()
}

/// The points of a flat grid of six by six, each put elsewhere.
fn moved(to: impl Fn(f64, f64) -> [f64; 3]) -> PolyMesh {
    let mut grid = shapes::grid(6, 6);
    let points = grid.points().iter().map(|p| Point::from(to(p.x, p.y))).collect();
    grid.set_points(points);
    grid
}

/// All meshes as one, without a common vertex.
fn together(meshes: &[PolyMesh]) -> PolyMesh {
    let (mut points, mut faces) = (Vec::new(), Vec::new());
    for mesh in meshes {
        let start = points.len() as u32;
        points.extend_from_slice(mesh.points());
        faces.extend(mesh.faces().map(|f| f.iter().map(|v| v + start).collect::<Vec<_>>()));
    }
    PolyMesh::new(points, faces).unwrap()
}

/// A band or tube of n by m quads whose ends meet after a turn over.
fn one_sided(n: u32, m: u32, closed: bool) -> PolyMesh {
    let rows = if closed { m } else { m + 1 };
    let point = |i: u32, j: u32| {
        let (a, b) = (TAU * f64::from(i) / f64::from(n), f64::from(j) / f64::from(m) - 0.5);
        let (r, z) =
            if closed { ((TAU * b).cos(), (TAU * b).sin()) } else { (b, b * (a / 2.0).sin()) };
        let far = 3.0 + r * (a / 2.0).cos();
        [far * a.cos(), far * a.sin(), z]
    };
    let points = (0..n).flat_map(|i| (0..rows).map(move |j| point(i, j))).collect();
    let at = |i: u32, j: u32| {
        let row = if i < n { j } else { m - j };
        (i % n) * rows + row % rows
    };
    let quads = (0..n).flat_map(|i| (0..m).map(move |j| (i, j)));
    mesh(points, quads.map(|(i, j)| [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]))
}

/// Three sheets on one edge of four pieces.
fn book() -> PolyMesh {
    let mut points: Vec<[f64; 3]> = (0..5).map(|z| [0.0, 0.0, f64::from(z)]).collect();
    let mut faces = Vec::new();
    for page in 0..3 {
        let (start, a) = (points.len() as u32, TAU * f64::from(page) / 3.0);
        points.extend((0..5).map(|z| [a.cos(), a.sin(), f64::from(z)]));
        faces.extend((0..4).map(|z| [z, start + z, start + z + 1, z + 1]));
    }
    mesh(points, faces)
}

/// Two tetrahedra that touch in vertex 0.
fn two_tetrahedra() -> PolyMesh {
    let points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0], [0, -1, 0], [0, 0, -1]];
    let faces =
        [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3], [0, 4, 5], [0, 6, 4], [4, 6, 5], [5, 6, 0]];
    mesh(points.map(|p| p.map(f64::from)).to_vec(), faces)
}

/// A grid whose right half has quads of half the size, which do not share the vertices between.
fn hanging() -> PolyMesh {
    let fine = moved(|x, y| [3.0 + x / 2.0, y / 2.0, 0.0]);
    let coarse = shapes::grid(3, 3);
    let mut faces: Vec<Vec<u32>> = coarse.faces().map(<[u32]>::to_vec).collect();
    let mut points: Vec<Point> = coarse.points().to_vec();
    let mut number = Vec::new();
    for p in fine.points() {
        let known = coarse.points().iter().position(|q| q == p);
        number.push(known.unwrap_or(points.len()) as u32);
        if known.is_none() {
            points.push(*p);
        }
    }
    faces.extend(fine.faces().map(|f| f.iter().map(|&v| number[v as usize]).collect()));
    PolyMesh::new(points, faces).unwrap()
}

fn wound_at_random() -> PolyMesh {
    let grid = shapes::torus(12, 8);
    let faces = grid.faces().enumerate().map(|(f, face)| {
        let mut face = face.to_vec();
        if (f * 7919) % 5 < 2 {
            face.reverse();
        }
        face
    });
    PolyMesh::new(grid.points().to_vec(), faces).unwrap()
}

fn disk(corners: u32) -> PolyMesh {
    let at = |i: u32| TAU * f64::from(i) / f64::from(corners);
    let points = (0..corners).map(|i| [at(i).cos(), at(i).sin(), 0.0]).collect();
    mesh(points, [(0..corners).collect::<Vec<_>>()])
}

fn scaled(factor: f64) -> PolyMesh {
    moved(|x, y| [factor * x, factor * y, 0.0])
}

fn isolated_vertices(count: u32) -> PolyMesh {
    let grid = shapes::grid(6, 6);
    let mut points = grid.points().to_vec();
    points.extend((0..count).map(|i| Point::new(f64::from(i), 7.0, -1.0)));
    PolyMesh::new(points, grid.faces()).unwrap()
}

/// Every face has vertices of its own.
fn unwelded() -> PolyMesh {
    let grid = shapes::cube(3);
    let points = grid.corners().iter().map(|&v| grid.points()[v as usize]).collect();
    PolyMesh::new(points, (0..grid.face_count() as u32).map(|f| [0, 1, 2, 3].map(|i| 4 * f + i)))
        .unwrap()
}

#[test]
fn odd_meshes_are_cleaned_or_refused() {
    let one_sided_words: &[&str] = &["one-sided"];
    let cube = |scale: f64| {
        let mut cube = shapes::cube(2);
        let points = cube.points().iter().map(|p| p * scale).collect();
        cube.set_points(points);
        cube
    };
    let wall = moved(|x, y| [x, 2.5, y - 3.0]);
    let cases: Vec<(&str, PolyMesh, Fate)> = vec![
        ("huge-numbers", scaled(1e20), Cleaned(36, &[])),
        ("nearly-too-huge-numbers", scaled(1e90), Cleaned(36, &[])),
        ("tiny-numbers", scaled(1e-20), Cleaned(36, &[])),
        ("denormal-numbers", scaled(5e-324), Refused(&["no face with an area"])),
        ("far-from-the-origin", moved(|x, y| [1e12 + x, y, 0.0]), Cleaned(36, &[])),
        ("all-in-one-place", moved(|_, _| [1.0; 3]), Refused(&["no face with an area"])),
        ("all-on-a-line", moved(|x, _| [x, 0.0, 0.0]), Refused(&["no face with an area"])),
        ("flat", shapes::grid(6, 6), Cleaned(36, &[])),
        ("one-face", shapes::grid(1, 1), Cleaned(1, &[])),
        ("one-triangle", disk(3), Cleaned(1, &[])),
        (
            "crossed-quad",
            mesh(vec![[0.; 3], [1., 1., 0.], [1., 0., 0.], [0., 1., 0.]], [[0, 1, 2, 3]]),
            Cleaned(1, &[]),
        ),
        ("two-tetrahedra-on-a-vertex", two_tetrahedra(), Cleaned(8, &["1 bow-tie vertex split"])),
        ("moebius-band", one_sided(24, 2, false), Refused(one_sided_words)),
        ("klein-bottle", one_sided(24, 12, true), Refused(one_sided_words)),
        ("book-of-three-pages", book(), Cleaned(12, &["4 edges with more than two faces cut"])),
        ("nested-components", together(&[cube(1.0), cube(2.0), cube(3.0)]), Cleaned(72, &[])),
        ("100000-isolated-vertices", isolated_vertices(100_000), Cleaned(36, &["100000 unused"])),
        ("unwelded-faces", unwelded(), Cleaned(54, &[])),
        ("two-in-one-place", together(&[cube(1.0), cube(1.0)]), Cleaned(48, &[])),
        ("hanging-vertices", hanging(), Cleaned(EDITED, &["3 cracks closed"])),
        ("self-intersection", together(&[shapes::grid(6, 6), wall]), Cleaned(72, &[])),
        ("winding-at-random", wound_at_random(), Cleaned(96, &["faces turned over"])),
        ("face-of-degree-200", disk(200), Cleaned(1, &[])),
        (
            "face-beyond-the-limit",
            disk(10_001),
            Refused(&["10000 corners in a face", "read.degree"]),
        ),
    ];
    let folder = tempfile::tempdir().unwrap();
    for (kind, mesh, fate) in &cases {
        let name = format!("{kind}.ply");
        io::write(&folder.path().join(&name), mesh).unwrap();
        judge(folder.path(), &name, None, fate);
    }
    // Measured in no time, cleaned in half a minute.
    io::write(&folder.path().join("big.obj"), &disk(10_000)).unwrap();
    let metrics = run(folder.path(), &["metrics", "big.obj"]);
    assert_eq!(metrics.status.code(), Some(0));
}

#[test]
fn references_that_do_not_fit_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, mesh: &PolyMesh| io::write(&folder.path().join(name), mesh).unwrap();
    write("mesh.obj", &shapes::grid(6, 6));
    write("far.ply", &moved(|x, y| [x + 100.0, y, 0.0]));
    write("larger.ply", &moved(|x, y| [10.0 * x, 10.0 * y, 5.0]));
    write("turned.ply", &moved(|x, y| [x, 0.0, y]));
    write("flat.ply", &moved(|_, _| [0.0; 3]));
    fs::write(folder.path().join("empty.ply"), "").unwrap();
    fs::write(folder.path().join("cloud.obj"), "v 0 0 0\nv 1 0 0\n").unwrap();
    for (reference, words) in [
        ("far.ply", &["same position and scale"][..]),
        ("larger.ply", &["same position and scale"]),
        ("turned.ply", &["same position and scale"]),
        ("flat.ply", &["no face with an area"]),
    ] {
        let fate = Refused(Vec::leak(words.to_vec()));
        judge(folder.path(), "mesh.obj", Some(reference), &fate);
    }
    for (reference, word) in [("empty.ply", "empty"), ("cloud.obj", "point cloud")] {
        let output = run(folder.path(), &["clean", "mesh.obj", "-r", reference, "-o", "out.obj"]);
        let told = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(3), "{told}");
        assert!(told.contains(reference) && told.contains(word), "{told}");
        assert!(!folder.path().join("out.obj").exists());
    }
    // Triangles of every format are references, STL among them.
    let stl = "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 6 0 0\nvertex 6 6 0\n\
        endloop\nendfacet\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 6 6 0\n\
        vertex 0 6 0\nendloop\nendfacet\nendsolid s\n";
    fs::write(folder.path().join("scan.stl"), stl).unwrap();
    judge(folder.path(), "mesh.obj", Some("scan.stl"), &Cleaned(36, &[]));
}
