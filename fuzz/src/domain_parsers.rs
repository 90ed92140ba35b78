//! Target: the readers of domains. Any bytes give a domain or an error with a place; validation of
//! what was read ends, and every fault has an id and a place.

use trigrade::domain::validate::validate;
use trigrade::format::airfoil::FarField;
use trigrade::format::domain_file::{DomainForm, ReadOptions, read_domain};

/// Larger domains would only be slow: validation is not what this target is about.
const POINTS_VALIDATED: usize = 500;

/// One input: the first byte chooses the form, the rest is the file.
pub fn run(bytes: &[u8]) {
    let Some((&choice, file)) = bytes.split_first() else { return };
    let form = match choice % 4 {
        0 => DomainForm::Poly,
        1 => DomainForm::Json,
        2 => DomainForm::Airfoil,
        _ => DomainForm::GeoJson,
    };
    let far_field = (choice & 4 != 0).then_some(FarField { chords: 4.0, points: 12 });
    let options = ReadOptions { far_field, ..ReadOptions::default() };
    match read_domain(file, form, &options) {
        Ok(domain) if domain.points.len() <= POINTS_VALIDATED => {
            for fault in validate(&domain).err().unwrap_or_default() {
                assert!(!fault.id().is_empty() && !fault.places().is_empty(), "{fault}");
            }
        }
        Ok(domain) => {
            // A byte at the least for each point: memory is bounded by the size of the file.
            assert!(domain.points.len() <= file.len() + 12, "{} points", domain.points.len());
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}
