//! Reading and measuring meshes for `metrics` and `compare`.

use std::path::{Path, PathBuf};

use clap::Args;
use quadmend::metrics::{Metrics, Target, measure};
use quadmend::watch::{Phase, Watch};

use super::failure::Failure;
use super::paths;
use super::settings::{Running, Settings};

/// Against what and how to measure.
#[derive(Debug, Args)]
pub(super) struct Measuring {
    /// Surface to measure distances to, usually the scan that was remeshed (OBJ, - for standard
    /// input) [default: no distances]
    #[arg(short, long, value_name = "MESH")]
    reference: Option<PathBuf>,

    /// Write JSON instead of a table
    #[arg(long)]
    pub(super) json: bool,

    #[command(flatten)]
    settings: Settings,

    #[command(flatten)]
    running: Running,
}

impl Measuring {
    /// Measures the meshes as they are in the files, unmended, in order.
    pub(super) fn measure<F: AsRef<Path>>(&self, files: &[F]) -> Result<Vec<Metrics>, Failure> {
        let inputs: Vec<&Path> =
            files.iter().map(AsRef::as_ref).chain(self.reference.as_deref()).collect();
        paths::read_stdin_once(&inputs)?;
        let options = self.settings.load()?.measure;
        let progress = self.running.start()?;
        let target = self.reference.as_deref().map(|path| {
            let mesh = progress.read(path)?;
            Target::new(&mesh, &options).map_err(|e| Failure::of_file(&paths::shown(path), e))
        });
        let target = target.transpose()?;
        let mut all = Vec::new();
        for (i, path) in files.iter().map(AsRef::as_ref).enumerate() {
            progress.progress(Phase::Measure, i, files.len(), None);
            let mesh = progress.read(path)?;
            let measured = measure(&mesh, target.as_ref());
            all.push(measured.map_err(|e| Failure::of_file(&paths::shown(path), e))?);
        }
        progress.finish();
        Ok(all)
    }
}
