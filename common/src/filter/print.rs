//! A filter as text, which reads back as the same filter.

use std::fmt::{self, Display, Formatter};

use super::condition::vertex::{VertexCheck, VertexTest};
use super::condition::{Described, Form, Leaf, NumberPart};
use super::quote::InQuotes;
use super::word::{NameList, Walk, Word};
use super::{LightPathExpression, Name, Tree};

impl<T: Described + Clone> Display for Tree<T> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Constant(value) => write!(f, "{value}"),
            Self::Not(part) => {
                f.write_str("not ")?;
                grouped(f, part, part.is_group())
            }
            Self::And(parts) => joined(f, parts, ["and", "true"], Self::is_group),
            Self::Or(parts) => {
                joined(f, parts, ["or", "false"], |part| matches!(part, Self::Or(_)))
            }
            Self::Leaf(leaf) => f.write_str(&text_of(leaf)),
        }
    }
}

/// `part`, in parentheses where it needs them.
fn grouped(f: &mut Formatter<'_>, part: &impl Display, needs: bool) -> fmt::Result {
    if needs { write!(f, "({part})") } else { part.fmt(f) }
}

/// The parts with an operator between them; `empty` where there are none.
fn joined<T: Display>(
    f: &mut Formatter<'_>,
    parts: &[T],
    [operator, empty]: [&str; 2],
    is_grouped: fn(&T) -> bool,
) -> fmt::Result {
    if parts.is_empty() {
        return f.write_str(empty);
    }
    for (i, part) in parts.iter().enumerate() {
        if i > 0 {
            write!(f, " {operator} ")?;
        }
        grouped(f, part, is_grouped(part))?;
    }
    Ok(())
}

impl Display for Leaf {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(&text_of(self))
    }
}

impl Display for VertexCheck {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(&text_of(self))
    }
}

/// The text of something that describes itself.
pub(super) fn text_of(described: &(impl Described + Clone)) -> String {
    let mut printer = Printer { text: String::new(), tight: true };
    let walked = described.clone().describe(&mut printer);
    debug_assert_eq!(walked, Ok(()), "nothing stops whoever prints");
    printer.text
}

/// Prints what is described.
#[derive(Debug)]
struct Printer {
    text: String,
    /// No blank belongs before what comes next.
    tight: bool,
}

impl Printer {
    fn put(&mut self, part: impl Display) {
        if !self.tight {
            self.text.push(' ');
        }
        self.text.push_str(&part.to_string());
        self.tight = false;
    }
}

impl Form for Printer {
    fn word(&mut self, word: &'static Word) -> Walk {
        self.put(word.text);
        Ok(())
    }

    fn sign(&mut self, sign: &'static str, _: &'static str) -> Walk {
        self.text.push_str(sign);
        self.tight = true;
        Ok(())
    }

    fn choice(&mut self, _: &'static str, words: &[Word], chosen: &mut usize) -> Walk {
        self.put(words.get(*chosen).map_or("", |word| word.text));
        Ok(())
    }

    fn number(&mut self, _: &NumberPart, value: &mut f64) -> Walk {
        self.put(Exact(*value));
        Ok(())
    }

    fn name(&mut self, _: NameList, name: &mut Name) -> Walk {
        self.put(name);
        Ok(())
    }

    fn names(&mut self, _: NameList, names: &mut Vec<Name>) -> Walk {
        let texts: Vec<String> = names.iter().map(ToString::to_string).collect();
        self.put(texts.join(", "));
        Ok(())
    }

    fn expression(&mut self, expression: &mut LightPathExpression) -> Walk {
        self.put(InQuotes(expression.text()));
        Ok(())
    }

    fn vertex(&mut self, test: &mut VertexTest) -> Walk {
        if test.is_group() {
            self.put(format_args!("({test})"));
        } else {
            self.put(test);
        }
        Ok(())
    }

    fn check(&mut self, _: usize, _: Option<&'static str>) -> Walk {
        Ok(())
    }
}

/// A finite number as the text that reads back as the same one.
#[derive(Debug)]
struct Exact(f64);

impl Display for Exact {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        if size == 0.0 || (1e-5..1e15).contains(&size) {
            write!(f, "{}", self.0)
        } else {
            write!(f, "{:e}", self.0)
        }
    }
}

impl Display for Name {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        InQuotes(&self.text).fmt(f)
    }
}
