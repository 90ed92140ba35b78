//! Boundaries whose verdict is known by construction.
//!
//! Every family draws on the integer lattice and proves its claim there with exact integers; a
//! dress then turns sites into doubles by exact steps only (quarter turns, a mirror, shifts by
//! integers, powers of two), so the claim survives. The tests hold each claim against
//! [`validate`](crate::domain::validate::validate), which knows nothing of how a boundary was made.

mod cells;
mod chains;
mod compose;
mod draft;
mod gaps;
mod holes;
mod invalid;
mod koch;
mod lattice;
mod random;
mod stars;

use super::prng::Prng;
use crate::domain::Domain;
use draft::{Draft, Dress};
use serde::{Deserialize, Serialize};

/// What a mesher must make of a boundary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Claim {
    /// It must be meshed.
    Valid,
    /// It must be refused; the SPEC 3 id of the fault that it was given.
    Invalid(&'static str),
}

impl std::fmt::Display for Claim {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Valid => f.write_str("valid"),
            Self::Invalid(fault) => write!(f, "invalid ({fault})"),
        }
    }
}

/// A kind of boundary.
#[derive(Clone, Copy, Debug)]
pub struct Family {
    /// Its name on the command line and in reports.
    pub name: &'static str,
    /// What its boundaries look like.
    pub about: &'static str,
    /// What must become of them.
    pub claim: Claim,
    make: fn(&mut Prng, usize) -> Draft,
}

impl Family {
    const fn valid(
        name: &'static str,
        about: &'static str,
        make: fn(&mut Prng, usize) -> Draft,
    ) -> Self {
        Self { name, about, claim: Claim::Valid, make }
    }

    const fn invalid(
        name: &'static str,
        fault: &'static str,
        about: &'static str,
        make: fn(&mut Prng, usize) -> Draft,
    ) -> Self {
        Self { name, about, claim: Claim::Invalid(fault), make }
    }
}

/// The families of valid boundaries.
const VALID: [Family; 23] = [
    chains::NEAR_COLLINEAR,
    chains::NEEDLES,
    chains::JUMPS,
    chains::NEAR_DUPLICATES,
    chains::ZIPPER,
    gaps::GAPS,
    gaps::SLIVER,
    gaps::FAN,
    cells::COMB,
    cells::SPIRAL,
    cells::HILBERT,
    cells::MAZE,
    cells::GRID,
    koch::KOCH,
    stars::STARS,
    stars::COCIRCULAR,
    random::GROWN,
    random::TWO_OPT,
    holes::NESTED,
    holes::TOUCHING,
    holes::MANY_HOLES,
    holes::ISLANDS,
    holes::HANGING,
];

/// Every family, the valid ones first.
pub fn families() -> impl Iterator<Item = &'static Family> {
    VALID.iter().chain(&invalid::FAMILIES)
}

/// Names of the ways in which coordinates are dressed; the first one leaves small integers.
pub const DRESSES: [&str; 6] = Dress::NAMES;

/// A boundary with its verdict.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// Its number in the run.
    pub index: u64,
    /// Name of its family.
    pub family: &'static str,
    /// How its coordinates are dressed, one of [`DRESSES`].
    pub dress: &'static str,
    /// What must become of it.
    pub claim: Claim,
    /// The boundary.
    pub domain: Domain,
}

/// Which cases are drawn, and how hard they are.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Selection {
    /// Everything follows from it.
    pub seed: u64,
    /// Names of the families; empty for all.
    pub families: Vec<String>,
    /// No family goes far above this number of vertices.
    pub size_max: usize,
    /// Leave coordinates as moderate integers, for meshers that work with tolerances.
    pub plain: bool,
}

impl Selection {
    /// All families at full difficulty.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self { seed, families: Vec::new(), size_max: 3000, plain: false }
    }

    /// The families that are drawn from.
    #[must_use]
    pub fn drawn(&self) -> Vec<&'static Family> {
        let is_wanted = |family: &&Family| {
            self.families.is_empty() || self.families.iter().any(|name| name == family.name)
        };
        families().filter(is_wanted).collect()
    }

    /// The case with a number: the families take turns. `None` when no family is selected.
    ///
    /// # Complexity
    /// O(n^2) for a random polygon of n <= 120 vertices, else O(n log n).
    #[must_use]
    pub fn case(&self, index: u64) -> Option<Case> {
        let drawn = self.drawn();
        let family = drawn.get((index % drawn.len().max(1) as u64) as usize)?;
        let mut prng = Prng::of(self.seed, index);
        let size = size(&mut prng).min(self.size_max);
        let draft = (family.make)(&mut prng, size);
        let draft = put_together(draft, family.claim, &mut prng);
        let dress = match self.plain {
            true => Dress::PLAIN,
            false => Dress::choose(&draft, &mut prng),
        };
        let domain = draft.domain(&dress);
        Some(Case { index, family: family.name, dress: dress.name, claim: family.claim, domain })
    }
}

/// Mostly small, for small cases find most faults; now and then large.
fn size(prng: &mut Prng) -> usize {
    let most = match prng.below(128) {
        0 => 3000,
        1..=7 => 200,
        8..=63 => 40,
        _ => 10,
    };
    3 + prng.below(most) as usize
}

/// One in four drafts gets company: a frame, or a neighbour of another valid family.
fn put_together(draft: Draft, claim: Claim, prng: &mut Prng) -> Draft {
    if !compose::can_be_joined(&draft) || !prng.one_in(4) {
        return draft;
    }
    // A frame takes roles away, and with them the faults of roles.
    let is_about_roles = matches!(claim, Claim::Invalid("D10" | "D11" | "D12"));
    if prng.one_in(2) && !is_about_roles {
        return compose::framed(draft, prng);
    }
    let neighbour = (prng.pick(&VALID).make)(prng, 6);
    if compose::can_be_joined(&neighbour) {
        return compose::beside(draft, neighbour, prng);
    }
    draft
}

/// The case with a number under a seed, of any family: for the tests of any mesher.
///
/// ```
/// use trigrade::torture::generate::{Claim, case};
///
/// for index in 0..200 {
///     let case = case(7, index);
///     let mesh = my_mesher(&case.domain); // your own
///     assert_eq!(mesh.is_ok(), case.claim == Claim::Valid, "{} {index}", case.family);
/// }
/// # use trigrade::domain::{Domain, validate::{Fault, validate}};
/// # fn my_mesher(domain: &Domain) -> Result<(), Vec<Fault>> { validate(domain).map(|_| ()) }
/// ```
#[must_use]
pub fn case(seed: u64, index: u64) -> Case {
    Selection::new(seed).case(index).expect("all families are selected")
}

#[cfg(test)]
mod tests;
