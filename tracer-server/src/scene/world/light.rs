//! What paths ask of the lights, with or without a surface.

use std::f64::consts::PI;

use common::Rgb;
use glam::DVec3;

use super::lamp::{Emission, Lamp};
use super::{Anchor, NO_PRIMITIVE, Scene};
use crate::math::{Frame, Rng, below_one, cosine_hemisphere, invert_cosine_hemisphere};

/// The start of a path, with all that it needs of it.
#[derive(Clone, Copy, Debug)]
pub struct LightSample {
    /// Where it is. That of a light without a surface has no primitive; its normal is the axis of
    /// a spot, and the direction of travel of infinite lights.
    pub anchor: Anchor,
    /// Index of its material; behind those of the surfaces come the lights without one.
    pub material: u16,
}

/// A light without a surface, for people.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LampInfo<'a> {
    /// Its name in the scene file.
    pub name: &'a str,
    /// What it is.
    pub kind: &'static str,
    /// Intensity of points and spots, irradiance of the sun, mean radiance of the environment, in
    /// the units of the file.
    pub color: Rgb,
    /// Flux into the scene, in luminance and units of the file.
    pub power: f64,
}

impl Scene {
    /// All lights without a surface.
    pub fn lamps(&self) -> impl Iterator<Item = LampInfo<'_>> {
        let bounds = self.emitters.bounds();
        let area = self.frame().scale * self.frame().scale;
        self.emitters.lamps().iter().zip(&self.lamp_names).map(move |(lamp, name)| {
            let per_area = if lamp.is_infinite() { 1.0 } else { area };
            LampInfo {
                name,
                kind: lamp.kind(),
                color: lamp.color() * (self.radiance_scale() / per_area),
                power: PI * lamp.power(bounds) * self.radiance_scale() / area,
            }
        })
    }

    /// What a path gets that leaves a light in the unit `direction`. The light is the surface
    /// `primitive`, or, without one, the lamp that `material` names. `None` where there is no light
    /// or where it is dark; the back of a surface is not tested for.
    #[inline]
    pub fn emission(&self, primitive: u32, material: u16, direction: DVec3) -> Option<Emission> {
        if primitive == NO_PRIMITIVE {
            return self.lamp_emission(material, direction);
        }
        let emitter = self.emitters.get(self.primitives.get(primitive as usize)?.emitter)?;
        Some(Emission {
            color: emitter.radiance,
            pdf: emitter.probability / emitter.area,
            connection: 1.0,
            // Drawn with density cos / pi.
            walk: PI,
            hittable: true,
        })
    }

    fn lamp_emission(&self, material: u16, direction: DVec3) -> Option<Emission> {
        let (index, lamp) = self.lamp(material)?;
        let mut emission = lamp.emission(direction, self.emitters.bounds())?;
        emission.pdf *= self.emitters.lamp_probability(index);
        Some(emission)
    }

    /// True when the surface is a light.
    #[inline]
    pub fn is_light(&self, primitive: u32) -> bool {
        let emitter = self.primitives.get(primitive as usize).map(|p| p.emitter);
        emitter.is_some_and(|emitter| self.emitters.get(emitter).is_some())
    }

    /// The lamp that a material index names.
    #[inline]
    fn lamp(&self, material: u16) -> Option<(usize, &Lamp)> {
        let index = usize::from(material).checked_sub(self.surfaces.len())?;
        Some((index, self.emitters.lamps().get(index)?))
    }

    /// True when the start on this lamp is a direction, not a point.
    #[inline]
    pub fn is_infinite(&self, material: u16) -> bool {
        self.lamp(material).is_some_and(|(_, lamp)| lamp.is_infinite())
    }

    /// The material index of the sky, if there is one.
    #[inline]
    pub fn sky(&self) -> Option<u16> {
        Some(self.surfaces.len() as u16 + self.emitters.sky()?)
    }

    /// A point outside of the scene that is seen from `from` in the unit `direction`.
    pub fn far_from(&self, from: DVec3, direction: DVec3) -> Anchor {
        let bounds = self.emitters.bounds();
        let reach = (from - bounds.centre).length() + 2.0 * bounds.radius;
        Anchor { position: from + reach * direction, normal: -direction, primitive: NO_PRIMITIVE }
    }

    /// The start of a path with the density that [`Emission::pdf`] tells, made of uniform numbers:
    /// the first chooses the light, the other two the point on it or the direction.
    #[inline]
    pub fn sample_light(&self, [choice, u, v]: [f64; 3]) -> LightSample {
        let index = self.emitters.choose(choice) as usize;
        let Some(emitter) = self.emitters.list().get(index) else {
            return self.sample_lamp(index - self.emitters.list().len(), [u, v]);
        };
        let primitive = emitter.primitive;
        let triangles = self.accel.triangles();
        let (position, normal) = match triangles.get(primitive as usize) {
            Some(triangle) => (triangle.sample(u, v), triangle.normal),
            None => self.accel.balls()[primitive as usize - triangles.len()].sample(u, v),
        };
        let anchor = Anchor { position, normal, primitive };
        LightSample { anchor, material: self.material_of(primitive) }
    }

    fn sample_lamp(&self, index: usize, u: [f64; 2]) -> LightSample {
        let lamp = &self.emitters.lamps()[index];
        let (position, normal) = lamp.sample(u, self.emitters.bounds());
        let anchor = Anchor { position, normal, primitive: NO_PRIMITIVE };
        LightSample { anchor, material: (self.surfaces.len() + index) as u16 }
    }

    /// Numbers from which [`Scene::sample_light`] would have made the start `at` of a path; `None`
    /// where there is no light. Among the many numbers that do, `rng` draws one uniformly.
    pub fn invert_light(&self, at: &LightSample, rng: &mut Rng) -> Option<[f64; 3]> {
        let primitive = at.anchor.primitive;
        let (number, [u, v]) = if primitive == NO_PRIMITIVE {
            let (index, lamp) = self.lamp(at.material)?;
            let point = lamp.invert(at.anchor.normal).unwrap_or_else(|| rng.array());
            (self.emitters.number_of_lamp(index), point)
        } else {
            let emitter = self.primitives.get(primitive as usize)?.emitter;
            self.emitters.get(emitter)?;
            let triangles = self.accel.triangles();
            let position = at.anchor.position;
            let point = if let Some(triangle) = triangles.get(primitive as usize) {
                triangle.invert(position)
            } else {
                self.accel.balls()[primitive as usize - triangles.len()].invert(position)
            };
            (emitter, point)
        };
        let (from, to) = self.emitters.share(number);
        let choice = below_one(from + rng.uniform() * (to - from));
        Some([choice, u, v])
    }

    /// A ray of light from the start `at`, made of two uniform numbers: where it begins, and its
    /// unit direction.
    ///
    /// On surfaces directions have density `cos / pi`; points and spots fill their solid angle
    /// evenly; rays of infinite lights are parallel and fill a disk.
    #[inline]
    pub fn emit(&self, at: &LightSample, [u, v]: [f64; 2]) -> (Anchor, DVec3) {
        let anchor = at.anchor;
        if anchor.primitive == NO_PRIMITIVE
            && let Some((_, lamp)) = self.lamp(at.material)
        {
            let bounds = self.emitters.bounds();
            let (position, direction) = lamp.emit(anchor.position, anchor.normal, [u, v], bounds);
            return (Anchor { position, ..anchor }, direction);
        }
        (anchor, Frame::new(anchor.normal).to_world(cosine_hemisphere(u, v)))
    }

    /// The numbers from which [`Scene::emit`] makes a ray in `direction` to the point `next`.
    pub fn invert_emission(&self, at: &LightSample, direction: DVec3, next: DVec3) -> [f64; 2] {
        if at.anchor.primitive == NO_PRIMITIVE
            && let Some((_, lamp)) = self.lamp(at.material)
        {
            return lamp.invert_emission(direction, next, self.emitters.bounds());
        }
        invert_cosine_hemisphere(Frame::new(at.anchor.normal).to_local(direction))
    }
}
