//! The smallest of several fields.

use super::growth::GrowthField;
use super::sources::SourceField;
use super::table::TableField;
use super::{Base, Hint, SizeField};
use crate::point::Point2;

/// A field and what keeps it down.
#[derive(Debug)]
pub struct Composed {
    /// What would be without the others.
    pub base: SizeField,
    /// The growth-limited field below `base`, when it is asked for.
    pub limit: Option<GrowthField>,
    /// Nowhere more than this; infinite for no bound.
    pub cap: f64,
    /// Points, discs, lines, markers.
    pub sources: Option<SourceField>,
    /// A background mesh of the user's.
    pub table: Option<TableField>,
    /// Largest spacings of regions.
    pub regions: Option<RegionCaps>,
    /// All of it times this, to make the mesh coarser or finer.
    pub factor: f64,
}

/// For each triangle of the background mesh the largest spacing that its region allows.
#[derive(Debug)]
pub struct RegionCaps {
    /// Region of each background triangle, by its slot: an index into `caps`.
    pub regions: Vec<u32>,
    /// Largest spacing of each.
    pub caps: Vec<f64>,
}

impl Composed {
    /// A field as it is.
    #[must_use]
    pub const fn plain(base: SizeField) -> Self {
        Self {
            base,
            limit: None,
            cap: f64::INFINITY,
            sources: None,
            table: None,
            regions: None,
            factor: 1.0,
        }
    }

    /// Whether the field is the base and nothing else.
    #[must_use]
    pub const fn is_plain(&self) -> bool {
        self.limit.is_none()
            && self.cap == f64::INFINITY
            && self.sources.is_none()
            && self.table.is_none()
            && self.regions.is_none()
            && self.factor == 1.0
    }

    /// The spacing at `p`: `factor` times the smallest.
    pub fn at(&self, p: Point2, base: Base, hint: &mut Hint) -> f64 {
        // The base field may move the hint, but never across a border: the region is the same.
        let mut h = self.base.at(p, base, hint).min(self.cap);
        if let Some(limit) = &self.limit {
            h = h.min(limit.at(p));
        }
        if let Some(sources) = &self.sources {
            h = h.min(sources.at(p));
        }
        if let Some(table) = &self.table {
            h = h.min(table.at(p));
        }
        if let Some(regions) = &self.regions {
            h = h.min(regions.at(*hint));
        }
        self.factor * h
    }

    /// Whether the slope is bounded.
    #[must_use]
    pub fn is_lipschitz(&self) -> bool {
        self.limit.is_some() || self.base.is_lipschitz()
    }
}

impl RegionCaps {
    fn at(&self, hint: Hint) -> f64 {
        let region = self.regions.get(hint.0.index());
        region.map_or(f64::INFINITY, |&region| self.caps[region as usize])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::size::{SizeSource, SpacingTable};
    use crate::triangulation::TriangleId;

    fn at(field: &Composed, x: f64, y: f64) -> f64 {
        field.at(Point2::new(x, y), Base { length: 1.0 }, &mut Hint(TriangleId(1)))
    }

    #[test]
    fn hints_are_heeded_where_the_answer_depends_on_the_background_triangle() {
        let mut field = Composed::plain(SizeField::Uniform(8.0));
        field.cap = 6.0;
        let heeds = |field: Composed| SizeField::Composed(Box::new(field)).heeds_hint();
        assert!(!SizeField::Uniform(1.0).heeds_hint() && !SizeField::BaseLength(1.5).heeds_hint());
        assert!(!heeds(field));
        let mut field = Composed::plain(SizeField::Uniform(8.0));
        field.regions = Some(RegionCaps { regions: vec![0, 1], caps: vec![2.0, 4.0] });
        assert!(heeds(field));
    }

    // spec: H8
    #[test]
    fn the_smallest_of_all_counts() {
        let mut field = Composed::plain(SizeField::Uniform(8.0));
        assert!(field.is_plain() && field.is_lipschitz());
        assert_eq!(at(&field, 0.0, 0.0), 8.0);
        field.cap = 6.0;
        assert_eq!(at(&field, 0.0, 0.0), 6.0);
        let source = SizeSource::point(Point2::new(0.0, 0.0), 1.0, 0.0);
        field.sources = Some(SourceField::new(vec![source], 0.5));
        assert_eq!(
            [at(&field, 0.0, 0.0), at(&field, 0.0, 4.0), at(&field, 99.0, 0.0)],
            [1.0, 3.0, 6.0]
        );
        let points = [[90.0, 0.0], [99.0, 0.0], [90.0, 9.0]].map(Point2::from).to_vec();
        let table = SpacingTable { points, spacing: vec![2.0; 3], triangles: vec![[0, 1, 2]] };
        field.table = Some(TableField::new(&table, 0.5));
        assert_eq!(at(&field, 91.0, 1.0), 2.0);
        field.regions = Some(RegionCaps { regions: vec![0, 1], caps: vec![0.1, 1.5] });
        assert_eq!(at(&field, 91.0, 1.0), 1.5, "the region of triangle 1");
        field.factor = 0.5;
        assert_eq!(at(&field, 91.0, 1.0), 0.75);
        assert!(!field.is_plain());
    }

    // spec: H8
    #[test]
    fn a_limit_makes_any_field_s_slope_bounded() {
        let mut field = Composed::plain(SizeField::BaseLength(1.2));
        assert!(!field.is_lipschitz());
        let source = super::super::Source { at: Point2::new(0.0, 0.0), spacing: 0.5 };
        field.limit = Some(GrowthField::new(&[source], 0.25));
        assert!(field.is_lipschitz());
        assert_eq!(at(&field, 0.0, 0.0), 0.5);
    }
}
