//! Texts in quotes, in which a sign behind `\` stands for itself.

use std::fmt::{self, Display, Formatter};
use std::ops::Range;

/// A text in double quotes.
#[derive(Debug)]
pub(super) struct InQuotes<'a>(pub(super) &'a str);

impl Display for InQuotes<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "\"{}\"", escaped(self.0, '"'))
    }
}

/// A text that may stand within quotes of a kind.
pub(super) fn escaped(text: &str, quote: char) -> String {
    let mut escaped = String::with_capacity(text.len());
    for sign in text.chars() {
        if sign == quote || sign == '\\' {
            escaped.push('\\');
        }
        escaped.push(sign);
    }
    escaped
}

/// The content of quotes, and where in the text it stands.
#[derive(Debug)]
pub(super) struct Quoted {
    pub(super) text: String,
    /// Bytes of the outer text before the content.
    pub(super) start: usize,
    /// Bytes of the content before each sign that has a `\` in front of it.
    pub(super) escapes: Vec<usize>,
    /// The second quote is there, as it is unless somebody wants to know what may come before it.
    pub(super) is_closed: bool,
}

impl Quoted {
    /// The place in the outer text of a place in the content.
    pub(super) fn outer(&self, place: usize) -> usize {
        let escapes = self.escapes.iter().filter(|escape| **escape < place).count();
        self.start + place + escapes
    }

    /// The part of the outer text that a part of the content stands for.
    pub(super) fn outer_range(&self, part: Range<usize>) -> Range<usize> {
        self.outer(part.start)..self.outer(part.end)
    }
}
