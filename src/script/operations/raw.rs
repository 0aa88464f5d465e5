//! Steps by the numbers of Q, as logs consist of them: nothing is searched for.

use super::Operation;
use crate::mesh::Point;
use crate::ops::{Collapse, Flip, Op, Refusal, Split};
use crate::patch::{self, Misfit};
use crate::script::error::Trouble;
use crate::script::run::Done;
use crate::script::session::Session;
use crate::sqrtcc::{Ideal, QuadMesh, Vertex};
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
        Ok(Done { words: "done".to_owned(), results: Vec::new(), ops: vec![op], ..Done::default() })
    }
}

/// Several operations that belong together.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Operations {
    ops: Vec<Op>,
}

impl Operation for Operations {
    fn run(&self, session: &mut Session, _: &dyn Watch) -> Result<Done, Trouble> {
        for op in &self.ops {
            op.run(session.mesh_mut())?;
        }
        Ok(Done { words: "done".to_owned(), ops: self.ops.clone(), ..Done::default() })
    }
}

/// A patch with what takes its place.
#[derive(Debug, Clone, Deserialize)]
#[serde(transparent)]
pub(super) struct Refill(patch::Refill);

impl Operation for Refill {
    fn run(&self, session: &mut Session, _: &dyn Watch) -> Result<Done, Trouble> {
        refilled(session.mesh_mut(), |mesh| {
            let fitted = self.0.fitted(mesh)?;
            fitted.run(mesh)?;
            Ok(vec![fitted])
        })
    }
}

/// Features resampled, and the patches beside them with what takes their place.
#[derive(Debug, Clone, Deserialize)]
#[serde(transparent)]
pub(super) struct Crossing(patch::Crossing);

impl Operation for Crossing {
    fn run(&self, session: &mut Session, _: &dyn Watch) -> Result<Done, Trouble> {
        refilled(session.mesh_mut(), |mesh| self.0.replay(mesh))
    }
}

/// Makes refills, and checks all that they touched.
fn refilled(
    mesh: &mut QuadMesh,
    make: impl FnOnce(&mut QuadMesh) -> Result<Vec<patch::Refill>, Misfit>,
) -> Result<Done, Trouble> {
    let mark = mesh.mark();
    let refills = make(mesh).map_err(|misfit| Trouble::other(misfit.to_string()))?;
    for v in mesh.touched_since(mark).into_iter().filter(|&v| mesh.is_alive(v)) {
        mesh.check_vertex(v).map_err(|violation| Trouble::other(violation.to_string()))?;
    }
    let before: usize = refills.iter().map(|r| r.faces.len()).sum();
    let after: usize = refills.iter().map(|r| r.filling.face_count()).sum();
    let words = format!("{before} faces become {after}");
    Ok(Done { words, refills, ..Done::default() })
}

/// What sectors at features want.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Ideals {
    ideals: Vec<Ideal>,
}

impl Operation for Ideals {
    fn run(&self, session: &mut Session, _: &dyn Watch) -> Result<Done, Trouble> {
        if !session.mesh_mut().note_ideals(&self.ideals) {
            return Err(Refusal::Gone.into());
        }
        Ok(Done { words: format!("{} sectors", self.ideals.len()), ..Done::default() })
    }
}

/// Puts every vertex where it is said to be.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Place {
    /// A point for each vertex, in the order of the file that is written.
    points: Vec<[f64; 3]>,
}

impl Operation for Place {
    fn run(&self, session: &mut Session, _: &dyn Watch) -> Result<Done, Trouble> {
        let mesh = session.mesh_mut();
        let vertices: Vec<Vertex> = mesh.vertices().filter(|&v| !mesh.is_face(v)).collect();
        let (given, needed) = (self.points.len(), vertices.len());
        if given != needed {
            let words = format!("the mesh has {needed} vertices now, and there are {given} points");
            return Err(Trouble::other(words));
        }
        if let Some(i) = self.points.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
            return Err(Trouble::other(format!("point {} is not finite", i + 1)));
        }
        for (v, &point) in vertices.into_iter().zip(&self.points) {
            mesh.set_position(v, Point::from(point));
        }
        Ok(Done { words: format!("{given} vertices"), ..Done::default() })
    }
}
