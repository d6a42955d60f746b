//! Undo and redo: states before and after what the user did.

/// States kept; the oldest go first.
const MOST: usize = 200;
/// Seconds in which more of the same counts as one step: a slider that is dragged.
const PAUSE: f64 = 0.8;

/// The states that the user can go back and forth to.
#[derive(Clone, Debug)]
pub struct History<T> {
    past: Vec<T>,
    future: Vec<T>,
    /// What changed the state last, and when in seconds.
    last: Option<(String, f64)>,
}

impl<T> Default for History<T> {
    fn default() -> Self {
        Self { past: Vec::new(), future: Vec::new(), last: None }
    }
}

impl<T> History<T> {
    /// Remembers that the state was `before` until `what` changed it at `time`.
    pub fn record(&mut self, before: T, what: &str, time: f64) {
        let same = self.last.as_ref().is_some_and(|(w, t)| w == what && time - t < PAUSE);
        self.last = Some((what.to_owned(), time));
        self.future.clear();
        if same {
            return;
        }
        if self.past.len() == MOST {
            self.past.remove(0);
        }
        self.past.push(before);
    }

    /// The state before `now`, if there is one.
    pub fn undo(&mut self, now: T) -> Option<T> {
        let state = self.past.pop()?;
        self.future.push(now);
        self.last = None;
        Some(state)
    }

    /// The state after `now`, if there is one.
    pub fn redo(&mut self, now: T) -> Option<T> {
        let state = self.future.pop()?;
        self.past.push(now);
        self.last = None;
        Some(state)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_go_back_and_forth() {
        let mut history = History::default();
        history.record(1, "width", 0.0);
        history.record(2, "width", 0.5);
        history.record(3, "colour", 0.6);
        assert_eq!(history.undo(4), Some(3), "the colour");
        assert_eq!(history.undo(3), Some(1), "the drag is one step");
        assert_eq!(history.undo(1), None, "the beginning");
        assert_eq!(history.redo(1), Some(3), "forth");
        history.record(3, "colour", 0.7);
        assert_eq!(history.redo(5), None, "something new forgets what was undone");
        for i in 0..1000 {
            history.record(i, &i.to_string(), 0.0);
        }
        assert_eq!(history.past.len(), MOST, "bounded");
    }
}
