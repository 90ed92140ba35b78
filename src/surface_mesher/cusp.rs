//! Cusps across a patch: lines where its tangent vanishes and turns round, so that there is no normal
//! and the mesh would fold over.

use crate::surface::Surface;
use crate::vector::{Vector, dot};

/// Steps along each of the lines that are looked at.
const STEPS: u32 = 64;
/// The lines, as fractions of the other parameter.
const LINES: [f64; 3] = [0.25, 0.5, 0.75];
/// The interval of a turn is halved so often: a curve that is only bent turns no more.
const HALVINGS: u32 = 20;

/// A place where a tangent turns round at once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cusp {
    /// Whether u is constant along the cusp, and not v.
    pub(super) is_across_u: bool,
    /// That parameter.
    pub(super) parameter: f64,
    /// A point of it.
    pub(super) at: Vector,
}

/// The first cusp that one of three lines in each direction meets. What the sign of a product of
/// rounded tangents misses, the check of the mesh finds.
pub(super) fn find(surface: &Surface) -> Option<Cusp> {
    [true, false].into_iter().find_map(|is_across_u| {
        LINES.into_iter().find_map(|line| on_line(surface, is_across_u, line))
    })
}

fn on_line(surface: &Surface, is_across_u: bool, line: f64) -> Option<Cusp> {
    let [u, v] = surface.domain();
    let mix = |[low, high]: [f64; 2], t: f64| low + t * (high - low);
    let place =
        |t: f64| if is_across_u { [mix(u, t), mix(v, line)] } else { [mix(u, line), mix(v, t)] };
    let tangent = |t: f64| {
        let [u, v] = place(t);
        let tangents = surface.tangents(u, v);
        if is_across_u { tangents.u } else { tangents.v }
    };
    let turns = |a: f64, b: f64| dot(tangent(a), tangent(b)) < 0.0;
    // Between the samples, so that a cusp at a simple fraction is not on one.
    let step = |k: u32| (f64::from(k) + 0.4) / f64::from(STEPS);
    (1..STEPS).find_map(|k| {
        let (mut low, mut high) = (step(k - 1), step(k));
        if !turns(low, high) {
            return None;
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if turns(low, middle) { high = middle } else { low = middle }
        }
        let [u, v] = place(0.5 * (low + high));
        let parameter = if is_across_u { u } else { v };
        turns(low, high).then(|| Cusp { is_across_u, parameter, at: surface.at(u, v) })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::Tensor;

    fn swept(curve: &[[f64; 2]]) -> Surface {
        let row = |&[x, y]: &[f64; 2]| vec![[x, y, 0.0], [x, y, 1.0]];
        let rows: Vec<_> = curve.iter().map(row).collect();
        Surface::Tensor(Tensor::bezier(&rows).expect("a patch"))
    }

    // spec: S33
    #[test]
    fn the_cusp_of_a_cubic_is_found_at_its_parameter() {
        let cusp = find(&swept(&[[0.0, 0.0], [1.0, 1.0], [0.0, 1.0], [1.0, 0.0]]));
        let cusp = cusp.expect("a cusp");
        assert!(cusp.is_across_u && (cusp.parameter - 0.5).abs() < 1e-6, "{cusp:?}");
        assert!((cusp.at[0] - 0.5).abs() < 1e-9 && (cusp.at[1] - 0.75).abs() < 1e-9, "{cusp:?}");
    }

    // spec: S33
    #[test]
    fn a_bend_however_sharp_is_no_cusp() {
        for pull in [0.9, 0.99, 0.999] {
            let bent = swept(&[[0.0, 0.0], [pull, 1.0], [1.0 - pull, 1.0], [1.0, 0.0]]);
            assert_eq!(find(&bent), None, "{pull}");
        }
        let looped = swept(&[[0.0, 0.0], [3.0, 2.0], [-2.0, 2.0], [1.0, 0.0]]);
        assert_eq!(find(&looped), None);
    }
}
