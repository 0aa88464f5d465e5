//! Reading and measuring meshes for `metrics` and `compare`.

use std::path::{Path, PathBuf};

use clap::Args;
use quadmend::config::Config;
use quadmend::io::Loaded;
use quadmend::metrics::{Metrics, Target, measure};
use quadmend::watch::{Phase, Watch};

use super::failure::Failure;
use super::paths;
use super::settings::{Running, Settings};
use super::stop::Stop;

/// Against what and how to measure.
#[derive(Debug, Args)]
pub(super) struct Measuring {
    /// Surface to measure distances to, usually the scan that was remeshed (OBJ, PLY, OFF or STL, -
    /// for standard input) [default: no distances]
    #[arg(short, long, value_name = "MESH")]
    pub(super) reference: Option<PathBuf>,

    /// Write JSON instead of a table
    #[arg(long)]
    pub(super) json: bool,

    #[command(flatten)]
    pub(super) settings: Settings,

    #[command(flatten)]
    running: Running,
}

/// A mesh and what was measured.
#[derive(Debug)]
pub(super) struct Measured {
    pub(super) loaded: Loaded,
    pub(super) metrics: Metrics,
}

/// All meshes, and what they were measured against.
#[derive(Debug)]
pub(super) struct Measurements {
    pub(super) meshes: Vec<Measured>,
    pub(super) reference: Option<Loaded>,
    pub(super) config: Config,
}

impl Measuring {
    /// Measures the meshes as they are in the files, unmended, in order.
    pub(super) fn measure<F: AsRef<Path>>(&self, files: &[F]) -> Result<Measurements, Failure> {
        let inputs: Vec<&Path> =
            files.iter().map(AsRef::as_ref).chain(self.reference.as_deref()).collect();
        paths::read_stdin_once(&inputs)?;
        let config = self.settings.load()?;
        let progress = self.running.start(Stop::default())?;
        let reference =
            self.reference.as_deref().map(|path| progress.load(path, &config.read)).transpose()?;
        let target = self.target(reference.as_ref(), &config)?;
        let mut meshes = Vec::new();
        for (i, path) in files.iter().map(AsRef::as_ref).enumerate() {
            progress.progress(Phase::Measure, i, files.len(), None);
            let loaded = progress.load(path, &config.read)?;
            let metrics = measure(&loaded.mesh, target.as_ref());
            let metrics = metrics.map_err(|e| Failure::of_file(&paths::shown(path), e))?;
            meshes.push(Measured { loaded, metrics });
        }
        progress.finish();
        Ok(Measurements { meshes, reference, config })
    }

    fn target(&self, mesh: Option<&Loaded>, config: &Config) -> Result<Option<Target>, Failure> {
        let (Some(loaded), Some(path)) = (mesh, self.reference.as_deref()) else { return Ok(None) };
        let target = Target::new(&loaded.mesh, &config.measure);
        target.map(Some).map_err(|e| Failure::of_file(&paths::shown(path), e))
    }
}
