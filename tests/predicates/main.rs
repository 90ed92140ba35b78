//! The predicates against laws, exhaustive small worlds and rational arithmetic.
//!
//! The long run: `cargo test --release --test predicates -- --ignored --nocapture`.

mod differential;
mod lattice;
mod laws;
mod oracle;
mod perturbation;
mod rungs;
mod samples;
mod segments;
