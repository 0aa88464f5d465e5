//! Refilling patches: random convex regions, after random edits, with every filling that fits.

mod common;

use common::lifted::{Dice, Invariants, fingerprint, mess_up, no_features, operation, samples};
use proptest::prelude::*;
use quadmend::mesh::shapes;
use quadmend::patch::{Filling, Grower, Refill, Region, fillings};
use quadmend::sqrtcc::{QuadKind, QuadMesh, Vertex, lift, lower};

/// Most faces of a region.
const MOST_FACES: usize = 160;
/// Fillings asked for.
const MOST_FILLINGS: usize = 4;

/// How many refills there were, and of what.
#[derive(Debug, Clone, Copy, Default)]
struct Tally {
    regions: usize,
    /// Refills made.
    made: usize,
    /// Refills that would have joined two vertices twice.
    refused: usize,
    /// Refills made of regions that stand against a boundary, and against a feature.
    against_boundary: usize,
    against_feature: usize,
    /// Refills made by number of corners.
    by_corners: [usize; 7],
}

impl Tally {
    fn count(&mut self, mesh: &QuadMesh, region: &Region) {
        let stands_against =
            |kind| region.rim.iter().any(|&h| mesh.kind(QuadMesh::quad(h)) == kind);
        self.made += 1;
        self.against_boundary += usize::from(stands_against(QuadKind::Boundary));
        self.against_feature += usize::from(stands_against(QuadKind::Feature));
        self.by_corners[region.corners.len()] += 1;
    }

    fn add(&mut self, other: &Self) {
        self.regions += other.regions;
        self.made += other.made;
        self.refused += other.refused;
        self.against_boundary += other.against_boundary;
        self.against_feature += other.against_feature;
        for (mine, theirs) in self.by_corners.iter_mut().zip(other.by_corners) {
            *mine += theirs;
        }
    }
}

/// A convex region around a random face or vertex, a few rings wide before it is made convex.
fn grow(mesh: &QuadMesh, grower: &mut Grower, dice: &mut Dice) -> Option<Region> {
    let alive: Vec<Vertex> = mesh.vertices().collect();
    grower.start(mesh);
    grower.add(mesh, alive[dice.below(alive.len() as u32) as usize]);
    for _ in 0..dice.below(4) {
        grower.add_ring(mesh);
    }
    let outline = grower.convex(mesh, MOST_FACES).ok()?;
    Some(grower.region(mesh, outline))
}

/// Refills `regions` random regions with each filling that fits, and keeps one filling of each.
fn refill_everywhere(mesh: &mut QuadMesh, dice: &mut Dice, regions: usize) -> Tally {
    let (mut tally, mut grower) = (Tally::default(), Grower::default());
    let invariants = Invariants::of(mesh);
    for _ in 0..regions {
        let Some(region) = grow(mesh, &mut grower, dice) else { continue };
        let all = fillings(region.rim.len(), &region.corners, MOST_FILLINGS);
        tally.regions += 1;
        let before = fingerprint(mesh);
        let mut kept = None;
        for filling in all {
            let mark = mesh.mark();
            match refill(mesh, &region, filling) {
                Some(refill) => {
                    assert_eq!(Invariants::of(mesh), invariants);
                    mesh.undo_to(mark);
                    tally.count(mesh, &region);
                    kept = Some(refill);
                }
                None => tally.refused += 1,
            }
            assert!(fingerprint(mesh) == before, "undo is not exact, or a refusal left traces");
        }
        if let Some(refill) = kept {
            refill.run(mesh).expect("what was legal is legal again");
        }
    }
    assert_eq!(Invariants::of(mesh), invariants);
    tally
}

/// Refills the region if that is legal; its irregularity is then as predicted.
fn refill(mesh: &mut QuadMesh, region: &Region, filling: Filling) -> Option<Refill> {
    let corners = region.corners.len();
    let before = mesh.total_irregularity();
    let after = region.rim_irregularity_after + filling.irregularity();
    let refill = Refill::new(mesh, region, filling).unwrap();
    assert_eq!(refill.places.len(), refill.filling.interior as usize);
    assert!(refill.places.iter().all(|p| p.iter().all(|x| x.is_finite())), "places are finite");
    refill.run(mesh).ok()?;
    let measured = mesh.total_irregularity() as i64 - before as i64;
    let predicted = i64::from(after) - i64::from(region.irregularity);
    assert_eq!(measured, predicted, "{corners} corners: the change of irregularity");
    Some(refill)
}

/// The mesh can be written and read again.
fn survives_lowering(mesh: &QuadMesh) {
    let polygons = lower(mesh, &[String::new()]).expect("can be lowered").mesh;
    quadmend::mesh::check(&polygons).expect("a clean mesh");
    let again = lift(&polygons, &no_features(&polygons)).expect("can be lifted again");
    again.check().expect("a sound mesh");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, ..ProptestConfig::default() })]

    #[test]
    fn every_filling_of_random_regions_keeps_every_invariant(
        edits in prop::collection::vec((any::<u8>(), any::<u32>(), any::<u32>()), 0..400),
        seed in any::<u64>(),
    ) {
        for (name, mesh, features) in samples() {
            let mut q = lift(&mesh, &features).expect(name);
            for &(kind, place, turns) in &edits {
                let _ = operation(&q, kind, place, turns).run(&mut q);
            }
            let tally = refill_everywhere(&mut q, &mut Dice(seed), 12);
            prop_assert!(tally.regions > 0, "{}: no region could be grown", name);
            survives_lowering(&q);
        }
    }
}

/// The same seeds every time: regions of each kind are met, and most fillings are legal.
fn tally_of(name: &str) -> Tally {
    let mut sum = Tally::default();
    for (_, mesh, features) in samples().into_iter().filter(|s| s.0 == name) {
        for seed in 0..16 {
            let mut dice = Dice(seed);
            let mut q = lift(&mesh, &features).expect(name);
            mess_up(&mut q, &mut dice, 5 * seed as usize);
            sum.add(&refill_everywhere(&mut q, &mut dice, 12));
            survives_lowering(&q);
        }
    }
    assert!(sum.made >= 80, "{name}: {sum:?}");
    assert!(sum.refused <= sum.made, "{name}: {sum:?}");
    sum
}

#[test]
fn regions_against_a_boundary_are_refilled() {
    assert!(tally_of("disk").against_boundary >= 20);
}

#[test]
fn regions_against_features_are_refilled() {
    assert!(tally_of("cube with features").against_feature >= 20);
}

#[test]
fn regions_with_three_to_six_corners_are_refilled() {
    let mut sum = tally_of("sphere");
    sum.add(&tally_of("torus"));
    assert!(sum.by_corners[3..=6].iter().all(|&n| n > 0), "{sum:?}");
}

/// Whatever is refilled around a pin, there is a pinned vertex just there.
#[test]
fn pins_stay_in_place_while_their_surroundings_are_refilled() {
    for seed in 0..4 {
        let mut dice = Dice(seed);
        let mesh = shapes::sphere(8);
        let mut q = lift(&mesh, &no_features(&mesh)).expect("a sphere");
        for v in (0..mesh.vertex_count() as u32).step_by(23) {
            q.pin(v);
        }
        mess_up(&mut q, &mut dice, 20);
        refill_everywhere(&mut q, &mut dice, 20);
        survives_lowering(&q);
    }
}
