//! Histograms of all meshes over the same bins.

use super::Entry;
use crate::elements::edges;
use serde_json::{Value, json};

const BINS: usize = 48;

/// Share of values that may be beyond the last bin, so that a few do not flatten the rest.
const CUT: f64 = 0.002;

/// What is counted: name, unit, and one value for each element.
type Counted = (&'static str, &'static str, fn(&Entry) -> Vec<f64>);

const CHARTS: [Counted; 2] = [
    ("angle deviation of faces", "°", |entry| {
        entry.inspection.field("angle-deviation").map(|f| f.values.clone()).unwrap_or_default()
    }),
    ("edge length", "mean edges", edge_lengths),
];

/// All histograms.
pub(super) fn histograms(meshes: &[Entry]) -> Vec<Value> {
    CHARTS.iter().map(|chart| histogram(chart, meshes)).collect()
}

fn histogram((label, unit, values): &Counted, meshes: &[Entry]) -> Value {
    let values: Vec<Vec<f64>> = meshes.iter().map(values).collect();
    let mut all: Vec<f64> = values.iter().flatten().copied().filter(|v| v.is_finite()).collect();
    all.sort_by(f64::total_cmp);
    let cut = ((1.0 - CUT) * all.len() as f64) as usize;
    let high = all.get(cut).copied().filter(|&high| high > 1e-9).unwrap_or(1.0);
    json!({
        "label": label,
        "unit": unit,
        "high": high,
        "counts": values.iter().map(|v| counts(v, high)).collect::<Vec<_>>(),
    })
}

/// How many values are in each bin from 0 to `high`; the last one takes all above.
fn counts(values: &[f64], high: f64) -> Vec<u32> {
    let mut counts = vec![0; BINS];
    for value in values.iter().filter(|v| v.is_finite()) {
        let bin = (value / high * BINS as f64) as usize;
        counts[bin.min(BINS - 1)] += 1;
    }
    counts
}

/// Over their mean.
fn edge_lengths(entry: &Entry) -> Vec<f64> {
    let (mesh, topology) = (entry.mesh, &entry.inspection.topology);
    let point = |c: u32| mesh.points()[mesh.corners()[c as usize] as usize];
    let length = |h: u32| (point(topology.next[h as usize]) - point(h)).norm();
    let lengths: Vec<f64> = edges(topology).map(length).collect();
    let mean = lengths.iter().sum::<f64>() / lengths.len().max(1) as f64;
    lengths.iter().map(|l| l / mean).collect()
}
