//! Whatever comes from a peer, a user or a file gets an answer: never a panic, an abort, or a bill of
//! time or memory that is out of proportion.
//!
//! Each target is a reader of ours. Its inputs are seeds mutated with a sense of their structure
//! ([`mutate`], [`wire`]); those to which the reader gives an answer of a new kind become seeds, too, so
//! that the search goes ever deeper. Numbers are drawn from a fixed seed: the same inputs on every run.
//!
//! Longer and elsewhere: `LVIS_FUZZ_SECONDS=600 LVIS_FUZZ_SEED=1 cargo test -p tests --test it fuzz::`.
//! What fails is written to a file, and `LVIS_FUZZ_INPUT=FILE` tries that alone.

mod campaign;
mod mutate;
mod readers;
mod seeds;
mod wire;
