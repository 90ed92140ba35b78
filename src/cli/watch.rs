//! Watching the mesher: a progress bar on a terminal, and the time of each stage.

use super::console::Console;
use super::words::count;
use crate::mesher::{Observer, Stage};
use crate::size::Prediction;
use indicatif::ProgressBar;
use serde_json::Value;
use std::time::{Duration, Instant};

/// The stages of a run with their times, and a bar.
#[derive(Debug)]
pub struct Watch {
    laps: Vec<(String, Duration)>,
    running: Option<(String, Instant)>,
    bar: ProgressBar,
}

impl Watch {
    /// Starts nothing yet.
    #[must_use]
    pub fn new(console: &Console) -> Self {
        Self { laps: Vec::new(), running: None, bar: console.bar() }
    }

    /// Ends the stage that runs, and begins the next.
    pub fn begin(&mut self, stage: &str) {
        self.end();
        self.bar.set_message(stage.to_owned());
        self.running = Some((stage.to_owned(), Instant::now()));
    }

    /// Ends the stage that runs.
    pub fn end(&mut self) {
        if let Some((stage, start)) = self.running.take() {
            self.laps.push((stage, start.elapsed()));
        }
    }

    /// Ends all, and clears the bar.
    #[must_use]
    pub fn finish(mut self) -> Vec<(String, Duration)> {
        self.end();
        self.bar.finish_and_clear();
        self.laps
    }
}

impl Observer for Watch {
    fn stage(&mut self, stage: Stage) {
        self.begin(&stage.to_string());
    }

    fn predicted(&mut self, prediction: Prediction) -> bool {
        let predicted = prediction.triangles as u64;
        self.bar.set_length(predicted);
        self.bar.println(format!("predicted {} triangles", count(predicted)));
        true
    }

    fn progress(&mut self, triangles: usize) -> bool {
        self.bar.set_position(triangles as u64);
        true
    }
}

/// Stops the mesher as soon as it has predicted the number of triangles.
#[derive(Debug, Default)]
pub struct Forecast {
    prediction: Option<Prediction>,
}

impl Observer for Forecast {
    fn predicted(&mut self, prediction: Prediction) -> bool {
        self.prediction = Some(prediction);
        false
    }
}

/// The prediction alone, of a mesher that is run with the observer given.
///
/// # Errors
/// Those of the mesher that come before its prediction.
///
/// # Panics
/// When it makes a mesh without having predicted.
pub fn prediction<T, E>(mesh: impl FnOnce(&mut Forecast) -> Result<T, E>) -> Result<Prediction, E> {
    let mut forecast = Forecast::default();
    let outcome = mesh(&mut forecast);
    match (forecast.prediction, outcome) {
        (Some(prediction), _) => Ok(prediction),
        (None, Err(error)) => Err(error),
        (None, Ok(_)) => unreachable!("meshers predict before they mesh"),
    }
}

/// A time in the unit that suits it, with three digits.
#[must_use]
pub fn time(duration: Duration) -> String {
    let seconds = duration.as_secs_f64();
    match seconds {
        s if s < 1e-3 => format!("{:.0} µs", s * 1e6),
        s if s < 1.0 => format!("{:.1} ms", s * 1e3),
        s => format!("{s:.2} s"),
    }
}

/// The time of each stage, for people.
#[must_use]
pub fn stages(laps: &[(String, Duration)]) -> String {
    let each: Vec<String> =
        laps.iter().map(|(stage, lap)| format!("{stage} {}", time(*lap))).collect();
    each.join(", ")
}

/// The time of all stages.
#[must_use]
pub fn total(laps: &[(String, Duration)]) -> Duration {
    laps.iter().map(|(_, lap)| *lap).sum()
}

/// The seconds of each stage, for programs.
#[must_use]
pub fn seconds(laps: &[(String, Duration)]) -> Value {
    let each = laps.iter().map(|(stage, lap)| (stage.clone(), lap.as_secs_f64().into()));
    Value::Object(each.collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::arguments::Global;

    #[test]
    fn stages_are_timed_in_their_order() {
        let mut watch = Watch::new(&Console::new(&Global::default(), false));
        watch.begin("read");
        watch.stage(Stage::Front);
        watch.end();
        watch.begin("write");
        let names: Vec<String> = watch.finish().into_iter().map(|(stage, _)| stage).collect();
        assert_eq!(names, ["read", "front", "write"]);
    }

    #[test]
    fn times_have_a_unit_that_suits_them() {
        for (micros, text) in [(12, "12 µs"), (3_400, "3.4 ms"), (2_500_000, "2.50 s")] {
            assert_eq!(time(Duration::from_micros(micros)), text);
        }
    }
}
