//! Why a move is refused. Every refusal leaves the mesh as it was, bit for bit.

use super::element::Kind;
use crate::ops::Refusal;
use crate::sqrtcc::Vertex;
use thiserror::Error;

/// Why a move is refused. Elements are named by their number in Q.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum MoveRefusal {
    /// One of the operations that the move is made of is not legal there.
    #[error("{0}")]
    Operation(#[from] Refusal),
    /// The element does not exist, or no longer.
    #[error("element {0} does not exist (any more)")]
    Gone(Vertex),
    /// A face where a vertex is needed.
    #[error("element {0} is a face; a vertex is needed")]
    NotAVertex(Vertex),
    /// A vertex where a face is needed.
    #[error("element {0} is a vertex; a face is needed")]
    NotAFace(Vertex),
    /// The element is regular, or its index is not ±1.
    #[error("element {0} is not of valence or degree 3 or 5")]
    NotIrregular(Vertex),
    /// The element lies on a boundary or feature.
    #[error("element {0} is held by a boundary or feature")]
    Held(Vertex),
    /// The two elements of a pair are one.
    #[error("a pair needs two different elements")]
    SameElement,
    /// No dislocation stands there.
    #[error("no adjacent pair of an element with an edge too few and one with an edge too many")]
    NotADislocation,
    /// No T-junction stands there.
    #[error("no T-junction: a vertex of valence 3 at a face of degree 5")]
    NotATJunction,
    /// The two elements are not joined as the operation needs it.
    #[error("elements {0} and {1} are not joined as the operation needs it")]
    NotJoined(Vertex, Vertex),
    /// The direction does not apply to the signs of the pair.
    #[error(
        "two elements of opposite index translate together (climb, sink, glide); two of equal \
         index move closer or apart or rotate (Proposition 3.4)"
    )]
    Direction,
    /// Elements of different types cannot be merged.
    #[error("a {0} and a {1} cannot be merged: only the same type can (Proposition 3.5)")]
    DifferentTypes(Kind, Kind),
    /// Elements of opposite index cannot be merged.
    #[error("a {0} and a {1} cannot be merged: only the same index can (Proposition 3.5)")]
    OppositeIndices(Kind, Kind),
    /// Merging would leave an element of two edges.
    #[error("two {0} would merge into an element of two edges, which is no vertex or face")]
    TooFewEdges(Kind),
    /// No path of regular elements joins the two.
    #[error("no path of regular elements leads from element {0} to element {1}")]
    NoPath(Vertex, Vertex),
    /// The path that was given does not lead there.
    #[error("the path breaks at element {0}: it must lead through regular elements")]
    BrokenPath(Vertex),
    /// Irregular elements beside the path would be changed, too.
    #[error("other irregular elements stand too near to the path")]
    InTheWay,
    /// The elements cannot cancel.
    #[error("they do not cancel: nothing would be left out")]
    NoCancellation,
}
