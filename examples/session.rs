//! A session as a program: regularise what is worst, cancel what is near, make pure quads.
//!
//! `cargo run --release --example session`

use fixedbitset::FixedBitSet;
use quadmend::io::{Format, Obj};
use quadmend::mesh::{MendPolicy, check, mend};
use quadmend::moves::pure::{Kind, convert};
use quadmend::moves::{Dipole, regularize};
use quadmend::planner::cost::CostOptions;
use quadmend::planner::movement::MovementGraph;
use quadmend::sqrtcc::{QuadMesh, lift, lower};
use quadmend::watch::Silent;
use std::error::Error;

/// Runs the example.
pub(crate) fn main() -> Result<(), Box<dyn Error>> {
    let mesh = Obj.read(include_bytes!("../assets/bracket.obj"), "bracket.obj")?.mesh;
    let (mesh, _) = mend(mesh, MendPolicy::Mend)?;
    let mut q = lift(&mesh, &FixedBitSet::with_capacity(mesh.corner_count()))?;
    let start = q.mark();
    let mut left = vec![q.total_irregularity()];

    // Clusters: an element that is off by two or more, with what is around it.
    for v in 0..q.vertex_ids() {
        if q.is_alive(v) && q.irregularity(v) >= 2 {
            // A refusal says why, and leaves the mesh as it was.
            let _ = regularize::around(&mut q, v, 60);
        }
    }
    left.push(q.total_irregularity());

    let standing: Vec<Dipole> = Dipole::all(&q).collect();
    for dipole in standing {
        // What was cancelled before may have taken this one along.
        if q.is_quad_alive(QuadMesh::quad(dipole.0)) && dipole.stands(&q) {
            cancel(&mut q, dipole)?;
        }
    }
    left.push(q.total_irregularity());

    let conversion = convert(&mut q, Kind::Faces, &mut |_, _| 0.0, &Silent);
    assert_eq!(conversion.left.len(), conversion.obstructions.len());
    assert!(left.is_sorted_by(|a, b| a >= b) && left[2] < left[0] / 2, "{left:?}");
    check(&lower(&q, mesh.group_names())?.mesh)?;

    // The whole session can be taken back.
    q.undo_to(start);
    assert_eq!(lower(&q, mesh.group_names())?.mesh.points(), mesh.points());
    Ok(())
}

/// Walks a dislocation the cheapest way until it is absorbed, if there is one.
fn cancel(q: &mut QuadMesh, dipole: Dipole) -> Result<(), Box<dyn Error>> {
    let costs = CostOptions::default();
    let graph = MovementGraph::new(q, dipole, 12, &costs);
    let steps = graph.search(&[]).map(|(goal, _)| graph.steps(goal)).unwrap_or_default();
    drop(graph);
    let mut at = Some(dipole);
    for step in steps {
        at = at.ok_or("it still stands")?.step(q, step)?.dipole;
    }
    Ok(())
}
