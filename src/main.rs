//! The `quadmend` command: parse, run, exit code.

mod cli;

use std::process::ExitCode;

/// What threads give back is of use to the others: with the allocator of glibc a clean of a million
/// faces takes a third more memory.
#[cfg(all(feature = "jemalloc", not(target_env = "msvc")))]
#[global_allocator]
static ALLOCATOR: tikv_jemallocator::Jemalloc = tikv_jemallocator::Jemalloc;

fn main() -> ExitCode {
    cli::main()
}
