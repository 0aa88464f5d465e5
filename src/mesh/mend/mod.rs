//! Makes a mesh fit to be edited: mends what can be mended without a doubt, and counts it.
//!
//! Remeshers leave doublets, valence-1 vertices, bow-ties, edges with three faces, cracks, torn holes
//! and mixed orientation. The surface is cut where it is no manifold, exactly as [`Topology`] sees
//! it, and what was manifold keeps its Euler characteristic, components and boundary loops.
//!
//! Where two faces meet along a cut edge and are also connected around both its ends, the cut
//! closes again: the edge then has just these two faces.
//!
//! *Invariant:* what comes out passes [`check`]; a mesh that cannot be brought there is an error.
//!
//! [`Topology`]: super::Topology

mod cracks;
mod cut;
mod doublets;
mod faces;
mod orient;

use serde::Serialize;
use std::cell::OnceCell;
use thiserror::Error;

use super::{Flaw, MeshError, Point, PolyMesh, Topology, check_connected};

/// One round mends everything that is known to occur; the others are for what is not.
const ROUNDS: usize = 4;
/// How many elements are named for each kind of mend.
const EXAMPLES: usize = 5;

/// What to do about a mesh that is not clean.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum MendPolicy {
    /// Mend it.
    #[default]
    Mend,
    /// Refuse it.
    Strict,
}

/// A kind of mend, in the order in which they are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum MendKind {
    /// A vertex that no face uses: dropped.
    UnusedVertex,
    /// A corner equal to the one before it: dropped.
    RepeatedCorner,
    /// A corner that a face runs to and back from (`u v u`): cut off.
    Spur,
    /// A face without three corners, or with a vertex twice after the mends above: dropped.
    DegenerateFace,
    /// A face with the vertices of an earlier one: dropped.
    DuplicateFace,
    /// A vertex that hangs on the edge of a face which does not have it: welded into the face.
    Crack,
    /// An edge with three or more faces: cut.
    NonManifoldEdge,
    /// A vertex where parts of the surface only touch: one copy for each part.
    BowTie,
    /// A face oriented against most of its component: turned over.
    FlippedFace,
    /// An interior vertex of valence 2: removed, its two faces merged.
    DoubletMerged,
    /// An interior vertex of valence 2 whose faces cannot be merged: replaced by an edge.
    DoubletDissolved,
    /// An interior vertex of valence 2 that has to stay: given a third edge.
    DoubletBraced,
}

impl MendKind {
    /// What was found and done, for one and for many, and the kind of element that is named.
    fn words(self) -> (&'static str, &'static str, &'static str) {
        match self {
            Self::UnusedVertex => ("unused vertex dropped", "unused vertices dropped", "vertex"),
            Self::RepeatedCorner => ("repeated corner dropped", "repeated corners dropped", "face"),
            Self::Spur => ("spur cut off", "spurs cut off", "face"),
            Self::DegenerateFace => ("degenerate face dropped", "degenerate faces dropped", "face"),
            Self::DuplicateFace => ("duplicate face dropped", "duplicate faces dropped", "face"),
            Self::Crack => (
                "crack closed: vertex welded into the face beside it",
                "cracks closed: vertices welded into the faces beside them",
                "vertex",
            ),
            Self::NonManifoldEdge => (
                "edge with more than two faces cut",
                "edges with more than two faces cut",
                "vertex",
            ),
            Self::BowTie => ("bow-tie vertex split", "bow-tie vertices split", "vertex"),
            Self::FlippedFace => ("face turned over", "faces turned over", "face"),
            Self::DoubletMerged => ("doublet merged away", "doublets merged away", "vertex"),
            Self::DoubletDissolved => {
                ("doublet replaced by an edge", "doublets replaced by edges", "vertex")
            }
            Self::DoubletBraced => {
                ("doublet given a third edge", "doublets given a third edge", "vertex")
            }
        }
    }

    /// What is wrong with an element that needs this mend.
    fn complaint(self) -> &'static str {
        match self {
            Self::UnusedVertex => "belongs to no face",
            Self::RepeatedCorner => "has the same corner twice in a row",
            Self::Spur => "runs along an edge and back",
            Self::DegenerateFace => "does not have three corners, or uses a vertex twice",
            Self::DuplicateFace => "has the vertices of an earlier face",
            Self::Crack => "hangs on the edge of a face that does not have it (a crack)",
            Self::NonManifoldEdge => "is on an edge with more than two faces",
            Self::BowTie => "joins parts of the surface that share no edge there",
            Self::FlippedFace => "is oriented against its neighbours",
            Self::DoubletMerged | Self::DoubletDissolved | Self::DoubletBraced => {
                "is inside the surface and has only two edges"
            }
        }
    }
}

/// All mends of one kind.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Mend {
    /// What was mended.
    pub kind: MendKind,
    /// How often.
    pub count: usize,
    /// The first few elements: numbers of vertices or faces in the input, from 0.
    pub examples: Vec<u32>,
    /// All that in words.
    pub sentence: String,
}

impl Mend {
    fn describe(&mut self) {
        let (one, many, element) = self.kind.words();
        let words = if self.count == 1 { one } else { many };
        let named: Vec<String> = self.examples.iter().map(ToString::to_string).collect();
        let more = if self.count > self.examples.len() { ", …" } else { "" };
        let named = named.join(", ");
        self.sentence = format!("{} {words} ({element} {named}{more}, from 0)", self.count);
    }
}

/// What was mended, and where the vertices come from.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize)]
pub struct MendReport {
    /// The mends, by kind; empty if the mesh was clean.
    pub mends: Vec<Mend>,
    /// The input vertex behind each output vertex; ascending.
    #[serde(skip)]
    pub sources: Vec<u32>,
    /// The input face behind each output face (of merged faces, the first).
    #[serde(skip)]
    pub face_sources: Vec<u32>,
}

impl MendReport {
    /// How many mends of a kind were made.
    #[must_use]
    pub fn count(&self, kind: MendKind) -> usize {
        self.mends.iter().find(|m| m.kind == kind).map_or(0, |m| m.count)
    }
}

/// Why a mesh was not mended. Elements are those of the input, from 0.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum MendError {
    /// The policy is strict and there is something to mend.
    #[error("{element} {number} (from 0) {complaint}; correct it, or let it be mended")]
    Refused {
        /// The mend that would be made.
        kind: MendKind,
        /// "vertex" or "face".
        element: &'static str,
        /// Its number.
        number: u32,
        /// What is wrong with it.
        complaint: &'static str,
    },
    /// A surface like a Möbius band.
    #[error(
        "the component of face {face} (from 0) cannot be oriented: it is one-sided like a Möbius \
         band; cut it open or remove it"
    )]
    NonOrientable {
        /// A face of the component.
        face: u32,
    },
    /// No face survived.
    #[error("no face of three distinct corners; give a surface mesh")]
    NothingLeft,
    /// Mending did not come to an end.
    #[error("mending left a flaw ({0}); simplify the mesh there")]
    Stuck(Flaw),
    /// Cutting made the mesh too large.
    #[error(transparent)]
    Mesh(#[from] MeshError),
}

/// Mends `mesh`, or under [`MendPolicy::Strict`] refuses it if there is anything to mend.
///
/// Vertices and faces keep their order, faces their groups. O(n log n) for n corners.
pub fn mend(mesh: PolyMesh, policy: MendPolicy) -> Result<(PolyMesh, MendReport), MendError> {
    let (mesh, _, report) = mend_connected(mesh, policy)?;
    Ok((mesh, report))
}

/// [`mend`]; also the connectivity of what comes out.
pub(crate) fn mend_connected(
    mesh: PolyMesh,
    policy: MendPolicy,
) -> Result<(PolyMesh, Topology, MendReport), MendError> {
    let mut log = Log { policy, mends: Vec::new() };
    let (groups, names) = (mesh.groups().to_vec(), mesh.group_names().to_vec());
    let mut draft = Draft::new(mesh);
    draft.note_unused(&mut log)?;
    let mut checked = draft.check();
    for _ in 0..ROUNDS {
        if checked.is_ok() && draft.cracks().is_empty() {
            break;
        }
        draft.mend_once(&mut log)?;
        checked = draft.check();
    }
    checked.map_err(MendError::Stuck)?;
    let Draft { mesh, topology, sources, faces } = draft;
    let topology = topology.into_inner().unwrap_or_else(|| Topology::new(&mesh));
    let groups = faces.iter().map(|&f| groups[f as usize]).collect();
    let report = MendReport { mends: log.finish(), sources, face_sources: faces };
    Ok((mesh.with_groups(groups, names), topology, report))
}

/// The mesh on its way, and where its elements come from.
#[derive(Debug)]
struct Draft {
    mesh: PolyMesh,
    /// That of the mesh as it is, once it has been asked for.
    topology: OnceCell<Topology>,
    /// Input vertex of each vertex.
    sources: Vec<u32>,
    /// Input face of each face.
    faces: Vec<u32>,
}

impl Draft {
    fn new(mesh: PolyMesh) -> Self {
        let sources = (0..mesh.vertex_count() as u32).collect();
        let faces = (0..mesh.face_count() as u32).collect();
        Self { mesh, topology: OnceCell::new(), sources, faces }
    }

    fn topology(&self) -> &Topology {
        self.topology.get_or_init(|| Topology::new(&self.mesh))
    }

    fn check(&self) -> Result<(), Flaw> {
        check_connected(&self.mesh, self.topology())
    }

    /// One pass over all kinds of mends; each stage counts on those before it.
    fn mend_once(&mut self, log: &mut Log) -> Result<(), MendError> {
        self.simplify_faces(log)?;
        self.drop_duplicates(log)?;
        if self.mesh.face_count() == 0 {
            return Err(MendError::NothingLeft);
        }
        self.weld_cracks(log)?;
        self.cut(log)?;
        self.orient(log)?;
        self.remove_doublets(log)?;
        self.drop_unused()
    }

    fn note_unused(&self, log: &mut Log) -> Result<(), MendError> {
        let used = self.used();
        let unused = (0_u32..).zip(&used).filter(|(_, u)| !**u);
        unused.map(|(v, _)| v).try_for_each(|v| log.note(MendKind::UnusedVertex, v))
    }

    fn used(&self) -> Vec<bool> {
        let mut used = vec![false; self.mesh.vertex_count()];
        self.mesh.corners().iter().for_each(|&v| used[v as usize] = true);
        used
    }

    /// Drops vertices without faces: those of the input and those that mends left behind.
    fn drop_unused(&mut self) -> Result<(), MendError> {
        let used = self.used();
        if used.iter().all(|&u| u) {
            return Ok(());
        }
        let kept: Vec<usize> = (0..used.len()).filter(|&v| used[v]).collect();
        let mut number = vec![super::NONE; used.len()];
        kept.iter().enumerate().for_each(|(new, &old)| number[old] = new as u32);
        let corners = self.mesh.corners().iter().map(|&v| number[v as usize]).collect();
        let points = kept.iter().map(|&v| self.mesh.points()[v]).collect();
        self.sources = kept.iter().map(|&v| self.sources[v]).collect();
        self.set_vertices(points, corners)
    }

    /// Puts the same faces on other vertices: theirs are `corners`, one after the other.
    fn set_vertices(&mut self, points: Vec<Point>, corners: Vec<u32>) -> Result<(), MendError> {
        self.topology.take();
        self.mesh = PolyMesh::from_rows(points, self.mesh.offsets().to_vec(), corners)?;
        Ok(())
    }

    /// Puts other faces on the same vertices.
    fn set_faces(&mut self, rows: Rows) -> Result<(), MendError> {
        self.topology.take();
        let points: Vec<Point> = self.mesh.points().to_vec();
        self.mesh = PolyMesh::from_rows(points, rows.offsets, rows.corners)?;
        self.faces = rows.sources;
        Ok(())
    }
}

/// Faces in compressed rows, with the input face of each.
#[derive(Debug)]
struct Rows {
    offsets: Vec<u32>,
    corners: Vec<u32>,
    sources: Vec<u32>,
}

impl Rows {
    fn new() -> Self {
        Self { offsets: vec![0], corners: Vec::new(), sources: Vec::new() }
    }

    fn push(&mut self, face: &[u32], source: u32) {
        self.corners.extend_from_slice(face);
        self.offsets.push(self.corners.len() as u32);
        self.sources.push(source);
    }
}

/// Counts mends, or refuses the first.
#[derive(Debug)]
struct Log {
    policy: MendPolicy,
    mends: Vec<Mend>,
}

impl Log {
    /// Records the mend of an input element.
    fn note(&mut self, kind: MendKind, number: u32) -> Result<(), MendError> {
        if self.policy == MendPolicy::Strict {
            let (element, complaint) = (kind.words().2, kind.complaint());
            return Err(MendError::Refused { kind, element, number, complaint });
        }
        let at = self.mends.iter().position(|m| m.kind == kind).unwrap_or_else(|| {
            let (examples, sentence) = (Vec::new(), String::new());
            self.mends.push(Mend { kind, count: 0, examples, sentence });
            self.mends.len() - 1
        });
        let mend = &mut self.mends[at];
        mend.count += 1;
        if mend.examples.len() < EXAMPLES {
            mend.examples.push(number);
        }
        Ok(())
    }

    fn finish(mut self) -> Vec<Mend> {
        self.mends.sort_by_key(|m| m.kind);
        self.mends.iter_mut().for_each(Mend::describe);
        self.mends
    }
}
