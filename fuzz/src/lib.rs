//! The bodies of the fuzz targets, shared by libFuzzer (`fuzz_targets`) and by the plain test
//! `tests/fuzz_corpus.rs`. A body panics when it finds a fault.

pub mod cdt;
pub mod decode;
pub mod domain_parsers;
pub mod exact;
pub mod mesh_readers;
pub mod model_files;
pub mod pipeline;
pub mod point_files;
pub mod predicates;
pub mod torture;

/// A target: its name, which is also the name of its corpus, and its body.
pub type Target = (&'static str, fn(&[u8]));

/// All targets.
pub const TARGETS: [Target; 8] = [
    ("predicates", predicates::run),
    ("domain_parsers", domain_parsers::run),
    ("mesh_readers", mesh_readers::run),
    ("cdt", cdt::run),
    ("pipeline", pipeline::run),
    ("point_files", point_files::run),
    ("torture", torture::run),
    ("model_files", model_files::run),
];
