//! Everything that takes more than one crate to test, in one binary.
//!
//! `workspace` reads the repository; the first four tests below keep it tidy. To add a test, add a
//! file with its `#[test]` functions and one line here.

mod citations;
mod layers;
mod stream;
mod tidy;
mod workspace;
