//! Irregular elements of index ±1: what the moves of the paper are about.
//!
//! ```text
//!  index +1   v3  three edges      f3  triangle
//!  index −1   v5  five edges       f5  pentagon
//! ```
//! In Q all four are the same kind of thing, a vertex of valence 3 or 5; the colour tells v from f.
//! Source: Peng & Wonka 2013, section 2.1.

use super::MoveRefusal;
use crate::sqrtcc::{QuadMesh, Vertex};
use serde::{Deserialize, Serialize};
use std::fmt;

/// The kind of an irregular element.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// A vertex of three edges.
    V3,
    /// A vertex of five edges.
    V5,
    /// A triangle.
    F3,
    /// A pentagon.
    F5,
}

impl Kind {
    /// 4 − valence, or 4 − degree.
    #[must_use]
    pub const fn index(self) -> i32 {
        match self {
            Self::V3 | Self::F3 => 1,
            Self::V5 | Self::F5 => -1,
        }
    }

    /// Whether it is a face.
    #[must_use]
    pub const fn is_face(self) -> bool {
        matches!(self, Self::F3 | Self::F5)
    }

    /// The kind of the same index and the other type: what an odd number of steps makes of it.
    #[must_use]
    pub const fn other_type(self) -> Self {
        match self {
            Self::V3 => Self::F3,
            Self::V5 => Self::F5,
            Self::F3 => Self::V3,
            Self::F5 => Self::V5,
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::V3 => "v3",
            Self::V5 => "v5",
            Self::F3 => "f3",
            Self::F5 => "f5",
        })
    }
}

/// An irregular element of index ±1 that lies on no boundary or feature.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Element {
    /// Its number in Q.
    pub at: Vertex,
    /// What it is.
    pub kind: Kind,
}

impl Element {
    /// The element at `v`; refused if there is none of index ±1, or if something holds it.
    pub fn at(mesh: &QuadMesh, v: Vertex) -> Result<Self, MoveRefusal> {
        if v >= mesh.vertex_ids() || !mesh.is_alive(v) || mesh.is_ghost(v) {
            return Err(MoveRefusal::Gone(v));
        }
        if mesh.is_on_line(v) {
            return Err(MoveRefusal::Held(v));
        }
        let kind = match (mesh.valence(v), mesh.is_face(v)) {
            (3, false) => Kind::V3,
            (5, false) => Kind::V5,
            (3, true) => Kind::F3,
            (5, true) => Kind::F5,
            _ => return Err(MoveRefusal::NotIrregular(v)),
        };
        Ok(Self { at: v, kind })
    }

    /// All of the mesh, in order of number.
    pub fn all(mesh: &QuadMesh) -> impl Iterator<Item = Self> + '_ {
        mesh.vertices().filter_map(|v| Self::at(mesh, v).ok())
    }
}
