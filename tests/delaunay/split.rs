//! Segments cut at their crossings.

use crate::clouds::{self, Random};
use trigrade::delaunay::{CdtError, Split, cdt, split_at_points, split_crossings};
use trigrade::point::Point2;

fn p(x: f64, y: f64) -> Point2 {
    Point2::new(x, y)
}

/// Splits, and checks that the pieces are what `cdt` accepts and that none strays from its parent.
fn split(points: &[Point2], segments: &[[u32; 2]]) -> Split {
    let split = split_crossings(points, segments).expect("sound input");
    assert_eq!(&split.points[..points.len()], points);
    assert_eq!(split.segments.len(), split.parents.len());
    assert!(split.segments.is_sorted_by(|a, b| a < b));
    let result = cdt(&split.points, &split.segments).expect("the pieces do not cross");
    result.triangulation.verify_geometry(&split.points).expect("constrained Delaunay");
    split
}

/// Distance of a point from a line, rounded, relative to the size of the coordinates.
fn stray([a, b]: [Point2; 2], q: Point2) -> f64 {
    let cross = (b.x - a.x) * (q.y - a.y) - (b.y - a.y) * (q.x - a.x);
    cross.abs() / a.distance(b) / (1.0 + a.x.abs().max(a.y.abs()))
}

// spec: T9
#[test]
fn two_diagonals_meet_in_the_middle() {
    let square = [p(0.0, 0.0), p(1.0, 0.0), p(1.0, 1.0), p(0.0, 1.0)];
    let found = split(&square, &[[0, 2], [3, 1]]);
    assert_eq!(found.points[4..], [p(0.5, 0.5)]);
    assert_eq!(found.segments, [[0, 4], [1, 4], [2, 4], [3, 4]]);
    assert_eq!(found.parents, [0, 1, 0, 1]);
}

// spec: T9
#[test]
fn overlaps_and_points_on_segments_are_cut_at_the_points() {
    let line: Vec<_> = (0..5).map(|i| p(f64::from(i), 2.0 * f64::from(i))).collect();
    let found = split(&line, &[[0, 3], [4, 1]]);
    assert_eq!(found.points, line);
    assert_eq!(found.segments, [[0, 1], [1, 2], [2, 3], [3, 4]]);
    assert_eq!(found.parents, [0, 0, 0, 1]);
    assert_eq!(found.covered, [[0, 0], [1, 0], [1, 1], [2, 0], [2, 1], [3, 1]]);
}

// spec: T10
#[test]
fn segments_are_cut_at_the_points_inside_them_and_nowhere_else() {
    let line: Vec<_> = (0..5).map(|i| p(0.1 * f64::from(i), 0.0)).collect();
    let found = split_at_points(&line, &[[0, 3], [4, 1]]).unwrap();
    assert_eq!((found.points, found.segments), (line, vec![[0, 1], [1, 2], [2, 3], [3, 4]]));
    let grid: Vec<_> = (0..49).map(|i| p(f64::from(i % 7), f64::from(i / 7))).collect();
    // Rows, columns and diagonals through the points; diagonals one way only.
    let segments: Vec<[u32; 2]> = (0..7)
        .flat_map(|i| [[7 * i, 7 * i + 6], [i, 42 + i], [i, 7 * i]])
        .filter(|s| s[0] != s[1])
        .collect();
    let found = split_at_points(&grid, &segments).unwrap();
    assert_eq!(found.points, grid);
    let exact = split_crossings(&grid, &segments).unwrap();
    assert_eq!((found.segments, found.covered), (exact.segments, exact.covered));
}

// spec: T10 !T10
#[test]
fn segments_that_cross_where_there_is_no_point_are_named() {
    let square = [p(0.0, 0.0), p(2.0, 0.0), p(2.0, 2.0), p(0.0, 2.0), p(1.0, 1.0)];
    assert!(split_at_points(&square, &[[0, 2], [1, 3]]).is_ok());
    let error = split_at_points(&square[..4], &[[0, 1], [2, 0], [1, 3]]).unwrap_err();
    assert_eq!(error, CdtError::Crossing { first: 1, second: 2 });
    // The piece that is crossed belongs to a segment given twice: the first is named.
    let error = split_at_points(&square[..4], &[[0, 2], [2, 0], [1, 3]]).unwrap_err();
    assert!(matches!(error, CdtError::Crossing { second: 2, .. }));
}

// spec: T9
#[test]
fn a_segment_through_a_crossing_of_two_others_shares_its_point() {
    let star = [p(0.0, 0.0), p(2.0, 2.0), p(0.0, 2.0), p(2.0, 0.0), p(1.0, -1.0), p(1.0, 3.0)];
    let found = split(&star, &[[0, 1], [2, 3], [4, 5]]);
    assert_eq!(found.points.len(), 7);
    assert_eq!(found.segments.len(), 6);
}

// spec: T9
#[test]
fn tangles_of_random_segments_come_apart() {
    for seed in 0..10 {
        let points = clouds::uniform(60, seed);
        let mut random = Random::new(seed);
        let segments: Vec<[u32; 2]> = (0..80)
            .map(|_| [random.below(60) as u32, random.below(60) as u32])
            .filter(|[a, b]| a != b)
            .collect();
        let found = split(&points, &segments);
        assert!(found.points.len() > 300, "a tangle crosses often");
        for (piece, &parent) in found.segments.iter().zip(&found.parents) {
            let line = segments[parent as usize].map(|v| points[v as usize]);
            for v in piece {
                assert!(stray(line, found.points[*v as usize]) < 1e-13);
            }
        }
    }
}

// spec: T9
#[test]
fn crossings_that_round_together_still_come_apart() {
    // A fan of segments whose crossings lie closer than neighbouring floats.
    let mut points = Vec::new();
    for i in 0..30 {
        let tiny = f64::from(i) * f64::EPSILON;
        points.extend([p(0.0, 1.0 + tiny), p(1.0, 1.0 + f64::from(29 - i) * f64::EPSILON)]);
    }
    let segments: Vec<[u32; 2]> = (0..30).map(|i| [2 * i, 2 * i + 1]).collect();
    split(&points, &segments);
    for (name, points) in clouds::all(40) {
        if name != "extremes" {
            let n = points.len() as u32;
            let segments: Vec<[u32; 2]> = (0..n).map(|i| [i, (i * 7 + 3) % n]).collect();
            let segments: Vec<_> = segments.into_iter().filter(|[a, b]| a != b).collect();
            split(&points, &segments);
        }
    }
}

// spec: T9
#[test]
fn nothing_to_cut_changes_nothing() {
    let points = clouds::uniform(5, 3);
    let found = split(&points, &[[3, 0], [0, 3]]);
    assert_eq!((found.points, found.segments, found.parents), (points, vec![[0, 3]], vec![0]));
    assert_eq!(found.covered, [[0, 0], [0, 1]]);
    assert_eq!(split(&[], &[]), Split::default());
}

// spec: T4
#[test]
fn unsound_input_is_an_error_here_too() {
    let twice = [p(0.0, 0.0), p(1.0, 1.0), p(0.0, 0.0)];
    let error = split_crossings(&twice, &[[0, 1]]).unwrap_err();
    assert!(matches!(error, CdtError::Duplicate { first: 0, second: 2, .. }));
    let error = split_crossings(&twice, &[[0, 3]]).unwrap_err();
    assert_eq!(
        error.to_string(),
        "segment 0 joins points 0 and 3, which are not two of the 3 points"
    );
}
