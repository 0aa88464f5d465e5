//! What a step is about: elements by number, by place, by selection, or as a result of a step.
//!
//! Numbers are those of the mesh as it was read, from 1, as OBJ files count; an element keeps its
//! number as long as it exists. Elements that a script makes have no number; they are found by
//! place or as results.

use super::error::Trouble;
use super::session::Session;
use crate::mesh::Point;
use crate::moves::basic::edge_between;
use crate::moves::{Dipole, Element, Kind};
use crate::sqrtcc::{HalfEdge, QuadMesh, Vertex};
use serde::Deserialize;

/// A kind of elements.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Select {
    /// Any vertex of the polygon mesh.
    Vertices,
    /// Any face.
    Faces,
    /// Any vertex or face.
    Elements,
    /// v3, v5, f3 and f5 that nothing holds.
    Irregular,
    /// Vertices of three edges.
    V3,
    /// Vertices of five edges.
    V5,
    /// Triangles.
    F3,
    /// Pentagons.
    F5,
    /// Hanging vertices: v3 at an f5.
    TJunctions,
    /// Triangles at a v5: dual T-junctions.
    Duals,
    /// Both.
    Dislocations,
    /// Vertices and faces of six edges.
    Six,
}

impl Select {
    /// Whether `v` is one.
    #[must_use]
    pub fn takes(self, mesh: &QuadMesh, v: Vertex) -> bool {
        if v >= mesh.vertex_ids() || !mesh.is_alive(v) {
            return false;
        }
        let kind = |wanted| Element::at(mesh, v).is_ok_and(|element| element.kind == wanted);
        let free = !mesh.is_on_line(v);
        match self {
            Self::Vertices => !mesh.is_face(v),
            Self::Faces => mesh.is_face(v),
            Self::Elements => true,
            Self::Irregular => Element::at(mesh, v).is_ok(),
            Self::V3 => kind(Kind::V3),
            Self::V5 => kind(Kind::V5),
            Self::F3 => kind(Kind::F3),
            Self::F5 => kind(Kind::F5),
            Self::TJunctions => free && !mesh.is_face(v) && dislocation(mesh, v).is_some(),
            Self::Duals => free && mesh.is_face(v) && dislocation(mesh, v).is_some(),
            Self::Dislocations => free && dislocation(mesh, v).is_some(),
            Self::Six => free && mesh.valence(v) == 6,
        }
    }

    /// What it takes, in words.
    fn words(self) -> &'static str {
        match self {
            Self::Vertices => "vertex",
            Self::Faces => "face",
            Self::Elements => "element",
            Self::Irregular => "irregular element (v3, v5, f3, f5)",
            Self::V3 => "v3",
            Self::V5 => "v5",
            Self::F3 => "f3",
            Self::F5 => "f5",
            Self::TJunctions => "T-junction",
            Self::Duals => "dual T-junction",
            Self::Dislocations => "T-junction or dual one",
            Self::Six => "element of six edges",
        }
    }
}

/// The dislocation whose edge too few is at `v`.
pub(super) fn dislocation(mesh: &QuadMesh, v: Vertex) -> Option<Dipole> {
    let free = |d: &Dipole| !mesh.is_on_line(mesh.target(d.0));
    mesh.outgoing(v)
        .map(Dipole)
        .filter(|d| d.stands(mesh) && free(d))
        .min_by_key(|d| mesh.target(d.0))
}

/// Part of space.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(untagged, deny_unknown_fields)]
pub enum Within {
    /// A ball, in units of the file.
    Ball {
        /// Its centre.
        center: [f64; 3],
        /// Its radius.
        radius: f64,
    },
    /// An axis-parallel box, in units of the file.
    Box {
        /// Smallest coordinates.
        min: [f64; 3],
        /// Largest coordinates.
        max: [f64; 3],
    },
}

impl Within {
    fn holds(self, point: Point) -> bool {
        match self {
            Self::Ball { center, radius } => (point - Point::from(center)).norm() <= radius,
            Self::Box { min, max } => (0..3).all(|k| (min[k]..=max[k]).contains(&point[k])),
        }
    }
}

/// An address as it is written.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    vertex: Option<u32>,
    face: Option<u32>,
    nearest: Option<[f64; 3]>,
    all: Option<Select>,
    kind: Option<Select>,
    within: Option<Within>,
    step: Option<usize>,
    result: Option<usize>,
}

/// An address.
#[derive(Debug, Clone, Deserialize)]
#[serde(try_from = "Written")]
pub enum Address {
    /// `{ vertex = 12 }`: by number, from 1.
    Vertex(u32),
    /// `{ face = 7 }`: by number, from 1.
    Face(u32),
    /// `{ nearest = [x, y, z], kind = "v5" }`: the nearest of what the step is about, or of a kind.
    Nearest([f64; 3], Option<Select>),
    /// `{ all = "t-junctions", within = … }`: all of a kind, in a part of space or everywhere.
    All(Select, Option<Within>),
    /// `{ step = 2, result = 1 }`: what an earlier step left, by default the first such element.
    Result(usize, usize),
}

impl TryFrom<Written> for Address {
    type Error = &'static str;

    fn try_from(written: Written) -> Result<Self, Self::Error> {
        let Written { vertex, face, nearest, all, kind, within, step, result } = written;
        match (vertex, face, nearest, all, step) {
            _ if within.is_some() && all.is_none() => Err("`within` goes with `all`"),
            _ if kind.is_some() && nearest.is_none() => Err("`kind` goes with `nearest`"),
            _ if result.is_some() && step.is_none() => Err("`result` goes with `step`"),
            (Some(v), None, None, None, None) => Ok(Self::Vertex(v)),
            (None, Some(f), None, None, None) => Ok(Self::Face(f)),
            (None, None, Some(place), None, None) => Ok(Self::Nearest(place, kind)),
            (None, None, None, Some(select), None) => Ok(Self::All(select, within)),
            (None, None, None, None, Some(step)) => Ok(Self::Result(step, result.unwrap_or(1))),
            _ => Err("an address has exactly one of vertex, face, nearest, all, step"),
        }
    }
}

impl Address {
    /// The elements that are meant, in order of number; `seeks` is what the step is about.
    pub(super) fn find(&self, session: &Session, seeks: Select) -> Result<Vec<Vertex>, Trouble> {
        let mesh = session.mesh();
        match *self {
            Self::Vertex(number) => Ok(vec![session.numbered(number, false)?]),
            Self::Face(number) => Ok(vec![session.numbered(number, true)?]),
            Self::Nearest(place, kind) => {
                nearest(mesh, Point::from(place), kind.unwrap_or(seeks), &[]).map(|v| vec![v])
            }
            Self::All(select, within) => Ok(mesh
                .vertices()
                .filter(|&v| within.is_none_or(|part| part.holds(mesh.location(v))))
                .filter(|&v| select.takes(mesh, v))
                .collect()),
            Self::Result(step, number) => session.result(step, number).map(|v| vec![v]),
        }
    }

    /// The kind that all of are meant, if it is such an address.
    pub(super) fn selects(&self) -> Option<Select> {
        match *self {
            Self::All(select, _) => Some(select),
            _ => None,
        }
    }

    /// The one element that is meant.
    pub(super) fn one(&self, session: &Session, seeks: Select) -> Result<Vertex, Trouble> {
        match self.find(session, seeks)?[..] {
            [v] => Ok(v),
            ref many => {
                Err(Trouble::other(format!("one element is needed here, not {}", many.len())))
            }
        }
    }
}

/// The element nearest to a place that is none of `but`; the one with the smallest number of
/// several. O(size of the mesh).
pub(super) fn nearest(
    mesh: &QuadMesh,
    place: Point,
    select: Select,
    but: &[Vertex],
) -> Result<Vertex, Trouble> {
    let distance = |v: Vertex| (mesh.location(v) - place).norm_squared();
    let candidates = mesh.vertices().filter(|&v| select.takes(mesh, v) && !but.contains(&v));
    let best = candidates.map(|v| (distance(v), v)).min_by(|a, b| a.0.total_cmp(&b.0));
    best.map(|(_, v)| v)
        .ok_or_else(|| Trouble::other(format!("there is no {} in the mesh", select.words())))
}

/// The address of an edge.
#[derive(Debug, Clone, Deserialize)]
#[serde(untagged, deny_unknown_fields)]
pub enum EdgeAddress {
    /// `{ vertices = [3, 7] }`: by the numbers of its ends.
    Vertices {
        /// The numbers, from 1.
        vertices: [u32; 2],
    },
    /// `{ nearest = [x, y, z] }`: the one whose midpoint is nearest.
    Nearest {
        /// The place.
        nearest: [f64; 3],
    },
}

impl EdgeAddress {
    /// The ends of the edge.
    pub(super) fn find(&self, session: &Session) -> Result<[Vertex; 2], Trouble> {
        let mesh = session.mesh();
        let ends = |h: HalfEdge| [mesh.origin(h), mesh.origin(QuadMesh::opposite(h))];
        match *self {
            Self::Vertices { vertices: [a, b] } => {
                let edge = [session.numbered(a, false)?, session.numbered(b, false)?];
                edge_between(mesh, edge[0], edge[1])?;
                Ok(edge)
            }
            Self::Nearest { nearest } => {
                let middle =
                    |[a, b]: [Vertex; 2]| nalgebra::center(&mesh.position(a), &mesh.position(b));
                let distance = |e: &[Vertex; 2]| (middle(*e) - Point::from(nearest)).norm_squared();
                let edges = mesh.quads().map(|q| ends(4 * q));
                edges
                    .min_by(|a, b| distance(a).total_cmp(&distance(b)))
                    .ok_or_else(|| Trouble::other("there is no edge in the mesh"))
            }
        }
    }
}
