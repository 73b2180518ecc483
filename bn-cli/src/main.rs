//! bn.
fn main() {}
