//! Surfaces in space.

use super::plane::Run;

pub(super) fn check(run: &mut Run<'_>) {
    run.could_not_run.push("surfaces in space are not checked yet".to_owned());
}
