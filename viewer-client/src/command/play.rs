//! `play ...`: a file of paths, step by step.

use super::table::{forms, limits, table};
use crate::value::{Switch, range};

/// Most steps of a file.
const MOST: u32 = 1_000_000_000;

table! {
    /// What may be done with a file of paths.
    #[derive(Copy)]
    pub enum PlayCommand in Play;

    commands {
        /// Plays the steps of a file of paths, or stands still.
        Run "play" (switch: Switch);
        /// How many steps of the file are played a second.
        Rate "play rate" (steps: f32 [range(0.05, 2000.0).log().decimals(2)]);
        /// Shows a step of the file, counted from 0.
        To "play to" (index: u32 [range(0, MOST)]);
        /// Goes so many steps forward, or back.
        By "play by" (steps: i32 [range(-(MOST as i32), MOST as i32)]);
        /// Goes on to the next accepted step.
        Accepted "play accepted";
    }
}
