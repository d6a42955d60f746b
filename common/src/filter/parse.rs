//! The grammar of filters: trees of what describes itself, names and texts in quotes.

use super::condition::vertex::VertexTest;
use super::condition::{Form, Leaves, NumberPart};
use super::lpe;
use super::reader::Reader;
use super::word::{NameList, Stop, Walk, Word, in_word};
use super::{LightPathExpression, Name, Tree};

const NOT: Word = Word { text: "not", also: &["!"], meaning: "the opposite" };
const AND: Word = Word { text: "and", also: &["&&", "&"], meaning: "both" };
const OR: Word = Word { text: "or", also: &["||", "|"], meaning: "either" };
const CLOSE: Word = Word::new(")", "closes");
const COMMA: Word = Word::new(",", "and another one");

impl Reader<'_> {
    /// A tree: its loosest operator first.
    pub(super) fn tree<T: Leaves>(&mut self) -> Result<Tree<T>, Stop> {
        self.joined(&OR, Tree::Or, |reader| reader.joined(&AND, Tree::And, Self::part))
    }

    /// One part, or several with an operator between them.
    fn joined<T>(
        &mut self,
        operator: &Word,
        join: impl Fn(Vec<Tree<T>>) -> Tree<T>,
        read: impl Fn(&mut Self) -> Result<Tree<T>, Stop>,
    ) -> Result<Tree<T>, Stop> {
        let mut parts = vec![read(self)?];
        while self.accept_word(operator) {
            parts.push(read(self)?);
        }
        self.expect(format!("`{}`", operator.text));
        Ok(if parts.len() == 1 { parts.remove(0) } else { join(parts) })
    }

    /// A leaf, a negation or a group.
    fn part<T: Leaves>(&mut self) -> Result<Tree<T>, Stop> {
        self.skip_blanks();
        let start = self.position();
        for (text, value) in [("true", true), ("false", false)] {
            if self.accept(text) {
                return Ok(Tree::Constant(value));
            }
        }
        for (mut leaf, example) in T::kinds() {
            if self.attempt(example, |reader| leaf.describe(reader))? {
                return Ok(Tree::Leaf(leaf));
            }
        }
        if self.accept_word(&NOT) {
            let part = self.deeper(Self::part)?;
            return Ok(Tree::Not(Box::new(part)));
        }
        if self.accept("(") {
            return self.group();
        }
        for what in ["`not`", "`(`"] {
            self.expect(what.to_owned());
        }
        if let Some(summary) = T::summary() {
            self.summarise(start, summary);
        }
        Err(Stop)
    }

    /// What follows an opening parenthesis.
    fn group<T: Leaves>(&mut self) -> Result<Tree<T>, Stop> {
        let tree = self.deeper(Self::tree)?;
        if self.accept_word(&CLOSE) {
            return Ok(tree);
        }
        self.expect("`)`".to_owned());
        Err(Stop)
    }

    /// A name, bare or in quotes.
    fn any_name(&mut self, list: NameList) -> Result<Name, Stop> {
        self.skip_blanks();
        self.offer_names(list, |name| Name::from(name).to_string());
        let offset = self.position();
        let word = self.run(|c| in_word(c) || c == '-');
        if !word.is_empty() {
            return Ok(Name { text: word.to_owned(), offset });
        }
        if !self.rest().starts_with('"') {
            let kind = list.kind();
            self.expect(format!("the name of a {kind}, such as `name` or `\"a name\"`"));
            return Err(Stop);
        }
        let quoted = self.quoted()?;
        if quoted.is_closed { Ok(Name { text: quoted.text, offset }) } else { self.unfinished() }
    }
}

impl Form for Reader<'_> {
    fn word(&mut self, word: &'static Word) -> Walk {
        if self.accept_word(word) {
            return Ok(());
        }
        self.expect(format!("`{}`", word.text));
        Err(Stop)
    }

    fn sign(&mut self, sign: &'static str, meaning: &'static str) -> Walk {
        self.offer_sign(sign, meaning);
        let sign = sign.trim();
        if self.accept(sign) {
            return Ok(());
        }
        self.expect(format!("`{sign}`"));
        Err(Stop)
    }

    fn choice(&mut self, _: &'static str, words: &[Word], chosen: &mut usize) -> Walk {
        self.offer_words(words);
        let spellings = |word: &Word| std::iter::once(word.text).chain(word.also.iter().copied());
        let coming = words.iter().enumerate().flat_map(|(number, word)| {
            let coming = spellings(word).filter(|text| self.comes(text));
            coming.map(move |text| (text, number)).collect::<Vec<_>>()
        });
        // Of `>` and `>=` the longer one is meant.
        if let Some((text, number)) = coming.max_by_key(|(text, _)| text.len()) {
            self.accept(text);
            *chosen = number;
            return Ok(());
        }
        for word in words {
            self.expect(format!("`{}`", word.text));
        }
        Err(Stop)
    }

    fn number(&mut self, about: &NumberPart, value: &mut f64) -> Walk {
        self.skip_blanks();
        self.leave_open();
        let start = self.position();
        let text = self.bytes(number_length);
        if text.is_empty() {
            self.expect(format!("a number ({})", about.about));
            return Err(Stop);
        }
        match text.parse::<f64>() {
            Ok(number) if number.is_finite() => {
                *value = number;
                Ok(())
            }
            _ => self.wrong(start, "this number is too large; write one of at most 1e308"),
        }
    }

    fn name(&mut self, list: NameList, name: &mut Name) -> Walk {
        *name = self.any_name(list)?;
        Ok(())
    }

    fn names(&mut self, list: NameList, names: &mut Vec<Name>) -> Walk {
        names.clear();
        loop {
            names.push(self.any_name(list)?);
            if !self.accept_word(&COMMA) {
                self.expect("`,`".to_owned());
                return Ok(());
            }
        }
    }

    fn expression(&mut self, expression: &mut LightPathExpression) -> Walk {
        self.offer_sign(" \"", "from the camera C or the light L");
        if !self.rest().starts_with('"') {
            self.expect("an expression in quotes".to_owned());
            return Err(Stop);
        }
        let quoted = self.quoted()?;
        if !quoted.is_closed {
            self.offer_within(&quoted, lpe::offers);
            return self.unfinished();
        }
        match LightPathExpression::parse(&quoted.text) {
            Ok(read) => {
                *expression = read.placed(&quoted);
                Ok(())
            }
            Err(mut error) => {
                error.span = quoted.outer_range(error.span);
                self.fail(error)
            }
        }
    }

    fn vertex(&mut self, test: &mut VertexTest) -> Walk {
        *test = self.part()?;
        Ok(())
    }

    fn mark(&self) -> usize {
        self.next_place()
    }

    fn check(&mut self, since: usize, complaint: Option<&'static str>) -> Walk {
        match complaint {
            Some(complaint) => self.wrong(since, complaint),
            None => Ok(()),
        }
    }
}

/// How many bytes at the beginning of `text` are a number as people write them.
fn number_length(text: &str) -> usize {
    let digits = |from: usize| text[from..].bytes().take_while(u8::is_ascii_digit).count();
    let signed = |from: usize| from + usize::from(text[from..].starts_with(['+', '-']));
    let start = signed(0);
    let whole = digits(start);
    let mut end = start + whole;
    if text[end..].starts_with('.') {
        let fraction = digits(end + 1);
        end += if fraction > 0 { 1 + fraction } else { 0 };
    }
    if end == start {
        return 0;
    }
    if text[end..].starts_with(['e', 'E']) {
        let first = signed(end + 1);
        let exponent = digits(first);
        end = if exponent > 0 { first + exponent } else { end };
    }
    end
}
