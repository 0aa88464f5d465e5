//! Pictures against golden ones in `tests/golden`. After a change that is meant, look at what
//! `QUADMEND_WRITE_GOLDEN=1 cargo test --test render` makes of them.

use std::fs;
use std::path::{Path, PathBuf};

use quadmend::elements::Inspection;
use quadmend::io;
use quadmend::mesh::{Point, PolyMesh, shapes};
use quadmend::metrics::FACE_FIELDS;
use quadmend::render::{
    HeatRange, Image, Picture, PictureError, Shading, Subject, Up, VIEWS, View,
};
use quadmend::surface::{FeatureOptions, Reference};

/// Rounding may differ between machines in the last bit, which is one shade of a pixel at an edge.
const SHADES: u8 = 4;

fn asset(name: &str) -> PolyMesh {
    io::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("assets").join(name)).unwrap().mesh
}

fn view(name: &str) -> View {
    name.parse().unwrap()
}

fn subject<'a>(mesh: &'a PolyMesh, inspection: &'a Inspection) -> Subject<'a> {
    Subject {
        name: "mesh.obj".to_owned(),
        mesh,
        topology: &inspection.topology,
        elements: &inspection.elements,
        heat: None,
    }
}

fn picture<'a>(subjects: Vec<Subject<'a>>, views: &[&str]) -> Picture<'a> {
    Picture {
        subjects,
        views: views.iter().map(|name| view(name)).collect(),
        up: Up::Y,
        panel: [240, 180],
        shading: Shading::Flat,
        edges: true,
        legend: true,
        heat: None,
    }
}

fn decoded(path: &Path) -> ([u32; 2], Vec<u8>) {
    let file = fs::File::open(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    ([info.width, info.height], pixels)
}

/// Compares with the golden picture of that name; on a difference leaves the new one beside it.
#[track_caller]
fn is_golden(name: &str, image: &Image) {
    let golden = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(name);
    let write = |path: &Path| image.write_png(fs::File::create(path).unwrap()).unwrap();
    if std::env::var_os("QUADMEND_WRITE_GOLDEN").is_some() {
        write(&golden.with_extension("png"));
    }
    let (size, pixels) = decoded(&golden.with_extension("png"));
    let alike = |(a, b): (&u8, &u8)| a.abs_diff(*b) <= SHADES;
    if size != image.size() || !pixels.iter().zip(image.pixels()).all(alike) {
        let new = std::env::temp_dir().join(format!("{name}-new.png"));
        write(&new);
        panic!("{name} does not look as it did; the new picture is {}", new.display());
    }
}

#[test]
fn irregular_elements_t_junctions_and_features_look_as_they_did() {
    let (mesh, reference) = (asset("bracket.obj"), asset("bracket.ref.obj"));
    let surface = Reference::new(&reference).unwrap();
    let inspection = Inspection::new(&mesh, Some(&surface), &FeatureOptions::default());
    let sheet = picture(vec![subject(&mesh, &inspection)], &["corner", "-60,-20"]);
    is_golden("irregular", &sheet.draw().unwrap());
}

#[test]
fn heat_maps_have_one_scale_and_smooth_light() {
    let (mesh, reference) = (asset("bracket.obj"), asset("bracket.ref.obj"));
    let surface = Reference::new(&reference).unwrap();
    let options = FeatureOptions::default();
    let inspections = [&mesh, &reference].map(|m| Inspection::new(m, Some(&surface), &options));
    let fields = [0, 1].map(|i| inspections[i].field("scaled-jacobian").unwrap());
    let subjects = [&mesh, &reference].into_iter().zip(&inspections).zip(fields).map(
        |((mesh, inspection), field)| Subject {
            heat: Some(&field.values),
            ..subject(mesh, inspection)
        },
    );
    let sheet = Picture {
        shading: Shading::Smooth,
        heat: Some((fields[0].field, HeatRange::of(&fields))),
        ..picture(subjects.collect(), &["behind"])
    };
    is_golden("heat", &sheet.draw().unwrap());
}

/// A saddle of quads with a hole in it, a triangle turned over, and a vertex of eight triangles.
fn open_mesh() -> PolyMesh {
    let grid = shapes::grid(6, 6);
    let lift = |p: &Point| {
        let (x, y) = (p.x - 3.0, p.y - 3.0);
        Point::new(x, 0.12 * (x * x - y * y), y)
    };
    let mut faces: Vec<Vec<u32>> = grid.faces().map(<[u32]>::to_vec).collect();
    let around = [0, 1, 6, 7].map(|i| faces[i + 14].clone());
    let hub = around[0][2];
    faces.retain(|f| !around.contains(f));
    let cut = |f: &Vec<u32>| {
        let at = f.iter().position(|&v| v == hub).unwrap();
        let [a, b, c] = [1, 2, 3].map(|i| f[(at + i) % 4]);
        [vec![hub, a, b], vec![hub, b, c]]
    };
    faces.extend(around.iter().flat_map(cut));
    faces[1].reverse();
    faces.remove(21);
    PolyMesh::new(grid.points().iter().map(lift).collect(), faces).unwrap()
}

#[test]
fn boundaries_backs_and_large_indices_look_as_they_did() {
    let mesh = open_mesh();
    let inspection = Inspection::new(&mesh, None, &FeatureOptions::default());
    let sheet = picture(vec![subject(&mesh, &inspection)], &["corner", "20,-35"]);
    is_golden("open", &sheet.draw().unwrap());
}

#[test]
fn the_same_picture_is_the_same_bytes() {
    let mesh = shapes::cube(5);
    let inspection = Inspection::new(&mesh, None, &FeatureOptions::default());
    let names: Vec<&str> = VIEWS.iter().map(|(name, _)| *name).collect();
    let bytes = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let sheet = picture(vec![subject(&mesh, &inspection)], &names);
        let mut bytes = Vec::new();
        pool.install(|| sheet.draw().unwrap()).write_png(&mut bytes).unwrap();
        bytes
    };
    let one = bytes(1);
    assert!(one == bytes(1) && one == bytes(3));
}

#[test]
fn apart_they_are_what_they_are_side_by_side() {
    let meshes = [shapes::cube(3), shapes::cube(6)];
    let inspections = [0, 1].map(|i| Inspection::new(&meshes[i], None, &FeatureOptions::default()));
    let subjects = [0, 1].map(|i| subject(&meshes[i], &inspections[i]));
    let sheet = Picture { legend: false, ..picture(subjects.to_vec(), &["corner"]) };
    let (both, apart) = (sheet.draw().unwrap(), sheet.draw_apart().unwrap());
    let pixels = (0..180).flat_map(|y| (0..240).map(move |x| (x, y)));
    for (x, y) in pixels {
        assert_eq!(
            [both.get(x, y), both.get(x + 240, y)],
            [apart[0].get(x, y), apart[1].get(x, y)]
        );
    }
}

#[test]
fn what_cannot_be_drawn_is_an_error() {
    let mesh = shapes::cube(1);
    let inspection = Inspection::new(&mesh, None, &FeatureOptions::default());
    let all = || vec![subject(&mesh, &inspection)];
    assert_eq!(picture(Vec::new(), &["front"]).draw(), Err(PictureError::Nothing));
    assert_eq!(picture(all(), &[]).draw(), Err(PictureError::Nothing));
    for panel in [[15, 100], [100, 0], [60_000, 60_000], [u32::MAX, u32::MAX]] {
        let sheet = Picture { panel, ..picture(all(), &["front"]) };
        assert!(matches!(sheet.draw(), Err(PictureError::Size { .. })), "{panel:?}");
    }
}

#[test]
fn meshes_without_extent_are_drawn() {
    let point = PolyMesh::new(vec![Point::origin(); 3], [[0, 1, 2]]).unwrap();
    let nothing = PolyMesh::new(Vec::new(), [[0_u32; 0]; 0]).unwrap();
    for mesh in [point, nothing] {
        let inspection = Inspection::new(&mesh, None, &FeatureOptions::default());
        let values = vec![f64::NAN; mesh.face_count()];
        let subject = Subject { heat: Some(&values), ..subject(&mesh, &inspection) };
        let heat = Some((&FACE_FIELDS[0], HeatRange::of(&[])));
        Picture { heat, ..picture(vec![subject], &["corner", "top"]) }.draw().unwrap();
    }
}
