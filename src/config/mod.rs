//! The configuration: what every section of knobs is set to.
//!
//! Values come in layers, later ones over earlier ones: defaults, a preset, a file, single
//! assignments. Every value is checked where it enters, so that an error can say where that was.
//!
//! A section is declared with `knobs!` in the module that it configures and listed in one line
//! of [`Config`] below; file keys, `--set`, schema, explanations and `configs/default.toml` follow.
//!
//! *Invariant:* every value of a [`Config`] made here is inside the range of its knob.

mod describe;
mod error;
mod layer;
mod nearest;
#[cfg(test)]
mod tests;

pub use describe::{explain, schema};
pub use error::{ConfigError, IllegalValue, Origin};
pub(crate) use nearest::nearest;

use crate::knobs::{Knob, Section};
use layer::Layer;
use serde::{Deserialize, Serialize};
use std::path::Path;
use toml::{Table, Value};

/// Presets by name, as files of the format that `--config` reads.
pub const PRESETS: &[(&str, &str)] = &[
    ("default", include_str!("../../configs/default.toml")),
    ("balanced", include_str!("../../configs/balanced.toml")),
    ("clean", include_str!("../../configs/clean.toml")),
    ("fast", include_str!("../../configs/fast.toml")),
    ("gentle", include_str!("../../configs/gentle.toml")),
    ("pure-quad", include_str!("../../configs/pure-quad.toml")),
    ("t-junctions", include_str!("../../configs/t-junctions.toml")),
];

/// A section as the configuration sees it.
#[derive(Debug, Clone, Copy)]
pub struct SectionInfo {
    /// Its name in files.
    pub name: &'static str,
    /// What it is about.
    pub about: &'static str,
    /// Its knobs.
    pub knobs: &'static [Knob],
}

impl SectionInfo {
    const fn of<S: Section>() -> Self {
        Self { name: S::NAME, about: S::ABOUT, knobs: S::KNOBS }
    }
}

/// Declares [`Config`] and [`SECTIONS`]; the field is the name of the section.
macro_rules! sections {
    ($($field:ident: $section:ty,)*) => {
        /// Every knob of the program. The default is what `configs/default.toml` says.
        #[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
        #[serde(deny_unknown_fields, default)]
        pub struct Config {
            $(#[doc = concat!("Section `", stringify!($field), "`.")] pub $field: $section,)*
        }

        /// All sections, in the order in which files list them.
        pub const SECTIONS: &[SectionInfo] = &[$(SectionInfo::of::<$section>(),)*];
    };
}

sections! {
    read: crate::io::ReadOptions,
    features: crate::surface::FeatureOptions,
    plan: crate::planner::PlanOptions,
    cost: crate::planner::cost::CostOptions,
    gate: crate::planner::gate::GateOptions,
    relax: crate::smooth::RelaxOptions,
    smooth: crate::smooth::SmoothOptions,
    optimize: crate::optimize::OptimizeOptions,
    measure: crate::metrics::MeasureOptions,
}

impl Config {
    /// Defaults, then the preset, then the file, then assignments `section.key=value` in order.
    pub fn load(
        preset: Option<&str>,
        file: Option<&Path>,
        assignments: &[impl AsRef<str>],
    ) -> Result<Self, ConfigError> {
        let mut config = preset.map_or_else(|| Ok(Self::default()), Self::preset)?;
        if let Some(file) = file {
            let read = std::fs::read_to_string(file);
            let text = read.map_err(|source| ConfigError::Read { file: file.into(), source })?;
            config = config.with(&Layer::from_file(&file.display().to_string(), &text)?)?;
        }
        for assignment in assignments {
            config = config.with(&Layer::from_assignment(assignment.as_ref())?)?;
        }
        Ok(config)
    }

    /// The preset called `name`.
    pub fn preset(name: &str) -> Result<Self, ConfigError> {
        let names = || PRESETS.iter().map(|(name, _)| *name);
        let Some((name, text)) = PRESETS.iter().find(|(known, _)| *known == name) else {
            let known = names().collect::<Vec<_>>().join(", ");
            let nearest = nearest::nearest(name, names()).unwrap_or_default().to_owned();
            return Err(ConfigError::UnknownPreset { name: name.to_owned(), nearest, known });
        };
        Self::default().with(&Layer::from_preset(name, text)?)
    }

    /// This configuration with the values of a text in the format of files; `name` is what
    /// errors call it.
    pub fn with_text(self, name: &str, text: &str) -> Result<Self, ConfigError> {
        self.with(&Layer::from_file(name, text)?)
    }

    /// This configuration with one assignment `section.key=value`.
    pub fn with_assignment(self, assignment: &str) -> Result<Self, ConfigError> {
        self.with(&Layer::from_assignment(assignment)?)
    }

    /// The value of `section.key`.
    #[must_use]
    pub fn get(&self, section: &str, key: &str) -> Option<Value> {
        self.table().get(section)?.get(key).cloned()
    }

    /// All values as a file, each with its meaning, unit, range and default.
    #[must_use]
    pub fn to_toml_commented(&self) -> String {
        describe::commented(self)
    }

    /// The values as a file without comments.
    #[must_use]
    pub fn to_toml(&self) -> String {
        self.table().to_string()
    }

    /// The values that are not those of [`Self::default`], as a file.
    #[must_use]
    pub fn to_toml_changed(&self) -> String {
        let (mut table, usual) = (self.table(), Self::default().table());
        for (name, section) in &mut table {
            if let Value::Table(section) = section {
                section
                    .retain(|key, value| usual.get(name).and_then(|s| s.get(key)) != Some(&*value));
            }
        }
        table.retain(|_, section| section.as_table().is_some_and(|s| !s.is_empty()));
        table.to_string()
    }

    /// Checks each value of the layer and puts it in its place.
    fn with(self, layer: &Layer) -> Result<Self, ConfigError> {
        let mut table = self.table();
        for entry in &layer.entries {
            let value = entry.checked(&table)?;
            if let Some(Value::Table(section)) = table.get_mut(&entry.section) {
                section.insert(entry.key.clone(), value);
            }
        }
        table.try_into().map_err(|e: toml::de::Error| ConfigError::Rejected {
            origin: layer.origin(),
            message: e.message().to_owned(),
        })
    }

    fn table(&self) -> Table {
        // Sections hold numbers, booleans and lists of them, all of which TOML can say.
        Table::try_from(self).expect("knobs are TOML values")
    }
}

/// A section by its name.
#[must_use]
pub fn section(name: &str) -> Option<&'static SectionInfo> {
    SECTIONS.iter().find(|s| s.name == name)
}
