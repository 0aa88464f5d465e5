//! One source of values: which knobs it sets, to what, and where it says so.

use super::nearest::{edit_distance, nearest};
use super::{ConfigError, IllegalValue, Origin, SECTIONS, section};
use crate::knobs::Knob;
use toml::de::{DeTable, DeValue};
use toml::{Spanned, Table, Value};

/// Values in the order of their text.
#[derive(Debug)]
pub(super) struct Layer {
    pub(super) entries: Vec<Entry>,
    file: Option<String>,
}

/// One value, not checked yet.
#[derive(Debug)]
pub(super) struct Entry {
    pub(super) section: String,
    pub(super) key: String,
    /// As it was written.
    text: String,
    origin: Origin,
}

impl Layer {
    /// The values of a preset.
    pub(super) fn from_preset(name: &str, text: &str) -> Result<Self, ConfigError> {
        Self::from_file(&format!("preset {name}"), text)
    }

    /// The values of a file; `name` is what errors call it.
    pub(super) fn from_file(name: &str, text: &str) -> Result<Self, ConfigError> {
        let source = Source { name, text };
        let root = DeTable::parse(text).map_err(|e| source.syntax(&e))?;
        let mut entries = Vec::new();
        for (section, values) in root.get_ref() {
            source.add_section(section, values, &mut entries)?;
        }
        Ok(Self { entries, file: Some(name.to_owned()) })
    }

    /// The one value of `section.key=value`.
    pub(super) fn from_assignment(text: &str) -> Result<Self, ConfigError> {
        let split =
            text.split_once('=').and_then(|(key, value)| Some((key.split_once('.')?, value)));
        let Some(((section, key), value)) = split else {
            return Err(ConfigError::NotAnAssignment { text: text.to_owned() });
        };
        let [section, key, value] = [section, key, value].map(|s| s.trim().to_owned());
        let origin = Origin::Assignment(text.to_owned());
        if super::section(&section).is_none() {
            return Err(unknown_section(origin, &section));
        }
        Ok(Self { entries: vec![Entry { section, key, text: value, origin }], file: None })
    }

    /// Where the layer as a whole comes from.
    pub(super) fn origin(&self) -> Origin {
        match (&self.file, self.entries.first()) {
            (None, Some(entry)) => entry.origin.clone(),
            (file, _) => Origin::Line { file: file.clone().unwrap_or_default(), line: 1 },
        }
    }
}

/// A text and what errors call it.
struct Source<'a> {
    name: &'a str,
    text: &'a str,
}

impl Source<'_> {
    fn add_section(
        &self,
        name: &Spanned<impl AsRef<str>>,
        values: &Spanned<DeValue>,
        entries: &mut Vec<Entry>,
    ) -> Result<(), ConfigError> {
        let (origin, section) = (self.line(name.span().start), name.get_ref().as_ref());
        let DeValue::Table(table) = values.get_ref() else {
            return Err(unknown_section(origin, section));
        };
        if super::section(section).is_none() {
            return Err(unknown_section(origin, section));
        }
        for (key, value) in table {
            entries.push(Entry {
                section: section.to_owned(),
                key: key.get_ref().to_string(),
                text: self.text.get(value.span()).unwrap_or_default().to_owned(),
                origin: self.line(key.span().start),
            });
        }
        Ok(())
    }

    fn line(&self, at: usize) -> Origin {
        let before = self.text.bytes().take(at);
        let line = 1 + before.filter(|&b| b == b'\n').count();
        Origin::Line { file: self.name.to_owned(), line }
    }

    fn syntax(&self, error: &toml::de::Error) -> ConfigError {
        let at = error.span().map_or(0, |span| span.start);
        ConfigError::Syntax { origin: self.line(at), message: error.message().to_owned() }
    }
}

impl Entry {
    /// The value, if the knob exists and takes it. `present` holds a legal value of each knob.
    pub(super) fn checked(&self, present: &Table) -> Result<Value, ConfigError> {
        let knobs = section(&self.section).map_or(&[][..], |s| s.knobs);
        let knob = knobs.iter().find(|k| k.name == self.key).ok_or_else(|| self.unknown_key())?;
        let like = present.get(&self.section).and_then(|s| s.get(&self.key));
        let like = like.ok_or_else(|| self.unknown_key())?;
        let value = self.text.parse::<Value>().ok().and_then(|v| converted(v, like));
        let value = value.ok_or_else(|| self.wrong_type(knob, like))?;
        for number in numbers(&value) {
            if !(knob.min..=knob.max).contains(&number) {
                return Err(self.out_of_range(knob, like, number));
            }
        }
        Ok(value)
    }

    fn full_key(&self) -> String {
        format!("{}.{}", self.section, self.key)
    }

    fn unknown_key(&self) -> ConfigError {
        ConfigError::UnknownKey {
            origin: self.origin.clone(),
            section: self.section.clone(),
            key: self.key.clone(),
            nearest: nearest_knob(Some(&self.section), &self.key).unwrap_or_default(),
        }
    }

    fn wrong_type(&self, knob: &Knob, like: &Value) -> ConfigError {
        ConfigError::WrongType(Box::new(self.illegal(knob, like, like.to_string())))
    }

    fn out_of_range(&self, knob: &Knob, like: &Value, number: f64) -> ConfigError {
        // NaN is no nearer to one end than to the other.
        let nearest = if number > knob.max { knob.max } else { knob.min };
        ConfigError::OutOfRange(Box::new(self.illegal(knob, like, nearest.to_string())))
    }

    fn illegal(&self, knob: &Knob, like: &Value, nearest: String) -> IllegalValue {
        IllegalValue {
            origin: self.origin.clone(),
            key: self.full_key(),
            value: self.text.clone(),
            expected: expected(knob, like),
            nearest,
        }
    }
}

/// The most similar knob, with its section; in other sections it must be more similar to win.
pub(super) fn nearest_knob(section: Option<&str>, key: &str) -> Option<String> {
    let all = SECTIONS.iter().flat_map(|s| s.knobs.iter().map(move |k| (s.name, k.name)));
    let away = |name: &str| usize::from(section.is_some_and(|s| s != name));
    let best = all.min_by_key(|(s, k)| 2 * edit_distance(key, k) + 3 * away(s));
    best.map(|(s, k)| format!("{s}.{k}"))
}

/// What a knob takes: kind, range and unit.
pub(super) fn expected(knob: &Knob, like: &Value) -> String {
    let range = format!("{} to {}", knob.min, knob.max);
    let unit = if knob.unit.is_empty() { String::new() } else { format!(" ({})", knob.unit) };
    match like {
        Value::Boolean(_) => "true or false".to_owned(),
        Value::Integer(_) => format!("a whole number from {range}{unit}"),
        Value::Array(_) => format!("a list of numbers from {range}{unit}"),
        _ => format!("a number from {range}{unit}"),
    }
}

fn unknown_section(origin: Origin, name: &str) -> ConfigError {
    let sections = || SECTIONS.iter().map(|s| s.name);
    // A knob written without its section is the likelier slip.
    let is_knob = SECTIONS.iter().any(|s| s.knobs.iter().any(|k| k.name == name));
    let knob = if is_knob { nearest_knob(None, name) } else { None };
    let nearest = knob.or_else(|| nearest(name, sections()).map(str::to_owned));
    let (section, nearest) = (name.to_owned(), nearest.unwrap_or_default());
    ConfigError::UnknownSection { origin, section, nearest }
}

/// The value as the kind of `like`; whole numbers are numbers, but not the other way round.
fn converted(value: Value, like: &Value) -> Option<Value> {
    match (value, like) {
        (Value::Integer(i), Value::Float(_)) => Some(Value::Float(i as f64)),
        (Value::Array(values), Value::Array(likes)) => {
            let like = likes.first().cloned().unwrap_or(Value::Float(0.0));
            let all: Option<Vec<Value>> = values.into_iter().map(|v| converted(v, &like)).collect();
            all.map(Value::Array)
        }
        (value, like) if value.same_type(like) => Some(value),
        _ => None,
    }
}

/// The numbers of a value that a range applies to.
fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Integer(i) => vec![*i as f64],
        Value::Float(x) => vec![*x],
        Value::Array(values) => values.iter().flat_map(numbers).collect(),
        _ => Vec::new(),
    }
}
