//! The `quadmend` command.
fn main() {}
