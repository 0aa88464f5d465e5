//! The other domains of a mesh, and the ways back.

mod common;

use common::lifted::{Dice, lifted, mess_up};
use quadmend::io::{OBJ, ReadOptions};
use quadmend::mesh::{PolyMesh, check, shapes};
use quadmend::sqrtcc::lower;
use quadmend::views::{Label, ViewError, catmull_clark, dual, primal, sqrt_cc};

/// The faces with each cycle turned so that its smallest vertex comes first.
fn faces(mesh: &PolyMesh) -> Vec<Vec<u32>> {
    let turned = |f: &[u32]| {
        let start = (0..f.len()).min_by_key(|&i| f[i]).unwrap_or(0);
        (0..f.len()).map(|i| f[(start + i) % f.len()]).collect()
    };
    mesh.faces().map(turned).collect()
}

/// Quad-dominant meshes: random operations on regular ones.
fn messy() -> Vec<(&'static str, PolyMesh)> {
    let meshes = [
        ("sphere", shapes::sphere(6)),
        ("torus", shapes::torus(16, 9)),
        ("disk", shapes::grid(9, 7)),
    ];
    let mess = |(name, mesh): (&'static str, PolyMesh)| {
        let mut q = lifted(&mesh);
        mess_up(&mut q, &mut Dice(7), 40);
        (name, lower(&q, mesh.group_names()).unwrap().mesh)
    };
    meshes.map(mess).into()
}

#[test]
fn proposition_3_1_sqrt_cc_and_back_given_one_label() {
    for (name, mesh) in messy() {
        let view = sqrt_cc(&mesh).unwrap();
        check(&view.mesh).unwrap_or_else(|flaw| panic!("{name}: {flaw}"));
        assert!(view.mesh.faces().all(|f| f.len() == 4), "{name}");
        for quad in view.mesh.faces() {
            let vertices = quad.iter().filter(|&&v| view.labels[v as usize] == Label::Vertex);
            assert_eq!(vertices.count(), 2, "{name}: p and d take turns");
        }
        let back = primal(&view.mesh, Label::Vertex).unwrap();
        assert_eq!((faces(&back), back.points()), (faces(&mesh), mesh.points()), "{name}");
    }
}

#[test]
fn the_other_label_gives_the_dual_of_a_closed_mesh() {
    for (name, mesh) in messy().into_iter().take(2) {
        let other = primal(&sqrt_cc(&mesh).unwrap().mesh, Label::Face).unwrap();
        let dual = dual(&mesh).unwrap().mesh;
        assert_eq!((faces(&other), other.points()), (faces(&dual), dual.points()), "{name}");
    }
}

#[test]
fn the_dual_of_the_dual_has_the_connectivity_of_a_closed_mesh() {
    for (name, mesh) in messy().into_iter().take(2) {
        let there = dual(&mesh).unwrap().mesh;
        assert_eq!(
            (there.vertex_count(), there.face_count()),
            (mesh.face_count(), mesh.vertex_count())
        );
        assert_eq!(faces(&dual(&there).unwrap().mesh), faces(&mesh), "{name}");
    }
}

#[test]
fn the_dual_of_a_disk_has_a_face_for_each_vertex_inside() {
    let mesh = shapes::grid(5, 4);
    let view = dual(&mesh).unwrap().mesh;
    check(&view).unwrap();
    assert_eq!((view.vertex_count(), view.face_count()), (5 * 4, 4 * 3));
}

#[test]
fn catmull_clark_has_a_quad_for_each_corner() {
    for (name, mesh) in messy() {
        let view = catmull_clark(&mesh).unwrap();
        check(&view.mesh).unwrap_or_else(|flaw| panic!("{name}: {flaw}"));
        assert_eq!(view.mesh.face_count(), mesh.corner_count(), "{name}");
        let edges = view.labels.iter().filter(|&&l| l == Label::Edge).count();
        let chi = |v: usize, e: usize, f: usize| v as i64 - e as i64 + f as i64;
        let before = chi(mesh.vertex_count(), edges, mesh.face_count());
        assert_eq!(
            before,
            if name == "disk" {
                1
            } else if name == "torus" {
                0
            } else {
                2
            },
            "{name}"
        );
    }
}

#[test]
fn colours_are_written_and_the_mesh_reads_back() {
    let view = sqrt_cc(&shapes::grid(3, 2)).unwrap();
    let colours: Vec<[f64; 3]> = view.labels.iter().map(|l| l.colour()).collect();
    let text = OBJ.bytes(&view.mesh, Some(&colours));
    let first = String::from_utf8(text.clone()).unwrap();
    assert_eq!(first.lines().next(), Some("v 0 0 0 0.85 0.15 0.1"));
    let back = OBJ.read(&text[..], "view", &ReadOptions::default()).unwrap().mesh;
    assert_eq!((back.points(), faces(&back)), (view.mesh.points(), faces(&view.mesh)));
    let outside = view.labels.iter().filter(|&&l| l == Label::Outside).count();
    let name = |f: usize| &*back.group_names()[back.groups()[f] as usize];
    assert_eq!((0..back.face_count()).filter(|&f| name(f) == "boundary").count(), outside);
}

#[test]
fn what_is_no_sqrt_cc_mesh_is_refused_with_the_reason() {
    let triangle = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let mesh = PolyMesh::new(triangle.map(Into::into).to_vec(), [[0, 1, 2]]).unwrap();
    assert_eq!(primal(&mesh, Label::Vertex), Err(ViewError::NotAQuad { face: 0, corners: 3 }));
    let odd = shapes::torus(5, 4);
    assert!(matches!(primal(&odd, Label::Vertex), Err(ViewError::OddCycle { .. })));
    assert_eq!(primal(&shapes::grid(1, 1), Label::Vertex), Err(ViewError::NoFaces));
}
