//! The range of radiances on screen, from a running mean and deviation of their logarithms.

use shaders::{decode_radiance, encode_radiance};

/// After this many paths, older ones count 1/e.
const MEMORY: f32 = 4000.0;
/// The shown range is this many deviations to either side of the mean.
const DEVIATIONS: f32 = 1.8;
/// The range never gets narrower than this many stops.
const NARROWEST: f32 = 3.0;

/// A running estimate, in stops (log2 of the radiance).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tone {
    mean: f32,
    variance: f32,
    paths: f32,
}

impl Tone {
    /// Learns from one path.
    pub fn include(&mut self, radiance: f32) {
        let stops = decode_radiance(encode_radiance(radiance));
        self.paths = (self.paths + 1.0).min(MEMORY);
        let step = (stops - self.mean) / self.paths;
        let before = stops - self.mean;
        self.mean += step;
        self.variance += (before * (stops - self.mean) - self.variance) / self.paths;
    }

    /// The darkest and the brightest radiance to tell apart, in stops.
    pub fn range(self) -> (f32, f32) {
        let half = (DEVIATIONS * self.variance.max(0.0).sqrt()).max(0.5 * NARROWEST);
        (self.mean - half, self.mean + half)
    }
}
