//! Anchors: places of the reference that the mesh has left pull it back.
//!
//! Closest-point projection alone lets vertices slide off a horn: each of them is on the
//! surface, yet none at the tip. So every so often samples of the reference that are far from the
//! mesh pull the corners of the face that is nearest to them.

use super::kernel::{Kernel, Target};
use crate::mesh::{Point, PolyMesh};
use crate::surface::Reference;

/// Weight of a pull in units of the weight of all faces of a vertex.
const PULL: f64 = 1.0;

/// Places of the reference that are watched: about `count` by area, and at most twice as many of
/// its vertices, among which are the tips of horns. O(triangles).
pub(crate) fn watched(reference: &Reference, count: usize) -> Vec<Point> {
    let mut used: Vec<u32> = reference.triangles().iter().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    let stride = used.len().div_ceil(2 * count.max(1)).max(1);
    let mut places = reference.samples(count);
    places.extend(used.iter().step_by(stride).map(|&v| reference.points()[v as usize]));
    places
}

/// Lets every watched place farther than `far` from `mesh` pull; how many there are.
pub(super) fn pull(kernel: &mut Kernel, mesh: &PolyMesh, places: &[Point], far: f64) -> usize {
    kernel.pulls.clear();
    let Ok(surface) = Reference::plain(mesh) else { return 0 };
    // A root may round either way: what is about as far as that is measured.
    let lost = surface.farther_than(places, far * (1.0 - 1e-12));
    let lost: Vec<Point> = lost.into_iter().map(|i| places[i as usize]).collect();
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
