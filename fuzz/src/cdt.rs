//! Target: the constrained Delaunay triangulation. It is one, or the refusal is right.

use super::decode::Decoder;
use super::exact::{cross, is_inside_segment};
use std::collections::BTreeSet;
use trigrade::delaunay::{CdtError, cdt};
use trigrade::point::Point2;
use trigrade::triangulation::VertexId;

/// One input.
pub fn run(bytes: &[u8]) {
    let mut decoder = Decoder::new(bytes);
    let points = distinct(decoder.points(24));
    let segments = segments(&mut decoder, points.len() as u32);
    let ends = |i: u32| segments[i as usize].map(|v| points[v as usize]);
    match cdt(&points, &segments) {
        Ok(cdt) => {
            cdt.triangulation.verify_geometry(&points).unwrap_or_else(|e| {
                panic!("{e}: {points:?} {segments:?}");
            });
            assert_eq!(cdt.segments.len(), segments.len());
            for (&e, &[a, b]) in cdt.segments.iter().zip(&segments) {
                assert_eq!(cdt.triangulation.origin(e), VertexId(a), "{points:?} {segments:?}");
                assert_eq!(cdt.triangulation.dest(e), VertexId(b), "{points:?} {segments:?}");
                assert!(cdt.triangulation.is_constrained(e), "{points:?} {segments:?}");
            }
        }
        Err(CdtError::Crossing { first, second }) => {
            assert!(cross(ends(first), ends(second)), "{points:?} {segments:?}");
        }
        Err(CdtError::Through { segment, vertex, .. }) => {
            let vertex = points[vertex as usize];
            assert!(is_inside_segment(vertex, ends(segment)), "{points:?} {segments:?}");
        }
        Err(other) => panic!("the input is sound, but {other}: {points:?} {segments:?}"),
    }
}

/// The points without repetitions, in their order.
fn distinct(points: Vec<Point2>) -> Vec<Point2> {
    let mut seen = BTreeSet::new();
    points.into_iter().filter(|p| seen.insert(p.key())).collect()
}

fn segments(decoder: &mut Decoder<'_>, points: u32) -> Vec<[u32; 2]> {
    if points < 2 {
        return Vec::new();
    }
    let count = decoder.below(9);
    let pairs = (0..count).map(|_| [decoder.below(points), decoder.below(points)]);
    pairs.filter(|[a, b]| a != b).collect()
}
