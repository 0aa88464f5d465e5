//! Which configurations are tried next.
//!
//! A generation of trials is a function of the seed, its number and what came of the trials before
//! it: there is nothing else to save when a search stops. The tree-structured Parzen estimator
//! (Bergstra et al. 2011) is that of the crate `parzen`; a front is found as in `ParEGO` (Knowles
//! 2006): every generation looks for the best in another mixture of the measures.

use super::TuneError;
use super::objective::{QUANTITIES, score, weighted};
use super::task::{Goal, Sampler, Task};
use parzen::{
    Direction, Distribution, FloatDistribution, ParamValue, ParzenError, SearchSpace, Study,
    TpeSampler, TpeSamplerConfig, TrialInput,
};

/// Share of a mixture that is their sum; the rest is the largest, which finds what is in a dent of
/// the front, too.
const SUM: f64 = 0.05;

/// What is made as small as possible, of measures relative to the start.
type Mixture = dyn Fn(&[f64]) -> f64;

/// A trial that is over: where it was in the unit cube, and its measures relative to the start.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Told {
    pub(super) point: Vec<f64>,
    pub(super) ratios: Vec<f64>,
}

/// The points of the unit cube that generation `number`, from 0, tries.
pub(super) fn generation(
    task: &Task,
    dimensions: usize,
    number: usize,
    told: &[Told],
) -> Result<Vec<Vec<f64>>, TuneError> {
    let seed = (u64::from(task.seed) << 32) | number as u64;
    // The estimator chooses at random, too, as long as it knows nothing.
    let told = if task.sampler == Sampler::Random { &[] } else { told };
    let mixture = mixture(task, number);
    chosen(seed, (dimensions, task.generation), told, &mixture).map_err(TuneError::Sampler)
}

fn chosen(
    seed: u64,
    (dimensions, count): (usize, usize),
    told: &[Told],
    value: &Mixture,
) -> Result<Vec<Vec<f64>>, ParzenError> {
    let names: Vec<String> = (0..dimensions).map(|d| d.to_string()).collect();
    let mut space = SearchSpace::new();
    for name in &names {
        space.add(name.as_str(), Distribution::Float(FloatDistribution::linear(0.0, 1.0)?))?;
    }
    let sampler = TpeSampler::new(TpeSamplerConfig::optuna_compatible(seed))?;
    let mut study = Study::new(Direction::Minimize, sampler, space)?;
    for Told { point, ratios } in told {
        let values = point.iter().map(|&u| ParamValue::Float(u));
        let params = names.iter().cloned().zip(values).collect();
        study.add_trial(TrialInput { params, value: value(ratios) })?;
    }
    let mut points = Vec::new();
    for _ in 0..count {
        points.push(names.iter().map(|n| study.suggest_float(n)).collect::<Result<_, _>>()?);
        study.abort_trial();
    }
    Ok(points)
}

/// What generation `number` makes as small as it can.
fn mixture(task: &Task, number: usize) -> Box<Mixture> {
    let weights = task.weights;
    if task.goal == Goal::Score {
        return Box::new(move |ratios| score(ratios, &weights).ln());
    }
    let among = weighted(&weights);
    let shares = shares(among.len(), number);
    Box::new(move |ratios| {
        let parts = among.iter().zip(&shares).map(|(&i, share)| share * ratios[i].ln());
        let (sum, largest) =
            parts.fold((0.0, f64::NEG_INFINITY), |(s, l): (f64, f64), p| (s + p, l.max(p)));
        (1.0 - SUM) * largest + SUM * sum
    })
}

/// Shares of a sum of 1 that go everywhere as `number` grows: gaps between the sorted fractional
/// parts of multiples of irrational numbers.
fn shares(count: usize, number: usize) -> Vec<f64> {
    const STEPS: [f64; QUANTITIES.len() - 1] =
        [0.618_033_988_75, 0.414_213_562_37, 0.732_050_807_57];
    let mut cuts: Vec<f64> = STEPS
        .iter()
        .take(count.saturating_sub(1))
        .map(|step| (step * (number as f64 + 1.0)).fract())
        .chain([0.0, 1.0])
        .collect();
    cuts.sort_by(f64::total_cmp);
    cuts.windows(2).map(|pair| pair[1] - pair[0]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A bowl whose lowest place is (0.3, 0.3, …).
    fn told(points: &[Vec<f64>]) -> Vec<Told> {
        let height = |p: &[f64]| p.iter().map(|u| (u - 0.3).powi(2)).sum::<f64>().exp();
        let one = |p: &Vec<f64>| Told { point: p.clone(), ratios: vec![height(p), 1.0, 1.0, 1.0] };
        points.iter().map(one).collect()
    }

    fn lowest(sampler: Sampler, seed: u32) -> f64 {
        let task = Task { seed, sampler, ..Task::default() };
        let mut points: Vec<Vec<f64>> = Vec::new();
        for number in 0..25 {
            points.extend(generation(&task, 4, number, &told(&points)).expect("points"));
        }
        assert!(points.iter().flatten().all(|u| (0.0..=1.0).contains(u)));
        told(&points).iter().map(|t| t.ratios[0].ln()).fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn the_estimator_goes_deeper_than_chance() {
        let sum = |sampler| (1..=5).map(|seed| lowest(sampler, seed)).sum::<f64>();
        let (tpe, random) = (sum(Sampler::Tpe), sum(Sampler::Random));
        assert!(tpe < 0.5 * random, "{tpe} and {random}");
    }

    #[test]
    fn a_generation_depends_on_its_arguments_only() {
        let task = Task::default();
        let first = generation(&task, 3, 0, &[]).expect("points");
        let again = |number| generation(&task, 3, number, &told(&first)).expect("points");
        assert_eq!(again(1), again(1));
        assert_ne!(again(1), again(2));
        assert_eq!(first.len(), task.generation);
    }

    #[test]
    fn mixtures_sum_to_one_and_go_everywhere() {
        let all: Vec<Vec<f64>> = (0..50).map(|n| shares(2, n)).collect();
        assert!(all.iter().all(|s| (s.iter().sum::<f64>() - 1.0).abs() < 1e-12));
        assert!(all.iter().any(|s| s[0] < 0.05) && all.iter().any(|s| s[0] > 0.95));
    }
}
