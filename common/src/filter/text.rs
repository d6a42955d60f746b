//! A filter as somebody wrote it: the text, and what was read of it.

use std::fmt::{self, Display, Formatter};
use std::str::FromStr;

use super::reader::Reader;
use super::{Filter, FilterError};

/// A filter's text is no longer than this.
pub const MAX_FILTER_BYTES: usize = 4096;

impl FromStr for Filter {
    type Err = FilterError;

    fn from_str(text: &str) -> Result<Self, FilterError> {
        Self::parse(text)
    }
}

impl Filter {
    /// Parses a filter's text; a blank one wants every path.
    pub fn parse(text: &str) -> Result<Self, FilterError> {
        if text.len() > MAX_FILTER_BYTES {
            let message = format!("a filter has at most {MAX_FILTER_BYTES} bytes; shorten it");
            return Err(FilterError::new(MAX_FILTER_BYTES..text.len(), message));
        }
        if text.trim().is_empty() {
            return Ok(Self::default());
        }
        Reader::new(text).whole("the end of the filter", Reader::tree)
    }
}

/// A filter as somebody wrote it: a text that was read once, where it came in.
///
/// A text that cannot be read is kept with the reason; it never stands for another filter.
#[derive(Clone, Debug)]
pub struct FilterText {
    text: String,
    tree: Result<Filter, FilterError>,
}

impl FilterText {
    /// Reads a text.
    pub fn read(text: impl Into<String>) -> Self {
        let text = text.into();
        let tree = Filter::parse(&text);
        Self { text, tree }
    }

    /// The text as it was written.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// What it says, or why it cannot be read.
    pub fn tree(&self) -> Result<&Filter, &FilterError> {
        self.tree.as_ref()
    }

    /// Why it cannot be read.
    pub fn error(&self) -> Option<&FilterError> {
        self.tree.as_ref().err()
    }

    /// True where it wants every path.
    pub fn wants_all(&self) -> bool {
        self.tree == Ok(Filter::Constant(true))
    }
}

/// The same text says the same.
impl PartialEq for FilterText {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text
    }
}

impl Eq for FilterText {}

impl Default for FilterText {
    /// Every path, without a text.
    fn default() -> Self {
        Self { text: String::new(), tree: Ok(Filter::default()) }
    }
}

impl From<&Filter> for FilterText {
    /// The text that says so; none where every path is wanted.
    fn from(filter: &Filter) -> Self {
        match filter {
            Filter::Constant(true) => Self::default(),
            // Its places are those of the new text, which may be too long.
            other => Self::read(other.to_string()),
        }
    }
}

impl Display for FilterText {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}
