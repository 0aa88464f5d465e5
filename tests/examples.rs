//! The programs of `examples` do what they say: each asserts it.

#[path = "../examples/cancel_t_junctions.rs"]
mod cancel_t_junctions;
#[path = "../examples/move_pair.rs"]
mod move_pair;
#[path = "../examples/pure_quad.rs"]
mod pure_quad;
#[path = "../examples/session.rs"]
mod session;

#[test]
fn two_t_junctions_cancel() {
    cancel_t_junctions::main().unwrap();
}

#[test]
fn a_pair_moves_and_comes_back() {
    move_pair::main().unwrap();
}

#[test]
fn the_sample_becomes_pure_quads() {
    pure_quad::main().unwrap();
}

#[test]
fn a_scripted_session_ends_with_quads() {
    session::main().unwrap();
}
