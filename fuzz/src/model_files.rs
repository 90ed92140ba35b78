//! Target: the readers of surface models. Any bytes give a model whose surfaces can be evaluated, or
//! an error with its rule.

use trigrade::format::model_file::{ModelForm, read_model};
use trigrade::surface::Side;

/// More would only be slow: evaluation is not what this target is about.
const PATCHES_MAX: usize = 20;

/// One input: the first byte chooses the form, the rest is the file.
pub fn run(bytes: &[u8]) {
    let Some((&choice, file)) = bytes.split_first() else { return };
    let (form, _) = ModelForm::ALL[usize::from(choice) % ModelForm::ALL.len()];
    let model = match read_model(file, form) {
        Ok(model) => model,
        Err(error) => {
            assert!(!error.to_string().is_empty() && !error.problem.id().is_empty());
            return;
        }
    };
    assert!(model.patches.len() <= file.len(), "{} patches", model.patches.len());
    assert!(model.trims.keys().all(|&patch| patch < model.patches.len()));
    for patch in model.patches.iter().take(PATCHES_MAX) {
        let [[u0, u1], [v0, v1]] = patch.surface.domain();
        assert!(u0 < u1 && v0 < v1, "{:?}", patch.surface.domain());
        let _ = patch.surface.jet(0.5 * (u0 + u1), 0.5 * (v0 + v1));
        for piece in patch.surface.pieces() {
            let _ = Side::ALL.map(|side| piece.side(side).pieces().len());
        }
    }
    let _ = model.diagonal();
}
