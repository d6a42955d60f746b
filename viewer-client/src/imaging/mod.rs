//! The progressive image as numbers and as colours: what it is compared with, how it is shown, and
//! how it leaves the viewer. Knows nothing of windows.

mod compare;
mod develop;
mod exchange;
pub mod film;
mod flip;
mod tev;
mod view;

pub use compare::{Comparison, Reference};
pub use develop::{BAND, Legend, Ramp, Sources, develop, legend, map_values, ramp_color};
pub use exchange::{ExchangeError, read_exr, save};
pub use flip::FlipMap;
pub use tev::{TEV_ADDRESS, send_to_tev};
pub use view::{Finding, ImageView, Job, Outcome, Provenance, saved_text};
