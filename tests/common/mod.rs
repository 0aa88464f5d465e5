//! Helpers that several tests share.

// Each test file compiles this module for itself and uses a part of it.
#![allow(dead_code, reason = "every test uses some of it")]

use std::path::{Path, PathBuf};

/// The meshes of the data folder, each with its reference surface `NAME.ref.obj` beside it.
pub const MESHES: [&str; 17] = [
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
pub fn data_folder(test: &str) -> Option<PathBuf> {
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data");
    let folder = std::env::var_os("QUADMEND_DATA").map_or_else(beside, PathBuf::from);
    if folder.is_dir() {
        return Some(folder);
    }
    say(&format!("SKIPPED: {test}: no meshes at {} (set QUADMEND_DATA)", folder.display()));
    None
}

/// Writes a line that shows even when the test passes and its output is captured.
pub fn say(line: &str) {
    use std::io::Write;
    // Only the print macros are captured.
    let _ = writeln!(std::io::stderr(), "{line}");
}
