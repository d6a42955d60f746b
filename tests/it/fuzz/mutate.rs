//! Changes to inputs that leave most of their structure standing.

use rand_core::Rng as _;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::wire;

/// Numbers at which readers break.
const NUMBERS: &[&str] = &[
    "0",
    "-0",
    "-1",
    "1",
    "2",
    "63",
    "64",
    "65",
    "255",
    "256",
    "65535",
    "65536",
    "2147483648",
    "4294967295",
    "4294967296",
    "18446744073709551615",
    "18446744073709551616",
    "1e-320",
    "1e-30",
    "1e15",
    "1e30",
    "1e38",
    "1e39",
    "1e308",
    "1e309",
    "-1e308",
    "nan",
    "inf",
    "-inf",
    "0.1",
    ".5",
    "5.",
    "+1",
    "0x10",
    "00",
    "1_0",
    "1e",
    "99999999999999999999999999999999999999",
];

/// Random choices.
pub(super) struct Dice(pub(super) Xoshiro256PlusPlus);

impl Dice {
    /// A number below `limit`, which must not be 0.
    pub(super) fn below(&mut self, limit: usize) -> usize {
        (self.0.next_u64() % limit as u64) as usize
    }

    /// One of `all`, which must not be empty.
    pub(super) fn choose<'a, T>(&mut self, all: &'a [T]) -> &'a T {
        &all[self.below(all.len())]
    }

    /// A part of something of this length, mostly short.
    fn range(&mut self, length: usize) -> std::ops::Range<usize> {
        let start = self.below(length + 1);
        let most = if self.below(4) == 0 { length } else { 16 };
        start..(start + self.below(most + 1)).min(length)
    }
}

/// What the inputs of a reader are made of.
#[derive(Clone, Copy)]
pub(super) enum Mutator<'a> {
    /// Words, numbers and signs; these words mean something.
    Text(&'a [&'a str]),
    /// Fields of a protocol buffer.
    Wire,
}

impl Mutator<'_> {
    /// Changes `input` in one place; `corpus` is where pieces are taken from.
    pub(super) fn mutate(self, input: &mut Vec<u8>, corpus: &[Vec<u8>], dice: &mut Dice) {
        match self {
            Self::Text(words) if dice.below(6) > 0 => text(input, words, corpus, dice),
            Self::Wire if dice.below(6) > 0 => wire::mutate(input, corpus, dice),
            Self::Text(_) | Self::Wire => bytes(input, corpus, dice),
        }
    }
}

/// Changes some bytes, whatever they mean.
pub(super) fn bytes(input: &mut Vec<u8>, corpus: &[Vec<u8>], dice: &mut Dice) {
    let range = dice.range(input.len());
    match dice.below(7) {
        0 if !input.is_empty() => {
            let at = dice.below(input.len());
            input[at] ^= 1 << dice.below(8);
        }
        1 if !input.is_empty() => {
            let at = dice.below(input.len());
            input[at] = *dice.choose(&[0, 1, 0x20, 0x7f, 0x80, 0xff]);
        }
        2 => drop(input.drain(range)),
        3 => {
            let copy = input[range.clone()].to_vec();
            input.splice(range.start..range.start, copy);
        }
        4 => input.truncate(range.start),
        5 => {
            let other = dice.choose(corpus);
            let piece = other[dice.range(other.len())].to_vec();
            input.splice(range, piece);
        }
        _ => {
            let noise = dice.0.next_u64().to_le_bytes();
            input.splice(range.start..range.start, noise.into_iter().take(dice.below(8)));
        }
    }
}

/// Where the words, the numbers, the signs and the gaps of a text lie.
fn tokens(text: &[u8]) -> Vec<std::ops::Range<usize>> {
    let class = |byte: u8| match byte {
        b'0'..=b'9' | b'a'..=b'z' | b'A'..=b'Z' | b'_' | b'.' | 0x80.. => 0,
        b' ' | b'\t' => 1,
        // Signs stand alone.
        sign => 2 + u16::from(sign),
    };
    let mut found: Vec<std::ops::Range<usize>> = Vec::new();
    for (at, &byte) in text.iter().enumerate() {
        match found.last_mut() {
            Some(last) if class(text[last.start]) == class(byte) && class(byte) < 2 => {
                last.end += 1;
            }
            _ => found.push(at..at + 1),
        }
    }
    found
}

/// Changes a word, a line, or how often something is said.
fn text(input: &mut Vec<u8>, words: &[&str], corpus: &[Vec<u8>], dice: &mut Dice) {
    let found = tokens(input);
    if found.is_empty() {
        input.extend(dice.choose(words).bytes());
        return;
    }
    let token = dice.choose(&found).clone();
    match dice.below(11) {
        0 => drop(input.drain(token)),
        1 | 2 => drop(input.splice(token, dice.choose(words).bytes())),
        3 => drop(input.splice(token.end..token.end, dice.choose(words).bytes())),
        4 | 5 => {
            let is_number = |t: &&std::ops::Range<usize>| input[t.start].is_ascii_digit();
            let numbers: Vec<_> = found.iter().filter(is_number).cloned().collect();
            let place = if numbers.is_empty() { token } else { dice.choose(&numbers).clone() };
            input.splice(place, dice.choose(NUMBERS).bytes());
        }
        6 => {
            let other = dice.choose(&found).clone();
            let (a, b) = if token.start <= other.start { (token, other) } else { (other, token) };
            let (first, second) = (input[a.clone()].to_vec(), input[b.clone()].to_vec());
            input.splice(b, first);
            input.splice(a, second);
        }
        7 => {
            // From here to some token after it, once more or many times: lists and nests grow.
            let until = found[dice.below(found.len())].end.max(token.end);
            let piece = input[token.start..until.min(token.start + 200)].to_vec();
            let times = *dice.choose(&[1, 1, 1, 2, 8, 70, 300]);
            input.splice(token.start..token.start, piece.repeat(times));
        }
        8 => {
            let other = dice.choose(corpus);
            let from = tokens(other);
            if let Some(start) = (!from.is_empty()).then(|| dice.below(from.len())) {
                let end = (start + 1 + dice.below(12)).min(from.len());
                let piece = other[from[start].start..from[end - 1].end].to_vec();
                input.splice(token, piece);
            }
        }
        9 => lines(input, dice),
        _ => {
            let until = found[dice.below(found.len())].end;
            if token.start < until {
                input.drain(token.start..until.min(token.start + 60));
            }
        }
    }
}

/// Leaves a line out, says it twice, or lets two change places.
fn lines(input: &mut Vec<u8>, dice: &mut Dice) {
    let mut all: Vec<Vec<u8>> =
        input.split_inclusive(|&b| b == b'\n').map(<[u8]>::to_vec).collect();
    let (a, b) = (dice.below(all.len()), dice.below(all.len()));
    match dice.below(3) {
        0 => drop(all.remove(a)),
        1 => {
            let copy = all[a].clone();
            all.insert(b, copy);
        }
        _ => all.swap(a, b),
    }
    *input = all.concat();
}
