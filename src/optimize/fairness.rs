//! Planarity and angles of all faces, in mean and maximum.
//!
//! Planarity is the extent of the corners along the normal of the face over the mean length of
//! its long diagonals; for a quad that is the distance of the diagonals over their mean length
//! (as in the metrics). The deviation of angles is that of Peng & Wonka 2013, Figure 10.

use crate::mesh::PolyMesh;
use crate::metrics::measure;
use serde::Serialize;

/// Mean and maximum of a quantity.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct MeanMax {
    /// Mean.
    pub mean: f64,
    /// Maximum.
    pub max: f64,
}

/// How planar and how equiangular the faces of a mesh are.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Fairness {
    /// Planarity of the faces with four corners and more.
    pub planarity: MeanMax,
    /// Mean |angle − mean angle of the face| over faces, degrees.
    pub angle_deviation_deg: MeanMax,
}

impl Fairness {
    /// Measures `mesh`. O(n log n).
    #[must_use]
    pub fn of(mesh: &PolyMesh) -> Self {
        let (mut sum, mut count, mut max) = (0.0, 0, 0.0f64);
        for f in (0..mesh.face_count()).filter(|&f| mesh.face(f).len() > 3) {
            let planarity = planarity(mesh, f);
            (sum, count, max) = (sum + planarity, count + 1, max.max(planarity));
        }
        let angles =
            measure(mesh, None).ok().map(|m| m.quality.angles.fig10_face_angle_deviation_deg);
        Self {
            planarity: MeanMax { mean: sum / f64::from(count.max(1)), max },
            angle_deviation_deg: angles.map_or(MeanMax::default(), |a| MeanMax {
                mean: a.mean.unwrap_or_default(),
                max: a.max.unwrap_or_default(),
            }),
        }
    }
}

/// Planarity of face `f`: 0 is planar.
#[must_use]
pub fn planarity(mesh: &PolyMesh, f: usize) -> f64 {
    let face = mesh.face(f);
    let point = |i: usize| mesh.points()[face[i % face.len()] as usize];
    let Some(normal) = mesh.area_vector(f).try_normalize(0.0) else { return 0.0 };
    let height = (0..face.len()).map(|i| normal.dot(&point(i).coords));
    let (low, high) =
        height.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
    let across = |i: usize| (point(i + face.len() / 2) - point(i)).norm();
    let length = (0..face.len()).map(across).sum::<f64>() / face.len() as f64;
    if length > 0.0 { (high - low) / length } else { 0.0 }
}
