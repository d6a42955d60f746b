//! From vertices to a path: splicing, and the computation of every cached value.

use arrayvec::ArrayVec;
use common::{Kept, Rgb, VertexKind};
use glam::{DVec2, DVec3};

use super::{Edge, Failure, NO_SCATTERING, Path, Vertex, lens_vertex};
use crate::scene::{Emission, Tracer};

/// What is kept of a path of which something between its ends is replaced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cut {
    /// How many vertices are kept from the light end.
    pub light: usize,
    /// Index of the first vertex kept at the eye end; one past the lens when the lens point is
    /// replaced too.
    pub eye_from: usize,
}

impl Cut {
    /// How much that is of a path of so many vertices.
    pub fn kept(self, vertices: usize) -> Kept {
        Kept { light: self.light, eye: vertices.saturating_sub(self.eye_from) }
    }
}

/// How a path is made of an older one: its ends are kept, what lies between is replaced.
#[derive(Clone, Copy, Debug)]
pub struct Splice<'a> {
    /// The older path.
    pub base: &'a Path,
    /// What is kept of it.
    pub cut: Cut,
    /// New vertices on the light side, in the order of the path.
    pub light: &'a [Vertex],
    /// New vertices on the eye side, in the order of a walk from the eye: the last one comes first
    /// in the path.
    pub eye: &'a [Vertex],
    /// The film point, where a walk from the lens has drawn one.
    pub film: Option<DVec2>,
}

impl Path {
    /// Only a lens, in its middle: the base for paths that are new from end to end.
    pub fn at_lens(scene: &Tracer<'_>) -> Self {
        // The centre of the disk.
        Self::from_lens(lens_vertex(scene, || [0.0; 2]))
    }

    /// Only the vertex `lens`: the base for paths that end there and are new otherwise.
    pub fn from_lens(lens: Vertex) -> Self {
        let mut path = Self::default();
        path.vertices.push(lens);
        path.scattering.push(NO_SCATTERING);
        path
    }

    /// Replaces the vertex of a path that is nothing but a lens: see [`Path::from_lens`].
    pub(super) fn move_lens(&mut self, lens: Vertex) {
        debug_assert_eq!(self.vertices.len(), 1, "nothing but a lens");
        self.vertices[0] = lens;
    }

    /// Becomes the path that `splice` describes and computes its cached values.
    ///
    /// Fails when the path carries no light. Visibility is not tested; see [`Path::connect`].
    pub fn splice(&mut self, scene: &Tracer<'_>, splice: &Splice<'_>) -> Result<(), Failure> {
        let (base, cut) = (splice.base, splice.cut);
        let first_kept = cut.light + splice.light.len() + splice.eye.len();
        self.vertices.clear();
        self.edges.clear();
        self.scattering.clear();

        append(&mut self.vertices, &base.vertices[..cut.light])?;
        append(&mut self.vertices, splice.light)?;
        append(&mut self.vertices, splice.eye)?;
        self.vertices[cut.light + splice.light.len()..].reverse();
        append(&mut self.vertices, &base.vertices[cut.eye_from..])?;

        self.place_infinite_light(scene);

        let first_new_edge = cut.light.saturating_sub(1);
        append(&mut self.edges, &base.edges[..first_new_edge])?;
        for j in first_new_edge..first_kept.min(self.vertices.len() - 1) {
            let edge = self.new_edge(scene, j)?;
            self.edges.push(edge);
        }
        append(&mut self.edges, base.edges.get(cut.eye_from..).unwrap_or_default())?;
        if cut.eye_from + 1 < base.vertices.len() {
            self.film = base.film;
            self.pixel = base.pixel;
        } else {
            self.find_film_point(scene, splice.film)?;
        }

        append(&mut self.scattering, &base.scattering[..first_new_edge])?;
        for j in first_new_edge..=first_kept.min(self.edges.len() - 1) {
            let scattering = self.new_scattering(scene, j)?;
            self.scattering.push(scattering);
        }
        let copied = (cut.eye_from + 1).min(base.scattering.len());
        append(&mut self.scattering, &base.scattering[copied..])?;
        if self.scattering.len() < self.vertices.len() {
            self.scattering.push(NO_SCATTERING);
        }
        self.weigh(scene)
    }

    /// Splices, and tests the one edge that no ray has traced: the one from the light side to the
    /// eye side. Without a light side the walk from the eye has hit the light, and there is none.
    pub fn connect(&mut self, scene: &Tracer<'_>, splice: &Splice<'_>) -> Result<(), Failure> {
        self.splice(scene, splice)?;
        let last_light = (splice.cut.light + splice.light.len()).checked_sub(1);
        match last_light {
            Some(j) if !self.connection_is_clear(scene, j) => Err(Failure::Occluded),
            _ => Ok(()),
        }
    }

    /// True when nothing blocks the edge from vertex `j` to its successor, and it is long enough
    /// for that to mean anything.
    #[inline]
    fn connection_is_clear(&self, scene: &Tracer<'_>, j: usize) -> bool {
        let (a, b) = (&self.vertices[j], &self.vertices[j + 1]);
        if a.is_lamp() && scene.is_infinite(a.material) {
            return scene.visible(&scene.far_from(b.position, -a.normal), &b.anchor());
        }
        let reach = scene.reach(a.primitive, b.primitive);
        (b.position - a.position).length_squared() > reach * reach
            && scene.visible(&a.anchor(), &b.anchor())
    }

    /// Puts a light that is infinitely far away where the first edge, drawn from there, has the
    /// direction of its light.
    #[inline]
    fn place_infinite_light(&mut self, scene: &Tracer<'_>) {
        if let [light, next, ..] = self.vertices.as_mut_slice()
            && light.is_lamp()
            && scene.is_infinite(light.material)
        {
            light.position = scene.far_from(next.position, -light.normal).position;
        }
    }

    #[inline]
    fn new_edge(&self, scene: &Tracer<'_>, j: usize) -> Result<Edge, Failure> {
        let (a, b) = (&self.vertices[j], &self.vertices[j + 1]);
        let (direction, at_a) =
            if a.is_lamp() { leave_lamp(scene, a, b)? } else { leave_surface(a, b)? };
        let cos_b = -b.normal.dot(direction);
        let at_b = if b.kind == VertexKind::Eye {
            if !(cos_b > 0.0) {
                return Err(Failure::OffFilm);
            }
            scene.camera().film_per_solid_angle(cos_b)
        } else {
            cos_b.abs()
        };
        Ok(Edge { direction, geometry: at_a * at_b })
    }

    /// The film point: drawn by the walk from the lens, or found by projection.
    fn find_film_point(&mut self, scene: &Tracer<'_>, drawn: Option<DVec2>) -> Result<(), Failure> {
        let camera = scene.camera();
        let lens = self.vertices[self.edges.len()].position;
        let projected = || camera.project_from(lens, -self.edges.last()?.direction);
        let film = drawn.or_else(projected).ok_or(Failure::OffFilm)?;
        self.film = film;
        self.pixel = camera.pixel(film) as u32;
        Ok(())
    }

    #[inline]
    fn new_scattering(
        &self,
        scene: &Tracer<'_>,
        j: usize,
    ) -> Result<crate::bsdf::Scattering, Failure> {
        if j == 0 {
            return Ok(NO_SCATTERING);
        }
        let vertex = &self.vertices[j];
        let to_light = -self.edges[j - 1].direction;
        let to_eye = self.edges[j].direction;
        scene
            .local(&vertex.anchor(), vertex.material)
            .evaluate(to_light, to_eye, vertex.event)
            .ok_or(Failure::ZeroContribution)
    }

    /// Colour, reciprocals, their sum and the mask of connectable vertices.
    ///
    /// A lamp has no size: seen directly it would light a single point of the film, which no
    /// picture shows.
    fn weigh(&mut self, scene: &Tracer<'_>) -> Result<(), Failure> {
        let k = self.edges.len();
        let light = &self.vertices[0];
        let emission = scene
            .emission(light.primitive, light.material, self.edges[0].direction)
            .filter(|emission| emission.hittable || k > 1)
            .ok_or(Failure::ZeroContribution)?;
        self.color = emission.color;
        self.lit_from_afar = light.is_lamp() && scene.is_infinite(light.material);
        self.connectable = 1 | 1 << k;
        for j in 1..k {
            self.color *= self.scattering[j].color;
            self.connectable |= u128::from(!self.vertices[j].event.is_specular()) << j;
        }
        self.luminance = self.color.luminance();
        self.weigh_splits(&emission);
        self.density_sum = self.reciprocals.iter().sum::<f64>() / self.luminance;
        if self.color == Rgb::BLACK {
            return Err(Failure::ZeroContribution);
        }
        let sound = self.density_sum.is_finite() && self.luminance.is_finite();
        if !(sound && self.luminance > 0.0 && self.density_sum > 0.0) {
            return Err(Failure::NotFinite);
        }
        Ok(())
    }

    /// The reciprocals of the scalar parts of all `C_i`: (light prefix) x (connection) x (eye
    /// suffix). Densities and Dirac deltas of traced edges have cancelled in the weights.
    fn weigh_splits(&mut self, emission: &Emission) {
        let k = self.edges.len();
        // First the eye suffixes: entry j holds the weight of making vertices j..=k from the eye.
        self.reciprocals.clear();
        self.reciprocals.extend(std::iter::repeat_n(1.0, k + 1));
        for j in (0..k.saturating_sub(1)).rev() {
            self.reciprocals[j] = self.reciprocals[j + 1] * self.scattering[j + 1].eye_weight;
        }
        // A light that is hit needs no connection.
        self.reciprocals[0] = if emission.hittable { 1.0 / self.reciprocals[0] } else { 0.0 };
        let mut prefix = 1.0 / emission.pdf;
        let mut at_light = emission.connection;
        for i in 0..k {
            let connection = at_light
                * self.scattering[i].connection
                * self.edges[i].geometry
                * self.scattering[i + 1].connection;
            let contribution = prefix * connection * self.reciprocals[i + 1];
            self.reciprocals[i + 1] = if connection > 0.0 { 1.0 / contribution } else { 0.0 };
            prefix *= if i == 0 { emission.walk } else { self.scattering[i].light_weight };
            at_light = 1.0;
        }
    }
}

/// Copies `new` to the end of a list as one block.
#[inline]
fn append<T: Copy, const N: usize>(list: &mut ArrayVec<T, N>, new: &[T]) -> Result<(), Failure> {
    list.try_extend_from_slice(new).map_err(|_full| Failure::LengthOutOfRange)
}

/// The unit direction from `a` to `b`, and what the end at `a` gives to the edge.
#[inline]
fn leave_surface(a: &Vertex, b: &Vertex) -> Result<(DVec3, f64), Failure> {
    let (direction, length_squared) = between(a, b)?;
    let cos_a = a.normal.dot(direction);
    if a.kind == VertexKind::Light && !(cos_a > 0.0) {
        // Lights are dark on their back.
        return Err(Failure::ZeroContribution);
    }
    Ok((direction, cos_a.abs() / length_squared))
}

/// The same for a light without a surface: no cosine, and from infinitely far away no distance.
#[cold]
fn leave_lamp(scene: &Tracer<'_>, a: &Vertex, b: &Vertex) -> Result<(DVec3, f64), Failure> {
    if scene.is_infinite(a.material) {
        return Ok((a.normal, 1.0));
    }
    let (direction, length_squared) = between(a, b)?;
    Ok((direction, 1.0 / length_squared))
}

/// The unit direction from `a` to `b`, and their distance squared.
#[inline]
fn between(a: &Vertex, b: &Vertex) -> Result<(DVec3, f64), Failure> {
    let span = b.position - a.position;
    let length_squared = span.length_squared();
    if !(length_squared > 0.0) {
        return Err(Failure::Occluded);
    }
    Ok((span / length_squared.sqrt(), length_squared))
}
