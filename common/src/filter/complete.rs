//! What may come next in a text that is still being written.
//!
//! The text up to the cursor is read as any other, and every word that the reader would have taken at
//! its end is offered.

use std::ops::Range;

use super::form::{NameList, Word};
use super::lpe;
use super::parse::Quoted;
use super::print::escaped;
use super::reader::{Reader, in_word};
use super::{FilterScene, Leaf, MAX_FILTER_BYTES};

/// Signs without a choice, such as the parenthesis behind `sphere`, that are written along with a word.
const MOST_FORCED: usize = 4;

/// What may stand in the place of a part of a text.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Completion {
    /// The bytes that are replaced: what of a word is there already.
    pub range: Range<usize>,
    /// What may stand there, the usual first.
    pub choices: Vec<Choice>,
}

/// What may come next.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Choice {
    /// The word, with signs that must follow it and with the blank after it.
    pub text: String,
    /// What it means.
    pub meaning: &'static str,
}

impl Completion {
    /// The text with the choice of this number taken, and the byte where the cursor is then.
    pub fn taken(&self, text: &str, number: usize) -> Option<(String, usize)> {
        let choice = self.choices.get(number)?;
        let (before, after) = (text.get(..self.range.start)?, text.get(self.range.end..)?);
        let word = if after.starts_with(' ') { choice.text.trim_end() } else { &choice.text };
        Some((format!("{before}{word}{after}"), before.len() + word.len()))
    }
}

/// What may come at `cursor`, a number of bytes, in a filter on paths of `scene`.
pub fn complete(text: &str, cursor: usize, scene: &FilterScene) -> Completion {
    let before = &text[..text.floor_char_boundary(cursor)];
    let Offers { mut found, .. } = offers(before, scene);
    found.retain(|offer| offer.rank != Rank::Silent);
    let Some(start) = found.iter().map(|offer| offer.at).min() else {
        return Completion { range: before.len()..before.len(), choices: Vec::new() };
    };
    found.retain(|offer| offer.at == start);
    found.sort_by_key(|offer| offer.rank);
    let head = &before[..start];
    let mut choices: Vec<Choice> = Vec::with_capacity(found.len());
    for Offer { text, meaning, rank, .. } in found {
        let text = if rank == Rank::Name { text } else { with_forced(head, text, scene) };
        let blank = if is_inside(&format!("{head}{text}")) { "" } else { " " };
        let choice = Choice { text: format!("{text}{blank}"), meaning };
        let fits = head.len() + choice.text.len() <= MAX_FILTER_BYTES;
        if fits && choices.iter().all(|known| known.text != choice.text) {
            choices.push(choice);
        }
    }
    Completion { range: start..before.len(), choices }
}

pub(super) fn offers<'a>(before: &'a str, scene: &'a FilterScene) -> Offers<'a> {
    let mut reader = Reader::offering(before, Offers::new(scene));
    // Whatever is wrong is wrong before the end, where nothing is offered then.
    let read = reader.whole("", Reader::tree::<Leaf>);
    drop(read);
    reader.into_offers().unwrap_or_else(|| Offers::new(scene))
}

/// A word with the only signs and words that may follow it.
fn with_forced(head: &str, mut text: String, scene: &FilterScene) -> String {
    for _ in 0..MOST_FORCED {
        let before = format!("{head}{text} ");
        let Offers { found, open, .. } = offers(&before, scene);
        match found.as_slice() {
            [first, others @ ..] if !open && others.iter().all(|o| o.text == first.text) => {
                text.push_str(&first.glued);
            }
            _ => break,
        }
    }
    text
}

/// True where no blank belongs behind a text: within quotes or behind a parenthesis.
fn is_inside(text: &str) -> bool {
    let (mut quoted, mut escaped) = (false, false);
    for letter in text.chars() {
        match letter {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            '"' => quoted = !quoted,
            _ => {}
        }
    }
    quoted || text.ends_with('(')
}

/// Collects what may come at the end of a text.
#[derive(Debug)]
pub(super) struct Offers<'a> {
    scene: &'a FilterScene,
    pub(super) found: Vec<Offer>,
    /// Something else may stand at the end of the text, such as a number.
    pub(super) open: bool,
}

/// What the reader would take at the end of a text.
#[derive(Debug)]
pub(super) struct Offer {
    /// Where it begins.
    pub(super) at: usize,
    pub(super) text: String,
    /// The text as it stands behind others.
    glued: String,
    meaning: &'static str,
    pub(super) rank: Rank,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Rank {
    Usual,
    /// A name of the scene.
    Name,
    /// One of a long list, which would push others away.
    Last,
    /// A sign that is only written along with others.
    Silent,
}

impl<'a> Offers<'a> {
    fn new(scene: &'a FilterScene) -> Self {
        Self { scene, found: Vec::new(), open: false }
    }

    fn push(&mut self, (at, rest): (usize, &str), text: String, meaning: &'static str, rank: Rank) {
        if goes_on(&text, rest) {
            let glued = format!(" {text}");
            self.found.push(Offer { at, text, glued, meaning, rank });
        }
    }

    /// A word that may stand at `at`, where `rest` is what is there of it.
    pub(super) fn word(&mut self, place: (usize, &str), word: &str, meaning: &'static str) {
        self.push(place, word.to_owned(), meaning, Rank::Usual);
    }

    /// One of many words.
    pub(super) fn last(&mut self, place: (usize, &str), word: &Word) {
        self.push(place, word.text.to_owned(), word.meaning, Rank::Last);
    }

    /// A sign, with the blanks around it; one without a meaning is not told.
    pub(super) fn sign(
        &mut self,
        (at, rest): (usize, &str),
        sign: &'static str,
        meaning: &'static str,
    ) {
        let text = sign.trim().to_owned();
        if goes_on(&text, rest) {
            let rank = if meaning.is_empty() { Rank::Silent } else { Rank::Usual };
            self.found.push(Offer { at, text, glued: sign.to_owned(), meaning, rank });
        }
    }

    /// The names of a list.
    pub(super) fn names(
        &mut self,
        (at, rest): (usize, &str),
        list: NameList,
        write: impl Fn(&str) -> String,
    ) {
        self.leave_open(rest.is_empty());
        for name in self.scene.names(list) {
            let text = write(name);
            let is_bare = goes_on(name, rest);
            if is_bare || goes_on(&text, rest) {
                let glued = format!(" {text}");
                let meaning = list.kind();
                self.found.push(Offer { at, text, glued, meaning, rank: Rank::Name });
            }
        }
    }

    /// Something may stand here that cannot be offered.
    pub(super) fn leave_open(&mut self, is_end: bool) {
        self.open |= is_end;
    }

    /// What may come in an expression that is still being written.
    pub(super) fn expression(&mut self, quoted: &Quoted) {
        self.open = true;
        let (inner, is_whole) = lpe::offers(&quoted.text, Self::new(self.scene));
        for offer in inner.into_iter().flat_map(|inner| inner.found) {
            let text = escaped(&offer.text, '"');
            self.found.push(Offer { at: quoted.outer(offer.at), text, ..offer });
        }
        if is_whole {
            let at = quoted.outer(quoted.text.len());
            self.push((at, ""), "\"".to_owned(), "closes", Rank::Last);
        }
    }
}

/// Whether a text that ends in `rest` goes on with `text`.
fn goes_on(text: &str, rest: &str) -> bool {
    let mut letters = text.chars();
    let begins = rest.chars().all(|own| {
        letters.next().is_some_and(|letter| letter.to_lowercase().eq(own.to_lowercase()))
    });
    begins && letters.next().is_some()
}

/// Whether a word may stand right behind `before`, which another one may end.
pub(super) fn may_follow(before: &str, word: &str) -> bool {
    matches!(word, "(" | ")" | "," | "..") || !before.ends_with(|c: char| in_word(c) || c == '"')
}
