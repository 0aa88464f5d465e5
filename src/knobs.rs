//! Configuration knobs, each declared once: name, type, default, range, unit and meaning.
//!
//! A module that has options declares them with [`knobs!`]; the configuration file, `--set`, the
//! schema, `config explain` and the tuner all read the [`Knob`] table that the macro makes.

use serde::{Deserialize, Serialize};

/// One adjustable value of the configuration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Knob {
    /// Key inside its section.
    pub name: &'static str,
    /// Smallest legal value; booleans count as 0 and 1.
    pub min: f64,
    /// Largest legal value.
    pub max: f64,
    /// Unit: `_rel` lengths are fractions of the bounding-box diagonal, `_edges` of the mean edge.
    pub unit: &'static str,
    /// What it does, in words.
    pub meaning: &'static str,
}

/// A section of the configuration: a struct of knobs with defaults.
pub trait Section: Serialize + for<'a> Deserialize<'a> + Default {
    /// Name of the section in the configuration file.
    const NAME: &'static str;
    /// What it is about, in words.
    const ABOUT: &'static str;
    /// Its knobs, in the order of declaration.
    const KNOBS: &'static [Knob];
}

/// Declares a section: a documented struct with defaults and its table of knobs.
///
/// ```ignore
/// knobs! {
///     /// How vertices are moved.
///     pub struct SmoothOptions in "smooth" {
///         /// Most iterations of the final smoothing.
///         iterations: u32 = 200, in 0.0..=5000.0, "count";
///     }
/// }
/// ```
macro_rules! knobs {
    ($(#[doc = $about:literal])* pub struct $name:ident in $section:literal {
        $($(#[doc = $doc:literal])+ $field:ident: $type:ty = $default:expr, in $min:literal..=$max:literal, $unit:literal;)*
    }) => {
        $(#[doc = $about])*
        #[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
        #[serde(deny_unknown_fields, default)]
        pub struct $name { $($(#[doc = $doc])+ pub $field: $type,)* }

        impl Default for $name {
            fn default() -> Self { Self { $($field: $default,)* } }
        }

        impl $crate::knobs::Section for $name {
            const NAME: &'static str = $section;
            const ABOUT: &'static str = concat!($($about),*);
            const KNOBS: &'static [$crate::knobs::Knob] = &[$($crate::knobs::Knob {
                name: stringify!($field), min: $min, max: $max, unit: $unit,
                meaning: concat!($($doc),+),
            },)*];
        }
    };
}
pub(crate) use knobs;
