//! The five basic operations (Peng & Wonka 2013, section 3.2).

use super::Operation;
use crate::moves::MoveRefusal;
use crate::moves::basic::{
    Made, edge_collapse, edge_deletion, edge_insertion, edge_shift, vertex_split,
};
use crate::script::address::{Address, EdgeAddress, Select};
use crate::script::error::Trouble;
use crate::script::run::Done;
use crate::script::session::Session;
use crate::sqrtcc::QuadMesh;
use crate::watch::Watch;
use serde::Deserialize;

/// Opens a vertex into an edge between two of its faces.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct VertexSplit {
    at: Address,
    from: Address,
    to: Address,
}

impl Operation for VertexSplit {
    fn run(&self, session: &mut Session, _: &dyn Watch) -> Result<Done, Trouble> {
        let v = self.at.one(session, Select::Vertices)?;
        let faces = [&self.from, &self.to].map(|face| face.one(session, Select::Faces));
        let [from, to] = faces;
        let faces = [from?, to?];
        made(session, "new: ", |mesh| vertex_split(mesh, v, faces)).map_err(|t| t.at(v))
    }
}

/// Cuts a face in two by an edge between two of its vertices.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct EdgeInsertion {
    at: Address,
    from: Address,
    to: Address,
}

impl Operation for EdgeInsertion {
    fn run(&self, session: &mut Session, _: &dyn Watch) -> Result<Done, Trouble> {
        let face = self.at.one(session, Select::Faces)?;
        let [from, to] = [&self.from, &self.to].map(|v| v.one(session, Select::Vertices));
        let ends = [from?, to?];
        made(session, "new: ", |mesh| edge_insertion(mesh, face, ends)).map_err(|t| t.at(face))
    }
}

/// Makes the ends of an edge one.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct EdgeCollapse {
    edge: EdgeAddress,
}

impl Operation for EdgeCollapse {
    fn run(&self, session: &mut Session, _: &dyn Watch) -> Result<Done, Trouble> {
        let ends = self.edge.find(session)?;
        made(session, "left: ", |mesh| edge_collapse(mesh, ends)).map_err(|t| t.at(ends[0]))
    }
}

/// Makes the two faces of an edge one.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct EdgeDeletion {
    edge: EdgeAddress,
}

impl Operation for EdgeDeletion {
    fn run(&self, session: &mut Session, _: &dyn Watch) -> Result<Done, Trouble> {
        let ends = self.edge.find(session)?;
        made(session, "left: ", |mesh| edge_deletion(mesh, ends)).map_err(|t| t.at(ends[0]))
    }
}

/// Ends an edge at the next vertex of one of its faces.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct EdgeShift {
    fixed: Address,
    from: Address,
    to: Address,
}

impl Operation for EdgeShift {
    fn run(&self, session: &mut Session, _: &dyn Watch) -> Result<Done, Trouble> {
        let fixed = self.fixed.one(session, Select::Vertices)?;
        let [from, to] = [&self.from, &self.to].map(|v| v.one(session, Select::Vertices));
        let ends = [from?, to?];
        made(session, "now at ", |mesh| edge_shift(mesh, fixed, ends)).map_err(|t| t.at(fixed))
    }
}

fn made(
    session: &mut Session,
    word: &str,
    act: impl FnOnce(&mut QuadMesh) -> Result<Made, MoveRefusal>,
) -> Result<Done, Trouble> {
    let Made { op, element } = act(session.mesh_mut())?;
    let words = format!("{word}{}", session.name(element));
    Ok(Done { words, results: vec![element], ops: vec![op], ..Done::default() })
}
