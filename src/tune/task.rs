//! What a search is for and where it looks: the file `configs/tune.toml` and its like.

use super::TuneError;
use super::objective::Weights;
use super::space::{Range, Varied};
use serde::{Deserialize, Serialize};
use toml::map::Map;

/// The task that a search has unless it is given another; each key says what it is for.
pub const DEFAULT: &str = include_str!("../../configs/tune.toml");

/// A task.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Task {
    /// What is looked for.
    pub goal: Goal,
    /// What chance depends on.
    pub seed: u32,
    /// Trials that are chosen at once.
    pub generation: usize,
    /// How trials are chosen.
    pub sampler: Sampler,
    /// What counts how much.
    pub weights: Weights,
    /// Knobs by `section.key`, in order, with their ranges.
    pub space: Map<String, toml::Value>,
}

/// What is looked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Goal {
    /// The smallest score.
    Score,
    /// Configurations of which none is better in all measures.
    Pareto,
}

/// How trials are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Sampler {
    /// A tree-structured Parzen estimator.
    Tpe,
    /// Anywhere, equally likely.
    Random,
}

impl Task {
    /// [`DEFAULT`], in which the keys of `text` replace those of the same name; the tables
    /// `weights` key by key, `space` as a whole. `name` is what errors call the text.
    pub fn read(name: &str, text: &str) -> Result<Self, TuneError> {
        let syntax = |e: toml::de::Error| TuneError::Task {
            name: name.to_owned(),
            message: e.to_string().trim_end().to_owned(),
        };
        let mut table: toml::Table = DEFAULT.parse().map_err(syntax)?;
        for (key, value) in text.parse::<toml::Table>().map_err(syntax)? {
            match (table.get_mut(&key), value) {
                (Some(toml::Value::Table(old)), toml::Value::Table(new)) if key == "weights" => {
                    old.extend(new);
                }
                (_, value) => {
                    table.insert(key, value);
                }
            }
        }
        let task: Self = table.try_into().map_err(syntax)?;
        let wrong = |message: &str| {
            Err(TuneError::Task { name: name.to_owned(), message: message.to_owned() })
        };
        if task.generation == 0 {
            return wrong("`generation` must be at least 1");
        }
        if !task.weights.are_legal() {
            return wrong("weights are numbers from 0 on, and one of them must be more than 0");
        }
        Ok(task)
    }

    /// Makes `knobs` the space.
    pub fn vary(&mut self, knobs: &[Varied]) -> Result<(), TuneError> {
        let one = |varied: &Varied| {
            let range = toml::Value::try_from(varied.range).map_err(|e| TuneError::Task {
                name: format!("the range of `{}`", varied.key),
                message: e.to_string(),
            })?;
            Ok((varied.key.clone(), range))
        };
        self.space = knobs.iter().map(one).collect::<Result<_, TuneError>>()?;
        Ok(())
    }

    /// The ranges of the space, in order.
    pub(super) fn ranges(&self) -> Result<Vec<(String, Range)>, TuneError> {
        let one = |(key, value): (&String, &toml::Value)| {
            let range = value.clone().try_into::<Range>().map_err(|e| TuneError::Task {
                name: format!("the range of `{key}`"),
                message: e.message().to_owned(),
            })?;
            Ok((key.clone(), range))
        };
        self.space.iter().map(one).collect()
    }
}

impl Default for Task {
    fn default() -> Self {
        Self::read("configs/tune.toml", "").expect("the file that is built in is a task")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_of_a_file_replace_the_defaults() {
        let text = "seed = 7\n[weights]\nwork = 2\n[space]\n\"cost.step\" = {}";
        let task = Task::read("mine.toml", text).expect("a task");
        assert_eq!((task.seed, task.generation), (7, Task::default().generation));
        assert!((task.weights.work - 2.0).abs() < 1e-12);
        assert!((task.weights.irregular - Task::default().weights.irregular).abs() < 1e-12);
        assert_eq!(task.space.keys().collect::<Vec<_>>(), ["cost.step"]);
    }

    #[test]
    fn what_is_no_task_is_refused() {
        for (text, wanted) in [
            ("sead = 7", "sead"),
            ("goal = \"best\"", "unknown variant"),
            ("generation = 0", "at least 1"),
            ("[weights]\nangle = -1", "from 0 on"),
            ("[weights]\nirregular = 0\nangle = 0\ndistance = 0", "more than 0"),
            ("seed = ", "mine.toml"),
        ] {
            let error = Task::read("mine.toml", text).expect_err(text).to_string();
            assert!(error.contains(wanted), "{text}: {error}");
        }
    }
}
