//! How far a long command has come.

use std::io::{self, IsTerminal as _};
use std::sync::atomic::{AtomicUsize, Ordering};

use indicatif::{ProgressBar, ProgressStyle};

/// A progress bar on a terminal, a line for each tenth elsewhere.
#[derive(Debug)]
pub(super) struct Meter {
    bar: Option<ProgressBar>,
    verb: &'static str,
    told: AtomicUsize,
}

impl Meter {
    const STEPS: u64 = 1000;

    /// For `what`; `verb` tells what has been done with it, such as "rendered".
    pub(super) fn new(what: String, verb: &'static str) -> Self {
        let bar = io::stderr().is_terminal().then(|| {
            let bar = ProgressBar::new(Self::STEPS);
            let style = "{prefix} {wide_bar} {percent:>3} %  {elapsed} passed, {eta} left  {msg}";
            if let Ok(style) = ProgressStyle::with_template(style) {
                bar.set_style(style);
            }
            bar.set_prefix(what);
            bar
        });
        Self { bar, verb, told: AtomicUsize::new(0) }
    }

    /// Something that has no share of the work, such as preparations.
    pub(super) fn tell(&self, message: String) {
        if let Some(bar) = &self.bar {
            bar.set_message(message);
        } else {
            tracing::info!("{message}");
        }
    }

    /// The share that is done, from 0 to 1, and what is being worked on.
    pub(super) fn show(&self, share: f64, message: &str) {
        if let Some(bar) = &self.bar {
            bar.set_message(message.to_owned());
            bar.set_position((share * Self::STEPS as f64) as u64);
            return;
        }
        let tenth = (share * 10.0) as usize;
        if tenth > self.told.fetch_max(tenth, Ordering::Relaxed) {
            tracing::info!("{} {} %", self.verb, 10 * tenth);
        }
    }

    /// Takes the bar away.
    pub(super) fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
