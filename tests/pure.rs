//! Pure conversion: quads only where parity allows it, what stops it where it does not, and what
//! must not change on the way.

mod common;

use common::lifted::{Dice, Invariants, fingerprint, lifted, mess_up, no_features, samples};
use common::{data_folder, say};
use quadmend::config::Config;
use quadmend::io;
use quadmend::mesh::{MendPolicy, PolyMesh, shapes};
use quadmend::moves::pure::{Conversion, Kind, Obstruction, convert, obstructions};
use quadmend::pipeline::pure_quad::pure_quad;
use quadmend::sqrtcc::{QuadMesh, lift, lower};
use quadmend::watch::Silent;

fn convert_all(q: &mut QuadMesh, kind: Kind) -> Conversion {
    convert(q, kind, &mut |_, _| 0.0, &Silent)
}

/// The sample meshes after so many random operations.
fn messy(edits: usize, seed: u64) -> Vec<(&'static str, QuadMesh)> {
    let mess = |(name, mesh, features)| {
        let mut q = lift(&mesh, &features).expect(name);
        mess_up(&mut q, &mut Dice(seed), edits);
        q.commit();
        (name, q)
    };
    samples().into_iter().map(mess).collect()
}

#[test]
fn every_face_becomes_a_quad_and_undo_is_exact() {
    for seed in 0..4 {
        for (name, mut q) in messy(60, seed) {
            let (before, invariants) = (fingerprint(&q), Invariants::of(&q));
            let mark = q.mark();
            let e = q.total_irregularity() as i64;
            let done = convert_all(&mut q, Kind::Faces);
            assert_eq!(
                (&done.left[..], &done.obstructions[..]),
                (&[][..], &[][..]),
                "{name} {seed}"
            );
            assert_eq!(Kind::Faces.irregular(&q).count(), 0, "{name} {seed}");
            assert_eq!(q.total_irregularity() as i64 - e, done.delta, "{name} {seed}");
            assert_eq!(Invariants::of(&q), invariants, "{name} {seed}");
            let mesh = lower(&q, &[String::new()]).unwrap().mesh;
            assert!(mesh.faces().all(|f| f.len() == 4), "{name} {seed}");
            q.undo_to(mark);
            assert!(fingerprint(&q) == before, "{name} {seed}: undo is not exact");
        }
    }
}

#[test]
fn few_pairs_in_regular_surroundings_cost_nothing() {
    for seed in 0..4 {
        for (name, mut q) in messy(6, seed) {
            let done = convert_all(&mut q, Kind::Faces);
            assert!(done.delta <= 0, "{name} {seed}: E grew by {}", done.delta);
        }
    }
}

#[test]
fn irregular_vertices_become_faces_on_closed_meshes() {
    for (name, mut q) in messy(40, 3) {
        if name == "disk" || name == "cube with features" {
            continue;
        }
        let invariants = Invariants::of(&q);
        let done = convert_all(&mut q, Kind::Vertices);
        assert_eq!(Kind::Vertices.irregular(&q).count(), 0, "{name}: {:?}", done.left);
        assert_eq!(Invariants::of(&q), invariants, "{name}");
    }
    let mut ball = lifted(&shapes::sphere(6));
    assert_eq!(convert_all(&mut ball, Kind::Vertices).delta, 0);
    assert_eq!(Kind::Faces.irregular(&ball).count(), 8, "the corners of the cube are faces now");
}

#[test]
fn the_same_mesh_gives_the_same_operations() {
    for (_, q) in messy(60, 9) {
        let run = || convert_all(&mut q.clone(), Kind::Faces);
        assert_eq!(run(), run());
    }
}

/// A grid whose first square has lost a corner: the boundary is odd.
fn clipped(columns: u32, rows: u32) -> PolyMesh {
    let grid = shapes::grid(columns, rows);
    let faces = grid.faces().map(<[u32]>::to_vec).enumerate();
    // Vertex 0 goes: the first square becomes a triangle, the others keep their numbers less one.
    let less = |v: &u32| v - 1;
    let clip = |(f, face): (usize, Vec<u32>)| -> Vec<u32> {
        face.iter().filter(|&&v| f > 0 || v > 0).map(less).collect()
    };
    PolyMesh::new(grid.points()[1..].to_vec(), faces.map(clip)).unwrap()
}

#[test]
fn an_odd_boundary_is_an_obstruction_and_one_face_is_left() {
    let mesh = clipped(7, 5);
    let mut q = lift(&mesh, &no_features(&mesh)).unwrap();
    mess_up(&mut q, &mut Dice(5), 30);
    let invariants = Invariants::of(&q);
    let done = convert_all(&mut q, Kind::Faces);
    assert_eq!(done.left.len(), 1);
    let rims = |all: &[Obstruction]| all.iter().map(|o| o.rim).collect::<Vec<_>>();
    assert_eq!(rims(&done.obstructions), rims(&obstructions(&q)), "no edit changes it");
    let [odd] = &done.obstructions[..] else { panic!("{:?}", done.obstructions) };
    assert_eq!(odd.rim, 2 * (7 + 5) - 1);
    assert!(odd.to_string().contains("23 boundary and feature edges"), "{odd}");
    assert_eq!(Invariants::of(&q), invariants);
}

#[test]
fn features_with_an_odd_number_of_edges_stop_what_they_enclose() {
    let mesh = shapes::cube(5);
    let mut q = lifted(&mesh);
    mess_up(&mut q, &mut Dice(1), 20);
    let mesh = lower(&q, mesh.group_names()).unwrap().mesh;
    let odd = mesh.faces().position(|f| f.len() % 2 == 1).expect("an odd face");
    let mut around_it = no_features(&mesh);
    around_it.insert_range(mesh.offsets()[odd] as usize..mesh.offsets()[odd + 1] as usize);
    let mut q = lift(&mesh, &around_it).unwrap();
    let done = convert_all(&mut q, Kind::Faces);
    let rims: Vec<usize> = done.obstructions.iter().map(|o| o.rim).collect();
    assert_eq!(rims, [mesh.face(odd).len(); 2], "inside and outside");
    assert_eq!(done.left.len(), 2);
}

#[test]
fn real_meshes_become_pure_quads_without_inverted_ones() {
    let Some(folder) = data_folder("real_meshes_become_pure_quads") else { return };
    for name in ["spot_im3k", "lilium_gmsh", "wingnut_im4k"] {
        let read = |suffix: &str| io::read(&folder.join(format!("{name}{suffix}"))).unwrap().mesh;
        let (mesh, reference) = (read(".obj"), read(".ref.obj"));
        let config = Config::default();
        let done = pure_quad(mesh, Some(&reference), MendPolicy::Mend, &config, &Silent).unwrap();
        let [before, after] = [&done.report.before, &done.report.after];
        say(&format!(
            "{name}: E {} to {}, {} pairs",
            before.summary.irregular_elements,
            after.summary.irregular_elements,
            done.report.conversion.pairs
        ));
        assert!(after.summary.pure_quad && after.summary.manifold, "{name}");
        assert_eq!(after.summary.chi, before.summary.chi, "{name}");
        assert!(after.summary.irregular_elements <= before.summary.irregular_elements, "{name}");
        let inverted = |m: &quadmend::metrics::Metrics| {
            m.quality.scaled_jacobian_quads.as_ref().map_or(0, |s| s.count_below_0)
        };
        assert!(inverted(after) <= inverted(before), "{name}");
    }
}
