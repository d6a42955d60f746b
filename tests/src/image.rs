//! How far one picture is from another. Pictures are rows of linear RGB pixels.

use crate::{Accumulator, Suite, welch_z};

/// Means over squares of `block` pixels, row by row; squares cut by the border are averaged over
/// what is left of them.
///
/// Neighbouring pixels of a Markov chain err together, so their means show what single pixels
/// hide. An incomplete last row of `image` is ignored.
pub fn block_means(image: &[[f64; 3]], width: usize, block: usize) -> Vec<[f64; 3]> {
    let (width, block) = (width.max(1), block.max(1));
    let columns = width.div_ceil(block);
    let bands = (image.len() / width).div_ceil(block);
    let mut blocks = vec![[Accumulator::default(); 3]; columns * bands];
    for (y, row) in image.chunks_exact(width).enumerate() {
        for (x, pixel) in row.iter().enumerate() {
            let target = &mut blocks[y / block * columns + x / block];
            for (channel, value) in target.iter_mut().zip(pixel) {
                channel.push(*value);
            }
        }
    }
    blocks.into_iter().map(|channels| channels.map(|c| c.mean())).collect()
}

/// Compares two renderers pixel by pixel and channel by channel, from independent runs of each.
///
/// Every run is a picture of the same size; each side needs at least two. A channel that is the
/// same number in every run of both renderers, such as black background, tests nothing and is
/// left out. Whatever the sizes, a mismatch of them is a failing comparison, not a panic.
pub fn z_map(name: &str, runs_a: &[Vec<[f64; 3]>], runs_b: &[Vec<[f64; 3]>]) -> Suite {
    let mut suite = Suite::new(name);
    let pixels = runs_a.first().map_or(0, Vec::len);
    let same_size = runs_a.iter().chain(runs_b).all(|run| run.len() == pixels);
    if !same_size {
        suite.record("picture sizes", crate::ZScore(f64::NAN));
        return suite;
    }
    for index in 0..pixels * 3 {
        let (pixel, channel) = (index / 3, index % 3);
        let gather = |runs: &[Vec<[f64; 3]>]| -> Accumulator {
            runs.iter().map(|run| run[pixel][channel]).collect()
        };
        let (a, b) = (gather(runs_a), gather(runs_b));
        let constant = a.variance() == 0.0 && b.variance() == 0.0 && a.mean() == b.mean();
        if !constant {
            let letter = ["r", "g", "b"][channel];
            suite.record(format!("pixel {pixel} {letter}"), welch_z(&a, &b));
        }
    }
    suite
}

#[cfg(test)]
mod tests {
    use rand_core::{Rng as _, SeedableRng as _};
    use rand_xoshiro::Xoshiro256PlusPlus;

    use super::*;

    #[test]
    fn blocks_average_what_they_hold() {
        // Three by three pixels in blocks of two: four blocks, three of them cut.
        let image: Vec<[f64; 3]> = (0..9).map(|i| [f64::from(i), 0.0, 1.0]).collect();
        let means = block_means(&image, 3, 2);
        let red: Vec<f64> = means.iter().map(|pixel| pixel[0]).collect();
        assert_eq!(red, [2.0, 3.5, 6.5, 8.0], "row by row");
        assert!(means.iter().all(|pixel| pixel[2] == 1.0), "a constant stays constant");
    }

    /// Sixteen runs of sixteen noisy pixels around `mean`, with one black pixel.
    fn runs(seed: u64, mean: f64) -> Vec<Vec<[f64; 3]>> {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
        let mut noisy = || mean * (0.9 + 0.2 * (rng.next_u64() >> 11) as f64 * 2.0_f64.powi(-53));
        let mut run = || {
            let mut pixels: Vec<[f64; 3]> = (0..16).map(|_| [noisy(), noisy(), noisy()]).collect();
            pixels[3] = [0.0; 3];
            pixels
        };
        (0..16).map(|_| run()).collect()
    }

    #[test]
    fn equal_renderers_agree() {
        let suite = z_map("same", &runs(1, 1.0), &runs(2, 1.0));
        assert_eq!(suite.len(), 45, "the black pixel is left out");
        assert!(suite.verdict().is_pass(), "{}", suite.verdict());
        let mean_square = suite.mean_square();
        assert!((mean_square - 1.0).abs() < 5.0 * (2.0_f64 / 45.0).sqrt(), "{mean_square}");
    }

    #[test]
    fn a_bias_and_a_size_mismatch_are_found() {
        let biased = z_map("biased", &runs(1, 1.0), &runs(2, 1.2));
        assert!(!biased.verdict().is_pass(), "twenty per cent too bright");
        let mut cropped = runs(2, 1.0);
        cropped[4].pop();
        assert!(!z_map("cropped", &runs(1, 1.0), &cropped).verdict().is_pass(), "sizes differ");
        let mut dead = runs(2, 1.0);
        dead[0][7] = [f64::NAN; 3];
        assert!(!z_map("NaN", &runs(1, 1.0), &dead).verdict().is_pass(), "NaN fails");
    }
}
