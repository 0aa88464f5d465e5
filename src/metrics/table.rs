//! Metrics as plain text for people: one mesh, or several side by side.

use super::Metrics;
use super::registry::{Better, Kind, METRICS, Metric};

/// One line: the label, the values, and for two meshes the change.
type Row = Vec<String>;

/// Renders meshes side by side under their names. Two are read as before and after: a last column
/// says how much each number changed and whether that is better. Ends with a line break.
#[must_use]
pub fn table(meshes: &[(&str, &Metrics)]) -> String {
    let mut rows: Vec<Row> = vec![header(meshes)];
    let mut group = "";
    for metric in METRICS {
        let values: Vec<Option<f64>> = meshes.iter().map(|(_, m)| (metric.value)(m)).collect();
        if !is_worth_a_line(metric, &values) {
            continue;
        }
        if metric.group != group {
            group = metric.group;
            rows.push(vec![group.to_owned()]);
        }
        rows.push(row(metric, &values));
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

/// Unmeasured numbers and faults that no mesh has are left out.
fn is_worth_a_line(metric: &Metric, values: &[Option<f64>]) -> bool {
    values.iter().flatten().any(|&v| !metric.quiet || v != 0.0)
}

fn row(metric: &Metric, values: &[Option<f64>]) -> Row {
    let unit = if metric.unit.is_empty() { String::new() } else { format!(" [{}]", metric.unit) };
    let mut row = vec![format!("  {}{unit}", metric.label)];
    row.extend(values.iter().map(|&v| v.map_or_else(|| "-".to_owned(), |v| show(metric.kind, v))));
    if let &[Some(before), Some(after)] = values {
        row.push(change(metric, before, after));
    }
    row
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

/// Which way and how far, and whether that is an improvement: `↓ 85.1 %  better`.
fn change(metric: &Metric, before: f64, after: f64) -> String {
    // What is equal as it is shown is equal to the reader.
    if show(metric.kind, before) == show(metric.kind, after) {
        return "=".to_owned();
    }
    let (arrow, rises) = if after > before { ("↑", true) } else { ("↓", false) };
    let judgement = match metric.better {
        Better::Neither => "",
        better if rises == (better == Better::Higher) => "better",
        _ => "worse",
    };
    if metric.kind == Kind::Flag {
        return judgement.to_owned();
    }
    format!("{arrow} {}  {judgement}", extent(metric.kind, before, after)).trim_end().to_owned()
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
        change(metric(key).expect("the metric exists"), before, after)
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
    fn numbers_keep_four_digits() {
        let shown = [0.0, 12.345_67, 0.001_234_56, 123_456.7, 1e-7, -0.5].map(significant);
        assert_eq!(shown, ["0", "12.35", "0.001235", "123457", "1.000e-7", "-0.5000"]);
        assert_eq!(show(Kind::Share, 0.015_73), "1.573 %");
    }
}
