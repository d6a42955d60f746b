//! A terminal that something is drawn on.

use std::io;
use std::sync::{Mutex, PoisonError};

use crate::Writer;

/// Columns where the terminal does not tell.
const USUAL_COLUMNS: u16 = 80;

/// The terminal of standard error, for what is drawn again and again. What is drawn comes by a
/// [`Writer`], so that a terminal that was stopped, or is gone, stops nobody.
#[derive(Debug)]
pub struct Screen {
    writer: Writer,
    /// What belongs together, until it is shown.
    drawn: Mutex<String>,
}

impl Screen {
    /// That of standard error; `None` where that is no terminal.
    pub fn of_stderr() -> Option<Self> {
        let is_terminal = io::IsTerminal::is_terminal(&io::stderr());
        is_terminal.then(|| Self { writer: Writer::stderr(), drawn: Mutex::default() })
    }

    /// By which it is drawn.
    pub fn writer(&self) -> &Writer {
        &self.writer
    }

    /// Adds to what will be shown.
    pub fn draw(&self, text: &str) {
        self.drawn.lock().unwrap_or_else(PoisonError::into_inner).push_str(text);
    }

    /// Shows what was drawn.
    pub fn show(&self) {
        let mut drawn = self.drawn.lock().unwrap_or_else(PoisonError::into_inner);
        if !drawn.is_empty() {
            self.writer.say(std::mem::take(&mut *drawn));
        }
    }

    /// The width of standard error's terminal in columns.
    #[cfg(unix)]
    pub fn columns() -> u16 {
        let size = rustix::termios::tcgetwinsize(rustix::stdio::stderr());
        size.map(|size| size.ws_col).ok().filter(|columns| *columns > 0).unwrap_or(USUAL_COLUMNS)
    }

    /// The width of standard error's terminal in columns.
    #[cfg(not(unix))]
    pub fn columns() -> u16 {
        USUAL_COLUMNS
    }
}
