//! The three operations on Q by its numbers: what logs consist of.

use super::Operation;
use crate::ops::{Collapse, Flip, Op, Split};
use crate::script::error::Trouble;
use crate::script::run::Done;
use crate::script::session::Session;
use crate::watch::Watch;
use serde::Deserialize;

/// One operation of the √CC mesh as it is logged.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(transparent)]
pub(super) struct Raw<T>(T);

impl From<Raw<Flip>> for Op {
    fn from(raw: Raw<Flip>) -> Self {
        Self::Flip(raw.0)
    }
}

impl From<Raw<Collapse>> for Op {
    fn from(raw: Raw<Collapse>) -> Self {
        Self::Collapse(raw.0)
    }
}

impl From<Raw<Split>> for Op {
    fn from(raw: Raw<Split>) -> Self {
        Self::Split(raw.0)
    }
}

impl<T> Operation for Raw<T>
where
    Self: Into<Op> + Copy + std::fmt::Debug + Send + Sync,
{
    fn run(&self, session: &mut Session, _: &dyn Watch) -> Result<Done, Trouble> {
        let op: Op = (*self).into();
        op.run(session.mesh_mut())?;
        Ok(Done { words: "done".to_owned(), results: Vec::new(), ops: vec![op] })
    }
}
