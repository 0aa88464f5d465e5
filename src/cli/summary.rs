//! What a run did, in words.

use quadmend::metrics;
use quadmend::pipeline::Report;
use quadmend::planner::edit::Edit;
use quadmend::planner::schedule::EditRecord;

use super::Exit;

/// Mends and edits, a line each.
pub(super) fn work(report: &Report) -> String {
    let mends = report.mends.mends.iter().map(|m| format!("mended: {}", m.sentence));
    let mut lines: Vec<String> = mends.collect();
    let [local, walks, refills, types] = kinds(&report.edits);
    lines.push(match report.edits.len() {
        0 => "no edit found that improves the mesh".to_owned(),
        n => format!(
            "edits made: {n} (local reductions {local}, walks {walks}, refilled patches {refills}, \
             type changes {types})"
        ),
    });
    if report.stopped {
        lines.push("stopped before it was done: this is the best mesh so far".to_owned());
    }
    lines.join("\n") + "\n"
}

/// How many edits of each kind there are.
fn kinds(edits: &[EditRecord]) -> [usize; 4] {
    let mut counts = [0; 4];
    for record in edits {
        counts[kind(&record.edit)] += 1;
    }
    counts
}

fn kind(edit: &Edit) -> usize {
    match edit {
        Edit::Local { .. } => 0,
        Edit::Walk { .. } => 1,
        Edit::Refill(_) => 2,
        Edit::TypeChange { .. } => 3,
    }
}

/// The metrics before beside those after.
pub(super) fn table(report: &Report) -> String {
    metrics::table(&[("before", &report.before), ("after", &report.after)])
}

/// Work and metrics: the report for people.
pub(super) fn text(report: &Report) -> String {
    format!("{}\n{}", work(report), table(report))
}

/// Nothing to improve means that nothing was: neither a mend nor an edit.
pub(super) fn exit(report: &Report) -> Exit {
    let idle = report.edits.is_empty() && report.mends.mends.is_empty();
    if idle { Exit::NothingToImprove } else { Exit::Done }
}
