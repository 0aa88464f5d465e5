//! Evenly spread points of a surface, and distances measured with them.
//!
//! Samples are stratified along the running sum of areas and placed in their triangle by the
//! two-dimensional additive sequence of Roberts (*The unreasonable effectiveness of
//! quasirandom sequences*, 2018); nothing is random.

use super::reference::Reference;
use crate::mesh::Point;

/// The number of the triangle that each of `count` samples is on, ascending, for triangles of these
/// areas; none if they have none. O(triangles + count).
pub(super) fn sampled(areas: &[f64], count: usize) -> Vec<u32> {
    let total: f64 = areas.iter().sum();
    let (mut out, mut done) = (Vec::with_capacity(count), 0.0);
    for (area, number) in areas.iter().zip(0..) {
        done += area;
        // Sample i stands in the middle of its share of the area, (i + 1/2) / count.
        while out.len() < count && (out.len() as f64 + 0.5) * total < done * count as f64 {
            out.push(number);
        }
    }
    out
}

/// Sample number `i` put at a place of the triangle that looks random.
pub(super) fn place_in_triangle(i: usize, [a, b, c]: &[Point; 3]) -> Point {
    // Powers of the inverse of the plastic number, the real root of x^3 = x + 1.
    const STEP: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_3];
    let [u, v] = STEP.map(|s| (0.5 + s * (i + 1) as f64).fract());
    let (r, s) = (u.sqrt(), v);
    Point::from(a.coords * (1.0 - r) + b.coords * (r * (1.0 - s)) + c.coords * (r * s))
}

/// How far two surfaces are apart, both ways, in the units of the file.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Deviation {
    /// Largest distance of a sample to the other surface, either way.
    pub hausdorff: f64,
    /// Root mean square distance of the samples, the larger of both ways.
    pub rms: f64,
}

/// Corners of a surface beyond which only some are looked at.
const MOST_CORNERS: usize = 200_000;

/// Distances from samples and vertices (of many, some) of each surface to the other. `count` samples each way.
/// O((count + vertices) log n), in parallel; independent of the number of threads.
#[must_use]
pub fn deviation(surface: &Reference, other: &Reference, count: usize) -> Deviation {
    let (there, back) = (one_way(surface, other, count), one_way(other, surface, count));
    Deviation { hausdorff: there.hausdorff.max(back.hausdorff), rms: there.rms.max(back.rms) }
}

/// At most so many of some points, evenly spread over their order.
pub(crate) fn spread(points: &[Point], most: usize) -> Vec<Point> {
    let every = points.len().div_ceil(most.max(1)).max(1);
    points.iter().step_by(every).copied().collect()
}

/// Distances from samples and corners of `from` to `to`.
fn one_way(from: &Reference, to: &Reference, count: usize) -> Deviation {
    let (mut far, mut squares) = (0.0, 0.0);
    let samples = from.samples(count);
    to.closest_each(&samples, &mut Vec::new(), |_, hit| {
        far = hit.distance.max(far);
        squares += hit.distance * hit.distance;
    });
    let corners = spread(from.used_points(), MOST_CORNERS);
    to.closest_each(&corners, &mut Vec::new(), |_, hit| far = hit.distance.max(far));
    Deviation { hausdorff: far, rms: (squares / samples.len().max(1) as f64).sqrt() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::PolyMesh;

    fn square(z: f64) -> PolyMesh {
        let corners = [[0.0, 0.0, z], [3.0, 0.0, z], [3.0, 1.0, z], [0.0, 1.0, z]];
        PolyMesh::new(corners.map(Point::from).to_vec(), [[0, 1, 2, 3]]).unwrap()
    }

    #[test]
    fn samples_are_spread_by_area() {
        let surface = Reference::new(&square(0.0)).unwrap();
        let samples = surface.samples(1200);
        assert_eq!(samples.len(), 1200);
        let left = samples.iter().filter(|p| p.x < 1.0).count();
        assert!((380..=420).contains(&left), "{left} of 1200 are in the left third");
        assert!(samples.iter().all(|p| surface.closest(p).distance < 1e-14));
    }

    #[test]
    fn deviation_of_shifted_squares_is_the_shift() {
        let surfaces = [0.0, 0.25].map(|z| Reference::new(&square(z)).unwrap());
        let d = deviation(&surfaces[0], &surfaces[1], 100);
        assert_eq!(d, Deviation { hausdorff: 0.25, rms: 0.25 });
    }
}
