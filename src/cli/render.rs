//! `quadmend render`: pictures of meshes.

use std::path::{Path, PathBuf};

use clap::Args;
use quadmend::elements::Inspection;
use quadmend::mesh::PolyMesh;
use quadmend::surface::Reference;
use quadmend::watch::{Phase, Watch};

use super::failure::Failure;
use super::look::{Look, Shown};
use super::paths::{self, Files};
use super::settings::{Running, Settings};
use super::stop::Stop;
use super::{Exit, output};

const EXAMPLES: &str = "\
Examples:
  quadmend render remesh.obj -o remesh.png
  quadmend render remesh.obj clean.obj -o both.png --view corner --view back
  quadmend render clean.obj -r scan.obj --heat distance -o distance.png --up z

Blue is a vertex or face with fewer than four edges, yellow one with more; a red ring marks a
T-junction. All views of a picture have the same scale. The same input gives the same bytes.";

/// Draw meshes as a PNG picture: irregular elements, or a heat map of their quality
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Render {
    /// The meshes to draw, side by side (OBJ, PLY or OFF, - for standard input)
    #[arg(required = true)]
    meshes: Vec<PathBuf>,

    /// Where the picture goes (PNG, - for standard output)
    #[arg(short, long, value_name = "PICTURE")]
    output: PathBuf,

    /// Surface that the meshes were made from: its creases are the sharp features, and distances
    /// are those to it (OBJ, PLY, OFF or STL, - for standard input) [default: creases of each mesh
    /// itself]
    #[arg(short, long, value_name = "MESH")]
    reference: Option<PathBuf>,

    /// Allow the picture to replace an input
    #[arg(long)]
    force: bool,

    #[command(flatten)]
    look: Look,

    #[command(flatten)]
    settings: Settings,

    #[command(flatten)]
    running: Running,
}

impl Render {
    pub(super) fn run(&self) -> Result<Exit, Failure> {
        self.check_paths()?;
        let config = self.settings.load()?;
        let progress = self.running.start(Stop::default())?;
        progress.progress(Phase::Read, 0, 1, None);
        let read = |path: &PathBuf| Ok(progress.load(path, &config.read)?.mesh);
        let meshes: Vec<PolyMesh> = self.meshes.iter().map(read).collect::<Result<_, Failure>>()?;
        let reference = self.reference.as_ref().map(|path| {
            let mesh = read(path)?;
            Reference::new(&mesh).map_err(|e| Failure::of_file(&paths::shown(path), e))
        });
        let reference = reference.transpose()?;
        let inspect = |mesh| Inspection::new(mesh, reference.as_ref(), &config.features);
        let inspections: Vec<Inspection> = meshes.iter().map(inspect).collect();
        let names = paths::names(&self.meshes);
        let shown: Vec<Shown> = names
            .into_iter()
            .zip(meshes.iter().zip(&inspections))
            .map(|(name, (mesh, inspection))| Shown { name, mesh, inspection })
            .collect();
        let image =
            self.look.draw(&shown, &self.look.views_or(&["corner"]), self.look.range(&shown))?;
        progress.progress(Phase::Write, 0, 1, None);
        output::picture(&self.output, &image)?;
        progress.finish();
        Ok(Exit::Done)
    }

    fn check_paths(&self) -> Result<(), Failure> {
        if self.look.heat.as_deref() == Some("distance") && self.reference.is_none() {
            return Err(Failure::usage("--heat distance needs a --reference to be distant from"));
        }
        let meshes: Vec<&Path> =
            self.meshes.iter().chain(&self.reference).map(PathBuf::as_path).collect();
        let (texts, others) = (self.settings.config.as_deref(), [self.output.as_path()]);
        let texts = texts.as_slice();
        Files { meshes: &meshes, texts, output: None, others: &others, force: self.force }.check()
    }
}
