//! Everything that takes more than one crate to test, in one binary.
//!
//! `circles`, `citations`, `documents`, `layers` and `tidy` keep the repository in order; the others
//! run the program. To add a test, add a file with its `#[test]` functions and one line here.

mod cable;
mod circles;
mod citations;
mod daemon;
mod detail;
mod documents;
mod explorer;
mod filters;
mod fuzz;
mod isolation;
mod layers;
mod names;
mod reconnect;
mod security;
mod soak;
mod steering;
mod stream;
mod tidy;
mod workspace;
