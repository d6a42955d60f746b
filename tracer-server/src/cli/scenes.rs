//! `tracer-server scenes`: the built-in scenes, one a line.

use std::io::{self, Write as _};
use std::process::ExitCode;

use clap::Args;
use serde::Serialize;

use crate::scene::builtin::BUILTINS;

/// Lists the built-in scenes, one per line: name and description.
#[derive(Args, Clone, Debug)]
#[command(after_help = "\
Examples:
  tracer-server scenes
  tracer-server info door
  tracer-server render door -o door.png --time 10")]
pub struct ScenesArgs {
    /// Print JSON instead.
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Serialize)]
struct Line {
    name: &'static str,
    description: String,
}

/// Prints the list.
pub fn run(args: &ScenesArgs) -> anyhow::Result<ExitCode> {
    let mut lines = Vec::new();
    for builtin in BUILTINS {
        lines.push(Line { name: builtin.name, description: builtin.summary()? });
    }
    let mut out = io::stdout().lock();
    if args.json {
        writeln!(out, "{}", serde_json::to_string_pretty(&lines)?)?;
    } else {
        let width = lines.iter().map(|line| line.name.len()).max().unwrap_or(0);
        for Line { name, description } in &lines {
            writeln!(out, "{name:width$}  {description}")?;
        }
    }
    Ok(ExitCode::SUCCESS)
}
