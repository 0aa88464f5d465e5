//! Metrics as plain text for people: one mesh, or several side by side.

use super::Metrics;
use super::registry::{Better, Kind, METRICS, Metric};

/// One line: the label, the values, and for two meshes the change.
type Row = Vec<String>;

/// A metric of several meshes side by side, as it is shown.
#[derive(Debug, Clone)]
pub struct Line {
    /// The metric.
    pub metric: &'static Metric,
    /// Its value for each mesh; `-` where there is none.
    pub values: Vec<String>,
    /// Of exactly two meshes: how far and which way the second differs from the first.
    pub change: Option<Change>,
    /// The meshes with the best value, where values differ and one is better than another.
    pub best: Vec<usize>,
}

/// A change between two meshes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Change {
    /// `=`, or an arrow with the extent; empty for flags.
    pub extent: String,
    /// `better`, `worse`, or nothing where neither is.
    pub judgement: &'static str,
}

/// The lines that are worth reading: unmeasured numbers and faults that no mesh has are left out.
#[must_use]
pub fn lines(meshes: &[&Metrics]) -> Vec<Line> {
    let of = |metric: &'static Metric| {
        let values: Vec<Option<f64>> = meshes.iter().map(|m| (metric.value)(m)).collect();
        is_worth_a_line(metric, &values).then(|| line(metric, &values))
    };
    METRICS.iter().filter_map(of).collect()
}

/// Renders meshes side by side under their names. Two are read as before and after: a last column
/// says how much each number changed and whether that is better. Ends with a line break.
#[must_use]
pub fn table(meshes: &[(&str, &Metrics)]) -> String {
    let mut rows: Vec<Row> = vec![header(meshes)];
    let mut group = "";
    for line in lines(&meshes.iter().map(|&(_, m)| m).collect::<Vec<_>>()) {
        if line.metric.group != group {
            group = line.metric.group;
            rows.push(vec![group.to_owned()]);
        }
        rows.push(row(line));
    }
    layout(&rows, meshes.len())
}

fn header(meshes: &[(&str, &Metrics)]) -> Row {
    let mut header = vec![String::new()];
    header.extend(meshes.iter().map(|(name, _)| (*name).to_owned()));
    if meshes.len() == 2 {
        header.push("change".to_owned());
    }
    header
}

fn is_worth_a_line(metric: &Metric, values: &[Option<f64>]) -> bool {
    values.iter().flatten().any(|&v| !metric.quiet || v != 0.0)
}

fn row(line: Line) -> Row {
    let metric = line.metric;
    let unit = if metric.unit.is_empty() { String::new() } else { format!(" [{}]", metric.unit) };
    let mut row = vec![format!("  {}{unit}", metric.label)];
    row.extend(line.values);
    row.extend(line.change.map(|change| change.words()));
    row
}

fn line(metric: &'static Metric, values: &[Option<f64>]) -> Line {
    let change = match *values {
        [Some(before), Some(after)] => Some(change(metric, before, after)),
        _ => None,
    };
    let shown = |&v: &Option<f64>| v.map_or_else(|| "-".to_owned(), |v| show(metric.kind, v));
    let values_shown: Vec<String> = values.iter().map(shown).collect();
    Line { metric, best: best(metric, values, &values_shown), values: values_shown, change }
}

/// Numbers of the meshes that share the best value, as it is shown; none if all do.
fn best(metric: &Metric, values: &[Option<f64>], shown: &[String]) -> Vec<usize> {
    let worth = |v: f64| if metric.better == Better::Lower { -v } else { v };
    let measured = (0..values.len()).filter_map(|i| Some((i, worth(values[i]?))));
    let winner = measured.max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)));
    let Some((winner, _)) = winner.filter(|_| metric.better != Better::Neither) else {
        return Vec::new();
    };
    let sharing: Vec<usize> = (0..shown.len()).filter(|&i| shown[i] == shown[winner]).collect();
    if sharing.len() == shown.len() { Vec::new() } else { sharing }
}

impl Change {
    fn words(&self) -> String {
        let gap = if self.extent.is_empty() { "" } else { "  " };
        format!("{}{gap}{}", self.extent, self.judgement).trim_end().to_owned()
    }
}

fn show(kind: Kind, value: f64) -> String {
    match kind {
        Kind::Count => format!("{value:.0}"),
        Kind::Real => significant(value),
        Kind::Share => format!("{} %", significant(100.0 * value)),
        Kind::Flag => if value > 0.0 { "yes" } else { "no" }.to_owned(),
    }
}

/// Four significant digits, without exponent where that is readable.
fn significant(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || !size.is_finite() {
        return format!("{value}");
    }
    if !(1e-4..1e6).contains(&size) {
        return format!("{value:.3e}");
    }
    // The logarithm is within -4..6 here, so the digits are 0 to 7.
    #[allow(clippy::cast_sign_loss)]
    let digits = (3.0 - size.log10().floor()).max(0.0) as usize;
    format!("{value:.digits$}")
}

/// Which way and how far, and whether that is an improvement: `↓ 85.1 %` and `better`.
fn change(metric: &Metric, before: f64, after: f64) -> Change {
    // What is equal as it is shown is equal to the reader.
    if show(metric.kind, before) == show(metric.kind, after) {
        return Change { extent: "=".to_owned(), judgement: "" };
    }
    let (arrow, rises) = if after > before { ("↑", true) } else { ("↓", false) };
    let judgement = match metric.better {
        Better::Neither => "",
        better if rises == (better == Better::Higher) => "better",
        _ => "worse",
    };
    let extent = match metric.kind {
        Kind::Flag => String::new(),
        kind => format!("{arrow} {}", extent(kind, before, after)),
    };
    Change { extent, judgement }
}

/// Relative where there is something to relate to, else the difference.
fn extent(kind: Kind, before: f64, after: f64) -> String {
    // Rounding noise is nothing to relate to either.
    if before > 1e-6 * after && after >= 0.0 {
        return format!("{:.1} %", 100.0 * (after - before).abs() / before);
    }
    show(kind, (after - before).abs())
}

/// Pads the columns: labels and changes to the left, the `meshes` columns of values to the right.
fn layout(rows: &[Row], meshes: usize) -> String {
    let width = |c: usize| {
        let cells = rows.iter().filter_map(|row| row.get(c));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..meshes + 2).map(width).collect();
    let cell = |(c, text): (usize, &String)| {
        let width = widths[c];
        if (1..=meshes).contains(&c) {
            format!("{text:>width$}")
        } else {
            format!("{text:<width$}")
        }
    };
    let line = |row: &Row| {
        let cells: Vec<String> = row.iter().enumerate().map(cell).collect();
        format!("{}\n", cells.join("   ").trim_end())
    };
    rows.iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::super::metric;
    use super::*;

    fn changed(key: &str, before: f64, after: f64) -> String {
        change(metric(key).expect("the metric exists"), before, after).words()
    }

    #[test]
    fn changes_say_which_way_and_whether_that_is_better() {
        assert_eq!(changed("irregular_elements", 328.0, 52.0), "↓ 84.1 %  better");
        assert_eq!(changed("scaled_jacobian_min", 0.6, 0.3), "↓ 50.0 %  worse");
        assert_eq!(changed("scaled_jacobian_min", -0.5, 0.5), "↑ 1.000  better");
        assert_eq!(changed("manifold", 0.0, 1.0), "better");
        assert_eq!(changed("V", 10.0, 12.0), "↑ 20.0 %");
        assert_eq!(changed("flipped_faces", 0.0, 3.0), "↑ 3  worse");
        assert_eq!(changed("rms", 1e-17, 0.000_3), "↑ 0.03000 %  worse");
        assert_eq!(changed("fig10_mean", 2.0, 2.000_000_1), "=");
    }

    #[test]
    fn the_best_are_those_that_share_the_best_value() {
        let of = |key: &str, values: &[Option<f64>]| {
            line(metric(key).expect("the metric exists"), values).best
        };
        assert_eq!(of("irregular_elements", &[Some(3.0), Some(1.0), Some(1.0)]), [1, 2]);
        assert_eq!(of("scaled_jacobian_min", &[Some(0.5), None]), [0]);
        assert_eq!(of("scaled_jacobian_min", &[Some(0.5), Some(0.500_000_1)]), [0; 0]);
        assert_eq!(of("V", &[Some(1.0), Some(2.0)]), [0; 0]);
    }

    #[test]
    fn numbers_keep_four_digits() {
        let shown = [0.0, 12.345_67, 0.001_234_56, 123_456.7, 1e-7, -0.5].map(significant);
        assert_eq!(shown, ["0", "12.35", "0.001235", "123457", "1.000e-7", "-0.5000"]);
        assert_eq!(show(Kind::Share, 0.015_73), "1.573 %");
    }
}
