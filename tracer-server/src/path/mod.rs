//! Light paths as values: vertices, cached weights, and the densities that follow from them.
//!
//! A path runs from the light (vertex 0) to the lens (vertex k). For every split `i` in `-1..k` the
//! unweighted bidirectional contribution `C_i = f / p_i` is a colour common to all splits times a
//! scalar; the path stores the reciprocals of those scalars, from which follow the balance weights
//! [Veach 1997, section 10.2], the acceptance ratios of the mutations, and
//! `S = sum_i 1 / lum C_i`.

mod assemble;
mod bidirectional;
mod class;
mod detail;
mod failure;
mod numbers;
mod record;
mod resample;
mod tape;
mod vertex;
mod walk;

pub use assemble::{Cut, Splice};
pub use bidirectional::BidirectionalSampler;
pub use class::ClassKey;
pub use common::Kept;
pub use failure::Failure;
pub use numbers::{Numbers, ROW, STRANDS, Strand};
pub use resample::{Draft, Range, end_on_light, open_for_connection, resample};
pub use tape::Tape;
pub use vertex::Vertex;
pub use walk::{CameraSample, emit, extend, lens_vertex, light_vertex, scatter};

use arrayvec::ArrayVec;
use common::{MAX_VERTICES, Rgb};
use glam::{DVec2, DVec3};

use crate::bsdf::Scattering;
use crate::scene::{MAX_EDGES, Tracer};

/// Vertices in the order of a walk.
pub type Vertices = ArrayVec<Vertex, MAX_VERTICES>;

/// One edge, from a vertex to its neighbour on the eye side.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Edge {
    /// Unit direction from light to eye.
    pub direction: DVec3,
    /// What the edge contributes to a connection: `|cos| |cos| / r^2`, per unit area; on the edge
    /// to the lens `|cos| / r^2` times film area per solid angle. The cosine at a point light is
    /// one, and from a light infinitely far away there is neither a cosine nor `r^2`.
    pub geometry: f64,
}

/// A complete path that carries light: `0 < lum f < inf`.
///
/// It is only made by [`Path::splice`], which computes every cached value.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    vertices: Vertices,
    /// Edge `j` joins vertices `j` and `j + 1`.
    edges: ArrayVec<Edge, MAX_EDGES>,
    /// Entry `j` belongs to vertex `j`; the two ends hold [`NO_SCATTERING`].
    scattering: ArrayVec<Scattering, MAX_VERTICES>,
    /// Entry `i + 1` is the reciprocal of the scalar part of `C_i`.
    reciprocals: ArrayVec<f64, MAX_VERTICES>,
    /// The colour common to all `C_i`.
    color: Rgb,
    /// Its luminance.
    luminance: f64,
    /// `S(x) = sum_i 1 / lum C_i`.
    density_sum: f64,
    film: DVec2,
    pixel: u32,
    /// Bit `j` is set when vertex `j` can be connected.
    connectable: u128,
    /// The start is infinitely far away.
    lit_from_afar: bool,
}

/// Stands for the scattering of the two ends of a path, which do not scatter.
const NO_SCATTERING: Scattering = Scattering {
    color: Rgb::WHITE,
    connection: 1.0,
    light_weight: 1.0,
    eye_weight: 1.0,
    light_pdf: 1.0,
    eye_pdf: 1.0,
};

impl Default for Path {
    /// An empty path: a buffer to splice into.
    fn default() -> Self {
        Self {
            vertices: Vertices::new(),
            edges: ArrayVec::new(),
            scattering: ArrayVec::new(),
            reciprocals: ArrayVec::new(),
            color: Rgb::BLACK,
            luminance: 0.0,
            density_sum: 0.0,
            film: DVec2::ZERO,
            pixel: 0,
            connectable: 0,
            lit_from_afar: false,
        }
    }
}

impl Path {
    /// Number of edges, `k`.
    #[inline]
    pub fn edge_count(&self) -> usize {
        self.edges.len()
    }

    /// All vertices, the light first.
    #[inline]
    pub fn vertices(&self) -> &[Vertex] {
        &self.vertices
    }

    /// All edges, the one at the light first.
    pub fn edges(&self) -> &[Edge] {
        &self.edges
    }

    /// What vertex `j` does; meaningless at the two ends.
    #[inline]
    pub fn scattering(&self, j: usize) -> &Scattering {
        &self.scattering[j]
    }

    /// The film point, `u` to the right and `v` downwards, both in [0, 1).
    #[inline]
    pub fn film(&self) -> DVec2 {
        self.film
    }

    /// The film's pixel.
    #[inline]
    pub fn pixel(&self) -> usize {
        self.pixel as usize
    }

    /// Luminance of the colour common to all splits.
    #[inline]
    pub fn luminance(&self) -> f64 {
        self.luminance
    }

    /// The contribution's colour, scaled to unit luminance: what every splat of the path carries.
    #[inline]
    pub fn unit_color(&self) -> Rgb {
        self.color / self.luminance
    }

    /// `S(x) = sum_i 1 / lum C_i(x)`. Its reciprocal is the path's weight as a bidirectional
    /// sample, whatever split made it.
    #[inline]
    pub fn density_sum(&self) -> f64 {
        self.density_sum
    }

    /// `1 / lum C_i` for the split with `light` vertices on the light side (`light = i + 1`);
    /// zero when the split cannot make the path.
    #[inline]
    pub fn reciprocal(&self, light: usize) -> f64 {
        self.reciprocals[light] / self.luminance
    }

    /// Sum of `1 / lum C_i` over the splits with `first..=last` vertices on the light side.
    #[inline]
    pub fn reciprocal_sum(&self, first: usize, last: usize) -> f64 {
        self.reciprocals[first..=last].iter().sum::<f64>() / self.luminance
    }

    /// Bit `j` is set when vertex `j` can be connected.
    #[inline]
    pub fn connectable(&self) -> u128 {
        self.connectable
    }

    /// True when vertex `j` can be connected.
    #[inline]
    pub fn is_connectable(&self, j: usize) -> bool {
        self.connectable >> j & 1 == 1
    }

    /// Index of the first vertex, seen from the lens, that is not specular; zero for a light that
    /// is seen directly or through specular vertices only.
    #[inline]
    pub fn first_diffuse_from_eye(&self) -> usize {
        let last = self.edge_count() - 1;
        (1..=last).rev().find(|&j| self.is_connectable(j)).unwrap_or(0)
    }

    /// The path of these vertices, seen at `film`. Visibility is not tested.
    pub fn rebuild(scene: &Tracer<'_>, vertices: &[Vertex], film: DVec2) -> Result<Self, Failure> {
        let (&lens, inner) = vertices.split_last().ok_or(Failure::LengthOutOfRange)?;
        let lens = Self::from_lens(lens);
        let splice = Splice {
            base: &lens,
            cut: Cut { light: 0, eye_from: 0 },
            light: inner,
            eye: &[],
            film: Some(film),
        };
        let mut path = Self::default();
        path.splice(scene, &splice)?;
        Ok(path)
    }

    /// Rebuilds the path from its vertices and compares every cached value; false when one is
    /// stale.
    pub fn is_fresh(&self, scene: &Tracer<'_>) -> bool {
        Self::rebuild(scene, &self.vertices, self.film).is_ok_and(|fresh| fresh == *self)
    }

    /// True when the path starts in a direction, on the sun or the sky.
    #[inline]
    pub fn is_lit_from_afar(&self) -> bool {
        self.lit_from_afar
    }

    /// Heckbert's class, such as `LDSE`.
    pub fn class(&self) -> String {
        self.vertices.iter().map(|v| v.kind.letter()).collect()
    }
}

#[cfg(test)]
mod laws;
#[cfg(test)]
mod shading_laws;
