//! Airfoil sections of the NACA four-digit family, and the far field around them.
//!
//! Source: E. N. Jacobs, K. E. Ward, R. M. Pinkerton, NACA report 460 (1933), with the last
//! coefficient of the thickness changed from 0.1015 to 0.1036 so that the trailing edge is closed.
//! Only symmetric sections are made here: the camber line is the chord.

use crate::domain::{Domain, Inside, Loop, LoopRole, Places};
use crate::point::Point2;
use std::f64::consts::PI;

/// Marker of the segments on the airfoil.
pub const AIRFOIL_MARKER: i32 = 1;
/// Marker of the segments on the far field.
pub const FARFIELD_MARKER: i32 = 2;

/// The section NACA 00xx on the chord from (0, 0) to (1, 0): `points` points, counterclockwise
/// from the trailing edge over the upper side, in cosine spacing. `thickness` is the largest one
/// as a fraction of the chord, 0.12 for NACA 0012. The lower side mirrors the upper one exactly.
///
/// # Requires
/// `points` is even and at least 4, so that both edges of the section are points.
#[must_use]
pub fn symmetric_section(thickness: f64, points: u32) -> Vec<Point2> {
    assert!(points >= 4 && points.is_multiple_of(2), "an even number of points, at least 4");
    let side = points / 2;
    let upper = |i: u32| {
        let x = 0.5 * (1.0 + libm::cos(PI * f64::from(i) / f64::from(side)));
        let is_edge = i == 0 || i == side;
        Point2::new(if i == side { 0.0 } else { x }, if is_edge { 0.0 } else { half(thickness, x) })
    };
    let lower = (1..side).rev().map(|i| Point2::new(upper(i).x, -upper(i).y));
    (0..=side).map(upper).chain(lower).collect()
}

/// Half the thickness at `x`.
fn half(thickness: f64, x: f64) -> f64 {
    let tail = 0.2843 - 0.1036 * x;
    5.0 * thickness * (0.2969 * x.sqrt() + x * (-0.1260 + x * (-0.3516 + x * tail)))
}

/// `points` points on the circle around `centre`, counterclockwise from angle 0.
#[must_use]
pub fn circle(centre: Point2, radius: f64, points: u32) -> Vec<Point2> {
    let point = |i| {
        let angle = 2.0 * PI * f64::from(i) / f64::from(points);
        Point2::new(centre.x + radius * libm::cos(angle), centre.y + radius * libm::sin(angle))
    };
    (0..points).map(point).collect()
}

/// The demonstration domain: NACA 0012 with 200 points inside a circle of 15 chords with 60.
#[must_use]
pub fn naca0012() -> Domain {
    let farfield = circle(Point2::new(0.5, 0.0), 15.0, 60);
    let section = symmetric_section(0.12, 200);
    let mut points = Vec::new();
    let loops = vec![
        closed(&mut points, &farfield, FARFIELD_MARKER, LoopRole::Outer),
        closed(&mut points, &section, AIRFOIL_MARKER, LoopRole::HoleOf(0)),
    ];
    Domain {
        points,
        point_markers: Vec::new(),
        loops,
        segments: Vec::new(),
        inside: Inside::EvenOdd,
        regions: Vec::new(),
        places: Places::default(),
    }
}

/// Appends `ring` to `points` as a loop with one marker.
fn closed(points: &mut Vec<Point2>, ring: &[Point2], marker: i32, role: LoopRole) -> Loop {
    let first = points.len() as u32;
    points.extend_from_slice(ring);
    let vertices = (first..points.len() as u32).collect();
    Loop { vertices, markers: vec![marker; ring.len()], role }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_section_is_closed_symmetric_and_as_thick_as_its_name_says() {
        let section = symmetric_section(0.12, 200);
        assert_eq!(section.len(), 200);
        assert_eq!((section[0], section[100]), (Point2::new(1.0, 0.0), Point2::new(0.0, 0.0)));
        for i in 1..100 {
            let (upper, lower) = (section[i], section[200 - i]);
            assert_eq!((upper.x, upper.y), (lower.x, -lower.y), "point {i}");
            assert!(upper.y > 0.0, "point {i}");
        }
        let thickest = section.iter().map(|p| 2.0 * p.y).fold(0.0, f64::max);
        // The report: 12 % of the chord at 30 % of it.
        assert!((0.1199..=0.1201).contains(&thickest), "{thickest}");
    }

    #[test]
    fn ordinates_agree_with_the_report() {
        // NACA report 460, table of the basic thickness for 20 %: x, y in per cent of the chord.
        for (x, y) in [(1.25, 3.157), (10.0, 7.804), (30.0, 10.003), (60.0, 7.606), (90.0, 2.413)] {
            let ours = 100.0 * half(0.20, x / 100.0);
            // The closed trailing edge moves the ordinates by at most 0.21 % of the chord there.
            let tolerance = 0.002 + 0.21 * libm::pow(x / 100.0, 4.0);
            assert!((ours - y).abs() <= tolerance, "x {x}: {ours} and {y}");
        }
    }

    #[test]
    fn the_demonstration_domain_has_its_counts() {
        let domain = naca0012();
        assert_eq!(domain.loops.iter().map(|l| l.vertices.len()).collect::<Vec<_>>(), [60, 200]);
        assert_eq!(domain.points.len(), 260);
        assert!(domain.points.iter().all(|p| p.is_finite()));
        let far = domain.points[..60].iter().map(|p| p.distance(Point2::new(0.5, 0.0)));
        assert!(far.into_iter().all(|r| (r - 15.0).abs() < 1e-12));
    }

    #[test]
    #[should_panic(expected = "even number of points")]
    fn an_odd_number_of_points_is_a_programming_error() {
        let _ = symmetric_section(0.12, 199);
    }
}
