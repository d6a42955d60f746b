use std::io::Write as _;

use exr::image::write::layers::WritableLayers;
use exr::prelude::{AnyChannel, AnyChannels, Compression, FlatSamples, f16};

use super::*;
use crate::file::{FileError, Place};

const SIZE: Vec2<usize> = Vec2(40, 36);

/// The value of a channel at a pixel: red, green and blue differ, and so do pixels.
fn value(channel: usize, x: usize, y: usize) -> f32 {
    (channel + 1) as f32 * 0.25 + x as f32 * 0.125 + y as f32 * 0.5
}

fn samples(value: impl Fn(usize, usize) -> f32) -> Vec<f32> {
    let Vec2(width, height) = SIZE;
    (0..width * height).map(|i| value(i % width, i / width)).collect()
}

/// Channels of these names; those that end in R, G or B hold what the picture holds, others noise.
fn channels(names: &[&str]) -> AnyChannels<FlatSamples> {
    let channel = |name: &&str| {
        let colour = name.chars().last().and_then(|end| "RGB".find(end.to_ascii_uppercase()));
        let samples = samples(|x, y| colour.map_or(-9.0, |colour| value(colour, x, y)));
        AnyChannel::new(*name, FlatSamples::F32(samples))
    };
    AnyChannels::sort(names.iter().map(channel).collect())
}

fn layer(name: &str, names: &[&str]) -> Layer<AnyChannels<FlatSamples>> {
    let layer_name = (!name.is_empty()).then(|| Text::from(name));
    let attributes = LayerAttributes { layer_name, ..LayerAttributes::default() };
    Layer::new(SIZE, attributes, Encoding::FAST_LOSSLESS, channels(names))
}

/// Reads what `image` writes.
fn reread<'w, L: WritableLayers<'w>>(image: &'w Image<L>) -> Result<Picture, PictureError> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("picture.exr");
    image.write().to_file(&path).expect("written");
    read_exr(&path)
}

fn of_channels(names: &[&str]) -> Result<Picture, PictureError> {
    reread(&Image::from_layer(layer("", names)))
}

/// How far a picture is from what was written, as a share of it.
fn is_off(picture: &Picture) -> f64 {
    assert_eq!((picture.width, picture.height), (SIZE.0, SIZE.1), "its size");
    let mut worst = 0.0_f64;
    for (i, pixel) in picture.pixels.iter().enumerate() {
        let expected = [0, 1, 2].map(|c| f64::from(value(c, i % SIZE.0, i / SIZE.0)));
        for (found, expected) in <[f64; 3]>::from(*pixel).into_iter().zip(expected) {
            worst = worst.max((found / expected - 1.0).abs());
        }
    }
    worst
}

#[test]
fn the_channels_of_other_programs_are_found() {
    for names in [
        &["B", "G", "R"][..],
        &["A", "B", "G", "R", "Z"],
        &["B", "G", "R", "albedo.B", "albedo.G", "albedo.R", "depth.Z"],
        &[
            "ViewLayer.Combined.A",
            "ViewLayer.Combined.B",
            "ViewLayer.Combined.G",
            "ViewLayer.Combined.R",
        ],
        &[
            "View Layer.Normal.X",
            "View Layer.DiffCol.R",
            "View Layer.DiffCol.G",
            "View Layer.DiffCol.B",
            "View Layer.Combined.R",
            "View Layer.Combined.G",
            "View Layer.Combined.B",
        ],
        &[".A", ".B", ".G", ".R"],
        &[
            "effectsResult.R",
            "effectsResult.G",
            "effectsResult.B",
            "diffuse.R",
            "diffuse.G",
            "diffuse.B",
        ],
        &["b", "g", "r"],
        &["radiance.R", "radiance.G", "radiance.B", "depth.Z"],
    ] {
        let picture = of_channels(names).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(is_off(&picture), 0.0, "{names:?}");
        assert_eq!(picture.missing(), 0);
    }
}

#[test]
fn where_there_is_no_picture_the_channels_are_named() {
    for (names, words) in [
        (&["depth.Z", "normal.X"][..], "no picture among its channels `depth.Z`, `normal.X`"),
        (&["albedo.R", "albedo.G", "albedo.B", "paint.R", "paint.G", "paint.B"], "more than one"),
        (&["R", "G"], "`G`, `R`"),
        (&["BY", "RY", "Y"], "`RY`"),
    ] {
        let error = of_channels(names).expect_err("no picture").to_string();
        assert!(error.contains(words) && error.contains("picture.exr"), "{error}");
    }
    let many: Vec<String> = (0..99).map(|i| format!("pass{i:02}.Z")).collect();
    let many: Vec<&str> = many.iter().map(String::as_str).collect();
    let error = of_channels(&many).expect_err("no picture").to_string();
    assert!(error.contains("`pass23.Z` and 75 more"), "{error}");
}

#[test]
fn luminance_alone_is_grey() {
    let picture = of_channels(&["Y"]).expect("a picture");
    assert_eq!(picture.pixels[7], Rgb::grey(-9.0), "what this test writes into other channels");
}

#[test]
fn the_part_that_is_the_picture_is_found() {
    let parts = |names: &[(&str, &[&str])]| {
        let layers = names.iter().map(|(name, channels)| layer(name, channels));
        let layers: exr::prelude::Layers<_> = layers.collect();
        let window = IntegerBounds::from_dimensions(SIZE);
        reread(&Image::from_layers(exr::prelude::ImageAttributes::new(window), layers))
    };
    let rgb = &["B", "G", "R"][..];
    let picture = parts(&[("depth", &["Z"]), ("beauty", rgb)]).expect("by its channels");
    assert_eq!(is_off(&picture), 0.0);
    let picture = parts(&[("albedo", rgb), ("rgba", rgb), ("normal", rgb)]).expect("by its name");
    assert_eq!(is_off(&picture), 0.0);
    let error = parts(&[("albedo", rgb), ("paint", rgb)]).expect_err("neither").to_string();
    assert!(error.contains("`albedo: R`") && error.contains("`paint: B`"), "{error}");
}

#[test]
fn every_compression_is_read() {
    for (compression, tolerance) in [
        (Compression::Uncompressed, 0.0),
        (Compression::RLE, 0.0),
        (Compression::ZIP1, 0.0),
        (Compression::ZIP16, 0.0),
        (Compression::PIZ, 0.0),
        (Compression::PXR24, 1e-4),
        (Compression::B44, 0.0),
        (Compression::B44A, 0.0),
        // These lose what is hardly seen.
        (Compression::DWAA(None), 0.1),
        (Compression::DWAB(None), 0.1),
    ] {
        let mut layer = layer("", &["B", "G", "R"]);
        layer.encoding.compression = compression;
        let picture = reread(&Image::from_layer(layer)).unwrap_or_else(|error| panic!("{error}"));
        assert!(is_off(&picture) <= tolerance, "{compression}: {}", is_off(&picture));
    }
    let half = |(index, name): (usize, &str)| {
        let samples = samples(|x, y| value(index, x, y)).into_iter().map(f16::from_f32).collect();
        AnyChannel::new(name, FlatSamples::F16(samples))
    };
    let channels = AnyChannels::sort(["R", "G", "B"].into_iter().enumerate().map(half).collect());
    let picture = reread(&Image::from_encoded_channels(SIZE, Encoding::default(), channels));
    assert!(is_off(&picture.expect("half the bits")) < 1e-3);
}

/// A border render: less than the picture was rendered, or more.
#[test]
fn what_was_not_rendered_is_missing() {
    let mut layer = layer("", &["B", "G", "R"]);
    layer.attributes.layer_position = Vec2(-10, 20);
    let window = IntegerBounds::new(Vec2(5, 10), Vec2(50, 30));
    let attributes = exr::prelude::ImageAttributes::new(window);
    let picture = reread(&Image::new(attributes, layer)).expect("a picture");
    assert_eq!((picture.width, picture.height), (50, 30), "the picture, not the part");
    let at = |x: usize, y: usize| picture.pixels[y * 50 + x];
    // Pixel 0, 0 of the picture is at 5, 10, and that of the part at -10, 20.
    assert_eq!(at(0, 10).r, f64::from(value(0, 15, 0)));
    assert!(!at(0, 9).is_finite() && !at(25, 10).is_finite(), "above, and to the right");
    assert_eq!(picture.missing(), 50 * 30 - 25 * 20);
}

#[test]
fn a_pixel_that_is_no_number_is_missing() {
    let mut layer = layer("", &["B", "G", "R"]);
    for channel in &mut layer.channel_data.list {
        if let FlatSamples::F32(samples) = &mut channel.sample_data {
            samples[77] = if channel.name.eq("G") { f32::NAN } else { 1.0 };
            samples[78] = f32::INFINITY;
        }
    }
    let picture = reread(&Image::from_layer(layer)).expect("a picture");
    assert_eq!(picture.missing(), 2);
    assert!(!picture.pixels[77].is_finite() && picture.pixels[79].is_finite());
}

#[test]
fn what_is_written_is_read_whatever_it_is_called() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("сцена – l’été.exr");
    let long = "場".repeat(300);
    for name in ["сцена", "l’été", "Küche", "a\nb\0c", "", &long] {
        let metadata = [("lvis.scene".to_owned(), name.to_owned())];
        let pixel = |x, y| [0, 1, 2].map(|channel| value(channel, x, y));
        Place::find(&path)
            .expect("a place")
            .write(|output| -> Result<(), FileError> {
                write_exr(
                    output,
                    [SIZE.0, SIZE.1],
                    pixel,
                    &Extras { metadata: &metadata, ..Extras::default() },
                )
                .expect("room");
                output.flush().expect("room");
                Ok(())
            })
            .expect("written");
        assert_eq!(is_off(&read_exr(&path).expect("our own")), 0.0, "{name}");
        let meta = MetaData::read_from_file(&path, true).expect("a sound header");
        let read = meta.headers[0].own_attributes.other.get(&Text::from("lvis.scene"));
        let Some(AttributeValue::Text(read)) = read else { panic!("{name}: {read:?}") };
        assert_eq!(read.as_slice(), name.as_bytes(), "UTF-8");
    }
}

#[test]
fn noise_and_nothing_are_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("noise.exr");
    std::fs::write(&path, b"no picture").expect("writable");
    assert!(read_exr(&path).expect_err("noise").to_string().contains("noise.exr"));
    let missing = read_exr(&folder.path().join("missing.exr")).expect_err("nothing");
    assert!(missing.to_string().contains("missing.exr"), "{missing}");
}
