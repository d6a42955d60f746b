//! The ground: values that know nothing else of the viewer.

mod bounds;
pub mod format;
mod fresh;
pub mod history;
mod path;
pub mod rates;
pub mod theme;
pub mod trends;

pub use bounds::Bounds;
pub use fresh::fresh;
pub use path::Pointer;
