//! The range of a heat map: the same for all meshes that are shown together.

use crate::metrics::{Better, FaceValues};

/// Share of faces at the bad end that get the same colour, so that one bad face does not make all
/// others look alike.
const CUT: f64 = 0.01;

/// The values that get the first and the last colour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeatRange {
    /// Value of the dark end.
    pub low: f64,
    /// Value of the light end.
    pub high: f64,
}

impl HeatRange {
    /// Of all values together: from the best that there can be to what all but one in a hundred
    /// reach. Where nothing is defined, 0 to 1.
    #[must_use]
    pub fn of(fields: &[&FaceValues]) -> Self {
        let mut values: Vec<f64> =
            fields.iter().flat_map(|f| &f.values).copied().filter(|v| v.is_finite()).collect();
        values.sort_by(f64::total_cmp);
        let at = |share: f64| values.get((share * values.len() as f64) as usize).copied();
        let higher = fields.first().is_some_and(|f| f.field.better == Better::Higher);
        let range = if higher {
            Self { low: at(CUT).unwrap_or(0.0), high: 1.0 }
        } else {
            Self { low: 0.0, high: at(1.0 - CUT).unwrap_or(1.0) }
        };
        // Rounding noise alone is no range.
        if range.high - range.low > 1e-9 { range } else { Self { high: range.low + 1.0, ..range } }
    }

    /// Where a value is in the range, 0 to 1; NaN stays NaN.
    #[must_use]
    pub fn place(&self, value: f64) -> f64 {
        ((value - self.low) / (self.high - self.low)).clamp(0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::FACE_FIELDS;

    #[test]
    fn ranges_begin_or_end_at_the_best_and_leave_outliers_out() {
        let mut values: Vec<f64> = (0..1000).map(|i| f64::from(i) / 1000.0).collect();
        values[7] = 1e9;
        values[8] = f64::NAN;
        let of = |i: usize| {
            HeatRange::of(&[&FaceValues { field: &FACE_FIELDS[i], values: values.clone() }])
        };
        assert!(of(0).low.to_bits() == 0 && (0.98..1.0).contains(&of(0).high), "{:?}", of(0));
        assert!(
            of(1).high.to_bits() == 1.0_f64.to_bits() && (0.0..0.02).contains(&of(1).low),
            "{:?}",
            of(1)
        );
        assert_eq!(HeatRange::of(&[]), HeatRange { low: 0.0, high: 1.0 });
        assert!(of(0).place(f64::NAN).is_nan());
    }
}
