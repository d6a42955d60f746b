//! What every replicate of a picture is made of.

use std::sync::Arc;

use common::Camera;
use serde::Serialize;

use crate::chain::{Kernel, Prospect};
use crate::target::{Base, Selective};

/// The sizes of replicates and the law of their chains: frozen before the first one begins.
///
/// They depend on scene, settings and seed, never on how much is asked for, on threads or on a clock.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Number of the run: every random number is keyed by it.
    pub seed: u64,
    /// Who draws the base samples, and what is left to chains; none where chains have all of the light.
    pub base: Option<Selective>,
    /// The law of the chains.
    pub kernel: Arc<Kernel>,
    /// Parts of a replicate.
    pub parts: u32,
    /// Bidirectional samples of a replicate's pool.
    pub pool: u64,
    /// Chains of a replicate; none where the base sampler has all of the light.
    pub chains: u32,
    /// Steps of each chain in a part.
    pub steps: u64,
    /// The mean luminance of the picture, about: in film units of the scene.
    pub brightness: f64,
    /// What the pilot found of each strategy.
    pub prospects: Vec<Prospect>,
    /// What the pilot expects of the work, for people.
    pub outlook: Outlook,
}

/// What a pilot expects of replicates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Outlook {
    /// The base sampler; none where chains have all of the light.
    pub base: Option<Base>,
    /// The dial between both: film luminance above which light is left to chains.
    pub tau: f64,
    /// Share of the light that is the chains'.
    pub chains_share: f64,
    /// Mutations for each pixel and base sample.
    pub mutations_per_sample: f64,
    /// Share of the work that pools take.
    pub pool_share: f64,
    /// Mutations that are worth one independent sample.
    pub correlation: f64,
    /// Whether dark parts are visited as often as bright ones.
    pub is_equalised: bool,
}

/// A share of a replicate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Share {
    /// Parts that are done.
    pub parts: u32,
    /// Parts of a whole replicate.
    pub of: u32,
}

impl Share {
    /// True of a whole replicate.
    pub fn is_whole(self) -> bool {
        self.parts == self.of
    }

    /// The share, from 0 to 1.
    pub fn get(self) -> f64 {
        f64::from(self.parts) / f64::from(self.of)
    }
}

impl Plan {
    /// Mutations and base samples for each pixel in one replicate.
    pub fn per_pixel(&self, camera: &Camera) -> f64 {
        let steps = u64::from(self.chains) * self.steps;
        let mutations = steps as f64 / camera.pixel_count() as f64;
        let samples = if self.base.is_some() { 1.0 } else { 0.0 };
        f64::from(self.parts) * (mutations + samples)
    }

    /// Replicates of a picture with so many mutations and base samples for each pixel: at least one.
    pub fn replicates_for(&self, per_pixel: u64, camera: &Camera) -> u64 {
        ((per_pixel as f64 / self.per_pixel(camera)).ceil() as u64).max(1)
    }

    /// The plan in a few words, for people.
    pub fn describe(&self) -> String {
        let Outlook { base, tau, .. } = self.outlook;
        let base =
            base.map_or_else(|| "no base".to_owned(), |base| format!("base {}", base.name()));
        format!(
            "seed {}; {base}, tau {tau:.4e}; {} parts of {} chains of {} steps each, pool of {}",
            self.seed, self.parts, self.chains, self.steps, self.pool
        )
    }

    /// The quantum that sums of pixels are counted in, in film units of the scene: a power of two, so
    /// small that rounding is beneath any noise.
    pub fn quantum(&self) -> f64 {
        const BITS: i32 = 30;
        let exponent =
            if self.brightness > 0.0 { self.brightness.log2().floor() as i32 } else { 0 };
        2_f64.powi(exponent - BITS)
    }
}
