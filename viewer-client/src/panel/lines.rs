//! Lines of text for the clipboard.

use std::fmt::Display;

/// A text that grows by lines.
#[derive(Debug, Default)]
pub(super) struct Lines(String);

impl Lines {
    /// Appends a line.
    pub(super) fn put(&mut self, line: impl Display) {
        self.0.push_str(&line.to_string());
        self.0.push('\n');
    }

    /// The whole text.
    pub(super) fn text(self) -> String {
        self.0
    }
}

/// One thing a line.
impl<T: Display> FromIterator<T> for Lines {
    fn from_iter<I: IntoIterator<Item = T>>(things: I) -> Self {
        let mut lines = Self::default();
        things.into_iter().for_each(|thing| lines.put(thing));
        lines
    }
}
