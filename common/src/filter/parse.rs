//! The text of a filter.

use std::str::FromStr;

use glam::DVec3;
use winnow::stream::Stream as _;

use super::number::number;
use super::syntax::{
    Input, Parsed, accept, accept_word, deeper, expected, parse_all, peek_word, position, require,
    rest, skip_blanks, take_run, wrong,
};
use super::{
    Attribute, Comparison, Filter, FilterError, Leaf, LightPathExpression, Name, Named, Place,
    VertexClass, VertexTest, Volume,
};

/// A filter's text is no longer than this.
pub const MAX_FILTER_BYTES: usize = 4096;

const CONDITION: &str = "a condition such as `any in sphere(0, 1, 0, 0.5)`, `lpe \"CS+DL\"`, \
                         `edges >= 4` or `strategy == lens`";
const VERTEX: &str = "`in sphere(...)`, `in box(...)`, `on material \"...\"`, `is specular` or \
                      `through sphere(...)`";

impl FromStr for Filter {
    type Err = FilterError;

    fn from_str(text: &str) -> Result<Self, FilterError> {
        Self::parse(text)
    }
}

impl Filter {
    /// Parses a filter's text; a blank one wants every path.
    pub fn parse(text: &str) -> Result<Self, FilterError> {
        if text.len() > MAX_FILTER_BYTES {
            let message = format!("a filter has at most {MAX_FILTER_BYTES} bytes; shorten it");
            return Err(FilterError::new(MAX_FILTER_BYTES..text.len(), message));
        }
        if text.trim().is_empty() {
            return Ok(Self::default());
        }
        parse_all(text, either, "`and`, `or` or the end of the filter")
    }
}

/// Takes one of several spellings of an operator.
fn operator(input: &mut Input<'_>, word: &str, signs: [&str; 2]) -> bool {
    accept_word(input, word) || signs.iter().any(|sign| accept(input, sign))
}

const OR: (&str, [&str; 2]) = ("or", ["||", "|"]);
const AND: (&str, [&str; 2]) = ("and", ["&&", "&"]);

/// One part, or several with an operator between them.
fn joined<T>(
    input: &mut Input<'_>,
    part: impl Fn(&mut Input<'_>) -> Parsed<T>,
    (word, signs): (&str, [&str; 2]),
    join: impl Fn(Vec<T>) -> T,
) -> Parsed<T> {
    let mut parts = vec![part(input)?];
    while operator(input, word, signs) {
        parts.push(part(input)?);
    }
    Ok(if parts.len() == 1 { parts.remove(0) } else { join(parts) })
}

fn either(input: &mut Input<'_>) -> Parsed<Filter> {
    joined(input, both, OR, Filter::Or)
}

fn both(input: &mut Input<'_>) -> Parsed<Filter> {
    joined(input, negation, AND, Filter::And)
}

fn negation(input: &mut Input<'_>) -> Parsed<Filter> {
    if accept_word(input, "not") || accept(input, "!") {
        return Ok(Filter::Not(Box::new(deeper(input, negation)?)));
    }
    if accept(input, "(") {
        let filter = deeper(input, either)?;
        require(input, ")", "`and`, `or`, or `)` to close the parenthesis")?;
        return Ok(filter);
    }
    condition(input)
}

fn condition(input: &mut Input<'_>) -> Parsed<Filter> {
    let word = peek_word(input);
    if let Some(&(place, _)) = Place::NAMES.iter().find(|(_, name)| *name == word) {
        input.next_slice(word.len());
        return located(input, place).map(Filter::Leaf);
    }
    if let Some(attribute) = Attribute::named(word) {
        input.next_slice(word.len());
        return comparison(input, attribute).map(Filter::Leaf);
    }
    let read: fn(&mut Input<'_>) -> Parsed<Filter> = match word {
        "true" => |_| Ok(Filter::Constant(true)),
        "false" => |_| Ok(Filter::Constant(false)),
        "lpe" => light_path,
        "film" => film,
        "strategy" => strategy,
        _ => return Err(expected(input, CONDITION)),
    };
    input.next_slice(word.len());
    read(input)
}

/// What follows `start`, `end`, `any` or `all`.
fn located(input: &mut Input<'_>, place: Place) -> Parsed<Leaf> {
    if accept_word(input, "through") {
        return Ok(Leaf::Segment { place, volume: volume(input)? });
    }
    Ok(Leaf::Vertex { place, test: vertex_negation(input)? })
}

fn vertex_either(input: &mut Input<'_>) -> Parsed<VertexTest> {
    joined(input, vertex_both, OR, VertexTest::Or)
}

fn vertex_both(input: &mut Input<'_>) -> Parsed<VertexTest> {
    joined(input, vertex_negation, AND, VertexTest::And)
}

fn vertex_negation(input: &mut Input<'_>) -> Parsed<VertexTest> {
    if accept_word(input, "not") || accept(input, "!") {
        return Ok(VertexTest::Not(Box::new(deeper(input, vertex_negation)?)));
    }
    if accept(input, "(") {
        let test = deeper(input, vertex_either)?;
        require(input, ")", "`and`, `or`, or `)` to close the parenthesis")?;
        return Ok(test);
    }
    if accept_word(input, "in") {
        return volume(input).map(VertexTest::Inside);
    }
    if accept_word(input, "on") {
        let kind = one_of(input, &Named::NAMES, "`object`, `material` or `light`")?;
        return Ok(VertexTest::On(kind, name(input)?));
    }
    if accept_word(input, "is") {
        let what = "`diffuse`, `glossy`, `specular`, `reflect`, `refract`, `light` or `camera`";
        return one_of(input, &VertexClass::NAMES, what).map(VertexTest::Is);
    }
    Err(expected(input, VERTEX))
}

/// One of the words of a table.
fn one_of<T: Copy>(input: &mut Input<'_>, names: &[(T, &str)], what: &str) -> Parsed<T> {
    let word = peek_word(input);
    match names.iter().find(|(_, name)| *name == word) {
        Some(&(value, _)) => {
            input.next_slice(word.len());
            Ok(value)
        }
        None => Err(expected(input, what)),
    }
}

fn volume(input: &mut Input<'_>) -> Parsed<Volume> {
    skip_blanks(input);
    let start = position(input);
    let volume = if accept_word(input, "sphere") {
        let [x, y, z, radius] = numbers(input, "`sphere(x, y, z, radius)`")?;
        Volume::Sphere { centre: DVec3::new(x, y, z), radius }
    } else if accept_word(input, "box") {
        let [x0, y0, z0, x1, y1, z1] = numbers(input, "`box(x0, y0, z0, x1, y1, z1)`")?;
        Volume::Box { min: DVec3::new(x0, y0, z0), max: DVec3::new(x1, y1, z1) }
    } else {
        let what = "`sphere(x, y, z, radius)` or `box(x0, y0, z0, x1, y1, z1)`";
        return Err(expected(input, what));
    };
    match volume.complaint() {
        Some(complaint) => wrong(start, input, complaint),
        None => Ok(volume),
    }
}

/// `N` numbers in parentheses, separated by commas.
fn numbers<const N: usize>(input: &mut Input<'_>, form: &str) -> Parsed<[f64; N]> {
    let mut values = [0.0; N];
    require(input, "(", &format!("`(` as in {form}"))?;
    for (i, value) in values.iter_mut().enumerate() {
        if i > 0 {
            require(input, ",", &format!("`,` and another number as in {form}"))?;
        }
        *value = number(input, &format!("a number as in {form}"))?;
    }
    require(input, ")", &format!("`)` as in {form}"))?;
    Ok(values)
}

fn light_path(input: &mut Input<'_>) -> Parsed<Filter> {
    skip_blanks(input);
    let start = position(input) + 1;
    let text = quoted(input, "a light path expression in quotes, such as `lpe \"CS+DL\"`")?;
    match LightPathExpression::parse(&text) {
        Ok(expression) => Ok(Filter::Leaf(Leaf::LightPath(expression.moved(start)))),
        Err(error) => Err(winnow::error::ErrMode::Cut(error.shifted(start))),
    }
}

fn film(input: &mut Input<'_>) -> Parsed<Filter> {
    const FORM: &str = "`film in rect(u0, v0, u1, v1)`";
    if !accept_word(input, "in") || !accept_word(input, "rect") {
        return Err(expected(input, &format!("a rectangle as in {FORM}")));
    }
    let start = position(input);
    let [u0, v0, u1, v1] = numbers(input, FORM)?;
    if !(u0 <= u1 && v0 <= v1) {
        let message = "a rectangle is written left, top, right, bottom; film points lie in 0 to 1";
        return wrong(start, input, message);
    }
    Ok(Filter::Leaf(Leaf::Film { min: [u0, v0], max: [u1, v1] }))
}

fn comparison(input: &mut Input<'_>, attribute: Attribute) -> Parsed<Leaf> {
    if accept_word(input, "in") {
        skip_blanks(input);
        let start = position(input);
        let least = number(input, "a range such as `3..6`")?;
        require(input, "..", "`..` and the range's largest value, as in `3..6`")?;
        let most = number(input, "the range's largest value, as in `3..6`")?;
        if least > most {
            return wrong(start, input, "the range is empty; write the smaller number first");
        }
        return Ok(Leaf::Range { attribute, least, most });
    }
    let found = Comparison::SIGNS.iter().find(|(_, sign)| accept(input, sign));
    let comparison = match found {
        Some(&(comparison, _)) => comparison,
        None if accept(input, "=") => Comparison::Equal,
        None => return Err(expected(input, "`==`, `!=`, `<`, `<=`, `>`, `>=` or `in`")),
    };
    let value = number(input, "a number to compare with")?;
    Ok(Leaf::Number { attribute, comparison, value })
}

fn strategy(input: &mut Input<'_>) -> Parsed<Filter> {
    if accept(input, "!=") {
        let leaf = Leaf::Strategy(vec![name(input)?]);
        return Ok(Filter::Not(Box::new(Filter::Leaf(leaf))));
    }
    if accept(input, "==") || accept(input, "=") {
        return Ok(Filter::Leaf(Leaf::Strategy(vec![name(input)?])));
    }
    const FORM: &str = "`strategy == lens` or `strategy in (lens, caustic)`";
    if !accept_word(input, "in") {
        return Err(expected(input, FORM));
    }
    require(input, "(", FORM)?;
    let mut names = vec![name(input)?];
    while accept(input, ",") {
        names.push(name(input)?);
    }
    require(input, ")", "`,` and another strategy, or `)`")?;
    Ok(Filter::Leaf(Leaf::Strategy(names)))
}

/// A name, in quotes or as a bare word.
fn name(input: &mut Input<'_>) -> Parsed<Name> {
    skip_blanks(input);
    let offset = position(input);
    let word = take_run(input, |c| c.is_alphanumeric() || matches!(c, '_' | '-'));
    if !word.is_empty() {
        return Ok(Name { text: word.to_owned(), offset });
    }
    Ok(Name { text: quoted(input, "a name such as `lens` or `\"blue wall\"`")?, offset })
}

/// A text in double quotes, in which `\"` and `\\` stand for the second sign.
fn quoted(input: &mut Input<'_>, what: &str) -> Parsed<String> {
    require(input, "\"", what)?;
    let start = position(input) - 1;
    let mut text = String::new();
    let mut signs = rest(input).char_indices();
    while let Some((i, sign)) = signs.next() {
        match sign {
            '"' => {
                input.next_slice(i + 1);
                return Ok(text);
            }
            '\\' => text.extend(signs.next().map(|(_, escaped)| escaped)),
            _ => text.push(sign),
        }
    }
    let message = "this quote is never closed; put another `\"` at its end";
    wrong(start, input, message)
}
