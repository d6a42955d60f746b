//! What the two little languages, filters and light path expressions, share: positions, blanks,
//! tokens and complaints.

use winnow::error::{ErrMode, ParserError};
use winnow::stream::{LocatingSlice, Location as _, Stateful, Stream as _};

use super::FilterError;

/// No tree is deeper than this.
pub(super) const MAX_DEPTH: usize = 24;

/// A text under a parser, with the depth of what is open.
pub(super) type Input<'a> = Stateful<LocatingSlice<&'a str>, usize>;
/// What a parser returns.
pub(super) type Parsed<T> = Result<T, ErrMode<FilterError>>;

impl<'a> ParserError<Input<'a>> for FilterError {
    type Inner = Self;

    fn from_input(input: &Input<'a>) -> Self {
        complaint(input, "something else")
    }

    fn into_inner(self) -> Result<Self, Self> {
        Ok(self)
    }
}

/// Parses the whole of `text`.
pub(super) fn parse_all<'a, T>(
    text: &'a str,
    parser: impl FnOnce(&mut Input<'a>) -> Parsed<T>,
    continuation: &str,
) -> Result<T, FilterError> {
    let mut input = Input { input: LocatingSlice::new(text), state: 0 };
    let parsed = parser(&mut input).and_then(|value| {
        skip_blanks(&mut input);
        if input.is_empty() { Ok(value) } else { Err(expected(&input, continuation)) }
    });
    parsed.map_err(|error| match error {
        ErrMode::Backtrack(error) | ErrMode::Cut(error) => error,
        // Only inputs that arrive in parts are ever incomplete.
        ErrMode::Incomplete(_) => {
            FilterError::new(text.len()..text.len(), "the text ends too soon")
        }
    })
}

/// Where the next token begins, in bytes.
pub(super) fn position(input: &Input<'_>) -> usize {
    input.input.current_token_start()
}

/// The text that is still to be read.
pub(super) fn rest<'a>(input: &Input<'a>) -> &'a str {
    input.input.as_ref()
}

/// The complaint that something else than what comes next was expected.
pub(super) fn expected(input: &Input<'_>, what: &str) -> ErrMode<FilterError> {
    ErrMode::Cut(complaint(input, what))
}

fn complaint(input: &Input<'_>, what: &str) -> FilterError {
    let rest = rest(input);
    let blanks = rest.len() - rest.trim_start().len();
    let start = position(input) + blanks;
    let found = found(&rest[blanks..]);
    let message = match found {
        "" => format!("expected {what}, but the text ends"),
        _ => format!("expected {what}, found `{found}`"),
    };
    FilterError::new(start..start + found.len(), message)
}

/// The word, number or sign that `text` begins with; a long one is cut.
fn found(text: &str) -> &str {
    let belongs = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.' | '-');
    let length = text.find(|c: char| !belongs(c)).unwrap_or(text.len());
    let first = text.chars().next().map_or(0, char::len_utf8);
    &text[..text.floor_char_boundary(length.max(first).min(40))]
}

/// An error about the bytes from `start` to where the input is now.
pub(super) fn wrong<T>(start: usize, input: &Input<'_>, message: impl Into<String>) -> Parsed<T> {
    Err(ErrMode::Cut(FilterError::new(start..position(input).max(start), message)))
}

/// Skips blanks.
pub(super) fn skip_blanks(input: &mut Input<'_>) {
    take_run(input, char::is_whitespace);
}

/// Takes the characters that come next, as long as they belong.
pub(super) fn take_run<'a>(input: &mut Input<'a>, belongs: fn(char) -> bool) -> &'a str {
    let rest = rest(input);
    let length = rest.find(|c: char| !belongs(c)).unwrap_or(rest.len());
    input.next_slice(length)
}

/// Skips blanks and takes `sign` if it comes next.
pub(super) fn accept(input: &mut Input<'_>, sign: &str) -> bool {
    skip_blanks(input);
    let comes = rest(input).starts_with(sign);
    if comes {
        input.next_slice(sign.len());
    }
    comes
}

/// Skips blanks and takes `sign`, which must come next.
pub(super) fn require(input: &mut Input<'_>, sign: &str, what: &str) -> Parsed<()> {
    if accept(input, sign) { Ok(()) } else { Err(expected(input, what)) }
}

/// Skips blanks and looks at the word that comes next; empty where none does.
pub(super) fn peek_word<'a>(input: &mut Input<'a>) -> &'a str {
    skip_blanks(input);
    let start = input.checkpoint();
    let word = take_run(input, |c| c.is_ascii_alphanumeric() || c == '_');
    input.reset(&start);
    word
}

/// Takes `word` if it comes next, as a whole word.
pub(super) fn accept_word(input: &mut Input<'_>, word: &str) -> bool {
    let comes = peek_word(input) == word;
    if comes {
        input.next_slice(word.len());
    }
    comes
}

/// Runs `parser` one level deeper, which must not be too deep.
pub(super) fn deeper<'a, T>(
    input: &mut Input<'a>,
    parser: impl FnOnce(&mut Input<'a>) -> Parsed<T>,
) -> Parsed<T> {
    if input.state >= MAX_DEPTH {
        let message = format!("nested deeper than {MAX_DEPTH} levels; flatten the expression");
        return wrong(position(input), input, message);
    }
    input.state += 1;
    let parsed = parser(input);
    input.state -= 1;
    parsed
}
