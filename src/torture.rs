//! Torture: adversarial boundaries for any mesher, judged exactly, shrunk to small reproducers.
//!
//! ```text
//! generate -> export -> run -> judge -> shrink -> report
//! verdict     .poly     any    check    fewest    HTML, JSON,
//! known       .geo ...  tool            vertices  corpus
//! ```
//!
//! [`generate::case`] gives boundaries whose verdict is known by construction; [`judge`] says what is
//! wrong with an answer. Both are for the tests of any mesher, in any program. Nothing here
//! calls the mesher of this crate.

pub mod export;
pub mod generate;
pub mod judge;
pub mod prng;
#[cfg(feature = "cli")]
pub mod report;
#[cfg(feature = "cli")]
pub mod run;
pub mod shrink;
