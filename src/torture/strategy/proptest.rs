//! A strategy of proptest.

use super::simpler;
use crate::torture::generate::{Case, Selection};
use proptest::arbitrary::any;
use proptest::strategy::{NewTree, Strategy, ValueTree};
use proptest::test_runner::TestRunner;

/// Boundaries of a selection; its seed is replaced by proptest's own randomness.
///
/// ```
/// use proptest::prelude::*;
/// use trigrade::domain::validate::validate;
/// use trigrade::torture::generate::{Claim, Selection};
/// use trigrade::torture::strategy::proptest::cases;
///
/// proptest!(ProptestConfig::with_cases(20), |(case in cases(Selection::new(0)))| {
///     // Your mesher in place of our validation.
///     prop_assert_eq!(validate(&case.domain).is_ok(), case.claim == Claim::Valid);
/// });
/// ```
#[must_use]
pub fn cases(selection: Selection) -> Cases {
    Cases { selection }
}

/// What [`cases`] returns.
#[derive(Clone, Debug)]
pub struct Cases {
    selection: Selection,
}

impl Strategy for Cases {
    type Tree = Shrinking;
    type Value = Case;

    fn new_tree(&self, runner: &mut TestRunner) -> NewTree<Self> {
        let (seed, index) = any::<(u64, u32)>().new_tree(runner)?.current();
        let selection = Selection { seed, ..self.selection.clone() };
        let case = selection.case(u64::from(index)).ok_or("no family of boundaries is selected")?;
        Ok(Shrinking { best: case.clone(), current: case, next: None })
    }
}

/// A case that is being shrunk.
pub struct Shrinking {
    /// The simplest that failed.
    best: Case,
    /// The one that is tried.
    current: Case,
    /// What else to try in place of `best`.
    next: Option<Box<dyn Iterator<Item = Case>>>,
}

impl std::fmt::Debug for Shrinking {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Shrinking").field("best", &self.best).finish_non_exhaustive()
    }
}

impl Shrinking {
    /// Goes on to what is next in place of `best`, or back to it.
    fn advance(&mut self) -> bool {
        let next = self.next.as_mut().and_then(Iterator::next);
        let is_left = next.is_some();
        self.current = next.unwrap_or_else(|| self.best.clone());
        is_left
    }
}

impl ValueTree for Shrinking {
    type Value = Case;

    fn current(&self) -> Case {
        self.current.clone()
    }

    /// The current case failed: it is the best so far, and all begins anew from it.
    fn simplify(&mut self) -> bool {
        self.best = self.current.clone();
        self.next = Some(Box::new(simpler(&self.best)));
        self.advance()
    }

    /// The current case did not fail.
    fn complicate(&mut self) -> bool {
        self.advance()
    }
}
