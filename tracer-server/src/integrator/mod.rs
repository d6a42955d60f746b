//! Images by independent samples: the references that the chains are held to, and chains over the
//! numbers behind such samples.

mod bidirectional;
mod path_tracer;
pub mod pssmlt;

pub use bidirectional::BidirectionalTracer;
pub use path_tracer::PathTracer;

#[cfg(test)]
pub(crate) mod laws;
#[cfg(test)]
mod peers;
