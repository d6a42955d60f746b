//! One vertex of a path.

use common::{Event, VertexKind};
use glam::DVec3;

use crate::scene::{Anchor, Hit, LightSample, NO_PRIMITIVE};

/// A point of a path and what happens there. Kind and event belong to the path, not to the
/// material: the same point with another event is another path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex {
    /// Where, in scene units.
    pub position: DVec3,
    /// Unit geometric normal on the front side; the view direction on the lens; on a light
    /// infinitely far away the direction in which its light travels.
    pub normal: DVec3,
    /// The primitive; [`NO_PRIMITIVE`] on the lens and on lights without a surface.
    pub primitive: u32,
    /// Index of the material, or of the light without a surface; zero on the lens.
    pub material: u16,
    /// Heckbert's letter.
    pub kind: VertexKind,
    /// The lobe that scatters here.
    pub event: Event,
}

impl Vertex {
    /// A fresh vertex on a surface, whose event is still to be decided.
    #[inline]
    pub fn on_surface(hit: &Hit, material: u16) -> Self {
        Self {
            position: hit.position,
            normal: hit.normal,
            primitive: hit.primitive,
            material,
            kind: VertexKind::Diffuse,
            event: Event::End,
        }
    }

    /// The vertex as an end of rays.
    #[inline]
    pub fn anchor(&self) -> Anchor {
        Anchor { position: self.position, normal: self.normal, primitive: self.primitive }
    }

    /// Decides what happens here.
    #[inline]
    pub fn set_event(&mut self, event: Event) {
        self.event = event;
        self.kind = if event.is_specular() { VertexKind::Specular } else { VertexKind::Diffuse };
    }

    /// Makes it the start of a path: a point on a light.
    #[inline]
    pub fn set_light(&mut self) {
        self.event = Event::End;
        self.kind = VertexKind::Light;
    }

    /// True on the lens.
    pub fn is_lens(&self) -> bool {
        self.kind == VertexKind::Eye
    }

    /// True on a light without a surface, the sky included.
    #[inline]
    pub fn is_lamp(&self) -> bool {
        self.primitive == NO_PRIMITIVE && self.kind == VertexKind::Light
    }

    /// The vertex as the start of a path.
    #[inline]
    pub fn light_sample(&self) -> LightSample {
        LightSample { anchor: self.anchor(), material: self.material }
    }
}
