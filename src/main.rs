//! The `trigrade` program.

fn main() {}
