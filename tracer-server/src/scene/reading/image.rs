//! Textures from image files.

use std::io::Cursor;
use std::path::Path;

use image::{DynamicImage, ImageReader, Limits};

use super::text::read_bytes;
use crate::scene::description::{Coding, SkyImage, Texture};

/// The most bytes of an image file that are read.
const MAX_BYTES: u64 = 256 << 20;
/// The longest side of an image in pixels.
const MAX_SIDE: u32 = 16_384;
/// The most memory that decoding may take, in bytes.
const MAX_MEMORY: u64 = 1 << 30;

/// Reads a PNG or JPEG image.
pub(crate) fn read_texture(path: &Path, coding: Coding) -> Result<Texture, String> {
    let image = decode(path)?.into_rgb8();
    Ok(Texture {
        name: path.file_name().unwrap_or_default().to_string_lossy().into_owned(),
        width: image.width(),
        height: image.height(),
        texels: image.pixels().map(|pixel| pixel.0).collect(),
        coding,
    })
}

/// Reads the image of an environment: `OpenEXR` and Radiance HDR as they are, PNG and JPEG as sRGB.
pub(crate) fn read_sky(path: &Path) -> Result<SkyImage, String> {
    let image = decode(path)?;
    let linear = matches!(image, DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_));
    let (width, height) = (image.width() as usize, image.height() as usize);
    let texels = if linear {
        image.into_rgb32f().pixels().map(|pixel| pixel.0).collect()
    } else {
        let decode = |value: u8| Coding::Srgb.decode(value) as f32;
        image.into_rgb8().pixels().map(|pixel| pixel.0.map(decode)).collect()
    };
    Ok(SkyImage { width, height, texels })
}

fn decode(path: &Path) -> Result<DynamicImage, String> {
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
    if image.width() == 0 || image.height() == 0 {
        return Err(format!("{}: the image has no pixels", path.display()));
    }
    Ok(image)
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
        let mean = read_texture(&path, Coding::Srgb).expect("decoded").mean();
        assert!((mean.r - 0.5).abs() < 1e-12, "half of the squares are full red: {mean:?}");
        assert!((mean.g - 0.5029).abs() < 1e-4, "sRGB 188 is half of full light: {mean:?}");
        assert_eq!(mean.b, 0.0, "no blue");
    }

    #[test]
    fn what_is_no_image_is_a_message() {
        let directory = tempfile::tempdir().expect("a directory");
        let path = directory.path().join("broken.jpg");
        let complaint = || read_texture(&path, Coding::Srgb).expect_err("no image");
        assert!(complaint().contains("broken.jpg"), "names the file that is absent");
        std::fs::write(&path, b"\xff\xd8\xff\xe0 not a JPEG").expect("written");
        assert!(complaint().contains("broken.jpg"), "names the file that is broken");
    }
}
