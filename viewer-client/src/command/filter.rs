//! `filter ...`: which paths are shown.

use std::fmt;

use common::{FilterText, Selector, SelectorKind, Volume};
use glam::DVec3;

use super::Form;
use super::words::{CommandError, Switch, Words};

/// Largest distance from the origin and largest radius that a selector may have, in the file's units.
const FAR: f64 = 1e12;
/// Most selectors at a time; the text of a filter has its own limits.
pub const MOST_SELECTORS: u32 = 32;
/// Most kept filters, and letters of their names.
pub const MOST_KEPT: usize = 32;
const LONGEST_NAME: usize = 40;

/// What may be done to the filter. `docs/FILTERS.md` has the grammar of its text.
#[derive(Clone, Debug, PartialEq)]
pub enum FilterCommand {
    /// This text is the filter from now on, beside the selectors.
    Set(FilterText),
    /// All paths are wanted: neither a text nor a selector is left.
    Clear,
    /// Whether the filter holds at all.
    Enable(Switch),
    /// Whether the paths that it would leave out are wanted instead.
    Invert(Switch),
    /// Adds a sphere that paths are selected by.
    Add(Sphere),
    /// Moves the selector of this number.
    Move(u32, [f64; 4]),
    /// Chooses the selector of this number for its handles.
    Choose(u32),
    /// Removes the selector of this number.
    Delete(u32),
    /// Removes every selector.
    DeleteAll,
    /// Keeps text and selectors under a name.
    Keep(String),
    /// Whether the kept filter of this name holds, beside the others.
    Use(String, Switch),
    /// Whether the opposite of the kept filter of this name holds.
    Reverse(String, Switch),
    /// Makes the kept filter of this name the text, in the place of text and selectors.
    Load(String),
    /// Keeps the filter of this name no longer.
    Forget(String),
}

/// A spherical selector: its kind, and its centre and radius in the file's units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// How it combines with others.
    pub kind: SelectorKind,
    /// Centre and radius.
    pub place: [f64; 4],
}

impl Sphere {
    /// The selector that it stands for.
    pub fn selector(self) -> Selector {
        let [x, y, z, radius] = self.place;
        let volume = Volume::Sphere { centre: DVec3::new(x, y, z), radius };
        Selector { kind: self.kind, volume, by_segment: false }
    }
}

/// How every path is asked for in a command, where a text must stand.
const ALL: &str = "true";

/// A selector's word.
#[derive(Clone, Copy)]
struct Kind(SelectorKind);

impl Kind {
    const ALL: [Self; 4] = [
        Self(SelectorKind::Start),
        Self(SelectorKind::End),
        Self(SelectorKind::Any),
        Self(SelectorKind::All),
    ];
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(kind_name(self.0))
    }
}

/// The word for a kind of selectors.
pub fn kind_name(kind: SelectorKind) -> &'static str {
    match kind {
        SelectorKind::Start => "start",
        SelectorKind::End => "end",
        SelectorKind::Any => "any",
        SelectorKind::All => "all",
    }
}

pub(super) const FORMS: &[Form] = &[
    ("filter set TEXT", "show the paths that a filter wants; see docs/FILTERS.md"),
    ("filter clear", "show all paths"),
    ("filter enable on|off|toggle", "whether the filter holds"),
    ("filter invert on|off|toggle", "show what it would leave out"),
    ("filter add start|end|any|all X Y Z RADIUS", "select by a sphere, in the file's units"),
    ("filter move NUMBER X Y Z RADIUS", "move a selector, counted from 0"),
    ("filter choose NUMBER", "show the handles of a selector"),
    ("filter delete NUMBER", "remove a selector"),
    ("filter bare", "remove every selector"),
    ("filter keep NAME", "keep text and selectors under a name"),
    ("filter use on|off|toggle NAME", "whether a kept filter holds, beside the others"),
    ("filter reverse on|off|toggle NAME", "whether the opposite of a kept filter holds"),
    ("filter load NAME", "write a kept filter into the text"),
    ("filter forget NAME", "keep a filter no longer"),
];

impl fmt::Display for FilterCommand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Set(text) if text.text().is_empty() => write!(f, "set {ALL}"),
            Self::Set(text) => write!(f, "set {text}"),
            Self::Clear => write!(f, "clear"),
            Self::Enable(switch) => write!(f, "enable {switch}"),
            Self::Invert(switch) => write!(f, "invert {switch}"),
            Self::Add(Sphere { kind, place: [x, y, z, r] }) => {
                write!(f, "add {} {x} {y} {z} {r}", Kind(*kind))
            }
            Self::Move(number, [x, y, z, r]) => write!(f, "move {number} {x} {y} {z} {r}"),
            Self::Choose(number) => write!(f, "choose {number}"),
            Self::Delete(number) => write!(f, "delete {number}"),
            Self::DeleteAll => write!(f, "bare"),
            Self::Keep(name) => write!(f, "keep {name}"),
            Self::Use(name, switch) => write!(f, "use {switch} {name}"),
            Self::Reverse(name, switch) => write!(f, "reverse {switch} {name}"),
            Self::Load(name) => write!(f, "load {name}"),
            Self::Forget(name) => write!(f, "forget {name}"),
        }
    }
}

pub(super) fn parse(words: &mut Words<'_>) -> Result<FilterCommand, CommandError> {
    const NUMBER: std::ops::RangeInclusive<u32> = 0..=MOST_SELECTORS - 1;
    Ok(match words.next("filter command")? {
        "set" => {
            let text = words.rest("TEXT")?;
            let read = FilterText::read(if text == ALL { String::new() } else { text });
            match read.error() {
                Some(problem) => return Err(CommandError::BadFilter(problem.to_string())),
                None => FilterCommand::Set(read),
            }
        }
        "clear" => FilterCommand::Clear,
        "enable" => FilterCommand::Enable(words.switch()?),
        "invert" => FilterCommand::Invert(words.switch()?),
        "add" => {
            let Kind(kind) = words.choice("KIND", &Kind::ALL)?;
            FilterCommand::Add(Sphere { kind, place: place(words)? })
        }
        "move" => FilterCommand::Move(words.count("NUMBER", NUMBER)?, place(words)?),
        "choose" => FilterCommand::Choose(words.count("NUMBER", NUMBER)?),
        "delete" => FilterCommand::Delete(words.count("NUMBER", NUMBER)?),
        "bare" => FilterCommand::DeleteAll,
        "keep" => FilterCommand::Keep(name(words)?),
        "use" => {
            let switch = words.switch()?;
            FilterCommand::Use(name(words)?, switch)
        }
        "reverse" => {
            let switch = words.switch()?;
            FilterCommand::Reverse(name(words)?, switch)
        }
        "load" => FilterCommand::Load(name(words)?),
        "forget" => FilterCommand::Forget(name(words)?),
        other => return Err(CommandError::Unknown(format!("filter {other}"))),
    })
}

/// The name of a kept filter.
fn name(words: &mut Words<'_>) -> Result<String, CommandError> {
    kept_name(&words.rest("NAME")?).ok_or(CommandError::NoName(LONGEST_NAME))
}

/// The name of a kept filter as it is written: words with one blank between them; `None` where it is
/// none, or too long, or would end a command in a link.
pub fn kept_name(text: &str) -> Option<String> {
    let name = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let fits = (1..=LONGEST_NAME).contains(&name.chars().count());
    (fits && !name.contains(|c: char| c == ';' || c.is_control())).then_some(name)
}

fn place(words: &mut Words<'_>) -> Result<[f64; 4], CommandError> {
    Ok([
        words.within("X", -FAR..=FAR)?,
        words.within("Y", -FAR..=FAR)?,
        words.within("Z", -FAR..=FAR)?,
        words.within("RADIUS", f64::MIN_POSITIVE..=FAR)?,
    ])
}
