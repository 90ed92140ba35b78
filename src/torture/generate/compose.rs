//! Boundaries put together: one in the hole of another, one beside another.

use super::draft::{Draft, Ring, rectangle};
use crate::domain::LoopRole;
use crate::torture::prng::Prng;

/// The largest extent that is put together with others, so that the lattice has room.
const EXTENT_MAX: i64 = 1 << 50;

/// Whether a draft can be put together with others.
#[must_use]
pub fn can_be_joined(draft: &Draft) -> bool {
    !draft.carved && draft.extent() < EXTENT_MAX
}

/// Draws a rectangle around a draft, at least one unit away: inside and outside change places.
/// Roles go; nesting decides.
#[must_use]
pub fn framed(mut draft: Draft, prng: &mut Prng) -> Draft {
    let margin = prng.magnitude(10);
    let extent = draft.extent();
    draft.move_to([margin, margin]);
    for ring in &mut draft.rings {
        ring.role = LoopRole::Any;
    }
    let side = extent + 2 * margin;
    let sites = rectangle([0, 0], [side, side]);
    draft.rings.insert(0, Ring { sites, role: LoopRole::Any });
    draft
}

/// Puts two drafts beside each other, at least one unit apart.
#[must_use]
pub fn beside(mut left: Draft, mut right: Draft, prng: &mut Prng) -> Draft {
    left.move_to([0, 0]);
    let x = left.bounds()[1][0] + prng.magnitude(10);
    right.move_to([x, 0]);
    left.append(right);
    left
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::validate::validate;
    use crate::torture::generate::draft::Dress;

    #[test]
    fn what_is_put_together_is_valid_when_its_parts_are() {
        let mut prng = Prng::new(1);
        let pair = beside(Draft::square(5), Draft::square(3), &mut prng);
        let both = framed(pair, &mut prng);
        assert_eq!(both.rings.len(), 3);
        assert!(validate(&both.domain(&Dress::PLAIN)).is_ok());
    }

    #[test]
    fn unclosed_chains_stay_alone() {
        assert!(can_be_joined(&Draft::square(5)));
        assert!(!can_be_joined(&Draft { carved: true, ..Draft::square(5) }));
        assert!(!can_be_joined(&Draft::square(1 << 51)));
    }
}
