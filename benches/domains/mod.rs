//! Domains for tables of quality: made by formulas, or the golden ones.

use std::f64::consts::{PI, TAU};
use std::path::Path;
use trigrade::domain::Domain;
use trigrade::domain::naca::symmetric_section;
use trigrade::format::domain_file::{DomainForm, ReadOptions, read_domain};
use trigrade::point::Point2;

/// A domain and what it is called.
pub struct Named {
    /// Name in the table.
    pub name: &'static str,
    /// The domain.
    pub domain: Domain,
}

/// A domain of closed rings, holes by the even-odd rule.
pub fn rings(rings: &[Vec<Point2>]) -> Domain {
    Domain::of_rings(rings)
}

/// `n` points on a circle.
pub fn circle(x: f64, y: f64, radius: f64, n: u32) -> Vec<Point2> {
    (0..n)
        .map(|i| {
            let angle = TAU * f64::from(i) / f64::from(n);
            Point2::new(x + radius * libm::cos(angle), y + radius * libm::sin(angle))
        })
        .collect()
}

/// Points along a closed polygon: side `i` is cut into `cuts[i]` pieces, each `ratios[i]` times as
/// long as the one before.
pub fn polygon(corners: &[[f64; 2]], cuts: &[u32], ratios: &[f64]) -> Vec<Point2> {
    let mut points = Vec::new();
    for (i, &[x, y]) in corners.iter().enumerate() {
        let [u, v] = corners[(i + 1) % corners.len()];
        let (n, q) = (cuts[i % cuts.len()], ratios[i % ratios.len()]);
        let whole: f64 = (0..n).map(|k| libm::pow(q, f64::from(k))).sum();
        let mut t = 0.0;
        for k in 0..n {
            points.push(Point2::new(x + t * (u - x), y + t * (v - y)));
            t += libm::pow(q, f64::from(k)) / whole;
        }
    }
    points
}

/// The unit square with `n` segments a side.
pub fn square(n: u32) -> Domain {
    rings(&[polygon(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], &[n], &[1.0])])
}

/// NACA 0012 of `n` points in a circle of 15 chords with `m`.
pub fn naca(n: u32, m: u32) -> Domain {
    let section = symmetric_section(0.12, n);
    rings(&[circle(0.5, 0.0, 15.0, m), section])
}

fn gear(teeth: u32) -> Domain {
    let outer = (0..teeth * 8).map(|k| {
        let angle = TAU * f64::from(k) / f64::from(teeth * 8);
        let radius = if k % 8 < 4 { 1.0 } else { 0.82 };
        Point2::new(radius * libm::cos(angle), radius * libm::sin(angle))
    });
    rings(&[outer.collect(), circle(0.0, 0.0, 0.3, 60)])
}

fn spiral(turns: f64, n: u32) -> Domain {
    let arm = |k: u32, shift: f64| {
        let t = f64::from(k) / f64::from(n);
        let angle = TAU * turns * t;
        let radius = 0.3 + 0.35 * turns * t + shift;
        Point2::new(radius * libm::cos(angle), radius * libm::sin(angle))
    };
    let inner = (0..=n).map(|k| arm(k, 0.0));
    rings(&[inner.rev().chain((0..=n).map(|k| arm(k, 0.17))).collect()])
}

fn comb(teeth: u32) -> Domain {
    let mut corners = vec![[0.0, 0.0], [f64::from(teeth), 0.0]];
    for i in (0..teeth).rev() {
        let x = f64::from(i);
        corners.extend([[x + 1.0, 4.0], [x + 0.6, 4.0], [x + 0.5, 0.8], [x + 0.1, 0.8]]);
    }
    let lengths: Vec<u32> = (0..corners.len())
        .map(|i| {
            let ([x, y], [u, v]) = (corners[i], corners[(i + 1) % corners.len()]);
            (libm::hypot(u - x, v - y) / 0.1).round().max(1.0) as u32
        })
        .collect();
    rings(&[polygon(&corners, &lengths, &[1.0])])
}

fn plate(holes: u32) -> Domain {
    let n = f64::from(holes);
    let mut all = vec![polygon(&[[0.0, 0.0], [n, 0.0], [n, n], [0.0, n]], &[10 * holes], &[1.0])];
    for i in 0..holes * holes {
        let (x, y) = (f64::from(i % holes) + 0.5, f64::from(i / holes) + 0.5);
        let radius = 0.1 + 0.2 * f64::from((i * 7) % 5) / 4.0;
        all.push(circle(x, y, radius, 24 + 8 * ((i * 3) % 4)));
    }
    rings(&all)
}

fn star() -> Domain {
    let point = |k: u32| {
        let angle = TAU * f64::from(k) / 400.0;
        let radius = 1.0 + 0.4 * libm::cos(5.0 * angle);
        Point2::new(radius * libm::cos(angle), radius * libm::sin(angle))
    };
    rings(&[(0..400).map(point).collect()])
}

fn channel() -> Domain {
    let wall = |k: u32, side: f64| {
        let x = f64::from(k) / 10.0;
        Point2::new(x, 0.4 * libm::sin(x * PI / 3.0) + side)
    };
    rings(&[(0..=120)
        .map(|k| wall(k, -0.3))
        .chain((0..=120).rev().map(|k| wall(k, 0.3)))
        .collect()])
}

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// A golden domain.
fn golden(file: &str) -> Domain {
    let path = Path::new(ROOT).join("tests/golden").join(file);
    let bytes = std::fs::read(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let form = DomainForm::from_path(&path).expect("a golden domain's form");
    read_domain(&bytes, form, &ReadOptions::default()).expect("a golden domain is sound")
}

/// The nine regular domains, then others.
pub fn all() -> Vec<Named> {
    let l = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
    let graded_l = polygon(&l, &[24, 12, 30, 30, 12, 24], &[1.0, 1.0, 0.9, 1.0 / 0.9, 1.0, 1.0]);
    let named = |name, domain| Named { name, domain };
    vec![
        named("NACA 0012, 200 + 60", naca(200, 60)),
        named("three-element airfoil", golden("three_element.poly")),
        named("plate, 36 holes", plate(6)),
        named("gear", gear(24)),
        named("graded L", rings(&[graded_l])),
        named("two circles", rings(&[circle(0.0, 0.0, 10.0, 120), circle(2.0, 1.0, 1.0, 100)])),
        named("spiral", spiral(3.0, 400)),
        named("comb", comb(8)),
        named("square, 100 a side", square(100)),
        named("star", rings(&[star_ring()])),
        named("channel", channel()),
        named("nested islands", golden("nested_islands.json")),
        named("airfoil, 1000 + 200", naca(1000, 200)),
        named("NACA 0012, 400 + 60", naca(400, 60)),
    ]
}

fn star_ring() -> Vec<Point2> {
    star().points
}
