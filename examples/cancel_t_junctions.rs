//! Two T-junctions that face one another are made, moved apart, and cancelled again.
//!
//! `cargo run --example cancel_t_junctions`

use fixedbitset::FixedBitSet;
use quadmend::mesh::shapes;
use quadmend::moves::{Dipole, Step};
use quadmend::ops::{Flip, Op, Turn};
use quadmend::planner::cost::CostOptions;
use quadmend::planner::movement::MovementGraph;
use quadmend::sqrtcc::lift;
use std::error::Error;

/// Runs the example.
pub(crate) fn main() -> Result<(), Box<dyn Error>> {
    let torus = shapes::torus(30, 20);
    let mut q = lift(&torus, &FixedBitSet::with_capacity(torus.corner_count()))?;

    // One edge shift in a regular grid leaves two opposite T-junctions next to one another.
    Op::Flip(Flip { edge: q.out(310), turn: Turn::Ccw }).run(&mut q)?;
    assert_eq!(q.total_irregularity(), 4);
    let mut t_junction = Dipole::all(&q).find(|d| d.is_t_junction()).ok_or("a T-junction")?;

    // Gliding keeps type and E.
    for _ in 0..5 {
        let way = [Step::GlideLeft, Step::GlideRight].into_iter().find_map(|step| {
            let mark = q.mark();
            let there = t_junction.step(&mut q, step).ok().filter(|s| s.delta == 0);
            if there.is_none() {
                q.undo_to(mark);
            }
            there?.dipole
        });
        t_junction = way.ok_or("room to glide")?;
    }
    assert_eq!(q.total_irregularity(), 4);

    // The cheapest way back, as a shortest path in the movement graph.
    let costs = CostOptions::default();
    let graph = MovementGraph::new(&mut q, t_junction, 16, &costs);
    let (goal, _) = graph.search(&[]).ok_or("a way to be cancelled")?;
    let steps = graph.steps(goal);
    drop(graph);
    let mut at = Some(t_junction);
    for step in steps {
        at = at.ok_or("it still stands")?.step(&mut q, step)?.dipole;
    }
    assert_eq!(q.total_irregularity(), 0, "both are gone");
    Ok(())
}
