//! Numbers as people write them.

use std::fmt;

use winnow::Parser as _;
use winnow::ascii::digit1;
use winnow::combinator::{alt, opt};
use winnow::token::one_of;

use super::syntax::{Input, Parsed, expected, position, skip_blanks, wrong};

/// A finite number.
pub(super) fn number(input: &mut Input<'_>, what: &str) -> Parsed<f64> {
    skip_blanks(input);
    let start = position(input);
    let mantissa = alt(((digit1, opt(('.', digit1))).void(), ('.', digit1).void()));
    let exponent = (one_of(['e', 'E']), opt(one_of(['+', '-'])), digit1);
    let form = (opt(one_of(['+', '-'])), mantissa, opt(exponent)).take();
    let text: Parsed<&str> = { form }.parse_next(input);
    let Ok(text) = text else { return Err(expected(input, what)) };
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => wrong(start, input, "this number is too large; write one of at most 1e308"),
    }
}

/// A finite number as the text that reads back as the same one.
pub(super) struct Exact(pub(super) f64);

impl fmt::Display for Exact {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        if size == 0.0 || (1e-5..1e15).contains(&size) {
            write!(f, "{}", self.0)
        } else {
            write!(f, "{:e}", self.0)
        }
    }
}
