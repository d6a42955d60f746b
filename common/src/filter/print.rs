//! A filter as text, which reads back as the same filter.

use std::fmt::{self, Display, Formatter};

use super::number::Exact;
use super::{Filter, Leaf, Name, Named, Place, VertexClass, VertexTest, Volume};

impl Display for Filter {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Constant(value) => write!(f, "{value}"),
            Self::Not(part) => {
                f.write_str("not ")?;
                grouped(f, part.as_ref(), part.is_compound())
            }
            Self::And(parts) => joined(f, parts, "and", "true", Self::is_compound),
            Self::Or(parts) => joined(f, parts, "or", "false", |part| matches!(part, Self::Or(_))),
            Self::Leaf(leaf) => leaf.fmt(f),
        }
    }
}

impl Filter {
    fn is_compound(&self) -> bool {
        matches!(self, Self::And(_) | Self::Or(_))
    }
}

impl Display for VertexTest {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Inside(volume) => write!(f, "in {volume}"),
            Self::On(kind, name) => write!(f, "on {} {name}", word(&Named::NAMES, kind)),
            Self::Is(class) => write!(f, "is {}", word(&VertexClass::NAMES, class)),
            Self::Not(part) => {
                f.write_str("not ")?;
                grouped(f, part.as_ref(), part.is_compound())
            }
            Self::And(parts) => joined(f, parts, "and", "", Self::is_compound),
            Self::Or(parts) => joined(f, parts, "or", "", |part| matches!(part, Self::Or(_))),
        }
    }
}

impl VertexTest {
    fn is_compound(&self) -> bool {
        matches!(self, Self::And(_) | Self::Or(_))
    }
}

/// `part`, in parentheses where it is compound.
fn grouped(f: &mut Formatter<'_>, part: &impl Display, compound: bool) -> fmt::Result {
    if compound { write!(f, "({part})") } else { part.fmt(f) }
}

/// The parts with an operator between them; `empty` where there are none.
fn joined<T: Display>(
    f: &mut Formatter<'_>,
    parts: &[T],
    operator: &str,
    empty: &str,
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

/// The word for `value` in a table.
fn word<T: PartialEq>(names: &[(T, &'static str)], value: &T) -> &'static str {
    names.iter().find(|(known, _)| known == value).map_or("", |&(_, word)| word)
}

impl Display for Leaf {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Vertex { place, test } => {
                write!(f, "{place} ")?;
                grouped(f, test, test.is_compound())
            }
            Self::Segment { place, volume } => write!(f, "{place} through {volume}"),
            Self::LightPath(expression) => write!(f, "lpe {}", Quoted(expression.text())),
            Self::Film { min: [u0, v0], max: [u1, v1] } => {
                write!(
                    f,
                    "film in rect({}, {}, {}, {})",
                    Exact(*u0),
                    Exact(*v0),
                    Exact(*u1),
                    Exact(*v1)
                )
            }
            Self::Number { attribute, comparison, value } => {
                write!(f, "{} {} {}", attribute.name(), comparison.sign(), Exact(*value))
            }
            Self::Range { attribute, least, most } => {
                write!(f, "{} in {}..{}", attribute.name(), Exact(*least), Exact(*most))
            }
            Self::Strategy(names) => match names.as_slice() {
                [name] => write!(f, "strategy == {name}"),
                names => {
                    f.write_str("strategy in (")?;
                    joined(f, names, ",", "", |_| false)?;
                    f.write_str(")")
                }
            },
        }
    }
}

impl Display for Place {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(word(&Self::NAMES, self))
    }
}

impl Display for Volume {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Sphere { centre: c, radius } => {
                write!(
                    f,
                    "sphere({}, {}, {}, {})",
                    Exact(c.x),
                    Exact(c.y),
                    Exact(c.z),
                    Exact(*radius)
                )
            }
            Self::Box { min, max } => {
                write!(f, "box({}, {}, {}, ", Exact(min.x), Exact(min.y), Exact(min.z))?;
                write!(f, "{}, {}, {})", Exact(max.x), Exact(max.y), Exact(max.z))
            }
        }
    }
}

impl Display for Name {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        Quoted(&self.text).fmt(f)
    }
}

/// A text in double quotes.
struct Quoted<'a>(&'a str);

impl Display for Quoted<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str("\"")?;
        for part in self.0.split_inclusive(['"', '\\']) {
            match part.strip_suffix(['"', '\\']) {
                Some(before) => write!(f, "{before}\\{}", &part[before.len()..])?,
                None => f.write_str(part)?,
            }
        }
        f.write_str("\"")
    }
}
