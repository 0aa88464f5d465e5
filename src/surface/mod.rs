//! The reference surface: triangles that say where the shape is.
//!
//! [`Reference`] answers closest-point queries, gives samples for distances and holds the creases
//! from which [`SharpLines`] are made. A reference may itself be a polygon mesh; it is
//! triangulated, while its creases are judged between polygons, so that the fold of a warped quad
//! is no feature.

mod features;
mod reference;
mod samples;
mod segments;
mod tree;
#[cfg(test)]
pub(crate) mod trial;
mod triangulation;

pub(crate) use features::area_vectors;
pub use features::{
    Crease, FeatureOptions, SharpLines, mean_edge, mesh_features, vertices_on_lines,
};
pub use reference::{Hit, Reference, SurfaceError};
pub(crate) use samples::spread;
pub use samples::{Deviation, deviation};
pub(crate) use segments::Segments;
pub use triangulation::{Triangulation, triangulate};

/// Squared distance from a point to a triangle, in squared units of the file. O(1).
#[must_use]
pub fn squared_distance(query: &crate::mesh::Point, triangle: &[crate::mesh::Point; 3]) -> f64 {
    (tree::closest_on_triangle(query, triangle) - query).norm_squared()
}
