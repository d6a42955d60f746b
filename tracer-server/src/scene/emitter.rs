//! The lights: emitting triangles and spheres, chosen in proportion to their power.

use common::Rgb;

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
#[derive(Clone, Debug, Default)]
pub(crate) struct Emitters {
    list: Vec<Emitter>,
    /// Cumulated probabilities; the last one is 1.
    cumulative: Vec<f64>,
}

impl Emitters {
    /// Emitters from `(primitive, radiance, area)`, in order.
    pub(crate) fn new(sources: &[(u32, Rgb, f64)]) -> Self {
        let power = |radiance: Rgb, area: f64| radiance.luminance() * area;
        let total: f64 = sources.iter().map(|&(_, radiance, area)| power(radiance, area)).sum();
        let mut sum = 0.0;
        let mut emitters = Self::default();
        for &(primitive, radiance, area) in sources {
            let probability = power(radiance, area) / total;
            sum += probability;
            emitters.list.push(Emitter { primitive, radiance, area, probability });
            emitters.cumulative.push(sum);
        }
        if let Some(last) = emitters.cumulative.last_mut() {
            *last = 1.0;
        }
        emitters
    }

    pub(crate) fn list(&self) -> &[Emitter] {
        &self.list
    }

    /// The emitter that owns `u` in [0, 1). There is at least one in a scene.
    #[inline]
    pub(crate) fn choose(&self, u: f64) -> u32 {
        let index = self.cumulative.partition_point(|&c| c <= u);
        index.min(self.list.len() - 1) as u32
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
