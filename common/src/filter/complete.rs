//! What may come next in a text that is still being written.
//!
//! The text up to the cursor is read as any other, and every word that the reader would have taken at
//! its end is offered.

use std::ops::Range;

use super::offers::{Offer, Offers, Rank};
use super::reader::Reader;
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
