//! Target: a boundary of any torture family, meshed with any options; its claim and `check` judge.

use super::decode::Decoder;
use super::pipeline::options;
use arbitrary::{Arbitrary, Unstructured};
use trigrade::mesh::MeshData;
use trigrade::mesher::{MeshError, Unobserved, mesh_domain};
use trigrade::torture::generate::Case;
use trigrade::torture::judge::{Answer, Demands, judge};

/// One input: the case in nine bytes, then the options.
pub fn run(bytes: &[u8]) {
    let mut source = Unstructured::new(bytes);
    let Ok(case) = Case::arbitrary(&mut source) else { return };
    let options = options(&mut Decoder::new(source.take_rest()));
    let answer = match mesh_domain(&case.domain, &options, &mut Unobserved) {
        Ok(meshed) => Answer::Mesh(Box::new(MeshData::from(&meshed.mesh))),
        Err(MeshError::Invalid(faults)) => Answer::Refused(faults[0].to_string()),
        Err(error @ (MeshError::Front(_) | MeshError::Gradation(_) | MeshError::Table(_))) => {
            Answer::Crash(error.to_string())
        }
        Err(error) => Answer::Limit(error.to_string()),
    };
    let judgement = judge(&case.domain, case.claim, &answer, &Demands::default());
    assert!(
        !judgement.class.is_failure(),
        "{} {}: {}\n{options:?}\n{:?}",
        case.family,
        judgement.class,
        judgement.reason,
        case.domain
    );
}
