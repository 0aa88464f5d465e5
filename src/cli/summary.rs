//! What a run did, in words.

use quadmend::metrics;
use quadmend::moves::pure::Conversion;
use quadmend::pipeline::Report;
use quadmend::planner::edit::Edit;
use quadmend::planner::schedule::EditRecord;

use super::Exit;

/// Mends and edits, a line each.
pub(super) fn work(report: &Report) -> String {
    let mends = report.mends.mends.iter().map(|m| format!("mended: {}", m.sentence));
    let mut lines: Vec<String> = mends.collect();
    let kinds = kinds(&report.edits);
    let [local, walks, refills, types, crossings] = kinds;
    lines.push(match kinds.iter().sum() {
        0 => "no edit found that improves the mesh".to_owned(),
        n => format!(
            "edits made: {n} (local reductions {local}, walks {walks}, refilled patches {refills}, \
             crossings of features {crossings}, type changes {types})"
        ),
    });
    lines.extend(report.conversion.iter().flat_map(not_quads));
    if report.stopped {
        lines.push("stopped before it was done: this is the best mesh so far".to_owned());
    }
    lines.join("\n") + "\n"
}

/// Which faces could not be made quads, and why.
pub(super) fn not_quads(conversion: &Conversion) -> Vec<String> {
    let known = conversion.obstructions.iter();
    let mut lines: Vec<String> = known.map(|o| format!("not a quad: {o}")).collect();
    let others = conversion.left.len().saturating_sub(conversion.obstructions.len());
    if others > 0 {
        lines.push(format!("not a quad: {others} faces for which no way was found"));
    }
    lines
}

/// How many edits of each kind there are.
fn kinds(edits: &[EditRecord]) -> [usize; 5] {
    let mut counts = [0; 5];
    for kind in edits.iter().filter_map(|record| kind(&record.edit)) {
        counts[kind] += 1;
    }
    counts
}

fn kind(edit: &Edit) -> Option<usize> {
    match edit {
        Edit::Local { .. } => Some(0),
        Edit::Walk { .. } => Some(1),
        Edit::Refill(_) => Some(2),
        Edit::TypeChange { .. } => Some(3),
        Edit::Crossing(_) => Some(4),
        Edit::Ideals { .. } => None,
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

/// Nothing to improve means that nothing was: neither a mend nor an edit. Quads that were asked for
/// and could not be had are a limit missed.
pub(super) fn exit(report: &Report) -> Exit {
    if report.conversion.as_ref().is_some_and(|c| !c.left.is_empty()) {
        return Exit::LimitMissed;
    }
    let idle = report.edits.is_empty() && report.mends.mends.is_empty();
    if idle { Exit::NothingToImprove } else { Exit::Done }
}
