//! Which paths are shown.

use common::Filter;

use crate::command::{FilterCommand, MOST_KEPT};
use crate::value::{MOST_SELECTORS, Sphere};

/// Which paths are shown.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FilterSettings {
    /// The text that the user wrote; blank for all paths.
    pub text: String,
    /// Spheres that paths are selected by, too.
    pub selectors: Vec<Sphere>,
    /// The selector whose handles are shown.
    pub chosen: Option<usize>,
    /// All paths are wanted in spite of the above.
    pub off: bool,
    /// What text and selectors leave out is wanted instead.
    pub inverted: bool,
    /// Filters that have names; each of those that are on must hold, too.
    pub kept: Vec<KeptFilter>,
}

/// A filter that has a name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KeptFilter {
    /// Its name.
    pub name: String,
    /// Its text.
    pub text: String,
    /// It holds.
    pub on: bool,
    /// Its opposite does.
    pub inverted: bool,
}

impl FilterSettings {
    /// Follows a command.
    pub fn apply(&mut self, command: &FilterCommand) {
        match command {
            FilterCommand::Set(text) if text == "true" => self.text.clear(),
            FilterCommand::Set(text) => self.text.clone_from(text),
            FilterCommand::Clear => {
                let mut kept = std::mem::take(&mut self.kept);
                for filter in &mut kept {
                    filter.on = false;
                }
                *self = Self { kept, ..Self::default() };
            }
            FilterCommand::Enable(switch) => {
                let mut on = !self.off;
                switch.apply(&mut on);
                self.off = !on;
            }
            FilterCommand::Invert(switch) => switch.apply(&mut self.inverted),
            FilterCommand::Add(sphere) => {
                if self.selectors.len() < MOST_SELECTORS as usize {
                    self.selectors.push(*sphere);
                    self.chosen = Some(self.selectors.len() - 1);
                }
            }
            FilterCommand::Move(number, place) => {
                if let Some(sphere) = self.selectors.get_mut(*number as usize) {
                    sphere.place = *place;
                }
            }
            FilterCommand::Choose(number) => {
                let number = *number as usize;
                self.chosen = (number < self.selectors.len()).then_some(number);
            }
            FilterCommand::Delete(number) => {
                if (*number as usize) < self.selectors.len() {
                    self.selectors.remove(*number as usize);
                    self.chosen = None;
                }
            }
            FilterCommand::DeleteAll => {
                self.selectors.clear();
                self.chosen = None;
            }
            FilterCommand::Keep(name) => self.keep(name),
            FilterCommand::Use(switch, name) => {
                self.named(name).into_iter().for_each(|kept| switch.apply(&mut kept.on));
            }
            FilterCommand::Reverse(switch, name) => {
                self.named(name).into_iter().for_each(|kept| switch.apply(&mut kept.inverted));
            }
            FilterCommand::Load(name) => {
                if let Some(kept) = self.named(name) {
                    // It would hold twice.
                    kept.on = false;
                    let KeptFilter { text, inverted, .. } = kept.clone();
                    let kept = std::mem::take(&mut self.kept);
                    *self = Self { text, inverted, kept, ..Self::default() };
                }
            }
            FilterCommand::Forget(name) => self.kept.retain(|kept| kept.name != *name),
        }
    }

    /// The kept filter of this name.
    fn named(&mut self, name: &str) -> Option<&mut KeptFilter> {
        self.kept.iter_mut().find(|kept| kept.name == name)
    }

    /// Keeps text and selectors under a name, in the place of what had it before.
    fn keep(&mut self, name: &str) {
        let text = self.own().to_string();
        let (inverted, has_room) = (self.inverted, self.kept.len() < MOST_KEPT);
        let kept = KeptFilter { name: name.to_owned(), text, on: false, inverted };
        match self.named(name) {
            Some(known) => *known = kept,
            None if has_room => self.kept.push(kept),
            None => {}
        }
    }

    /// Text and selectors together.
    fn own(&self) -> Filter {
        let selectors: Vec<_> = self.selectors.iter().map(|sphere| sphere.selector()).collect();
        let text = Filter::parse(&self.text).unwrap_or_default();
        all_of(vec![Filter::from_selectors(&selectors), text])
    }

    /// The text of everything together, as the daemon gets it; blank for all paths.
    pub fn wanted(&self) -> String {
        if self.off {
            return String::new();
        }
        let kept = self.kept.iter().filter(|kept| kept.on).map(|kept| {
            let filter = Filter::parse(&kept.text).unwrap_or_default();
            opposite_if(kept.inverted, filter)
        });
        let parts = std::iter::once(opposite_if(self.inverted, self.own())).chain(kept).collect();
        match all_of(parts) {
            Filter::Constant(true) => String::new(),
            all => all.to_string(),
        }
    }
}

/// What all parts want together.
fn all_of(mut parts: Vec<Filter>) -> Filter {
    parts.retain(|part| *part != Filter::Constant(true));
    if parts.len() > 1 { Filter::And(parts) } else { parts.pop().unwrap_or_default() }
}

/// The filter or, where `inverted` and it leaves out something, its opposite.
fn opposite_if(inverted: bool, filter: Filter) -> Filter {
    if inverted && filter != Filter::Constant(true) {
        Filter::Not(Box::new(filter))
    } else {
        filter
    }
}
