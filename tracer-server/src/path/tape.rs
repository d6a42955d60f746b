//! The numbers that would have made a path.

use arrayvec::ArrayVec;

use super::numbers::ROW;
use super::{MAX_VERTICES, Path, Strand};
use crate::math::Rng;
use crate::scene::Tracer;

/// Rows of numbers for the walks of a path from both ends, in the order of [`Strand`]'s rows.
#[derive(Clone, Debug, Default)]
pub struct Tape {
    light: ArrayVec<[f64; ROW], MAX_VERTICES>,
    eye: ArrayVec<[f64; ROW], MAX_VERTICES>,
}

impl Tape {
    /// Writes numbers from which two walks make `x` with `light` vertices on the light side.
    ///
    /// The inverse of the walks: where many numbers would do, as for the choice of an event or of a
    /// light, `rng` draws one uniformly. `None` where the split cannot make the path. In place, since
    /// a tape is too long to be handed around.
    pub fn record(
        &mut self,
        scene: &Tracer<'_>,
        x: &Path,
        light: usize,
        rng: &mut Rng,
    ) -> Option<()> {
        self.light.clear();
        self.eye.clear();
        self.invert_light_walk(scene, x, light, rng)?;
        self.invert_eye_walk(scene, x, x.edge_count() - light, rng);
        Some(())
    }

    fn invert_light_walk(
        &mut self,
        scene: &Tracer<'_>,
        x: &Path,
        count: usize,
        rng: &mut Rng,
    ) -> Option<()> {
        let [start, next, ..] = x.vertices() else { return None };
        let start = start.light_sample();
        if count > 0 {
            let [choice, u, v] = scene.invert_light(&start, rng)?;
            self.light.push([choice, u, v, 0.0]);
        }
        if count > 1 {
            let [u, v] = scene.invert_emission(&start, x.edges()[0].direction, next.position);
            self.light.push([u, v, 0.0, 0.0]);
        }
        // The event of the last vertex of a walk is no draw: the connection decides it.
        for j in 1..count.saturating_sub(1) {
            let (back, onward) = (-x.edges()[j - 1].direction, x.edges()[j].direction);
            let at = &x.vertices()[j];
            let local = scene.local(&at.anchor(), at.material);
            let [event, u, v] = local.invert(back, onward, at.event, rng);
            self.light.push([event, u, v, 0.0]);
        }
        Some(())
    }

    fn invert_eye_walk(&mut self, scene: &Tracer<'_>, x: &Path, count: usize, rng: &mut Rng) {
        let (k, camera) = (x.edge_count(), scene.camera());
        if camera.has_aperture() {
            let [u, v] = camera.invert_lens_point(x.vertices()[k].position);
            self.eye.push([x.film().x, x.film().y, u, v]);
        } else if count > 0 {
            self.eye.push([x.film().x, x.film().y, 0.0, 0.0]);
        }
        for j in (k - count + 1..k).rev() {
            let (back, onward) = (x.edges()[j].direction, -x.edges()[j - 1].direction);
            let at = &x.vertices()[j];
            let local = scene.local(&at.anchor(), at.material);
            let [event, u, v] = local.invert(back, onward, at.event, rng);
            self.eye.push([event, u, v, 0.0]);
        }
    }

    /// The row number `row` of a walk; `None` beyond its end.
    #[inline]
    pub fn row(&self, strand: Strand, row: usize) -> Option<&[f64; ROW]> {
        match strand {
            Strand::Light => self.light.get(row),
            Strand::Eye => self.eye.get(row),
            Strand::Connection => None,
        }
    }

    /// All rows of both walks, to be spoilt.
    #[cfg(test)]
    pub(crate) fn rows_mut(&mut self) -> impl Iterator<Item = (Strand, usize, &mut [f64; ROW])> {
        let light = self.light.iter_mut().enumerate().map(|(i, row)| (Strand::Light, i, row));
        light.chain(self.eye.iter_mut().enumerate().map(|(i, row)| (Strand::Eye, i, row)))
    }
}
