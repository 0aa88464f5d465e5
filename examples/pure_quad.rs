//! The sample mesh, cleaned, becomes one of quads only.
//!
//! `cargo run --release --example pure_quad`

use quadmend::config::Config;
use quadmend::io::{OBJ, ReadOptions};
use quadmend::mesh::MendPolicy;
use quadmend::pipeline::pure_quad::pure_quad;
use quadmend::watch::Silent;
use std::error::Error;

/// Runs the example.
pub(crate) fn main() -> Result<(), Box<dyn Error>> {
    let read = |bytes, name| OBJ.read(bytes, name, &ReadOptions::default());
    let mesh = read(&include_bytes!("../assets/bracket.obj")[..], "bracket.obj")?.mesh;
    let scan = read(&include_bytes!("../assets/bracket.ref.obj")[..], "bracket.ref.obj")?.mesh;
    let converted = pure_quad(mesh, Some(&scan), MendPolicy::Mend, &Config::default(), &Silent)?;

    // Every face is a quad, but for one in each part with an odd number of frozen edges around it.
    let conversion = &converted.report.conversion;
    assert_eq!(conversion.left.len(), conversion.obstructions.len());
    let odd = converted.mesh.faces().filter(|face| face.len() != 4).count();
    assert_eq!(odd, conversion.left.len());

    // Irregular faces have become irregular vertices: there are no more of them all together.
    let [before, after] = [&converted.report.before, &converted.report.after];
    assert!(after.summary.irregular_elements <= before.summary.irregular_elements);
    Ok(())
}
