//! The manifest as comma-separated values (RFC 4180).

use super::Entry;
use crate::metrics::METRICS;

/// A row for each mesh: its name, status, seconds and error, and each metric before and after;
/// empty where there is no value.
#[must_use]
pub fn csv(entries: &[Entry]) -> String {
    let columns =
        METRICS.iter().flat_map(|m| ["before", "after"].map(|w| format!("{}_{w}", m.key)));
    let head = ["input", "output", "status", "seconds", "error"].map(str::to_owned);
    let mut text = head.into_iter().chain(columns).collect::<Vec<_>>().join(",") + "\n";
    for entry in entries {
        let cell = |value: Option<&f64>| value.map(f64::to_string).unwrap_or_default();
        let metrics = METRICS
            .iter()
            .flat_map(|m| [&entry.before, &entry.after].map(|numbers| cell(numbers.get(m.key))));
        let first = [
            quoted(&entry.input),
            quoted(entry.output.as_deref().unwrap_or_default()),
            entry.status.words().to_owned(),
            entry.seconds.to_string(),
            quoted(entry.error.as_deref().unwrap_or_default()),
        ];
        text += &(first.into_iter().chain(metrics).collect::<Vec<_>>().join(",") + "\n");
    }
    text
}

/// In quotes where commas, quotes or line breaks would be misread.
#[must_use]
pub fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}
