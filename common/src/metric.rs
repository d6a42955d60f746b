//! How far one picture is from another. Pictures are rows of linear pixels.

use crate::Rgb;

fn square(pixel: Rgb) -> f64 {
    pixel.r * pixel.r + pixel.g * pixel.g + pixel.b * pixel.b
}

/// Relative mean squared error of `image` against `reference`.
///
/// Per pixel `|I - R|^2 / (|R|^2 + 0.01 mean |R|^2)`, averaged over the pixels: noise counts alike
/// in bright and dark parts, and the second term keeps black pixels from ruling the sum. NaN when
/// the sizes differ, there are no pixels, or any value is NaN. For an unbiased renderer it falls
/// in inverse proportion to the time spent.
pub fn relative_mse(image: &[Rgb], reference: &[Rgb]) -> f64 {
    if image.len() != reference.len() {
        return f64::NAN;
    }
    let pixels = reference.len() as f64;
    let floor = 0.01 * reference.iter().map(|&pixel| square(pixel)).sum::<f64>() / pixels;
    let error = |(&i, &r): (&Rgb, &Rgb)| square(i + r * -1.0) / (square(r) + floor);
    image.iter().zip(reference).map(error).sum::<f64>() / pixels
}

/// Sum of all channels of `image` over that of `reference`: one when no energy is lost.
///
/// NaN when the sizes differ or both are black.
pub fn mean_ratio(image: &[Rgb], reference: &[Rgb]) -> f64 {
    if image.len() != reference.len() {
        return f64::NAN;
    }
    let sum = |pixels: &[Rgb]| pixels.iter().map(|p| p.r + p.g + p.b).sum::<f64>();
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
    fn lost_energy_shows_in_the_ratio() {
        let ratio = mean_ratio(&[Rgb::grey(0.9); 4], &[Rgb::WHITE; 4]);
        assert!((ratio - 0.9).abs() < 1e-12, "{ratio}");
        assert!(mean_ratio(&[Rgb::BLACK], &[Rgb::BLACK]).is_nan(), "black against black");
    }
}
