//! The edits of a cleaned mesh as a script: step by step what the planner committed, and at the
//! end every vertex where the automation left it.

use crate::mesh::Point;
use crate::moves::{Dipole, Step};
use crate::ops::Op;
use crate::patch::{Crossing, Refill};
use crate::planner::edit::Edit;
use crate::planner::schedule::EditRecord;
use crate::sqrtcc::Ideal;
use serde::Serialize;
use std::fmt::Write;
use toml::ser::Error;

/// What is run again must be lifted as it was: so the head says.
const HEAD: &str = "\
# The edits of a run of quadmend, in the numbers of its √CC mesh. With the same input, reference
# and configuration, `quadmend edit INPUT --reference SCAN --script THIS -o OUTPUT` makes them again.
";

#[derive(Serialize)]
struct Steps<'a> {
    step: [Entry<'a>; 1],
}

/// A step as [`super::OPERATIONS`] reads it.
#[derive(Serialize)]
#[serde(tag = "do", rename_all = "kebab-case")]
enum Entry<'a> {
    Operations { ops: &'a [Op] },
    Walk { start: Dipole, steps: &'a [Step] },
    Refill(&'a Refill),
    Crossing(&'a Crossing),
    Ideals { ideals: &'a [Ideal] },
}

impl<'a> From<&'a Edit> for Entry<'a> {
    fn from(edit: &'a Edit) -> Self {
        match edit {
            Edit::Local { ops } | Edit::TypeChange { ops } => Self::Operations { ops },
            Edit::Walk { start, steps, .. } => Self::Walk { start: *start, steps },
            Edit::Refill(refill) => Self::Refill(refill),
            Edit::Crossing(crossing) => Self::Crossing(crossing),
            Edit::Ideals { ideals } => Self::Ideals { ideals },
        }
    }
}

/// The script that makes `edits` on the mesh that they were made on, and puts its vertices, in the
/// order of the mesh that is left, to `points`, to the bit.
pub fn log(edits: &[EditRecord], points: &[Point]) -> Result<String, Error> {
    let mut text = HEAD.to_owned();
    // Writing to a string cannot fail.
    for (number, record) in (1..).zip(edits) {
        let EditRecord { round, gain, place: [x, y, z], .. } = record;
        let at = format!("near ({x:.4}, {y:.4}, {z:.4})");
        let _ = writeln!(text, "\n# {number}: round {round}, {gain} elements fewer, {at}");
        text += &toml::to_string(&Steps { step: [(&record.edit).into()] })?;
    }
    text += "\n# Where smoothing left the vertices\n[[step]]\ndo = \"place\"\npoints = [\n";
    for point in points {
        // The shortest text that is read as the same number.
        let _ = writeln!(text, "  [{:?}, {:?}, {:?}],", point.x, point.y, point.z);
    }
    text += "]\n";
    Ok(text)
}
