//! Target: the predicates against rational arithmetic, over near-degenerate points and the whole
//! range of exponents.

use super::decode::Decoder;
use super::exact;
use trigrade::predicates::{incircle, orient2d};

/// One input.
pub fn run(bytes: &[u8]) {
    let mut decoder = Decoder::new(bytes);
    let mut points = Vec::new();
    for _ in 0..4 {
        let next = decoder.point(&points);
        points.push(next);
    }
    let [a, b, c, d] = points[..] else { unreachable!("four points were made") };
    assert_eq!(orient2d(a, b, c), exact::orient2d(a, b, c), "orient2d {points:?}");
    assert_eq!(orient2d(b, c, d), exact::orient2d(b, c, d), "orient2d {points:?}");
    assert_eq!(incircle(a, b, c, d), exact::incircle(a, b, c, d), "incircle {points:?}");
}
