//! On and off.

use super::{Settable, choice::choices};

choices! {
    /// What to do with something that is on or off.
    pub enum Switch {
        /// Makes it on.
        On,
        /// Makes it off.
        Off,
        /// Changes it.
        Toggle,
    }
}

impl Switch {
    /// The state after a state.
    pub fn apply(self, on: &mut bool) {
        *on = match self {
            Self::On => true,
            Self::Off => false,
            Self::Toggle => !*on,
        };
    }

    /// On or off, as a checkbox says it.
    pub fn to(on: bool) -> Self {
        if on { Self::On } else { Self::Off }
    }
}

impl Settable for bool {
    type Change = Switch;

    fn change(&mut self, to: Switch) {
        to.apply(self);
    }

    fn as_change(&self) -> Option<Switch> {
        Some(Switch::to(*self))
    }
}
