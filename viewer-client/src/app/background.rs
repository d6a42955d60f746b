//! Work that takes longer than a frame may, each task on a thread of its own that is joined.

use std::thread::JoinHandle;

use crate::imaging::Finding;
use crate::source::dump::PlayableDump;

/// Tasks that may be under way at the same time.
const MOST: usize = 4;

/// What a task brings back.
#[derive(Debug)]
pub enum TaskResult {
    /// It is done, says this.
    Done(String),
    /// Something about the image of the scene that was shown under the number `of`.
    Image {
        /// See [`crate::source::Shown::serial`].
        of: u64,
        /// What was found.
        finding: Finding,
    },
    /// A file of paths was read.
    Opened {
        /// Its name.
        name: String,
        /// What it holds.
        playable: Box<PlayableDump>,
    },
}

/// What went well, or why not and what to do.
pub type Outcome = Result<TaskResult, String>;

/// The tasks under way.
#[derive(Debug, Default)]
pub struct BackgroundTasks {
    threads: Vec<JoinHandle<Outcome>>,
}

impl BackgroundTasks {
    /// Begins a task; the answer tells why it cannot begin now.
    pub fn start(&mut self, work: impl FnOnce() -> Outcome + Send + 'static) -> Result<(), String> {
        if self.threads.len() >= MOST {
            return Err("too many tasks are running; try again in a moment".to_owned());
        }
        let thread = std::thread::Builder::new().name("background".to_owned()).spawn(work);
        self.threads.push(thread.map_err(|error| format!("cannot start a thread: {error}"))?);
        Ok(())
    }

    /// True while one is under way.
    pub fn is_busy(&self) -> bool {
        !self.threads.is_empty()
    }

    /// What those that have ended brought back.
    pub fn finished(&mut self) -> Vec<Outcome> {
        let ended = self.threads.extract_if(.., |thread| thread.is_finished());
        ended.map(join).collect()
    }
}

impl Drop for BackgroundTasks {
    fn drop(&mut self) {
        for outcome in self.threads.drain(..).map(join) {
            if let Err(problem) = outcome {
                tracing::error!("{problem}");
            }
        }
    }
}

fn join(thread: JoinHandle<Outcome>) -> Outcome {
    thread.join().unwrap_or_else(|_| Err("an unexpected error occurred".to_owned()))
}

#[cfg(test)]
mod tests {
    use std::sync::{Arc, Barrier};

    use super::*;

    #[test]
    fn tasks_come_back_and_are_bounded() {
        let mut tasks = BackgroundTasks::default();
        let gate = Arc::new(Barrier::new(MOST + 1));
        for i in 0..MOST {
            let gate = Arc::clone(&gate);
            let work = move || {
                gate.wait();
                Ok(TaskResult::Done(i.to_string()))
            };
            tasks.start(work).expect("there is room");
        }
        assert!(tasks.finished().is_empty(), "all wait");
        assert!(tasks.start(|| Err(String::new())).is_err(), "there is no more room");
        gate.wait();
        let mut outcomes = Vec::new();
        while tasks.is_busy() {
            outcomes.extend(tasks.finished());
            std::thread::yield_now();
        }
        assert_eq!(outcomes.len(), MOST, "all came back: {outcomes:?}");
    }
}
