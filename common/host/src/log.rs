//! The log of a program, on standard error.

use std::backtrace::Backtrace;
use std::env;
use std::ffi::OsString;
use std::io::{self, IsTerminal as _};
use std::panic::{self, PanicHookInfo};
use std::thread;
use std::time::Duration;

use tracing_subscriber::EnvFilter;

use crate::Writer;

/// How long the end of a program waits for the reader of its log.
const PATIENCE: Duration = Duration::from_secs(1);

/// The log of the program; its end is [`Log::finish`].
#[derive(Debug)]
#[must_use = "the last lines are written by `finish`"]
pub struct Log(Writer);

/// Sends everything that is logged and `filter` lets pass to standard error, and what a panic says,
/// too. `with_target` names the module that each line comes from.
pub fn start(filter: EnvFilter, with_target: bool) -> Log {
    let writer = Writer::stderr();
    let of_line = writer.clone();
    tracing_subscriber::fmt()
        .with_env_filter(filter)
        .with_writer(move || of_line.clone())
        .with_ansi(has_colours())
        .with_target(with_target)
        .log_internal_errors(false)
        .init();
    let of_panic = writer.clone();
    panic::set_hook(Box::new(move |info| of_panic.say(last_words(info))));
    Log(writer)
}

impl Log {
    /// A plain line, such as the message that a program ends with.
    pub fn say(&self, line: &str) {
        self.0.say(format!("{line}\n"));
    }

    /// Lines that never came to their place so far.
    pub fn lost(&self) -> u64 {
        self.0.lost()
    }

    /// Writes what still waits. A reader that does not read is not waited for.
    pub fn finish(self) {
        self.0.settle(PATIENCE);
    }
}

/// True where standard error is a terminal that understands colours and whose user wants them: see
/// no-color.org.
fn has_colours() -> bool {
    io::stderr().is_terminal() && wants_colours(|name| env::var_os(name))
}

/// By the variables of the environment.
fn wants_colours(variable: impl Fn(&str) -> Option<OsString>) -> bool {
    let is_set = |name| variable(name).is_some_and(|value| !value.is_empty());
    let is_dumb = variable("TERM").is_some_and(|term| term == "dumb");
    !is_set("NO_COLOR") && !is_dumb
}

fn last_words(info: &PanicHookInfo<'_>) -> String {
    let thread = thread::current();
    let name = thread.name().unwrap_or("<unnamed>");
    // Tells how to get one where RUST_BACKTRACE asks for none.
    let backtrace = Backtrace::capture();
    format!("thread '{name}' {info}\nbacktrace: {backtrace}\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_wants_no_colours_gets_none() {
        for (variables, expected) in [
            (&[("TERM", "xterm-256color")][..], true),
            (&[], true),
            (&[("NO_COLOR", "")], true),
            (&[("NO_COLOR", "1"), ("TERM", "xterm")], false),
            (&[("TERM", "dumb")], false),
        ] {
            let variable = |name: &str| {
                let found = variables.iter().find(|(known, _)| *known == name);
                found.map(|(_, value)| OsString::from(value))
            };
            assert_eq!(wants_colours(variable), expected, "{variables:?}");
        }
    }
}
