//! The overview of a batch: one HTML file with everything in it, light or dark as the reader has it.
//!
//! *Invariant:* whatever files and errors are called, they are text on the page.

use super::Entry;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use std::fmt::Write;

const PAGE: &str = include_str!("page.html");

/// A mesh on the page.
#[derive(Debug, Clone)]
pub struct Row<'a> {
    /// What is known about it.
    pub entry: &'a Entry,
    /// Pictures before and after as PNG, if there are any.
    pub pictures: Option<[Vec<u8>; 2]>,
    /// File of its own report, within the folder of the batch.
    pub report: Option<String>,
}

/// A column of numbers: heading, key of the metric, decimals, factor.
struct Column {
    head: &'static str,
    key: &'static str,
    decimals: usize,
    factor: f64,
}

const COLUMNS: &[Column] = &[
    Column { head: "faces", key: "F", decimals: 0, factor: 1.0 },
    Column { head: "E", key: "irregular_elements", decimals: 0, factor: 1.0 },
    Column { head: "T-junctions", key: "t_junctions", decimals: 0, factor: 1.0 },
    Column { head: "angles °", key: "fig10_mean", decimals: 1, factor: 1.0 },
    Column { head: "Jacobian", key: "scaled_jacobian_min", decimals: 2, factor: 1.0 },
    Column { head: "Hausdorff %", key: "hausdorff", decimals: 2, factor: 100.0 },
];

/// The whole file.
#[must_use]
pub fn page(title: &str, rows: &[Row]) -> String {
    let head = |c: &Column| ["<th data-sort>", c.head, "</th>"].concat();
    let columns: String = COLUMNS.iter().map(head).collect();
    let body: String = rows.iter().map(row).collect();
    // In the order of the page, so that a mark within a part is left alone.
    let parts = [
        ("@TITLE@", escaped(title)),
        ("@HEADING@", escaped(title)),
        ("@SUMMARY@", summary(rows)),
        ("@COLUMNS@", columns),
        ("@ROWS@", body),
    ];
    let (mut html, mut rest) = (String::new(), PAGE);
    for (mark, text) in parts {
        let (before, after) = rest.split_once(mark).unwrap_or((rest, ""));
        html.push_str(before);
        html.push_str(&text);
        rest = after;
    }
    html + rest
}

/// How many meshes there are of each status, and E of all together.
fn summary(rows: &[Row]) -> String {
    let mut counts = std::collections::BTreeMap::new();
    for row in rows {
        *counts.entry(row.entry.status).or_insert(0usize) += 1;
    }
    let mut words = vec![format!("{} meshes", rows.len())];
    words.extend(counts.into_iter().map(|(status, count)| format!("{count} {}", status.words())));
    let with_both = || rows.iter().map(|row| row.entry).filter(|entry| entry.status.has_mesh());
    let sum = |of: fn(&Entry) -> Option<&f64>| with_both().filter_map(of).sum::<f64>();
    let before = sum(|entry| entry.before.get("irregular_elements"));
    let after = sum(|entry| entry.after.get("irregular_elements"));
    words.push(format!("E {before} → {after}"));
    words.join(" · ")
}

fn row(row: &Row) -> String {
    let Row { entry, pictures, report } = row;
    let class = if entry.status.has_failed() { " class=\"failed\"" } else { "" };
    let mut html = format!("<tr{class}>");
    match pictures {
        Some(pictures) => {
            for (when, picture) in ["before", "after"].iter().zip(pictures) {
                let data = STANDARD.encode(picture);
                // Writing to a string cannot fail.
                let _ = write!(
                    html,
                    "<td class=\"picture\"><img loading=\"lazy\" width=\"144\" height=\"108\" \
                     alt=\"{when}\" src=\"data:image/png;base64,{data}\"></td>"
                );
            }
        }
        None => html.push_str("<td class=\"picture\"></td><td class=\"picture\"></td>"),
    }
    let name = escaped(&entry.input);
    let link = |file: &str, words: &str| format!("<a href=\"{}\">{words}</a>", address(file));
    let links: Vec<String> = [
        entry.output.as_ref().map(|file| link(file, "mesh")),
        report.as_ref().map(|file| link(file, "report")),
    ]
    .into_iter()
    .flatten()
    .collect();
    let error = entry.error.as_deref().map(escaped).unwrap_or_default();
    let _ = write!(
        html,
        "<td class=\"name\">{name}<br><small>{}</small><p class=\"error\">{error}</p></td>\
         <td><span class=\"status\">{}</span></td><td data-value=\"{}\">{:.1}</td>",
        links.join(" "),
        entry.status.words(),
        entry.seconds,
        entry.seconds
    );
    html.extend(COLUMNS.iter().map(|column| cell(column, entry)));
    html + "</tr>\n"
}

/// Before → after; sorted by what it is after.
fn cell(column: &Column, entry: &Entry) -> String {
    let number = |numbers: &std::collections::BTreeMap<String, f64>| {
        numbers.get(column.key).map(|value| value * column.factor)
    };
    let (before, after) = (number(&entry.before), number(&entry.after));
    let words = |value: Option<f64>| {
        value.map_or_else(|| "–".to_owned(), |v| format!("{v:.*}", column.decimals))
    };
    let value = after.or(before).map(|v| v.to_string()).unwrap_or_default();
    if after.is_none() {
        return format!("<td data-value=\"{value}\">{}</td>", words(before));
    }
    let (before, after) = (words(before), words(after));
    format!("<td data-value=\"{value}\">{before} → <b>{after}</b></td>")
}

/// Text for HTML, in quotes or not.
fn escaped(text: &str) -> String {
    let mut html = text.replace('&', "&amp;");
    for (sign, name) in [('<', "&lt;"), ('>', "&gt;"), ('"', "&quot;"), ('\'', "&#39;")] {
        html = html.replace(sign, name);
    }
    html
}

/// A file name as an address: whatever is not plain is percent-encoded, and the dot in front keeps
/// a colon from making it a protocol.
fn address(file: &str) -> String {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-._~/".contains(&byte);
    let mut address = "./".to_owned();
    for byte in file.bytes() {
        if plain(byte) {
            address.push(char::from(byte));
        } else {
            // Writing to a string cannot fail.
            let _ = write!(address, "%{byte:02X}");
        }
    }
    address
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_addresses_are_text() {
        assert_eq!(escaped("<a & \"b'>"), "&lt;a &amp; &quot;b&#39;&gt;");
        assert_eq!(address("a b#ü.obj"), "./a%20b%23%C3%BC.obj");
    }
}
