//! Why a filter is refused, and where.

use std::ops::Range;

use thiserror::Error;

/// Why a filter's text is refused: what is wrong, what was expected, and what to do.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("at character {}: {message}", span.start + 1)]
pub struct FilterError {
    /// The bytes of the text that are at fault; empty at the text's end.
    pub span: Range<usize>,
    /// What is wrong and what to do about it, for people.
    pub message: String,
}

impl FilterError {
    pub(super) fn new(span: Range<usize>, message: impl Into<String>) -> Self {
        Self { span, message: message.into() }
    }

    /// The same complaint about a text that stands `offset` bytes into a longer one.
    pub(super) fn shifted(mut self, offset: usize) -> Self {
        self.span = self.span.start + offset..self.span.end + offset;
        self
    }

    /// The complaint under the line of `text` that it is about, with a mark below the fault.
    pub fn pointed(&self, text: &str) -> String {
        let start = text.floor_char_boundary(self.span.start.min(text.len()));
        let end = text.floor_char_boundary(self.span.end.min(text.len())).max(start);
        let line_start = text[..start].rfind('\n').map_or(0, |newline| newline + 1);
        let line = text[line_start..].lines().next().unwrap_or_default();
        let indent = " ".repeat(text[line_start..start].chars().count());
        let marked = text[start..end].lines().next().unwrap_or_default();
        let mark = "^".repeat(marked.chars().count().max(1));
        format!("{line}\n{indent}{mark}\n{}", self.message)
    }
}
