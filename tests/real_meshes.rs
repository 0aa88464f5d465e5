//! The meshes of the data folder: read, mended to a clean mesh, of the same topology.

mod common;

use common::{MESHES, data_folder, say, shape};
use quadmend::io;
use quadmend::mesh::{MendPolicy, PolyMesh, check, mend};

/// The components of the cut input and of the output, as a checker counts them.
fn assert_same_shape(name: &str, input: &PolyMesh, output: &PolyMesh) {
    let (mut before, mut after) = (shape(input), shape(output));
    before.sort_unstable();
    after.sort_unstable();
    assert_eq!(before, after, "{name}: Euler characteristic and loops of each component");
}

#[test]
fn all_real_meshes_are_mended_and_keep_their_topology() {
    let Some(folder) = data_folder("all_real_meshes_are_mended_and_keep_their_topology") else {
        return;
    };
    for name in MESHES.iter().flat_map(|m| [(*m).to_owned(), format!("{m}.ref")]) {
        let loaded = io::read(&folder.join(format!("{name}.obj"))).unwrap();
        assert!(loaded.warnings.is_empty(), "{name}: {:?}", loaded.warnings);
        let (output, report) = mend(loaded.mesh.clone(), MendPolicy::Mend).unwrap();
        assert_eq!(check(&output), Ok(()), "{name}");
        for mend in &report.mends {
            say(&format!("{name}: {}", mend.sentence));
        }
        assert_same_shape(&name, &loaded.mesh, &output);
    }
}
