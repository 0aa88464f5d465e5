//! Random messy meshes are cleaned, and every invariant of the result is checked against the input.
//!
//! A few dozen small ones always run; `QUADMEND_SOAK=500` runs so many, and larger ones.

mod common;

use common::messy::Messy;
use common::say;
use quadmend::config::Config;
use quadmend::mesh::MendPolicy;
use quadmend::pipeline;
use quadmend::watch::Silent;
use rayon::prelude::*;

/// How many always run.
const FEW: u64 = 30;

/// What became of one mesh: E before and after, and what is wrong.
struct Outcome {
    e: [u64; 2],
    faults: Vec<String>,
}

fn run(messy: &Messy, config: &Config) -> Outcome {
    let (mesh, reference) = (messy.mesh.clone(), messy.reference.as_ref());
    match pipeline::clean(mesh, reference, MendPolicy::Mend, config, &Silent) {
        Ok(cleaned) => {
            let report = &cleaned.report;
            let e = [&report.before, &report.after].map(|m| m.summary.irregular_elements as u64);
            Outcome { e, faults: messy.faults(&cleaned, config) }
        }
        Err(error) => Outcome { e: [0; 2], faults: vec![format!("{}: {error}", messy.name)] },
    }
}

#[test]
fn random_meshes_become_cleaner_and_keep_every_invariant() {
    let asked = std::env::var("QUADMEND_SOAK").ok().and_then(|n| n.parse().ok());
    let (count, size) = asked.map_or((FEW, 5), |count| (count, 12));
    let mut config = Config::default();
    config.measure.samples = 20_000;
    let outcomes: Vec<Outcome> =
        (0..count).into_par_iter().map(|seed| run(&Messy::new(seed, size), &config)).collect();
    let faults: Vec<&String> = outcomes.iter().flat_map(|o| &o.faults).collect();
    let e = |i: usize| outcomes.iter().map(|o| o.e[i]).sum::<u64>();
    say(&format!("{count} random meshes: E {} -> {}, {} faults", e(0), e(1), faults.len()));
    for fault in &faults {
        say(fault);
    }
    assert!(faults.is_empty(), "{} faults", faults.len());
    assert!(3 * e(1) <= 2 * e(0), "a third of all irregular elements goes at least");
}

#[test]
fn the_preset_for_large_meshes_keeps_every_invariant_for_any_number_of_threads() {
    let messy = Messy::scanned(1, 5000);
    assert!(messy.mesh == Messy::scanned(1, 5000).mesh, "a seed is a mesh");
    let config = Config::preset("fast").expect("a preset");
    let outcome = run(&messy, &config);
    assert!(outcome.faults.is_empty(), "{:?}", outcome.faults);
    let [before, after] = outcome.e;
    say(&format!("{}: E {before} -> {after}", messy.name));
    assert!(before > 100 && 2 * after <= before, "E {before} -> {after}");
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        let (mesh, reference) = (messy.mesh.clone(), messy.reference.as_ref());
        let clean = || pipeline::clean(mesh, reference, MendPolicy::Mend, &config, &Silent);
        pool.install(clean).expect("it was cleaned before").mesh
    };
    assert!(with(1) == with(3), "threads make no difference");
}
