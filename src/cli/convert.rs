//! `quadmend convert`: the same surface as another kind of mesh.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use quadmend::io::Destination;
use quadmend::mesh::{MeshError, PolyMesh, mend};
use quadmend::metrics::table;
use quadmend::pipeline::pure_quad::{Report, pure_quad};
use quadmend::views::{Label, View, catmull_clark, dual, primal, sqrt_cc};
use quadmend::watch::{Phase, Watch};

use super::failure::Failure;
use super::output::MeshFormat;
use super::paths::is_stream;
use super::source::{Begun, Source};
use super::stop::Patience;
use super::{Exit, output, summary};

const EXAMPLES: &str = "\
Examples:
  quadmend convert clean.obj --to pure-quad --reference scan.obj -o quads.obj
  quadmend convert clean.obj --to sqrtcc -o inspect.obj
  quadmend convert inspect.obj --to primal -o again.obj

Pure quads: irregular faces become irregular vertices, in pairs; E stays about the same, less where
pairs cancel. A part of the mesh that is enclosed by an odd number of boundary and feature edges
cannot be all quads: what is left is told, the output is written all the same, and the exit code
is 4. With --set features.crease_deg=180 no feature is kept, and only boundaries can stop it.

Views are for inspection: vertices of the mesh are red, its faces blue, its edges green, and what
would be faces beyond a boundary grey (as colours of the vertices, which Blender and MeshLab show).";

/// Convert a mesh to pure quads, or to a view of its √CC, dual or Catmull-Clark mesh
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Convert {
    /// What to convert it to
    #[arg(long, value_name = "KIND")]
    to: Kind,

    /// Where the result goes (- for standard output); never an input unless --force is given
    #[arg(short, long, value_name = "MESH")]
    output: PathBuf,

    /// For primal: what the first vertex of each component stands for [default: p]
    #[arg(long, value_name = "LABEL")]
    first: Option<First>,

    /// For pure-quad: write the report as JSON (- for standard output) [default: none]
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,

    #[command(flatten)]
    format: MeshFormat,

    #[command(flatten)]
    source: Source,

    #[command(flatten)]
    patience: Patience,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Kind {
    /// Quads only: every irregular face becomes irregular vertices
    PureQuad,
    /// The √CC mesh: a quad for each edge
    Sqrtcc,
    /// The dual: a face for each vertex
    Dual,
    /// One step of subdivision, unsmoothed: a quad for each corner
    CatmullClark,
    /// Back from a √CC mesh
    Primal,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum First {
    /// A vertex
    P,
    /// A face
    D,
}

impl Convert {
    pub(super) fn run(&self) -> Result<Exit, Failure> {
        self.check_arguments()?;
        let destination = self.format.to(&self.output)?;
        let begun = self.source.begin(self.patience.begin()?)?;
        match self.to {
            Kind::PureQuad => self.pure_quad(begun, destination),
            kind => self.view(begun, kind, destination),
        }
    }

    fn check_arguments(&self) -> Result<(), Failure> {
        if self.to != Kind::PureQuad && (self.source.reference.is_some() || self.json.is_some()) {
            return Err(Failure::usage("--reference and --json are for `--to pure-quad` only"));
        }
        if self.to != Kind::Primal && self.first.is_some() {
            return Err(Failure::usage("--first is for `--to primal` only"));
        }
        let json = self.json.as_deref();
        self.source.check_paths(None, Some(&self.output), json.as_slice())
    }

    fn pure_quad(&self, mut begun: Begun, destination: Destination) -> Result<Exit, Failure> {
        let (mesh, surface) = (begun.take_mesh(), begun.surface());
        let converted = pure_quad(mesh, surface, begun.policy, &begun.config, &begun.progress)
            .map_err(|e| self.source.failure(e))?;
        begun.progress.progress(Phase::Write, 0, 1, None);
        destination.write(&converted.mesh)?;
        if let Some(path) = &self.json {
            output::file(path, &output::json(&converted.report)?)?;
        }
        begun.progress.finish();
        self.tell(&converted.report)?;
        Ok(begun.stop.exit(exit(&converted.report)))
    }

    fn tell(&self, report: &Report) -> Result<(), Failure> {
        let conversion = &report.conversion;
        for line in summary::not_quads(conversion) {
            output::note(&line);
        }
        if self.source.quiet() {
            return Ok(());
        }
        for mend in &report.mends.mends {
            output::note(&format!("mended: {}", mend.sentence));
        }
        output::note(&format!(
            "faces divided: {}, pairs converted: {}, operations: {}",
            conversion.divided,
            conversion.pairs,
            conversion.ops.len()
        ));
        let table = table(&[("before", &report.before), ("after", &report.after)]);
        let taken = is_stream(&self.output) || self.json.as_deref().is_some_and(is_stream);
        output::table(&table, taken)
    }

    fn view(&self, begun: Begun, kind: Kind, destination: Destination) -> Result<Exit, Failure> {
        let mesh = begun.input.mesh;
        if kind == Kind::Primal {
            let first = if self.first == Some(First::D) { Label::Face } else { Label::Vertex };
            let mesh = primal(&mesh, first).map_err(|e| self.source.failure(e))?;
            destination.write(&mesh)?;
            return Ok(Exit::Done);
        }
        let (mesh, mends) = mend(mesh, begun.policy).map_err(|e| self.source.failure(e))?;
        for mend in &mends.mends {
            begun.progress.tell(&format!("mended: {}", mend.sentence));
        }
        let View { mesh, labels } = domain(kind)(&mesh).map_err(|e| self.source.failure(e))?;
        let colours: Vec<[f64; 3]> = labels.into_iter().map(Label::colour).collect();
        destination.write_coloured(&mesh, &colours)?;
        Ok(Exit::Done)
    }
}

fn domain(kind: Kind) -> fn(&PolyMesh) -> Result<View, MeshError> {
    match kind {
        Kind::Dual => dual,
        Kind::CatmullClark => catmull_clark,
        _ => sqrt_cc,
    }
}

fn exit(report: &Report) -> Exit {
    let conversion = &report.conversion;
    match (conversion.left.is_empty(), conversion.ops.is_empty()) {
        (false, _) => Exit::LimitMissed,
        (true, true) if report.mends.mends.is_empty() => Exit::NothingToImprove,
        (true, _) => Exit::Done,
    }
}
