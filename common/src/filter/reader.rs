//! A text that is read from its beginning to its end.
//!
//! Whoever reads tries what may come, in order; the reader remembers what was expected at the farthest
//! place that it reached. From this come both the complaint about a text that is wrong there and, for
//! a text that is still being written, what may be offered: neither can differ from what is read.

use super::FilterScene;
use super::error::{FilterError, closest};
use super::offers::{Offers, Typed, Within, may_follow};
use super::quote::Quoted;
use super::tree::{MAX_DEPTH, too_deep};
use super::word::{NameList, Stop, Walk, Word, in_word};

/// A text that is read.
#[derive(Debug)]
pub(super) struct Reader<'a> {
    text: &'a str,
    at: usize,
    /// Groups that are open.
    depth: usize,
    /// What is wrong whatever else is tried.
    fault: Option<FilterError>,
    expected: Expected,
    /// An example of what is read, for complaints.
    example: Option<&'static str>,
    /// What may come at the text's end, where somebody wants to know.
    offers: Option<Offers<'a>>,
    /// The text is an expression, whose letters need no blanks between them.
    is_expression: bool,
}

/// What could stand at the farthest place at which something else does.
#[derive(Debug, Default)]
struct Expected {
    at: usize,
    what: Vec<String>,
    /// What is said instead of a long list.
    summary: Option<String>,
    example: Option<&'static str>,
}

impl<'a> Reader<'a> {
    /// A reader of filters.
    pub(super) fn new(text: &'a str) -> Self {
        Self {
            text,
            at: 0,
            depth: 0,
            fault: None,
            expected: Expected::default(),
            example: None,
            offers: None,
            is_expression: false,
        }
    }

    /// A reader of filters that collects what may come at the end of its text.
    pub(super) fn offering(text: &'a str, offers: Offers<'a>) -> Self {
        Self { offers: Some(offers), ..Self::new(text) }
    }

    /// A reader of light path expressions, which may collect, too.
    pub(super) fn of_expression(text: &'a str, offers: Option<Offers<'a>>) -> Self {
        Self { is_expression: true, offers, ..Self::new(text) }
    }

    /// What may come at the end of the text.
    pub(super) fn into_offers(self) -> Option<Offers<'a>> {
        self.offers
    }

    /// The whole text as `read` reads it; `end` tells what could stand in the place of more.
    pub(super) fn whole<T>(
        &mut self,
        end: &str,
        read: impl FnOnce(&mut Self) -> Result<T, Stop>,
    ) -> Result<T, FilterError> {
        let found = read(self);
        self.skip_blanks();
        match found {
            Ok(value) if self.rest().is_empty() => return Ok(value),
            Ok(_) => self.expect(end.to_owned()),
            Err(Stop) => {}
        }
        Err(self.complaint())
    }

    fn complaint(&mut self) -> FilterError {
        if let Some(fault) = self.fault.take() {
            return fault;
        }
        let Expected { at, what, summary, example } = std::mem::take(&mut self.expected);
        let found = first_of(&self.text[at..]);
        let wanted = match (&summary, example) {
            (Some(summary), _) => summary.clone(),
            (None, Some(example)) => format!("{}, as in `{example}`", listed(&what)),
            (None, None) => listed(&what),
        };
        let words = what.iter().map(|word| word.trim_matches('`'));
        let message = match closest(found, words) {
            _ if found.is_empty() => format!("expected {wanted}, but the text ends"),
            Some(word) => format!("expected {wanted}, found `{found}`; did you mean `{word}`?"),
            None => format!("expected {wanted}, found `{found}`"),
        };
        FilterError::new(at..at + found.len(), message)
    }

    /// Notes that `what` could stand where the text goes on.
    pub(super) fn expect(&mut self, what: String) {
        let at = self.next_place();
        if at > self.expected.at {
            self.expected = Expected { at, ..Expected::default() };
        }
        if at == self.expected.at && !self.expected.what.contains(&what) {
            self.expected.what.push(what);
            self.expected.example = self.expected.example.or(self.example);
        }
    }

    /// Tells all that could stand at `place` in other words, if nothing was read beyond it.
    pub(super) fn summarise(&mut self, place: usize, summary: String) {
        if self.expected.at == place {
            self.expected.summary = Some(summary);
        }
    }

    /// Reads by `read`; false where the text goes on otherwise, which is as if nothing had been read.
    pub(super) fn attempt(
        &mut self,
        example: &'static str,
        read: impl FnOnce(&mut Self) -> Walk,
    ) -> Result<bool, Stop> {
        let (at, depth, outer) = (self.at, self.depth, self.example.replace(example));
        let read = read(self);
        self.example = outer;
        if read.is_err() {
            if self.fault.is_some() {
                return Err(Stop);
            }
            (self.at, self.depth) = (at, depth);
        }
        Ok(read.is_ok())
    }

    /// Ends all reading with a complaint about what was read since `start`.
    pub(super) fn wrong<T>(&mut self, start: usize, message: impl Into<String>) -> Result<T, Stop> {
        let fault = FilterError::new(start..self.at.max(start), message);
        self.fail(fault)
    }

    /// Ends all reading.
    pub(super) fn fail<T>(&mut self, fault: FilterError) -> Result<T, Stop> {
        self.fault.get_or_insert(fault);
        Err(Stop)
    }

    /// Where the text goes on, in bytes.
    pub(super) fn position(&self) -> usize {
        self.at
    }

    /// Where it goes on after blanks.
    pub(super) fn next_place(&self) -> usize {
        self.text.len() - self.rest().trim_start().len()
    }

    /// What is still to be read.
    pub(super) fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    pub(super) fn skip_blanks(&mut self) {
        self.at = self.next_place();
    }

    /// Reads as many bytes as `length` says of what is still to be read.
    pub(super) fn bytes(&mut self, length: impl FnOnce(&str) -> usize) -> &'a str {
        let rest = self.rest();
        let length = length(rest);
        self.at += length;
        &rest[..length]
    }

    /// Reads the letters that come next, as long as they belong.
    pub(super) fn run(&mut self, belongs: impl Fn(char) -> bool) -> &'a str {
        self.bytes(|rest| rest.find(|c: char| !belongs(c)).unwrap_or(rest.len()))
    }

    /// Reads one letter.
    pub(super) fn letter(&mut self) -> Option<char> {
        let letter = self.rest().chars().next()?;
        self.at += letter.len_utf8();
        Some(letter)
    }

    /// Whether `text` comes next, as a whole word where it is one.
    pub(super) fn comes(&self, text: &str) -> bool {
        let Some(after) = self.rest().strip_prefix(text) else { return false };
        !(text.ends_with(in_word) && after.starts_with(in_word) && !self.is_expression)
    }

    /// A text in double quotes, in which `\"` and `\\` stand for the second sign; the quote comes next.
    pub(super) fn quoted(&mut self) -> Result<Quoted, Stop> {
        let quote = self.position();
        self.letter();
        let mut quoted = Quoted {
            text: String::new(),
            start: self.position(),
            escapes: Vec::new(),
            is_closed: false,
        };
        loop {
            match self.letter() {
                Some('"') => {
                    quoted.is_closed = true;
                    return Ok(quoted);
                }
                Some('\\') => {
                    quoted.escapes.push(quoted.text.len());
                    quoted.text.extend(self.letter());
                }
                Some(letter) => quoted.text.push(letter),
                None if self.is_offering() => return Ok(quoted),
                None => {
                    let message = "this quote is never closed; put another `\"` at its end";
                    return self.wrong(quote, message);
                }
            }
        }
    }

    /// The text ends within quotes, where somebody wants to know what may come there.
    pub(super) fn unfinished<T>(&mut self) -> Result<T, Stop> {
        self.wrong(self.position(), "this quote is not closed yet")
    }

    /// Skips blanks and reads `text` where it comes next.
    pub(super) fn accept(&mut self, text: &str) -> bool {
        self.skip_blanks();
        let comes = self.comes(text);
        if comes {
            self.at += text.len();
        }
        comes
    }

    /// Reads one of the spellings of a word where it comes next, and offers the word at the end.
    pub(super) fn accept_word(&mut self, word: &Word) -> bool {
        self.skip_blanks();
        self.offer(word.text, word.meaning);
        self.accept(word.text) || word.also.iter().any(|other| self.accept(other))
    }

    /// Offers a word that may stand here, if the text ends within it.
    pub(super) fn offer(&mut self, word: &str, meaning: &'static str) {
        self.with_offers(word, |offers, typed| offers.word(typed, word, meaning));
    }

    /// Offers words, after all others where they are many.
    pub(super) fn offer_words(&mut self, words: &[Word]) {
        const MANY: usize = 8;
        self.skip_blanks();
        if words.len() > MANY {
            return self.offer_last(words);
        }
        for word in words {
            self.offer(word.text, word.meaning);
        }
    }

    /// Offers words after all others.
    pub(super) fn offer_last(&mut self, words: &[Word]) {
        for word in words {
            self.with_offers(word.text, |offers, typed| offers.last(typed, word));
        }
    }

    /// Offers a sign with the blanks around it.
    pub(super) fn offer_sign(&mut self, sign: &'static str, meaning: &'static str) {
        self.skip_blanks();
        self.with_offers(sign.trim(), |offers, typed| offers.sign(typed, sign, meaning));
    }

    /// Offers the names of the scene as `write` writes them.
    pub(super) fn offer_names(&mut self, list: NameList, write: impl Fn(&str) -> String) {
        self.with_offers("\"", |offers, typed| offers.names(typed, list, write));
    }

    /// Offers what may come within quotes in which the text ends, as `offers` collects it.
    pub(super) fn offer_within(
        &mut self,
        quoted: &Quoted,
        offers: impl Fn(&str, &FilterScene) -> Within,
    ) {
        if let Some(outer) = &mut self.offers {
            let within = offers(&quoted.text, outer.scene());
            outer.within(quoted, within);
        }
    }

    /// Something that cannot be offered may stand here, such as a number.
    pub(super) fn leave_open(&mut self) {
        self.with_offers("", |offers, typed| offers.leave_open(typed.rest.is_empty()));
    }

    /// Calls `offer` with the place and what is there, if somebody collects and `word` may stand here.
    fn with_offers(&mut self, word: &str, offer: impl FnOnce(&mut Offers<'a>, Typed<'_>)) {
        let (before, rest) = self.text.split_at(self.at);
        if let Some(offers) = &mut self.offers
            && (self.is_expression || may_follow(before, word))
        {
            offer(offers, Typed { at: before.len(), rest });
        }
    }

    /// True where somebody wants to know what may come at the end of the text.
    pub(super) fn is_offering(&self) -> bool {
        self.offers.is_some()
    }

    /// Reads one level deeper, which must not be too deep.
    pub(super) fn deeper<T>(
        &mut self,
        read: impl FnOnce(&mut Self) -> Result<T, Stop>,
    ) -> Result<T, Stop> {
        if self.depth >= MAX_DEPTH {
            return self.wrong(self.at, too_deep());
        }
        self.depth += 1;
        let found = read(self)?;
        self.depth -= 1;
        Ok(found)
    }
}

/// The word, number or sign that `text` begins with; a long one is cut.
fn first_of(text: &str) -> &str {
    let belongs = |c: char| in_word(c) || matches!(c, '.' | '-');
    let length = text.find(|c: char| !belongs(c)).unwrap_or(text.len());
    let first = text.chars().next().map_or(0, char::len_utf8);
    &text[..text.floor_char_boundary(length.max(first).min(40))]
}

/// `a, b or c`.
fn listed(what: &[String]) -> String {
    match what {
        [] => "something else".to_owned(),
        [only] => only.clone(),
        [first @ .., last] => format!("{} or {last}", first.join(", ")),
    }
}
