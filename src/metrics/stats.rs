//! Summaries of many values, with the conventions of numpy: values that are not finite are left
//! out, percentiles are interpolated linearly, deviations are those of a whole population.

use serde::Serialize;

/// Mean, 95th percentile and maximum; all `None` if there is no finite value.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Spread {
    /// Arithmetic mean.
    pub mean: Option<f64>,
    /// 95th percentile.
    pub p95: Option<f64>,
    /// Largest value.
    pub max: Option<f64>,
}

impl Spread {
    /// Summarises the finite ones of `values`. O(n).
    #[must_use]
    pub fn of(values: impl IntoIterator<Item = f64>) -> Self {
        let mut finite: Vec<f64> = values.into_iter().filter(|x| x.is_finite()).collect();
        Self { mean: mean(&finite), p95: percentile(&mut finite, 95.0), max: max(&finite) }
    }
}

/// Arithmetic mean; `None` of nothing.
pub(super) fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

/// Smallest value; `None` of nothing.
pub(super) fn min(values: &[f64]) -> Option<f64> {
    values.iter().copied().reduce(f64::min)
}

/// Largest value; `None` of nothing.
pub(super) fn max(values: &[f64]) -> Option<f64> {
    values.iter().copied().reduce(f64::max)
}

/// Standard deviation of a whole population; `None` of nothing.
pub(super) fn deviation(values: &[f64]) -> Option<f64> {
    let mean = mean(values)?;
    let square = |x: &f64| (x - mean) * (x - mean);
    Some((values.iter().map(square).sum::<f64>() / values.len() as f64).sqrt())
}

/// Percentile with linear interpolation between ranks; reorders `values`. O(n).
pub(super) fn percentile(values: &mut [f64], percent: f64) -> Option<f64> {
    let last = values.len().checked_sub(1)?;
    let rank = last as f64 * percent.clamp(0.0, 100.0) / 100.0;
    // The rank lies in 0..=last, so the cast neither wraps nor loses more than the fraction.
    #[allow(clippy::cast_sign_loss)]
    let below = rank.floor() as usize;
    let (_, &mut low, rest) = values.select_nth_unstable_by(below, f64::total_cmp);
    let high = min(rest).unwrap_or(low);
    Some(low + (high - low) * (rank - below as f64))
}

/// Share of `count` in `total`, 0 of nothing.
pub(super) fn share(count: usize, total: usize) -> f64 {
    if total == 0 { 0.0 } else { count as f64 / total as f64 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_interpolate_between_ranks() {
        let mut values = [4.0, 1.0, 3.0, 2.0];
        assert_eq!(percentile(&mut values, 50.0), Some(2.5));
        assert_eq!(percentile(&mut values, 0.0), Some(1.0));
        assert_eq!(percentile(&mut values, 100.0), Some(4.0));
        assert!((percentile(&mut values, 95.0).unwrap_or(0.0) - 3.85).abs() < 1e-12);
        assert_eq!(percentile(&mut [], 50.0), None);
    }

    #[test]
    fn spreads_leave_out_what_is_not_finite() {
        let spread = Spread::of([1.0, f64::NAN, 3.0, f64::INFINITY]);
        assert_eq!((spread.mean, spread.max), (Some(2.0), Some(3.0)));
        assert_eq!(Spread::of([f64::NAN]), Spread::default());
    }

    #[test]
    fn deviation_is_of_the_population() {
        assert_eq!(deviation(&[1.0, 3.0]), Some(1.0));
        assert_eq!(deviation(&[]), None);
    }
}
