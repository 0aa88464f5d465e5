//! The mesh while a script works on it, and what its elements are called.

use super::error::{Reason, Trouble};
use crate::config::Config;
use crate::mesh::PolyMesh;
use crate::sqrtcc::{QuadMesh, Vertex};
use crate::surface::Reference;

/// A mesh that is edited by the steps of a script.
#[derive(Debug)]
pub struct Session<'a> {
    mesh: QuadMesh,
    /// Vertices and faces of the mesh that was read, and the number of its first face in Q.
    vertices: u32,
    faces: u32,
    first_face: u32,
    /// Whether its numbers are those of the file.
    numbers_hold: bool,
    results: Vec<Vec<Vertex>>,
    pub(super) keep_going: bool,
    /// Elements of the step that were refused while going on.
    pub(super) passed_over: Vec<Explained>,
    pub(super) group_names: &'a [String],
    pub(super) reference: &'a Reference,
    pub(super) config: &'a Config,
}

/// What a session works with besides the mesh.
#[derive(Debug, Clone, Copy)]
pub(super) struct Means<'a> {
    pub(super) reference: &'a Reference,
    pub(super) config: &'a Config,
    pub(super) keep_going: bool,
    pub(super) numbers_hold: bool,
}

impl<'a> Session<'a> {
    /// A session on `q`, just lifted from `mesh`.
    pub(super) fn new(q: QuadMesh, mesh: &'a PolyMesh, means: Means<'a>) -> Self {
        let first_face = (0..q.vertex_ids()).find(|&v| q.is_face(v)).unwrap_or(0);
        Self {
            mesh: q,
            vertices: mesh.vertex_count() as u32,
            faces: mesh.face_count() as u32,
            first_face,
            numbers_hold: means.numbers_hold,
            results: Vec::new(),
            keep_going: means.keep_going,
            passed_over: Vec::new(),
            group_names: mesh.group_names(),
            reference: means.reference,
            config: means.config,
        }
    }

    /// The mesh as it is now.
    #[must_use]
    pub fn mesh(&self) -> &QuadMesh {
        &self.mesh
    }

    /// The mesh, to be edited.
    pub(super) fn mesh_mut(&mut self) -> &mut QuadMesh {
        &mut self.mesh
    }

    pub(super) fn into_mesh(self) -> QuadMesh {
        self.mesh
    }

    /// The element with a number of the file.
    pub(super) fn numbered(&self, number: u32, face: bool) -> Result<Vertex, Trouble> {
        if !self.numbers_hold {
            return Err(Trouble::other(
                "the mesh had to be mended, so its numbers are not those of the file; write a \
                 mended mesh first, or use places",
            ));
        }
        let (word, count, base) =
            if face { ("face", self.faces, self.first_face) } else { ("vertex", self.vertices, 0) };
        if !(1..=count).contains(&number) {
            let words = format!("there is no {word} {number}; they are numbered 1 to {count}");
            return Err(Trouble::other(words));
        }
        let v = base + number - 1;
        if self.mesh.is_alive(v) {
            return Ok(v);
        }
        Err(Trouble::other(format!("{word} {number} is gone: an earlier step removed it")))
    }

    /// An element that an earlier step left, both counted from 1.
    pub(super) fn result(&self, step: usize, number: usize) -> Result<Vertex, Trouble> {
        let results = step.checked_sub(1).and_then(|i| self.results.get(i));
        let results = results
            .ok_or_else(|| Trouble::other(format!("step {step} has not been made before this")))?;
        let v = number.checked_sub(1).and_then(|i| results.get(i)).copied().ok_or_else(|| {
            Trouble::other(format!("step {step} left {} elements, not {number}", results.len()))
        })?;
        if v < self.mesh.vertex_ids() && self.mesh.is_alive(v) {
            return Ok(v);
        }
        Err(Trouble::other(format!("result {number} of step {step} is gone")))
    }

    pub(super) fn remember(&mut self, results: Vec<Vertex>) {
        self.results.push(results);
    }

    /// What people call an element: its number in the file, or that it is new and where.
    #[must_use]
    pub fn name(&self, v: Vertex) -> String {
        let known = self.numbers_hold;
        if known && v < self.vertices {
            return format!("vertex {}", v + 1);
        }
        if known && (self.first_face..self.first_face + self.faces).contains(&v) {
            return format!("face {}", v - self.first_face + 1);
        }
        if v >= self.mesh.vertex_ids() || !self.mesh.is_alive(v) {
            return "an element that is gone".to_owned();
        }
        let [x, y, z]: [f64; 3] = self.mesh.location(v).into();
        let word = if self.mesh.is_face(v) { "face" } else { "vertex" };
        format!("the {word} near ({x:.4}, {y:.4}, {z:.4})")
    }

    /// A trouble in the words of the mesh that was read: the element, if there is one, and the
    /// reason.
    pub(super) fn explain(&self, trouble: &Trouble) -> Explained {
        let reason = match &trouble.reason {
            Reason::Move(refusal) => refusal.words(&|v| self.name(v)),
            Reason::Other(words) => words.clone(),
        };
        Explained { element: trouble.at.map(|v| self.name(v)), reason }
    }
}

/// A trouble in words.
#[derive(Debug, Clone)]
pub(super) struct Explained {
    pub(super) element: Option<String>,
    pub(super) reason: String,
}
