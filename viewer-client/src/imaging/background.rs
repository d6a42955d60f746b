//! Work that takes longer than a frame may: files and other programs, each on a thread of its own.

use std::path::Path;
use std::thread::JoinHandle;

use crate::imaging::{FlipMap, Reference};

/// Errands that may be under way at the same time.
const MOST: usize = 4;

/// What an errand brings back.
#[derive(Clone, Debug, PartialEq)]
pub enum Errand {
    /// It is done, says this.
    Done(String),
    /// An image to compare with.
    Reference(Reference),
    /// How different the image looks from it.
    Flip(Result<FlipMap, String>),
}

impl Errand {
    /// A file is written; says where, since a name alone may lie in any folder.
    pub fn saved(file: &Path) -> Self {
        let place = std::path::absolute(file).unwrap_or_else(|_| file.to_owned());
        Self::Done(format!("Saved {}", place.display()))
    }
}

/// What went well, or why not and what to do.
pub type Outcome = Result<Errand, String>;

/// The errands under way.
#[derive(Debug, Default)]
pub struct Errands {
    threads: Vec<JoinHandle<Outcome>>,
}

impl Errands {
    /// Begins an errand; the answer tells why it cannot begin now.
    pub fn start(&mut self, work: impl FnOnce() -> Outcome + Send + 'static) -> Result<(), String> {
        if self.threads.len() >= MOST {
            return Err("too much is under way; try again in a moment".to_owned());
        }
        let thread = std::thread::Builder::new().name("errand".to_owned()).spawn(work);
        self.threads.push(thread.map_err(|error| format!("cannot start a thread: {error}"))?);
        Ok(())
    }

    /// True while one is under way.
    pub fn is_busy(&self) -> bool {
        !self.threads.is_empty()
    }

    /// What those that have ended brought back.
    pub fn take(&mut self) -> Vec<Outcome> {
        let ended = self.threads.extract_if(.., |thread| thread.is_finished());
        ended.map(join).collect()
    }
}

impl Drop for Errands {
    fn drop(&mut self) {
        for outcome in self.threads.drain(..).map(join) {
            if let Err(problem) = outcome {
                tracing::error!("{problem}");
            }
        }
    }
}

fn join(thread: JoinHandle<Outcome>) -> Outcome {
    thread.join().unwrap_or_else(|_| Err("this went wrong in an unforeseen way".to_owned()))
}

#[cfg(test)]
mod tests {
    use std::sync::{Arc, Barrier};

    use super::*;

    #[test]
    fn errands_come_back_and_are_bounded() {
        let mut errands = Errands::default();
        let gate = Arc::new(Barrier::new(MOST + 1));
        for i in 0..MOST {
            let gate = Arc::clone(&gate);
            let work = move || {
                gate.wait();
                Ok(Errand::Done(i.to_string()))
            };
            errands.start(work).expect("there is room");
        }
        assert!(errands.take().is_empty(), "all wait");
        assert!(errands.start(|| Err(String::new())).is_err(), "there is no more room");
        gate.wait();
        let mut outcomes = Vec::new();
        while errands.is_busy() {
            outcomes.extend(errands.take());
            std::thread::yield_now();
        }
        assert_eq!(outcomes.len(), MOST, "all came back: {outcomes:?}");
    }
}
