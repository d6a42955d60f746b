//! What may come next in the text of a filter.

use std::ops::Range;

use common::{Attribute, Name, Named, Place, VertexClass};

/// The names that a scene has.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(in crate::panel) struct Vocabulary {
    pub(in crate::panel) objects: Vec<String>,
    pub(in crate::panel) materials: Vec<String>,
    pub(in crate::panel) lights: Vec<String>,
    pub(in crate::panel) strategies: Vec<String>,
}

/// What may stand in the place of a part of the text.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Completion {
    /// The bytes that are replaced: what of a word is there already.
    pub(super) range: Range<usize>,
    pub(super) choices: Vec<Choice>,
}

/// A word that may come next.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Choice {
    pub(super) text: String,
    pub(super) meaning: &'static str,
}

/// What the grammar expects.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Expected {
    Condition,
    /// What follows a place.
    Test,
    /// A part of what stands in parentheses after a place.
    InnerTest,
    Operator,
    Region,
    Kind,
    Name(Named),
    Class,
    Comparison,
    Value,
    FilmIn,
    Rectangle,
    StrategyIs,
    Strategy,
    Strategies,
    Expression,
    /// Numbers in parentheses.
    Numbers,
}

/// What may come at `cursor`, a number of bytes.
pub(super) fn complete(text: &str, cursor: usize, scene: &Vocabulary) -> Completion {
    let before = &text[..text.floor_char_boundary(cursor.min(text.len()))];
    let (tokens, open) = tokens(before);
    let expected = expected(&tokens);
    if let Some(start) = open {
        let part = &before[start + 1..];
        let choices = match expected {
            Expected::Expression => return expression(before, start + 1, scene),
            _ => names(expected, scene),
        };
        return fitting(start..before.len(), part, choices);
    }
    let belongs = |c: char| c.is_alphanumeric() || c == '_' || c == '-';
    let start = before.rfind(|c| !belongs(c)).map_or(0, |i| i + 1);
    let start = before.ceil_char_boundary(start);
    let part = &before[start..];
    // The word under the cursor is still being written.
    let done = if part.is_empty() { tokens.as_slice() } else { &tokens[..tokens.len() - 1] };
    let expected = self::expected(done);
    let choices = match expected {
        Expected::Strategies if done.last().is_some_and(|token| !matches!(*token, "(" | ",")) => {
            vec![choice(")", "that is all"), choice(",", "and another one")]
        }
        Expected::Name(_) | Expected::Strategy | Expected::Strategies => names(expected, scene),
        Expected::Operator if !is_open(done) => {
            let mut all = words(expected);
            all.retain(|choice| choice.text != ")");
            all
        }
        other => words(other),
    };
    fitting(start..before.len(), part, choices)
}

/// Whether a parenthesis waits to be closed.
fn is_open(tokens: &[&str]) -> bool {
    let count = |sign: &str| tokens.iter().filter(|token| **token == sign).count();
    count("(") > count(")")
}

/// The choices that go on with `part`, unless it is all of the only one.
fn fitting(range: Range<usize>, part: &str, mut choices: Vec<Choice>) -> Completion {
    let part = part.to_lowercase();
    choices.retain(|choice| {
        choice.text.trim_start_matches('"').to_lowercase().starts_with(&part) && choice.text != part
    });
    Completion { range, choices }
}

/// The tokens of a text and, where it ends within quotes, where those begin.
fn tokens(text: &str) -> (Vec<&str>, Option<usize>) {
    let mut tokens = Vec::new();
    let mut rest = text;
    loop {
        rest = rest.trim_start();
        let Some(first) = rest.chars().next() else { return (tokens, None) };
        let length = if first == '"' {
            match closing_quote(rest) {
                Some(length) => length,
                None => return (tokens, Some(text.len() - rest.len())),
            }
        } else {
            let belongs = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.' | '-');
            let word = rest.find(|c| !belongs(c)).unwrap_or(rest.len());
            word.max(first.len_utf8())
        };
        tokens.push(&rest[..length]);
        rest = &rest[length..];
    }
}

/// The length of a text in quotes, which `text` begins with, quotes included.
fn closing_quote(text: &str) -> Option<usize> {
    let mut escaped = false;
    for (i, c) in text.char_indices().skip(1) {
        match c {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            '"' => return Some(i + 1),
            _ => {}
        }
    }
    None
}

/// What the grammar expects after these tokens. A text that is wrong before its end leads to
/// something plausible, since it is only offered.
fn expected(tokens: &[&str]) -> Expected {
    use Expected as E;
    let mut state = E::Condition;
    // For each open parenthesis, whether it holds parts of a test at one vertex.
    let mut open = Vec::new();
    for &token in tokens {
        state = match (state, token) {
            (E::Condition, "(") => {
                open.push(false);
                E::Condition
            }
            (E::Test | E::InnerTest, "(") => {
                open.push(true);
                E::InnerTest
            }
            (E::Condition, "not" | "!") => E::Condition,
            (E::Test | E::InnerTest, "not" | "!") => state,
            (E::Condition, word) => after_condition_word(word),
            (E::Test | E::InnerTest, "in" | "through") => E::Region,
            (E::Test | E::InnerTest, "on") => E::Kind,
            (E::Test | E::InnerTest, "is") => E::Class,
            (E::Operator, ")") => {
                open.pop();
                E::Operator
            }
            (E::Operator, _) if open.last() == Some(&true) => E::InnerTest,
            (E::Operator, _) => E::Condition,
            (E::Numbers | E::Strategies, ")") => E::Operator,
            (E::Region | E::Rectangle | E::Numbers, _) => E::Numbers,
            (E::Kind, "object") => E::Name(Named::Object),
            (E::Kind, "light") => E::Name(Named::Light),
            (E::Kind, _) => E::Name(Named::Material),
            // A sign of two letters may come as two tokens.
            (E::Comparison, _) | (E::Value, "=") => E::Value,
            (E::FilmIn, _) => E::Rectangle,
            (E::StrategyIs, "in") | (E::Strategies, _) => E::Strategies,
            (E::StrategyIs, _) | (E::Strategy, "=") => E::Strategy,
            (
                E::Test
                | E::InnerTest
                | E::Name(_)
                | E::Class
                | E::Value
                | E::Strategy
                | E::Expression,
                _,
            ) => E::Operator,
        };
    }
    state
}

fn after_condition_word(word: &str) -> Expected {
    if Attribute::named(word).is_some() {
        return Expected::Comparison;
    }
    match word {
        "lpe" => Expected::Expression,
        "film" => Expected::FilmIn,
        "strategy" => Expected::StrategyIs,
        word if Place::ALL.iter().any(|place| place.to_string() == word) => Expected::Test,
        _ => Expected::Operator,
    }
}

fn choice(text: impl Into<String>, meaning: &'static str) -> Choice {
    Choice { text: text.into(), meaning }
}

/// The words of the grammar.
fn words(expected: Expected) -> Vec<Choice> {
    let list = |pairs: &[(&'static str, &'static str)]| -> Vec<Choice> {
        pairs.iter().map(|&(text, meaning)| choice(text, meaning)).collect()
    };
    let tests = [
        ("in", "lies in a sphere or box"),
        ("on", "lies on an object, a material or a light"),
        ("is", "scatters so, or is an end"),
        ("not", "the opposite"),
    ];
    match expected {
        Expected::Condition => {
            let mut all = list(&[
                ("any", "at least one vertex"),
                ("start", "the vertex at the light"),
                ("end", "the vertex at the camera"),
                ("all", "every vertex between the ends"),
                ("lpe", "a light path expression"),
                ("film", "where on the film"),
                ("strategy", "what made the path"),
                ("not", "the opposite"),
            ]);
            all.extend(Attribute::ALL.map(|a| choice(a.name(), "a number")));
            all
        }
        Expected::Test => {
            let mut all = list(&tests);
            all.insert(1, choice("through", "a segment passes a sphere or box"));
            all
        }
        Expected::InnerTest => list(&tests),
        Expected::Operator => list(&[("and", "both"), ("or", "either"), (")", "closes")]),
        Expected::Region => {
            list(&[("sphere(", "x, y, z, radius"), ("box(", "x0, y0, z0, x1, y1, z1")])
        }
        Expected::Kind => list(&[
            ("material", "by its name"),
            ("object", "by its name"),
            ("light", "by its name"),
        ]),
        Expected::Class => VertexClass::ALL.iter().map(|c| choice(c.name(), "a vertex")).collect(),
        Expected::Comparison => list(&[
            (">=", "at least"),
            ("<=", "at most"),
            ("==", "exactly"),
            (">", "more than"),
            ("<", "less than"),
            ("!=", "anything but"),
            ("in", "LEAST..MOST"),
        ]),
        Expected::FilmIn => list(&[("in rect(", "left, top, right, bottom; 0 to 1")]),
        Expected::Rectangle => list(&[("rect(", "left, top, right, bottom; 0 to 1")]),
        Expected::StrategyIs => {
            list(&[("==", "this one"), ("!=", "another one"), ("in (", "one of several")])
        }
        Expected::Expression => list(&[("\"", "from the camera C or the light L")]),
        Expected::Name(_)
        | Expected::Strategy
        | Expected::Strategies
        | Expected::Value
        | Expected::Numbers => Vec::new(),
    }
}

/// The names that fit, in quotes.
fn names(expected: Expected, scene: &Vocabulary) -> Vec<Choice> {
    let (names, meaning) = match expected {
        Expected::Name(Named::Object) => (&scene.objects, "an object"),
        Expected::Name(Named::Light) => (&scene.lights, "a light"),
        Expected::Name(Named::Material) => (&scene.materials, "a material"),
        Expected::Strategy | Expected::Strategies => (&scene.strategies, "a strategy"),
        _ => return Vec::new(),
    };
    let quoted = |name: &String| choice(Name::from(name.as_str()).to_string(), meaning);
    names.iter().map(quoted).collect()
}

/// What may come in a light path expression that begins at byte `start`.
fn expression(before: &str, start: usize, scene: &Vocabulary) -> Completion {
    let text = &before[start..];
    let end = before.len();
    if text.matches('\'').count() % 2 == 1 {
        let label = before.rfind('\'').map_or(end, |i| i + 1);
        let names = scene.materials.iter().filter(|name| !name.contains('\''));
        let choices = names.map(|name| choice(format!("{name}'"), "anything on it")).collect();
        return fitting(label..end, &before[label..], choices);
    }
    let list = |pairs: &[(&'static str, &'static str)]| -> Vec<Choice> {
        pairs.iter().map(|&(text, meaning)| choice(text, meaning)).collect()
    };
    let opened = text.rfind('<') > text.rfind('>');
    let choices = if opened {
        list(&[
            ("R", "a reflection"),
            ("T", "a refraction"),
            ("D", "diffuse"),
            ("G", "glossy"),
            ("S", "mirror or clear glass"),
            ("'", "on a material"),
            (">", "closes: all of this at one vertex"),
        ])
    } else if text.is_empty() {
        list(&[("C", "the camera: read from there"), ("L", "a light: read from there")])
    } else {
        list(&[
            ("D", "diffuse"),
            ("G", "glossy"),
            ("S", "mirror or clear glass"),
            ("<", "all of this at one vertex, as in <RD>"),
            (".*", "anything, any number of times"),
            ("+", "once or more"),
            ("'", "on a material"),
            ("L", "a light"),
            ("C", "the camera"),
            ("\"", "closes"),
        ])
    };
    Completion { range: end..end, choices }
}

#[cfg(test)]
mod tests {
    use common::Filter;

    use super::*;

    fn scene() -> Vocabulary {
        let names = |list: &[&str]| list.iter().map(|&name| name.to_owned()).collect();
        Vocabulary {
            objects: names(&["table", "tea pot"]),
            materials: names(&["glass", "wall"]),
            lights: names(&["lamp"]),
            strategies: names(&["lens", "caustic"]),
        }
    }

    /// What is offered at the end of a text.
    fn offered(text: &str) -> Vec<String> {
        let found = complete(text, text.len(), &scene()).choices;
        found.into_iter().map(|choice| choice.text).collect()
    }

    #[test]
    fn what_is_offered_fits_the_place() {
        for (text, first, count) in [
            ("any on m", "material", 1),
            ("any on material ", "\"glass\"", 2),
            ("any on material \"w", "\"wall\"", 1),
            ("start on light ", "\"lamp\"", 1),
            ("any on object te", "\"tea pot\"", 1),
            ("any is re", "reflect", 2),
            ("any (in sphere(0, 1, 0, 1) and i", "in", 2),
            ("edges ", ">=", 7),
            ("edges >= 3 a", "and", 1),
            ("film ", "in rect(", 1),
            ("strategy == ", "\"lens\"", 2),
            ("strategy in (\"lens\", c", "\"caustic\"", 1),
            ("not lu", "luminance", 1),
            ("lpe \"C.*<T", "R", 7),
            ("lpe \"C<RS'", "glass'", 2),
            ("lpe \"C<RS'w", "wall'", 1),
            ("lpe \"", "C", 2),
        ] {
            let offered = offered(text);
            assert_eq!(offered.first().map(String::as_str), Some(first), "`{text}`: {offered:?}");
            assert_eq!(offered.len(), count, "`{text}`: {offered:?}");
        }
        for text in ["edges >= ", "any in sphere(0, ", "any on material \"glas\" x", "edges == 3"] {
            assert_eq!(offered(text), Vec::<String>::new(), "`{text}`");
        }
    }

    /// The text with an offer taken, and numbers where it wants some.
    fn taken(text: &str, range: &Range<usize>, choice: &str) -> String {
        let numbers = match choice {
            "sphere(" => "0, 0, 0, 1)",
            "box(" => "0, 0, 0, 1, 1, 1)",
            "in rect(" => "0, 0, 1, 1)",
            ">=" | "<=" | "==" | ">" if !text.contains("strategy") => " 3",
            _ => "",
        };
        let blank = if text.contains("lpe \"") || choice == "\"" { "" } else { " " };
        format!("{}{choice}{numbers}{blank}", &text[..range.start])
    }

    /// Whoever takes an offer at every step, of the first few ways, ends up with a filter.
    #[test]
    fn offers_lead_to_filters() {
        let mut texts = vec![String::new()];
        let mut whole = 0;
        for _ in 0..7 {
            let mut longer = Vec::new();
            for text in &texts {
                let Completion { range, choices } = complete(text, text.len(), &scene());
                for Choice { text: choice, .. } in choices.iter().take(4) {
                    let next = taken(text, &range, choice);
                    whole += usize::from(Filter::parse(&next).is_ok());
                    longer.push(next);
                }
            }
            longer.truncate(300);
            texts = longer;
        }
        assert!(whole > 100, "{whole} of the texts are filters");
    }

    #[test]
    fn nothing_that_is_typed_breaks_it() {
        let text = "any (in sphere(0, \u{e9}\u{4e2d}\" lpe \"C<R'\u{4e2d} strategy in (";
        for cursor in 0..=text.len() + 2 {
            let Completion { range, .. } = complete(text, cursor, &scene());
            assert!(text.get(range.clone()).is_some(), "{range:?} at {cursor}");
        }
    }
}
