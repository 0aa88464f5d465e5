//! A run of `clean`: what was mended, edited and refused, with what settings, how long it took.

use crate::config::{Config, SECTIONS};
use crate::knobs::Knob;
use crate::mesh::Point;
use crate::pipeline::Report;
use crate::planner::edit::Edit;
use crate::planner::gate::Failure;
use crate::planner::movement::Cancellation;
use crate::planner::schedule::{EditRecord, RoundRecord};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// A part of a run and how long it took.
#[derive(Debug, Clone, Copy)]
pub struct Timing {
    /// What was done.
    pub phase: &'static str,
    /// Seconds.
    pub seconds: f64,
}

/// How a mesh came about.
#[derive(Debug, Clone)]
pub struct Run<'a> {
    /// What was done to it.
    pub report: &'a Report,
    /// With what settings.
    pub config: &'a Config,
    /// How long it took.
    pub timings: Vec<Timing>,
}

impl Run<'_> {
    pub(super) fn json(&self, centre: &Point) -> Value {
        let report = self.report;
        json!({
            "mends": report.mends.mends.iter().map(|m| &m.sentence).collect::<Vec<_>>(),
            "feature_edges": report.feature_edges,
            "edits": report.edits.iter().map(|e| edit(e, centre)).collect::<Vec<_>>(),
            "curve": curve(report),
            "refused": refused(&report.rounds),
            "config": self.sections(),
            "timings": self.timings.iter().map(|t| json!({
                "phase": t.phase, "seconds": t.seconds,
            })).collect::<Vec<_>>(),
        })
    }

    /// Every knob with its value, and whether that is the default.
    fn sections(&self) -> Vec<Value> {
        let default = Config::default();
        let knob = |section: &str, knob: &Knob| {
            let [value, usual] = [self.config, &default].map(|c| c.get(section, knob.name));
            json!({
                "key": knob.name,
                "unit": knob.unit,
                "meaning": knob.meaning.trim(),
                "value": value.as_ref().map(ToString::to_string),
                "changed": value != usual,
            })
        };
        SECTIONS
            .iter()
            .map(|s| {
                let knobs: Vec<Value> = s.knobs.iter().map(|k| knob(s.name, k)).collect();
                json!({ "name": s.name, "about": s.about.trim(), "knobs": knobs })
            })
            .collect()
    }
}

fn edit(record: &EditRecord, centre: &Point) -> Value {
    let place: Vec<f32> = (Point::from(record.place) - centre).iter().map(|&x| x as f32).collect();
    let terms = match &record.edit {
        Edit::Walk { terms, .. } => {
            terms.iter().map(|t| json!([t.name, rounded(t.cost)])).collect()
        }
        _ => Vec::new(),
    };
    json!({
        "round": record.round,
        "what": words(&record.edit),
        "gain": record.gain,
        "cost": rounded(record.cost),
        "angle": rounded(record.angle_growth_deg),
        "terms": terms,
        "place": place,
    })
}

/// To four places: what is shown needs no more.
fn rounded(value: f64) -> f64 {
    (value * 1e4).round() / 1e4
}

/// An edit in words.
#[must_use]
pub fn words(edit: &Edit) -> String {
    match edit {
        Edit::Local { ops } => format!("local, {} ops", ops.len()),
        Edit::Walk { cancellation, steps, .. } => {
            let of = match cancellation {
                Cancellation::Triple => "triple",
                Cancellation::TJunctionPair => "T-junction pair",
                Cancellation::Quadruple => "quadruple",
            };
            format!("{of} cancellation, {} steps", steps.len())
        }
        Edit::TypeChange { .. } => "type change".to_owned(),
        Edit::Refill(_) => "refill".to_owned(),
        Edit::Crossing(crossing) => match crossing.shifts.len() {
            1 => "crossing of a feature".to_owned(),
            n => format!("crossing of {n} features"),
        },
        Edit::Ideals { ideals } => format!("features measured anew, {} sectors", ideals.len()),
    }
}

/// The irregularity that the planner sees, before the first edit and after each: its sum of gains,
/// counted back from the end.
fn curve(report: &Report) -> Vec<i64> {
    let end = report.rounds.last().map_or(0, |round| round.irregularity.cast_signed());
    let mut left: Vec<i64> = vec![end];
    for edit in report.edits.iter().rev() {
        left.push(left[left.len() - 1] + i64::from(edit.gain));
    }
    left.reverse();
    left
}

/// How many candidates were turned down for each reason, at each exchange rate, in the order of
/// the rounds.
fn refused(rounds: &[RoundRecord]) -> Value {
    let mut rates: Vec<f64> = Vec::new();
    let mut counts: BTreeMap<Failure, Vec<usize>> = BTreeMap::new();
    for round in rounds {
        let known = rates.iter().position(|&rate| rate.total_cmp(&round.lambda).is_eq());
        let column = known.unwrap_or_else(|| {
            rates.push(round.lambda);
            rates.len() - 1
        });
        for (&reason, &count) in &round.turned_down {
            let row = counts.entry(reason).or_default();
            row.resize(row.len().max(column + 1), 0);
            row[column] += count;
        }
    }
    let rows: Vec<Value> = counts
        .into_iter()
        .map(|(reason, mut row)| {
            row.resize(rates.len(), 0);
            json!({ "reason": reason, "why": why(reason), "counts": row })
        })
        .collect();
    json!({ "lambdas": rates, "rows": rows })
}

fn why(reason: Failure) -> &'static str {
    match reason {
        Failure::Jacobian => "a quad nearby would be too badly shaped",
        Failure::Angles => "corner angles would grow worse than the elements removed are worth",
        Failure::Distance => "faces would leave the reference, or leave a part of it uncovered",
        Failure::Size => "the mesh would get too many or too few edges",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refusals_are_added_up_for_each_exchange_rate() {
        let round = |lambda: f64, reason: Failure, count: usize| RoundRecord {
            lambda,
            turned_down: [(reason, count)].into(),
            ..RoundRecord::default()
        };
        let rounds = [
            round(80.0, Failure::Angles, 3),
            round(80.0, Failure::Angles, 4),
            round(200.0, Failure::Jacobian, 1),
        ];
        let table = refused(&rounds);
        assert_eq!(table["lambdas"], json!([80.0, 200.0]));
        assert_eq!(table["rows"][0]["counts"], json!([0, 1]));
        assert_eq!(table["rows"][1]["counts"], json!([7, 0]));
    }
}
