//! The program: owns all that there is, and runs in a window, into a file or as text.

pub mod background;
pub mod bench;
pub mod cli;
pub mod desktop;
mod failed;
pub mod headless;
pub mod pace;
pub mod preferences;
pub mod run;
pub mod script;
pub mod share;
mod viewer;
pub mod watch;
pub mod window;

pub use failed::Failed;
pub use viewer::Viewer;
