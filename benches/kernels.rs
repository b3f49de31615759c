//! How long each kernel takes.
fn main() {}
