//! The knobs that a search turns: each a number between two limits, counted evenly or by ratios.

use super::TuneError;
use super::task::Task;
use crate::config::{Config, ConfigError, explain, section};
use serde::{Deserialize, Serialize};
use std::fmt::Write;
use std::str::FromStr;
use toml::Value;

/// Significant digits of the values that are tried: so files stay readable, and say exactly what
/// was tried.
const DIGITS: usize = 4;

/// Where the values of a knob lie.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Range {
    /// Smallest value, if not that of the declaration.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub low: Option<f64>,
    /// Largest value, if not that of the declaration.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub high: Option<f64>,
    /// Whether ratios count instead of differences.
    pub log: bool,
}

/// A knob and its range, as `section.key`, `section.key=LOW..HIGH` or `section.key=LOW..HIGH,log`.
#[derive(Debug, Clone, PartialEq)]
pub struct Varied {
    /// The knob.
    pub key: String,
    /// Its range.
    pub range: Range,
}

impl FromStr for Varied {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("`{text}` is not KEY, KEY=LOW..HIGH or KEY=LOW..HIGH,log");
        let Some((key, range)) = text.split_once('=') else {
            return Ok(Self { key: text.trim().to_owned(), range: Range::default() });
        };
        let (limits, log) = match range.split_once(',') {
            Some((limits, "log")) => (limits, true),
            Some(_) => return Err(wrong()),
            None => (range, false),
        };
        let (low, high) = limits.split_once("..").ok_or_else(wrong)?;
        let number = |text: &str| text.trim().parse::<f64>().map(Some).map_err(|_| wrong());
        let range = Range { low: number(low)?, high: number(high)?, log };
        Ok(Self { key: key.trim().to_owned(), range })
    }
}

/// A knob with the limits that hold for it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Dimension {
    /// The knob, as `section.key`.
    pub key: String,
    /// Smallest value.
    pub low: f64,
    /// Largest value.
    pub high: f64,
    /// Whether ratios count instead of differences.
    pub log: bool,
    /// Whether the knob takes whole numbers only.
    pub whole: bool,
}

/// All knobs of a search.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Space(pub Vec<Dimension>);

impl Space {
    /// The space of a task; every range is checked against the declaration of its knob.
    pub fn new(task: &Task) -> Result<Self, TuneError> {
        let ranges = task.ranges()?;
        if ranges.is_empty() {
            return Err(TuneError::NoKnob);
        }
        ranges
            .into_iter()
            .map(|(key, range)| Dimension::new(key, range))
            .collect::<Result<_, _>>()
            .map(Self)
    }

    /// The values at a point of the unit cube.
    #[must_use]
    pub fn values(&self, point: &[f64]) -> Vec<f64> {
        self.0.iter().zip(point).map(|(d, &u)| d.value(u)).collect()
    }

    /// The point of the unit cube where the values are, or the nearest to it.
    #[must_use]
    pub fn point(&self, values: &[f64]) -> Vec<f64> {
        self.0.iter().zip(values).map(|(d, &x)| d.share(x)).collect()
    }

    /// The values that a configuration has.
    #[must_use]
    pub fn values_of(&self, config: &Config) -> Vec<f64> {
        self.0.iter().map(|d| d.value_of(config)).collect()
    }

    /// The configuration with these values in place of its own.
    pub fn apply(&self, base: &Config, values: &[f64]) -> Result<Config, ConfigError> {
        self.0.iter().zip(values).try_fold(base.clone(), |config, (dimension, &value)| {
            config.with_assignment(&format!("{}={}", dimension.key, dimension.written(value)))
        })
    }

    /// The values as sections of a configuration file.
    #[must_use]
    pub fn to_toml(&self, values: &[f64]) -> String {
        let mut sections: Vec<(&str, String)> = Vec::new();
        for (dimension, &value) in self.0.iter().zip(values) {
            let (section, key) = dimension.key.split_once('.').unwrap_or_default();
            if !sections.iter().any(|(name, _)| *name == section) {
                sections.push((section, String::new()));
            }
            for (_, lines) in sections.iter_mut().filter(|(name, _)| *name == section) {
                // Writing to a string cannot fail.
                let _ = writeln!(lines, "{key} = {}", dimension.written(value));
            }
        }
        let text = sections.iter().map(|(name, lines)| format!("[{name}]\n{lines}"));
        text.collect::<Vec<_>>().join("\n")
    }
}

impl Dimension {
    fn new(key: String, range: Range) -> Result<Self, TuneError> {
        let default = Config::default();
        let (knob, value) = key
            .split_once('.')
            .and_then(|(name, knob)| {
                let knob = section(name)?.knobs.iter().find(|k| k.name == knob)?;
                Some((knob, default.get(name, knob.name)?))
            })
            .ok_or_else(|| unknown(&key))?;
        let whole = match value {
            Value::Integer(_) => true,
            Value::Float(_) => false,
            _ => return Err(TuneError::NoNumber { key }),
        };
        let (low, high) = (range.low.unwrap_or(knob.min), range.high.unwrap_or(knob.max));
        let legal = knob.min..=knob.max;
        if !(legal.contains(&low) && legal.contains(&high) && low < high) {
            return Err(TuneError::Range { key, low, high, min: knob.min, max: knob.max });
        }
        if range.log && low <= 0.0 {
            return Err(TuneError::LogRange { key, low });
        }
        Ok(Self { key, low, high, log: range.log, whole })
    }

    /// The value at a share of the way from low to high, as it is written.
    fn value(&self, share: f64) -> f64 {
        let value = if self.log {
            self.low * (self.high / self.low).powf(share)
        } else {
            self.low + share * (self.high - self.low)
        };
        let value = if self.whole { value.round() } else { rounded(value) };
        value.clamp(self.low, self.high)
    }

    /// How far from low to high a value is.
    pub(super) fn share(&self, value: f64) -> f64 {
        let value = value.clamp(self.low, self.high);
        let share = if self.log {
            (value / self.low).ln() / (self.high / self.low).ln()
        } else {
            (value - self.low) / (self.high - self.low)
        };
        share.clamp(0.0, 1.0)
    }

    fn value_of(&self, config: &Config) -> f64 {
        let (section, key) = self.key.split_once('.').unwrap_or_default();
        match config.get(section, key) {
            Some(Value::Integer(i)) => i as f64,
            Some(Value::Float(x)) => x,
            _ => self.low,
        }
    }

    /// A value as configuration files say it.
    #[must_use]
    pub fn written(&self, value: f64) -> String {
        if self.whole { format!("{value:.0}") } else { format!("{value:?}") }
    }
}

/// To [`DIGITS`] significant digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.*e}", DIGITS - 1).parse().unwrap_or(value)
}

/// What `config explain` says of a knob that is not there.
fn unknown(key: &str) -> TuneError {
    match explain(key) {
        Err(error) => TuneError::Config(error),
        // A whole section, or a knob without its section.
        Ok(_) => TuneError::NoNumber { key: key.to_owned() },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn space(text: &str) -> Result<Space, TuneError> {
        Space::new(&Task::read("test", &format!("[space]\n{text}"))?)
    }

    #[test]
    fn points_become_values_and_configurations() {
        let space = space(
            "\"cost.step\" = { low = 0.1, high = 10, log = true }\n\"plan.tries\" = { high = 5 }",
        )
        .expect("a space");
        let values = space.values(&[0.5, 0.4]);
        assert_eq!(values, [1.0, 3.0]);
        let config = space.apply(&Config::default(), &values).expect("legal");
        assert_eq!((config.cost.step, config.plan.tries), (1.0, 3));
        assert_eq!(space.values_of(&config), values);
        let back = space.point(&values);
        assert!((back[0] - 0.5).abs() < 1e-9 && (back[1] - 0.5).abs() < 1e-9, "{back:?}");
        let file = space.to_toml(&values);
        assert_eq!(file, "[cost]\nstep = 1.0\n\n[plan]\ntries = 3\n");
        assert_eq!(Config::default().with_text("best", &file).expect("legal"), config);
    }

    #[test]
    fn every_default_range_has_the_default_in_it() {
        let space = Space::new(&Task::default()).expect("a space");
        let values = space.values_of(&Config::default());
        for (dimension, value) in space.0.iter().zip(values) {
            let inside = (dimension.low..=dimension.high).contains(&value);
            assert!(inside, "{} = {value}", dimension.key);
        }
        let section = section("cost").expect("a section");
        for knob in section.knobs {
            let key = format!("cost.{}", knob.name);
            assert!(space.0.iter().any(|d| d.key == key), "{key} is not searched");
        }
    }

    #[test]
    fn wrong_knobs_and_ranges_say_what_is_right() {
        for (text, wanted) in [
            ("\"cost.stepp\" = {}", "did you mean `cost.step`?"),
            ("\"cost\" = {}", "is not a number"),
            ("\"cost.step\" = { low = 5, high = 1 }", "from 0.001 to 100"),
            ("\"cost.step\" = { high = 1000 }", "from 0.001 to 100"),
            ("\"cost.quads\" = { log = true }", "more than 0"),
            ("\"cost.step\" = { lo = 1 }", "unknown field"),
            ("", "no knob"),
        ] {
            let error = space(text).expect_err(text).to_string();
            assert!(error.contains(wanted), "{text}: {error}");
        }
    }

    #[test]
    fn ranges_are_read_from_the_command_line() {
        let read = |text: &str| text.parse::<Varied>();
        let range = Range { low: Some(1.0), high: Some(20.0), log: true };
        assert_eq!(read("plan.tries=1..20,log"), Ok(Varied { key: "plan.tries".into(), range }));
        assert_eq!(read("plan.tries").map(|v| v.range), Ok(Range::default()));
        for text in ["plan.tries=1", "plan.tries=a..b", "plan.tries=1..2,exp"] {
            assert!(read(text).is_err(), "{text}");
        }
    }
}
