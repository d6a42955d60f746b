//! How far a long command has come.

use std::io;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use host::{Screen, Writer};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle, TermLike};

/// A progress bar on a terminal, a line for each tenth elsewhere.
#[derive(Debug)]
pub(super) struct Meter {
    /// The bar, and by what it is drawn.
    bar: Option<(ProgressBar, Writer)>,
    verb: &'static str,
    told: AtomicUsize,
}

impl Meter {
    const STEPS: u64 = 1000;
    /// Times a second that the bar is drawn at most.
    const RATE: u8 = 20;
    /// How long the end waits for the terminal.
    const PATIENCE: Duration = Duration::from_secs(1);

    /// For `what`; `verb` tells what has been done with it, such as "rendered".
    pub(super) fn new(what: String, verb: &'static str) -> Self {
        let bar = Screen::of_stderr().map(|screen| {
            let writer = screen.writer().clone();
            let target =
                ProgressDrawTarget::term_like_with_hz(Box::new(Terminal(screen)), Self::RATE);
            let bar = ProgressBar::with_draw_target(Some(Self::STEPS), target);
            let style = "{prefix} {wide_bar} {percent:>3} %  {elapsed} passed, {eta} left  {msg}";
            if let Ok(style) = ProgressStyle::with_template(style) {
                bar.set_style(style);
            }
            bar.set_prefix(what);
            (bar, writer)
        });
        Self { bar, verb, told: AtomicUsize::new(0) }
    }

    /// Something that has no share of the work, such as preparations.
    pub(super) fn tell(&self, message: String) {
        if let Some((bar, _)) = &self.bar {
            bar.set_message(message);
        } else {
            tracing::info!("{message}");
        }
    }

    /// The share that is done, from 0 to 1, and what is being worked on.
    pub(super) fn show(&self, share: f64, message: &str) {
        if let Some((bar, _)) = &self.bar {
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
        if let Some((bar, writer)) = &self.bar {
            bar.finish_and_clear();
            // Before anything else is printed where the bar was.
            writer.settle(Self::PATIENCE);
        }
    }
}

/// Draws the bar with the usual control sequences of ECMA-48.
#[derive(Debug)]
struct Terminal(Screen);

impl Terminal {
    fn control(&self, count: usize, end: char) {
        if count > 0 {
            self.0.draw(&format!("\x1b[{count}{end}"));
        }
    }
}

impl TermLike for Terminal {
    fn width(&self) -> u16 {
        Screen::columns()
    }

    fn move_cursor_up(&self, n: usize) -> io::Result<()> {
        self.control(n, 'A');
        Ok(())
    }

    fn move_cursor_down(&self, n: usize) -> io::Result<()> {
        self.control(n, 'B');
        Ok(())
    }

    fn move_cursor_right(&self, n: usize) -> io::Result<()> {
        self.control(n, 'C');
        Ok(())
    }

    fn move_cursor_left(&self, n: usize) -> io::Result<()> {
        self.control(n, 'D');
        Ok(())
    }

    fn write_line(&self, text: &str) -> io::Result<()> {
        self.0.draw(&format!("{text}\n"));
        Ok(())
    }

    fn write_str(&self, text: &str) -> io::Result<()> {
        self.0.draw(text);
        Ok(())
    }

    fn clear_line(&self) -> io::Result<()> {
        self.0.draw("\r\x1b[2K");
        Ok(())
    }

    fn flush(&self) -> io::Result<()> {
        self.0.show();
        Ok(())
    }
}
