//! The alphabet of light path expressions: what can happen at a vertex, in one byte.

use glam::Vec3;

use crate::{Event, VertexKind, VertexRecord, decode_normal};

/// The primitive of a vertex that lies on no surface.
const NO_PRIMITIVE: u32 = u32::MAX;
/// Events without their label.
pub(super) const BASES: usize = 12;
/// Labels that one expression may name; all symbols must fit into a byte.
pub(super) const MAX_LABELS: usize = 15;

/// A set of events without their labels, one bit each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Bases(pub(super) u16);

/// The bits of [`Bases`]: their order is of no meaning.
mod bit {
    pub(super) const CAMERA: u16 = 1;
    /// A surface that emits.
    pub(super) const EMITTER: u16 = 1 << 1;
    /// The environment.
    pub(super) const BACKGROUND: u16 = 1 << 2;
    /// A light that is no surface.
    pub(super) const OTHER_LIGHT: u16 = 1 << 3;
    pub(super) const REFLECT_DIFFUSE: u16 = 1 << 4;
    pub(super) const REFLECT_GLOSSY: u16 = 1 << 5;
    pub(super) const REFLECT_SINGULAR: u16 = 1 << 6;
    pub(super) const TRANSMIT_DIFFUSE: u16 = 1 << 7;
    pub(super) const TRANSMIT_GLOSSY: u16 = 1 << 8;
    pub(super) const TRANSMIT_SINGULAR: u16 = 1 << 9;
    pub(super) const STRAIGHT: u16 = 1 << 10;
    pub(super) const VOLUME: u16 = 1 << 11;
}

/// The letters, what they stand for and the events that are so; the usual ones first.
pub(super) const LETTERS: [(char, &str, Bases); 11] = [
    ('C', "the camera", Bases::CAMERA),
    ('L', "any light", Bases::LIGHTS),
    ('D', "diffuse", Bases(bit::REFLECT_DIFFUSE | bit::TRANSMIT_DIFFUSE)),
    ('G', "glossy", Bases(bit::REFLECT_GLOSSY | bit::TRANSMIT_GLOSSY)),
    ('S', "mirror or clear glass", Bases(bit::REFLECT_SINGULAR | bit::TRANSMIT_SINGULAR)),
    (
        'R',
        "a reflection",
        Bases(bit::REFLECT_DIFFUSE | bit::REFLECT_GLOSSY | bit::REFLECT_SINGULAR),
    ),
    (
        'T',
        "a refraction",
        Bases(
            bit::TRANSMIT_DIFFUSE | bit::TRANSMIT_GLOSSY | bit::TRANSMIT_SINGULAR | bit::STRAIGHT,
        ),
    ),
    ('O', "a surface that emits", Bases(bit::EMITTER)),
    ('B', "the environment", Bases(bit::BACKGROUND)),
    ('V', "a scattering in a volume", Bases(bit::VOLUME)),
    ('s', "straight through", Bases(bit::STRAIGHT)),
];

impl Bases {
    /// Every event.
    pub(super) const ALL: Self = Self((1 << BASES) - 1);
    /// The ends of a path.
    pub(super) const CAMERA: Self = Self(bit::CAMERA);
    /// Any light.
    pub(super) const LIGHTS: Self = Self(bit::EMITTER | bit::BACKGROUND | bit::OTHER_LIGHT);

    /// The events that `letter` stands for: the first letter of a triple or a letter alone.
    pub(super) fn of_letter(letter: char) -> Option<Self> {
        // OSL has the eye, too.
        let letter = if letter == 'E' { 'C' } else { letter };
        LETTERS.iter().find(|(known, ..)| *known == letter).map(|&(.., bases)| bases)
    }

    /// The events of both.
    pub(super) fn and(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// The events of either.
    pub(super) fn or(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// All other events.
    pub(super) fn complement(self) -> Self {
        Self(Self::ALL.0 & !self.0)
    }

    /// True where the two share an event.
    pub(super) fn meets(self, other: Self) -> bool {
        self.and(other).0 != 0
    }
}

/// The byte of an event under label number `label`, 0 for none that is named.
pub(super) fn symbol(base: usize, label: usize) -> u8 {
    debug_assert!(base < BASES && label <= MAX_LABELS, "the alphabet has one byte");
    (label * BASES + base) as u8
}

/// The index of the event at vertex `i` of a path, under an environment called `background`.
pub(super) fn base_of(path: &[VertexRecord], i: usize, background: Option<u16>) -> usize {
    let vertex = &path[i];
    let bit = match vertex.kind {
        VertexKind::Eye => bit::CAMERA,
        VertexKind::Light if vertex.primitive != NO_PRIMITIVE => bit::EMITTER,
        VertexKind::Light if background == Some(vertex.material) => bit::BACKGROUND,
        VertexKind::Light => bit::OTHER_LIGHT,
        VertexKind::Diffuse | VertexKind::Specular => match vertex.event {
            Event::Reflect => bit::REFLECT_SINGULAR,
            Event::Transmit => bit::TRANSMIT_SINGULAR,
            Event::Glossy if passes_through(path, i) => bit::TRANSMIT_GLOSSY,
            Event::Glossy => bit::REFLECT_GLOSSY,
            Event::Diffuse | Event::End => bit::REFLECT_DIFFUSE,
        },
    };
    bit.trailing_zeros() as usize
}

/// Whether the neighbours of vertex `i` lie on different sides of its surface: a rough boundary
/// records that it scatters, and the points tell whether it reflects or refracts.
fn passes_through(path: &[VertexRecord], i: usize) -> bool {
    let (Some(before), Some(after)) = (i.checked_sub(1).and_then(|j| path.get(j)), path.get(i + 1))
    else {
        return false;
    };
    let normal = decode_normal(path[i].normal);
    let side = |other: &VertexRecord| {
        (Vec3::from_array(other.position) - Vec3::from_array(path[i].position)).dot(normal)
    };
    side(before) * side(after) < 0.0
}
