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
use crate::sqrtcc::{HalfEdge, Mark, QuadKind, QuadMesh, Vertex};
use crate::surface::SharpLines;
use rustc_hash::FxHashMap;

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

/// Finds crossings, and keeps what begins at each feature edge: seeds nearby share their edges.
#[derive(Debug, Clone, Default)]
pub struct Crossings {
    clusters: Clusters,
    /// By the edge: what was found, and whether a patch was left out because it was too large.
    known: FxHashMap<HalfEdge, (Vec<Found>, bool)>,
    limited: bool,
}

impl Crossings {
    /// Forgets what was found: the mesh has changed, or what is looked for.
    pub fn forget(&mut self) {
        self.known.clear();
    }

    /// Whether a patch has been left out since this was asked last because it was too large.
    pub fn take_limited(&mut self) -> bool {
        std::mem::take(&mut self.limited)
    }

    /// The few smallest crossings that begin at the feature edges nearest to `seed`, with how many
    /// elements fewer each leaves. The mesh is unchanged afterwards.
    ///
    /// *Precondition:* all but the seed is as it was when something was last forgotten.
    pub fn around(
        &mut self,
        mesh: &mut QuadMesh,
        seed: Vertex,
        lines: &SharpLines,
        bounds: Bounds,
    ) -> Vec<(u32, Crossing)> {
        let edges = self.clusters.feature_edges(mesh, seed, bounds.edges);
        for &edge in &edges {
            let (_, limited) = self.known.entry(edge).or_insert_with(|| {
                let found = beginning_at(mesh, edge, (&mut self.clusters, lines), bounds);
                (found, self.clusters.take_limited())
            });
            self.limited |= *limited;
        }
        let mut found: Vec<&Found> = edges.iter().flat_map(|edge| &self.known[edge].0).collect();
        found.sort_by_key(|f| (f.faces(), std::cmp::Reverse(f.gain)));
        let mark = mesh.mark();
        let crossings = found.into_iter().take(bounds.tries).filter_map(|found| {
            let crossing = found.place(mesh);
            mesh.undo_to(mark);
            Some((found.gain, crossing?))
        });
        crossings.collect()
    }
}

/// The smallest crossing of each count of lines that begins at `edge`, with an edge more and with
/// an edge less. The mesh is unchanged afterwards.
fn beginning_at(
    mesh: &mut QuadMesh,
    edge: HalfEdge,
    (clusters, lines): (&mut Clusters, &SharpLines),
    bounds: Bounds,
) -> Vec<Found> {
    let (chain, mark) = (chain(mesh, edge), mesh.mark());
    let mut found = Vec::new();
    for cut in [false, true] {
        let mut way = Way::default();
        for (k, &edge) in chain.edges.iter().enumerate() {
            if way.resample(mesh, edge, cut, lines).is_none() {
                break;
            }
            found.extend(way.crossing(mesh, &chain.walls[..k], clusters, bounds));
        }
        mesh.undo_to(mark);
    }
    // Of those as large and as good the one of fewer lines is first.
    found.sort_by_key(|f| f.shifts.len());
    found
}

impl Found {
    /// Number of faces of all patches.
    fn faces(&self) -> usize {
        self.patches.iter().map(|p| p.region.faces.len()).sum()
    }

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

/// A row of feature edges that have been resampled, one behind the other.
#[derive(Debug, Default)]
struct Way {
    shifts: Vec<Shift>,
    /// Irregularity that the resampling brought.
    rise: i32,
    /// Each vertex that came or stayed, and the faces before and after it.
    sides: Vec<[Vertex; 3]>,
    /// Regions before the first, and the state of the mesh in which they were found.
    near: Option<(Vec<Region>, Mark)>,
}

impl Way {
    /// Resamples one more edge, with an edge more or an edge less. `None` if that cannot be done.
    fn resample(
        &mut self,
        mesh: &mut QuadMesh,
        edge: HalfEdge,
        cut: bool,
        lines: &SharpLines,
    ) -> Option<()> {
        let (before, after) = (mesh.target(edge), mesh.origin(QuadMesh::prev(edge)));
        let resample = if cut { Resample::Cut { edge } } else { join(mesh, edge)? };
        let line = Line::around(mesh, edge);
        self.rise += resample.check(mesh).ok()?.delta();
        let vertex = resample.run(mesh).ok()?;
        let shift = Shift { resample, slides: line.slides(mesh, vertex, lines) };
        shift.slide(mesh);
        self.shifts.push(shift);
        self.sides.push([vertex, before, after]);
        Some(())
    }

    /// The half-edges from what is between the lines to the faces before and after, if all that is
    /// still there: a vertex that stays at one line may go at the next.
    fn half_edges(&self, mesh: &QuadMesh) -> Option<Vec<[HalfEdge; 2]>> {
        let at = |&[vertex, before, after]: &[Vertex; 3]| {
            let alive = [vertex, before, after].iter().all(|&v| mesh.is_alive(v));
            alive.then(|| Some([mesh.find(vertex, before)?, mesh.find(vertex, after)?]))?
        };
        self.sides.iter().map(at).collect()
    }

    /// The smallest crossing of all the edges that leaves fewer irregular elements.
    fn crossing(
        &mut self,
        mesh: &QuadMesh,
        walls: &[Vec<Vertex>],
        clusters: &mut Clusters,
        bounds: Bounds,
    ) -> Option<Found> {
        let sides = self.half_edges(mesh)?;
        let mut patches: Vec<Patch> = Vec::new();
        let (mut left, mut rise) = (bounds.faces, self.rise);
        for (wall, pair) in walls.iter().zip(sides.windows(2)) {
            let region = clusters.spanning(mesh, &[pair[0][1], pair[1][0]], wall, left)?;
            let patch = Patch::new(region)?;
            rise -= patch.gain;
            left -= patch.region.faces.len();
            patches.push(patch);
        }
        let limits = Limits { faces: left, partners: bounds.partners, least_gain: LEAST_GAIN };
        let near = self.near(mesh, sides.first()?[0], clusters, limits);
        if near.is_empty() {
            return None;
        }
        let far = clusters.beside(mesh, sides.last()?[1], limits);
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
                return Some(Found { gain: gain as u32, shifts: self.shifts.clone(), patches });
            }
        }
        None
    }

    /// Regions before the first edge: those that were found before another was resampled, unless
    /// that has changed something there.
    fn near(
        &mut self,
        mesh: &QuadMesh,
        at: HalfEdge,
        clusters: &mut Clusters,
        limits: Limits,
    ) -> &[Region] {
        let is_known = self.near.as_ref().is_some_and(|(regions, mark)| {
            let touched = mesh.touched_since(*mark);
            let is_touched = |v: Vertex| touched.binary_search(&v).is_ok();
            !regions.iter().any(|r| {
                let rim = r.rim.iter().map(|&h| mesh.target(h));
                r.faces.iter().chain(&r.interior).copied().chain(rim).any(is_touched)
            })
        });
        if !is_known {
            self.near = None;
        }
        let found = || (clusters.beside(mesh, at, limits), mesh.mark());
        &self.near.get_or_insert_with(found).0
    }
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
