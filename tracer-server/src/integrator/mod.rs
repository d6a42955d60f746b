//! Images by independent samples: the references that the chains are held to.

mod bidirectional;
mod path_tracer;

pub use bidirectional::BidirectionalTracer;
pub use path_tracer::PathTracer;

#[cfg(test)]
mod laws;
#[cfg(test)]
mod peers;
