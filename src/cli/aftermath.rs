//! What there is to show after cleaning: the mesh before and after, looked at element by element.

use quadmend::config::Config;
use quadmend::elements::Inspection;
use quadmend::io::Loaded;
use quadmend::mesh::PolyMesh;
use quadmend::metrics::Metrics;
use quadmend::pipeline::Cleaned;
use quadmend::report::{Document, Entry, Run, Timing};
use quadmend::surface::Reference;

use super::look::Shown;

/// A mesh that was cleaned, with all that pictures and reports need.
pub(super) struct Aftermath<'a> {
    input: &'a Loaded,
    reference: Option<&'a Loaded>,
    cleaned: &'a Cleaned,
    config: &'a Config,
    /// Before and after.
    inspections: [Inspection; 2],
}

impl<'a> Aftermath<'a> {
    /// Looks at the mesh before and after. Without a reference, the input is what the result is
    /// compared with.
    pub(super) fn new(
        (input, reference): (&'a Loaded, Option<&'a Loaded>),
        cleaned: &'a Cleaned,
        config: &'a Config,
    ) -> Self {
        // It was good enough to be cleaned on, so this does not fail; if it did, only the distances
        // would be missing.
        let surface = Reference::new(&reference.unwrap_or(input).mesh).ok();
        let inspect = |mesh| Inspection::new(mesh, surface.as_ref(), &config.features);
        let inspections = [&input.mesh, &cleaned.mesh].map(inspect);
        Self { input, reference, cleaned, config, inspections }
    }

    /// Before and after, for pictures.
    pub(super) fn pair(&self, names: &[String; 2]) -> [Shown<'_>; 2] {
        let [before, after] = &self.inspections;
        let shown =
            |name: &String, mesh, inspection| Shown { name: name.clone(), mesh, inspection };
        [shown(&names[0], &self.input.mesh, before), shown(&names[1], &self.cleaned.mesh, after)]
    }

    /// The report, given the names and files of the meshes and the file of the reference.
    pub(super) fn html(
        &self,
        (names, files, reference): ([String; 2], [String; 2], Option<String>),
        timings: Vec<Timing>,
    ) -> String {
        let report = &self.cleaned.report;
        let entry = |i: usize, mesh: &'a PolyMesh, metrics: &'a Metrics| Entry {
            name: format!("{}: {}", ["before", "after"][i], names[i]),
            file: files[i].clone(),
            sha256: (i == 0).then(|| self.input.sha256.clone()),
            mesh,
            inspection: &self.inspections[i],
            metrics,
        };
        Document {
            title: format!("{} cleaned", names[0]),
            meshes: vec![
                entry(0, &self.input.mesh, &report.before),
                entry(1, &self.cleaned.mesh, &report.after),
            ],
            reference: reference.zip(self.reference.map(|r| r.sha256.clone())),
            run: Some(Run { report, config: self.config, timings }),
        }
        .html()
    }
}
