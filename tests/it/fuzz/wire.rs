//! Changes to protocol buffers, field by field.

use rand_core::Rng as _;

use super::mutate::{Dice, bytes};

/// Numbers at which readers break.
const NUMBERS: &[u64] =
    &[0, 1, 2, 65, 66, 255, 256, 65_536, 65_537, 1 << 31, u32::MAX as u64, 1 << 63, u64::MAX];
/// Floats at which readers break.
const FLOATS: &[f64] = &[
    0.0,
    -0.0,
    1.0,
    -1.0,
    1e-320,
    1e30,
    1e39,
    f64::MAX,
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
];

/// One field as it stands in the bytes.
#[derive(Clone, Debug)]
struct Field {
    number: u64,
    value: Value,
}

#[derive(Clone, Debug)]
enum Value {
    Varint(u64),
    Fixed64([u8; 8]),
    Bytes(Vec<u8>),
    Fixed32([u8; 4]),
}

/// Changes a field, at any depth; bytes that are no message are changed as such.
pub(super) fn mutate(input: &mut Vec<u8>, corpus: &[Vec<u8>], dice: &mut Dice) {
    let Some(mut fields) = parse(input).filter(|fields| !fields.is_empty()) else {
        bytes(input, corpus, dice);
        return;
    };
    let at = dice.below(fields.len());
    match dice.below(12) {
        0 => drop(fields.remove(at)),
        1 => fields.insert(dice.below(fields.len() + 1), fields[at].clone()),
        2 => {
            let b = dice.below(fields.len());
            fields.swap(at, b);
        }
        3 => fields[at].number = 1 + dice.below(46) as u64,
        4 => {
            if let Some(other) =
                parse(dice.choose(corpus).as_slice()).filter(|other| !other.is_empty())
            {
                fields.insert(at, dice.choose(&other).clone());
            }
        }
        _ => change(&mut fields[at].value, corpus, dice),
    }
    input.clear();
    for field in &fields {
        field.write(input);
    }
}

fn change(value: &mut Value, corpus: &[Vec<u8>], dice: &mut Dice) {
    match value {
        Value::Varint(number) => {
            *number = match dice.below(4) {
                0 => number.wrapping_add(1),
                1 => number.wrapping_sub(1),
                2 => dice.0.next_u64() >> dice.below(64),
                _ => *dice.choose(NUMBERS),
            };
        }
        Value::Fixed64(bytes) => *bytes = dice.choose(FLOATS).to_le_bytes(),
        Value::Fixed32(bytes) => *bytes = (*dice.choose(FLOATS) as f32).to_le_bytes(),
        Value::Bytes(content) => match dice.below(8) {
            0..4 => mutate(content, corpus, dice),
            // Columns of floats and of indices.
            4 if content.len() >= 4 => {
                let at = 4 * dice.below(content.len() / 4);
                let number = (*dice.choose(FLOATS) as f32).to_le_bytes();
                content.splice(at..at + 4, number);
            }
            5 => {
                let times = *dice.choose(&[0, 2, 3, 64, 257]);
                *content = content.repeat(times);
                content.truncate(32 << 10);
            }
            _ => bytes(content, corpus, dice),
        },
    }
}

impl Field {
    fn write(&self, out: &mut Vec<u8>) {
        let kind = match self.value {
            Value::Varint(_) => 0,
            Value::Fixed64(_) => 1,
            Value::Bytes(_) => 2,
            Value::Fixed32(_) => 5,
        };
        varint(self.number << 3 | kind, out);
        match &self.value {
            Value::Varint(number) => varint(*number, out),
            Value::Fixed64(bytes) => out.extend(bytes),
            Value::Bytes(content) => {
                varint(content.len() as u64, out);
                out.extend(content);
            }
            Value::Fixed32(bytes) => out.extend(bytes),
        }
    }
}

fn varint(mut number: u64, out: &mut Vec<u8>) {
    while number >= 0x80 {
        out.push(number as u8 | 0x80);
        number >>= 7;
    }
    out.push(number as u8);
}

/// The fields of a message; `None` where the bytes are none.
fn parse(mut bytes: &[u8]) -> Option<Vec<Field>> {
    let mut fields = Vec::new();
    while !bytes.is_empty() {
        let tag = take_varint(&mut bytes)?;
        let value = match tag & 7 {
            0 => Value::Varint(take_varint(&mut bytes)?),
            1 => Value::Fixed64(*bytes.split_off(..8)?.first_chunk()?),
            2 => {
                let length = usize::try_from(take_varint(&mut bytes)?).ok()?;
                Value::Bytes(bytes.split_off(..length)?.to_vec())
            }
            5 => Value::Fixed32(*bytes.split_off(..4)?.first_chunk()?),
            _ => return None,
        };
        fields.push(Field { number: tag >> 3, value });
    }
    Some(fields)
}

fn take_varint(bytes: &mut &[u8]) -> Option<u64> {
    let mut number = 0;
    for shift in (0..64).step_by(7) {
        let byte = *bytes.split_off_first()?;
        number |= u64::from(byte & 0x7f) << shift;
        if byte < 0x80 {
            return Some(number);
        }
    }
    None
}

#[test]
fn fields_survive_being_taken_apart() {
    let message = [0x08, 0x96, 0x01, 0x12, 0x02, 0x08, 0x01, 0x1d, 0, 0, 0x80, 0x3f];
    let fields = parse(&message).expect("a message");
    let mut again = Vec::new();
    for field in &fields {
        field.write(&mut again);
    }
    assert_eq!((fields.len(), again.as_slice()), (3, message.as_slice()), "{fields:?}");
    assert!(parse(&[0x12, 0x05, 0x00]).is_none(), "a length beyond the end");
}
