//! What a texture amounts to until textures are modelled: its mean colour.

use std::io::Cursor;
use std::path::Path;

use common::Rgb;
use image::{ImageReader, Limits};

use super::text::read_bytes;

/// The most bytes of an image file that are read.
const MAX_BYTES: u64 = 256 << 20;
/// The longest side of an image in pixels.
const MAX_SIDE: u32 = 16_384;
/// The most memory that decoding may take, in bytes.
const MAX_MEMORY: u64 = 1 << 30;

/// The mean of an sRGB-coded PNG or JPEG image, in linear light.
pub(super) fn mean_color(path: &Path) -> Result<Rgb, String> {
    let bytes = read_bytes(path, MAX_BYTES).map_err(|error| error.to_string())?;
    let mut reader = ImageReader::new(Cursor::new(bytes))
        .with_guessed_format()
        .map_err(|error| format!("{}: {error}", path.display()))?;
    let mut limits = Limits::default();
    limits.max_image_width = Some(MAX_SIDE);
    limits.max_image_height = Some(MAX_SIDE);
    limits.max_alloc = Some(MAX_MEMORY);
    reader.limits(limits);
    let image = reader.decode().map_err(|error| format!("{}: {error}", path.display()))?;
    let image = image.into_rgb8();

    // Counting codes first makes the sum exact and independent of the order of pixels.
    let mut counts = [[0_u64; 256]; 3];
    for pixel in image.pixels() {
        for (channel, code) in counts.iter_mut().zip(pixel.0) {
            channel[usize::from(code)] += 1;
        }
    }
    let pixels = u64::from(image.width()) * u64::from(image.height());
    if pixels == 0 {
        return Err(format!("{}: the image has no pixels", path.display()));
    }
    let mean = |channel: &[u64; 256]| {
        let sum: f64 = (0_u8..=255).zip(channel).map(|(code, &n)| n as f64 * linear(code)).sum();
        sum / pixels as f64
    };
    let [r, g, b] = &counts;
    Ok(Rgb::new(mean(r), mean(g), mean(b)))
}

/// The light that an 8-bit sRGB code stands for, in [0, 1] (IEC 61966-2-1).
fn linear(code: u8) -> f64 {
    let value = f64::from(code) / 255.0;
    if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

#[cfg(test)]
mod tests {
    use image::RgbImage;

    use super::*;

    #[test]
    fn the_mean_is_taken_in_linear_light() {
        let directory = tempfile::tempdir().expect("a directory");
        let path = directory.path().join("checks.png");
        let checks = RgbImage::from_fn(8, 8, |x, y| {
            if (x + y) % 2 == 0 { [255, 188, 0].into() } else { [0, 188, 0].into() }
        });
        checks.save(&path).expect("saved");
        let mean = mean_color(&path).expect("decoded");
        assert!((mean.r - 0.5).abs() < 1e-12, "half of the squares are full red: {mean:?}");
        assert!((mean.g - 0.5029).abs() < 1e-4, "sRGB 188 is half of full light: {mean:?}");
        assert_eq!(mean.b, 0.0, "no blue");
    }

    #[test]
    fn what_is_no_image_is_a_message() {
        let directory = tempfile::tempdir().expect("a directory");
        let path = directory.path().join("broken.jpg");
        assert!(mean_color(&path).expect_err("absent").contains("broken.jpg"), "names the file");
        std::fs::write(&path, b"\xff\xd8\xff\xe0 not a JPEG").expect("written");
        assert!(mean_color(&path).expect_err("broken").contains("broken.jpg"), "names the file");
    }
}
