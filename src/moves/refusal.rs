//! Why a move is refused. Every refusal leaves the mesh as it was, bit for bit.

use super::element::Kind;
use crate::ops::Refusal;
use crate::sqrtcc::Vertex;
use std::fmt;

/// Why a move is refused. Elements are named by their number in Q.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MoveRefusal {
    /// One of the operations that the move is made of is not legal there.
    Operation(Refusal),
    /// The element does not exist, or no longer.
    Gone(Vertex),
    /// A face where a vertex is needed.
    NotAVertex(Vertex),
    /// A vertex where a face is needed.
    NotAFace(Vertex),
    /// The element is regular, or its index is not the one that is needed.
    NotIrregular(Vertex),
    /// The element lies on a boundary or feature.
    Held(Vertex),
    /// The two elements of a pair are one, or two pairs share one.
    SameElement,
    /// No dislocation stands there.
    NotADislocation,
    /// No T-junction stands there.
    NotATJunction,
    /// The two elements are not joined as the operation needs it.
    NotJoined(Vertex, Vertex),
    /// The direction does not apply to the signs of the pair.
    Direction,
    /// Elements of different types cannot be merged.
    DifferentTypes(Kind, Kind),
    /// Elements of opposite index cannot be merged.
    OppositeIndices(Kind, Kind),
    /// Merging would leave an element of two edges.
    TooFewEdges(Kind),
    /// No path of regular elements joins the two.
    NoPath(Vertex, Vertex),
    /// The path that was given meets itself, or an element that is not regular.
    BrokenPath(Vertex),
    /// Irregular elements beside the path, or a boundary, would be changed, too.
    InTheWay,
    /// The two do not cancel into what is wanted.
    NoCancellation,
}

impl MoveRefusal {
    /// The reason in words, with `name` to name elements.
    #[must_use]
    pub fn words(&self, name: &dyn Fn(Vertex) -> String) -> String {
        match *self {
            Self::Operation(refusal) => refusal.to_string(),
            Self::Gone(v) => format!("{} does not exist (any more)", name(v)),
            Self::NotAVertex(v) => format!("{} is a face; a vertex is needed", name(v)),
            Self::NotAFace(v) => format!("{} is a vertex; a face is needed", name(v)),
            Self::NotIrregular(v) => {
                format!("{} has not the valence or degree that the move is about", name(v))
            }
            Self::Held(v) => format!("{} is held by a boundary or feature", name(v)),
            Self::SameElement => "the elements must be different ones".to_owned(),
            Self::NotADislocation => {
                "no adjacent pair of one edge too few and one too many stands there".to_owned()
            }
            Self::NotATJunction => {
                "no T-junction stands there: a vertex of valence 3 at a face of degree 5".to_owned()
            }
            Self::NotJoined(a, b) => {
                format!("{} and {} are not joined as the operation needs it", name(a), name(b))
            }
            Self::Direction => "elements of opposite index translate together (climb, sink), \
                                those of equal index move closer or apart or rotate \
                                (Proposition 3.4)"
                .to_owned(),
            Self::DifferentTypes(a, b) => {
                format!("{a} and {b} cannot be merged: only the same type can (Proposition 3.5)")
            }
            Self::OppositeIndices(a, b) => {
                format!("{a} and {b} cannot be merged: only the same index can (Proposition 3.5)")
            }
            Self::TooFewEdges(kind) => {
                format!("two {kind} would merge into an element of two edges, which is none")
            }
            Self::NoPath(a, b) => {
                format!("no path of regular elements leads from {} to {}", name(a), name(b))
            }
            Self::BrokenPath(v) => format!(
                "the path breaks at {}: it must lead through regular elements, each once",
                name(v)
            ),
            Self::InTheWay => {
                "a boundary or other irregular elements are too near, and would change".to_owned()
            }
            Self::NoCancellation => "they do not cancel into what is wanted".to_owned(),
        }
    }
}

impl fmt::Display for MoveRefusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.words(&|v| format!("element {v}")))
    }
}

impl std::error::Error for MoveRefusal {}

impl From<Refusal> for MoveRefusal {
    fn from(refusal: Refusal) -> Self {
        Self::Operation(refusal)
    }
}
