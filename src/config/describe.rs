//! The knobs in words: commented files, a JSON schema, explanations. All read the tables that
//! `knobs!` makes.

use super::layer::{expected, nearest_knob};
use super::nearest::nearest;
use super::{Config, ConfigError, SECTIONS, SectionInfo, section};
use crate::knobs::Knob;
use serde_json::json;
use std::fmt::Write;
use toml::Value;

type Properties = serde_json::Map<String, serde_json::Value>;

/// Widest comment line, in characters.
const WIDTH: usize = 96;

/// All values of a configuration as a file in which each knob explains itself.
pub(super) fn commented(config: &Config) -> String {
    let defaults = Config::default();
    let mut text = wrapped("Every knob with its meaning, its unit, its range and its default.");
    for info in SECTIONS {
        let _ = write!(text, "\n{}[{}]\n", wrapped(&sentence(info.about)), info.name);
        for knob in info.knobs {
            let (value, default) =
                (config.get(info.name, knob.name), defaults.get(info.name, knob.name));
            let (Some(value), Some(default)) = (value, default) else { continue };
            let limits = format!("{}; default {default}", capital(&expected(knob, &default)));
            text += &wrapped(&sentence(knob.meaning));
            let _ = writeln!(text, "{}{} = {value}\n", wrapped(&sentence(&limits)), knob.name);
        }
        text.truncate(text.trim_end().len());
        text.push('\n');
    }
    text
}

/// A JSON schema (draft 2020-12) of the files that the configuration reads.
#[must_use]
pub fn schema() -> serde_json::Value {
    let defaults = Config::default();
    let sections =
        SECTIONS.iter().map(|info| (info.name.to_owned(), section_schema(info, &defaults)));
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "quadmend configuration",
        "type": "object",
        "additionalProperties": false,
        "properties": sections.collect::<Properties>(),
    })
}

fn section_schema(info: &SectionInfo, defaults: &Config) -> serde_json::Value {
    let property = |knob: &Knob| {
        let default = defaults.get(info.name, knob.name)?;
        Some((knob.name.to_owned(), knob_schema(knob, &default)))
    };
    json!({
        "description": sentence(info.about),
        "type": "object",
        "additionalProperties": false,
        "properties": info.knobs.iter().filter_map(property).collect::<Properties>(),
    })
}

fn knob_schema(knob: &Knob, default: &Value) -> serde_json::Value {
    let number = |kind: &str| json!({ "type": kind, "minimum": knob.min, "maximum": knob.max });
    let mut schema = match default {
        Value::Boolean(_) => json!({ "type": "boolean" }),
        Value::Integer(_) => number("integer"),
        Value::Array(_) => json!({ "type": "array", "items": number("number") }),
        _ => number("number"),
    };
    let unit = if knob.unit.is_empty() { String::new() } else { format!(" Unit: {}.", knob.unit) };
    schema["description"] = json!(format!("{}{unit}", sentence(knob.meaning)));
    schema["default"] = json!(default);
    schema
}

/// What a section (`measure`), a knob (`measure.samples`) or a knob without its section
/// (`samples`) means.
pub fn explain(key: &str) -> Result<String, ConfigError> {
    if let Some(info) = section(key) {
        let knobs = info.knobs.iter().map(|knob| explain_knob(info, knob));
        let about = format!("[{}] {}\n", info.name, sentence(info.about));
        return Ok(std::iter::once(about).chain(knobs).collect::<Vec<_>>().join("\n"));
    }
    let all = SECTIONS.iter().flat_map(|s| s.knobs.iter().map(move |k| (s, k)));
    let named =
        |(s, k): &(&SectionInfo, &Knob)| k.name == key || format!("{}.{}", s.name, k.name) == key;
    let found: Vec<String> = all.filter(named).map(|(s, k)| explain_knob(s, k)).collect();
    if found.is_empty() {
        return Err(ConfigError::UnknownName { name: key.to_owned(), nearest: most_similar(key) });
    }
    Ok(found.join("\n"))
}

fn explain_knob(info: &SectionInfo, knob: &Knob) -> String {
    let name = format!("{}.{}", info.name, knob.name);
    let Some(default) = Config::default().get(info.name, knob.name) else { return name };
    let takes = expected(knob, &default);
    format!("{name}\n  {}\n  Takes {takes}; default {default}.\n", sentence(knob.meaning))
}

fn most_similar(key: &str) -> String {
    match key.split_once('.') {
        Some((section, key)) => {
            let section = nearest(section, SECTIONS.iter().map(|s| s.name));
            nearest_knob(section, key).unwrap_or_default()
        }
        None => nearest_knob(None, key).unwrap_or_default(),
    }
}

/// One space between words, and a full stop.
fn sentence(text: &str) -> String {
    let words: Vec<&str> = text.split_whitespace().collect();
    let text = words.join(" ");
    if text.ends_with(['.', '?', '!']) { text } else { format!("{text}.") }
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |c| c.to_uppercase().chain(letters).collect())
}

/// As comment lines of at most [`WIDTH`] characters.
fn wrapped(text: &str) -> String {
    let (mut out, mut line) = (String::new(), String::from("#"));
    for word in text.split_whitespace() {
        if line.chars().count() + 1 + word.chars().count() > WIDTH {
            let _ = writeln!(out, "{line}");
            line = String::from("#");
        }
        let _ = write!(line, " {word}");
    }
    out + &line + "\n"
}
