//! The foot of a point on a patch.

use crate::metric::normal;
use crate::skin::Foot;
use crate::surface::{Surface, Tangents};
use crate::vector::{Vector, distance, dot, sub};

/// Most steps; three or four are the rule.
const STEPS: u32 = 20;
/// A step below this fraction of the parameters' range ends the search.
const STILL: f64 = 1e-14;

/// The foot near the parameters `from`, by Gauss and Newton's method within the patch; `None` where the
/// map is singular.
pub(super) fn foot(surface: &Surface, p: Vector, from: [f64; 2]) -> Option<Foot<[f64; 2]>> {
    let domain = surface.domain();
    let [mut u, mut v] = inside(domain, from);
    for _ in 0..STEPS {
        let at = surface.tangents(u, v);
        let [du, dv] = step(&at, p)?;
        let [new_u, new_v] = inside(domain, [u + du, v + dv]);
        let [wide_u, wide_v] = domain.map(|[low, high]| high - low);
        let is_still = (new_u - u).abs() <= STILL * wide_u && (new_v - v).abs() <= STILL * wide_v;
        [u, v] = [new_u, new_v];
        if is_still {
            break;
        }
    }
    let at = surface.tangents(u, v);
    Some(Foot { point: at.point, normal: normal(&at)?, place: [u, v] })
}

/// The foot nearest to `p` of those found from several places.
pub(super) fn nearest(
    surface: &Surface,
    p: Vector,
    from: impl IntoIterator<Item = [f64; 2]>,
) -> Option<Foot<[f64; 2]>> {
    let mut best: Option<Foot<[f64; 2]>> = None;
    for found in from.into_iter().filter_map(|from| foot(surface, p, from)) {
        if best.is_none_or(|b| distance(found.point, p) < distance(b.point, p)) {
            best = Some(found);
        }
    }
    best
}

fn inside([u_range, v_range]: [[f64; 2]; 2], [u, v]: [f64; 2]) -> [f64; 2] {
    [u.clamp(u_range[0], u_range[1]), v.clamp(v_range[0], v_range[1])]
}

/// The step in (u, v) that makes the tangential part of the distance vanish.
fn step(at: &Tangents, p: Vector) -> Option<[f64; 2]> {
    let away = sub(p, at.point);
    let (e, f, g) = (dot(at.u, at.u), dot(at.u, at.v), dot(at.v, at.v));
    let (r, s) = (dot(at.u, away), dot(at.v, away));
    let determinant = e * g - f * f;
    let singular = determinant.is_nan() || determinant <= 1e-14 * e * g;
    match singular {
        // On a pole only one direction leads away.
        true if e > g && e > 0.0 => Some([r / e, 0.0]),
        true if g > 0.0 => Some([0.0, s / g]),
        true => None,
        false => Some([(g * r - f * s) / determinant, (e * s - f * r) / determinant]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::Curve;
    use crate::surface::Revolution;
    use crate::vector::{norm, scale, unit};

    // spec: U11
    #[test]
    fn feet_on_a_sphere_are_in_the_direction_of_the_point() {
        let profile = Curve::arc([0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]).expect("ok");
        let sphere = Revolution::new(profile, [0.0; 3], [0.0, 0.0, 1.0], [0.0, 360.0]);
        let sphere = Surface::Revolution(sphere.expect("a sphere"));
        let [[u0, u1], [v0, v1]] = sphere.domain();
        for k in 1..40 {
            let (s, t) = (f64::from(k) / 40.0, f64::from(k * 7 % 39 + 1) / 41.0);
            let from = [u0 + s * (u1 - u0), v0 + t * (v1 - v0)];
            let near = sphere.at(from[0], from[1]);
            let p =
                scale(1.07, unit([near[0] + 0.02, near[1] - 0.02, near[2] + 0.01]).expect("ok"));
            let found = foot(&sphere, p, from).expect("a foot");
            let expected = scale(1.0 / norm(p), p);
            // Beside the seam the foot stays on the patch.
            let on_seam = found.place[1] == v0 || found.place[1] == v1;
            assert!(on_seam || distance(found.point, expected) < 1e-10, "{k}: {found:?}");
        }
    }
}
