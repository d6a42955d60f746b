//! `play ...`: a file of paths, step by step.

use super::table::table;
use crate::value::{Switch, range};

/// Most steps of a file.
const MOST: i32 = 1_000_000_000;

table! {
    /// What may be done with a file of paths.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub enum PlayCommand in Play;

    commands {
        /// Plays a file of paths, or pauses it.
        Run "play" (switch: Switch);
        /// How many steps of the file are played per second.
        Rate "play rate" (steps: f32 [range(0.05, 2000.0).log().decimals(2).unit("/s")]);
        /// Shows a step of the file, counted from 0.
        To "play to" (index: u32 [range(0, MOST.cast_unsigned())]);
        /// Goes this many steps forward, or back if negative.
        By "play by" (steps: i32 [range(-MOST, MOST)]);
        /// Goes on to the next accepted step.
        Accepted "play accepted";
    }
}
