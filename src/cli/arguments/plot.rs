//! The flags of `trigrade plot`.

use super::{Against, MeshReading, metric_meant};
use crate::check::Metric;
use crate::draw::View;
use clap::{Args, ValueHint};
use std::path::PathBuf;
use std::str::FromStr;

/// `trigrade plot`
#[derive(Clone, Debug, Args)]
#[command(after_help = "\
Examples:
  trigrade plot wing.msh -o wing.svg -o wing.png
  trigrade plot wing.msh --colour min_angle --window -0.1,-0.1,0.3,0.1 -o nose.png
  trigrade plot wing.msh --domain wing.poly -o wing.html")]
pub struct PlotArguments {
    /// The mesh; `-` is standard input.
    #[arg(value_name = "MESH", value_hint = ValueHint::FilePath)]
    pub mesh: PathBuf,
    /// How the mesh is read.
    #[command(flatten)]
    pub reading: MeshReading,
    /// The picture: .svg, .png or .html (a viewer), `-` is standard output; repeatable.
    #[arg(long = "output", short, value_name = "OUT", required = true)]
    pub outputs: Vec<PathBuf>,
    /// Form of the pictures, whatever their extension (needed for `-o -`).
    #[arg(long, value_name = "FORM")]
    pub form: Option<String>,
    /// The metric that colours triangles, by a name that `trigrade check --gate` knows, or `none`.
    #[arg(long, value_name = "METRIC|none", default_value = "radius_ratio")]
    pub colour: Colour,
    /// What it must cover: findings are marked, and a viewer shows the background mesh too.
    #[command(flatten)]
    pub against: Against,
    /// Draw only this part of the plane.
    #[arg(long, value_name = "X0,Y0,X1,Y1", allow_hyphen_values = true)]
    pub window: Option<View>,
    /// The line above the picture; the file's name if not given.
    #[arg(long, value_name = "TEXT")]
    pub title: Option<String>,
    /// Width of the picture in pixels.
    #[arg(long, value_name = "PIXELS", default_value_t = 1200)]
    #[arg(value_parser = clap::value_parser!(u32).range(16..=20_000))]
    pub width: u32,
}

/// `--colour`: a metric, or none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Colour(pub Option<Metric>);

impl FromStr for Colour {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text.trim() == "none" {
            return Ok(Self(None));
        }
        let metric = text.parse::<Metric>().map_err(|e| format!("{e}{}", metric_meant(text)))?;
        Ok(Self(Some(metric)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_metrics_or_none() {
        assert_eq!("none".parse(), Ok(Colour(None)));
        assert_eq!("min-angle".parse(), Ok(Colour(Some(Metric::MinAngle))));
        let error = "beauty".parse::<Colour>().expect_err("no metric");
        assert!(error.contains("radius_ratio"), "{error}");
    }
}
