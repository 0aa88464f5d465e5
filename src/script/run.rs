//! Carrying out a script.

use super::address::Select;
use super::error::{ScriptError, StepError, Trouble};
use super::session::{Explained, Means, Session};
use super::{Script, Step};
use crate::config::Config;
use crate::mesh::{MendPolicy, PolyMesh, check, mend_connected};
use crate::ops::Op;
use crate::patch::Refill;
use crate::pipeline::{CleanError, lift_held};
use crate::sqrtcc::{Vertex, lower};
use crate::surface::Reference;
use crate::watch::{Phase, Watch};
use serde::Serialize;

/// What an operation did.
#[derive(Debug, Clone, Default)]
pub struct Done {
    /// What came of it, in words.
    pub words: String,
    /// The elements that it left (numbers of Q), for later steps to refer to.
    pub results: Vec<Vertex>,
    /// The operations on Q that it was made of.
    pub ops: Vec<Op>,
    /// The refills that it was made of.
    pub refills: Vec<Refill>,
}

/// A step that was carried out, for the log.
#[derive(Debug, Clone, Serialize)]
pub struct StepRecord {
    /// The step, from 1.
    pub step: usize,
    /// What it did.
    #[serde(rename = "do")]
    pub operation: &'static str,
    /// What came of it, in words.
    pub done: String,
    /// Irregularity E before.
    pub before: u64,
    /// Irregularity E after.
    pub after: u64,
    /// The operations on the √CC mesh, which can be steps of a script themselves.
    pub ops: Vec<Op>,
    /// The refills, which can be steps, too.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub refills: Vec<Refill>,
}

/// A mesh after a script.
#[derive(Debug, Clone)]
pub struct Edited {
    /// The mesh: clean, as after [`crate::pipeline::clean`].
    pub mesh: PolyMesh,
    /// The steps that were carried out.
    pub steps: Vec<StepRecord>,
    /// What was refused, if the script kept going.
    pub refused: Vec<StepError>,
}

/// Carries out a script on `mesh`, which may be any soup, on the surface of `reference` (its own
/// if there is none). Boundaries and sharp features stay as they are.
///
/// All or nothing: the first step that is refused is the error, unless `keep_going`, which passes
/// over what is refused (a step, or an element of a selection) and says so.
pub fn edit(
    mesh: PolyMesh,
    reference: Option<&PolyMesh>,
    policy: MendPolicy,
    script: &Script,
    (config, keep_going): (&Config, bool),
    watch: &dyn Watch,
) -> Result<Edited, ScriptError> {
    let (mesh, topology, mends) = mend_connected(mesh, policy)?;
    watch.progress(Phase::Reference, 0, 1, None);
    let own = || Reference::connected(&mesh, &topology);
    let surface = reference.map_or_else(own, Reference::new)?;
    let (q, _) = lift_held(&mesh, &topology, &surface, &config.features)?;
    let means =
        Means { reference: &surface, config, keep_going, numbers_hold: mends.mends.is_empty() };
    let mut session = Session::new(q, &mesh, means);
    let (mut steps, mut refused) = (Vec::new(), Vec::new());
    let mut irregularity = session.mesh().total_irregularity();
    for (i, step) in script.steps.iter().enumerate() {
        watch.progress(Phase::Edit, i, script.len(), None);
        match carry_out(&mut session, step, (i + 1, irregularity), watch) {
            Ok(record) => {
                irregularity = record.after;
                steps.push(record);
            }
            Err(error) if keep_going => {
                session.remember(Vec::new());
                refused.push(error);
            }
            Err(error) => return Err(error.into()),
        }
        for trouble in std::mem::take(&mut session.passed_over) {
            refused.push(step.refused(i + 1, trouble));
        }
    }
    let names = session.group_names;
    let result = lower(&session.into_mesh(), names)?.mesh;
    check(&result).map_err(CleanError::Flawed)?;
    Ok(Edited { mesh: result, steps, refused })
}

/// One step, whole or not at all; `before` is E before it.
fn carry_out(
    session: &mut Session,
    step: &Step,
    (number, before): (usize, u64),
    watch: &dyn Watch,
) -> Result<StepRecord, StepError> {
    let mark = session.mesh().mark();
    match step.operation.run(session, watch) {
        Ok(done) => {
            session.remember(done.results);
            let after = session.mesh().total_irregularity();
            Ok(StepRecord {
                step: number,
                operation: step.name,
                done: done.words,
                before,
                after,
                ops: done.ops,
                refills: done.refills,
            })
        }
        Err(trouble) => {
            // Named as it is now: what the step itself made is gone after the next line.
            let explained = session.explain(&trouble);
            session.mesh_mut().undo_to(mark);
            Err(step.refused(number, explained))
        }
    }
}

impl Step {
    fn refused(&self, number: usize, Explained { element, reason }: Explained) -> StepError {
        StepError { number, operation: self.name, line: self.line, element, reason }
    }
}

impl Session<'_> {
    /// Does the same to each of the elements; passes over the ones that are refused if the script
    /// keeps going. Of several, one that is no longer what the step is about was part of what was
    /// done to one before it.
    pub(super) fn each(
        &mut self,
        elements: &[Vertex],
        about: Select,
        mut act: impl FnMut(&mut Self, Vertex) -> Result<Done, Trouble>,
    ) -> Result<Done, Trouble> {
        if elements.is_empty() {
            return Err(Trouble::other("the selection is empty"));
        }
        let mut sum = Done::default();
        let mut made = 0;
        for &v in elements {
            if elements.len() > 1 && !about.takes(self.mesh(), v) {
                continue;
            }
            match act(self, v) {
                Ok(done) => {
                    made += 1;
                    sum.words = done.words;
                    sum.results.extend(done.results);
                    sum.ops.extend(done.ops);
                    sum.refills.extend(done.refills);
                }
                Err(trouble) if self.keep_going && elements.len() > 1 => {
                    let explained = self.explain(&trouble.at(v));
                    self.passed_over.push(explained);
                }
                Err(trouble) => return Err(trouble.at(v)),
            }
        }
        if elements.len() > 1 {
            sum.words = format!("{made} of {} elements", elements.len());
        }
        Ok(sum)
    }
}
