//! The movement graph: where a dislocation can go, as a graph that petgraph searches.
//!
//! Nodes are the places that a dislocation reaches, named by their displacement in the lattice
//! (places with the same displacement are the same place in regular surroundings); edges are its
//! six steps, weighted by the cost terms; goals are steps after which E is smaller. The graph is
//! implicit and exact: the edges of a node are found by walking there through the journal, trying
//! each step, and undoing everything.
//!
//! Source: Peng & Wonka 2013, section 4 (left there as future work).

use super::cost::{CostOptions, StepContext, step_cost};
use crate::moves::dipole::STEPS;
use crate::moves::{Dipole, Displacement, Step};
use crate::sqrtcc::QuadMesh;
use petgraph::visit::{
    Data, EdgeRef, GraphBase, GraphRef, IntoEdgeReferences, IntoEdges, IntoNeighbors, VisitMap,
    Visitable,
};
use rustc_hash::{FxBuildHasher, FxHashMap};
use std::cell::RefCell;
use std::collections::HashSet;

/// A node of the movement graph; 0 is where the dislocation stands now.
pub type Node = u32;

/// How a dislocation is absorbed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Cancellation {
    /// It meets a lone irregular element: three become one.
    Triple,
    /// A T-junction meets another: both vanish.
    TJunctionPair,
    /// It meets another pair of opposite elements: all four vanish.
    Quadruple,
}

#[derive(Debug, Clone, Copy)]
struct Place {
    parent: Node,
    step: Step,
    depth: u16,
    displacement: Displacement,
    goal: Option<Cancellation>,
    gain: u32,
}

/// A weighted step of the movement graph.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Movement {
    source: Node,
    target: Node,
    cost: f64,
}

impl EdgeRef for Movement {
    type NodeId = Node;
    type EdgeId = (Node, Node);
    type Weight = f64;

    fn source(&self) -> Node {
        self.source
    }
    fn target(&self) -> Node {
        self.target
    }
    fn weight(&self) -> &f64 {
        &self.cost
    }
    fn id(&self) -> (Node, Node) {
        (self.source, self.target)
    }
}

#[derive(Debug)]
struct State<'m> {
    mesh: &'m mut QuadMesh,
    places: Vec<Place>,
    found: FxHashMap<Displacement, Node>,
    edges: Vec<Option<Vec<Movement>>>,
}

/// The movement graph of one dislocation on a living mesh, built as far as it is searched.
#[derive(Debug)]
pub struct MovementGraph<'m, 'o> {
    state: RefCell<State<'m>>,
    start: Dipole,
    reach: u16,
    costs: &'o CostOptions,
}

impl<'m, 'o> MovementGraph<'m, 'o> {
    /// The graph of the dislocation at `start`, up to `reach` steps away.
    pub fn new(mesh: &'m mut QuadMesh, start: Dipole, reach: u16, costs: &'o CostOptions) -> Self {
        let origin = Place {
            parent: 0,
            step: Step::GlideLeft,
            depth: 0,
            displacement: Displacement::default(),
            goal: None,
            gain: 0,
        };
        let found = FxHashMap::from_iter([(origin.displacement, 0)]);
        let state = State { mesh, places: vec![origin], found, edges: vec![None] };
        Self { state: RefCell::new(state), start, reach, costs }
    }

    /// The cheapest way to be absorbed that is not among `refused`, and its cost.
    pub fn search(&self, refused: &[Node]) -> Option<(Node, f64)> {
        let goal = |n: Node| self.cancellation(n).is_some() && !refused.contains(&n);
        let found = petgraph::algo::astar(self, 0, goal, |e| *e.weight(), |_| 0.0);
        found.and_then(|(cost, path)| path.last().map(|&n| (n, cost)))
    }

    /// What happens at this node, if it is a goal.
    pub fn cancellation(&self, node: Node) -> Option<Cancellation> {
        self.state.borrow().places[node as usize].goal
    }

    /// How many irregular elements fewer there are at this node; 0 unless it is a goal.
    pub fn gain(&self, node: Node) -> u32 {
        self.state.borrow().places[node as usize].gain
    }

    /// The steps from the start to `node`.
    pub fn steps(&self, node: Node) -> Vec<Step> {
        self.state.borrow().path(node)
    }

    fn expand(&self, node: Node) -> Vec<Movement> {
        let mut state = self.state.borrow_mut();
        if let Some(edges) = &state.edges[node as usize] {
            return edges.clone();
        }
        let edges = state.explore(node, self.start, self.reach, self.costs);
        state.edges[node as usize] = Some(edges.clone());
        edges
    }
}

impl State<'_> {
    fn path(&self, node: Node) -> Vec<Step> {
        let mut steps = Vec::with_capacity(self.places[node as usize].depth as usize);
        let mut at = node;
        while self.places[at as usize].depth > 0 {
            steps.push(self.places[at as usize].step);
            at = self.places[at as usize].parent;
        }
        steps.reverse();
        steps
    }

    /// Walks to `node`, tries every step from there, and undoes it all.
    fn explore(
        &mut self,
        node: Node,
        start: Dipole,
        reach: u16,
        costs: &CostOptions,
    ) -> Vec<Movement> {
        let here = self.places[node as usize];
        if here.goal.is_some() || here.depth >= reach {
            return Vec::new();
        }
        let mark = self.mesh.mark();
        let mut at = Some(start);
        for step in self.path(node) {
            at = at.and_then(|d| d.step(self.mesh, step).ok()).and_then(|done| done.dipole);
        }
        let edges = at.map_or_else(Vec::new, |dipole| {
            STEPS.iter().filter_map(|&step| self.try_step(node, dipole, step, costs)).collect()
        });
        self.mesh.undo_to(mark);
        edges
    }

    fn try_step(
        &mut self,
        node: Node,
        dipole: Dipole,
        step: Step,
        costs: &CostOptions,
    ) -> Option<Movement> {
        let context = StepContext { mesh: self.mesh, dipole, step };
        let cost = step_cost(costs, &context);
        let was_t_junction = dipole.is_t_junction();
        let mark = self.mesh.mark();
        let done = dipole.step(self.mesh, step);
        self.mesh.undo_to(mark);
        let done = done.ok()?;
        let here = self.places[node as usize];
        let place = Place {
            parent: node,
            step,
            depth: here.depth + 1,
            displacement: here.displacement + step.displacement(),
            goal: None,
            gain: 0,
        };
        if done.delta < 0 {
            let kind = match done.delta {
                -3..=0 => Cancellation::Triple,
                _ if was_t_junction => Cancellation::TJunctionPair,
                _ => Cancellation::Quadruple,
            };
            let extra = match kind {
                Cancellation::Triple => costs.triple,
                Cancellation::TJunctionPair => costs.t_junction_pair,
                Cancellation::Quadruple => costs.quadruple,
            };
            let target =
                self.add(Place { goal: Some(kind), gain: done.delta.unsigned_abs(), ..place });
            return Some(Movement { source: node, target, cost: cost + extra });
        }
        if done.delta > 0 || done.dipole.is_none() {
            return None;
        }
        let known = self.found.get(&place.displacement).copied();
        let target = known.unwrap_or_else(|| {
            let new = self.add(place);
            self.found.insert(place.displacement, new);
            new
        });
        Some(Movement { source: node, target, cost })
    }

    fn add(&mut self, place: Place) -> Node {
        self.places.push(place);
        self.edges.push(None);
        self.places.len() as u32 - 1
    }
}

impl GraphBase for MovementGraph<'_, '_> {
    type NodeId = Node;
    type EdgeId = (Node, Node);
}

impl Data for MovementGraph<'_, '_> {
    type NodeWeight = ();
    type EdgeWeight = f64;
}

impl Visitable for MovementGraph<'_, '_> {
    type Map = Visited;

    fn visit_map(&self) -> Visited {
        Visited::default()
    }

    fn reset_map(&self, map: &mut Visited) {
        map.0.clear();
    }
}

/// The nodes that a search has visited.
#[derive(Debug, Clone, Default)]
pub struct Visited(HashSet<Node, FxBuildHasher>);

impl VisitMap<Node> for Visited {
    fn visit(&mut self, node: Node) -> bool {
        self.0.insert(node)
    }
    fn is_visited(&self, node: &Node) -> bool {
        self.0.contains(node)
    }
    fn unvisit(&mut self, node: Node) -> bool {
        self.0.remove(&node)
    }
}

/// The view that petgraph walks.
pub type View<'g, 'm, 'o> = &'g MovementGraph<'m, 'o>;

impl IntoNeighbors for View<'_, '_, '_> {
    type Neighbors = std::vec::IntoIter<Node>;

    fn neighbors(self, node: Node) -> Self::Neighbors {
        self.expand(node).iter().map(|m| m.target).collect::<Vec<_>>().into_iter()
    }
}

impl IntoEdgeReferences for View<'_, '_, '_> {
    type EdgeRef = Movement;
    type EdgeReferences = std::vec::IntoIter<Movement>;

    fn edge_references(self) -> Self::EdgeReferences {
        let known = self.state.borrow().edges.clone();
        known.into_iter().flatten().flatten().collect::<Vec<_>>().into_iter()
    }
}

impl IntoEdges for View<'_, '_, '_> {
    type Edges = std::vec::IntoIter<Movement>;

    fn edges(self, node: Node) -> Self::Edges {
        self.expand(node).into_iter()
    }
}

const _: fn() = || {
    fn is_graph_ref<G: GraphRef>() {}
    is_graph_ref::<View<'static, 'static, 'static>>();
};
