//! Helpers that several tests share.

// Each test file compiles this module for itself and uses a part of it.
#![allow(dead_code, reason = "every test uses some of it")]

pub(crate) mod browser;
pub(crate) mod lifted;
pub(crate) mod messy;

use std::path::{Path, PathBuf};

use quadmend::mesh::{DisjointSets, NONE, PolyMesh, Topology};

/// The meshes of the data folder, each with its reference surface `NAME.ref.obj` beside it.
pub(crate) const MESHES: [&str; 17] = [
    "armadillo_im25k",
    "blub_im6k",
    "bumpycube_hang",
    "bunny_im10k",
    "fandisk_im8k",
    "featuretype_im6k",
    "fertility_im12k",
    "goathead_ml",
    "koala_im50k",
    "lilium_gmsh",
    "mountain_im15k",
    "penguin_mlpair",
    "planeholes_im16k",
    "plate_gmsh",
    "rockerarm_im20k",
    "spot_im3k",
    "wingnut_im4k",
];

/// The folder of real meshes: `QUADMEND_DATA`, or `shared/data` beside the crate.
///
/// Says so loudly and gives `None` if it is not there; `test` is the name of the test that skips.
pub(crate) fn data_folder(test: &str) -> Option<PathBuf> {
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data");
    let folder = std::env::var_os("QUADMEND_DATA").map_or_else(beside, PathBuf::from);
    if folder.is_dir() {
        return Some(folder);
    }
    say(&format!("SKIPPED: {test}: no meshes at {} (set QUADMEND_DATA)", folder.display()));
    None
}

/// Writes a line that shows even when the test passes and its output is captured.
pub(crate) fn say(line: &str) {
    use std::io::Write;
    // Only the print macros are captured.
    let _ = writeln!(std::io::stderr(), "{line}");
}

/// Euler characteristic, components and boundary loops of the mesh cut at its non-manifold
/// places, component by component in the order of their first faces.
pub(crate) fn census(mesh: &PolyMesh) -> Vec<Component> {
    let topology = Topology::new(mesh);
    let mut faces = DisjointSets::new(mesh.face_count());
    let mut rims = DisjointSets::new(topology.fan_count());
    let mut edges = 0..mesh.corner_count();
    for h in edges.clone() {
        match topology.twin[h] {
            NONE => {
                let after = topology.next[h] as usize;
                rims.join(topology.fan[h] as usize, topology.fan[after] as usize);
            }
            twin => {
                faces.join(topology.face[h] as usize, topology.face[twin as usize] as usize);
            }
        }
    }
    let mut components = vec![Component::default(); mesh.face_count()];
    for f in 0..mesh.face_count() {
        let of = &mut components[faces.root(f)];
        of.faces += 1;
        of.chi += 1;
    }
    for h in edges.by_ref().filter(|&h| topology.twin[h] == NONE || topology.twin[h] as usize > h) {
        components[faces.root(topology.face[h] as usize)].chi -= 1;
    }
    let mut met = vec![false; topology.fan_count()];
    for (c, &fan) in topology.fan.iter().enumerate() {
        if !std::mem::replace(&mut met[fan as usize], true) {
            let of = &mut components[faces.root(topology.face[c] as usize)];
            of.chi += 1;
            let rim = topology.fan_on_boundary[fan as usize];
            of.loops += usize::from(rim && rims.root(fan as usize) == fan as usize);
        }
    }
    components.retain(|c| c.faces > 0);
    components
}

/// Invariants of one component of a surface.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Component {
    /// Number of faces.
    pub(crate) faces: usize,
    /// Euler characteristic.
    pub(crate) chi: i64,
    /// Number of boundary loops.
    pub(crate) loops: usize,
}

/// The Euler characteristics and boundary loops alone, which no mend of a manifold changes.
pub(crate) fn shape(mesh: &PolyMesh) -> Vec<(i64, usize)> {
    census(mesh).iter().map(|c| (c.chi, c.loops)).collect()
}

/// The two ends of an edge, as the bits of their coordinates, the smaller first.
pub(crate) type Segment = [[u64; 3]; 2];

/// The ends of edges, bit for bit, sorted; as often as they occur.
pub(crate) fn segments(
    mesh: &PolyMesh,
    topology: &Topology,
    edges: impl IntoIterator<Item = u32>,
) -> Vec<Segment> {
    let bits = |v: u32| mesh.points()[v as usize].coords.map(f64::to_bits).into();
    let ends = |h: u32| {
        let next = topology.next[h as usize];
        let mut ends: Segment = [h, next].map(|c| bits(mesh.corners()[c as usize]));
        ends.sort_unstable();
        ends
    };
    let mut all: Vec<Segment> = edges.into_iter().map(ends).collect();
    all.sort_unstable();
    all
}
