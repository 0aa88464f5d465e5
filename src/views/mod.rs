//! A mesh as it looks in the other domains, for inspection in Blender or `MeshLab`.
//!
//! | view | vertices | faces |
//! |---|---|---|
//! | √CC | vertices p, faces d | a quad p, d, p′, d′ for each edge |
//! | dual | faces d | one for each vertex inside |
//! | Catmull-Clark | vertices p, faces d, edges e | a quad p, e, d, e′ for each corner |
//!
//! Places are those of the mesh and means of them: nothing is smoothed. At a boundary an edge of
//! the √CC mesh has a vertex in its middle where the face outside would be. [`primal`] is the way
//! back from √CC (Peng & Wonka 2013, section 3.1, Proposition 3.1).

mod primal;

pub use primal::{ViewError, primal};

use crate::mesh::{MeshError, NONE, Point, PolyMesh, Topology};

/// What a vertex of a view stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Label {
    /// A vertex of the mesh: p.
    Vertex,
    /// A face of the mesh: d.
    Face,
    /// An edge of the mesh.
    Edge,
    /// What would be the face on the far side of a boundary edge.
    Outside,
}

impl Label {
    /// Red, green and blue, 0 to 1.
    #[must_use]
    pub const fn colour(self) -> [f64; 3] {
        match self {
            Self::Vertex => [0.85, 0.15, 0.1],
            Self::Face => [0.1, 0.3, 0.9],
            Self::Edge => [0.1, 0.65, 0.25],
            Self::Outside => [0.6, 0.6, 0.6],
        }
    }
}

/// A mesh in another domain.
#[derive(Debug, Clone, PartialEq)]
pub struct View {
    /// The mesh.
    pub mesh: PolyMesh,
    /// What each vertex stands for.
    pub labels: Vec<Label>,
}

/// The √CC mesh: vertices first, then faces, then the middles of boundary edges; the quads are in
/// two groups, those of inner edges and those of the boundary.
///
/// *Precondition* of all views: `mesh` is clean (see [`crate::mesh::check`]). O(n log n).
pub fn sqrt_cc(mesh: &PolyMesh) -> Result<View, MeshError> {
    let topology = Topology::new(mesh);
    let (mut points, mut labels) = points_and_centres(mesh);
    let (mut quads, mut groups) = (Vec::new(), Vec::new());
    for &h in &topology.edges {
        let twin = topology.twin[h as usize];
        let [a, b] = ends(mesh, &topology, h);
        let right = if twin == NONE {
            points.push(nalgebra::center(&mesh.points()[a as usize], &mesh.points()[b as usize]));
            labels.push(Label::Outside);
            points.len() as u32 - 1
        } else {
            face_number(mesh, &topology, twin)
        };
        quads.push([a, right, b, face_number(mesh, &topology, h)]);
        groups.push(u32::from(twin == NONE));
    }
    let names = vec!["edges".to_owned(), "boundary".to_owned()];
    Ok(View { mesh: PolyMesh::new(points, quads)?.with_groups(groups, names), labels })
}

/// The dual: a vertex in the middle of each face, a face around each vertex that is not on the
/// boundary. Faces at no such vertex are left out. The dual of the dual of a closed mesh has its
/// connectivity again.
pub fn dual(mesh: &PolyMesh) -> Result<View, MeshError> {
    let topology = Topology::new(mesh);
    let rings =
        rings(&topology).map(|ring| ring.iter().map(|&c| topology.face[c as usize]).collect());
    let mut faces: Vec<(u32, Vec<u32>)> = topology.fan_vertex.iter().copied().zip(rings).collect();
    faces.retain(|(_, ring)| !ring.is_empty());
    faces.sort_by_key(|&(v, _)| v);
    let mut number = vec![NONE; mesh.face_count()];
    for &f in faces.iter().flat_map(|(_, ring)| ring) {
        number[f as usize] = 0;
    }
    let used: Vec<usize> = (0..mesh.face_count()).filter(|&f| number[f] == 0).collect();
    for (i, &f) in used.iter().enumerate() {
        number[f] = i as u32;
    }
    let points = used.iter().map(|&f| mesh.centre(f)).collect();
    let rows = faces
        .into_iter()
        .map(|(_, ring)| -> Vec<u32> { ring.into_iter().map(|f| number[f as usize]).collect() });
    Ok(View { mesh: PolyMesh::new(points, rows)?, labels: vec![Label::Face; used.len()] })
}

/// The connectivity after one step of Catmull-Clark subdivision: vertices, then faces, then
/// edges; the faces keep their groups.
pub fn catmull_clark(mesh: &PolyMesh) -> Result<View, MeshError> {
    let topology = Topology::new(mesh);
    let (mut points, mut labels) = points_and_centres(mesh);
    let mut middle = vec![NONE; mesh.corner_count()];
    for &h in &topology.edges {
        let [a, b] = ends(mesh, &topology, h).map(|v| mesh.points()[v as usize]);
        middle[h as usize] = points.len() as u32;
        if topology.twin[h as usize] != NONE {
            middle[topology.twin[h as usize] as usize] = points.len() as u32;
        }
        points.push(nalgebra::center(&a, &b));
        labels.push(Label::Edge);
    }
    let quad = |c: usize| {
        let before = middle[topology.prev[c] as usize];
        [mesh.corners()[c], middle[c], face_number(mesh, &topology, c as u32), before]
    };
    let quads = (0..mesh.corner_count()).map(quad);
    let groups = topology.face.iter().map(|&f| mesh.groups()[f as usize]).collect();
    let refined = PolyMesh::new(points, quads)?.with_groups(groups, mesh.group_names().to_vec());
    Ok(View { mesh: refined, labels })
}

fn points_and_centres(mesh: &PolyMesh) -> (Vec<Point>, Vec<Label>) {
    let centres = (0..mesh.face_count()).map(|f| mesh.centre(f));
    let points = mesh.points().iter().copied().chain(centres).collect();
    let mut labels = vec![Label::Vertex; mesh.vertex_count()];
    labels.resize(mesh.vertex_count() + mesh.face_count(), Label::Face);
    (points, labels)
}

fn ends(mesh: &PolyMesh, topology: &Topology, h: u32) -> [u32; 2] {
    [h, topology.next[h as usize]].map(|c| mesh.corners()[c as usize])
}

/// The vertex that stands for the face of a corner.
fn face_number(mesh: &PolyMesh, topology: &Topology, corner: u32) -> u32 {
    mesh.vertex_count() as u32 + topology.face[corner as usize]
}

/// The corners around each vertex, fan by fan, counter-clockwise; none for those on a boundary.
fn rings(topology: &Topology) -> impl Iterator<Item = Vec<u32>> + '_ {
    let mut first = vec![NONE; topology.fan_count()];
    for (c, &fan) in topology.fan.iter().enumerate().rev() {
        first[fan as usize] = c as u32;
    }
    first.into_iter().enumerate().map(|(fan, start)| {
        if topology.fan_on_boundary[fan] {
            return Vec::new();
        }
        let mut ring = vec![start];
        let turn = |c: u32| topology.twin[topology.prev[c as usize] as usize];
        let mut c = turn(start);
        while c != start && ring.len() < topology.fan_corners[fan] as usize {
            ring.push(c);
            c = turn(c);
        }
        ring
    })
}
