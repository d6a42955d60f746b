//! The `#` lines of an annotated file: one a step.

use super::Outcome;

/// What a `#` line says.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Annotation {
    /// The chain that begins here, for a seed.
    pub(super) chain: Option<u32>,
    pub(super) number: u64,
    pub(super) outcome: Outcome,
    pub(super) mutation: String,
    pub(super) pixel: Option<[f64; 2]>,
    pub(super) configuration: String,
}

/// Reads what follows the `#`; `None` for a comment that does not describe a step.
pub(super) fn parse(text: &str) -> Result<Option<Annotation>, String> {
    let (text, configuration) = match text.split_once("config=") {
        Some((before, after)) => (before, after.trim()),
        None => (text, ""),
    };
    let mut words = text.split_whitespace().peekable();
    let is_seed = words.next_if_eq(&"seed").is_some();
    if !is_seed && !words.peek().is_some_and(|word| word.starts_with("step=")) {
        return Ok(None);
    }
    let mut found = Found::default();
    for word in words {
        found.word(word)?;
    }
    let step = found.step.ok_or("`step=N` is missing")?;
    let a = |a: Option<f64>| a.ok_or("`a=A`, the acceptance probability, is missing");
    let outcome = match found.fate {
        _ if is_seed => Outcome::Seed,
        Some("accepted") => Outcome::Accepted(a(found.acceptance)?),
        Some("rejected") => Outcome::Rejected(a(found.acceptance)?),
        Some("failed") => Outcome::Failed,
        _ => return Err("a step is `accepted`, `rejected` or `failed`".to_owned()),
    };
    Ok(Some(Annotation {
        chain: if is_seed { Some(found.chain.unwrap_or(0)) } else { None },
        // The seed is the state before the first step, which Mitsuba calls 0, too.
        number: if is_seed { 0 } else { step.saturating_add(1) },
        outcome,
        mutation: found.mutation.to_owned(),
        pixel: found.pixel,
        configuration: configuration.to_owned(),
    }))
}

#[derive(Default)]
struct Found<'a> {
    chain: Option<u32>,
    step: Option<u64>,
    fate: Option<&'a str>,
    mutation: &'a str,
    acceptance: Option<f64>,
    pixel: Option<[f64; 2]>,
}

impl<'a> Found<'a> {
    fn word(&mut self, word: &'a str) -> Result<(), String> {
        let Some((key, value)) = word.split_once('=') else {
            self.fate = Some(word);
            return Ok(());
        };
        match key {
            "chain" => self.chain = Some(number(key, value)?),
            "step" => self.step = Some(number(key, value)?),
            "mut" => self.mutation = value,
            "a" => {
                let a: f64 = number(key, value)?;
                if !(0.0..=1.0).contains(&a) {
                    return Err(format!("`a={value}` is not a probability"));
                }
                self.acceptance = Some(a);
            }
            "pixel" => {
                let (x, y) = value.split_once(',').ok_or("`pixel=X,Y` needs two numbers")?;
                self.pixel = Some([number(key, x)?, number(key, y)?]);
            }
            // Ranges and lengths follow from the paths; what is not known is not needed.
            _ => {}
        }
        Ok(())
    }
}

fn number<T: std::str::FromStr>(key: &str, value: &str) -> Result<T, String> {
    value.parse().ok().ok_or_else(|| format!("`{key}={value}` should be a number"))
}
