//! The lights: emitting triangles and spheres, then lights without a surface, chosen in proportion to
//! their power.

use common::Rgb;

use super::lamp::{Bounds, Lamp};

/// One emitting primitive.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Emitter {
    pub(crate) primitive: u32,
    /// Radiance on the front side.
    pub(crate) radiance: Rgb,
    pub(crate) area: f64,
    /// Probability of being chosen.
    pub(crate) probability: f64,
}

/// All emitters with a table to choose among them.
#[derive(Clone, Debug)]
pub(crate) struct Emitters {
    list: Vec<Emitter>,
    lamps: Vec<Lamp>,
    bounds: Bounds,
    /// Cumulated probabilities of the surfaces, then of the lamps; the last one is 1.
    cumulative: Vec<f64>,
    /// Which of the lamps is the sky.
    sky: Option<u16>,
}

impl Emitters {
    /// Emitters from `(primitive, radiance, area)`, in order, and lamps.
    pub(crate) fn new(sources: &[(u32, Rgb, f64)], lamps: Vec<Lamp>, bounds: Bounds) -> Self {
        let power = |radiance: Rgb, area: f64| radiance.luminance() * area;
        let of_surfaces: f64 =
            sources.iter().map(|&(_, radiance, area)| power(radiance, area)).sum();
        let total = of_surfaces + lamps.iter().map(|lamp| lamp.power(&bounds)).sum::<f64>();
        let mut sum = 0.0;
        let (mut list, mut cumulative) = (Vec::new(), Vec::new());
        for &(primitive, radiance, area) in sources {
            let probability = power(radiance, area) / total;
            sum += probability;
            list.push(Emitter { primitive, radiance, area, probability });
            cumulative.push(sum);
        }
        for lamp in &lamps {
            sum += lamp.power(&bounds) / total;
            cumulative.push(sum);
        }
        if let Some(last) = cumulative.last_mut() {
            *last = 1.0;
        }
        let sky = lamps.iter().position(|lamp| matches!(lamp, Lamp::Sky(_)));
        let sky = sky.and_then(|index| u16::try_from(index).ok());
        Self { list, lamps, bounds, cumulative, sky }
    }

    /// All lights without a surface.
    pub(crate) fn lamps(&self) -> &[Lamp] {
        &self.lamps
    }

    /// The ball that holds the scene.
    pub(crate) fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    /// Which of the lamps is the sky.
    #[inline]
    pub(crate) fn sky(&self) -> Option<u16> {
        self.sky
    }

    /// The number among all lights of the lamp `lamp`.
    pub(crate) fn number_of_lamp(&self, lamp: usize) -> u32 {
        (self.list.len() + lamp) as u32
    }

    /// Probability of choosing the lamp `lamp`.
    #[inline]
    pub(crate) fn lamp_probability(&self, lamp: usize) -> f64 {
        let (from, to) = self.share(self.number_of_lamp(lamp));
        to - from
    }

    pub(crate) fn list(&self) -> &[Emitter] {
        &self.list
    }

    /// The light that owns `u` in [0, 1): first the surfaces, then the lamps. There is at least one
    /// in a scene.
    #[inline]
    pub(crate) fn choose(&self, u: f64) -> u32 {
        let index = self.cumulative.partition_point(|&c| c <= u);
        index.min(self.cumulative.len() - 1) as u32
    }

    /// The numbers for which [`Emitters::choose`] gives the emitter `index`: from, and up to.
    pub(crate) fn share(&self, index: u32) -> (f64, f64) {
        let index = index as usize;
        let from = index.checked_sub(1).map_or(0.0, |before| self.cumulative[before]);
        (from, self.cumulative[index])
    }

    #[inline]
    pub(crate) fn get(&self, index: u32) -> Option<&Emitter> {
        self.list.get(index as usize)
    }
}
