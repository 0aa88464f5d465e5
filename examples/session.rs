//! A session as a script: regularise what is irregular, cancel what is near, make pure quads.
//!
//! `cargo run --release --example session`

use quadmend::config::Config;
use quadmend::io::{OBJ, ReadOptions};
use quadmend::mesh::MendPolicy;
use quadmend::script::{Script, edit};
use quadmend::watch::Silent;
use std::error::Error;

const SESSION: &str = r#"
[[step]]                       # disks around irregular elements, those where it helps
do = "regularize"
at = { all = "irregular" }
most = 60

[[step]]                       # dislocations that are left, each with its nearest
do = "cancel-quadruple"
at = { all = "dislocations" }

[[step]]
do = "pure-quad"

[[step]]                       # what was edited has only a rough place so far
do = "smooth"
iterations = 40
"#;

/// Runs the example.
pub(crate) fn main() -> Result<(), Box<dyn Error>> {
    let read = |bytes, name| OBJ.read(bytes, name, &ReadOptions::default());
    let mesh = read(&include_bytes!("../assets/bracket.obj")[..], "bracket.obj")?.mesh;
    let scan = read(&include_bytes!("../assets/bracket.ref.obj")[..], "bracket.ref.obj")?.mesh;
    let script = Script::parse(SESSION, "session.toml")?;
    // Goes on over what is refused; each refusal names its step, the element and the reason.
    let options = (&Config::default(), true);
    let edited = edit(mesh, Some(&scan), MendPolicy::Mend, &script, options, &Silent)?;

    // Each step has told what it did, and E before and after.
    let find = |name: &str| edited.steps.iter().find(|step| step.operation == name);
    let regular = find("regularize").ok_or("it is made")?;
    assert!(regular.after < regular.before / 2, "{}", regular.done);
    assert!(edited.refused.iter().all(|refusal| refusal.operation == "cancel-quadruple"));

    // All quads, but for a face in each part with an odd number of frozen edges around it.
    let quads = find("pure-quad").ok_or("it is made")?;
    let odd = edited.mesh.faces().filter(|face| face.len() != 4).count();
    assert!(odd <= 2, "{}", quads.done);
    Ok(())
}
