//! Images on disk: EXR with metadata, and PNG for people.

use std::path::Path;

use common::Rgb;
use exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Encoding, FlatSamples, Image, Layer, LayerAttributes,
    Text, Vec2, WritableImage as _, read_first_rgba_layer_from_file,
};
use host::file::{FileError, Output, Place};
use image::{ImageBuffer, ImageFormat, Rgb as Pixel8};
use thiserror::Error;

use crate::film::Film;

/// Widest and highest image that is read, in pixels.
const MAX_SIDE: usize = 1 << 15;

/// Why an image could not be read or written.
#[derive(Debug, Error)]
pub enum ImageError {
    /// The name does not tell a format.
    #[error("`{0}` does not tell its format; end the name in .exr or .png")]
    UnknownFormat(String),
    /// The file cannot be written.
    #[error(transparent)]
    File(#[from] FileError),
    /// The EXR library refused.
    #[error("`{file}`: {source}")]
    Exr {
        /// The file.
        file: String,
        /// What it said.
        source: exr::error::Error,
    },
    /// The PNG library refused.
    #[error("`{file}`: {source}")]
    Png {
        /// The file.
        file: String,
        /// What it said.
        source: image::ImageError,
    },
    /// Too large to be an image of ours.
    #[error("`{0}` is larger than {MAX_SIDE} pixels a side")]
    TooLarge(String),
}

/// What an image file may hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Linear radiance in 32-bit floats, with metadata.
    Exr,
    /// Exposed, sRGB-encoded and rounded to eight bits.
    Png,
}

/// One more number for every pixel of an image.
#[derive(Clone, Debug, PartialEq)]
pub struct Plane {
    /// Its name, such as `error`: the channel is `error.Y`.
    pub name: &'static str,
    /// Row by row from the top.
    pub values: Vec<f32>,
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
            Format::Exr => write_exr(output, image, planes, metadata)
                .map_err(|source| ImageError::Exr { file: file(), source }),
            Format::Png => {
                write_png(output, image).map_err(|source| ImageError::Png { file: file(), source })
            }
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

/// Text of any script, in UTF-8. What readers of old expect, Latin-1, is the same for ASCII.
fn exr_text(text: &str) -> Text {
    Text::from_slice_unchecked(text.as_bytes())
}

fn write_exr(
    output: &mut Output,
    image: &Film,
    planes: &[Plane],
    metadata: &[(String, String)],
) -> Result<(), exr::error::Error> {
    let size = (image.width() as usize, image.height() as usize);
    let color = |(index, name): (usize, &str)| {
        let values = image.pixels().iter().map(|pixel| pixel.to_f32()[index]).collect();
        AnyChannel::new(name, FlatSamples::F32(values))
    };
    let plane = |plane: &Plane| {
        let name = format!("{}.Y", plane.name);
        AnyChannel::new(name.as_str(), FlatSamples::F32(plane.values.clone()))
    };
    let colors = ["R", "G", "B"].into_iter().enumerate().map(color);
    let channels = AnyChannels::sort(colors.chain(planes.iter().map(plane)).collect());
    let mut attributes = LayerAttributes::named("");
    attributes.software_name = Some(Text::from("Lvis"));
    for (key, value) in metadata {
        attributes.other.insert(exr_text(key), AttributeValue::Text(exr_text(value)));
    }
    let layer = Layer::new(size, attributes, Encoding::SMALL_LOSSLESS, channels);
    Image::from_layer(layer).write().to_buffered(output)
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

/// Reads the first layer of an EXR file.
pub fn read_exr(path: &Path) -> Result<Film, ImageError> {
    let loaded = read_first_rgba_layer_from_file(
        path,
        |size, _| {
            let fits = size.0 <= MAX_SIDE && size.1 <= MAX_SIDE;
            fits.then(|| Film::new(size.0 as u32, size.1 as u32))
        },
        |film, Vec2(x, y), (r, g, b, _): (f32, f32, f32, f32)| {
            if let Some(film) = film {
                film.splat(y * film.width() as usize + x, Rgb::from([r, g, b]));
            }
        },
    );
    let file = path.display().to_string();
    let image = loaded.map_err(|source| ImageError::Exr { file: file.clone(), source })?;
    image.layer_data.channel_data.pixels.ok_or(ImageError::TooLarge(file))
}

#[cfg(test)]
mod tests {
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

    /// Names of scenes come from files' names, which may be in any script.
    #[test]
    fn metadata_may_be_in_any_script() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("сцена – l’été.exr");
        let long = "場".repeat(300);
        for name in ["сцена", "l’été", "Küche", "a\nb\0c", "", &long] {
            let metadata = [("lvis.scene".to_owned(), name.to_owned())];
            write(&path, &gradient(), &metadata).expect("an EXR file is written");
            let back = read_exr(&path).expect("and read");
            assert_eq!(back.pixels()[14].to_f32(), gradient().pixels()[14].to_f32(), "{name}");
            let meta = exr::meta::MetaData::read_from_file(&path, true).expect("a sound header");
            let read = meta.headers[0].own_attributes.other.get(&Text::from("lvis.scene"));
            let Some(AttributeValue::Text(read)) = read else { panic!("{name}: {read:?}") };
            assert_eq!(read.as_slice(), name.as_bytes(), "UTF-8");
        }
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
