//! The ground: values that know nothing else of the viewer.

mod bounds;
pub mod format;
pub mod history;
pub mod rates;
pub mod theme;
pub mod trends;

pub use bounds::Bounds;
