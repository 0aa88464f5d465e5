//! `quadmend demo`: the whole pipeline on the sample mesh that the program carries with it.

use std::path::{Path, PathBuf};

use clap::Args;
use quadmend::config::Config;
use quadmend::io::{Loaded, OBJ, ReadOptions, write};
use quadmend::mesh::{MendPolicy, PolyMesh};
use quadmend::pipeline::{Cleaned, clean};

use super::aftermath::Aftermath;
use super::failure::Failure;
use super::settings::Running;
use super::stop::Stop;
use super::{Exit, output, summary};

/// The mesh to be cleaned; `assets/README.md` says how it was made.
const SAMPLE: &[u8] = include_bytes!("../../assets/bracket.obj");
/// The surface that it was made from.
const REFERENCE: &[u8] = include_bytes!("../../assets/bracket.ref.obj");

const FILES: &str = "\
Files:
  input.obj       the sample: a bracket as Instant Meshes leaves it
  reference.obj   the surface that it was made from
  clean.obj       the cleaned mesh
  report.html     both meshes in 3D, heat maps, every edit: open it in a browser
  report.json     metrics before and after, mends, every edit
  report.txt      the table that is also shown";

/// Clean the sample mesh, and leave it with a report before/after in a folder
#[derive(Debug, Args)]
#[command(after_help = FILES)]
pub(super) struct Demo {
    /// Folder for the files; made if it is not there, files of an earlier demo are replaced
    #[arg(short, long, value_name = "DIR", default_value = "quadmend-demo")]
    output: PathBuf,

    #[command(flatten)]
    running: Running,
}

impl Demo {
    pub(super) fn run(&self) -> Result<Exit, Failure> {
        output::folder(&self.output)?;
        let progress = self.running.start(Stop::default())?;
        let (mesh, reference) = (embedded(SAMPLE)?, embedded(REFERENCE)?);
        let config = Config::default();
        let surface = Some(&reference.mesh);
        let cleaned = clean(mesh.mesh.clone(), surface, MendPolicy::Mend, &config, &progress)?;
        self.write(&mesh.mesh, &reference.mesh, &cleaned)?;
        let shown = Aftermath::new((&mesh, Some(&reference)), &cleaned, &config);
        let names = ["input.obj", "clean.obj"].map(str::to_owned);
        let files = (names.clone(), names, Some("reference.obj".to_owned()));
        output::file(&self.file("report.html"), &shown.html(files, progress.timings()))?;
        progress.finish();
        if !self.running.quiet {
            output::data(&self.tell(&cleaned))?;
        }
        Ok(Exit::Done)
    }

    fn write(
        &self,
        mesh: &PolyMesh,
        reference: &PolyMesh,
        cleaned: &Cleaned,
    ) -> Result<(), Failure> {
        write(&self.file("input.obj"), mesh)?;
        write(&self.file("reference.obj"), reference)?;
        write(&self.file("clean.obj"), &cleaned.mesh)?;
        output::file(&self.file("report.json"), &output::json(&cleaned.report)?)?;
        output::file(&self.file("report.txt"), &summary::text(&cleaned.report))
    }

    fn tell(&self, cleaned: &Cleaned) -> String {
        let files = ["input", "clean", "reference"].map(|f| self.shown(&format!("{f}.obj")));
        let [input, clean, reference] = files;
        let reports = ["html", "txt", "json"].map(|f| self.shown(&format!("report.{f}")));
        format!(
            "{}\nbefore      {input}\nafter       {clean}\nreference   {reference}\n\
             report      {}\n",
            summary::text(&cleaned.report),
            reports.join(", ")
        )
    }

    fn file(&self, name: &str) -> PathBuf {
        self.output.join(name)
    }

    fn shown(&self, name: &str) -> String {
        Path::new(&self.output).join(name).display().to_string()
    }
}

fn embedded(bytes: &[u8]) -> Result<Loaded, Failure> {
    Ok(OBJ.read(bytes, "embedded sample", &ReadOptions::default())?)
}
