//! Random streams that belong to what they feed, never to a thread.

use rand_core::{Rng as _, SeedableRng as _};
use rand_xoshiro::Xoshiro256PlusPlus;

/// What a random stream is for. Streams of different purposes never overlap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u64)]
pub enum Stream {
    /// One bidirectional sample of the pool that seeds the chains.
    Bootstrap = 1,
    /// One Markov chain.
    Chain = 2,
    /// The choice of the seeds among the pool.
    Resampling = 3,
    /// One pixel of the path tracer.
    PathTracer = 4,
    /// One block of samples of the bidirectional path tracer.
    Bidirectional = 5,
    /// The base samples of one replicate.
    Base = 10,
    /// What `verify` draws on a user's scene.
    Verification = 7,
    /// The census of a scene's light before the chains start.
    Census = 8,
    /// The look at a scene that sets the weights of its strategies.
    Pilot = 11,
    /// Samples through points anywhere on the film.
    Scattered = 15,
    /// One short chain of the look at a scene.
    Scout = 14,
    /// One epoch of the explorer.
    Explorer = 12,
    /// One fan of the explorer.
    Fan = 13,
    /// Tests and benchmarks.
    Laboratory = 6,
    /// The coordinates of one chain in primary-sample space.
    Coordinates = 9,
}

/// A random stream: xoshiro256++ keyed by a hash of (seed, purpose, index).
///
/// The key is hashed because neighbouring seeds of a simple mixer can give one and the same
/// sequence, shifted by a step.
#[derive(Clone, Debug)]
pub struct Rng(Xoshiro256PlusPlus);

impl Rng {
    /// The stream number `index` for a purpose.
    pub fn new(seed: u64, stream: Stream, index: u64) -> Self {
        let mut key = [0; 24];
        key[..8].copy_from_slice(&seed.to_le_bytes());
        key[8..16].copy_from_slice(&(stream as u64).to_le_bytes());
        key[16..].copy_from_slice(&index.to_le_bytes());
        Self(Xoshiro256PlusPlus::from_seed(*blake3::hash(&key).as_bytes()))
    }

    /// Sixty-four random bits.
    #[inline]
    pub fn bits(&mut self) -> u64 {
        self.0.next_u64()
    }

    /// A number in [0, 1) with 53 random bits.
    #[inline]
    pub fn uniform(&mut self) -> f64 {
        const SCALE: f64 = 1.0 / (1_u64 << 53) as f64;
        (self.0.next_u64() >> 11) as f64 * SCALE
    }

    /// `N` numbers in [0, 1), one after the other.
    #[inline]
    pub fn array<const N: usize>(&mut self) -> [f64; N] {
        std::array::from_fn(|_| self.uniform())
    }

    /// An integer in `0..n`; zero for `n == 0`.
    #[inline]
    pub fn below(&mut self, n: usize) -> usize {
        // The product rounds to `n` only for n near 2^53.
        ((self.uniform() * n as f64) as usize).min(n.saturating_sub(1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbouring_keys_are_unrelated() {
        // A product of two centred uniforms has standard deviation 1/12.
        const N: usize = 20_000;
        for (index, lag) in (0..4).flat_map(|index| (0..=8).map(move |lag| (index, lag))) {
            let mut a = Rng::new(1, Stream::Chain, index);
            let mut b = Rng::new(1, Stream::Chain, index + 1);
            for _ in 0..lag {
                b.uniform();
            }
            let sum: f64 = (0..N).map(|_| (a.uniform() - 0.5) * (b.uniform() - 0.5)).sum();
            let z = sum / (N as f64).sqrt() * 12.0;
            assert!(z.abs() < 6.0, "streams {index} and the next, lag {lag}: z = {z}");
        }
    }

    /// No number of one stream is a number of another: no stream is another's, shifted.
    #[test]
    fn keys_give_distinct_streams() {
        const STREAMS: u64 = 100_000;
        const LENGTH: usize = 64;
        let keys = (0..STREAMS).map(|index| (7, Stream::Bootstrap, index));
        let others = [(8, Stream::Bootstrap, 0), (7, Stream::Chain, 0)];
        let mut outputs = Vec::with_capacity((STREAMS as usize + others.len()) * LENGTH);
        for (seed, stream, index) in keys.chain(others) {
            let mut rng = Rng::new(seed, stream, index).0;
            outputs.extend((0..LENGTH).map(|_| rng.next_u64()));
        }
        let drawn = outputs.len();
        outputs.sort_unstable();
        outputs.dedup();
        assert_eq!(outputs.len(), drawn, "two streams share a number");
    }
}
