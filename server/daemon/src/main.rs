//! The covr binary.
fn main() {}
