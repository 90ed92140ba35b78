//! (to be written)

pub mod airfoil;
mod domain_builder;
pub mod domain_file;
pub mod domain_json;
mod domain_json_plain;
pub mod geojson;
pub mod poly;
