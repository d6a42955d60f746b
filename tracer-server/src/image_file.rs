//! Images on disk: EXR with metadata, and PNG for people.

use std::path::Path;

use common::Rgb;
use host::file::{FileError, Output, Place};
use host::picture::{self, Extras, Picture, PictureError, Plane};
use image::{ImageBuffer, ImageFormat, Rgb as Pixel8};
use thiserror::Error;

use crate::film::Film;

/// Why an image could not be read or written.
#[derive(Debug, Error)]
pub enum ImageError {
    /// The name does not tell a format.
    #[error("`{0}` has no known extension; use a name that ends in .exr or .png")]
    UnknownFormat(String),
    /// The file cannot be written.
    #[error(transparent)]
    File(#[from] FileError),
    /// The file cannot be read.
    #[error(transparent)]
    Picture(#[from] PictureError),
    /// The EXR library refused.
    #[error("`{file}`: {problem}")]
    Exr {
        /// The file.
        file: String,
        /// What it said.
        problem: exr::error::Error,
    },
    /// The PNG library refused.
    #[error("`{file}`: {problem}")]
    Png {
        /// The file.
        file: String,
        /// What it said.
        problem: image::ImageError,
    },
}

/// What an image file may hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Linear radiance in 32-bit floats, with metadata.
    Exr,
    /// Exposed, sRGB-encoded and rounded to eight bits.
    Png,
}

/// Where an image is to go and in what format, known before there is one.
#[derive(Clone, Debug)]
pub struct Destination {
    place: Place,
    format: Format,
}

impl Destination {
    /// Fails where no image can be written at `path`. What has no name of its own, such as a pipe that a
    /// shell made, gets EXR.
    pub fn find(path: &Path) -> Result<Self, ImageError> {
        let is_named = path.extension().is_some();
        let format = if is_named { Some(Format::of(path)?) } else { None };
        let place = Place::find(path)?;
        let format = match format {
            None if place.is_stream() => Format::Exr,
            None => Format::of(path)?,
            Some(format) => format,
        };
        Ok(Self { place, format })
    }

    /// As the user named it.
    pub fn path(&self) -> &Path {
        self.place.path()
    }

    /// True where it is what the program prints to, too.
    pub fn is_stdout(&self) -> bool {
        self.place.is_stdout()
    }

    /// Puts `image` there. `planes` and `metadata` go into EXR files only.
    pub fn write(
        &self,
        image: &Film,
        planes: &[Plane],
        metadata: &[(String, String)],
    ) -> Result<(), ImageError> {
        let file = || self.path().display().to_string();
        self.place.write(|output| match self.format {
            Format::Exr => {
                let size = [image.width(), image.height()].map(|side| side as usize);
                let pixel = |x: usize, y: usize| image.pixels()[y * size[0] + x].to_f32();
                picture::write_exr(output, size, pixel, &Extras { planes, metadata })
                    .map_err(|problem| ImageError::Exr { file: file(), problem })
            }
            Format::Png => write_png(output, image)
                .map_err(|problem| ImageError::Png { file: file(), problem }),
        })
    }
}

impl Format {
    /// The format that a file's name asks for.
    pub fn of(path: &Path) -> Result<Self, ImageError> {
        let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default();
        match extension.to_ascii_lowercase().as_str() {
            "exr" => Ok(Self::Exr),
            "png" => Ok(Self::Png),
            _ => Err(ImageError::UnknownFormat(path.display().to_string())),
        }
    }
}

/// Writes `image` in the format of the file's name. `metadata` goes into EXR headers.
pub fn write(path: &Path, image: &Film, metadata: &[(String, String)]) -> Result<(), ImageError> {
    Destination::find(path)?.write(image, &[], metadata)
}

/// The exposure that brings the brighter parts of an image just below white: one over its 98th
/// percentile of luminance, rounded to a power of two so that images of one scene look alike.
fn auto_exposure(image: &Film) -> f64 {
    let mut luminances: Vec<f64> = image.pixels().iter().map(|p| p.luminance()).collect();
    luminances.retain(|l| l.is_finite() && *l > 0.0);
    luminances.sort_unstable_by(f64::total_cmp);
    match luminances.get(luminances.len() * 98 / 100) {
        Some(&bright) => (0.9 / bright).log2().floor().exp2(),
        None => 1.0,
    }
}

fn encode_srgb(linear: f64) -> u8 {
    let encoded =
        if linear <= 0.0031308 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    (encoded.clamp(0.0, 1.0) * 255.0).round() as u8
}

fn write_png(output: &mut Output, image: &Film) -> Result<(), image::ImageError> {
    let exposure = auto_exposure(image);
    let mut bytes = ImageBuffer::new(image.width(), image.height());
    for (pixel, &Rgb { r, g, b }) in bytes.pixels_mut().zip(image.pixels()) {
        *pixel = Pixel8([r, g, b].map(|c| encode_srgb(c * exposure)));
    }
    bytes.write_to(output, ImageFormat::Png)
}

/// Reads the picture of an EXR file. A pixel that the file has no value for is not a number.
pub fn read_exr(path: &Path) -> Result<Film, ImageError> {
    let Picture { width, height, pixels } = picture::read_exr(path)?;
    let mut film = Film::new(width as u32, height as u32);
    pixels.into_iter().enumerate().for_each(|(i, pixel)| film.splat(i, pixel));
    Ok(film)
}

#[cfg(test)]
mod tests {
    use exr::prelude::{AttributeValue, Text};

    use super::*;

    fn gradient() -> Film {
        let mut film = Film::new(5, 3);
        for i in 0..15 {
            film.splat(i, Rgb::new(i as f64, 0.25, 1e-3 * i as f64));
        }
        film
    }

    #[test]
    fn exr_keeps_pixels_and_metadata() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("gradient.exr");
        let metadata = [("lvis.seed".to_owned(), "7".to_owned())];
        let errors = Plane { name: "error", values: (0..15).map(|i| i as f32).collect() };
        let place = Destination::find(&path).expect("a place");
        place.write(&gradient(), &[errors], &metadata).expect("an EXR file is written");
        let back = read_exr(&path).expect("and read");
        for (a, b) in back.pixels().iter().zip(gradient().pixels()) {
            assert_eq!(a.to_f32(), b.to_f32(), "pixels survive");
        }
        let meta = exr::meta::MetaData::read_from_file(&path, false).expect("the header is read");
        let channels = &meta.headers[0].channels.list;
        let names: Vec<String> = channels.iter().map(|c| c.name.to_string()).collect();
        assert_eq!(names, ["B", "G", "R", "error.Y"], "channels");
        let seed = meta.headers[0].own_attributes.other.get(&Text::from("lvis.seed"));
        assert_eq!(seed, Some(&AttributeValue::Text(Text::from("7"))), "metadata survives");
    }

    #[test]
    fn png_is_exposed_to_be_seen() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("dim.png");
        let mut film = Film::new(4, 4);
        (0..16).for_each(|i| film.splat(i, Rgb::grey(1e-6)));
        write(&path, &film, &[]).expect("a PNG file is written");
        let back = image::open(&path).expect("and read").to_rgb8();
        assert!(back.get_pixel(1, 1).0[0] > 150, "a dim image is made visible");
    }

    #[test]
    fn what_is_no_image_is_refused() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("noise.exr");
        std::fs::write(&path, b"this is no image").expect("a file is written");
        assert!(read_exr(&path).is_err(), "noise is no EXR");
        assert!(read_exr(&folder.path().join("missing.exr")).is_err(), "a missing file");
        let odd = write(&folder.path().join("a.bmp"), &gradient(), &[]);
        assert!(matches!(odd, Err(ImageError::UnknownFormat(_))), "an unknown format");
    }
}
