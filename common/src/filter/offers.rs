//! What a reader would take at the end of a text.

use super::FilterScene;
use super::quote::{Quoted, escaped};
use super::word::{NameList, Word, in_word};

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
    pub(super) glued: String,
    pub(super) meaning: &'static str,
    pub(super) rank: Rank,
}

/// Where an offer would stand, and what is written there already.
#[derive(Clone, Copy, Debug)]
pub(super) struct Typed<'a> {
    pub(super) at: usize,
    pub(super) rest: &'a str,
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
    pub(super) fn new(scene: &'a FilterScene) -> Self {
        Self { scene, found: Vec::new(), open: false }
    }

    fn push(&mut self, typed: Typed<'_>, text: String, meaning: &'static str, rank: Rank) {
        if goes_on(&text, typed.rest) {
            let at = typed.at;
            let glued = format!(" {text}");
            self.found.push(Offer { at, text, glued, meaning, rank });
        }
    }

    /// A word that may stand there.
    pub(super) fn word(&mut self, typed: Typed<'_>, word: &str, meaning: &'static str) {
        self.push(typed, word.to_owned(), meaning, Rank::Usual);
    }

    /// One of many words.
    pub(super) fn last(&mut self, typed: Typed<'_>, word: &Word) {
        self.push(typed, word.text.to_owned(), word.meaning, Rank::Last);
    }

    /// A sign, with the blanks around it; one without a meaning is not told.
    pub(super) fn sign(
        &mut self,
        Typed { at, rest }: Typed<'_>,
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
        Typed { at, rest }: Typed<'_>,
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

    /// The scene that names are offered of.
    pub(super) fn scene(&self) -> &'a FilterScene {
        self.scene
    }

    /// What may come within quotes that are not closed yet.
    pub(super) fn within(&mut self, quoted: &Quoted, within: Within) {
        self.open = true;
        for offer in within.found {
            let text = escaped(&offer.text, '"');
            self.found.push(Offer { at: quoted.outer(offer.at), text, ..offer });
        }
        if within.is_whole {
            let at = quoted.outer(quoted.text.len());
            self.push(Typed { at, rest: "" }, "\"".to_owned(), "closes", Rank::Last);
        }
    }
}

/// What may come at the end of a text within quotes.
#[derive(Debug)]
pub(super) struct Within {
    pub(super) found: Vec<Offer>,
    /// The text could end there.
    pub(super) is_whole: bool,
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
