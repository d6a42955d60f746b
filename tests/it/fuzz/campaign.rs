//! The search: which input is next, what is wrong with an answer, and what is kept of it.

use std::any::Any;
use std::collections::BTreeSet;
use std::fs::File;
use std::io::{Seek as _, Write as _};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use cpu_time::ThreadTime;
use rand_core::SeedableRng as _;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::mutate::{Dice, Mutator};

/// No input is longer: as much as the daemon reads of one message.
const LONGEST: usize = 64 << 10;
/// Processor time that no input may take; usual are microseconds.
const MOST_TIME: Duration = Duration::from_secs(10);
/// Memory, in KiB, that no input may add to what the process ever held.
const MOST_MEMORY: u64 = 256 << 10;
/// Inputs that are kept as seeds because they were understood, or because they were not: no more of
/// each, or the search would drown in wrecks.
const MOST_KEPT: usize = 1024;

/// What a reader makes of an input, for people. Answers that differ in more than numbers and quoted
/// words are of different kinds.
pub(super) type Answer = Result<String, String>;

/// A reader under test.
pub(super) struct Target<'a> {
    /// Its name, which begins those of the files that it leaves.
    pub(super) name: &'a str,
    /// Inputs that it should understand.
    pub(super) seeds: Vec<Vec<u8>>,
    /// How inputs are changed.
    pub(super) mutator: Mutator<'a>,
    /// Inputs that are tried when nobody says for how long.
    pub(super) count: u64,
}

impl Target<'_> {
    /// Tries inputs until enough were tried, or one fails.
    pub(super) fn run(&self, mut read: impl FnMut(&[u8]) -> Answer) {
        if let Some(file) = std::env::var_os("LVIS_FUZZ_INPUT") {
            let input = std::fs::read(file).expect("the input can be read");
            let answer = read(&input);
            say(&format!("{}: {answer:?}", self.name));
            return;
        }
        let mut search = Search::new(self.name);
        for seed in &self.seeds {
            let answer = search.attempt(seed, &mut read);
            assert!(answer.is_ok(), "{}: a seed is not understood: {answer:?}", self.name);
        }
        let number = |name| std::env::var(name).ok()?.parse().ok();
        let lasts = number("LVIS_FUZZ_SECONDS").map(Duration::from_secs);
        let salt = number("LVIS_FUZZ_SEED").unwrap_or(0);
        let mut dice = Dice(Xoshiro256PlusPlus::seed_from_u64(salt));
        let (mut understood, mut refused) = (self.seeds.clone(), Vec::new());
        let began = Instant::now();
        let mut accepted = 0_u64;
        let mut tried = 0_u64;
        while lasts.map_or(tried < self.count, |lasts| began.elapsed() < lasts) {
            tried += 1;
            let wrecks = dice.below(4) == 0 && !refused.is_empty();
            let mut input = dice.choose(if wrecks { &refused } else { &understood }).clone();
            self.mutator.mutate(&mut input, &understood, &mut dice);
            while dice.below(3) == 0 {
                self.mutator.mutate(&mut input, &understood, &mut dice);
            }
            input.truncate(LONGEST);
            let answer = search.attempt(&input, &mut read);
            accepted += u64::from(answer.is_ok());
            let given = if answer.is_ok() { self.seeds.len() } else { 0 };
            let kept = if answer.is_ok() { &mut understood } else { &mut refused };
            if !search.is_new(&answer) {
                continue;
            }
            if kept.len() < MOST_KEPT {
                kept.push(input);
            } else {
                // The given seeds stay.
                let place = dice.below(kept.len()).max(given);
                kept[place] = input;
            }
        }
        let seconds = began.elapsed().as_secs_f64();
        let kinds = search.kinds.len();
        say(&format!(
            "{}: {tried} inputs in {seconds:.1} s, {accepted} understood, {kinds} kinds of answer",
            self.name
        ));
        // A search that is refused all the same way, or never, has found no way in.
        assert!(accepted > 0 && accepted < tried, "{accepted} of {tried} inputs were understood");
        assert!(kinds > self.seeds.len().min(4), "{kinds} kinds of answer are too few");
    }
}

/// What was found so far.
struct Search<'a> {
    name: &'a str,
    kinds: BTreeSet<String>,
    /// The input that is being tried: all that is left if the process aborts.
    current: File,
    place: PathBuf,
}

impl<'a> Search<'a> {
    fn new(name: &'a str) -> Self {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("fuzz");
        std::fs::create_dir_all(&folder).expect("a folder for inputs");
        let place = folder.join(name);
        let current = File::create(&place).expect("a file for the input");
        Self { name, kinds: BTreeSet::new(), current, place }
    }

    /// Tries an input, and ends the test where that went wrong.
    fn attempt(&mut self, input: &[u8], read: &mut impl FnMut(&[u8]) -> Answer) -> Answer {
        // Overwritten rather than replaced: file systems make replacing a file safe, which is slow.
        self.current.rewind().expect("the start");
        self.current.write_all(input).expect("the input can be kept");
        self.current.set_len(input.len() as u64).expect("the input can be kept");
        let (memory, clock) = (peak_memory(), ThreadTime::now());
        let caught = catch_unwind(AssertUnwindSafe(|| read(input)));
        let (took, grown) = (clock.elapsed(), peak_memory().saturating_sub(memory));
        let answer = match caught {
            Ok(answer) => answer,
            Err(panic) => self.fail(&format!("panicked: {}", words(&*panic))),
        };
        if took > MOST_TIME {
            self.fail(&format!("took {took:?} of processor time"));
        }
        if grown > MOST_MEMORY {
            self.fail(&format!("took {} MiB", grown >> 10));
        }
        answer
    }

    fn fail(&self, what: &str) -> ! {
        let failed = self.place.with_extension("failed");
        std::fs::copy(&self.place, &failed).expect("the input can be kept");
        panic!("{} {what}; try it alone with LVIS_FUZZ_INPUT={}", self.name, failed.display())
    }

    /// True for an answer of a kind that was not given before.
    fn is_new(&mut self, answer: &Answer) -> bool {
        let kind = match answer {
            Ok(text) => format!("+{}", kind_of(text)),
            Err(text) => kind_of(text),
        };
        self.kinds.insert(kind)
    }
}

/// An answer without its numbers and without what it quotes from the input.
fn kind_of(text: &str) -> String {
    let unquoted: String = text.split(['`', '"']).step_by(2).collect();
    unquoted.chars().filter(|c| !c.is_ascii_digit()).take(60).collect()
}

fn words(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("without a word")
}

/// The most memory that the process ever held, in KiB; 0 where the system does not tell.
fn peak_memory() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|line| line.trim().strip_suffix(" kB")?.parse().ok()).unwrap_or(0)
}

fn say(line: &str) {
    writeln!(std::io::stdout(), "{line}").expect("standard output");
}
