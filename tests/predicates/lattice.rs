//! All triples and quadruples of the 5x5 lattice, against integers.

use trigrade::point::Point2;
use trigrade::predicates::{Sign, incircle, incircle_perturbed, orient2d};

type Node = [i64; 2];

fn nodes() -> Vec<Node> {
    (0..25).map(|i| [i / 5 - 2, i % 5 - 2]).collect()
}

fn point([x, y]: Node) -> Point2 {
    Point2::new(x as f64, y as f64)
}

fn area([ax, ay]: Node, [bx, by]: Node, [cx, cy]: Node) -> i64 {
    (ax - cx) * (by - cy) - (ay - cy) * (bx - cx)
}

/// The determinant with rows (x, y, height, 1), along the column of heights.
fn determinant([a, b, c, d]: [Node; 4], [ha, hb, hc, hd]: [i64; 4]) -> i64 {
    ha * area(b, c, d) - hb * area(a, c, d) + hc * area(a, b, d) - hd * area(a, b, c)
}

fn sign(value: i64) -> Sign {
    Sign::from(value.cmp(&0))
}

/// The heights, scaled to leave room for a perturbation that is small but not infinitesimal: on this
/// lattice a determinant is an integer and an area at most 32, so weights of 1, 65, 65^2, 65^3 are in
/// the infinite ratio for all that matters, and 65^4 of them are one unit.
fn perturbed_heights(quad: [Node; 4]) -> [i64; 4] {
    quad.map(|p| {
        let rank = quad.iter().filter(|&&q| q < p).count() as u32;
        (p[0] * p[0] + p[1] * p[1]) * 65_i64.pow(5) + 65_i64.pow(rank)
    })
}

fn quadruples() -> impl Iterator<Item = [Node; 4]> {
    let nodes = nodes();
    (0..25_usize.pow(4)).map(move |code| [15_625, 625, 25, 1].map(|unit| nodes[code / unit % 25]))
}

// spec: P1
#[test]
fn orient2d_is_right_on_all_triples() {
    for quad in quadruples().filter(|quad| quad[3] == [-2, -2]) {
        let [a, b, c, _] = quad;
        let [p, q, r, _] = quad.map(point);
        assert_eq!(orient2d(p, q, r), sign(area(a, b, c)), "{a:?} {b:?} {c:?}");
    }
}

// spec: P2
#[test]
fn incircle_is_right_on_all_quadruples() {
    for quad in quadruples() {
        let heights = quad.map(|[x, y]| x * x + y * y);
        let [p, q, r, s] = quad.map(point);
        assert_eq!(incircle(p, q, r, s), sign(determinant(quad, heights)), "{quad:?}");
    }
}

// spec: P6 P7
#[test]
fn incircle_perturbed_is_right_on_all_quadruples() {
    for quad in quadruples() {
        let expected = sign(determinant(quad, perturbed_heights(quad)));
        let [p, q, r, s] = quad.map(point);
        let perturbed = incircle_perturbed(p, q, r, s);
        assert_eq!(perturbed, expected, "{quad:?}");
        let [a, b, c, d] = quad;
        let in_general_position = area(a, b, c) != 0 && ![a, b, c].contains(&d);
        assert!(perturbed != Sign::Zero || !in_general_position, "{quad:?}");
    }
}
