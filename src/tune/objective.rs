//! What a configuration is judged by.
//!
//! All measures count relative to those of the configuration that the search starts from, so that
//! every mesh has the same weight. A new measure is one entry of [`QUANTITIES`], one field of
//! [`Measures`] and of [`Weights`], and one line of `configs/tune.toml`.

use serde::{Deserialize, Serialize};

/// What came of a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Measures {
    /// Irregular elements E.
    pub irregular: f64,
    /// Mean deviation of the corner angles of faces, in degrees.
    pub angle_deg: f64,
    /// Root mean square distance to the reference, relative to its diagonal.
    pub distance_rel: f64,
    /// Edits that were judged.
    pub work: f64,
}

/// What counts how much; 0 is not at all.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Weights {
    /// Irregular elements.
    pub irregular: f64,
    /// Angle deviation.
    pub angle: f64,
    /// Distance to the reference.
    pub distance: f64,
    /// Edits that were judged.
    pub work: f64,
}

impl Weights {
    /// Whether a score can be had with them.
    pub(super) fn are_legal(&self) -> bool {
        let all: Vec<f64> = QUANTITIES.iter().map(|q| (q.weight)(self)).collect();
        all.iter().all(|w| w.is_finite() && *w >= 0.0) && all.iter().any(|&w| w > 0.0)
    }
}

/// A measure that can be weighted.
#[derive(Debug, Clone, Copy)]
pub struct Quantity {
    /// Its name, which is its key in `weights`.
    pub name: &'static str,
    /// Name for people.
    pub label: &'static str,
    /// Its weight.
    pub weight: fn(&Weights) -> f64,
    /// Its value.
    pub value: fn(&Measures) -> f64,
    /// What is added before values are compared: differences that are smaller hardly matter.
    pub floor: f64,
}

/// All measures.
pub const QUANTITIES: &[Quantity] = &[
    Quantity {
        name: "irregular",
        label: "irregular elements",
        weight: |w| w.irregular,
        value: |m| m.irregular,
        floor: 1.0,
    },
    Quantity {
        name: "angle",
        label: "angle deviation",
        weight: |w| w.angle,
        value: |m| m.angle_deg,
        floor: 0.01,
    },
    Quantity {
        name: "distance",
        label: "RMS distance",
        weight: |w| w.distance,
        value: |m| m.distance_rel,
        floor: 1e-6,
    },
    Quantity {
        name: "work",
        label: "edits judged",
        weight: |w| w.work,
        value: |m| m.work,
        floor: 1.0,
    },
];

/// The geometric mean over all meshes of each measure relative to that of `start`.
#[must_use]
pub fn ratios(measures: &[Measures], start: &[Measures]) -> Vec<f64> {
    let ratio = |q: &Quantity| {
        let value = |m: &Measures| ((q.value)(m) + q.floor).ln();
        let sum: f64 = measures.iter().zip(start).map(|(m, s)| value(m) - value(s)).sum();
        (sum / measures.len().max(1) as f64).exp()
    };
    QUANTITIES.iter().map(ratio).collect()
}

/// The weighted geometric mean of [`ratios`].
#[must_use]
pub fn score(ratios: &[f64], weights: &Weights) -> f64 {
    let weights = QUANTITIES.iter().map(|q| (q.weight)(weights));
    let (sum, total) =
        ratios.iter().zip(weights).fold((0.0, 0.0), |(sum, total), (ratio, weight)| {
            (sum + weight * ratio.ln(), total + weight)
        });
    (sum / total).exp()
}

/// Which of the measures have a weight, as numbers in [`QUANTITIES`].
#[must_use]
pub fn weighted(weights: &Weights) -> Vec<usize> {
    let counts = |&i: &usize| (QUANTITIES[i].weight)(weights) > 0.0;
    (0..QUANTITIES.len()).filter(counts).collect()
}

/// Which of the points are no worse than any other in all of the measures `among`.
#[must_use]
pub fn front(points: &[Vec<f64>], among: &[usize]) -> Vec<bool> {
    let beats = |a: &[f64], b: &[f64]| {
        among.iter().all(|&i| a[i] <= b[i]) && among.iter().any(|&i| a[i] < b[i])
    };
    points.iter().map(|p| !points.iter().any(|other| beats(other, p))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tune::Task;

    fn measures(irregular: f64, angle_deg: f64) -> Measures {
        Measures { irregular, angle_deg, distance_rel: 0.001, work: 99.0 }
    }

    #[test]
    fn meshes_weigh_the_same() {
        let start = [measures(9.0, 2.0), measures(999.0, 1.0)];
        let one_better = [measures(4.0, 2.0), measures(999.0, 1.0)];
        let other_better = [measures(9.0, 2.0), measures(499.0, 1.0)];
        let [a, b] = [one_better, other_better].map(|m| ratios(&m, &start)[0]);
        assert!((a - b).abs() < 1e-12 && (a - 0.5_f64.sqrt()).abs() < 1e-12, "{a} {b}");
    }

    #[test]
    fn the_start_has_score_one_and_halves_weigh_as_told() {
        let weights = Task::default().weights;
        let start = [measures(9.0, 2.0)];
        assert!((score(&ratios(&start, &start), &weights) - 1.0).abs() < 1e-12);
        let halved = score(&ratios(&[measures(4.0, 2.0)], &start), &weights);
        assert!((halved - 0.5_f64.powf(1.0 / 1.75)).abs() < 1e-12, "{halved}");
    }

    #[test]
    fn the_front_is_what_nothing_beats() {
        let points = [[1.0, 3.0], [2.0, 2.0], [2.0, 3.0], [3.0, 1.0], [1.0, 3.0]].map(Vec::from);
        assert_eq!(front(&points, &[0, 1]), [true, true, false, true, true]);
        assert_eq!(front(&points, &[0]), [true, false, false, false, true]);
    }

    #[test]
    fn weights_are_those_of_the_task_file() {
        let table = toml::Table::try_from(Task::default().weights).expect("a table");
        let names: Vec<&str> = QUANTITIES.iter().map(|q| q.name).collect();
        assert_eq!(table.keys().collect::<Vec<_>>(), names);
    }
}
