//! From what is held to a picture: what lies under the cursor, and two ways to draw.

pub mod gpu;
pub mod pick;
pub mod raster;
