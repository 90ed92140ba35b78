//! Quality gates: bounds on metrics, and comparison with a committed baseline.
//!
//! A gate that cannot be evaluated makes the report say 'could not run': it never passes.

use super::quality::{Better, Metric, Quality};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// How a value is compared with a gate's bound.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Relation {
    /// `<=`
    #[serde(rename = "<=")]
    AtMost,
    /// `<`
    #[serde(rename = "<")]
    Below,
    /// `>=`
    #[serde(rename = ">=")]
    AtLeast,
    /// `>`
    #[serde(rename = ">")]
    Above,
}

impl Relation {
    const ALL: [(&'static str, Self); 4] =
        [("<=", Self::AtMost), (">=", Self::AtLeast), ("<", Self::Below), (">", Self::Above)];

    fn symbol(self) -> &'static str {
        Self::ALL.iter().find(|pair| pair.1 == self).map_or("", |pair| pair.0)
    }
}

/// A share of all triangles, in millionths: exact, so that counting decides.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Share(u32);

impl Share {
    /// All of them.
    pub const ALL: Self = Self(1_000_000);

    /// Whether `met` of `total` are at least this share.
    #[must_use]
    pub fn is_reached(self, met: u64, total: u64) -> bool {
        u128::from(met) * u128::from(Self::ALL.0) >= u128::from(total) * u128::from(self.0)
    }

    /// Reads `99%` or `99.95 %`.
    fn parse(text: &str) -> Option<Self> {
        let number = text.trim().strip_suffix('%')?.trim();
        let (whole, decimals) = number.split_once('.').unwrap_or((number, ""));
        let digits = |s: &str| s.bytes().all(|b| b.is_ascii_digit());
        if whole.is_empty() || !digits(whole) || !digits(decimals) || decimals.len() > 4 {
            return None;
        }
        let value: u32 = format!("{whole}{decimals:0<4}").parse().ok()?;
        (value <= Self::ALL.0).then_some(Self(value))
    }
}

impl std::fmt::Display for Share {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let decimals = format!("{:04}", self.0 % 10_000);
        match decimals.trim_end_matches('0') {
            "" => write!(f, "{}%", self.0 / 10_000),
            kept => write!(f, "{}.{kept}%", self.0 / 10_000),
        }
    }
}

/// A bound on a metric that all triangles, or a share of them, must meet.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Gate {
    /// The metric.
    pub metric: Metric,
    /// How its values relate to the bound.
    pub relation: Relation,
    /// The bound, in the metric's unit.
    pub bound: f64,
    /// How many of the triangles must meet it.
    pub share: Share,
}

/// Text that is no gate.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GateError {
    /// No relation sign.
    #[error("the gate '{0}' has none of <=, <, >=, >; a gate reads 'radius_ratio <= 3 @ 99%'")]
    NoRelation(String),
    /// The metric is not known.
    #[error("in the gate '{gate}': {source}")]
    Metric {
        /// The gate as given.
        gate: String,
        /// What is wrong.
        source: super::quality::metric::UnknownMetric,
    },
    /// The bound is not a finite number.
    #[error("in the gate '{gate}': '{text}' is not a finite number")]
    Bound {
        /// The gate as given.
        gate: String,
        /// What stands for the bound.
        text: String,
    },
    /// The share is not a percentage.
    #[error("in the gate '{gate}': '{text}' is no share from 0% to 100% with up to four decimals")]
    Share {
        /// The gate as given.
        gate: String,
        /// What stands for the share.
        text: String,
    },
    /// A gate file is no TOML of the right shape.
    #[error("the gate file cannot be read: {0}")]
    File(String),
    /// A baseline is no JSON of the right shape.
    #[error("the baseline cannot be read: {0}")]
    Baseline(String),
}

impl Gate {
    /// All triangles' `metric` is at most `bound`.
    #[must_use]
    pub fn at_most(metric: Metric, bound: f64) -> Self {
        Self { metric, relation: Relation::AtMost, bound, share: Share::ALL }
    }

    /// All triangles' `metric` is at least `bound`.
    #[must_use]
    pub fn at_least(metric: Metric, bound: f64) -> Self {
        Self { metric, relation: Relation::AtLeast, bound, share: Share::ALL }
    }

    /// Reads `METRIC RELATION BOUND`, optionally followed by `@ SHARE%`.
    ///
    /// ```
    /// use trigrade::check::{Gate, Metric};
    ///
    /// let gate = Gate::parse("radius_ratio <= 3 @ 99%")?;
    /// assert_eq!(gate.metric, Metric::RadiusRatio);
    /// assert_eq!(gate.to_string(), "radius_ratio <= 3 @ 99%");
    /// # Ok::<(), trigrade::check::GateError>(())
    /// ```
    ///
    /// # Errors
    /// Says which part of the text is wrong.
    pub fn parse(text: &str) -> Result<Self, GateError> {
        let gate = || text.trim().to_owned();
        let split = Relation::ALL.iter().find_map(|&(symbol, relation)| {
            text.split_once(symbol).map(|(metric, rest)| (metric, relation, rest))
        });
        let (metric, relation, rest) = split.ok_or_else(|| GateError::NoRelation(gate()))?;
        let metric = metric.parse().map_err(|source| GateError::Metric { gate: gate(), source })?;
        let (bound, share) = match rest.split_once('@') {
            Some((bound, share)) => {
                let wrong = || GateError::Share { gate: gate(), text: share.trim().to_owned() };
                (bound, Share::parse(share).ok_or_else(wrong)?)
            }
            None => (rest, Share::ALL),
        };
        let wrong = || GateError::Bound { gate: gate(), text: bound.trim().to_owned() };
        let bound = bound.trim().parse().ok().filter(|b: &f64| b.is_finite()).ok_or_else(wrong)?;
        Ok(Self { metric, relation, bound, share })
    }

    /// Whether a value meets the bound; an undefined one does not.
    #[must_use]
    pub fn is_met_by(&self, value: f64) -> bool {
        match self.relation {
            Relation::AtMost => value <= self.bound,
            Relation::Below => value < self.bound,
            Relation::AtLeast => value >= self.bound,
            Relation::Above => value > self.bound,
        }
    }

    /// The result for a mesh of which `met` of `total` triangles meet the bound.
    pub(super) fn result(&self, quality: &Quality, met: u64) -> GateResult {
        let total = quality.triangles;
        let summary = quality.summary(self.metric);
        let low_is_bad = matches!(self.relation, Relation::AtLeast | Relation::Above);
        let worst = summary.and_then(|s| match (s.infinite, low_is_bad) {
            (0, true) => s.min,
            (0, false) => s.max,
            _ => None,
        });
        let outcome = match total {
            0 => GateOutcome::CouldNotRun,
            _ if self.share.is_reached(met, total) => GateOutcome::Held,
            _ => GateOutcome::Missed,
        };
        GateResult { gate: self.to_string(), outcome, met, total, worst }
    }

    /// The result when there was nothing to measure.
    pub(super) fn not_run(&self) -> GateResult {
        let outcome = GateOutcome::CouldNotRun;
        GateResult { gate: self.to_string(), outcome, met: 0, total: 0, worst: None }
    }
}

impl std::fmt::Display for Gate {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} {} {}", self.metric, self.relation.symbol(), self.bound)?;
        if self.share == Share::ALL { Ok(()) } else { write!(f, " @ {}", self.share) }
    }
}

impl std::str::FromStr for Gate {
    type Err = GateError;

    fn from_str(text: &str) -> Result<Self, GateError> {
        Self::parse(text)
    }
}

/// What became of a gate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum GateOutcome {
    /// Enough triangles meet the bound.
    Held,
    /// Too few do.
    Missed,
    /// It could not be evaluated.
    CouldNotRun,
}

/// A gate and what became of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GateResult {
    /// The gate as text.
    pub gate: String,
    /// What became of it.
    pub outcome: GateOutcome,
    /// Triangles that meet the bound.
    pub met: u64,
    /// Triangles measured.
    pub total: u64,
    /// The worst value; `None` when infinite or unknown.
    pub worst: Option<f64>,
}

/// The contents of a gate file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GateFile {
    /// The gates.
    pub gates: Vec<Gate>,
    /// Ids whose findings do not fail the check.
    pub allow: Vec<super::id::Id>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawGateFile {
    #[serde(default)]
    gates: Vec<String>,
    #[serde(default)]
    allow: Vec<String>,
}

impl GateFile {
    /// Reads TOML: `gates = ["radius_ratio <= 3 @ 99%", ...]` and `allow = ["M6", ...]`, both
    /// optional.
    ///
    /// # Errors
    /// Says which line is no TOML, which key is unknown, or which gate or id is wrong.
    pub fn parse(text: &str) -> Result<Self, GateError> {
        let raw: RawGateFile = toml::from_str(text).map_err(|e| GateError::File(e.to_string()))?;
        let gates = raw.gates.iter().map(|gate| Gate::parse(gate)).collect::<Result<_, _>>()?;
        let id = |name: &String| {
            name.parse().map_err(|e: super::id::UnknownId| GateError::File(e.to_string()))
        };
        Ok(Self { gates, allow: raw.allow.iter().map(id).collect::<Result<_, _>>()? })
    }
}

/// The schema of a serialised [`Baseline`].
pub const BASELINE_SCHEMA: &str = "trigrade-baseline/1";

/// What a metric must not fall behind.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BaselineEntry {
    /// The worst value; `None` when infinite.
    pub worst: Option<f64>,
    /// The mean; `None` when infinite.
    pub mean: Option<f64>,
}

/// The quality of a mesh at an earlier time, to be committed and compared with.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Baseline {
    /// [`BASELINE_SCHEMA`].
    pub schema: String,
    /// How much worse than the entries a value may be, relative to them; 0 unless edited.
    #[serde(default)]
    pub tolerance: f64,
    /// The metrics that have a better and a worse, by name.
    pub metrics: BTreeMap<Metric, BaselineEntry>,
}

impl Baseline {
    /// The baseline that a mesh of this quality just meets.
    #[must_use]
    pub fn of(quality: &Quality) -> Self {
        let judged = quality.metrics.iter().filter(|s| s.better != Better::Neither);
        let entry = |s: &super::quality::MetricSummary| {
            (s.metric, BaselineEntry { worst: worst(s), mean: s.mean })
        };
        let metrics = judged.map(entry).collect();
        Self { schema: BASELINE_SCHEMA.to_owned(), tolerance: 0.0, metrics }
    }

    /// Reads the JSON that serialising a baseline gives.
    ///
    /// # Errors
    /// Says where the text is no JSON of this shape.
    pub fn parse(text: &str) -> Result<Self, GateError> {
        let wrong = |e: String| GateError::Baseline(e);
        let baseline: Self = serde_json::from_str(text).map_err(|e| wrong(e.to_string()))?;
        if baseline.schema != BASELINE_SCHEMA {
            return Err(wrong(format!(
                "its schema is '{}', not '{BASELINE_SCHEMA}'",
                baseline.schema
            )));
        }
        if !(baseline.tolerance >= 0.0 && baseline.tolerance.is_finite()) {
            return Err(wrong("its tolerance is not a number from 0 on".to_owned()));
        }
        Ok(baseline)
    }

    /// What is worse than it was: metric, `"worst"` or `"mean"`, value then, value now.
    #[must_use]
    pub fn compare(&self, quality: &Quality) -> Vec<Regression> {
        let mut regressions = Vec::new();
        for (&metric, entry) in &self.metrics {
            let summary = quality.summary(metric);
            let now = [("worst", summary.and_then(worst)), ("mean", summary.and_then(|s| s.mean))];
            for ((what, now), then) in now.into_iter().zip([entry.worst, entry.mean]) {
                if self.is_worse(metric, then, now) {
                    regressions.push(Regression { metric, what, then, now });
                }
            }
        }
        regressions
    }

    fn is_worse(&self, metric: Metric, then: Option<f64>, now: Option<f64>) -> bool {
        let Some(then) = then else { return false };
        let Some(now) = now else { return true };
        let slack = self.tolerance * then.abs();
        match metric.better() {
            Better::Lower => now > then + slack,
            Better::Higher => now < then - slack,
            Better::Neither => false,
        }
    }
}

/// A value that got worse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Regression {
    /// The metric.
    pub metric: Metric,
    /// `"worst"` or `"mean"`.
    pub what: &'static str,
    /// The value in the baseline.
    pub then: Option<f64>,
    /// The value now; `None` when infinite.
    pub now: Option<f64>,
}

fn worst(summary: &super::quality::MetricSummary) -> Option<f64> {
    match (summary.infinite, summary.better) {
        (0, Better::Higher) => summary.min,
        (0, _) => summary.max,
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gates_print_as_they_are_read() {
        for text in
            ["radius_ratio <= 3", "min_angle >= 20.5", "shape > 0.3 @ 99.95%", "area < 2 @ 0%"]
        {
            assert_eq!(Gate::parse(text).unwrap().to_string(), text);
        }
        assert_eq!(
            Gate::parse("aspect-ratio<=3@99 %").unwrap().to_string(),
            "radius_ratio <= 3 @ 99%"
        );
    }

    #[test]
    fn wrong_gates_say_what_is_wrong() {
        for (text, word) in [
            ("radius_ratio 3", "none of <="),
            ("radius <= 3", "'radius' is no quality metric"),
            ("shape <= x", "'x' is not a finite number"),
            ("shape <= inf", "not a finite number"),
            ("shape <= NaN", "not a finite number"),
            ("shape <= 1 @ 101%", "no share"),
            ("shape <= 1 @ 99", "no share"),
            ("shape <= 1 @ 99.12345%", "no share"),
            ("shape <= 1 @ -1%", "no share"),
            ("", "none of <="),
        ] {
            let error = Gate::parse(text).unwrap_err().to_string();
            assert!(error.contains(word), "{text}: {error}");
        }
    }

    #[test]
    fn shares_are_counted_exactly() {
        let share = Share::parse("99%").unwrap();
        assert!(share.is_reached(99, 100) && !share.is_reached(98, 100));
        assert!(share.is_reached(198, 200) && !share.is_reached(197, 199));
        assert!(!Share::ALL.is_reached(u64::MAX - 1, u64::MAX));
    }

    #[test]
    fn gate_files_are_strict() {
        let file = GateFile::parse("gates = ['shape >= 0.1']\nallow = ['M6', 'overlap']").unwrap();
        assert_eq!(file.gates, [Gate::at_least(Metric::Shape, 0.1)]);
        assert_eq!(file.allow.len(), 2);
        assert_eq!(GateFile::parse("").unwrap(), GateFile::default());
        for text in ["gate = []", "gates = 3", "gates = ['shape']", "allow = ['M99']", "gates = ["]
        {
            assert!(GateFile::parse(text).is_err(), "{text}");
        }
    }

    #[test]
    fn baselines_are_strict() {
        let good =
            r#"{"schema":"trigrade-baseline/1","metrics":{"shape":{"worst":0.5,"mean":0.9}}}"#;
        let baseline = Baseline::parse(good).unwrap();
        assert!(baseline.is_worse(Metric::Shape, Some(0.5), Some(0.499)));
        assert!(!baseline.is_worse(Metric::Shape, Some(0.5), Some(0.5)));
        assert!(baseline.is_worse(Metric::EdgeRatio, Some(0.5), None));
        for (from, to) in [("baseline/1", "baseline/2"), ("shape", "shap"), ("0.9", "\"x\"")] {
            assert!(Baseline::parse(&good.replace(from, to)).is_err(), "{to}");
        }
    }
}
