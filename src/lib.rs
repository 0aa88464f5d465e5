//! **quadmend** cleans up the connectivity of quad-dominant meshes.
//!
//! A polygon mesh is lifted to the √CC domain, where every vertex, face and edge becomes a
//! p-vertex, a d-vertex and a quad; irregular vertices and faces are then the same kind of thing
//! and are moved in pairs until they cancel (Peng & Wonka, *Connectivity Editing for
//! Quad-Dominant Meshes*, 2013). Data flows one way:
//! read → mesh → lift → plan → edit → lower → smooth → measure → write.

pub mod batch;
pub mod config;
pub mod elements;
pub mod io;
pub mod knobs;
pub mod mesh;
pub mod metrics;
pub mod moves;
pub mod ops;
pub mod optimize;
pub mod patch;
pub mod pipeline;
pub mod planner;
pub mod render;
pub mod report;
pub mod script;
pub mod smooth;
pub mod sqrtcc;
pub mod surface;
pub mod tune;
pub mod views;
pub mod watch;

// The example of the README must compile and run.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
