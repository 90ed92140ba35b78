//! Torture: adversarial boundaries for any mesher, judged exactly, shrunk to small reproducers.
//!
//! ```text
//! generate -> export -> run -> judge -> shrink -> report
//! verdict     .poly     any    check    fewest    HTML, JSON,
//! known       .geo ...  tool            vertices  corpus
//! ```
//!
//! [`generate::case`] gives boundaries whose verdict is known by construction, [`judge::judge`] says
//! what is wrong with an answer, and [`shrink::shrink`] makes the boundary small. All are for the
//! tests of any mesher, in any program. Nothing here calls the mesher of this crate.
//!
//! A test of another mesher:
//!
//! ```
//! use trigrade::mesh::MeshData;
//! use trigrade::torture::generate::{Case, case};
//! use trigrade::torture::judge::{Answer, Class, Demands, judge};
//!
//! fn answer(case: &Case) -> Answer {
//!     // Call your mesher here, and turn its triangles into plain arrays.
//!     # if true { return Answer::NotAsked("an example".into()) };
//!     Answer::Mesh(Box::new(MeshData::default()))
//! }
//!
//! for index in 0..50 {
//!     let case = case(2024, index);
//!     let verdict = judge(&case.domain, case.claim, &answer(&case), &Demands::default());
//!     assert!(!verdict.class.is_failure(), "{} {index}: {}", case.family, verdict.reason);
//! }
//! ```
//!
//! For proptest, quickcheck and fuzz targets see [`strategy`]. The family is that of the index, so
//! a failure names itself by two numbers.

pub mod export;
pub mod generate;
pub mod judge;
pub mod prng;
#[cfg(feature = "cli")]
pub mod report;
#[cfg(feature = "cli")]
pub mod run;
pub mod shrink;
pub mod strategy;
