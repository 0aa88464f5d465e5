//! What a command that changes a mesh starts from, and how it begins.

use std::path::{Path, PathBuf};

use clap::Args;
use quadmend::config::Config;
use quadmend::io::{self, Loaded};
use quadmend::mesh::{MendPolicy, PolyMesh};
use quadmend::watch::{Phase, Watch};

use super::failure::Failure;
use super::paths::{self, Files};
use super::progress::Progress;
use super::settings::{Running, Settings};
use super::stop::Stop;

/// A mesh, the surface that it stays on, and the settings.
#[derive(Debug, Args)]
pub(super) struct Source {
    /// The mesh, polygons of any degree (OBJ, PLY or OFF, - for standard input)
    pub(super) input: PathBuf,

    /// Surface to stay on, usually the scan that was remeshed, in the same position and scale
    /// (OBJ, PLY, OFF or STL, - for standard input) [default: the input]
    #[arg(short, long, value_name = "MESH")]
    pub(super) reference: Option<PathBuf>,

    /// Refuse a mesh that has anything to mend, instead of mending it [default: mend and tell]
    #[arg(long)]
    strict: bool,

    /// Allow an output to replace an input
    #[arg(long)]
    force: bool,

    #[command(flatten)]
    settings: Settings,

    #[command(flatten)]
    running: Running,
}

/// What has been read when the work begins.
pub(super) struct Begun {
    pub(super) progress: Progress,
    pub(super) config: Config,
    pub(super) input: Loaded,
    pub(super) reference: Option<Loaded>,
    pub(super) policy: MendPolicy,
    pub(super) stop: Stop,
}

impl Begun {
    /// The mesh, which is not kept: a large one is a large part of what there is room for.
    pub(super) fn take_mesh(&mut self) -> PolyMesh {
        std::mem::take(&mut self.input.mesh)
    }

    /// The surface to stay on, if it is not the input.
    pub(super) fn surface(&self) -> Option<&PolyMesh> {
        self.reference.as_ref().map(|loaded| &loaded.mesh)
    }
}

impl Source {
    /// Reads the configuration, the mesh and its reference for a run that may be told to `stop`.
    pub(super) fn begin(&self, stop: Stop) -> Result<Begun, Failure> {
        let config = self.settings.load()?;
        let progress = self.running.start(stop)?;
        progress.progress(Phase::Read, 0, 1, None);
        let read = |path: &Path| io::read_within(path, &config.read);
        let (input, reference) =
            rayon::join(|| read(&self.input), || self.reference.as_deref().map(read));
        // Told in this order whichever was read first.
        let input = progress.warned(input?);
        let reference = reference.transpose()?.map(|loaded| progress.warned(loaded));
        let policy = if self.strict { MendPolicy::Strict } else { MendPolicy::Mend };
        Ok(Begun { progress, config, input, reference, policy, stop })
    }

    /// Finds what is wrong with the files of a command before the work is done: `script` is read
    /// besides the meshes, the mesh goes to `output`, reports go to `others`.
    pub(super) fn check_paths(
        &self,
        script: Option<&Path>,
        output: Option<&Path>,
        others: &[&Path],
    ) -> Result<(), Failure> {
        let meshes: Vec<&Path> =
            std::iter::once(&*self.input).chain(self.reference.as_deref()).collect();
        let texts: Vec<&Path> = script.into_iter().chain(self.settings.config.as_deref()).collect();
        Files { meshes: &meshes, texts: &texts, output, others, force: self.force }.check()
    }

    /// Whether only errors are to be shown.
    pub(super) fn quiet(&self) -> bool {
        self.running.quiet
    }

    /// What is wrong with the input.
    pub(super) fn failure(&self, error: impl std::error::Error + Send + Sync + 'static) -> Failure {
        Failure::of_file(&paths::shown(&self.input), error)
    }
}
