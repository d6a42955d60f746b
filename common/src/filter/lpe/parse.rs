//! The text of a light path expression.

use super::symbol::{Bases, LETTERS, MAX_LABELS};
use super::{Atom, Node};
use crate::filter::offers::{Offer, Offers};
use crate::filter::quote::escaped;
use crate::filter::reader::Reader;
use crate::filter::word::{NameList, Stop, Word};
use crate::filter::{FilterError, FilterScene, Name};

/// An expression is no longer than this, in bytes.
const MAX_TEXT: usize = 1024;
/// The largest number in a repetition.
const MAX_REPEAT: u32 = 64;
/// Repetition signs in a row at most: each nests the tree once more.
const MAX_SIGNS: usize = 4;

/// What may follow a complete expression.
const CONTINUATION: &str = "an event (C L O B R T V D G S s .), `[...]`, `<...>`, `'label'`, `|`, \
                            `(`, `*`, `+`, `?` or `{n,m}`";

const ANY: Word = Word::new(".", "anything");
const OR: Word = Word::new("|", "either");
const TRIPLE: Word = Word::new("<", "all of this at one vertex, as in <RD>");
const END_OF_TRIPLE: Word = Word::new(">", "closes");
const END_OF_CLASS: Word = Word::new("]", "closes");
const END_OF_GROUP: Word = Word::new(")", "closes");
const LABEL: Word = Word::new("'", "on a material");
const SOME: Word = Word::new("*", "any number of times");
const MORE: Word = Word::new("+", "once or more");
const MAYBE: Word = Word::new("?", "at most once");

/// The tree of `text`, and the labels in the order of their numbers.
pub(super) fn parse(text: &str) -> Result<(Node, Vec<Name>), FilterError> {
    if text.len() > MAX_TEXT {
        let message = format!("a light path expression has at most {MAX_TEXT} bytes; shorten it");
        return Err(FilterError::new(MAX_TEXT..text.len(), message));
    }
    let mut parser = Parser { reader: Reader::of_expression(text, None), labels: Vec::new() };
    let node = parser.whole()?;
    Ok((node, parser.labels))
}

/// What may come at the end of `text`.
pub(super) fn offers(text: &str, scene: &FilterScene) -> Vec<Offer> {
    let reader = Reader::of_expression(text, Some(Offers::new(scene)));
    let mut parser = Parser { reader, labels: Vec::new() };
    // What is wrong is wrong before the end, where nothing is offered then.
    drop(parser.whole());
    parser.reader.into_offers().map(|offers| offers.found).unwrap_or_default()
}

struct Parser<'a> {
    reader: Reader<'a>,
    labels: Vec<Name>,
}

impl Parser<'_> {
    fn whole(&mut self) -> Result<Node, FilterError> {
        let labels = &mut self.labels;
        let read = |reader: &mut Reader<'_>| alternatives(reader, labels, true);
        self.reader.whole(CONTINUATION, read)
    }
}

fn missing<T>(reader: &mut Reader<'_>, what: &str) -> Result<T, Stop> {
    reader.expect(what.to_owned());
    Err(Stop)
}

/// `is_first` tells whether a path may begin here.
fn alternatives(
    reader: &mut Reader<'_>,
    labels: &mut Vec<Name>,
    is_first: bool,
) -> Result<Node, Stop> {
    let mut branches = vec![sequence(reader, labels, is_first)?];
    while reader.accept_word(&OR) {
        branches.push(sequence(reader, labels, is_first)?);
    }
    Ok(if branches.len() == 1 { branches.remove(0) } else { Node::Either(branches) })
}

fn sequence(reader: &mut Reader<'_>, labels: &mut Vec<Name>, is_first: bool) -> Result<Node, Stop> {
    let mut nodes = Vec::new();
    loop {
        let is_first = is_first && nodes.is_empty();
        reader.skip_blanks();
        offer_events(reader, is_first);
        if matches!(reader.rest().chars().next(), None | Some('|' | ')')) {
            break;
        }
        let node = item(reader, labels, is_first)?;
        nodes.push(repeated(reader, node)?);
    }
    match nodes.len() {
        0 => missing(reader, CONTINUATION),
        1 => Ok(nodes.remove(0)),
        _ => Ok(Node::Sequence(nodes)),
    }
}

/// Offers what may be an event; a path begins at the camera or at a light.
fn offer_events(reader: &mut Reader<'_>, is_first: bool) {
    for (letter, meaning, bases) in LETTERS {
        if !is_first || bases.meets(Bases::CAMERA.or(Bases::LIGHTS)) {
            reader.offer(letter.encode_utf8(&mut [0; 4]), meaning);
        }
    }
    reader.offer(ANY.text, ANY.meaning);
    if !is_first {
        reader.offer(TRIPLE.text, TRIPLE.meaning);
        reader.offer(LABEL.text, LABEL.meaning);
    }
}

fn item(reader: &mut Reader<'_>, labels: &mut Vec<Name>, is_first: bool) -> Result<Node, Stop> {
    if reader.accept("(") {
        let node = reader.deeper(|reader| alternatives(reader, labels, is_first))?;
        let closes = reader.accept_word(&END_OF_GROUP);
        return if closes { Ok(node) } else { missing(reader, "`)` to close the group") };
    }
    if reader.accept("<") {
        return triple(reader, labels).map(|atom| Node::Event(vec![atom], false));
    }
    if reader.accept("'") {
        let label = label(reader, labels)?;
        return Ok(Node::Event(vec![Atom { bases: Bases::ALL, label: Some(label) }], false));
    }
    if reader.accept("[") {
        return class(reader, labels);
    }
    let bases = letter(reader)?;
    Ok(Node::Event(vec![Atom { bases, label: None }], false))
}

/// A letter or a dot.
fn letter(reader: &mut Reader<'_>) -> Result<Bases, Stop> {
    reader.skip_blanks();
    let found = reader.rest().chars().next();
    let bases = found.and_then(|c| if c == '.' { Some(Bases::ALL) } else { Bases::of_letter(c) });
    let Some(bases) = bases else { return missing(reader, CONTINUATION) };
    reader.letter();
    Ok(bases)
}

/// `[...]` or `[^...]`, after the bracket.
fn class(reader: &mut Reader<'_>, labels: &mut Vec<Name>) -> Result<Node, Stop> {
    let negated = reader.accept("^");
    let mut atoms: Vec<Atom> = Vec::new();
    loop {
        let closes = (negated || !atoms.is_empty()) && reader.accept_word(&END_OF_CLASS);
        if closes {
            return Ok(Node::Event(atoms, negated));
        }
        offer_events(reader, false);
        if reader.accept("]") {
            let start = reader.position().saturating_sub(2);
            return reader.wrong(start, "`[]` matches nothing; put events between the brackets");
        }
        atoms.push(if reader.accept("<") {
            triple(reader, labels)?
        } else if reader.accept("'") {
            Atom { bases: Bases::ALL, label: Some(label(reader, labels)?) }
        } else {
            Atom { bases: letter(reader)?, label: None }
        });
    }
}

/// `<event scattering 'label'>`, after the bracket; missing parts match anything.
fn triple(reader: &mut Reader<'_>, labels: &mut Vec<Name>) -> Result<Atom, Stop> {
    let start = reader.position() - 1;
    let mut bases = Bases::ALL;
    let mut numbered = None;
    for _ in 0..2 {
        reader.skip_blanks();
        for (letter, meaning, own) in LETTERS {
            if bases.meets(own) {
                reader.offer(letter.encode_utf8(&mut [0; 4]), meaning);
            }
        }
        reader.offer(LABEL.text, LABEL.meaning);
        reader.offer(END_OF_TRIPLE.text, END_OF_TRIPLE.meaning);
        if matches!(reader.rest().chars().next(), Some('>' | '\'')) {
            break;
        }
        bases = bases.and(letters(reader)?);
    }
    if reader.accept_word(&LABEL) {
        numbered = Some(label(reader, labels)?);
    } else {
        // OSL writes a dot where any label will do.
        reader.accept(".");
    }
    if !reader.accept_word(&END_OF_TRIPLE) {
        return missing(reader, "`>` after an event, a scattering and a label");
    }
    if bases.0 == 0 {
        return reader.wrong(start, "no event is both; write for instance `<RD>` or `<TS'glass'>`");
    }
    Ok(Atom { bases, label: numbered })
}

/// A letter, or letters in brackets, without labels.
fn letters(reader: &mut Reader<'_>) -> Result<Bases, Stop> {
    if !reader.accept("[") {
        return letter(reader);
    }
    let negated = reader.accept("^");
    let mut bases = Bases(0);
    while !reader.accept("]") {
        bases = bases.or(letter(reader)?);
    }
    Ok(if negated { bases.complement() } else { bases })
}

/// A label, after its opening quote, in which `\'` and `\\` stand for the second sign; returns its
/// number.
fn label(reader: &mut Reader<'_>, labels: &mut Vec<Name>) -> Result<usize, Stop> {
    let offset = reader.position();
    if labels.len() < MAX_LABELS {
        reader.offer_names(NameList::Materials, |name| format!("{}'", escaped(name, '\'')));
    }
    let mut text = String::new();
    loop {
        match reader.letter() {
            Some('\'') => break,
            Some('\\') => text.extend(reader.letter()),
            Some(letter) => text.push(letter),
            None => return missing(reader, "a label that ends with `'`, such as `'glass'`"),
        }
    }
    if let Some(known) = labels.iter().position(|label| label.text == text) {
        return Ok(known + 1);
    }
    if labels.len() == MAX_LABELS {
        let message = format!("more than {MAX_LABELS} different labels; use fewer");
        return reader.wrong(offset, message);
    }
    labels.push(Name { text, offset });
    Ok(labels.len())
}

/// `*`, `+`, `?` or `{n,m}` after `node`, a few times.
fn repeated(reader: &mut Reader<'_>, mut node: Node) -> Result<Node, Stop> {
    for signs in 0..=MAX_SIGNS {
        reader.skip_blanks();
        if signs == 0 {
            reader.offer_last(&[SOME, MORE, MAYBE]);
        }
        let (least, most) = if reader.accept(SOME.text) {
            (0, None)
        } else if reader.accept(MORE.text) {
            (1, None)
        } else if reader.accept(MAYBE.text) {
            (0, Some(1))
        } else if reader.accept("{") {
            bounds(reader)?
        } else {
            return Ok(node);
        };
        node = Node::Repeat { node: Box::new(node), least, most };
    }
    reader.wrong(reader.position(), "too many repetition operators in a row; one is enough")
}

/// `n}`, `n,}`, `,m}` or `n,m}`.
fn bounds(reader: &mut Reader<'_>) -> Result<(u32, Option<u32>), Stop> {
    let start = reader.position();
    let least = number(reader)?;
    let most = if reader.accept(",") { number(reader)? } else { least };
    if !reader.accept("}") {
        return missing(reader, "a repetition such as `{2}`, `{2,}` or `{2,4}`");
    }
    match (least, most) {
        (None, None) => {
            reader.wrong(start, "a repetition needs a number, such as `{2}` or `{2,4}`")
        }
        (least, Some(most)) if least.unwrap_or(0) > most => {
            let message = "the first number of a repetition must not exceed the second";
            reader.wrong(start, message)
        }
        (least, most) => Ok((least.unwrap_or(0), most)),
    }
}

fn number(reader: &mut Reader<'_>) -> Result<Option<u32>, Stop> {
    reader.skip_blanks();
    let start = reader.position();
    let digits = reader.run(|c| c.is_ascii_digit());
    if digits.is_empty() {
        return Ok(None);
    }
    match digits.parse() {
        Ok(number) if number <= MAX_REPEAT => Ok(Some(number)),
        _ => reader.wrong(start, format!("a repetition count is at most {MAX_REPEAT}")),
    }
}
