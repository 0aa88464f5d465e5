//! Finding crossings: what is irregular on one side of a sharp feature against what is irregular
//! on another, with the feature between them resampled.
//!
//! A dislocation ends at a feature, since nothing that is held changes there. With an edge more or
//! less in the line it passes; through a wall of quads it passes straight on to the next line.

use super::clusters::{Clusters, Limits, least_after};
use super::lines::{Line, beside};
use crate::ops::Resample;
use crate::patch::crossing::{Crossing, Shift};
use crate::patch::{Filling, Refill, Region, fillings};
use crate::sqrtcc::{HalfEdge, QuadKind, QuadMesh, Vertex};
use crate::surface::SharpLines;

/// Lines that are crossed at most, one behind the other.
const LINES: usize = 3;
/// Quads between two of them at most.
const WALL: usize = 12;
/// A side that does not even get rid of what the resampling brought is hardly ever worth it.
const LEAST_GAIN: u32 = 2;

/// What a search for crossings may take.
#[derive(Debug, Clone, Copy)]
pub struct Bounds {
    /// Feature edges near the seed that are tried.
    pub edges: usize,
    /// Most faces of all patches.
    pub faces: usize,
    /// Nearest irregular elements on a side that a patch may take in.
    pub partners: usize,
    /// How many crossings are given.
    pub tries: usize,
}

/// Feature edges one behind the other, each as the half-edge from an end to the face before it, and
/// the faces of the walls between them.
#[derive(Debug, Clone)]
struct Chain {
    edges: Vec<HalfEdge>,
    walls: Vec<Vec<Vertex>>,
}

/// A crossing without places for what is new.
#[derive(Debug, Clone)]
struct Found {
    gain: u32,
    shifts: Vec<Shift>,
    patches: Vec<Patch>,
}

/// A region, its best filling, and how many elements fewer that leaves.
#[derive(Debug, Clone)]
struct Patch {
    region: Region,
    filling: Filling,
    gain: i32,
}

impl Patch {
    fn new(region: Region) -> Option<Self> {
        let filling = fillings(region.rim.len(), &region.corners, 1).into_iter().next()?;
        let after = region.rim_irregularity_after + filling.irregularity();
        let gain = region.irregularity as i32 - after as i32;
        Some(Self { region, filling, gain })
    }
}

/// The few smallest crossings that begin at the feature edges nearest to `seed`, with how many
/// elements fewer each leaves. The mesh is unchanged afterwards.
pub fn around(
    mesh: &mut QuadMesh,
    seed: Vertex,
    (clusters, lines): (&mut Clusters, &SharpLines),
    bounds: Bounds,
) -> Vec<(u32, Crossing)> {
    let mut found: Vec<Found> = Vec::new();
    let mark = mesh.mark();
    for edge in clusters.feature_edges(mesh, seed, bounds.edges) {
        let chain = chain(mesh, edge);
        for count in 1..=chain.edges.len() {
            for cut in [false, true] {
                let chain = (&chain.edges[..count], &chain.walls[..count - 1]);
                found.extend(crossing(mesh, chain, cut, (clusters, lines), bounds));
                mesh.undo_to(mark);
            }
        }
    }
    let faces = |f: &Found| f.patches.iter().map(|p| p.region.faces.len()).sum::<usize>();
    found.sort_by_key(|f| (faces(f), std::cmp::Reverse(f.gain)));
    let crossings = found.into_iter().take(bounds.tries).filter_map(|found| {
        let crossing = found.place(mesh);
        mesh.undo_to(mark);
        Some((found.gain, crossing?))
    });
    crossings.collect()
}

impl Found {
    /// With places for what is new. The mesh is left resampled.
    fn place(&self, mesh: &mut QuadMesh) -> Option<Crossing> {
        self.shifts.iter().try_for_each(|shift| shift.run(mesh).map(drop)).ok()?;
        let refill = |p: &Patch| Refill::new(mesh, &p.region, p.filling.clone()).ok();
        let refills = self.patches.iter().map(refill).collect::<Option<Vec<Refill>>>()?;
        Some(Crossing { shifts: self.shifts.clone(), refills })
    }
}

/// The feature edges that a dislocation which passes through `edge` meets one behind the other.
fn chain(mesh: &QuadMesh, edge: HalfEdge) -> Chain {
    let mut chain = Chain { edges: vec![edge], walls: Vec::new() };
    let mut wall = Vec::new();
    // Out of the face beyond the edge, in the quad of the edge.
    let mut out = QuadMesh::prev(edge);
    while chain.edges.len() < LINES && wall.len() < WALL {
        let face = mesh.origin(out);
        if mesh.is_ghost(face) || mesh.valence(face) != 4 {
            break;
        }
        wall.push(face);
        out = mesh.ccw(mesh.ccw(out));
        match mesh.kind(QuadMesh::quad(out)) {
            QuadKind::Free => out = QuadMesh::opposite(out),
            QuadKind::Feature if !chain.edges.iter().any(|&e| e >> 2 == out >> 2) => {
                chain.walls.push(std::mem::take(&mut wall));
                chain.edges.push(QuadMesh::prev(out));
                out = QuadMesh::opposite(out);
            }
            _ => break,
        }
    }
    chain
}

/// The smallest crossing of a chain of feature edges that leaves fewer irregular elements. The mesh
/// is left resampled.
fn crossing(
    mesh: &mut QuadMesh,
    (edges, walls): (&[HalfEdge], &[Vec<Vertex>]),
    cut: bool,
    (clusters, lines): (&mut Clusters, &SharpLines),
    bounds: Bounds,
) -> Option<Found> {
    let (mut shifts, mut sides, mut rise) = (Vec::new(), Vec::new(), 0);
    for &edge in edges {
        let (before, after) = (mesh.target(edge), mesh.origin(QuadMesh::prev(edge)));
        let resample = if cut { Resample::Cut { edge } } else { join(mesh, edge)? };
        let line = Line::around(mesh, edge);
        rise += resample.check(mesh).ok()?.delta();
        let vertex = resample.run(mesh).ok()?;
        let shift = Shift { resample, slides: line.slides(mesh, vertex, lines) };
        shift.slide(mesh);
        shifts.push(shift);
        sides.push((vertex, before, after));
    }
    // Not before all is resampled: a vertex that stays at one line may go at the next.
    let sides = sides.into_iter().map(|(vertex, before, after)| {
        let alive = mesh.is_alive(vertex) && mesh.is_alive(before) && mesh.is_alive(after);
        alive.then(|| Some((mesh.find(vertex, before)?, mesh.find(vertex, after)?)))?
    });
    let sides: Vec<(HalfEdge, HalfEdge)> = sides.collect::<Option<_>>()?;
    let mut patches: Vec<Patch> = Vec::new();
    let mut left = bounds.faces;
    for (wall, pair) in walls.iter().zip(sides.windows(2)) {
        let region = clusters.spanning(mesh, &[pair[0].1, pair[1].0], wall, left)?;
        let patch = Patch::new(region)?;
        rise -= patch.gain;
        left -= patch.region.faces.len();
        patches.push(patch);
    }
    let limits = Limits { faces: left, partners: bounds.partners, least_gain: LEAST_GAIN };
    let near = clusters.beside(mesh, sides.first()?.0, limits);
    if near.is_empty() {
        return None;
    }
    let far = clusters.beside(mesh, sides.last()?.1, limits);
    let after = |r: &Region| least_after(r.corners.len(), r.rim_irregularity_after);
    let hope = |region: &Region| region.irregularity as i32 - after(region) as i32;
    let faces = |&(i, k): &(usize, usize)| near[i].faces.len() + far[k].faces.len();
    let all = (0..near.len()).flat_map(|i| (0..far.len()).map(move |k| (i, k)));
    let pays = |&(i, k): &(usize, usize)| hope(&near[i]) + hope(&far[k]) > rise;
    let mut pairs: Vec<(usize, usize)> =
        all.filter(|pair| pays(pair) && faces(pair) <= left).collect();
    pairs.sort_by_key(faces);
    let (mut of_near, mut of_far) = (vec![None; near.len()], vec![None; far.len()]);
    for (i, k) in pairs {
        let a = of_near[i].get_or_insert_with(|| Patch::new(near[i].clone()));
        let b = of_far[k].get_or_insert_with(|| Patch::new(far[k].clone()));
        let (Some(a), Some(b)) = (a, b) else { continue };
        let gain = a.gain + b.gain - rise;
        if gain > 0 && are_apart(patches.iter().chain([&*a, &*b])) {
            patches.extend([a.clone(), b.clone()]);
            return Some(Found { gain: gain as u32, shifts, patches });
        }
    }
    None
}

/// Whether no two of the patches share a face.
fn are_apart<'a>(patches: impl Iterator<Item = &'a Patch>) -> bool {
    let mut faces: Vec<Vertex> = patches.flat_map(|p| p.region.faces.iter().copied()).collect();
    faces.sort_unstable();
    faces.windows(2).all(|w| w[0] != w[1])
}

/// Joins the ends of a feature edge at the one that has to stay.
fn join(mesh: &QuadMesh, edge: HalfEdge) -> Option<Resample> {
    let ends = [edge, QuadMesh::opposite(edge)];
    let edge =
        ends.into_iter().find(|&e| beside(mesh, mesh.origin(QuadMesh::opposite(e))).is_some())?;
    Some(Resample::Join { edge })
}
