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

    /// A complaint about a tree that no text could have made, so that it has no place.
    pub(super) fn of_tree(message: impl Into<String>) -> Self {
        Self::new(0..0, message)
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

/// The one of `known` words that may have been meant by `found`.
pub(super) fn closest<'a>(found: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    /// Two words of at least this Jaro-Winkler similarity may have been mixed up.
    const SIMILAR: f64 = 0.75;
    let likeness = |known: &str| strsim::jaro_winkler(known, found);
    let best = known.max_by(|a, b| likeness(a).total_cmp(&likeness(b)))?;
    (likeness(best) >= SIMILAR).then_some(best)
}
