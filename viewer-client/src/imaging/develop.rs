//! From numbers to the colours on screen.

use std::borrow::Cow;

use common::{Diagnostics, Rgb};

use super::{FlipMap, Reference};
use crate::imaging::film::{Film, encode_srgb};
use crate::settings::ImageSettings;
use crate::value::format;
use crate::value::{Channel, Layer, ToneCurve};

/// Low to high, from dark to light: also in grey, and with any kind of colour vision.
const SEQUENTIAL: [[u8; 3]; 9] = [
    [68, 1, 84],
    [71, 44, 122],
    [59, 81, 139],
    [44, 113, 142],
    [33, 144, 141],
    [39, 173, 129],
    [92, 200, 99],
    [170, 220, 50],
    [253, 231, 37],
];
/// Too dark in blue, right in white, too bright in orange: apart for any kind of colour vision.
const DIVERGING: [[u8; 3]; 9] = [
    [16, 60, 140],
    [50, 110, 190],
    [110, 165, 215],
    [185, 210, 235],
    [245, 245, 245],
    [250, 210, 160],
    [235, 150, 60],
    [200, 95, 10],
    [130, 50, 0],
];
/// Where nothing is known: a grey that is in neither ramp.
const UNKNOWN: [u8; 3] = [58, 58, 62];
/// Decades of luminance in false colours.
const DECADES: f32 = 4.0;
/// The largest luminance in false colours at exposure 0.
const BRIGHTEST: f32 = 10.0;
/// The relative squared errors at the ends of their ramp.
const ERRORS: [f32; 2] = [1e-4, 10.0];
/// Mean stays at the ends of their ramp, in steps.
const DWELLS: [f32; 2] = [1.0, 100.0];
/// Arrivals over the mean at the ends of their ramp.
const VISITS: [f32; 2] = [0.01, 100.0];
/// Relative standard errors at the ends of their ramp.
const SPREADS: [f32; 2] = [1e-3, 1.0];
/// R-hat less one at the ends of its ramp.
const EXCESSES: [f32; 2] = [1e-3, 1.0];
/// Colours of a legend.
pub const BAND: usize = 64;

/// What there is to show.
#[derive(Clone, Copy, Debug)]
pub struct Sources<'a> {
    /// The progressive image.
    pub film: &'a Film,
    /// What it is compared with.
    pub reference: Option<&'a Reference>,
    /// How different it looks from that.
    pub flip: Option<&'a FlipMap>,
    /// What the chains report about parts of the film.
    pub diagnostics: Option<&'a Diagnostics>,
}

/// A series of colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ramp {
    /// From little to much.
    Sequential,
    /// From less through equal to more.
    Diverging,
}

/// What the colours say.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Legend {
    /// Of what.
    pub title: String,
    /// The colours.
    pub ramp: Ramp,
    /// Values at equal distances, from the left to the right.
    pub ticks: Vec<String>,
}

/// The colour at `place`, from 0 to 1, of a ramp; what is no number has a colour of its own.
pub fn ramp_color(ramp: Ramp, place: f32) -> [u8; 3] {
    let colors = match ramp {
        Ramp::Sequential => &SEQUENTIAL,
        Ramp::Diverging => &DIVERGING,
    };
    if place.is_nan() {
        return UNKNOWN;
    }
    let place = place.clamp(0.0, 1.0) * (colors.len() - 1) as f32;
    let index = (place as usize).min(colors.len() - 2);
    let share = place - index as f32;
    let mix = |a: u8, b: u8| (f32::from(a) + share * (f32::from(b) - f32::from(a))).round() as u8;
    let [low, high] = [colors[index], colors[index + 1]];
    [mix(low[0], high[0]), mix(low[1], high[1]), mix(low[2], high[2])]
}

/// Three bytes a pixel, row by row, of what `look` asks for; `None` where there is nothing to show.
pub fn develop(sources: Sources<'_>, look: &ImageSettings) -> Option<Vec<u8>> {
    let film = sources.film;
    match look.layer {
        Layer::Image => Some(tone(&channel(film.rgb(), look.channel), look)),
        Layer::Reference => {
            let reference = sources.reference.filter(|r| r.fits(film))?;
            let rgb: Vec<f32> = reference.pixels.iter().flat_map(|p| p.to_f32()).collect();
            Some(tone(&channel(&rgb, look.channel), look))
        }
        Layer::Difference => {
            let reference = sources.reference.filter(|r| r.fits(film))?;
            let gain = f64::from(look.exposure.stops().exp2());
            let place = |(image, reference): (Rgb, &Rgb)| {
                let difference = gain * (image.luminance() - reference.luminance());
                ramp_color(Ramp::Diverging, (0.5 + 0.5 * difference) as f32)
            };
            Some(film.radiance().into_iter().zip(&reference.pixels).flat_map(place).collect())
        }
        Layer::Error => {
            let errors = sources.reference.filter(|r| r.fits(film))?.errors(film);
            let color = |e: f64| ramp_color(Ramp::Sequential, logarithmic(e as f32, ERRORS));
            Some(errors.into_iter().flat_map(color).collect())
        }
        Layer::Flip => {
            let [width, height] = film.size();
            let map = sources.flip.filter(|map| map.errors.len() == width * height)?;
            Some(map.errors.iter().flat_map(|&e| ramp_color(Ramp::Sequential, e)).collect())
        }
        Layer::Acceptance | Layer::Dwell | Layer::Visits | Layer::Spread | Layer::Disagreement => {
            Some(map(film.size(), sources.diagnostics?, look.layer))
        }
    }
}

/// A map as pixels: each has the colour of its tile.
fn map([width, height]: [usize; 2], diagnostics: &Diagnostics, layer: Layer) -> Vec<u8> {
    let values = map_values(diagnostics, layer);
    let colors: Vec<[u8; 3]> =
        values.iter().map(|&v| ramp_color(Ramp::Sequential, map_place(layer, v))).collect();
    let grid = diagnostics.grid;
    let pixels = (0..height as u32).flat_map(|y| (0..width as u32).map(move |x| (x, y)));
    pixels.flat_map(|(x, y)| colors.get(grid.tile(x, y)).copied().unwrap_or(UNKNOWN)).collect()
}

/// The values of a map's tiles; empty for a layer that is none.
pub fn map_values(diagnostics: &Diagnostics, layer: Layer) -> &[f32] {
    match layer {
        Layer::Acceptance => &diagnostics.maps.acceptance,
        Layer::Dwell => &diagnostics.maps.dwell,
        Layer::Visits => &diagnostics.maps.visits,
        Layer::Spread => &diagnostics.maps.spread,
        Layer::Disagreement => &diagnostics.maps.r_hat,
        Layer::Image | Layer::Reference | Layer::Difference | Layer::Error | Layer::Flip => &[],
    }
}

/// Where a value of a map lies on the ramp; NaN where it is not known.
fn map_place(layer: Layer, value: f32) -> f32 {
    if value < 0.0 {
        return f32::NAN;
    }
    match layer {
        Layer::Dwell => logarithmic(value, DWELLS),
        Layer::Visits => logarithmic(value, VISITS),
        Layer::Spread => logarithmic(value, SPREADS),
        Layer::Disagreement => logarithmic((value - 1.0).max(EXCESSES[0]), EXCESSES),
        _ => value,
    }
}

/// What the colours of `look` say; `None` where they are those of the light itself.
pub fn legend(look: &ImageSettings) -> Option<Legend> {
    match look.layer {
        Layer::Image | Layer::Reference if look.tone == ToneCurve::False => {
            let top = BRIGHTEST / look.exposure.stops().exp2();
            Some(Legend {
                title: "luminance, logarithmic".to_owned(),
                ramp: Ramp::Sequential,
                ticks: decades([top / 10_f32.powf(DECADES), top]),
            })
        }
        Layer::Image | Layer::Reference => None,
        Layer::Difference => {
            let end = format::value((-look.exposure.stops()).exp2());
            Some(Legend {
                title: "darker or brighter than the reference, in luminance".to_owned(),
                ramp: Ramp::Diverging,
                ticks: vec![format!("-{end}"), "0".to_owned(), format!("+{end}")],
            })
        }
        Layer::Error => Some(Legend {
            title: "relative squared error, logarithmic".to_owned(),
            ramp: Ramp::Sequential,
            ticks: decades(ERRORS),
        }),
        Layer::Flip => Some(Legend {
            title: "FLIP: the difference that a person perceives".to_owned(),
            ramp: Ramp::Sequential,
            ticks: ["0", "0.25", "0.5", "0.75", "1"].map(str::to_owned).into(),
        }),
        map => {
            let (title, ticks) = map_legend(map);
            let title = format!("{title}; grey where chains came too seldom");
            Some(Legend { title, ramp: Ramp::Sequential, ticks })
        }
    }
}

fn map_legend(layer: Layer) -> (&'static str, Vec<String>) {
    match layer {
        Layer::Dwell => ("mean stay at a path, in steps", decades(DWELLS)),
        Layer::Visits => ("arrivals, over the mean", decades(VISITS)),
        Layer::Spread => ("relative standard error, from how chains differ", decades(SPREADS)),
        Layer::Disagreement => {
            let excess = [1e-3, 1e-2, 0.1, 1.0].map(|excess: f32| format::value(1.0 + excess));
            ("R-hat between chains; above 1.1 they disagree", excess.into())
        }
        _ => {
            let shares = ["0", "25 %", "50 %", "75 %", "100 %"];
            ("mean acceptance probability", shares.map(str::to_owned).into())
        }
    }
}

/// Every power of ten times the first value.
fn decades([low, high]: [f32; 2]) -> Vec<String> {
    let steps = (high / low).log10().round() as i32;
    (0..=steps).map(|i| format::value(low * 10_f32.powi(i))).collect()
}

/// Where a value lies between two others on a logarithmic scale; zero is where the lower one is.
fn logarithmic(value: f32, [low, high]: [f32; 2]) -> f32 {
    if value == 0.0 { 0.0 } else { (value / low).ln() / (high / low).ln() }
}

/// All of the light, or one part of it as grey.
fn channel(rgb: &[f32], channel: Channel) -> Cow<'_, [f32]> {
    let of: fn(&[f32; 3]) -> f32 = match channel {
        Channel::Rgb => return Cow::Borrowed(rgb),
        Channel::Red => |[r, _, _]| *r,
        Channel::Green => |[_, g, _]| *g,
        Channel::Blue => |[_, _, b]| *b,
        Channel::Luminance => |rgb| Rgb::from(*rgb).luminance() as f32,
    };
    rgb.as_chunks::<3>().0.iter().flat_map(|pixel| [of(pixel); 3]).collect()
}

fn tone(rgb: &[f32], look: &ImageSettings) -> Vec<u8> {
    let scale = look.exposure.stops().exp2();
    match look.tone {
        ToneCurve::Srgb => rgb.iter().map(|v| encode_srgb(v * scale)).collect(),
        ToneCurve::Gamma => {
            let exponent = 1.0 / look.gamma;
            let encode = |v: &f32| (255.0 * (v * scale).clamp(0.0, 1.0).powf(exponent)) as u8;
            rgb.iter().map(encode).collect()
        }
        ToneCurve::False => {
            let ends = [BRIGHTEST / 10_f32.powf(DECADES), BRIGHTEST];
            let color = |p: &[f32; 3]| {
                let luminance = Rgb::from(*p).luminance() as f32;
                ramp_color(Ramp::Sequential, logarithmic(luminance * scale, ends))
            };
            rgb.as_chunks::<3>().0.iter().flat_map(color).collect()
        }
    }
}

#[cfg(test)]
mod tests {
    use common::FilmTile;

    use super::*;
    use crate::value::Exposure;

    fn film(value: f32) -> Film {
        let mut film = Film::default();
        let rgb = vec![value; 12];
        let tile = FilmTile { sequence: 1, width: 2, height: 2, first_row: 0, steps: 1, rgb };
        assert!(film.accept(&tile), "a whole image");
        film
    }

    fn first(film: &Film, reference: Option<f64>, look: &ImageSettings) -> Option<[u8; 3]> {
        let reference = reference.map(|grey| Reference {
            name: String::new(),
            width: 2,
            height: 2,
            pixels: vec![Rgb::grey(grey); 4],
        });
        let sources =
            Sources { film, reference: reference.as_ref(), flip: None, diagnostics: None };
        develop(sources, look).map(|bytes| [bytes[0], bytes[1], bytes[2]])
    }

    #[test]
    fn exposure_counts_in_stops() {
        let look = ImageSettings { exposure: Exposure::Chosen(2.0), ..ImageSettings::default() };
        assert_eq!(first(&film(0.25), None, &look), Some([255; 3]), "a quarter becomes white");
        assert_eq!(first(&film(0.25), None, &ImageSettings::default()), Some([137; 3]), "as is");
        let look = ImageSettings { tone: ToneCurve::Gamma, gamma: 2.0, ..look };
        assert_eq!(first(&film(0.0625), None, &look), Some([127; 3]), "the root of a quarter");
    }

    #[test]
    fn channels_are_shown_alone() {
        let mut film = Film::default();
        let rgb = vec![1.0, 0.25, 0.0];
        let tile = FilmTile { sequence: 1, width: 1, height: 1, first_row: 0, steps: 1, rgb };
        assert!(film.accept(&tile), "a whole image");
        let of =
            |channel| first(&film, None, &ImageSettings { channel, ..ImageSettings::default() });
        assert_eq!(of(Channel::Rgb), Some([255, 137, 0]), "all of it");
        assert_eq!(of(Channel::Red), Some([255; 3]), "red");
        assert_eq!(of(Channel::Green), Some([137; 3]), "green");
        assert_eq!(of(Channel::Blue), Some([0; 3]), "blue");
        let grey = Rgb::from([1.0, 0.25, 0.0]).luminance() as f32;
        assert_eq!(of(Channel::Luminance), Some([encode_srgb(grey); 3]), "luminance");
    }

    #[test]
    fn false_colours_follow_luminance_and_exposure() {
        let look = ImageSettings { tone: ToneCurve::False, ..ImageSettings::default() };
        let at = |value, stops| {
            first(&film(value), None, &ImageSettings { exposure: Exposure::Chosen(stops), ..look })
        };
        assert_eq!(at(10.0, 0.0), Some(SEQUENTIAL[8]), "the brightest");
        assert_eq!(at(0.001, 0.0), Some(SEQUENTIAL[0]), "four decades below");
        assert_eq!(at(2.5, 2.0), at(10.0, 0.0), "two stops are a factor of four");
        let legend = legend(&ImageSettings { exposure: Exposure::Chosen(1.0), ..look })
            .expect("colours need one");
        assert_eq!(legend.ticks.first().map(String::as_str), Some("5.0e-4"), "{legend:?}");
        assert_eq!(legend.ticks.len(), 5, "four decades: {legend:?}");
    }

    #[test]
    fn differences_have_a_sign() {
        let look = ImageSettings { layer: Layer::Difference, ..ImageSettings::default() };
        let at = |value| first(&film(value), Some(0.5), &look).expect("a reference");
        assert_eq!(at(0.5), DIVERGING[4], "equal is white");
        assert!(at(0.9)[0] > at(0.9)[2], "brighter is orange: {:?}", at(0.9));
        assert!(at(0.1)[2] > at(0.1)[0], "darker is blue: {:?}", at(0.1));
        assert_eq!(first(&film(0.5), None, &look), None, "no reference, nothing to show");
    }

    #[test]
    fn maps_colour_their_tiles() {
        let diagnostics = Diagnostics {
            grid: common::TileGrid { side: 1, columns: 2, rows: 2 },
            maps: common::TileMaps {
                acceptance: vec![1.0, 0.0, common::UNKNOWN, 0.5],
                r_hat: vec![1.0, 2.0, 1.001, 50.0],
                ..common::TileMaps::default()
            },
            ..Diagnostics::default()
        };
        let film = film(0.5);
        let of = |layer| {
            let look = ImageSettings { layer, ..ImageSettings::default() };
            let diagnostics = Some(&diagnostics);
            let sources = Sources { film: &film, reference: None, flip: None, diagnostics };
            develop(sources, &look).expect("there are maps")
        };
        let colors = [SEQUENTIAL[8], SEQUENTIAL[0], UNKNOWN, SEQUENTIAL[4]].concat();
        assert_eq!(of(Layer::Acceptance), colors, "four tiles");
        let colors = [SEQUENTIAL[0], SEQUENTIAL[8], SEQUENTIAL[0], SEQUENTIAL[8]].concat();
        assert_eq!(of(Layer::Disagreement), colors, "from agreement to twice the spread");
        assert_eq!(of(Layer::Dwell), UNKNOWN.repeat(4), "a map that is missing");
        let look = ImageSettings { layer: Layer::Visits, ..ImageSettings::default() };
        let sources = Sources { film: &film, reference: None, flip: None, diagnostics: None };
        assert_eq!(develop(sources, &look), None, "no diagnostics, nothing to show");
    }

    #[test]
    fn what_is_no_number_is_seen() {
        assert_eq!(ramp_color(Ramp::Sequential, f32::NAN), UNKNOWN, "not a colour of the ramp");
        assert_eq!(logarithmic(0.0, ERRORS), 0.0, "no error is the least");
    }
}
