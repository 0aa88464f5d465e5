//! The page of a search: one HTML file that opens offline, light or dark, without scripts.

use super::objective::{Measures, QUANTITIES, weighted};
use super::plot::{Axis, Dot, Mark, Plot, number};
use super::space::Dimension;
use super::{Findings, Goal, Judged, TuneError};
use crate::report::{STYLE, escaped, filled};
use std::fmt::Write;

const PAGE: &str = include_str!("page.html");

/// Size of the large plots, and of those of single knobs.
const LARGE: [f64; 2] = [440.0, 300.0];
const SMALL: [f64; 2] = [320.0, 210.0];
/// Trials in the table of the best.
const LISTED: usize = 10;
/// Scores beyond this many times that of the start are drawn at the edge.
const HIGHEST: f64 = 2.0;

/// The page of what a search has found.
pub fn page(findings: &Findings) -> Result<String, TuneError> {
    let page = Page { findings, best: findings.best(), order: by_importance(findings) };
    let title = format!("quadmend tune: {} trials", findings.trials.len());
    let body = [
        page.tiles(),
        key(),
        page.trade_offs(),
        page.knobs(),
        page.table(),
        page.meshes(),
        page.about()?,
    ];
    let title = escaped(&title);
    let parts = [
        ("@TITLE@", &*title),
        ("@STYLE@", STYLE),
        ("@HEADING@", &title),
        ("@BODY@", &body.join("\n")),
    ];
    Ok(filled(PAGE, &parts))
}

/// The knobs, those that matter most first.
fn by_importance(findings: &Findings) -> Vec<usize> {
    let mut order: Vec<usize> = (0..findings.space.0.len()).collect();
    if let Some(shares) = &findings.importance {
        order.sort_by(|&a, &b| shares[b].total_cmp(&shares[a]));
    }
    order
}

struct Page<'a> {
    findings: &'a Findings,
    best: &'a Judged,
    order: Vec<usize>,
}

impl Page<'_> {
    /// What the best trial is worth.
    fn tiles(&self) -> String {
        let tile = |name: &str, value: String, change: f64| {
            let class = if change < 0.9995 {
                " better"
            } else if change > 1.0005 {
                " worse"
            } else {
                ""
            };
            format!(
                "<div class=\"tile{class}\"><div class=\"faint\">{name}</div><div class=\"big\">\
                 <b>{value}</b></div><div class=\"change\">{}</div></div>",
                in_words(change)
            )
        };
        let mut tiles =
            tile("score of the best trial", format!("{:.4}", self.best.score), self.best.score);
        for (quantity, &ratio) in QUANTITIES.iter().zip(&self.best.ratios) {
            tiles += &tile(quantity.label, format!("× {ratio:.3}"), ratio);
        }
        format!(
            "<p class=\"faint\">The best of {} trials, trial {}, beside the configuration that the \
             search started from, over {}; less is better.</p><div class=\"tiles\">{tiles}</div>",
            self.findings.trials.len(),
            self.best.trial.number,
            counted(self.findings.meshes.len(), "mesh", "meshes")
        )
    }

    fn mark(&self, judged: &Judged) -> Mark {
        if judged.trial.number == self.best.trial.number {
            Mark::Best
        } else if judged.trial.number == 0 {
            Mark::Start
        } else if judged.on_front {
            Mark::Front
        } else {
            Mark::Trial
        }
    }

    /// A dot for each trial.
    fn dots(&self, at: impl Fn(&Judged) -> [f64; 2]) -> Vec<Dot> {
        let trials = self.findings.trials.iter();
        trials.map(|t| Dot { at: at(t), mark: self.mark(t), title: title(t) }).collect()
    }

    /// Every pair of the measures that count, and how the score fell.
    fn trade_offs(&self) -> String {
        let among = weighted(&self.findings.task.weights);
        let pairs = among.iter().flat_map(|&i| among.iter().map(move |&j| (i, j)));
        let plots: String =
            pairs.filter(|(i, j)| i < j).map(|(i, j)| self.trade_off([i, j])).collect();
        format!(
            "<section><h2>What is bought with what</h2><p class=\"faint\">Measures relative to the \
             start, geometric mean over the meshes: 1 is as much as there, left and low is better. \
             Point at a mark for its figures.</p><div class=\"charts\">{plots}{}</div></section>",
            self.progress()
        )
    }

    fn trade_off(&self, pair: [usize; 2]) -> String {
        let axis = |i: usize| {
            let values = self.findings.trials.iter().map(|t| t.ratios[i]);
            Axis::around(&format!("{}, × start", QUANTITIES[i].label), values, true)
        };
        let [i, j] = pair;
        let label = format!("{} against {}", QUANTITIES[j].label, QUANTITIES[i].label);
        let dots = self.dots(|t| pair.map(|i| t.ratios[i]));
        let plot = Plot {
            label: &label,
            size: LARGE,
            axes: pair.map(axis),
            steps: self.front(pair),
            dots,
        };
        format!("<figure>{}</figure>", plot.svg())
    }

    /// The corners of the front of two measures, as the steps of a line.
    fn front(&self, [i, j]: [usize; 2]) -> Vec<[f64; 2]> {
        let mut points: Vec<[f64; 2]> =
            self.findings.trials.iter().map(|t| [t.ratios[i], t.ratios[j]]).collect();
        points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        let mut front: Vec<[f64; 2]> = Vec::new();
        for point in points {
            if front.last().is_none_or(|last| point[1] < last[1]) {
                front.push(point);
            }
        }
        front
    }

    fn progress(&self) -> String {
        let trials = &self.findings.trials;
        let (mut steps, mut least): (Vec<[f64; 2]>, f64) = (Vec::new(), f64::INFINITY);
        for t in trials {
            least = least.min(t.score);
            steps.push([t.trial.number as f64, least]);
        }
        let numbers = trials.iter().map(|t| t.trial.number as f64);
        let scores = trials.iter().map(|t| t.score.min(HIGHEST));
        let axes = [Axis::around("trial", numbers, false), Axis::around("score", scores, true)];
        let dots = self.dots(|t| [t.trial.number as f64, t.score.min(HIGHEST)]);
        let plot = Plot { label: "score of each trial", size: LARGE, axes, dots, steps };
        format!("<figure>{}</figure>", plot.svg())
    }

    /// Which knobs matter, and what they do to the score.
    fn knobs(&self) -> String {
        let words = match &self.findings.importance {
            None => "With more trials this page says which knobs matter.".to_owned(),
            Some(shares) => format!(
                "In the order of how much they matter: the share of the variance of the score that \
                 a knob explains by itself (functional ANOVA). What is left, {:.0} %, is in their \
                 interplay.",
                100.0 * (1.0 - shares.iter().sum::<f64>()).clamp(0.0, 1.0)
            ),
        };
        let slices: String = self.order.iter().map(|&d| self.slice(d)).collect();
        format!(
            "<section><h2>Which knobs matter</h2><p class=\"faint\">{words}</p>\
             <div class=\"knobs\">{slices}</div></section>"
        )
    }

    /// The score against one knob.
    fn slice(&self, d: usize) -> String {
        let Dimension { key, low, high, log, .. } = &self.findings.space.0[d];
        let scores = self.findings.trials.iter().map(|t| t.score.min(HIGHEST));
        let axes = [Axis::from_to("", (*low, *high), *log), Axis::around("score", scores, true)];
        let dots = self.dots(|t| [t.trial.values[d].clamp(*low, *high), t.score.min(HIGHEST)]);
        let plot = Plot {
            label: &format!("score against {key}"),
            size: SMALL,
            axes,
            dots,
            steps: Vec::new(),
        };
        let share = match &self.findings.importance {
            None => String::new(),
            Some(shares) => bar(shares[d].clamp(0.0, 1.0)),
        };
        format!(
            "<figure><figcaption><b>{}</b> {share}</figcaption>{}</figure>",
            escaped(key),
            plot.svg()
        )
    }

    /// The best trials with what their knobs were set to.
    fn table(&self) -> String {
        let mut trials: Vec<&Judged> = self.findings.trials.iter().collect();
        trials.sort_by(|a, b| a.score.total_cmp(&b.score));
        trials.truncate(LISTED);
        if !trials.iter().any(|t| t.trial.number == 0) {
            trials.extend(self.findings.trials.first());
        }
        let heads: String = QUANTITIES.iter().map(|q| head(q.label)).collect();
        let knobs: String =
            self.order.iter().map(|&d| head(&self.findings.space.0[d].key)).collect();
        let rows: String = trials.iter().map(|t| self.row(t)).collect();
        format!(
            "<section><h2>The best trials</h2><div class=\"scroll\"><table><thead><tr>\
             <th>trial</th>{}{heads}{knobs}</tr></thead><tbody>{rows}</tbody></table></div></section>",
            head("score")
        )
    }

    fn row(&self, judged: &Judged) -> String {
        let name = match judged.trial.number {
            0 => "the start".to_owned(),
            number => number.to_string(),
        };
        let mut cells = format!("<th>{name}</th>{}", cell(&format!("{:.4}", judged.score)));
        cells.extend(judged.ratios.iter().map(|r| cell(&format!("× {r:.3}"))));
        cells.extend(self.order.iter().map(|&d| cell(&number(judged.trial.values[d]))));
        format!("<tr>{cells}</tr>")
    }

    /// The measures of each mesh, at the start and at the best.
    fn meshes(&self) -> String {
        let start = &self.findings.trials[0].trial.measures;
        let mut rows = String::new();
        for (i, file) in self.findings.meshes.iter().enumerate() {
            let pairs = QUANTITIES.iter().map(|q| {
                let value = |all: &[Measures]| all.get(i).map_or(0.0, |m| (q.value)(m));
                let [from, to] = [value(start), value(&self.best.trial.measures)];
                cell(&format!("{} → <b>{}</b>", number(from), number(to)))
            });
            // Writing to a string cannot fail.
            let _ =
                write!(rows, "<tr><th>{}</th>{}</tr>", escaped(file), pairs.collect::<String>());
        }
        let heads: String = QUANTITIES.iter().map(|q| head(q.label)).collect();
        format!(
            "<section><h2>The meshes</h2><p class=\"faint\">At the start → with the best trial. \
             Angles in degrees, distances relative to the diagonal of the reference.</p>\
             <div class=\"scroll\"><table><thead><tr><th>mesh</th>{heads}</tr></thead>\
             <tbody>{rows}</tbody></table></div></section>"
        )
    }

    /// What was searched, and the best configuration.
    fn about(&self) -> Result<String, TuneError> {
        let task = &self.findings.task;
        let weights: Vec<String> = QUANTITIES
            .iter()
            .map(|q| format!("{} {}", q.name, number((q.weight)(&task.weights))))
            .collect();
        let goal = match task.goal {
            Goal::Score => "the least score",
            Goal::Pareto => "the Pareto front",
        };
        let config = self.findings.config(self.best)?.to_toml_changed();
        Ok(format!(
            "<section><h2>The search</h2><p>Goal: {goal}. Weights: {}. Seed {}, generations of {} \
             trials. quadmend {}.</p><details><summary>The best configuration, as it is in \
             best.toml</summary><pre>{}</pre></details></section>",
            weights.join(", "),
            task.seed,
            task.generation,
            env!("CARGO_PKG_VERSION"),
            escaped(&config)
        ))
    }
}

/// What the marks of all plots mean.
fn key() -> String {
    let marks = [
        (Mark::Best, "best score"),
        (Mark::Start, "the start"),
        (Mark::Front, "Pareto front: no trial is better in all that has a weight"),
        (Mark::Trial, "other trials"),
    ];
    let sign = |(mark, words): (Mark, &str)| {
        let sign = mark.sign([7.0, 7.0], words);
        format!("<span><svg viewBox=\"0 0 14 14\" aria-hidden=\"true\">{sign}</svg>{words}</span>")
    };
    format!("<div class=\"marks\">{}</div>", marks.map(sign).concat())
}

/// What the pointer is told at a trial.
fn title(judged: &Judged) -> String {
    let mut text = format!("trial {}: score {:.4}", judged.trial.number, judged.score);
    for (quantity, ratio) in QUANTITIES.iter().zip(&judged.ratios) {
        let _ = write!(text, ", {} × {ratio:.3}", quantity.label);
    }
    text
}

fn in_words(change: f64) -> String {
    match 100.0 * (change - 1.0) {
        percent if percent.abs() < 0.05 => "as at the start".to_owned(),
        percent if percent < 0.0 => format!("↓ {:.1} %", -percent),
        percent => format!("↑ {percent:.1} %"),
    }
}

fn counted(count: usize, one: &str, more: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { more })
}

fn head(words: &str) -> String {
    format!("<th class=\"number\">{}</th>", escaped(words))
}

fn cell(html: &str) -> String {
    format!("<td class=\"number\">{html}</td>")
}

/// A share as a bar with its number.
fn bar(share: f64) -> String {
    format!(
        "<svg viewBox=\"0 0 120 12\" style=\"width:90px;height:10px\" aria-hidden=\"true\">\
         <rect class=\"bar\" width=\"{:.1}\" height=\"12\"/></svg> {:.0} %",
        120.0 * share,
        100.0 * share
    )
}
