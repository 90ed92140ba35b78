//! Files of surface models: which form a file has, and reading it.

use super::domain_file::{DomainReadError, without_mark};
#[cfg(feature = "step")]
use super::step;
use super::{bpt, iges, model_json, nurbs_json};
use crate::model::Model;
use serde_json::Value;
use std::path::Path;

/// The forms of model files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ModelForm {
    /// trigrade JSON (SPEC 12.3).
    Json,
    /// Bezier patches.
    Bpt,
    /// NURBS surfaces as JSON, as geomdl writes them.
    Nurbs,
    /// IGES, fixed-length ASCII.
    Iges,
    /// STEP, ISO 10303-21.
    #[cfg(feature = "step")]
    Step,
}

impl ModelForm {
    /// All forms with the names that `--from` takes.
    pub const ALL: &'static [(Self, &'static str)] = &[
        (Self::Json, "model"),
        (Self::Bpt, "bpt"),
        (Self::Nurbs, "nurbs"),
        (Self::Iges, "iges"),
        #[cfg(feature = "step")]
        (Self::Step, "step"),
    ];

    /// The form of this name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().find(|(_, known)| *known == name).map(|&(form, _)| form)
    }

    /// The form of a file: by the extension `bpt`, `igs` or `iges` (with the feature `step` also `step`,
    /// `stp`, `p21`) in any case, or JSON by its keys:
    /// `patches` or `"format": "trigrade-model"`, `shape` or `degree_u` and `degree_v`.
    #[must_use]
    pub fn of(path: &Path, bytes: &[u8]) -> Option<Self> {
        let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default();
        match extension.to_ascii_lowercase().as_str() {
            "bpt" => Some(Self::Bpt),
            "igs" | "iges" => Some(Self::Iges),
            #[cfg(feature = "step")]
            "step" | "stp" | "p21" => Some(Self::Step),
            "json" => Self::of_json(bytes),
            _ => None,
        }
    }

    fn of_json(bytes: &[u8]) -> Option<Self> {
        let bytes = without_mark(bytes);
        if bytes.trim_ascii_start().first() != Some(&b'{') {
            return None;
        }
        let value: Value = serde_json::from_slice(bytes).ok()?;
        if model_json::is_model_value(&value) {
            return Some(Self::Json);
        }
        nurbs_json::is_nurbs(&value).then_some(Self::Nurbs)
    }
}

/// Reads a model file of the given form.
///
/// # Errors
/// The first thing that keeps the file from being understood, with its line or JSON path. Memory
/// and time are bounded by a multiple of the file's size, whatever numbers it states.
pub fn read_model(bytes: &[u8], form: ModelForm) -> Result<Model, DomainReadError> {
    match form {
        ModelForm::Json => model_json::read(bytes),
        ModelForm::Bpt => bpt::read(bytes),
        ModelForm::Nurbs => nurbs_json::read(bytes),
        ModelForm::Iges => iges::read(bytes),
        #[cfg(feature = "step")]
        ModelForm::Step => step::read(bytes),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    // spec: X62
    #[test]
    fn the_form_is_known_by_extension_and_keys() {
        let of = |name: &str, text: &str| ModelForm::of(Path::new(name), text.as_bytes());
        assert_eq!(of("a.BPT", ""), Some(ModelForm::Bpt));
        assert_eq!(of("a.IGS", ""), Some(ModelForm::Iges));
        assert_eq!(of("a.iges", ""), Some(ModelForm::Iges));
        assert_eq!(of("a.json", r#"{"patches": []}"#), Some(ModelForm::Json));
        assert_eq!(of("a.json", r#"{"format": "trigrade-model"}"#), Some(ModelForm::Json));
        assert_eq!(of("a.json", r#"{"shape": {}}"#), Some(ModelForm::Nurbs));
        for (name, text) in [("a.json", r#"{"loops": []}"#), ("a.json", "[1]"), ("a.poly", "{}")] {
            assert_eq!(of(name, text), None, "{text}");
        }
        assert!(ModelForm::ALL.iter().all(|(f, name)| ModelForm::from_name(name) == Some(*f)));
        assert_eq!(ModelForm::from_name("poly"), None);
    }
}
