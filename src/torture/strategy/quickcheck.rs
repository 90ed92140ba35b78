//! Arbitrary values of quickcheck.

use super::simpler;
use crate::torture::generate::{Case, Selection};
use quickcheck::{Arbitrary, Gen};

/// No family goes above this many vertices for each unit of quickcheck's size (100 by default).
const VERTICES_PER_SIZE: usize = 10;

/// ```
/// use trigrade::domain::validate::validate;
/// use trigrade::torture::generate::{Case, Claim};
///
/// fn is_told_apart(case: Case) -> bool {
///     // Your mesher in place of our validation.
///     validate(&case.domain).is_ok() == (case.claim == Claim::Valid)
/// }
/// quickcheck::QuickCheck::new().tests(20).quickcheck(is_told_apart as fn(Case) -> bool);
/// ```
impl Arbitrary for Case {
    fn arbitrary(g: &mut Gen) -> Self {
        let size_max = g.size().saturating_mul(VERTICES_PER_SIZE);
        let (seed, index) = (u64::arbitrary(g), u64::from(u32::arbitrary(g)));
        let selection = Selection { size_max, ..Selection::new(seed) };
        selection.case(index).expect("all families are selected")
    }

    fn shrink(&self) -> Box<dyn Iterator<Item = Self>> {
        Box::new(simpler(self))
    }
}
