//! Limits for scripts: `--fail-if 'irregular_elements>100'`.

use std::str::FromStr;

use quadmend::metrics::{METRICS, Metric, Metrics, metric};

use super::Exit;
use super::output;

/// A bound on one metric.
#[derive(Debug, Clone)]
pub(super) struct Limit {
    metric: &'static Metric,
    above: bool,
    bound: f64,
}

impl FromStr for Limit {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let at = text.find(['<', '>']);
        let at =
            at.ok_or("a limit looks like irregular_elements>100 or scaled_jacobian_min<0.1")?;
        let (key, number) = (text[..at].trim(), text[at + 1..].trim());
        let metric = metric(key).ok_or_else(|| unknown(key))?;
        let bound = number.parse().map_err(|_| format!("`{number}` is not a number"))?;
        Ok(Self { metric, above: text[at..].starts_with('>'), bound })
    }
}

fn unknown(key: &str) -> String {
    let known: Vec<&str> = METRICS.iter().map(|m| m.key).collect();
    format!("there is no metric `{key}`; there are: {}", known.join(", "))
}

impl Limit {
    /// What to tell if the metrics are beyond the limit.
    fn missed(&self, metrics: &Metrics) -> Option<String> {
        let value = (self.metric.value)(metrics)?;
        let beyond = if self.above { value > self.bound } else { value < self.bound };
        let side = if self.above { "above" } else { "below" };
        let key = self.metric.key;
        beyond.then(|| format!("limit missed: {key} = {value} is {side} {}", self.bound))
    }
}

/// Names each limit that is missed; gives `otherwise` if all are kept.
pub(super) fn check(limits: &[Limit], metrics: &Metrics, otherwise: Exit) -> Exit {
    let missed: Vec<String> = limits.iter().filter_map(|limit| limit.missed(metrics)).collect();
    for line in &missed {
        output::note(line);
    }
    if missed.is_empty() { otherwise } else { Exit::LimitMissed }
}

#[cfg(test)]
mod tests {
    use super::Limit;

    #[test]
    fn a_limit_is_a_metric_a_side_and_a_number() {
        let limit: Limit = " scaled_jacobian_min < 0.1 ".parse().unwrap();
        assert_eq!(
            (limit.metric.key, limit.above, limit.bound),
            ("scaled_jacobian_min", false, 0.1)
        );
        assert!("irregular_elements".parse::<Limit>().is_err());
        assert!("irregular_elements>many".parse::<Limit>().is_err());
        let unknown = "irregulars>3".parse::<Limit>().unwrap_err();
        assert!(unknown.contains("irregular_elements"), "{unknown}");
    }
}
