//! Textures as the tracer reads them.

use std::sync::Arc;

use common::{Rgb, TexturePreview};
use glam::{DAffine2, DVec2};

use crate::bsdf::{ColorInput, Inputs, NumberInput};
use crate::scene::description::{Coding, Texels, Texture};

/// A texture with its codes decoded on the way.
#[derive(Debug)]
pub(super) struct Map {
    width: usize,
    height: usize,
    content: Content,
    /// From a surface's coordinates, where they are not the image's own.
    placing: Option<DAffine2>,
}

/// The values of a map.
#[derive(Debug)]
enum Content {
    /// Codes, and the number that each stands for.
    Codes(Arc<[[u8; 3]]>, Box<[f64; 256]>),
    /// Numbers.
    Numbers(Arc<[[f32; 3]]>),
}

impl Map {
    pub(super) fn new(texture: &Texture) -> Self {
        let content = match &texture.texels {
            Texels::Codes(codes, coding) => {
                let mut decoded = Box::new([0.0; 256]);
                for (code, value) in (0_u8..=255).zip(decoded.iter_mut()) {
                    *value = coding.decode(code);
                }
                Content::Codes(Arc::clone(codes), decoded)
            }
            Texels::Numbers(numbers) => Content::Numbers(Arc::clone(numbers)),
        };
        let placing = Some(texture.placing).filter(|placing| *placing != DAffine2::IDENTITY);
        Self { width: texture.width as usize, height: texture.height as usize, content, placing }
    }

    /// The colour at a point by bilinear interpolation between the four texels around it; the image
    /// repeats in both directions.
    pub(super) fn at(&self, uv: DVec2) -> Rgb {
        let uv = self.placing.map_or(uv, |placing| placing.transform_point2(uv));
        let (x, x_next, across) = neighbours(uv.x, self.width);
        let (y, y_next, down) = neighbours(1.0 - uv.y, self.height);
        let row = |y: usize| {
            let (left, right) = (self.texel(x, y), self.texel(x_next, y));
            left * (1.0 - across) + right * across
        };
        row(y) * (1.0 - down) + row(y_next) * down
    }

    /// The map times `factor` as small as viewers want it: each texel is the mean of a block.
    pub(super) fn preview(&self, factor: Rgb) -> TexturePreview {
        let side = self.width.max(self.height).div_ceil(TexturePreview::MAX_SIDE as usize).max(1);
        let (width, height) = (self.width.div_ceil(side), self.height.div_ceil(side));
        let block = |first: usize, count: usize| first * side..((first + 1) * side).min(count);
        let mean = |(x, y): (usize, usize)| {
            if self.placing.is_some() {
                // As it lies on a surface whose coordinates run once from 0 to 1.
                let at = |i: usize, count: usize| (i as f64 + 0.5) / count as f64;
                let color = self.at(DVec2::new(at(x, width), 1.0 - at(y, height))) * factor;
                return [color.r, color.g, color.b].map(Coding::encode_srgb);
            }
            let (columns, rows) = (block(x, self.width), block(y, self.height));
            let count = columns.len() * rows.len();
            let places = rows.flat_map(|y| columns.clone().map(move |x| (x, y)));
            let sum = places.fold(Rgb::BLACK, |sum, (x, y)| sum + self.texel(x, y));
            let mean = sum * (1.0 / count as f64) * factor;
            [mean.r, mean.g, mean.b].map(Coding::encode_srgb)
        };
        let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        TexturePreview {
            width: width as u32,
            height: height as u32,
            texels: places.map(mean).collect(),
        }
    }

    fn texel(&self, x: usize, y: usize) -> Rgb {
        let index = y * self.width + x;
        match &self.content {
            Content::Codes(codes, decoded) => {
                let [r, g, b] = codes[index].map(|code| decoded[usize::from(code)]);
                Rgb::new(r, g, b)
            }
            Content::Numbers(numbers) => Rgb::from(numbers[index]),
        }
    }
}

/// The two texels around a coordinate, and the share of the second.
fn neighbours(coordinate: f64, count: usize) -> (usize, usize, f64) {
    // Texels have their values in their middles.
    let position = coordinate.rem_euclid(1.0) * count as f64 - 0.5;
    let below = position.floor();
    let first = (below + count as f64) as usize % count;
    (first, (first + 1) % count, position - below)
}

/// Inputs at a point of a surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Painted<'a> {
    /// The scene's textures.
    pub(super) maps: &'a [Map],
    /// The point's texture coordinates.
    pub(super) uv: DVec2,
}

impl Painted<'_> {
    /// The colour of a texture; black where there is none.
    fn texel(&self, texture: u16) -> Rgb {
        self.maps.get(usize::from(texture)).map_or(Rgb::BLACK, |map| map.at(self.uv))
    }
}

impl Inputs for Painted<'_> {
    fn color(&self, input: ColorInput) -> Rgb {
        match input {
            ColorInput::Constant(color) => color,
            ColorInput::Texture { texture, factor } => self.texel(texture) * factor,
        }
    }

    fn number(&self, input: NumberInput) -> f64 {
        match input {
            NumberInput::Constant(number) => number,
            NumberInput::Texture { texture, factor } => self.texel(texture).luminance() * factor,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn checks() -> Map {
        Map::new(&Texture {
            name: "checks".to_owned(),
            width: 2,
            height: 2,
            texels: Texels::Codes(
                vec![[255, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 255]].into(),
                Coding::Linear,
            ),
            placing: DAffine2::IDENTITY,
        })
    }

    #[test]
    fn texels_lie_row_by_row_from_the_top() {
        let map = checks();
        let at = |u, v| map.at(DVec2::new(u, v));
        assert_eq!(at(0.25, 0.75), Rgb::new(1.0, 0.0, 0.0), "the first one is at the top left");
        assert_eq!(at(0.75, 0.25), Rgb::new(0.0, 0.0, 1.0), "the last one at the bottom right");
        assert_eq!(at(0.5, 0.5), Rgb::new(0.25, 0.0, 0.25), "the middle is the mean of all");
    }

    #[test]
    fn a_preview_is_small_and_as_bright() {
        let texels: Vec<_> =
            (0..1030 * 3).map(|i| if i % 2 == 0 { [255; 3] } else { [0; 3] }).collect();
        let map = Map::new(&Texture {
            name: "stripes".to_owned(),
            width: 1030,
            height: 3,
            texels: Texels::Codes(texels.into(), Coding::Linear),
            placing: DAffine2::IDENTITY,
        });
        let preview = map.preview(Rgb::new(1.0, 0.5, 0.0));
        assert_eq!((preview.width, preview.height, preview.texels.len()), (344, 1, 344), "small");
        // Every other column is white: two of the first three, and one of the next.
        let code = |share: f64| [share, 0.5 * share, 0.0].map(Coding::encode_srgb);
        assert_eq!(preview.texels[..2], [code(2.0 / 3.0), code(1.0 / 3.0)], "the first blocks");
        let whole = checks().preview(Rgb::WHITE);
        assert_eq!(whole.texels, [[255, 0, 0], [0; 3], [0; 3], [0, 0, 255]], "kept as it is");
    }

    #[test]
    fn the_image_repeats_without_a_seam() {
        let map = checks();
        for (u, v) in [(0.1, 0.9), (0.0, 0.0), (0.999, 0.3)] {
            let here = map.at(DVec2::new(u, v));
            for (du, dv) in [(1.0, 0.0), (-3.0, 2.0), (0.0, -1.0)] {
                let there = map.at(DVec2::new(u + du, v + dv));
                assert!((here.r - there.r).abs() + (here.b - there.b).abs() < 1e-12, "{u} {v}");
            }
        }
        let (left, right) = (map.at(DVec2::new(1e-9, 0.75)), map.at(DVec2::new(1.0 - 1e-9, 0.75)));
        assert!((left.r - right.r).abs() < 1e-6, "{left:?} {right:?}");
        // A coordinate just below zero is rounded up to one.
        assert!(map.at(DVec2::splat(-1e-30)).is_physical(), "no texel beyond the last");
    }
}
