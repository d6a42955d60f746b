//! Linear pictures in EXR files: what other programs write is read, too.

mod channels;
#[cfg(test)]
mod tests;

use std::path::Path;

use common::Rgb;
use exr::error::{Error as ExrError, UnitResult};
use exr::image::read::specific_channels::ReadSpecificChannel as _;
use exr::meta::MetaData;
use exr::meta::header::Header;
use exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Encoding, FlatSamples, Image, IntegerBounds, Layer,
    LayerAttributes, ReadChannels, ReadLayers as _, Text, Vec2, WritableImage as _, read,
};
use thiserror::Error;

use self::channels::{Choice, Names};
use crate::file::Output;

/// Widest and highest picture that is read, in pixels.
const MAX_SIDE: usize = 1 << 15;

/// Why a picture cannot be read.
#[derive(Debug, Error)]
pub enum PictureError {
    /// There is no such file, or it is no EXR file.
    #[error("`{file}`: {problem}")]
    Exr {
        /// The file.
        file: String,
        /// What the library said.
        problem: ExrError,
    },
    /// There is no picture in it, or more than one.
    #[error(
        "`{file}` has {what} among its channels {channels}; name the picture's channels R, G and B"
    )]
    Channels {
        /// The file.
        file: String,
        /// What is the matter.
        what: &'static str,
        /// The channels found.
        channels: String,
    },
    /// Too large to be a picture of ours.
    #[error("`{0}` is larger than {MAX_SIDE} pixels a side")]
    TooLarge(String),
}

/// A picture as a file holds it.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// In pixels.
    pub width: usize,
    /// In pixels.
    pub height: usize,
    /// Linear radiance, row by row from the top. A pixel that the file has no value for is not a
    /// number: outside of what was rendered, for one.
    pub pixels: Vec<Rgb>,
}

impl Picture {
    /// Pixels that are no radiance.
    pub fn missing(&self) -> usize {
        self.pixels.iter().filter(|pixel| !pixel.is_finite()).count()
    }
}

/// Reads the picture of an EXR file: its channels R, G and B, those of the layer that Blender, V-Ray
/// and others keep it in, or Y.
pub fn read_exr(path: &Path) -> Result<Picture, PictureError> {
    let file = || path.display().to_string();
    let told = |problem| PictureError::Exr { file: file(), problem };
    let meta = MetaData::read_from_file(path, false).map_err(told)?;
    let choice = channels::choose(&meta).map_err(|what| {
        let channels = channels::list(&meta);
        PictureError::Channels { file: file(), what, channels }
    })?;
    let Vec2(width, height) = choice.window.size;
    if width > MAX_SIDE || height > MAX_SIDE {
        return Err(PictureError::TooLarge(file()));
    }
    let part = read_part(path, &choice).map_err(told)?;
    Ok(part.ok_or_else(|| PictureError::TooLarge(file()))?.within(choice.window))
}

/// A part of a file, which may cover less than the picture, or more.
struct Part {
    place: Vec2<i32>,
    width: usize,
    pixels: Vec<Rgb>,
}

impl Part {
    /// The part of it within `window`, with nothing where it does not reach.
    fn within(&self, window: IntegerBounds) -> Picture {
        let Vec2(width, height) = window.size;
        let (left, top) = (window.position.0 - self.place.0, window.position.1 - self.place.1);
        let nothing = Rgb::grey(f64::NAN);
        let at = |x: usize, y: usize| {
            let (column, row) = (shift(x, left)?, shift(y, top)?);
            self.pixels.get(row * self.width + column).copied().filter(|_| column < self.width)
        };
        let rows = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let pixels = rows.map(|(x, y)| at(x, y).unwrap_or(nothing)).collect();
        Picture { width, height, pixels }
    }
}

/// `x` and so much more, or less; `None` below zero.
fn shift(x: usize, by: i32) -> Option<usize> {
    let distance = by.unsigned_abs() as usize;
    if by < 0 { x.checked_sub(distance) } else { x.checked_add(distance) }
}

/// Where the pixels of a part are gathered; none where it is too large.
type Gathered = Option<(usize, Vec<Rgb>)>;

fn gather(size: Vec2<usize>) -> Gathered {
    let fits = size.0 <= MAX_SIDE && size.1 <= MAX_SIDE;
    fits.then(|| (size.0, vec![Rgb::BLACK; size.0 * size.1]))
}

fn put(gathered: &mut Gathered, at: Vec2<usize>, rgb: [f32; 3]) {
    let Vec2(x, y) = at;
    if let Some((width, pixels)) = gathered
        && let Some(pixel) = pixels.get_mut(y * *width + x)
    {
        *pixel = Rgb::from(rgb);
    }
}

/// The part that was chosen; `None` where it is too large.
fn read_part(path: &Path, Choice { part, names, .. }: &Choice) -> Result<Option<Part>, ExrError> {
    let reader = read().no_deep_data().largest_resolution_level().specific_channels();
    let (gathered, place) = match names {
        Names::Rgb([r, g, b]) => {
            let channels = reader.required(r.clone()).required(g.clone()).required(b.clone());
            let channels = channels.collect_pixels(
                |size, _| gather(size),
                |pixels, at, rgb: (f32, f32, f32)| put(pixels, at, rgb.into()),
            );
            let channels = OfPart { part, channels };
            let layer = channels.first_valid_layer().all_attributes().from_file(path)?.layer_data;
            (layer.channel_data.pixels, layer.attributes.layer_position)
        }
        Names::Grey(y) => {
            let channels = reader.required(y.clone()).optional("", 0.0).collect_pixels(
                |size, _| gather(size),
                |pixels, at, (y, _): (f32, f32)| put(pixels, at, [y; 3]),
            );
            let channels = OfPart { part, channels };
            let layer = channels.first_valid_layer().all_attributes().from_file(path)?.layer_data;
            (layer.channel_data.pixels, layer.attributes.layer_position)
        }
    };
    Ok(gathered.map(|(width, pixels)| Part { place, width, pixels }))
}

/// Channels of one part of a file and no other.
struct OfPart<'a, C> {
    part: &'a Option<Text>,
    channels: C,
}

impl<'s, C: ReadChannels<'s>> ReadChannels<'s> for OfPart<'_, C> {
    type Reader = C::Reader;

    fn create_channels_reader(&'s self, header: &Header) -> Result<C::Reader, ExrError> {
        if header.own_attributes.layer_name != *self.part {
            return Err(ExrError::Invalid("another part".into()));
        }
        self.channels.create_channels_reader(header)
    }
}

/// One more number for every pixel of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Plane {
    /// Its name, such as `error`: the channel is `error.Y`.
    pub name: &'static str,
    /// Row by row from the top.
    pub values: Vec<f32>,
}

/// What a file holds in addition to the picture.
#[derive(Clone, Copy, Debug, Default)]
pub struct Extras<'a> {
    /// Channels of their own.
    pub planes: &'a [Plane],
    /// Words and what they mean, in the header.
    pub metadata: &'a [(String, String)],
}

/// Writes a picture of `size` pixels whose radiance `pixel` tells.
pub fn write_exr(
    output: &mut Output,
    [width, height]: [usize; 2],
    pixel: impl Fn(usize, usize) -> [f32; 3],
    extras: &Extras<'_>,
) -> UnitResult {
    let places = || (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let color = |(index, name): (usize, &str)| {
        let values = places().map(|(x, y)| pixel(x, y)[index]).collect();
        AnyChannel::new(name, FlatSamples::F32(values))
    };
    let plane = |plane: &Plane| {
        let name = format!("{}.Y", plane.name);
        AnyChannel::new(name.as_str(), FlatSamples::F32(plane.values.clone()))
    };
    let colors = ["R", "G", "B"].into_iter().enumerate().map(color);
    let channels = AnyChannels::sort(colors.chain(extras.planes.iter().map(plane)).collect());
    let mut attributes = LayerAttributes::named("");
    attributes.software_name = Some(text("Lvis"));
    for (key, value) in extras.metadata {
        attributes.other.insert(text(key), AttributeValue::Text(text(value)));
    }
    let layer = Layer::new(Vec2(width, height), attributes, Encoding::SMALL_LOSSLESS, channels);
    Image::from_layer(layer).write().to_buffered(output)
}

/// Text of any script, in UTF-8. What readers of old expect, Latin-1, is the same for ASCII.
fn text(text: &str) -> Text {
    Text::from_slice_unchecked(text.as_bytes())
}
