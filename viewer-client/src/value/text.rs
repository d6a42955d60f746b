//! Texts that go to the end of the line.

use common::FilterText;

use super::{CommandError, Value, Words};

/// What is asked of a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Line {
    /// Nothing; help texts show it as this.
    Any(&'static str),
    /// That it is a name, see [`name`].
    Name,
}

/// Letters of the longest name.
const LONGEST: usize = 40;

/// The name as it is written: words with one blank between them; `None` where it is none, or too long,
/// or would end a command in a link.
pub fn name(text: &str) -> Option<String> {
    let name = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let fits = (1..=LONGEST).contains(&name.chars().count());
    (fits && !name.contains(|c: char| c == ';' || c.is_control())).then_some(name)
}

/// All that is left of the line, such as the name of a file.
impl Value for String {
    type Limits = Line;

    fn form(_: &str, line: &Line) -> String {
        let shown = match line {
            Line::Any(shown) => shown,
            Line::Name => "NAME",
        };
        shown.to_owned()
    }

    fn read(words: &mut Words<'_>, parameter: &str, line: &Line) -> Result<Self, CommandError> {
        let text = words.rest(&Self::form(parameter, line))?;
        match line {
            Line::Any(_) => Ok(text.to_owned()),
            Line::Name => name(text).ok_or(CommandError::NoName(LONGEST)),
        }
    }

    fn text(&self) -> String {
        self.clone()
    }

    fn examples(line: &Line) -> Vec<Self> {
        let examples = match line {
            Line::Any(_) => ["a.b", "two  words # and \"more\"; сцена"],
            Line::Name => ["x", "my caustics"],
        };
        examples.map(str::to_owned).to_vec()
    }
}

/// How every path is asked for in a command, where a text must stand.
const ALL: &str = "true";

/// The text of a filter, which can be read.
impl Value for FilterText {
    type Limits = ();

    fn form(name: &str, (): &()) -> String {
        name.to_uppercase()
    }

    fn read(words: &mut Words<'_>, name: &str, (): &()) -> Result<Self, CommandError> {
        let text = words.rest(&name.to_uppercase())?;
        let read = Self::read(if text == ALL { "" } else { text });
        match read.error() {
            Some(problem) => Err(CommandError::BadFilter(problem.to_string())),
            None => Ok(read),
        }
    }

    fn text(&self) -> String {
        let text = self.text();
        if text.is_empty() { ALL.to_owned() } else { text.to_owned() }
    }

    fn examples((): &()) -> Vec<Self> {
        ["", "film in rect(0.25, 0, 1, 0.5)", "any on material \"a  #b; c\""]
            .map(Self::read)
            .to_vec()
    }
}
