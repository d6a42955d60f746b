//! Images on disk.

use std::path::Path;

use common::Rgb;
use exr::prelude::{
    AttributeValue, Encoding, Image, Layer, LayerAttributes, SpecificChannels, Text, Vec2,
    WritableImage as _, read_first_rgba_layer_from_file,
};
use thiserror::Error;

use super::Reference;
use crate::imaging::film::Film;

/// Widest and highest image that is read, in pixels.
const MAX_SIDE: usize = 1 << 13;

/// Why an image could not be read or written.
#[derive(Debug, Error)]
pub enum ExchangeError {
    /// The name does not tell a format.
    #[error("`{0}` does not tell its format; end the name in .exr or .png")]
    UnknownFormat(String),
    /// The EXR library refused.
    #[error("`{0}`: {1}")]
    Exr(String, exr::error::Error),
    /// The PNG library refused.
    #[error("`{0}`: {1}")]
    Png(String, image::ImageError),
    /// Too large to be an image of ours.
    #[error("`{0}` has more than {MAX_SIDE} pixels a side")]
    TooLarge(String),
    /// A radiance that is none.
    #[error("`{0}` holds a value that is not finite, at pixel {1}, {2}; render it anew")]
    NotFinite(String, usize, usize),
}

/// Reads the first layer of an EXR file.
pub fn read_exr(file: &Path) -> Result<Reference, ExchangeError> {
    let name = file.display().to_string();
    let loaded = read_first_rgba_layer_from_file(
        file,
        |size, _| {
            let fits = size.0 <= MAX_SIDE && size.1 <= MAX_SIDE;
            fits.then(|| (size.0, vec![Rgb::BLACK; size.0 * size.1]))
        },
        |target, Vec2(x, y), (r, g, b, _): (f32, f32, f32, f32)| {
            if let Some((width, pixels)) = target
                && let Some(pixel) = pixels.get_mut(y * *width + x)
            {
                *pixel = Rgb::from([r, g, b]);
            }
        },
    );
    let image = loaded.map_err(|error| ExchangeError::Exr(name.clone(), error))?;
    let pixels = image.layer_data.channel_data.pixels;
    let (width, pixels) = pixels.ok_or_else(|| ExchangeError::TooLarge(name.clone()))?;
    let is_finite = |p: &Rgb| [p.r, p.g, p.b].into_iter().all(f64::is_finite);
    if let Some(bad) = pixels.iter().position(|p| !is_finite(p)) {
        return Err(ExchangeError::NotFinite(name, bad % width, bad / width));
    }
    Ok(Reference { name, width, height: pixels.len() / width.max(1), pixels })
}

/// Writes the radiance of `film` into an EXR file with `metadata`, or `shown`, which has three bytes
/// a pixel, into a PNG file.
pub fn save(
    file: &Path,
    film: &Film,
    shown: Vec<u8>,
    metadata: &[(&str, String)],
) -> Result<(), ExchangeError> {
    let name = file.display().to_string();
    let extension = file.extension().and_then(|e| e.to_str()).unwrap_or_default();
    match extension.to_ascii_lowercase().as_str() {
        "exr" => write_exr(file, film, metadata).map_err(|error| ExchangeError::Exr(name, error)),
        "png" => {
            let [width, height] = film.size().map(|side| side as u32);
            let unknown = || ExchangeError::UnknownFormat(name.clone());
            let image = image::RgbImage::from_raw(width, height, shown).ok_or_else(unknown)?;
            let saved = image.save_with_format(file, image::ImageFormat::Png);
            saved.map_err(|error| ExchangeError::Png(name, error))
        }
        _ => Err(ExchangeError::UnknownFormat(name)),
    }
}

fn write_exr(file: &Path, film: &Film, metadata: &[(&str, String)]) -> exr::error::UnitResult {
    let [width, height] = film.size();
    let channels = SpecificChannels::rgb(|Vec2(x, y): Vec2<usize>| {
        <(f32, f32, f32)>::from(film.pixel(x, y).unwrap_or_default())
    });
    let mut attributes = LayerAttributes::named("");
    attributes.software_name = Some(Text::from("Lvis"));
    for (key, value) in metadata {
        let value = AttributeValue::Text(Text::from(value.as_str()));
        attributes.other.insert(Text::from(*key), value);
    }
    let layer = Layer::new(Vec2(width, height), attributes, Encoding::SMALL_LOSSLESS, channels);
    Image::from_layer(layer).write().to_file(file)
}

#[cfg(test)]
mod tests {
    use common::FilmTile;

    use super::*;

    fn film() -> Film {
        let mut film = Film::default();
        let rgb = (0..18).map(|i| i as f32 * 0.25).collect();
        let tile = FilmTile { sequence: 1, width: 3, height: 2, first_row: 0, steps: 9, rgb };
        assert!(film.accept(&tile), "a whole image");
        film
    }

    #[test]
    fn radiance_survives_a_file() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let file = folder.path().join("image.exr");
        let metadata = [("lvis.mutations", "9".to_owned())];
        save(&file, &film(), Vec::new(), &metadata).expect("an EXR file is written");
        let back = read_exr(&file).expect("and read");
        assert!(back.fits(&film()), "its size");
        assert_eq!(back.pixels, film().radiance(), "its radiance");
        let meta = exr::meta::MetaData::read_from_file(&file, false).expect("the header");
        let steps = meta.headers[0].own_attributes.other.get(&Text::from("lvis.mutations"));
        assert_eq!(steps, Some(&AttributeValue::Text(Text::from("9"))), "metadata");
    }

    #[test]
    fn what_is_shown_goes_into_a_png() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let file = folder.path().join("image.png");
        save(&file, &film(), (0..18).collect(), &[]).expect("a PNG file is written");
        let back = image::open(&file).expect("and read").to_rgb8();
        assert_eq!(back.into_raw(), (0..18).collect::<Vec<u8>>(), "byte for byte");
    }

    #[test]
    fn nonsense_is_refused_with_its_name() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let file = folder.path().join("noise.exr");
        std::fs::write(&file, b"no image").expect("a file is written");
        let error = read_exr(&file).expect_err("noise").to_string();
        assert!(error.contains("noise.exr"), "{error}");
        let error = save(&folder.path().join("a.bmp"), &film(), Vec::new(), &[]);
        assert!(matches!(error, Err(ExchangeError::UnknownFormat(_))), "{error:?}");
        let mut bad = Film::default();
        let rgb = vec![0.0, 0.0, f32::NAN];
        let tile = FilmTile { sequence: 1, width: 1, height: 1, first_row: 0, steps: 1, rgb };
        assert!(bad.accept(&tile), "tiles are checked on the wire");
        save(&file, &bad, Vec::new(), &[]).expect("a file is written");
        let error = read_exr(&file).expect_err("NaN").to_string();
        assert!(error.contains("pixel 0, 0"), "{error}");
    }
}
