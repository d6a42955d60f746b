//! The program: owns all that there is, and runs in a window, into a file or as text.

pub mod bench;
pub mod cli;
pub mod desktop;
pub mod headless;
pub mod pace;
pub mod run;
pub mod script;
pub mod share;
mod viewer;
pub mod watch;
pub mod window;

pub use viewer::Viewer;
