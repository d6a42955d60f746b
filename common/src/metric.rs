//! How far one picture is from another. Pictures are rows of linear pixels.

use crate::Rgb;

fn square(pixel: Rgb) -> f64 {
    pixel.r * pixel.r + pixel.g * pixel.g + pixel.b * pixel.b
}

/// What keeps the error of dark pixels from ruling a relative error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Floor {
    /// A hundredth of the reference's mean square: exposure does not matter.
    Relative,
    /// This much, in squared units of radiance and added in each channel, as other renderers'
    /// published errors have it.
    Absolute(f64),
}

/// Relative squared error of each pixel of `image` against `reference`.
///
/// With [`Floor::Relative`] `|I - R|^2 / (|R|^2 + 0.01 mean |R|^2)`; with [`Floor::Absolute`] the
/// mean over the channels of `(I - R)^2 / (R^2 + floor)`. NaN where the reference has no value, see
/// [`known`]. Empty when the sizes differ.
pub fn relative_errors(image: &[Rgb], reference: &[Rgb], floor: Floor) -> Vec<f64> {
    if image.len() != reference.len() {
        return Vec::new();
    }
    let pairs = image.iter().zip(reference);
    match floor {
        Floor::Relative => {
            let known = || reference.iter().filter(|pixel| pixel.is_finite());
            let sum = known().map(|&pixel| square(pixel)).sum::<f64>();
            let floor = 0.01 * sum / known().count() as f64;
            let error = |i: Rgb, r: Rgb| square(i + r * -1.0) / (square(r) + floor);
            pairs.map(|(&i, &r)| if r.is_finite() { error(i, r) } else { f64::NAN }).collect()
        }
        Floor::Absolute(floor) => {
            let channel = |i: f64, r: f64| (i - r).powi(2) / (r * r + floor);
            let mean = |i: &Rgb, r: &Rgb| {
                (channel(i.r, r.r) + channel(i.g, r.g) + channel(i.b, r.b)) / 3.0
            };
            pairs.map(|(i, r)| if r.is_finite() { mean(i, r) } else { f64::NAN }).collect()
        }
    }
}

/// The `errors` of those pixels for which the reference has a value: a pixel that another renderer left
/// out, or made no number of, says nothing about the image.
pub fn known(errors: Vec<f64>, reference: &[Rgb]) -> Vec<f64> {
    let pairs = errors.into_iter().zip(reference);
    pairs.filter(|(_, pixel)| pixel.is_finite()).map(|(error, _)| error).collect()
}

/// Relative mean squared error of `image` against `reference`: the mean of [`relative_errors`] where the
/// reference has a value.
///
/// Noise counts alike in bright and dark parts. NaN when the sizes differ, there are no pixels, or
/// any value of the image is NaN. For an unbiased renderer it falls in inverse proportion to the time spent.
pub fn relative_mse(image: &[Rgb], reference: &[Rgb]) -> f64 {
    mean_of_smallest(known(relative_errors(image, reference, Floor::Relative), reference), 1.0)
}

/// Mean of the smallest `share` of `errors`: what is left without the worst pixels.
///
/// NaN when there is no error, or any is NaN.
pub fn mean_of_smallest(mut errors: Vec<f64>, share: f64) -> f64 {
    if errors.iter().any(|error| error.is_nan()) {
        return f64::NAN;
    }
    let kept = ((errors.len() as f64 * share).floor() as usize).min(errors.len());
    if kept < errors.len() {
        errors.sort_by(f64::total_cmp);
        errors.truncate(kept);
    }
    errors.iter().sum::<f64>() / kept as f64
}

/// Sum of all channels of `image` over that of `reference`, where that has a value: one when no energy is
/// lost.
///
/// NaN when the sizes differ or both are black.
pub fn mean_ratio(image: &[Rgb], reference: &[Rgb]) -> f64 {
    if image.len() != reference.len() {
        return f64::NAN;
    }
    let sum = |pixels: &[Rgb]| {
        let known = pixels.iter().zip(reference).filter(|(_, known)| known.is_finite());
        known.map(|(p, _)| p.r + p.g + p.b).sum::<f64>()
    };
    sum(image) / sum(reference)
}

#[cfg(test)]
mod tests {
    use super::*;

    const GREY: Rgb = Rgb::grey(0.5);

    #[test]
    fn relative_error_is_relative() {
        let reference = [GREY, GREY];
        assert_eq!(relative_mse(&reference, &reference), 0.0, "a picture equals itself");
        let brighter = reference.map(|pixel| pixel * 1.1);
        let error = relative_mse(&brighter, &reference);
        assert!((error - 0.01 / 1.01).abs() < 1e-12, "ten per cent off: {error}");
        let scaled = relative_mse(&brighter.map(|p| p * 8.0), &reference.map(|p| p * 8.0));
        assert!((scaled - error).abs() < 1e-12, "exposure does not matter: {scaled}");
    }

    #[test]
    fn a_firefly_and_a_nan_are_seen() {
        let mut image = [GREY; 16];
        image[5] = Rgb::grey(500.0);
        assert!(relative_mse(&image, &[GREY; 16]) > 1e3, "one wild pixel among sixteen");
        image[5] = Rgb::grey(f64::NAN);
        assert!(relative_mse(&image, &[GREY; 16]).is_nan(), "NaN is not averaged away");
        assert!(relative_mse(&image, &[GREY; 15]).is_nan(), "sizes differ");
    }

    #[test]
    fn what_the_reference_does_not_know_is_left_out() {
        let image = [GREY, GREY * 1.1, GREY * 9.0];
        let reference = [GREY, GREY, Rgb::new(0.5, f64::NAN, 0.5)];
        let error = relative_mse(&image, &reference);
        assert!((error - relative_mse(&image[..2], &reference[..2])).abs() < 1e-12, "{error}");
        let ratio = mean_ratio(&image, &reference);
        assert!((ratio - 1.05).abs() < 1e-12, "{ratio}");
        for floor in [Floor::Relative, Floor::Absolute(0.01)] {
            let errors = relative_errors(&image, &reference, floor);
            assert!(errors[2].is_nan() && errors[1].is_finite(), "in its place");
            assert_eq!(known(errors, &reference).len(), 2);
        }
        assert!(relative_mse(&image[2..], &reference[2..]).is_nan(), "nothing is left");
    }

    #[test]
    fn the_worst_pixels_can_be_left_out() {
        let mut image = vec![GREY; 1000];
        image[7] = Rgb::grey(500.0);
        image[8] = Rgb::grey(0.6);
        let errors = relative_errors(&image, &vec![GREY; 1000], Floor::Absolute(0.01));
        assert!((errors[8] - 0.01 / 0.26).abs() < 1e-12, "{}", errors[8]);
        let trimmed = mean_of_smallest(errors.clone(), 0.999);
        assert!((trimmed - errors[8] / 999.0).abs() < 1e-12, "{trimmed}");
        assert!(mean_of_smallest(errors, 1.0) > 900.0, "all of them");
        assert!(mean_of_smallest(vec![f64::NAN, 1.0], 0.5).is_nan(), "NaN is never left out");
    }

    #[test]
    fn lost_energy_shows_in_the_ratio() {
        let ratio = mean_ratio(&[Rgb::grey(0.9); 4], &[Rgb::WHITE; 4]);
        assert!((ratio - 0.9).abs() < 1e-12, "{ratio}");
        assert!(mean_ratio(&[Rgb::BLACK], &[Rgb::BLACK]).is_nan(), "black against black");
    }
}
