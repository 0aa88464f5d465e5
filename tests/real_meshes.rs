//! The meshes of the data folder: read, mended to a clean mesh, of the same topology.

mod common;

use common::{MESHES, data_folder, say, shape};
use quadmend::io;
use quadmend::mesh::{MendKind, MendPolicy, PolyMesh, check, mend};
use quadmend::sqrtcc::{lift, lower};

/// Euler characteristic of the cut mesh, boundary loops and doublets, counted by another program;
/// every mesh is one component.
const KNOWN: [(&str, i64, usize, usize); 17] = [
    ("armadillo_im25k", 2, 0, 2),
    ("blub_im6k", 2, 0, 0),
    ("bumpycube_hang", 2, 0, 1),
    ("bunny_im10k", 2, 0, 0),
    ("fandisk_im8k", 2, 0, 0),
    ("featuretype_im6k", -17, 1, 8),
    ("fertility_im12k", -6, 0, 0),
    ("goathead_ml", 2, 0, 0),
    ("koala_im50k", 2, 0, 1),
    ("lilium_gmsh", 1, 1, 0),
    ("mountain_im15k", 1, 1, 0),
    ("penguin_mlpair", 2, 0, 52),
    ("planeholes_im16k", -25, 27, 5),
    ("plate_gmsh", -4, 6, 0),
    ("rockerarm_im20k", 0, 0, 3),
    ("spot_im3k", 2, 0, 0),
    ("wingnut_im4k", 2, 0, 0),
];

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

#[test]
fn counts_are_those_of_another_program() {
    let Some(folder) = data_folder("counts_are_those_of_another_program") else {
        return;
    };
    for (name, chi, loops, doublets) in KNOWN {
        let input = io::read(&folder.join(format!("{name}.obj"))).unwrap().mesh;
        let (output, report) = mend(input, MendPolicy::Mend).unwrap();
        assert_eq!(shape(&output), [(chi, loops)], "{name}");
        assert_eq!(report.count(MendKind::DoubletMerged), doublets, "{name}");
    }
}

/// The faces with each cycle turned so that its smallest vertex comes first.
fn cycles(mesh: &PolyMesh) -> Vec<Vec<u32>> {
    let turned = mesh.faces().map(|face| {
        let start = (0..face.len()).min_by_key(|&i| face[i]).unwrap_or(0);
        (0..face.len()).map(|i| face[(start + i) % face.len()]).collect()
    });
    turned.collect()
}

#[test]
fn lifting_and_lowering_returns_every_polygon() {
    let Some(folder) = data_folder("lifting_and_lowering_returns_every_polygon") else {
        return;
    };
    for name in MESHES {
        let loaded = io::read(&folder.join(format!("{name}.obj"))).unwrap();
        let (mesh, _) = mend(loaded.mesh, MendPolicy::Mend).unwrap();
        let none = fixedbitset::FixedBitSet::with_capacity(mesh.corner_count());
        let q = lift(&mesh, &none).unwrap();
        assert_eq!(q.check(), Ok(()), "{name}");
        assert_eq!(q.index_sum(), 4 * q.euler_characteristic(), "{name}: equation 1");
        let back = lower(&q, mesh.group_names()).unwrap().mesh;
        assert!(cycles(&back) == cycles(&mesh), "{name}: other polygons");
        assert!(back.points() == mesh.points(), "{name}: other points");
    }
}
