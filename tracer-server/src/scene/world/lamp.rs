//! Lights without a surface: points, spots, the sun and the sky.
//!
//! The start of a path on one of them is a vertex without a primitive. A point or a spot has a
//! position; the sun and the sky are infinitely far away: their vertex is a direction, its `normal`
//! is the direction in which the light travels, and its position only serves to draw it.

use std::f64::consts::{PI, TAU};

use common::Rgb;
use glam::DVec3;

use super::sky::Sky;
use crate::math::{
    Frame, cosine_hemisphere, invert_cosine_hemisphere, invert_uniform_sphere, uniform_sphere,
};

/// What a path gets from the light that it starts on.
///
/// The density of the start is per area on a surface, per solid angle for the sky, and a
/// probability for points, spots and the sun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Emission {
    /// Radiance of a surface or the sky, intensity of a point or spot, irradiance of the sun.
    pub color: Rgb,
    /// Density with which [`super::Scene::sample_light`] draws the start.
    pub pdf: f64,
    /// Scalar for an explicit connection to the start.
    pub connection: f64,
    /// Scalar for a walk from the start: value over the density of [`super::Scene::emit`], in sr on
    /// surfaces, points and spots, in area for infinite lights.
    pub walk: f64,
    /// True when a walk from the eye can hit it.
    pub hittable: bool,
}

/// A ball that holds every surface of the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounds {
    pub(crate) centre: DVec3,
    pub(crate) radius: f64,
}

/// A light without a surface, in scene units.
#[derive(Clone, Debug)]
pub(crate) enum Lamp {
    /// Shines equally in all directions.
    Point { position: DVec3, intensity: Rgb },
    /// Shines into a cone.
    Spot { position: DVec3, intensity: Rgb, cone: Cone },
    /// Parallel light.
    Sun { direction: DVec3, irradiance: Rgb },
    /// Light from all around.
    Sky(Sky),
}

/// The cone of a spot light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cone {
    /// Unit direction of its middle.
    pub(crate) axis: DVec3,
    /// Cosine of the half angle beyond which it is dark.
    pub(crate) cos_cutoff: f64,
    /// Cosine of the half angle up to which it is fully bright; at least `cos_cutoff`.
    pub(crate) cos_beam: f64,
}

impl Cone {
    /// Solid angle.
    fn solid_angle(&self) -> f64 {
        TAU * (1.0 - self.cos_cutoff)
    }

    /// Share of the full intensity in a direction: falls smoothly from the beam to the rim.
    fn falloff(&self, direction: DVec3) -> f64 {
        let cosine = self.axis.dot(direction);
        if cosine >= self.cos_beam {
            1.0
        } else if cosine > self.cos_cutoff {
            let t = (cosine - self.cos_cutoff) / (self.cos_beam - self.cos_cutoff);
            t * t * (3.0 - 2.0 * t)
        } else {
            0.0
        }
    }

    /// The mean of [`Cone::falloff`] over the cone: the smooth step takes the middle between its
    /// ends, since it is as much above the straight line as below it.
    fn mean_falloff(&self) -> f64 {
        let beam = 1.0 - self.cos_beam;
        let rim = self.cos_beam - self.cos_cutoff;
        (beam + 0.5 * rim) / (beam + rim)
    }

    /// A direction with uniform density in the cone.
    fn sample(&self, [u, v]: [f64; 2]) -> DVec3 {
        let down = u * (1.0 - self.cos_cutoff);
        let radius = (down * (2.0 - down)).max(0.0).sqrt();
        let (sin, cos) = (TAU * v).sin_cos();
        Frame::new(self.axis).to_world(DVec3::new(radius * cos, radius * sin, 1.0 - down))
    }

    /// The numbers from which [`Cone::sample`] makes `direction`.
    fn invert(&self, direction: DVec3) -> [f64; 2] {
        let local = Frame::new(self.axis).to_local(direction);
        let [_, v] = invert_uniform_sphere(local);
        // The cosine has no digits left of a narrow angle; the sine has.
        let sin_squared = local.x * local.x + local.y * local.y;
        let down = if local.z > 0.0 { sin_squared / (1.0 + local.z) } else { 1.0 - local.z };
        [crate::math::below_one(down / (1.0 - self.cos_cutoff)), v]
    }
}

impl Lamp {
    /// True for the lights whose start is a direction, not a point.
    pub(crate) fn is_infinite(&self) -> bool {
        matches!(self, Self::Sun { .. } | Self::Sky(_))
    }

    /// A word for people.
    pub(crate) fn kind(&self) -> &'static str {
        match self {
            Self::Point { .. } => "point light",
            Self::Spot { .. } => "spot light",
            Self::Sun { .. } => "directional light",
            Self::Sky(_) => "environment",
        }
    }

    /// Its colour as people would call it: intensity, irradiance or mean radiance.
    pub(crate) fn color(&self) -> Rgb {
        match self {
            Self::Point { intensity, .. } | Self::Spot { intensity, .. } => *intensity,
            Self::Sun { irradiance, .. } => *irradiance,
            Self::Sky(sky) => sky.mean(),
        }
    }

    /// Flux that it sends into the scene, divided by pi like that of the surfaces.
    pub(crate) fn power(&self, bounds: &Bounds) -> f64 {
        let disk = bounds.radius * bounds.radius;
        match self {
            Self::Point { intensity, .. } => 4.0 * intensity.luminance(),
            Self::Spot { intensity, cone, .. } => {
                intensity.luminance() * cone.solid_angle() / PI * cone.mean_falloff()
            }
            Self::Sun { irradiance, .. } => irradiance.luminance() * disk,
            Self::Sky(sky) => 4.0 * PI * sky.mean().luminance() * disk,
        }
    }

    /// Divides what it emits by a power of two.
    pub(crate) fn dim(&mut self, divisor: f64) {
        match self {
            Self::Point { intensity, .. } | Self::Spot { intensity, .. } => {
                *intensity = *intensity / divisor;
            }
            Self::Sun { irradiance, .. } => *irradiance = *irradiance / divisor,
            Self::Sky(sky) => sky.dim(divisor),
        }
    }

    /// The start of a path, made of two numbers: position and normal. That of an infinite light
    /// has a position only to be drawn.
    pub(crate) fn sample(&self, u: [f64; 2], bounds: &Bounds) -> (DVec3, DVec3) {
        let far = |travel: DVec3| (bounds.centre - 2.0 * bounds.radius * travel, travel);
        match self {
            Self::Point { position, .. } => (*position, DVec3::Z),
            Self::Spot { position, cone, .. } => (*position, cone.axis),
            Self::Sun { direction, .. } => far(*direction),
            Self::Sky(sky) => far(-sky.sample(u)),
        }
    }

    /// The numbers from which [`Lamp::sample`] makes a start with this normal; `None` where any
    /// would do.
    pub(crate) fn invert(&self, normal: DVec3) -> Option<[f64; 2]> {
        match self {
            Self::Sky(sky) => Some(sky.invert(-normal)),
            Self::Point { .. } | Self::Spot { .. } | Self::Sun { .. } => None,
        }
    }

    /// Where a ray of light begins and in which direction it goes, made of two numbers.
    ///
    /// Infinite lights shine on a disk that faces them and covers the scene
    /// [Pharr, Jakob and Humphreys 2023, section 12.5].
    pub(crate) fn emit(
        &self,
        position: DVec3,
        normal: DVec3,
        u: [f64; 2],
        bounds: &Bounds,
    ) -> (DVec3, DVec3) {
        match self {
            Self::Point { .. } => (position, uniform_sphere(u[0], u[1])),
            Self::Spot { cone, .. } => (position, cone.sample(u)),
            Self::Sun { .. } | Self::Sky(_) => {
                let disk = cosine_hemisphere(u[0], u[1]).with_z(-2.0) * bounds.radius;
                (bounds.centre + Frame::new(normal).to_world(disk), normal)
            }
        }
    }

    /// The numbers from which [`Lamp::emit`] makes a ray in `direction` that meets `next`.
    pub(crate) fn invert_emission(
        &self,
        direction: DVec3,
        next: DVec3,
        bounds: &Bounds,
    ) -> [f64; 2] {
        match self {
            Self::Point { .. } => invert_uniform_sphere(direction),
            Self::Spot { cone, .. } => cone.invert(direction),
            Self::Sun { .. } | Self::Sky(_) => {
                let local = Frame::new(direction).to_local(next - bounds.centre);
                invert_cosine_hemisphere(local / bounds.radius)
            }
        }
    }

    /// What a path gets that leaves it in `direction`; `None` where that is nothing. The density of
    /// its start is still without the probability of choosing this light.
    pub(crate) fn emission(&self, direction: DVec3, bounds: &Bounds) -> Option<Emission> {
        let disk = PI * bounds.radius * bounds.radius;
        match self {
            Self::Point { intensity, .. } => Some(Emission {
                color: *intensity,
                pdf: 1.0,
                connection: 1.0,
                walk: 4.0 * PI,
                hittable: false,
            }),
            Self::Spot { intensity, cone, .. } => {
                let falloff = cone.falloff(direction);
                (falloff > 0.0).then(|| Emission {
                    color: *intensity,
                    pdf: 1.0,
                    connection: falloff,
                    walk: falloff * cone.solid_angle(),
                    hittable: false,
                })
            }
            Self::Sun { irradiance, .. } => Some(Emission {
                color: *irradiance,
                pdf: 1.0,
                connection: 1.0,
                walk: disk,
                hittable: false,
            }),
            Self::Sky(sky) => {
                let (color, pdf) = sky.evaluate(-direction);
                (!color.is_black()).then_some(Emission {
                    color,
                    pdf,
                    connection: 1.0,
                    walk: disk,
                    hittable: true,
                })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use ::tests::{Accumulator, chi_square_test};

    use super::*;
    use crate::math::{Rng, Stream};

    fn cone() -> Cone {
        let axis = DVec3::new(0.3, -0.8, 0.2).normalize();
        Cone { axis, cos_cutoff: 0.8, cos_beam: 0.95 }
    }

    #[test]
    fn a_cone_is_sampled_evenly_and_inverted() {
        let cone = cone();
        let mut rng = Rng::new(3, Stream::Laboratory, 0);
        let (mut observed, mut falloff) = (vec![0_u64; 20], Accumulator::default());
        for _ in 0..50_000 {
            let u = rng.array();
            let direction = cone.sample(u);
            let again = cone.invert(direction);
            let turn = (again[1] - u[1]).abs();
            assert!(
                (again[0] - u[0]).abs() < 1e-9 && turn.min(1.0 - turn) < 1e-7,
                "{again:?} {u:?}"
            );
            // Uniform in solid angle is uniform in the cosine.
            let share = (1.0 - cone.axis.dot(direction)) / (1.0 - cone.cos_cutoff);
            observed[((share * 20.0) as usize).min(19)] += 1;
            falloff.push(cone.falloff(direction));
        }
        let result = chi_square_test(&observed, &[2500.0; 20], 20.0).expect("valid counts");
        assert!(result.p_value > 1e-7, "p = {:e}", result.p_value);
        let off = falloff.mean() - cone.mean_falloff();
        assert!(off.abs() < 5.5 * falloff.standard_error(), "mean fall-off is off by {off}");
    }

    /// A spot as narrow as a laser keeps its numbers.
    #[test]
    fn a_narrow_cone_is_inverted() {
        let cos_cutoff = 1.0 - 0.5e-8;
        let cone = Cone { cos_cutoff, cos_beam: cos_cutoff, ..cone() };
        for u in [[0.0, 0.2], [0.3, 0.9], [0.999, 0.5]] {
            let again = cone.invert(cone.sample(u));
            assert!((again[0] - u[0]).abs() < 1e-6, "{again:?} instead of {u:?}");
        }
    }
}
