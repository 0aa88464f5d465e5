//! Tiny meshes whose every count can be worked out by hand.

use super::*;
use crate::mesh::Point;
use std::f64::consts::TAU;

type Faces = Vec<Vec<u32>>;
type Soup = (Vec<[f64; 3]>, Faces);

fn mesh((points, faces): Soup) -> PolyMesh {
    let points = points.into_iter().map(Point::from).collect();
    PolyMesh::new(points, faces).expect("a fixture is well formed")
}

fn metrics(soup: Soup) -> Metrics {
    measure(&mesh(soup), None).expect("a fixture has faces")
}

fn cube() -> Soup {
    let bit = |i: u32, b: u32| f64::from((i >> b) & 1);
    let points = (0..8).map(|i| [bit(i, 2), bit(i, 1), bit(i, 0)]).collect();
    let faces =
        [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
    (points, faces.iter().map(|f| f.to_vec()).collect())
}

fn open_grid(nx: u32, ny: u32) -> Soup {
    let point = |i: u32| [f64::from(i / (ny + 1)), f64::from(i % (ny + 1)), 0.0];
    let at = |i: u32, j: u32| i * (ny + 1) + j;
    let face = |i, j| vec![at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
    let faces = (0..nx).flat_map(|i| (0..ny).map(move |j| (i, j)));
    ((0..(nx + 1) * (ny + 1)).map(point).collect(), faces.map(|(i, j)| face(i, j)).collect())
}

fn torus(nx: u32, ny: u32) -> Soup {
    let point = |i: u32| {
        let (u, v) =
            (TAU * f64::from(i / ny) / f64::from(nx), TAU * f64::from(i % ny) / f64::from(ny));
        [(3.0 + v.cos()) * u.cos(), (3.0 + v.cos()) * u.sin(), v.sin()]
    };
    let at = |i: u32, j: u32| (i % nx) * ny + j % ny;
    let face = |i, j| vec![at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
    let faces = (0..nx).flat_map(|i| (0..ny).map(move |j| (i, j)));
    ((0..nx * ny).map(point).collect(), faces.map(|(i, j)| face(i, j)).collect())
}

/// A band of `nx` by `ny` quads closed in x, with or without half a turn.
fn band(nx: u32, ny: u32, turned: bool) -> Soup {
    let width = ny + 1;
    let point = |i: u32| {
        let u = TAU * f64::from(i / width) / f64::from(nx);
        let s = f64::from(i % width) / f64::from(ny) - 0.5;
        let half = if turned { u / 2.0 } else { 0.0 };
        let r = 2.0 + s * half.cos();
        let z = if turned { s * half.sin() } else { s };
        [if turned { r } else { 1.0 } * u.cos(), if turned { r } else { 1.0 } * u.sin(), z]
    };
    let at = |i: u32, j: u32| match (i == nx, turned) {
        (false, _) => i * width + j,
        (true, false) => j,
        (true, true) => ny - j,
    };
    let face = |i, j| vec![at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
    let faces = (0..nx).flat_map(|i| (0..ny).map(move |j| (i, j)));
    ((0..nx * width).map(point).collect(), faces.map(|(i, j)| face(i, j)).collect())
}

fn icosahedron() -> Soup {
    let p = f64::midpoint(1.0, 5.0_f64.sqrt());
    let mut points = Vec::new();
    for turn in 0..3 {
        for (a, b) in [(-1.0, p), (1.0, p), (-1.0, -p), (1.0, -p)] {
            let mut point = [0.0; 3];
            point[turn % 3] = a;
            point[(turn + 1) % 3] = b;
            points.push(point);
        }
    }
    // Turn 0 is (x, y), turn 1 (y, z), turn 2 (z, x): the order of the usual table of faces.
    let faces = [
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ];
    (points, faces.iter().map(|f| f.to_vec()).collect())
}

/// A 5 × 5 grid whose middle row is cut in two from column 2 to the right border.
fn t_junction_grid() -> Soup {
    let (mut points, faces) = open_grid(5, 5);
    let at = |i: u32, j: u32| i * 6 + j;
    let middle = |i: u32| 36 + i - 2;
    points.extend((2..6).map(|i| [f64::from(i), 2.5, 0.0]));
    let split = |face: Vec<u32>| match (face[0] / 6, face[0] % 6) {
        (1, 2) => vec![vec![at(1, 2), at(2, 2), middle(2), at(2, 3), at(1, 3)]],
        (i, 2) if i >= 2 => vec![
            vec![at(i, 2), at(i + 1, 2), middle(i + 1), middle(i)],
            vec![middle(i), middle(i + 1), at(i + 1, 3), at(i, 3)],
        ],
        _ => vec![face],
    };
    (points, faces.into_iter().flat_map(split).collect())
}

#[test]
fn cube_has_eight_irregular_vertices() {
    let m = metrics(cube());
    let s = &m.summary;
    assert_eq!((s.vertices, s.edges, s.faces, s.chi), (8, 12, 6, 2));
    assert_eq!((s.components, s.genus, s.boundary_loops), (1, 0, 0));
    assert!(s.manifold && s.oriented && s.gauss_bonnet_exact && s.pure_quad);
    assert_eq!((s.irregular_elements, s.t_junctions, s.lower_bound), (8, 0, 8));
    assert_eq!(
        (s.scaled_jacobian_min, s.angle_dev_mean, s.edge_cv),
        (Some(1.0), Some(0.0), Some(0.0))
    );
    assert!(m.topology.degenerate.is_clean());
}

#[test]
fn a_reversed_face_is_inconsistent_but_orientable() {
    let (points, mut faces) = cube();
    faces[0].reverse();
    let m = metrics((points, faces)).topology.connectivity;
    assert_eq!((m.inconsistent_edges, m.orientable, m.consistently_oriented), (4, true, false));
}

#[test]
fn torus_is_regular() {
    let s = metrics(torus(24, 12)).summary;
    assert_eq!((s.chi, s.genus, s.irregular_elements, s.boundary_loops), (0, 1, 0, 0));
    assert_eq!((s.gauss_bonnet_exact, s.lower_bound), (true, 0));
}

#[test]
fn open_grid_has_four_corners() {
    let m = metrics(open_grid(5, 4));
    let s = &m.summary;
    assert_eq!((s.chi, s.boundary_loops, s.irregular_elements, s.lower_bound), (1, 1, 0, 0));
    assert!(s.gauss_bonnet_exact);
    assert_eq!(m.topology.irregularity.boundary_index, Histogram::from([(1, 4), (0, 14)]));
    assert_eq!(m.topology.connectivity.boundary_loop_lengths, [18]);
}

#[test]
fn cylinder_has_two_loops_and_moebius_band_one_crosscap() {
    let s = metrics(band(12, 3, false)).summary;
    assert_eq!((s.boundary_loops, s.genus, s.chi), (2, 0, 0));
    let m = metrics(band(16, 3, true));
    let c = &m.topology.connectivity;
    assert_eq!((c.orientable, c.boundary_loops, c.euler_cut, c.crosscaps), (false, 1, 0, 1));
    assert!(m.summary.gauss_bonnet_exact);
}

#[test]
fn chords_break_the_literal_identity_only() {
    let t = metrics(open_grid(3, 1)).topology;
    assert!(t.gauss_bonnet.holds_per_component && !t.gauss_bonnet.literal_holds_per_component);
    assert_eq!((t.connectivity.chords, t.gauss_bonnet.literal_residual), (2, 4));
}

#[test]
fn icosahedron_counts_vertices_and_faces() {
    let m = metrics(icosahedron());
    assert_eq!((m.summary.irregular_elements, m.summary.chi), (32, 2));
    assert!(m.summary.gauss_bonnet_exact && m.summary.oriented);
    assert_eq!((m.quality.scaled_jacobian_quads, m.quality.planarity_quads), (None, None));
    let Some(all) = m.quality.angles.angle_dev_from_90_all_deg.mean else { panic!("has corners") };
    assert!((all - 30.0).abs() < 1e-9);
}

#[test]
fn a_row_that_ends_is_one_t_junction() {
    let m = metrics(t_junction_grid());
    let wanted = TJunctions { pairs_v3_f5: 1, matched: 1, geometric: 1, boundary: 0 };
    assert_eq!((m.summary.irregular_elements, m.quality.t_junctions), (2, wanted));
    assert!(m.summary.gauss_bonnet_exact);
    assert_eq!((m.summary.angle_dev_mean, m.quality.reflex_corner_faces), (Some(0.0), 0));
}

#[test]
fn a_doublet_shares_two_edges() {
    let (mut points, mut faces) = open_grid(3, 3);
    points.push([1.5, 1.5, 0.0]);
    faces[4] = vec![5, 9, 10, 16];
    faces.push(vec![5, 16, 10, 6]);
    let d = metrics((points, faces)).topology.degenerate;
    assert_eq!((d.doublets_valence2_interior, d.face_pairs_sharing_2plus_edges), (1, 1));
}

#[test]
fn a_bow_tie_is_two_components() {
    let (mut points, mut faces) = cube();
    let (more, others) = cube();
    points.extend(more.iter().map(|p| p.map(|x| x + 1.0)));
    let shift = |v: u32| if v == 0 { 7 } else { v + 8 };
    faces.extend(others.iter().map(|f| f.iter().map(|&v| shift(v)).collect()));
    let m = metrics((points, faces));
    let c = &m.topology.connectivity;
    assert_eq!((c.nonmanifold_vertices, c.components, c.components_by_vertices), (1, 2, 1));
    assert_eq!((m.summary.gauss_bonnet_exact, c.unreferenced_vertices), (true, 1));
}

#[test]
fn three_faces_on_an_edge_are_cut_apart() {
    let points = vec![
        [0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [-1.0, 0.0, 0.0],
        [-1.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.0, 1.0, 1.0],
    ];
    let faces = vec![vec![0, 2, 3, 1], vec![0, 1, 5, 4], vec![0, 6, 7, 1]];
    let m = metrics((points, faces));
    let c = &m.topology.connectivity;
    assert_eq!(
        (c.nonmanifold_edges, c.components, c.boundary_loops, c.nonmanifold_vertices),
        (1, 3, 3, 2)
    );
    assert!(m.summary.gauss_bonnet_exact && !m.summary.manifold);
}

#[test]
fn duplicates_and_repeats_are_counted() {
    let points =
        vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [2.0, 0.0, 0.0]];
    let m = metrics((points, vec![vec![0, 1, 2, 3], vec![3, 0, 1, 2], vec![1, 4, 2, 2]]));
    let d = m.topology.degenerate;
    assert_eq!((d.duplicate_faces, d.faces_repeated_vertex), (1, 1));
    assert_eq!(m.topology.connectivity.self_loop_edges, 1);
}

#[test]
fn planarity_is_relative_to_the_diagonals() {
    let points = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.1], [1.0, 1.0, 0.0], [0.0, 1.0, 0.1]];
    let m = metrics((points, vec![vec![0, 1, 2, 3]]));
    let Some(Spread { max: Some(max), .. }) = m.quality.planarity_quads else { panic!("a quad") };
    assert!((max - 0.1 / 2.0_f64.sqrt()).abs() < 1e-12);
}

#[test]
fn faces_without_corners_or_area_do_no_harm() {
    let points = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]];
    let m = metrics((points, vec![vec![], vec![0], vec![0, 1], vec![0, 1, 2], vec![0, 0, 0, 0]]));
    assert_eq!((m.topology.degenerate.faces_degree_lt3, m.quality.zero_area_faces), (3, 5));
    assert_eq!(measure(&mesh((vec![], vec![])), None), Err(MetricsError::NoFaces));
}

fn against_cube(soup: Soup) -> ReferenceMetrics {
    let target =
        Target::new(&mesh(cube()), &MeasureOptions { samples: 2000, ..Default::default() });
    let metrics = measure(&mesh(soup), Some(&target.expect("a cube is a surface")));
    metrics.expect("a fixture has faces").reference.expect("there is a reference")
}

#[test]
fn a_cube_is_itself() {
    let r = against_cube(cube());
    assert!(r.hausdorff < 1e-12 && r.rms < 1e-12);
    assert_eq!((r.orientation.flipped_faces, r.features.reference_edges), (0, 12));
    assert!(r.features.to_sharp_mesh_edge.is_some_and(|d| d.max < 1e-12));
    assert_eq!(r.boundary, Boundary::Counts { mesh_boundary_edges: 0, ref_boundary_edges: 0 });
}

#[test]
fn a_shifted_cube_is_as_far_as_the_shift() {
    let (points, faces) = cube();
    let r = against_cube((points.iter().map(|p| [p[0] + 0.1, p[1], p[2]]).collect(), faces));
    assert!((r.hausdorff * 3.0_f64.sqrt() - 0.1).abs() < 1e-9);
}

#[test]
fn an_inverted_cube_is_all_flipped() {
    let (points, mut faces) = cube();
    for face in &mut faces {
        face.reverse();
    }
    let orientation = against_cube((points, faces)).orientation;
    assert_eq!((orientation.flipped_faces, orientation.flipped_share), (6, 1.0));
    assert_eq!(orientation.normal_deviation_deg.mean, Some(180.0));
}

#[test]
fn boundaries_are_compared_along_their_length() {
    let options = MeasureOptions { samples: 2000, ..Default::default() };
    let target = Target::new(&mesh(open_grid(4, 4)), &options).expect("a grid is a surface");
    let (points, faces) = open_grid(4, 4);
    let raised = points.iter().map(|p| [p[0], p[1], 0.5]).collect();
    let m = measure(&mesh((raised, faces)), Some(&target)).expect("a grid has faces");
    let Some(Boundary::Distances { ref_to_mesh_max, mesh_to_ref_mean, .. }) =
        m.reference.map(|r| r.boundary)
    else {
        panic!("both have a boundary")
    };
    for d in [ref_to_mesh_max, mesh_to_ref_mean] {
        assert!((d * 32.0_f64.sqrt() - 0.5).abs() < 1e-12);
    }
}

#[test]
fn what_has_no_area_is_no_surface() {
    let flat = mesh((vec![[0.0; 3]; 3], vec![vec![0, 1, 2]]));
    let options = MeasureOptions::default();
    assert!(matches!(Target::new(&flat, &options), Err(MetricsError::Reference(_))));
    let target = Target::new(&mesh(cube()), &MeasureOptions { samples: 1000, ..options });
    let refused = measure(&flat, Some(&target.expect("a cube is a surface")));
    assert!(matches!(refused, Err(MetricsError::Mesh(_))));
}

#[test]
fn metrics_have_unique_keys_and_groups_in_one_piece() {
    let mut keys: Vec<&str> = METRICS.iter().map(|m| m.key).collect();
    keys.sort_unstable();
    assert!(keys.windows(2).all(|w| w[0] != w[1]));
    let mut groups: Vec<&str> = METRICS.iter().map(|m| m.group).collect();
    groups.dedup();
    let runs = groups.len();
    groups.sort_unstable();
    groups.dedup();
    assert_eq!(runs, groups.len());
}

#[test]
fn keys_of_the_summary_mean_the_same_in_the_registry() {
    let m = metrics(t_junction_grid());
    let json = serde_json::to_value(&m.summary).expect("metrics are JSON");
    for metric in METRICS {
        let Some(in_json) = json.get(metric.key).filter(|v| !v.is_object()) else { continue };
        let value = in_json.as_f64().or(in_json.as_bool().map(|b| f64::from(u8::from(b))));
        assert_eq!((metric.value)(&m), value, "{}", metric.key);
    }
}

#[test]
fn the_table_lines_up_and_leaves_out_what_is_not_there() {
    let (before, after) = (metrics(t_junction_grid()), metrics(open_grid(5, 5)));
    let text = table(&[("before", &before), ("after", &after)]);
    assert!(text.contains("T-junctions") && text.contains("↓ 100.0 %  better"), "{text}");
    assert!(!text.contains("Hausdorff") && !text.contains("doublets"), "{text}");
    let lines: Vec<&str> =
        text.lines().filter(|l| l.contains("change") || l.contains('%')).collect();
    assert!(lines.len() > 3 && text.lines().all(|l| l == l.trim_end()), "{text}");
    assert!(
        table(&[("cube", &metrics(cube()))]).lines().next().is_some_and(|l| l.ends_with("cube"))
    );
}

#[test]
fn huge_and_tiny_coordinates_do_no_harm() {
    for scale in [1e300, 1e160, 1e-160, 1e-300] {
        let (points, faces) = t_junction_grid();
        let scaled = mesh((points.iter().map(|p| p.map(|x| x * scale)).collect(), faces));
        let m = measure(&scaled, None).expect("it has faces");
        assert_eq!(m.summary.irregular_elements, 2);
        let options = MeasureOptions { samples: 1000, ..Default::default() };
        if let Ok(target) = Target::new(&scaled, &options) {
            // No number is promised, only that there is an answer.
            let _ = measure(&scaled, Some(&target));
        }
    }
}

#[test]
fn numbers_do_not_depend_on_the_number_of_threads() {
    let target =
        Target::new(&mesh(cube()), &MeasureOptions { samples: 3000, ..Default::default() });
    let (target, ball) = (target.expect("a cube is a surface"), mesh(icosahedron()));
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| measure(&ball, Some(&target)).expect("it has faces"))
    };
    let one = with(1);
    assert!(one == with(2) && one == with(8));
}
