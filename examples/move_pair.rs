//! A pair (v3 and f5, a T-junction) moves by whole edges, and back; then it changes its type.
//!
//! `cargo run --example move_pair`

use fixedbitset::FixedBitSet;
use quadmend::mesh::shapes;
use quadmend::moves::t_junction::{Direction, shift};
use quadmend::moves::{Dipole, Step};
use quadmend::ops::{Flip, Op, Turn};
use quadmend::sqrtcc::lift;
use std::error::Error;

/// Runs the example.
pub(crate) fn main() -> Result<(), Box<dyn Error>> {
    let torus = shapes::torus(30, 20);
    let mut q = lift(&torus, &FixedBitSet::with_capacity(torus.corner_count()))?;
    Op::Flip(Flip { edge: q.out(310), turn: Turn::Ccw }).run(&mut q)?;
    let pair = Dipole::all(&q).find(|d| d.is_t_junction()).ok_or("a T-junction")?;

    // Away from its opposite twin, to where the surroundings are regular.
    let directions = [Direction::Up, Direction::Down, Direction::Left, Direction::Right];
    let away = directions.into_iter().find_map(|to| shift(&mut q, pair, to, 1).ok());
    let start = away.ok_or("room to move")?.dipole;

    // Up eats an edge of the stem, down gives it back: the pair stands where it stood.
    let edges = q.quads().count();
    let up = shift(&mut q, start, Direction::Up, 1)?.dipole;
    assert_eq!(q.quads().count(), edges - 2);
    let back = shift(&mut q, up, Direction::Down, 1)?.dipole;
    assert_eq!((q.quads().count(), q.total_irregularity()), (edges, 4));
    assert!(back.is_t_junction());

    // Half a move changes the type: v3 and f5 become f3 and v5.
    let half = back.step(&mut q, Step::ClimbLeft)?.dipole.ok_or("it stands")?;
    assert!(!half.is_t_junction());
    Ok(())
}
