//! What can be said to `trigrade remesh`.

use super::{MeshReading, parse_finite, parse_positive};
use crate::remesh::RemeshOptions;
use clap::{Args, ValueHint};
use std::path::PathBuf;

/// `trigrade remesh`
#[derive(Clone, Debug, Args)]
#[command(after_help = "\
Examples:
  trigrade remesh scan.stl --spacing 0.5 -o scan.msh -o scan.svg
  trigrade remesh part.obj --spacing 2 --feature-angle 30 -o part.stl
  trigrade remesh bunny.ply --spacing 3 --chord-error 0.01 -o bunny.ply")]
pub struct RemeshArguments {
    /// The surface: a triangle mesh in any form that `check` reads; `-` is standard input.
    #[arg(value_name = "MESH", value_hint = ValueHint::FilePath)]
    pub mesh: PathBuf,
    /// How the mesh is read.
    #[command(flatten)]
    pub reading: MeshReading,
    /// Where the new mesh goes; the extension names the form, `-` is standard output; repeatable.
    #[arg(long = "output", short, value_name = "OUT", value_hint = ValueHint::FilePath)]
    #[arg(required = true)]
    pub outputs: Vec<PathBuf>,
    /// Form of the outputs, whatever their extension (needed for `-o -`).
    #[arg(long, value_name = "FORM")]
    pub form: Option<String>,
    /// Wanted length of edges.
    #[arg(long, value_name = "LENGTH", value_parser = parse_positive)]
    pub spacing: f64,
    /// Edges across which the surface turns by more than this are kept.
    #[arg(long, value_name = "DEGREES", default_value_t = 40.0, value_parser = parse_finite)]
    pub feature_angle: f64,
    /// Largest slope of the wanted length where --chord-error makes it vary.
    #[arg(long, value_name = "SLOPE", default_value_t = 0.25, value_parser = parse_positive)]
    pub growth: f64,
    /// Shorter edges where the surface bends: triangles leave it by about this much.
    #[arg(long, value_name = "LENGTH", value_parser = parse_positive)]
    pub chord_error: Option<f64>,
    /// Refuse, before any work, to make more triangles than about this.
    #[arg(long, value_name = "COUNT", default_value_t = 20_000_000)]
    pub max_triangles: u32,
    /// Hand the mesh out without reading it back and checking it.
    #[arg(long)]
    pub no_check: bool,
    /// Print the time of each stage.
    #[arg(long)]
    pub timings: bool,
}

impl RemeshArguments {
    /// The same in the library's terms.
    #[must_use]
    pub fn options(&self) -> RemeshOptions {
        RemeshOptions {
            feature_angle_deg: self.feature_angle,
            growth: self.growth,
            chord_error: self.chord_error,
            triangles_max: self.max_triangles as usize,
            ..RemeshOptions::new(self.spacing)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Arguments, Verb};
    use super::*;
    use clap::Parser;

    // spec: U15
    #[test]
    fn defaults_are_those_of_the_library() {
        let line = ["trigrade", "remesh", "a.stl", "--spacing", "0.5", "-o", "b.stl"];
        let Verb::Remesh(remesh) = Arguments::parse_from(line).verb else {
            panic!("the verb is remesh");
        };
        assert_eq!(remesh.options(), RemeshOptions::new(0.5));
        for wrong in ["0", "-1", "nan", "wide"] {
            let line = ["trigrade", "remesh", "a.stl", "--spacing", wrong, "-o", "b.stl"];
            assert!(Arguments::try_parse_from(line).is_err(), "{wrong}");
        }
    }
}
