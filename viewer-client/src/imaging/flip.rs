//! How different the image looks from a reference: HDR-FLIP [Andersson et al. 2021].

use flip_rs::{HdrOptions, RgbImage, hdr_flip};

use super::Reference;
use crate::imaging::film::Film;

/// The difference that a person sees at each pixel who flips between image and reference.
#[derive(Clone, Debug, PartialEq)]
pub struct FlipMap {
    /// From 0, none, to 1, row by row from the top.
    pub errors: Vec<f32>,
    /// Mean over the pixels that the reference has a value for.
    pub mean: f64,
    /// Mutations behind the image that was compared.
    pub steps: u64,
}

impl FlipMap {
    /// Compares, which takes long: seconds for a large image. Exposures come from the reference, and a
    /// pixel counts as on the screen that the metric's authors assume.
    pub fn of(film: &Film, reference: &Reference) -> Result<Self, String> {
        let [width, height] = film.size();
        let is_known: Vec<bool> = reference.pixels.iter().map(|pixel| pixel.is_finite()).collect();
        // Where the reference has no value, there is no difference to be seen.
        let shown =
            |(rgb, known): ([f32; 3], &bool)| if *known { rgb.map(bounded) } else { [0.0; 3] };
        let own = film.rgb().as_chunks::<3>().0.iter().copied().zip(&is_known).map(shown);
        let other = reference.pixels.iter().map(|pixel| pixel.to_f32()).zip(&is_known).map(shown);
        let image = |pixels: Vec<f32>| {
            RgbImage::new(width, height, pixels).map_err(|error| error.to_string())
        };
        let test = image(own.flatten().collect())?;
        let reference = image(other.flatten().collect())?;
        let flipped = hdr_flip(&reference, &test, HdrOptions::default());
        let errors = flipped.map_err(|error| error.to_string())?.error_map.into_pixels();
        let known = || errors.iter().zip(&is_known).filter(|(_, known)| **known);
        let sum = known().map(|(error, _)| f64::from(*error)).sum::<f64>();
        let mean = sum / known().count().max(1) as f64;
        Ok(Self { errors, mean, steps: film.steps() })
    }

    /// True when so much light was added to `film` since that another comparison is due.
    pub fn is_old(&self, film: &Film) -> bool {
        const GROWTH: f64 = 1.1;
        self.errors.len() != film.rgb().len() / 3
            || film.steps() < self.steps
            || film.steps() as f64 > GROWTH * self.steps as f64
    }
}

/// What the metric takes: finite and not negative.
fn bounded(value: f32) -> f32 {
    if value.is_finite() { value.max(0.0) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use common::{FilmTile, Rgb};

    use super::*;

    fn film(value: impl Fn(usize) -> f32, steps: u64) -> Film {
        let mut film = Film::default();
        let rgb = (0..32 * 24).flat_map(|i| [value(i); 3]).collect();
        let tile = FilmTile { sequence: 1, width: 32, height: 24, first_row: 0, steps, rgb };
        assert!(film.accept(&tile), "a whole image");
        film
    }

    fn reference(value: impl Fn(usize) -> f32) -> Reference {
        let pixels = (0..32 * 24).map(|i| Rgb::grey(f64::from(value(i)))).collect();
        Reference { name: String::new(), width: 32, height: 24, pixels }
    }

    fn ramp(i: usize) -> f32 {
        (i % 32) as f32 / 32.0
    }

    #[test]
    fn what_looks_more_different_counts_more() {
        let reference = reference(ramp);
        let mean = |value: &dyn Fn(usize) -> f32| {
            FlipMap::of(&film(value, 7), &reference).expect("of equal size").mean
        };
        assert_eq!(mean(&ramp), 0.0, "equal");
        let slightly = mean(&|i| ramp(i) * 1.05);
        let much = mean(&|i| ramp(i) * 2.0);
        assert!(0.0 < slightly && slightly < 0.5 * much && much < 1.0, "{slightly} {much}");
        // One pixel in sixteen is far too bright: noise.
        let noisy =
            FlipMap::of(&film(|i| ramp(i) + if i % 16 == 5 { 2.0 } else { 0.0 }, 7), &reference);
        let noisy = noisy.expect("of equal size");
        let (at, beside) = (noisy.errors[5 + 32 * 9], noisy.errors[13 + 32 * 9]);
        assert!(at > 3.0 * beside, "where the noise is: {at}, beside it: {beside}");
    }

    #[test]
    fn what_the_reference_does_not_know_counts_for_nothing() {
        let hole = |i: usize| if i / 32 < 8 { f32::NAN } else { ramp(i) };
        let map =
            FlipMap::of(&film(|i| if i / 32 < 8 { 9.0 } else { ramp(i) }, 7), &reference(hole));
        assert_eq!(map.expect("of equal size").mean, 0.0, "equal elsewhere");
    }

    #[test]
    fn what_cannot_be_compared_is_refused() {
        let small =
            Reference { name: String::new(), width: 2, height: 1, pixels: vec![Rgb::BLACK; 2] };
        assert!(FlipMap::of(&film(ramp, 1), &small).is_err(), "another size");
        assert!(FlipMap::of(&film(ramp, 1), &reference(|_| 0.0)).is_err(), "a black reference");
        let map = FlipMap::of(&film(ramp, 100), &reference(ramp)).expect("of equal size");
        assert!(!map.is_old(&film(ramp, 105)), "hardly more light");
        assert!(map.is_old(&film(ramp, 120)), "more light");
        assert!(map.is_old(&film(ramp, 10)), "another image");
    }
}
