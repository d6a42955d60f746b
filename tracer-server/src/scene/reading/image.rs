//! Images: textures, and the sky.

use std::io::Cursor;
use std::path::Path;

use common::Rgb;
use glam::DAffine2;
use host::picture::{Picture, read_exr};
use image::{DynamicImage, ImageFormat, ImageReader, Limits};

use super::pfm;
use super::text::read_bytes;
use crate::scene::description::{Coding, SkyImage, Texels, Texture};

/// The most bytes of an image file that are read.
const MAX_BYTES: u64 = 256 << 20;
/// The longest side of an image in pixels.
const MAX_SIDE: u32 = 16_384;
/// The most memory that decoding may take, in bytes.
const MAX_MEMORY: u64 = 1 << 30;
/// How every EXR file begins.
const EXR: &[u8] = &[0x76, 0x2f, 0x31, 0x01];
/// How Radiance's own pictures begin; other programs write `#?RGBE` and more.
const RADIANCE: &[u8] = b"#?RADIANCE\n";

/// What an image file holds.
enum Decoded {
    /// Codes of up to 16 bits, which by custom are sRGB.
    Codes(DynamicImage),
    /// Linear numbers.
    Numbers(Picture),
}

/// Reads a texture. EXR, Radiance HDR and PFM images are numbers as they are, brought into [0, 1];
/// codes of all others mean what `coding` says.
pub(crate) fn read_texture(path: &Path, coding: Coding) -> Result<Texture, String> {
    let (width, height, texels) = match decode(path)? {
        Decoded::Codes(image) => {
            let image = image.into_rgb8();
            let codes = image.pixels().map(|pixel| pixel.0).collect();
            (image.width(), image.height(), Texels::Codes(codes, coding))
        }
        Decoded::Numbers(picture) => {
            // What is not a number is black, and a surface cannot reflect more than all.
            let share = |channel: f64| channel.clamp(0.0, 1.0).max(0.0) as f32;
            let texel = |pixel: &Rgb| <[f64; 3]>::from(*pixel).map(share);
            let numbers = picture.pixels.iter().map(texel).collect();
            (picture.width as u32, picture.height as u32, Texels::Numbers(numbers))
        }
    };
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    Ok(Texture { name, width, height, texels, placing: DAffine2::IDENTITY })
}

/// Reads the image of an environment: EXR, Radiance HDR and PFM as they are, all others as sRGB.
pub(crate) fn read_sky(path: &Path) -> Result<SkyImage, String> {
    match decode(path)? {
        Decoded::Codes(image) => {
            let decode = |value: u8| Coding::Srgb.decode(value) as f32;
            let (width, height) = (image.width() as usize, image.height() as usize);
            let texels = image.into_rgb8().pixels().map(|pixel| pixel.0.map(decode)).collect();
            Ok(SkyImage { width, height, texels })
        }
        Decoded::Numbers(Picture { width, height, pixels }) => {
            let texels = pixels.into_iter().map(Rgb::to_f32).collect();
            Ok(SkyImage { width, height, texels })
        }
    }
}

fn decode(path: &Path) -> Result<Decoded, String> {
    let named = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
    let mut bytes = read_bytes(path, MAX_BYTES).map_err(|error| error.to_string())?;
    if bytes.starts_with(EXR) {
        return read_exr(path).map(Decoded::Numbers).map_err(|error| error.to_string());
    }
    if bytes.starts_with(b"PF") || bytes.starts_with(b"Pf") {
        return pfm::read(&bytes).map(Decoded::Numbers).map_err(|error| named(&error));
    }
    if bytes.starts_with(b"#?") {
        let end = bytes.iter().position(|&byte| byte == b'\n').map_or(bytes.len(), |end| end + 1);
        bytes.splice(..end, RADIANCE.iter().copied());
    }
    let mut reader = ImageReader::new(Cursor::new(bytes))
        .with_guessed_format()
        .map_err(|error| named(&error))?;
    if reader.format().is_none()
        && let Ok(format) = ImageFormat::from_path(path)
    {
        // Some formats, such as TGA, have nothing to be known by but their names.
        reader.set_format(format);
    }
    let mut limits = Limits::default();
    limits.max_image_width = Some(MAX_SIDE);
    limits.max_image_height = Some(MAX_SIDE);
    limits.max_alloc = Some(MAX_MEMORY);
    reader.limits(limits);
    let image = reader.decode().map_err(|error| named(&error))?;
    if image.width() == 0 || image.height() == 0 {
        return Err(named(&"the image has no pixels"));
    }
    if !matches!(image, DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_)) {
        return Ok(Decoded::Codes(image));
    }
    let image = image.into_rgb32f();
    let (width, height) = (image.width() as usize, image.height() as usize);
    let pixels = image.pixels().map(|pixel| Rgb::from(pixel.0)).collect();
    Ok(Decoded::Numbers(Picture { width, height, pixels }))
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
    fn numbers_are_taken_as_they_are() {
        let directory = tempfile::tempdir().expect("a directory");
        let rows: [[f32; 3]; 2] = [[0.25, 0.5, 4.0], [0.75, f32::NAN, -1.0]];
        let (exr, hdr, pfm) = ("a.exr", "b.hdr", "c.pfm");
        let path = |name: &str| directory.path().join(name);
        let place = host::file::Place::find(&path(exr)).expect("a place");
        let written = place.write(|output| -> Result<(), host::file::FileError> {
            let pixel = |x: usize, _| rows.get(x).copied().unwrap_or_default();
            let extras = host::picture::Extras::default();
            host::picture::write_exr(output, [2, 1], pixel, &extras).expect("memory");
            Ok(())
        });
        written.expect("written");
        // Shared exponents hold these numbers exactly; -1 is none of them.
        let hdr_text =
            b"#?RGBE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n\x40\x80\x00\x80\xc0\x00\x00\x80";
        std::fs::write(path(hdr), hdr_text).expect("written");
        let mut text = b"PF\n2 1\n-1.0\n".to_vec();
        text.extend(rows.as_flattened().iter().flat_map(|number| number.to_le_bytes()));
        std::fs::write(path(pfm), text).expect("written");
        let texels = |name: &str| match read_texture(&path(name), Coding::Srgb) {
            Ok(Texture { texels: Texels::Numbers(numbers), .. }) => numbers.to_vec(),
            other => panic!("{name}: {other:?}"),
        };
        let shares = [[0.25, 0.5, 1.0], [0.75, 0.0, 0.0]];
        assert_eq!((texels(exr), texels(pfm)), (shares.to_vec(), shares.to_vec()));
        assert_eq!(texels(hdr), [[0.25, 0.5, 0.0], [0.75, 0.0, 0.0]]);
        let sky = read_sky(&path(pfm)).expect("a sky");
        assert_eq!((sky.width, sky.height, sky.texels[0]), (2, 1, rows[0]), "nothing is cut off");
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
