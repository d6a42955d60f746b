//! Diffuse paint under a rough transparent coat.

use std::f64::consts::FRAC_1_PI;

use common::{Event, Rgb};
use glam::DVec3;

use super::smooth::untinted;
use crate::bsdf::conductor::facing;
#[cfg(test)]
use crate::bsdf::laws::Specimens;
use crate::bsdf::{Fresnel, Ggx, Scatter, Scattering, reflect};
use crate::math::{Rng, below_one, cosine_hemisphere, invert_cosine_hemisphere};

/// A coat of microfacets over a diffuse base: the sum of a glossy and a diffuse lobe.
///
/// The base gets what the coat leaves: with the coat's directional albedo E it is
/// `color (1 - E(l)) (1 - E(e)) / (pi (1 - mean E))` [Kelemen and Szirmay-Kalos 2001], so that a
/// white base under an untinted coat reflects everything.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoughPlastic {
    /// Colour of the base as seen through the coat, each channel in [0, 1].
    pub diffuse: Rgb,
    /// What a facet of the coat reflects.
    pub fresnel: Fresnel,
    /// How the facets are turned.
    pub facets: Ggx,
    coat: CoatAlbedo,
}

/// How much an untinted coat reflects of light from one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
struct CoatAlbedo {
    /// At cosines that are the squares of evenly spaced numbers: dense where the albedo is steep.
    knots: [f32; KNOTS],
    /// Its mean over a hemisphere of uniform radiance.
    mean: f64,
}

const KNOTS: usize = 24;

/// The albedo of the coat by quadrature over the facets that `cosine` sees.
fn directional_albedo(fresnel: &Fresnel, facets: Ggx, cosine: f64) -> f64 {
    const STEPS: u32 = 24;
    let w = DVec3::new(((1.0 - cosine) * (1.0 + cosine)).max(0.0).sqrt(), 0.0, cosine);
    let middle = |i: u32| (f64::from(i) + 0.5) / f64::from(STEPS);
    let reflected = |i| {
        let half = facets.sample_visible(w, middle(i / STEPS), middle(i % STEPS));
        let onward = reflect(half, w);
        let seen = if onward.z > 0.0 { facets.shadowing(w, onward) } else { 0.0 };
        fresnel.at(w.dot(half)).max_channel() * seen
    };
    (0..STEPS * STEPS).map(reflected).sum::<f64>() / f64::from(STEPS * STEPS)
}

impl CoatAlbedo {
    fn new(fresnel: &Fresnel, facets: Ggx) -> Self {
        let exact = |x: f64| directional_albedo(fresnel, facets, (x * x).max(1e-6));
        let position = |i: usize| i as f64 / (KNOTS - 1) as f64;
        let mut albedo =
            Self { knots: std::array::from_fn(|i| exact(position(i)) as f32), mean: 0.0 };
        // Between knots the table must not tell less than the truth, or energy would be made.
        for i in 0..KNOTS - 1 {
            let x = 0.5 * (position(i) + position(i + 1));
            let short = (exact(x) - albedo.at(x * x)).max(0.0) as f32;
            for knot in &mut albedo.knots[i..=i + 1] {
                *knot = (*knot + short).min(1.0);
            }
        }
        const STEPS: u32 = 2048;
        let cosine = |i| (1.0 - (f64::from(i) + 0.5) / f64::from(STEPS)).sqrt();
        albedo.mean = (0..STEPS).map(|i| albedo.at(cosine(i))).sum::<f64>() / f64::from(STEPS);
        albedo
    }

    #[inline]
    fn at(&self, cosine: f64) -> f64 {
        let position = cosine.sqrt() * (KNOTS - 1) as f64;
        let below = (position as usize).min(KNOTS - 2);
        let share = position - below as f64;
        let (a, b) = (f64::from(self.knots[below]), f64::from(self.knots[below + 1]));
        a + share * (b - a)
    }
}

impl RoughPlastic {
    /// A base of that colour under that coat.
    pub fn new(diffuse: Rgb, fresnel: Fresnel, facets: Ggx) -> Self {
        let coat = CoatAlbedo::new(&untinted(fresnel), facets);
        Self { diffuse, fresnel, facets, coat }
    }

    /// The same coat over a base of another colour.
    pub(super) fn painted(self, diffuse: Rgb) -> Self {
        Self { diffuse, ..self }
    }

    /// The probability that a walk that arrives at an angle samples the coat.
    #[inline]
    fn coated(&self, cosine: f64) -> f64 {
        let albedo = self.coat.at(cosine);
        let coat = albedo * self.tint();
        let base = (1.0 - albedo) * self.diffuse.luminance();
        if coat > 0.0 { coat / (coat + base) } else { 0.0 }
    }

    /// Luminance of the highlight over that of an untinted one.
    #[inline]
    fn tint(&self) -> f64 {
        match self.fresnel {
            Fresnel::Dielectric { tint, .. } => tint.luminance(),
            Fresnel::Constant(_) | Fresnel::Schlick(_) | Fresnel::Conductor { .. } => 1.0,
        }
    }

    /// Density of the direction `b`, given that the walk arrived from `a`.
    #[inline]
    fn density(&self, a: DVec3, b: DVec3, facet_density: f64) -> f64 {
        let coated = self.coated(a.z);
        let glossy = 0.5 * facet_density / (a.z + self.facets.stretch(a));
        coated * glossy + (1.0 - coated) * b.z * FRAC_1_PI
    }
}

impl Scatter for RoughPlastic {
    const NAME: &'static str = "rough plastic";

    fn sample(&self, n: DVec3, w: DVec3, [choice, u, v]: [f64; 3]) -> Option<(DVec3, Event)> {
        let frame = facing(n, w);
        let local = frame.to_local(w);
        let onward = if choice < self.coated(local.z) {
            reflect(self.facets.sample_visible(local, u, v), local)
        } else {
            cosine_hemisphere(u, v)
        };
        let lit = onward.z > 0.0 && local.z > 0.0;
        lit.then(|| (frame.to_world(onward).normalize(), Event::Diffuse))
    }

    fn invert(&self, n: DVec3, w: DVec3, w_out: DVec3, _: Event, rng: &mut Rng) -> [f64; 3] {
        let frame = facing(n, w);
        let (local, onward) = (frame.to_local(w), frame.to_local(w_out));
        let half = (local + onward).normalize();
        let coated = self.coated(local.z);
        let facet_density = self.facets.density(half);
        let glossy = 0.5 * coated * facet_density / (local.z + self.facets.stretch(local));
        // Either lobe may have made it, each with its share of the density.
        let by_coat = rng.uniform() * self.density(local, onward, facet_density) < glossy;
        if by_coat {
            let (u, v) = self.facets.invert_visible(local, half);
            return [below_one(rng.uniform() * coated), u, v];
        }
        let [u, v] = invert_cosine_hemisphere(onward);
        [below_one(coated + rng.uniform() * (1.0 - coated)), u, v]
    }

    fn evaluate(&self, n: DVec3, w_l: DVec3, w_e: DVec3, event: Event) -> Option<Scattering> {
        let frame = facing(n, w_l);
        let (l, e) = (frame.to_local(w_l), frame.to_local(w_e));
        if !(l.z > 0.0 && e.z > 0.0 && event == Event::Diffuse) {
            return None;
        }
        let half = (l + e).normalize();
        let facet_density = self.facets.density(half);
        let glossy = facet_density * self.facets.visibility(l, e);
        let passed = (1.0 - self.coat.at(l.z)) * (1.0 - self.coat.at(e.z));
        let diffuse = passed / (1.0 - self.coat.mean).max(f64::MIN_POSITIVE) * FRAC_1_PI;
        let color = self.fresnel.at(l.dot(half)) * glossy + self.diffuse * diffuse;
        let connection = color.luminance();
        let light_pdf = self.density(l, e, facet_density);
        let eye_pdf = self.density(e, l, facet_density);
        let lit = connection > 0.0 && light_pdf > 0.0 && eye_pdf > 0.0;
        lit.then(|| Scattering {
            color: color / connection,
            connection,
            light_weight: connection * e.z / light_pdf,
            eye_weight: connection * l.z / eye_pdf,
            light_pdf,
            eye_pdf,
        })
    }

    fn specular_direction(&self, _: DVec3, _: DVec3, _: Event) -> Option<DVec3> {
        None
    }

    fn connectable(&self) -> Option<Event> {
        Some(Event::Diffuse)
    }

    fn albedo(&self) -> f64 {
        let coat = self.fresnel.at(1.0);
        let passed = 1.0 - self.coat.at(1.0);
        (coat + self.diffuse * passed).max_channel().min(1.0)
    }

    fn preview_color(&self) -> Rgb {
        self.diffuse
    }
}

#[cfg(test)]
impl Specimens for RoughPlastic {
    const MARGIN: f64 = 5e-3;

    fn specimens() -> Vec<(&'static str, Self)> {
        let red = Rgb::new(0.8, 0.2, 0.05);
        let paint = |diffuse, fresnel, alpha| Self::new(diffuse, fresnel, Ggx::new(alpha));
        let tinted = Fresnel::Dielectric { eta: 1.3, tint: Rgb::new(0.5, 0.4, 0.9) };
        vec![
            ("rough plastic", paint(red, Fresnel::COAT, 0.1)),
            ("white rough plastic", paint(Rgb::WHITE, Fresnel::COAT, 0.4)),
            ("phong", paint(red, Fresnel::Schlick(Rgb::new(0.5, 0.4, 0.3)), 0.2)),
            ("rough tinted coat", paint(red, tinted, 0.6)),
        ]
    }

    /// The coat and the base.
    fn samplers(_: Event) -> u32 {
        2
    }

    fn scatters(&self, _: f64) -> Option<Rgb> {
        (self.diffuse == Rgb::WHITE).then_some(Rgb::WHITE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The table never tells less than the truth by more than a thousandth: that would be energy
    /// from nowhere. At grazing angles its chords lie a little above.
    #[test]
    fn the_table_of_the_coat_is_on_the_safe_side() {
        let coat = Fresnel::Dielectric { eta: 1.5, tint: Rgb::WHITE };
        for alpha in [1e-3, 0.05, 0.3, 1.0] {
            let facets = Ggx::new(alpha);
            let table = CoatAlbedo::new(&coat, facets);
            for i in 1..200 {
                let cosine = f64::from(i) / 200.0;
                let excess = table.at(cosine) - directional_albedo(&coat, facets, cosine);
                assert!((-1e-3..3e-2).contains(&excess), "{alpha}, {cosine}: {excess}");
            }
        }
        let smooth = Fresnel::mean(&coat).g;
        let mean = CoatAlbedo::new(&coat, Ggx::new(1e-3)).mean;
        assert!((mean - smooth).abs() < 0.02, "{mean} of {smooth}");
    }
}
