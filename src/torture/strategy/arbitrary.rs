//! Arbitrary values for fuzz targets.

use crate::torture::generate::{Case, Selection};
use arbitrary::{Arbitrary, Result, Unstructured};

/// Nine bytes: the seed, and the family. A fuzzer that keeps the family and changes the seed stays
/// with one kind of boundary.
///
/// ```no_run
/// # macro_rules! fuzz_target { (|$case:ident: $t:ty| $body:block) => { fn target($case: $t) $body } }
/// use trigrade::torture::generate::{Case, Claim};
/// # fn my_mesher(_: &trigrade::domain::Domain) -> Result<(), ()> { Ok(()) }
///
/// fuzz_target!(|case: Case| {
///     assert_eq!(my_mesher(&case.domain).is_ok(), case.claim == Claim::Valid);
/// });
/// ```
impl<'a> Arbitrary<'a> for Case {
    fn arbitrary(bytes: &mut Unstructured<'a>) -> Result<Self> {
        let (seed, family) = (bytes.arbitrary()?, bytes.arbitrary::<u8>()?);
        let case = Selection::new(seed).case(u64::from(family));
        Ok(case.expect("all families are selected"))
    }

    fn size_hint(_depth: usize) -> (usize, Option<usize>) {
        (9, Some(9))
    }
}
