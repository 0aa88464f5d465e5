//! Each mend on the smallest mesh that needs it, and random soups.

mod common;

use common::{census, shape};
use proptest::prelude::*;
use quadmend::mesh::{
    Flaw, MendError, MendKind, MendPolicy, MendReport, Point, PolyMesh, check, mend,
};

/// A mesh of these faces on points that are all different.
fn mesh(faces: &[&[u32]]) -> PolyMesh {
    let n = faces.iter().flat_map(|f| f.iter()).max().map_or(0, |&v| v + 1);
    let points = (0..n).map(|v| Point::new(f64::from(v), f64::from(v % 7), 0.0)).collect();
    PolyMesh::new(points, faces).unwrap()
}

fn mended(input: &PolyMesh) -> (PolyMesh, MendReport) {
    let (output, report) = mend(input.clone(), MendPolicy::Mend).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(check(&output), Ok(()));
    assert_eq!(report.sources.len(), output.vertex_count());
    assert_eq!(report.face_sources.len(), output.face_count());
    for (v, &source) in report.sources.iter().enumerate() {
        assert_eq!(output.points()[v], input.points()[source as usize]);
    }
    if !report.mends.is_empty() {
        let refused = mend(input.clone(), MendPolicy::Strict);
        assert!(matches!(refused, Err(MendError::Refused { .. })), "{refused:?}");
    }
    (output, report)
}

/// Mends, asserts exactly these mends, and gives the faces by the vertices of the input.
fn mends(faces: &[&[u32]], want: &[(MendKind, usize, &[u32])]) -> Vec<Vec<u32>> {
    let (output, report) = mended(&mesh(faces));
    let got: Vec<_> =
        report.mends.iter().map(|m| (m.kind, m.count, m.examples.as_slice())).collect();
    assert_eq!(got, want);
    let source = |f: &[u32]| f.iter().map(|&v| report.sources[v as usize]).collect();
    output.faces().map(source).collect()
}

const CUBE: [&[u32]; 6] =
    [&[0, 3, 2, 1], &[4, 5, 6, 7], &[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7, 6], &[3, 0, 4, 7]];

/// A grid of `n` × `n` quads, row by row.
fn grid(n: u32) -> Vec<Vec<u32>> {
    let at = |i: u32, j: u32| i * (n + 1) + j;
    let quad = |k: u32| {
        let (i, j) = (k / n, k % n);
        vec![at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]
    };
    (0..n * n).map(quad).collect()
}

fn slices(faces: &[Vec<u32>]) -> Vec<&[u32]> {
    faces.iter().map(Vec::as_slice).collect()
}

#[test]
fn a_clean_mesh_stays_as_it_is() {
    let input = mesh(&CUBE);
    let (output, report) = mended(&input);
    assert_eq!(output, input);
    assert!(report.mends.is_empty());
    assert_eq!(report.sources, [0, 1, 2, 3, 4, 5, 6, 7]);
    assert!(mend(input, MendPolicy::Strict).is_ok());
}

#[test]
fn repeated_corners_are_dropped() {
    let faces = mends(&[&[0, 1, 1, 2, 3, 0]], &[(MendKind::RepeatedCorner, 2, &[0, 0])]);
    assert_eq!(faces, [[0, 1, 2, 3]]);
}

#[test]
fn a_valence_1_spur_is_cut_off() {
    let input: [&[u32]; 2] = [&[0, 1, 6, 1, 2, 3], &[1, 4, 5, 2]];
    assert_eq!(shape(&mesh(&input)), [(1, 1)]);
    assert_eq!(mends(&input, &[(MendKind::Spur, 1, &[0])]), [[0, 1, 2, 3], [1, 4, 5, 2]]);
}

#[test]
fn faces_of_two_corners_and_pinched_faces_are_dropped() {
    let faces = mends(
        &[&[0, 1], &[0, 1, 2, 3], &[2, 4, 5, 2, 6, 7], &[]],
        &[(MendKind::DegenerateFace, 3, &[0, 2, 3])],
    );
    assert_eq!(faces, [[0, 1, 2, 3]]);
}

#[test]
fn of_duplicate_faces_the_first_stays() {
    let faces = mends(
        &[&[0, 1, 2, 3], &[1, 4, 5, 2], &[3, 2, 1, 0], &[2, 3, 0, 1], &[5, 1, 4, 2]],
        &[(MendKind::DuplicateFace, 3, &[2, 3, 4])],
    );
    assert_eq!(faces, [[0, 1, 2, 3], [1, 4, 5, 2]]);
}

#[test]
fn a_book_of_three_pages_is_taken_apart() {
    let book: [&[u32]; 3] = [&[0, 1, 2, 3], &[0, 1, 4, 5], &[0, 1, 6, 7]];
    let (output, report) = mended(&mesh(&book));
    assert_eq!(report.count(MendKind::NonManifoldEdge), 1);
    assert_eq!(report.count(MendKind::BowTie), 2);
    assert_eq!(output.vertex_count(), 12);
    assert_eq!(report.sources, [0, 0, 0, 1, 1, 1, 2, 3, 4, 5, 6, 7]);
    assert_eq!(shape(&output), [(1, 1); 3]);
}

#[test]
fn a_flap_on_a_closed_surface_comes_off_and_the_surface_closes() {
    let mut faces = CUBE.to_vec();
    faces.push(&[0, 1, 8, 9]);
    let (output, _) = mended(&mesh(&faces));
    assert_eq!(shape(&output), [(2, 0), (1, 1)]);
}

#[test]
fn two_tetrahedra_on_a_vertex_become_two_components() {
    let faces: [&[u32]; 8] = [
        &[0, 2, 1],
        &[0, 1, 3],
        &[1, 2, 3],
        &[2, 0, 3],
        &[3, 5, 4],
        &[3, 4, 6],
        &[4, 5, 6],
        &[5, 3, 6],
    ];
    let (output, report) = mended(&mesh(&faces));
    assert_eq!(report.mends[0].sentence, "1 bow-tie vertex split (vertex 3, from 0)");
    assert_eq!(shape(&output), [(2, 0), (2, 0)]);
    assert_eq!(census(&output), census(&mesh(&faces)));
}

#[test]
fn two_tetrahedra_on_an_edge_become_two_closed_components() {
    let faces: [&[u32]; 8] = [
        &[0, 2, 1],
        &[0, 1, 3],
        &[1, 2, 3],
        &[2, 0, 3],
        &[0, 5, 1],
        &[0, 1, 4],
        &[1, 5, 4],
        &[5, 0, 4],
    ];
    let (output, _) = mended(&mesh(&faces));
    assert_eq!(shape(&output), [(2, 0), (2, 0)]);
}

#[test]
fn the_one_flipped_face_of_a_cube_is_turned_back() {
    let mut faces = CUBE.to_vec();
    faces[0] = &[0, 1, 2, 3];
    assert_eq!(mends(&faces, &[(MendKind::FlippedFace, 1, &[0])]), CUBE);
}

#[test]
fn on_a_tie_the_first_face_keeps_its_orientation() {
    let faces = mends(&[&[0, 1, 2, 3], &[1, 2, 5, 4]], &[(MendKind::FlippedFace, 1, &[1])]);
    assert_eq!(faces, [[0, 1, 2, 3], [1, 4, 5, 2]]);
}

#[test]
fn a_moebius_band_is_refused_and_named() {
    let band: [&[u32]; 4] = [&[8, 9, 10], &[0, 1, 3, 2], &[2, 3, 5, 4], &[4, 5, 0, 1]];
    for policy in [MendPolicy::Mend, MendPolicy::Strict] {
        let refused = mend(mesh_without_unused(&band), policy).unwrap_err();
        assert_eq!(refused, MendError::NonOrientable { face: 1 });
        assert!(refused.to_string().contains("Möbius"));
    }
}

/// The same faces on consecutive vertices.
fn mesh_without_unused(faces: &[&[u32]]) -> PolyMesh {
    let mut used: Vec<u32> = faces.concat();
    used.sort_unstable();
    used.dedup();
    let number = |v: &u32| used.binary_search(v).unwrap() as u32;
    let faces: Vec<Vec<u32>> = faces.iter().map(|f| f.iter().map(number).collect()).collect();
    mesh(&slices(&faces))
}

#[test]
fn a_doublet_of_two_quads_becomes_one_quad() {
    let mut faces = grid(3);
    faces[4] = vec![5, 9, 10, 16];
    faces.push(vec![5, 16, 10, 6]);
    let before = shape(&mesh(&slices(&faces)));
    let output = mends(&slices(&faces), &[(MendKind::DoubletMerged, 1, &[16])]);
    assert_eq!(output.len(), 9);
    assert_eq!(output[4], [5, 9, 10, 6]);
    assert_eq!(shape(&mesh(&slices(&output))), before);
}

#[test]
fn a_chain_of_doublets_goes_at_once() {
    let mut faces = grid(3);
    faces[4] = vec![5, 9, 10, 16, 17];
    faces.push(vec![17, 16, 10, 6, 5]);
    let output = mends(&slices(&faces), &[(MendKind::DoubletMerged, 1, &[16])]);
    assert_eq!(output[4], [5, 9, 10, 6]);
}

#[test]
fn doublets_that_appear_while_mending_go_too() {
    // A valence-3 corner of three quads, one of them a doublet's pair: 16 goes, then 17.
    let mut faces = grid(3);
    faces[4] = vec![5, 9, 10, 17];
    faces.push(vec![5, 17, 10, 16]);
    faces.push(vec![5, 16, 10, 6]);
    let before = shape(&mesh(&slices(&faces)));
    let output = mends(&slices(&faces), &[(MendKind::DoubletMerged, 2, &[16, 17])]);
    assert_eq!(output.len(), 9);
    assert_eq!(shape(&mesh(&slices(&output))), before);
}

#[test]
fn a_doublet_whose_faces_touch_again_is_dissolved() {
    // Two pentagons share the path 0-1-2 and the vertex 4 as well.
    let input: [&[u32]; 4] = [&[1, 2, 3, 4, 0], &[1, 0, 5, 4, 6, 2], &[4, 3, 2, 6], &[4, 5, 0]];
    let (output, report) = mended(&mesh(&input));
    assert_eq!(shape(&output), shape(&mesh(&input)));
    assert_eq!(report.count(MendKind::DoubletDissolved), 1, "{report:?}");
}

#[test]
fn a_doublet_that_can_neither_merge_nor_dissolve_is_braced() {
    // As above, and an edge 0-2 on the far side.
    let input: [&[u32]; 6] = [
        &[1, 2, 3, 4, 0],
        &[1, 0, 5, 4, 6, 2],
        &[5, 0, 7, 4],
        &[4, 7, 2, 6],
        &[7, 0, 2],
        &[0, 4, 3, 2],
    ];
    assert_eq!(shape(&mesh(&input)), [(2, 0)]);
    let (output, report) = mended(&mesh(&input));
    assert_eq!(shape(&output), [(2, 0)]);
    assert_eq!(report.count(MendKind::DoubletBraced), 1, "{report:?}");
}

#[test]
fn unused_vertices_are_dropped() {
    let points = (0..6).map(|v| Point::new(f64::from(v), 0.0, 0.0)).collect();
    let (output, report) = mended(&PolyMesh::new(points, [[1, 3, 4]]).unwrap());
    assert_eq!(report.sources, [1, 3, 4]);
    assert_eq!(report.count(MendKind::UnusedVertex), 3);
    assert_eq!(output.face(0), [0, 1, 2]);
    assert!(report.mends[0].sentence.starts_with("3 unused vertices dropped (vertex 0, 2, 5"));
}

#[test]
fn big_polygons_are_left_alone() {
    let big: Vec<u32> = (0..100_000).collect();
    assert!(mends(&[&big], &[]) == [big]);
}

#[test]
fn nothing_left_is_an_error() {
    for faces in [&[][..], &[&[0, 1][..], &[1, 1, 1]]] {
        let error = mend(mesh_without_unused(faces), MendPolicy::Mend).unwrap_err();
        assert_eq!(error, MendError::NothingLeft);
    }
}

#[test]
fn a_strict_refusal_names_the_first_problem() {
    let input = mesh(&[&[0, 1, 2, 3], &[0, 1, 1, 4]]);
    let message = mend(input, MendPolicy::Strict).unwrap_err().to_string();
    assert!(message.starts_with("face 1 (from 0) has the same corner twice"), "{message}");
}

#[test]
fn groups_follow_their_faces() {
    let input = mesh(&[&[0, 1], &[0, 1, 2, 3], &[1, 2, 5, 4]]);
    let names = ["", "a", "b", "c"].map(str::to_owned).to_vec();
    let (output, _) = mended(&input.with_groups(vec![1, 2, 3], names.clone()));
    assert_eq!(output.groups(), [2, 3]);
    assert_eq!(output.group_names(), names);
}

#[test]
fn every_flaw_is_found() {
    let flaw = |faces: &[&[u32]]| check(&mesh(faces)).unwrap_err();
    assert_eq!(flaw(&[]), Flaw::NoFaces);
    assert_eq!(flaw(&[&[0, 1]]), Flaw::ShortFace { face: 0 });
    assert_eq!(flaw(&[&[0, 1, 2, 1]]), Flaw::RepeatedVertex { face: 0, vertex: 1 });
    assert_eq!(flaw(&[&[0, 1, 3]]), Flaw::UnusedVertex { vertex: 2 });
    assert_eq!(flaw(&[&[0, 1, 2], &[2, 1, 0]]), Flaw::DuplicateFaces { first: 0, second: 1 });
    let book = flaw(&[&[0, 1, 2], &[0, 1, 3], &[0, 1, 4]]);
    assert_eq!(book, Flaw::NonManifoldEdge { a: 0, b: 1 });
    assert_eq!(flaw(&[&[0, 1, 2], &[0, 3, 4]]), Flaw::BowTie { vertex: 0 });
    assert_eq!(flaw(&[&[0, 1, 2], &[0, 1, 3]]), Flaw::Inconsistent { first: 0, second: 1 });
    let doublet = flaw(&[&[0, 1, 2, 3], &[0, 4, 2, 1]]);
    assert_eq!(doublet, Flaw::LowValence { vertex: 1, valence: 2 });
}

fn soup() -> impl Strategy<Value = PolyMesh> {
    let face = prop::collection::vec(0..12_u32, 0..7);
    prop::collection::vec(face, 1..24).prop_map(|faces| mesh(&slices(&faces)))
}

/// A grid from which some faces are removed, doubled, turned over or given to other vertices.
fn damaged_grid() -> impl Strategy<Value = PolyMesh> {
    let damage = (0..5_usize, any::<prop::sample::Index>(), any::<prop::sample::Index>());
    prop::collection::vec(damage, 0..8).prop_map(|damages| {
        let mut faces = grid(5);
        for (kind, at, other) in damages {
            let f = at.index(faces.len());
            match kind {
                0 => drop(faces.swap_remove(f)),
                1 => faces.push(faces[f].clone()),
                2 => faces[f].reverse(),
                3 => faces[f][1] = other.index(36) as u32,
                _ => {
                    // A doublet inside the face, beside its diagonal.
                    let (old, new) = (faces[f].clone(), 36 + faces.len() as u32);
                    faces[f] = [&old[..3], &[new]].concat();
                    faces.push([&[old[0], new, old[2]], &old[3..]].concat());
                }
            }
        }
        mesh(&slices(&faces))
    })
}

/// Two unit squares side by side, the right one divided in two or more, its vertices on the common
/// edge off by `off`.
fn cracked(parts: u32, off: f64) -> PolyMesh {
    let mut points = vec![
        Point::new(0.0, 0.0, 0.0),
        Point::new(1.0, 0.0, 0.0),
        Point::new(1.0, 1.0, 0.0),
        Point::new(0.0, 1.0, 0.0),
    ];
    let mut faces = vec![vec![0, 1, 2, 3]];
    let mut left = 1;
    points.push(Point::new(2.0, 0.0, 0.0));
    let mut right = 4;
    for part in 1..=parts {
        let y = f64::from(part) / f64::from(parts);
        let (below_left, below_right) = (left, right);
        left = if part == parts { 2 } else { points.len() as u32 };
        if part < parts {
            points.push(Point::new(1.0 + off, y, 0.0));
        }
        right = points.len() as u32;
        points.push(Point::new(2.0, y, 0.0));
        faces.push(vec![below_left, below_right, right, left]);
    }
    PolyMesh::new(points, faces).unwrap()
}

#[test]
fn cracks_are_welded_within_the_tolerance_only() {
    for (parts, off) in [(2, 0.0), (2, 0.04), (4, -0.04), (7, 0.0)] {
        let (output, report) = mended(&cracked(parts, off));
        assert_eq!(report.count(MendKind::Crack), parts as usize - 1);
        assert_eq!(output.face(0).len(), 4 + parts as usize - 1);
        assert_eq!(census(&output)[0].loops, 1, "{parts} {off}");
    }
    for off in [0.06, -0.2] {
        let (_, report) = mended(&cracked(2, off));
        assert_eq!(report.count(MendKind::Crack), 0, "{off}: a hole, not a crack");
    }
}

#[test]
fn a_crack_that_lies_on_two_faces_stays() {
    // The large square twice, on either side of the chain: its edges would have three faces.
    let input = cracked(2, 0.0);
    let mut points = input.points().to_vec();
    let n = points.len() as u32;
    points.extend([Point::new(0.0, 0.0, 1.0), Point::new(0.0, 1.0, 1.0)]);
    let mut faces: Vec<Vec<u32>> = input.faces().map(<[u32]>::to_vec).collect();
    faces.push(vec![n, 1, 2, n + 1]);
    let (_, report) = mended(&PolyMesh::new(points, faces).unwrap());
    assert_eq!(report.count(MendKind::Crack), 0);
}

/// Mends; what comes out is clean and mending it again changes nothing.
fn assert_settles(input: PolyMesh) -> Result<(), TestCaseError> {
    match mend(input, MendPolicy::Mend) {
        Ok((output, _)) => {
            prop_assert_eq!(check(&output), Ok(()));
            let (again, report) = mend(output.clone(), MendPolicy::Strict).unwrap();
            prop_assert!(report.mends.is_empty() && again == output);
        }
        Err(error) => prop_assert!(
            matches!(error, MendError::NothingLeft | MendError::NonOrientable { .. }),
            "{}",
            error
        ),
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn any_soup_is_mended_or_refused(input in soup()) {
        assert_settles(input)?;
    }

    #[test]
    fn any_damage_is_mended_or_refused(input in damaged_grid()) {
        assert_settles(input)?;
    }
}
