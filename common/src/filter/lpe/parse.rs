//! The text of a light path expression.

use super::super::FilterError;
use super::super::syntax::{
    Input, Parsed, accept, deeper, expected, parse_all, position, require, rest, skip_blanks,
    take_run, wrong,
};
use super::symbol::{Bases, MAX_LABELS};
use super::{Atom, Node};
use crate::filter::Name;
use winnow::stream::Stream as _;

/// An expression is no longer than this, in bytes.
const MAX_TEXT: usize = 1024;
/// The largest number in a repetition.
const MAX_REPEAT: u32 = 64;

/// What may follow a complete expression.
const CONTINUATION: &str = "an event (C L O B R T V D G S s .), `[...]`, `<...>`, `'label'`, `|`, \
                            `(`, `*`, `+`, `?` or `{n,m}`";

/// The tree of `text`, and the labels in the order of their numbers.
pub(super) fn parse(text: &str) -> Result<(Node, Vec<Name>), FilterError> {
    if text.len() > MAX_TEXT {
        let message = format!("a light path expression has at most {MAX_TEXT} bytes; shorten it");
        return Err(FilterError::new(MAX_TEXT..text.len(), message));
    }
    let mut labels = Vec::new();
    let node = parse_all(text, |input| alternatives(input, &mut labels), CONTINUATION)?;
    Ok((node, labels))
}

fn alternatives(input: &mut Input<'_>, labels: &mut Vec<Name>) -> Parsed<Node> {
    let mut branches = vec![sequence(input, labels)?];
    while accept(input, "|") {
        branches.push(sequence(input, labels)?);
    }
    Ok(if branches.len() == 1 { branches.remove(0) } else { Node::Either(branches) })
}

fn sequence(input: &mut Input<'_>, labels: &mut Vec<Name>) -> Parsed<Node> {
    let mut nodes = Vec::new();
    loop {
        skip_blanks(input);
        if matches!(rest(input).chars().next(), None | Some('|' | ')')) {
            break;
        }
        let node = item(input, labels)?;
        nodes.push(repeated(input, node)?);
    }
    match nodes.len() {
        0 => Err(expected(input, CONTINUATION)),
        1 => Ok(nodes.remove(0)),
        _ => Ok(Node::Sequence(nodes)),
    }
}

fn item(input: &mut Input<'_>, labels: &mut Vec<Name>) -> Parsed<Node> {
    if accept(input, "(") {
        let node = deeper(input, |input| alternatives(input, labels))?;
        require(input, ")", "`)` to close the group")?;
        return Ok(node);
    }
    if accept(input, "<") {
        return triple(input, labels);
    }
    if accept(input, "'") {
        let label = label(input, labels)?;
        return Ok(Node::Event(vec![Atom { bases: Bases::ALL, label: Some(label) }], false));
    }
    if accept(input, "[") {
        return class(input, labels);
    }
    let bases = letter(input)?;
    Ok(Node::Event(vec![Atom { bases, label: None }], false))
}

/// A letter or a dot.
fn letter(input: &mut Input<'_>) -> Parsed<Bases> {
    skip_blanks(input);
    let found = rest(input).chars().next();
    let bases = found.and_then(|c| if c == '.' { Some(Bases::ALL) } else { Bases::of_letter(c) });
    let Some(bases) = bases else { return Err(expected(input, CONTINUATION)) };
    input.next_slice(1);
    Ok(bases)
}

/// `[...]` or `[^...]`, after the bracket.
fn class(input: &mut Input<'_>, labels: &mut Vec<Name>) -> Parsed<Node> {
    let negated = accept(input, "^");
    let mut atoms: Vec<Atom> = Vec::new();
    while !accept(input, "]") {
        if accept(input, "<") {
            let Node::Event(inner, _) = triple(input, labels)? else { continue };
            atoms.extend(inner);
        } else if accept(input, "'") {
            atoms.push(Atom { bases: Bases::ALL, label: Some(label(input, labels)?) });
        } else {
            atoms.push(Atom { bases: letter(input)?, label: None });
        }
    }
    if atoms.is_empty() && !negated {
        let start = position(input).saturating_sub(2);
        return wrong(start, input, "`[]` matches nothing; put events between the brackets");
    }
    Ok(Node::Event(atoms, negated))
}

/// `<event scattering 'label'>`, after the bracket; missing parts match anything.
fn triple(input: &mut Input<'_>, labels: &mut Vec<Name>) -> Parsed<Node> {
    let start = position(input) - 1;
    let mut bases = Bases::ALL;
    let mut numbered = None;
    for _ in 0..2 {
        skip_blanks(input);
        if matches!(rest(input).chars().next(), Some('>' | '\'')) {
            break;
        }
        bases = bases.and(letters(input)?);
    }
    if accept(input, "'") {
        numbered = Some(label(input, labels)?);
    } else {
        // OSL writes a dot where any label will do.
        accept(input, ".");
    }
    require(input, ">", "`>` after an event, a scattering and a label")?;
    if bases.0 == 0 {
        return wrong(start, input, "no event is both; write for instance `<RD>` or `<TS'glass'>`");
    }
    Ok(Node::Event(vec![Atom { bases, label: numbered }], false))
}

/// A letter, or letters in brackets, without labels.
fn letters(input: &mut Input<'_>) -> Parsed<Bases> {
    if !accept(input, "[") {
        return letter(input);
    }
    let negated = accept(input, "^");
    let mut bases = Bases(0);
    while !accept(input, "]") {
        bases = bases.or(letter(input)?);
    }
    Ok(if negated { bases.complement() } else { bases })
}

/// A label, after its opening quote; returns its number.
fn label(input: &mut Input<'_>, labels: &mut Vec<Name>) -> Parsed<usize> {
    let offset = position(input);
    let Some(length) = rest(input).find('\'') else {
        return Err(expected(input, "a label that ends with `'`, such as `'glass'`"));
    };
    let text = input.next_slice(length);
    input.next_slice(1);
    if let Some(known) = labels.iter().position(|label| label.text == text) {
        return Ok(known + 1);
    }
    if labels.len() == MAX_LABELS {
        let message = format!("more than {MAX_LABELS} different labels; use fewer");
        return wrong(offset, input, message);
    }
    labels.push(Name { text: text.to_owned(), offset });
    Ok(labels.len())
}

/// `*`, `+`, `?` or `{n,m}` after `node`, any number of times.
fn repeated(input: &mut Input<'_>, mut node: Node) -> Parsed<Node> {
    // Each sign nests the tree once more.
    for _ in 0..5 {
        let (least, most) = if accept(input, "*") {
            (0, None)
        } else if accept(input, "+") {
            (1, None)
        } else if accept(input, "?") {
            (0, Some(1))
        } else if accept(input, "{") {
            bounds(input)?
        } else {
            return Ok(node);
        };
        node = Node::Repeat { node: Box::new(node), least, most };
    }
    wrong(position(input), input, "too many repetition signs in a row; one is enough")
}

/// `n}`, `n,}`, `,m}` or `n,m}`.
fn bounds(input: &mut Input<'_>) -> Parsed<(u32, Option<u32>)> {
    let start = position(input);
    let least = number(input)?;
    let most = if accept(input, ",") { number(input)? } else { least };
    require(input, "}", "a repetition such as `{2}`, `{2,}` or `{2,4}`")?;
    match (least, most) {
        (None, None) => {
            wrong(start, input, "a repetition needs a number, such as `{2}` or `{2,4}`")
        }
        (least, Some(most)) if least.unwrap_or(0) > most => {
            wrong(start, input, "the first number of a repetition must not exceed the second")
        }
        (least, most) => Ok((least.unwrap_or(0), most)),
    }
}

fn number(input: &mut Input<'_>) -> Parsed<Option<u32>> {
    skip_blanks(input);
    let start = position(input);
    let digits = take_run(input, |c| c.is_ascii_digit());
    if digits.is_empty() {
        return Ok(None);
    }
    match digits.parse() {
        Ok(number) if number <= MAX_REPEAT => Ok(Some(number)),
        _ => wrong(start, input, format!("a repetition counts to {MAX_REPEAT} at most")),
    }
}
