//! Planning on the sample mesh, and on a real mesh where there is one: searching the way of a
//! dislocation, local reductions, growing and filling patches, and cleaning from end to end.

use std::path::{Path, PathBuf};

use criterion::{Criterion, criterion_group, criterion_main};
use quadmend::config::Config;
use quadmend::io;
use quadmend::mesh::{MendPolicy, PolyMesh, Topology, mend};
use quadmend::moves::Dipole;
use quadmend::patch::{Refill, fillings};
use quadmend::pipeline;
use quadmend::planner::clusters::{Clusters, Limits};
use quadmend::planner::cost::CostOptions;
use quadmend::planner::local;
use quadmend::planner::movement::MovementGraph;
use quadmend::sqrtcc::{QuadMesh, Vertex, lift};
use quadmend::surface::{Reference, mesh_features};
use quadmend::watch::Silent;

/// Steps that a search goes.
const REACH: u16 = 16;
/// Dislocations, and patches, that are measured together.
const SEEDS: usize = 50;
const LIMITS: Limits = Limits { faces: 200, partners: 6, least_gain: 1 };

struct Input {
    name: &'static str,
    mesh: PolyMesh,
    reference: PolyMesh,
}

impl Input {
    fn read(name: &'static str, folder: &Path, file: &str) -> Option<Self> {
        let read = |end: &str| Some(io::read(&folder.join(format!("{file}{end}"))).ok()?.mesh);
        Some(Self { name, mesh: read(".obj")?, reference: read(".ref.obj")? })
    }

    /// Mended and lifted with its features, as the pipeline does.
    fn lifted(&self) -> QuadMesh {
        let config = Config::default();
        let (mesh, _) = mend(self.mesh.clone(), MendPolicy::Mend)
            .unwrap_or_else(|e| unreachable!("it can be mended: {e}"));
        let reference =
            Reference::new(&self.reference).unwrap_or_else(|e| unreachable!("a surface: {e}"));
        let features = mesh_features(&mesh, &Topology::new(&mesh), &reference, &config.features);
        lift(&mesh, &features).unwrap_or_else(|e| unreachable!("mended meshes lift: {e}"))
    }
}

/// The sample mesh, and a real one if the folder of real meshes is there.
fn inputs() -> Vec<Input> {
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    let real =
        std::env::var_os("QUADMEND_DATA").map_or_else(|| own.join("../shared/data"), PathBuf::from);
    let sample = Input::read("bracket", &own.join("assets"), "bracket");
    let real = Input::read("bunny", &real, "bunny_im10k");
    sample.into_iter().chain(real).collect()
}

fn irregular(q: &QuadMesh) -> Vec<Vertex> {
    q.vertices().filter(|&v| q.irregularity(v) > 0).collect()
}

fn plan(c: &mut Criterion) {
    for input in inputs() {
        let mut q = input.lifted();
        let mut group = c.benchmark_group(input.name);
        let dipoles: Vec<Dipole> = Dipole::all(&q).take(SEEDS).collect();
        let costs = CostOptions::default();
        group.bench_function(format!("{} movement searches", dipoles.len()), |b| {
            b.iter(|| {
                let mut found = 0;
                for &start in &dipoles {
                    let graph = MovementGraph::new(&mut q, start, REACH, &costs);
                    found += usize::from(graph.search(&[]).is_some());
                }
                found
            });
        });
        let seeds = irregular(&q);
        group.bench_function(format!("local reductions of {}", seeds.len()), |b| {
            b.iter(|| seeds.iter().map(|&v| local::reductions(&mut q, v, 2).len()).sum::<usize>());
        });
        let seeds: Vec<Vertex> = seeds.into_iter().take(SEEDS).collect();
        let mut clusters = Clusters::default();
        group.bench_function(format!("patches around {}", seeds.len()), |b| {
            b.iter(|| seeds.iter().map(|&v| clusters.around(&q, v, LIMITS).len()).sum::<usize>());
        });
        let regions: Vec<_> =
            seeds.iter().flat_map(|&v| clusters.around(&q, v, LIMITS)).take(SEEDS).collect();
        group.bench_function(format!("filling {} patches, undone", regions.len()), |b| {
            b.iter(|| {
                for region in &regions {
                    for filling in fillings(region.rim.len(), &region.corners, 2) {
                        let mark = q.mark();
                        let _ = Refill::new(&q, region, filling).and_then(|r| r.run(&mut q));
                        q.undo_to(mark);
                    }
                }
            });
        });
        group.finish();
    }
}

fn clean(c: &mut Criterion) {
    let config = Config::default();
    let mut group = c.benchmark_group("clean");
    for input in inputs() {
        group.bench_function(input.name, |b| {
            b.iter(|| {
                let (mesh, reference) = (input.mesh.clone(), Some(&input.reference));
                pipeline::clean(mesh, reference, MendPolicy::Mend, &config, &Silent)
                    .map(|cleaned| cleaned.mesh.face_count())
            });
        });
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(10);
    targets = plan, clean
}
criterion_main!(benches);
