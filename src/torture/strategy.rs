//! The boundaries as values of test frameworks: each behind a feature of its name.
//!
//! | feature | what it gives |
//! |---|---|
//! | `proptest` | `proptest::cases`, a strategy |
//! | `quickcheck` | `impl quickcheck::Arbitrary for Case` |
//! | `arbitrary` | `impl arbitrary::Arbitrary for Case`, for fuzz targets |
//!
//! The first two shrink by [`candidates`](super::shrink::candidates), so that what is reported is a
//! boundary of a few vertices that still has the claim of the one that failed.

#[cfg(feature = "arbitrary")]
mod arbitrary;
#[cfg(feature = "proptest")]
pub mod proptest;
#[cfg(feature = "quickcheck")]
mod quickcheck;

#[cfg(any(feature = "proptest", feature = "quickcheck"))]
use super::generate::Case;

/// Simpler cases one step away.
#[cfg(any(feature = "proptest", feature = "quickcheck"))]
fn simpler(case: &Case) -> impl Iterator<Item = Case> + use<> {
    let case = case.clone();
    super::shrink::candidates(&case.domain, case.claim)
        .map(move |domain| Case { domain, ..case.clone() })
}
