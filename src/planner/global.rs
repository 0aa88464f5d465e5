//! The global plan: which dislocations annihilate with which, and which lone elements absorb the
//! rest.
//!
//! Elements of opposite index are matched along the shortest paths between them; a pair is a
//! dislocation, and its Burgers vector is known from its separation. Then dislocations are matched
//! with one another and with lone elements, so that as many elements as possible go at the least
//! length of the ways: two dislocations of opposite Burgers vectors leave nothing, two others leave
//! one, and a lone element absorbs a dislocation and moves. Both are matchings of greatest weight
//! (Edmonds), so no group is chosen at the cost of two others, as the nearest first would.

use crate::moves::{Offset, Path, quarters};
use crate::sqrtcc::{HalfEdge, QuadMesh, Vertex};
use mwmatching::Matching;
use rayon::prelude::*;
use rustc_hash::FxHashMap;
use std::collections::{BTreeMap, BTreeSet};

/// Elements that are to vanish or merge together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Group {
    /// The elements, those of a dislocation side by side.
    pub members: Vec<Vertex>,
    /// The vertices of Q on the ways between them, members included.
    pub ways: Vec<Vertex>,
    /// The ends of the way that joins them.
    pub link: Link,
    /// Elements that may go: four if two dislocations annihilate, else two.
    pub gain: u32,
}

/// The roads that two elements of opposite index are matched along, by either element: a pair is a
/// dislocation.
type Dislocations = BTreeMap<usize, usize>;

/// The irregular elements that nothing holds, and the paths between neighbouring ones.
struct Roads {
    elements: Vec<Vertex>,
    paths: Vec<Path>,
    /// From which element to which each path leads.
    ends: Vec<[usize; 2]>,
}

/// Neighbours of an element that it may be matched with: the nearest ones.
const NEIGHBOURS: usize = 8;

/// Edges of Q that the ways may be longer for one element less.
const WORTH: i32 = 40;

/// Two elements, smaller number first: what joins a group.
pub type Link = [Vertex; 2];

/// The groups into which the global plan divides the elements of the mesh, by ways of at most
/// `reach` edges of Q; none by a link that was tried before. O(elements · (area they are spread
/// over) + elements³) at worst, much less as a rule.
#[must_use]
pub fn groups(mesh: &QuadMesh, reach: usize, tried: &BTreeSet<Link>) -> Vec<Group> {
    let roads = Roads::new(mesh, reach);
    let dislocations = roads.dislocations(mesh, reach);
    roads.groups(mesh, &dislocations, tried)
}

impl Roads {
    fn new(mesh: &QuadMesh, reach: usize) -> Self {
        let free = |&v: &Vertex| !mesh.is_on_line(v);
        let elements: Vec<Vertex> =
            mesh.vertices().filter(|&v| mesh.irregularity(v) > 0).filter(free).collect();
        let number: FxHashMap<Vertex, usize> =
            elements.iter().enumerate().map(|(i, &v)| (v, i)).collect();
        let nearest = |&v: &Vertex| Path::nearest(mesh, v, NEIGHBOURS, reach);
        let found: Vec<Vec<Path>> = elements.par_iter().map(nearest).collect();
        let (mut paths, mut ends) = (Vec::new(), Vec::new());
        for (i, path) in
            found.into_iter().enumerate().flat_map(|(i, p)| p.into_iter().map(move |p| (i, p)))
        {
            let end = path.half_edges().last().and_then(|&h| number.get(&mesh.target(h)));
            if let Some(&j) = end {
                paths.push(path);
                ends.push([i, j]);
            }
        }
        Self { elements, paths, ends }
    }

    fn link(&self, road: usize) -> Link {
        let mut link = self.ends[road].map(|i| self.elements[i]);
        link.sort_unstable();
        link
    }

    fn length(&self, road: usize) -> usize {
        self.paths[road].half_edges().len()
    }

    /// Matches elements of opposite index, as many as can be, nearest all in all.
    fn dislocations(&self, mesh: &QuadMesh, reach: usize) -> Dislocations {
        let is = |i: usize, valence: u32| mesh.valence(self.elements[i]) == valence;
        let mut best = Best::default();
        for (road, &[i, j]) in self.ends.iter().enumerate() {
            if is(i, 3) && is(j, 5) || is(i, 5) && is(j, 3) {
                best.offer([i, j], (2 * reach - self.length(road)) as i32, road);
            }
        }
        best.matching().into_iter().flat_map(|road| self.ends[road].map(|i| (i, road))).collect()
    }

    /// Matches dislocations with one another and with lone elements.
    fn groups(
        &self,
        mesh: &QuadMesh,
        dislocations: &Dislocations,
        tried: &BTreeSet<Link>,
    ) -> Vec<Group> {
        // A dislocation goes by the first element of its road.
        let unit = |i: usize| dislocations.get(&i).map_or(i, |&way| self.ends[way][0]);
        let mut best = Best::default();
        for (road, &[i, j]) in self.ends.iter().enumerate() {
            let ways = [i, j].map(|i| dislocations.get(&i).copied());
            let alone = ways == [None, None] || unit(i) == unit(j);
            if alone || tried.contains(&self.link(road)) {
                continue;
            }
            let length: usize =
                ways.into_iter().flatten().chain([road]).map(|way| self.length(way)).sum();
            let gain = self.gain(mesh, road, ways) as i32;
            best.offer([unit(i), unit(j)], gain * WORTH - length as i32, road);
        }
        best.matching().into_iter().map(|road| self.group(mesh, dislocations, road)).collect()
    }

    fn group(&self, mesh: &QuadMesh, dislocations: &Dislocations, road: usize) -> Group {
        let [i, j] = self.ends[road];
        let ways = [i, j].map(|i| dislocations.get(&i).copied());
        let both = |i: usize, way: Option<usize>| way.map_or(vec![i], |w| self.ends[w].to_vec());
        let members = [both(i, ways[0]), both(j, ways[1])].concat();
        let edges = ways.into_iter().flatten().chain([road]);
        let edges = edges.flat_map(|way| self.paths[way].half_edges());
        let mut on_ways: Vec<Vertex> =
            edges.flat_map(|&h| [mesh.origin(h), mesh.target(h)]).collect();
        on_ways.sort_unstable();
        on_ways.dedup();
        Group {
            members: members.into_iter().map(|i| self.elements[i]).collect(),
            ways: on_ways,
            link: self.link(road),
            gain: self.gain(mesh, road, ways),
        }
    }

    /// How many elements fewer there can be if what is at the ends of a road comes together.
    fn gain(&self, mesh: &QuadMesh, road: usize, ways: [Option<usize>; 2]) -> u32 {
        match ways {
            [Some(a), Some(b)] if self.annihilate(mesh, road, [a, b]) => 4,
            _ => 2,
        }
    }

    /// Whether the Burgers vectors of two dislocations are opposite when they are carried along a
    /// road between them.
    ///
    /// The lattice turns by a quarter around an end, so which way a vector is carried past it
    /// matters: always counter-clockwise from the road. A loop around a dislocation then shifts
    /// the lattice by (R − 1)·s, with s its separation from the end where the road meets it and R
    /// the turn around that end: R⁻¹ if it is the other one.
    fn annihilate(&self, mesh: &QuadMesh, road: usize, ways: [usize; 2]) -> bool {
        let path = &self.paths[road];
        let (Some(&first), Some(&last)) = (path.half_edges().first(), path.half_edges().last())
        else {
            return false;
        };
        let [i, j] = self.ends[road];
        let near = self.seen_from(mesh, ways[0], (i, first));
        let far = self.seen_from(mesh, ways[1], (j, mesh.twin(last)));
        let heading = path.headings()[path.headings().len() - 1];
        let far = far.turned(heading.quarters() + 2);
        match [i, j].map(|e| mesh.valence(self.elements[e])) {
            [a, b] if a == b => near + far == Offset::default(),
            // R⁻¹ − 1 = −R⁻¹ (R − 1); around a vertex of three edges R turns back by a quarter.
            [3, _] => near == far.turned(1),
            _ => near == far.turned(-1),
        }
    }

    /// The separation of a dislocation from its end `i`, in the lattice in which `from`, out of
    /// that end, points along +x.
    fn seen_from(&self, mesh: &QuadMesh, way: usize, (i, from): (usize, HalfEdge)) -> Offset {
        let path = &self.paths[way];
        let edges = path.half_edges();
        if self.ends[way][0] == i {
            return path.separation().turned(quarters(mesh, from, edges[0]));
        }
        // Seen from its far end: against the last edge, which leads there.
        let last = path.headings()[edges.len() - 1].quarters();
        let back = mesh.twin(edges[edges.len() - 1]);
        path.separation().turned(2).turned(quarters(mesh, from, back) - last - 2)
    }
}

/// The heaviest edge offered between each pair.
#[derive(Default)]
struct Best {
    edges: BTreeMap<[usize; 2], (i32, usize)>,
}

impl Best {
    fn offer(&mut self, mut ends: [usize; 2], weight: i32, road: usize) {
        ends.sort_unstable();
        let best = self.edges.entry(ends).or_insert((weight, road));
        if weight > best.0 {
            *best = (weight, road);
        }
    }

    /// The roads of a matching of greatest weight.
    fn matching(&self) -> Vec<usize> {
        let mut number = BTreeMap::new();
        for &end in self.edges.keys().flatten() {
            let next = number.len();
            number.entry(end).or_insert(next);
        }
        let edges = self.edges.iter().filter(|(_, best)| best.0 > 0);
        let edges = edges.map(|([a, b], &(w, _))| (number[a], number[b], w)).collect();
        let mate = Matching::new(edges).solve();
        let matched = |[a, b]: &[usize; 2]| mate.get(number[a]) == Some(&number[b]);
        self.edges.iter().filter(|(ends, _)| matched(ends)).map(|(_, best)| best.1).collect()
    }
}
