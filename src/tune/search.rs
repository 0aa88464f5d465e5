//! The search: generation after generation of trials.

use super::choice::{Told, generation};
use super::journal::{Head, Journal, Trial};
use super::objective::{Measures, front, ratios, score, weighted};
use super::space::Space;
use super::task::Task;
use super::{Case, TuneError};
use crate::config::Config;
use crate::mesh::{MendPolicy, PolyMesh};
use crate::metrics::{Summary, Target, measure};
use crate::pipeline::plan;
use crate::planner::schedule::RoundRecord;
use crate::watch::Silent;
use fanova::{FanovaOptions, RandomForestOptions};
use rayon::prelude::*;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// Fewest trials from which a forest can learn which knobs matter.
const FEWEST: usize = 10;

/// Follows a search.
pub trait Observer: Sync {
    /// A trial is over: its number, its score, and the number of all that are over.
    fn trial(&self, number: usize, score: f64, done: usize);

    /// A generation is over.
    fn generation(&self, findings: &Findings) {
        let _ = findings;
    }

    /// Whether to begin no more trials.
    fn enough(&self) -> bool;
}

/// A trial and what it is worth.
#[derive(Debug, Clone, PartialEq)]
pub struct Judged {
    /// The trial.
    pub trial: Trial,
    /// Each of the measures relative to the start, over all meshes.
    pub ratios: Vec<f64>,
    /// The weighted mean of them.
    pub score: f64,
    /// Whether no other trial is better in all weighted measures.
    pub on_front: bool,
}

/// What a search has found.
#[derive(Debug, Clone)]
pub struct Findings {
    /// What was searched.
    pub task: Task,
    /// The knobs.
    pub space: Space,
    /// Where it started.
    pub start: Config,
    /// Names of the meshes.
    pub meshes: Vec<String>,
    /// The trials by number; never empty.
    pub trials: Vec<Judged>,
    /// How much of the variance of the score each knob explains alone, if that can be said yet.
    pub importance: Option<Vec<f64>>,
}

impl Findings {
    /// The trial with the smallest score, the first of them.
    #[must_use]
    pub fn best(&self) -> &Judged {
        let first = &self.trials[0];
        self.trials.iter().fold(first, |best, t| if t.score < best.score { t } else { best })
    }

    /// The trials of the front, from few irregular elements to many; of equal ones the first.
    #[must_use]
    pub fn front(&self) -> Vec<&Judged> {
        let among = weighted(&self.task.weights);
        let key = |t: &Judged| among.iter().map(|&i| t.ratios[i]).collect::<Vec<f64>>();
        let mut front: Vec<&Judged> = self.trials.iter().filter(|t| t.on_front).collect();
        front.sort_by(|a, b| {
            let order = key(a).iter().zip(&key(b)).map(|(x, y)| x.total_cmp(y)).find(|o| o.is_ne());
            order.unwrap_or_else(|| a.trial.number.cmp(&b.trial.number))
        });
        front.dedup_by_key(|t| key(t));
        front
    }

    /// The configuration of a trial.
    pub fn config(&self, judged: &Judged) -> Result<Config, TuneError> {
        configured(&self.space, &self.start, &judged.trial)
    }
}

/// Trial 0 is the start as it is, whatever the ranges are.
fn configured(space: &Space, start: &Config, trial: &Trial) -> Result<Config, TuneError> {
    if trial.number == 0 { Ok(start.clone()) } else { Ok(space.apply(start, &trial.values)?) }
}

/// Searches for `task` from `start` on until `trials` trials beside the start are over or
/// `observer` has enough; those that `journal` holds count. The findings are the same for any
/// number of threads and however often the search was interrupted.
pub fn search(
    (task, start): (&Task, &Config),
    cases: &[Case],
    trials: usize,
    journal: &Path,
    observer: &dyn Observer,
) -> Result<Findings, TuneError> {
    let space = Space::new(task)?;
    if cases.is_empty() {
        return Err(TuneError::NoMesh);
    }
    let head = Head::new(task, &space, start, cases);
    let journal = Journal::open(journal, &head)?;
    let targets = cases.iter().map(|case| target(case, start)).collect::<Result<_, _>>()?;
    let mut search = Search {
        findings: Findings {
            task: task.clone(),
            meshes: cases.iter().map(|c| c.file.clone()).collect(),
            start: start.clone(),
            trials: Vec::new(),
            importance: None,
            space,
        },
        cases,
        targets,
        journal: Mutex::new(journal),
        observer,
    };
    search.run(trials)?;
    search.findings.importance = importance(&search.findings);
    Ok(search.findings)
}

fn target(case: &Case, config: &Config) -> Result<Target, TuneError> {
    let surface: &PolyMesh = case.reference.as_ref().unwrap_or(&case.mesh);
    let wrong = |source| TuneError::Measure { file: case.file.clone(), source };
    Target::new(surface, &config.measure).map_err(wrong)
}

struct Search<'a> {
    findings: Findings,
    cases: &'a [Case],
    targets: Vec<Target>,
    journal: Mutex<Journal>,
    observer: &'a dyn Observer,
}

impl Search<'_> {
    fn run(&mut self, trials: usize) -> Result<(), TuneError> {
        // Without the start there is nothing to compare with: it is always run.
        let values = self.findings.space.values_of(&self.findings.start);
        self.try_all(vec![(0, values)], true)?;
        let size = self.findings.task.generation;
        for number in 0..trials.div_ceil(size) {
            let told: Vec<Told> = self.findings.trials.iter().map(|t| self.told(t)).collect();
            let (task, space) = (&self.findings.task, &self.findings.space);
            let points = generation(task, space.0.len(), number, &told)?;
            let values = points.iter().map(|p| space.values(p));
            let numbered = (1 + number * size..=trials).zip(values).collect();
            if !self.try_all(numbered, false)? {
                break;
            }
            self.observer.generation(&self.findings);
        }
        Ok(())
    }

    fn told(&self, judged: &Judged) -> Told {
        let point = self.findings.space.point(&judged.trial.values);
        Told { point, ratios: judged.ratios.clone() }
    }

    /// Runs those trials that the journal does not hold, and takes all in; whether none is missing.
    fn try_all(&mut self, trials: Vec<(usize, Vec<f64>)>, always: bool) -> Result<bool, TuneError> {
        let count = trials.len();
        let ended: Vec<Option<Trial>> = trials
            .into_par_iter()
            .map(|(number, values)| {
                if let Some(known) = self.journal().trials.get(&number) {
                    return Ok(Some(known.clone()));
                }
                if !always && self.observer.enough() {
                    return Ok(None);
                }
                self.run_trial(number, values).map(Some)
            })
            .collect::<Result<_, TuneError>>()?;
        let ended: Vec<Trial> = ended.into_iter().flatten().collect();
        let whole = ended.len() == count;
        self.take_in(ended);
        Ok(whole)
    }

    fn run_trial(&self, number: usize, values: Vec<f64>) -> Result<Trial, TuneError> {
        let mut trial = Trial { number, values, measures: Vec::new() };
        let config = configured(&self.findings.space, &self.findings.start, &trial)?;
        let pairs = self.cases.par_iter().zip(&self.targets);
        trial.measures = pairs
            .map(|(case, target)| measures(case, target, &config))
            .collect::<Result<_, _>>()?;
        self.journal().add(trial.clone())?;
        let start = self.findings.trials.first().map(|t| &t.trial.measures);
        let ratios = ratios(&trial.measures, start.unwrap_or(&trial.measures));
        let done = self.journal().trials.len();
        self.observer.trial(number, score(&ratios, &self.findings.task.weights), done);
        Ok(trial)
    }

    fn take_in(&mut self, ended: Vec<Trial>) {
        let findings = &mut self.findings;
        for trial in ended {
            let start = findings.trials.first().map_or(&trial.measures, |t| &t.trial.measures);
            let ratios = ratios(&trial.measures, start);
            let score = score(&ratios, &findings.task.weights);
            findings.trials.push(Judged { trial, ratios, score, on_front: false });
        }
        let points: Vec<Vec<f64>> = findings.trials.iter().map(|t| t.ratios.clone()).collect();
        let on_front = front(&points, &weighted(&findings.task.weights));
        for (judged, on_front) in findings.trials.iter_mut().zip(on_front) {
            judged.on_front = on_front;
        }
    }

    /// A thread that panicked while it wrote a line left at most that line half done.
    fn journal(&self) -> std::sync::MutexGuard<'_, Journal> {
        self.journal.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Cleans a mesh with a configuration and measures what comes of it.
fn measures(case: &Case, target: &Target, config: &Config) -> Result<Measures, TuneError> {
    let wrong = |source| TuneError::Mesh { file: case.file.clone(), source };
    let (mesh, reference) = (case.mesh.clone(), case.reference.as_ref());
    let planned = plan(mesh, reference, MendPolicy::Mend, config, &Silent).map_err(wrong)?;
    let wrong = |source| TuneError::Measure { file: case.file.clone(), source };
    let metrics = measure(&planned.mesh, Some(target)).map_err(wrong)?;
    let Summary { irregular_elements, fig10_mean, rms, .. } = metrics.summary;
    Ok(Measures {
        irregular: irregular_elements as f64,
        angle_deg: fig10_mean.unwrap_or_default(),
        distance_rel: rms.unwrap_or_default(),
        work: planned.rounds.iter().map(judged_edits).sum::<usize>() as f64,
    })
}

fn judged_edits(round: &RoundRecord) -> usize {
    round.proposed + round.turned_down.values().sum::<usize>()
}

/// Which knobs matter: the shares of the variance of the logarithm of the score that they explain
/// alone (functional ANOVA of a random forest; Hutter et al. 2014).
fn importance(findings: &Findings) -> Option<Vec<f64>> {
    let trials = &findings.trials;
    if trials.len() < FEWEST {
        return None;
    }
    let scores: Vec<f64> = trials.iter().map(|t| t.score.ln()).collect();
    let points: Vec<Vec<f64>> =
        trials.iter().map(|t| findings.space.point(&t.trial.values)).collect();
    let columns: Vec<Vec<f64>> =
        (0..findings.space.0.len()).map(|d| points.iter().map(|p| p[d]).collect()).collect();
    let forest = RandomForestOptions::new().seed(u64::from(findings.task.seed));
    let options = FanovaOptions::new().random_forest(forest);
    let features = columns.iter().map(Vec::as_slice).collect();
    let mut fanova = options.fit(features, &scores).ok()?;
    let share = |d| fanova.quantify_importance(&[d]).mean;
    let shares: Vec<f64> = (0..columns.len()).map(share).collect();
    shares.iter().all(|s| s.is_finite()).then_some(shares)
}
