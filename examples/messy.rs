//! A messy mesh of any size to try things on, with the scan that it was made from.
//!
//! `cargo run --release --example messy -- --faces 1000000 --seed 1 -o messy.obj --reference scan.obj`
//!
//! It is connected and closed; about one element in twenty is irregular, with T-junctions,
//! triangles and dislocations that have walked apart. The same seed gives the same bytes.

#[path = "../tests/common/mod.rs"]
mod common;

use clap::Parser;
use common::messy::Messy;
use quadmend::io::write;
use std::error::Error;
use std::path::PathBuf;

/// Make a messy quad-dominant mesh and its reference surface
#[derive(Debug, Parser)]
struct Arguments {
    /// Number of faces, about
    #[arg(long, default_value_t = 10_000, value_parser = clap::value_parser!(u32).range(100..))]
    faces: u32,
    /// Another number gives another mesh
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Where the mesh goes (OBJ, PLY or OFF)
    #[arg(short, long)]
    output: PathBuf,
    /// Where its reference surface goes [default: nowhere]
    #[arg(long)]
    reference: Option<PathBuf>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::parse();
    let messy = Messy::scanned(arguments.seed, arguments.faces);
    write(&arguments.output, &messy.mesh)?;
    if let (Some(path), Some(scan)) = (&arguments.reference, &messy.reference) {
        write(path, scan)?;
    }
    Ok(())
}
