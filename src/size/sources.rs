//! Sources: points, discs and lines with a spacing of their own, from which it grows.

use super::boxes::{Boxed, Boxes, between, nearest_on_segment};
use crate::point::Point2;

/// A place that asks for a spacing: a segment, all within a radius of it; a point is a segment with
/// equal ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SizeSource {
    /// Ends of the segment.
    pub ends: [Point2; 2],
    /// How far around it the spacing is the same.
    pub radius: f64,
    /// The spacing there.
    pub spacing: f64,
}

impl SizeSource {
    /// A point, or with a radius a disc.
    #[must_use]
    pub const fn point(at: Point2, spacing: f64, radius: f64) -> Self {
        Self { ends: [at, at], radius, spacing }
    }

    /// A line.
    #[must_use]
    pub const fn line(ends: [Point2; 2], spacing: f64) -> Self {
        Self { ends, radius: 0.0, spacing }
    }

    /// Whether its numbers make sense: finite ends, a radius from 0, a spacing above 0.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        self.ends.iter().all(|p| p.is_finite())
            && self.radius.is_finite()
            && self.radius >= 0.0
            && self.spacing.is_finite()
            && self.spacing > 0.0
    }

    /// The spacing it allows at `p`, growing by `growth` per unit of distance.
    fn at(&self, p: Point2, growth: f64) -> f64 {
        let foot = between(self.ends, nearest_on_segment(self.ends, p));
        self.spacing + growth * (foot.distance(p) - self.radius).max(0.0)
    }
}

impl Boxed for SizeSource {
    fn bounds(&self) -> [Point2; 2] {
        let ([a, b], r) = (self.ends, self.radius);
        [
            Point2::new(a.x.min(b.x) - r, a.y.min(b.y) - r),
            Point2::new(a.x.max(b.x) + r, a.y.max(b.y) + r),
        ]
    }

    fn least(&self) -> f64 {
        self.spacing
    }
}

/// The smallest of what all sources allow.
#[derive(Debug)]
pub struct SourceField {
    growth: f64,
    sources: Boxes<SizeSource>,
}

impl SourceField {
    /// A field of sound sources; slope `growth`, at least 0.
    #[must_use]
    pub fn new(sources: Vec<SizeSource>, growth: f64) -> Self {
        debug_assert!(sources.iter().all(SizeSource::is_sound), "sources with senseless numbers");
        Self { growth, sources: Boxes::new(sources) }
    }

    /// The spacing allowed at `p`: min over sources of `h_s` + growth max(0, distance - radius);
    /// infinite without sources. Logarithmic time on ordinary sources.
    #[must_use]
    pub fn at(&self, p: Point2) -> f64 {
        let growth = self.growth;
        self.sources.smallest(p, growth, |s| s.at(p, growth)).map_or(f64::INFINITY, |(_, h)| h)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn p(x: f64, y: f64) -> Point2 {
        Point2::new(x, y)
    }

    // spec: H8
    #[test]
    fn points_discs_and_lines_grow_from_where_they_end() {
        let field = SourceField::new(
            vec![
                SizeSource::point(p(0.0, 0.0), 0.5, 0.0),
                SizeSource::point(p(100.0, 0.0), 0.25, 3.0),
                SizeSource::line([p(200.0, 0.0), p(210.0, 0.0)], 0.125),
            ],
            0.5,
        );
        assert_eq!(field.at(p(0.0, 0.0)), 0.5);
        assert_eq!(field.at(p(3.0, 4.0)), 3.0);
        assert_eq!(field.at(p(102.0, 2.0)), 0.25, "inside the disc");
        assert_eq!(field.at(p(105.0, 0.0)), 1.25);
        assert_eq!(field.at(p(205.0, -2.0)), 1.125);
        assert_eq!(field.at(p(213.0, 4.0)), 2.625, "beyond the line's end");
    }

    // spec: H8
    #[test]
    fn no_growth_and_no_sources() {
        let flat = SourceField::new(vec![SizeSource::point(p(1.0, 1.0), 2.0, 0.0)], 0.0);
        assert_eq!(flat.at(p(1e9, -1e9)), 2.0);
        assert_eq!(SourceField::new(Vec::new(), 0.3).at(p(0.0, 0.0)), f64::INFINITY);
    }

    // spec: !H8
    #[test]
    fn senseless_sources_are_told_apart() {
        let sound = SizeSource::point(p(0.0, 0.0), 1.0, 1.0);
        assert!(sound.is_sound());
        for wrong in [
            SizeSource { spacing: 0.0, ..sound },
            SizeSource { spacing: f64::INFINITY, ..sound },
            SizeSource { radius: -1.0, ..sound },
            SizeSource { radius: f64::NAN, ..sound },
            SizeSource { ends: [p(0.0, f64::NAN), p(0.0, 0.0)], ..sound },
        ] {
            assert!(!wrong.is_sound(), "{wrong:?}");
        }
    }
}
