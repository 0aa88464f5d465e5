//! Cuts the surface where it is no manifold: one vertex for each fan of [`Topology`].
//!
//! A fan along a cut is a chain of corners with two ends, so at most two of the faces on a cut
//! edge can share the fans at both its ends. These two are joined again by the new numbers, and
//! no edge keeps more than two faces: one pass is enough when every face is simple.

use super::{Draft, Log, MendError, MendKind};

impl Draft {
    pub(super) fn cut(&mut self, log: &mut Log) -> Result<(), MendError> {
        let topology = self.topology();
        for &h in &topology.nonmanifold_edges {
            let vertex = self.mesh.corners()[h as usize];
            log.note(MendKind::NonManifoldEdge, self.sources[vertex as usize])?;
        }
        let mut fans = vec![0_u32; self.mesh.vertex_count()];
        topology.fan_vertex.iter().for_each(|&v| fans[v as usize] += 1);
        for (v, _) in fans.iter().enumerate().filter(|(_, n)| **n > 1) {
            log.note(MendKind::BowTie, self.sources[v])?;
        }
        if fans.iter().all(|&n| n <= 1) {
            return Ok(());
        }
        self.split_vertices(&fans)
    }

    /// Gives each fan a vertex of its own; copies stand behind each other in the old order.
    fn split_vertices(&mut self, fans: &[u32]) -> Result<(), MendError> {
        let mut next_copy = Vec::with_capacity(fans.len());
        let (mut points, mut sources) = (Vec::new(), Vec::new());
        for (v, &count) in fans.iter().enumerate() {
            next_copy.push(points.len() as u32);
            for _ in 0..count.max(1) {
                points.push(self.mesh.points()[v]);
                sources.push(self.sources[v]);
            }
        }
        let take_copy = |&v: &u32| {
            next_copy[v as usize] += 1;
            next_copy[v as usize] - 1
        };
        let topology = self.topology();
        let vertex_of_fan: Vec<u32> = topology.fan_vertex.iter().map(take_copy).collect();
        let corners = topology.fan.iter().map(|&fan| vertex_of_fan[fan as usize]).collect();
        self.sources = sources;
        self.set_vertices(points, corners)
    }
}
