//! Images on disk.

use std::path::Path;

use host::file::{FileError, Place};
use host::picture::{self, Extras, Picture, PictureError};
use thiserror::Error;

use super::Reference;
use crate::imaging::film::Film;

/// Why an image could not be read or written.
#[derive(Debug, Error)]
pub enum ExchangeError {
    /// The name does not tell a format.
    #[error("`{0}` has no known extension; use a name that ends in .exr or .png")]
    UnknownFormat(String),
    /// The file cannot be read.
    #[error(transparent)]
    Unreadable(#[from] PictureError),
    /// The file cannot be written.
    #[error(transparent)]
    Unwritable(#[from] FileError),
    /// The EXR library refused.
    #[error("`{0}`: {1}")]
    Exr(String, exr::error::Error),
    /// The PNG library refused.
    #[error("`{0}`: {1}")]
    Png(String, image::ImageError),
}

/// Reads the picture of an EXR file. A pixel that the file has no value for is not a number.
pub fn read_exr(file: &Path) -> Result<Reference, ExchangeError> {
    let Picture { width, height, pixels } = picture::read_exr(file)?;
    Ok(Reference { name: file.display().to_string(), width, height, pixels })
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
    let [width, height] = film.size();
    let extension = file.extension().and_then(|e| e.to_str()).unwrap_or_default();
    match extension.to_ascii_lowercase().as_str() {
        "exr" => {
            let pixel = |x, y| film.pixel(x, y).unwrap_or_default();
            let metadata: Vec<_> =
                metadata.iter().map(|(key, value)| ((*key).to_owned(), value.clone())).collect();
            let extras = Extras { metadata: &metadata, ..Extras::default() };
            Place::find(file)?.write(|output| {
                let written = picture::write_exr(output, [width, height], pixel, &extras);
                written.map_err(|error| ExchangeError::Exr(name, error))
            })
        }
        "png" => {
            let unknown = || ExchangeError::UnknownFormat(name.clone());
            let image = image::RgbImage::from_raw(width as u32, height as u32, shown);
            let image = image.ok_or_else(unknown)?;
            Place::find(file)?.write(|output| {
                let written = image.write_to(output, image::ImageFormat::Png);
                written.map_err(|error| ExchangeError::Png(name, error))
            })
        }
        _ => Err(ExchangeError::UnknownFormat(name)),
    }
}

#[cfg(test)]
mod tests {
    use common::FilmTile;
    use exr::prelude::{AttributeValue, Text};

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
        let rgb = vec![0.0, 0.0, f32::NAN, 1.0, 1.0, 1.0];
        let tile = FilmTile { sequence: 1, width: 2, height: 1, first_row: 0, steps: 1, rgb };
        assert!(bad.accept(&tile), "tiles are checked on the wire");
        save(&file, &bad, Vec::new(), &[]).expect("a file is written");
        let reference = read_exr(&file).expect("one pixel is a number");
        assert_eq!(reference.missing(), 1, "{reference:?}");
    }
}
