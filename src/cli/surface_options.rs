//! Options of `trigrade mesh` that a surface model cannot heed, and those of models that a plane
//! domain cannot: each is refused with the reason (SPEC K44, K45).

use super::arguments::{Density, MeshArguments, MeshOptions, Method, Order, Rules, SurfaceFlags};
use super::failure::{Diagnostic, Failure};
use crate::mesher::Gradation;
use crate::model::Model;

/// An option that is given, as the user wrote it, and why it cannot be heeded.
type Idle = (&'static str, &'static str);

fn refuse(idle: &[(bool, Idle)], rule: &'static str) -> Result<(), Failure> {
    match idle.iter().find(|(is_given, _)| *is_given) {
        None => Ok(()),
        Some((_, (flag, reason))) => {
            let message = format!("{flag} {reason}");
            Err(Failure::cannot_run(Diagnostic::new(message).rule(rule)))
        }
    }
}

/// Demands that a model heeds all options.
///
/// # Errors
/// Exit code 2: the first that it does not.
pub fn demand_on_model(arguments: &MeshArguments) -> Result<(), Failure> {
    refuse(&[(arguments.reading.farfield.is_some(), FAR_FIELD)], "K44")?;
    refuse(&of_the_plane(&arguments.options), "K44")?;
    refuse(&of_the_front(&arguments.options), "K44")
}

const FAR_FIELD: Idle = ("--farfield", "has a meaning for airfoils only");

/// What only plane domains have.
fn of_the_plane(options: &MeshOptions) -> Vec<(bool, Idle)> {
    let is = |method| options.method == method;
    let of_plane = "has a meaning for plane domains only: models are meshed by graded, \
                    direct-surface, transfinite or elliptic";
    let no_mean = "has a meaning for plane domains only: it takes the mean of three nodes of the \
                   background triangulation, which models have none of; take growth, uniform or an \
                   expression of x, y and z";
    let no_count = "has a meaning for plane domains only: on a model change --spacing or \
                    --chord-error, `--dry-run` predicts the triangles";
    vec![
        (is(Method::Afm), ("--method afm", of_plane)),
        (is(Method::Direct), ("--method direct", of_plane)),
        (is(Method::DelaunayInitial), ("--method delaunay-initial", of_plane)),
        (is(Method::Delaunay), ("--method delaunay", of_plane)),
        (options.gradation == Gradation::Mean, ("--gradation mean", no_mean)),
        (options.gradation == Gradation::Third, ("--gradation third", no_mean)),
        (
            options.density == Density::AllEdges,
            (
                "--density all-edges",
                "has a meaning for plane domains only: the edges at a node of a \
              model are those of its curves",
            ),
        ),
        (
            options.limit_growth,
            (
                "--limit-growth",
                "has a meaning for plane domains only: on a model the slope of every \
              spacing is at most --growth as it is",
            ),
        ),
        (
            !options.spacing_at.is_empty(),
            (
                "--spacing-at",
                "has a meaning for plane domains only: give the curve a `spacing` in the \
              model's file",
            ),
        ),
        (
            !options.source.is_empty(),
            (
                "--source",
                "has a meaning for plane domains only: on a model take --gradation with an \
              expression of x, y and z",
            ),
        ),
        (
            options.size_field.is_some(),
            (
                "--size-field",
                "has a meaning for plane domains only: on a model take --gradation with \
              an expression of x, y and z",
            ),
        ),
        (
            options.corners.is_some(),
            ("--corners", "has a meaning for plane domains only: patches have their own"),
        ),
        (
            options.split_boundary,
            (
                "--split-boundary",
                "has a meaning for plane domains only: curves of a model are cut to \
              the spacing as it is",
            ),
        ),
        (options.max_area.is_some(), ("--max-area", "has a meaning with `--method delaunay` only")),
        (
            options.min_angle.is_some(),
            ("--min-angle", "has a meaning with `--method delaunay` only"),
        ),
        (options.coarsen, ("--coarsen", no_count)),
        (options.target.is_some(), ("--target", no_count)),
    ]
}

/// What only fronts have.
fn of_the_front(options: &MeshOptions) -> Vec<(bool, Idle)> {
    let is_grid = matches!(options.method, Method::Transfinite | Method::Elliptic);
    let is_other = options.method != Method::Graded;
    let front = "has a meaning on a model with `--method graded` only";
    let grid = "has no meaning with a structured grid: its points are those of the sides, joined";
    vec![
        (is_other && options.clamp != CLAMP, ("--clamp", front)),
        (is_other && options.order != Order::Depth, ("--order", front)),
        (is_other && options.rules != Rules::Scored, ("--rules", front)),
        (is_grid && options.gradation == Gradation::Uniform, ("--gradation uniform", grid)),
        (is_grid && options.optimize != 1, ("--optimize", grid)),
        (is_grid && options.no_improve, ("--no-improve", grid)),
    ]
}

/// The defaults of `--clamp` and `--growth`.
const CLAMP: f64 = 1.5;
const GROWTH: f64 = 0.25;

/// Demands that `--growth` has something to limit: on a structured grid only the spacings of the
/// curvature and of an expression.
///
/// # Errors
/// Exit code 2: it has not.
pub fn demand_slope_of_use(arguments: &MeshArguments, model: &Model) -> Result<(), Failure> {
    let (options, surface) = (&arguments.options, &arguments.on_surface);
    let is_grid = matches!(options.method, Method::Transfinite | Method::Elliptic);
    let bends = surface.chord_error.or(model.chord_error).is_some()
        || surface.angle_per_edge.or(model.angle_per_edge_deg).is_some();
    let varies = bends || matches!(options.gradation, Gradation::Expression(_));
    let idle = is_grid && options.growth != GROWTH && !varies;
    let reason = "has a meaning with a structured grid only where the spacing varies: with \
                  --chord-error, --angle-per-edge or an expression";
    refuse(&[(idle, ("--growth", reason))], "K44")
}

/// Demands that a plane domain heeds all options of models.
///
/// # Errors
/// Exit code 2: the first that it does not.
pub fn demand_on_plane(options: &MeshOptions, surface: &SurfaceFlags) -> Result<(), Failure> {
    let only = "has a meaning for surface models only";
    let is_direct = options.method == Method::DirectSurface;
    refuse(
        &[
            (is_direct, ("`--method direct-surface`", only)),
            (surface.chord_error.is_some(), ("--chord-error", only)),
            (surface.angle_per_edge.is_some(), ("--angle-per-edge", only)),
            (surface.weld.is_some(), ("--weld", only)),
        ],
        "K45",
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::arguments::{Arguments, Verb};
    use clap::Parser;

    fn parsed(flags: &[&str]) -> MeshArguments {
        let line = ["trigrade", "mesh", "a.json", "-o", "a.vtu"].iter().chain(flags);
        match Arguments::try_parse_from(line).expect("a command").verb {
            Verb::Mesh(arguments) => *arguments,
            _ => panic!("another verb"),
        }
    }

    // spec: K44
    #[test]
    fn the_defaults_are_those_of_the_command_line() {
        let MeshOptions { clamp, growth, optimize, .. } = parsed(&[]).options;
        assert_eq!((clamp, growth, optimize), (CLAMP, GROWTH, 1));
        assert!(demand_on_model(&parsed(&[])).is_ok());
    }

    // spec: K44
    #[test]
    fn an_option_is_refused_with_its_name() {
        for flags in [
            &["--corners", "0,1,2,3"][..],
            &["--method", "elliptic", "--optimize", "2"],
            &["--method", "direct-surface", "--clamp", "2"],
        ] {
            let failure = demand_on_model(&parsed(flags)).expect_err("refused");
            let told = failure.diagnostics[0].to_string();
            assert!(told.contains(flags[flags.len() - 2]) && told.contains("K44"), "{told}");
        }
        assert!(demand_on_model(&parsed(&["--optimize", "2", "--clamp", "2"])).is_ok());
    }

    // spec: K45
    #[test]
    fn a_plane_domain_has_no_curvature() {
        let of = |flags: &[&str]| {
            let arguments = parsed(flags);
            demand_on_plane(&arguments.options, &arguments.on_surface)
        };
        assert!(of(&[]).is_ok());
        for flags in [["--chord-error", "0.1"], ["--angle-per-edge", "9"], ["--weld", "0.1"]] {
            let told = of(&flags).expect_err("refused").diagnostics[0].to_string();
            assert!(told.contains(flags[0]) && told.contains("surface models only"), "{told}");
        }
    }
}
