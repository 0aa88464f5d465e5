//! The √CC domain: exact round trips, and every invariant after long random edit sequences.

mod common;

use common::lifted::{fingerprint, frozen_edges, held_points, no_features, operation, samples};
use proptest::prelude::*;
use quadmend::mesh::PolyMesh;
use quadmend::sqrtcc::{lift, lower};

/// The faces with each cycle turned so that its smallest vertex comes first.
fn normalised(mesh: &PolyMesh) -> Vec<Vec<u32>> {
    mesh.faces()
        .map(|f| {
            let start = (0..f.len()).min_by_key(|&i| f[i]).unwrap_or(0);
            (0..f.len()).map(|i| f[(start + i) % f.len()]).collect()
        })
        .collect()
}

#[test]
fn round_trip_keeps_every_polygon() {
    for (name, mesh, features) in samples() {
        let q = lift(&mesh, &features).expect(name);
        q.check().expect(name);
        let back = lower(&q, mesh.group_names()).expect(name).mesh;
        assert_eq!(normalised(&back), normalised(&mesh), "{name}");
        assert_eq!(back.points(), mesh.points(), "{name}");
    }
}

#[test]
fn equation_1_gauss_bonnet() {
    for (name, mesh, features) in samples() {
        let q = lift(&mesh, &features).expect(name);
        assert_eq!(q.index_sum(), 4 * q.euler_characteristic(), "{name}");
        let closed_chi = match name {
            "torus" => 0,
            _ => 2,
        };
        assert_eq!(q.euler_characteristic(), closed_chi, "{name}");
    }
}

#[test]
fn regular_shapes_have_only_the_irregular_elements_they_need() {
    let expected = [("sphere", 8), ("disk", 0), ("torus", 0), ("cube with features", 0)];
    for ((name, mesh, features), (_, count)) in samples().into_iter().zip(expected) {
        assert_eq!(lift(&mesh, &features).expect(name).total_irregularity(), count, "{name}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, ..ProptestConfig::default() })]

    #[test]
    fn random_edits_keep_every_invariant_and_undo_bit_for_bit(
        steps in prop::collection::vec((any::<u8>(), any::<u32>(), any::<u32>()), 4000)
    ) {
        for (name, mesh, features) in samples() {
            let mut q = lift(&mesh, &features).expect(name);
            let (chi, held, frozen) = (q.euler_characteristic(), held_points(&q), frozen_edges(&q));
            let before = fingerprint(&q);
            let mark = q.mark();
            let mut expected = q.total_irregularity() as i64;
            let mut done = 0;
            for &(kind, place, turns) in &steps {
                if let Ok(delta) = operation(&q, kind, place, turns).run(&mut q) {
                    expected += i64::from(delta);
                    done += 1;
                    if done % 64 == 0 {
                        prop_assert_eq!(q.total_irregularity() as i64, expected, "{}", name);
                    }
                }
            }
            prop_assert!(done > 500, "{}: only {} edits were legal", name, done);
            q.check().expect(name);
            prop_assert_eq!(q.total_irregularity() as i64, expected, "{}", name);
            prop_assert_eq!(q.euler_characteristic(), chi, "{}", name);
            prop_assert_eq!(q.index_sum(), 4 * chi, "{}", name);
            prop_assert_eq!(held_points(&q), held, "{}", name);
            prop_assert_eq!(frozen_edges(&q), frozen, "{}", name);
            let lowered = lower(&q, mesh.group_names()).expect(name).mesh;
            let again = lift(&lowered, &no_features(&lowered));
            prop_assert!(again.is_ok(), "{}: {:?}", name, again.err());
            q.undo_to(mark);
            prop_assert!(fingerprint(&q) == before, "{}: undo is not exact", name);
        }
    }
}
