//! Anchors: places of the reference that the mesh has left pull it back.
//!
//! Closest-point projection alone lets vertices slide off a horn: each of them is on the
//! surface, yet none at the tip. So every so often samples of the reference that are far from the
//! mesh pull the corners of the face that is nearest to them.

use super::kernel::{Kernel, Target};
use crate::mesh::{NONE, Point, PolyMesh};
use crate::surface::{Reference, spread};

/// Weight of a pull in units of the weight of all faces of a vertex.
const PULL: f64 = 1.0;

/// Places of the reference that are watched: about `count` by area, and at most twice as many of
/// its vertices, among which are the tips of horns. O(triangles).
pub(super) fn watched(reference: &Reference, count: usize) -> Vec<Point> {
    let mut places = reference.samples(count);
    places.extend(spread(reference.used_points(), 2 * count));
    places
}

/// Places of the reference that are watched, each with a triangle of the mesh that covered it.
pub(super) struct Watched {
    places: Vec<Point>,
    near: Vec<u32>,
}

impl Watched {
    /// About `count` places, see [`watched`].
    pub(super) fn new(reference: &Reference, count: usize) -> Self {
        let places = watched(reference, count);
        Self { near: vec![NONE; places.len()], places }
    }
}

/// Lets every watched place farther than `far` from `surface`, which is that of `mesh`, pull; how
/// many there are.
pub(super) fn pull(
    kernel: &mut Kernel,
    (mesh, surface): (&PolyMesh, &Reference),
    watched: &mut Watched,
    far: f64,
) -> usize {
    kernel.pulls.clear();
    // A root may round either way: what is about as far as that is measured.
    let lost = surface.farther_than(&watched.places, far * (1.0 - 1e-12), &mut watched.near);
    let lost: Vec<Point> = lost.into_iter().map(|i| watched.places[i as usize]).collect();
    let hits = surface.closest_many(&lost);
    let mut count = 0;
    for (place, hit) in lost.iter().zip(&hits).filter(|(_, h)| h.distance > far) {
        if count == 0 {
            kernel.pulls.resize(mesh.vertex_count(), Target::default());
        }
        count += 1;
        for &v in mesh.face(surface.faces()[hit.triangle as usize] as usize) {
            let goal = mesh.points()[v as usize] + (place - hit.point);
            let pull = &mut kernel.pulls[v as usize];
            for k in 0..3 {
                pull.sum[k] += goal[k];
            }
            pull.weight += 1.0;
        }
    }
    for pull in kernel.pulls.iter_mut().filter(|p| p.weight > 0.0) {
        // Many samples pull one vertex: their mean counts once.
        pull.sum = pull.sum.map(|x| x / pull.weight * PULL);
        pull.weight = PULL;
    }
    count
}
