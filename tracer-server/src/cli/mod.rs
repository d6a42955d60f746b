//! The command line: one file a subcommand.

pub mod info;
mod inventory;
pub mod scenes;
