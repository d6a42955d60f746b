//! From a description to a world that can be traced.

use std::collections::BTreeSet;

use common::{Camera, CameraError, FilterObject, Rgb, SceneFrame};
use glam::DVec3;
use thiserror::Error;

use super::accel::{Accel, Anchor};
use super::corners::Corners;
use super::emitter::Emitters;
use super::lamp::{Bounds, Cone, Lamp};
use super::paint::Map;
use super::sky::Sky;
use super::surface::{Ball, NO_PRIMITIVE, Triangle};
use super::{NO_EMITTER, Primitive, Scene, SceneFeatures, SurfaceMaterial};
use crate::scene::description::{LightKind, MAX_EDGES, SceneDescription, digest};

/// Why a description makes no scene.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SceneError {
    /// Nothing to trace.
    #[error("the scene has no surface: it needs at least one triangle or sphere of non-zero size")]
    Empty,
    /// No light.
    #[error("the scene has no light: give at least one material an emission, or add a light")]
    NoLight,
    /// A vertex or radius that is no finite number.
    #[error("{shape} has a coordinate that is not a finite number")]
    NotFinite {
        /// The shape's name.
        shape: String,
    },
    /// An index that points past the end of what it refers to.
    #[error("{shape} refers to {what} {index}, but there are only {count}")]
    BadIndex {
        /// The shape's name.
        shape: String,
        /// "vertex" or "material".
        what: &'static str,
        /// The index.
        index: usize,
        /// How many there are.
        count: usize,
    },
    /// A path length outside what the tracer can hold.
    #[error("max_edges is {0}; it must lie between 1 and {MAX_EDGES}")]
    BadMaxEdges(usize),
    /// The camera makes no picture.
    #[error("{0}")]
    Camera(#[from] CameraError),
}

/// How far a light that lies in the plane of another surface is moved to its front, in scene units.
const LIGHT_LIFT: f64 = 1.0 / 32.0;

impl Scene {
    /// Normalises, checks and indexes a description.
    pub fn new(description: &SceneDescription) -> Result<Self, SceneError> {
        if !(1..=MAX_EDGES).contains(&description.max_edges) {
            return Err(SceneError::BadMaxEdges(description.max_edges));
        }
        let mut camera = Camera::new(&description.camera, description.width, description.height)?;
        let frame = normalising_frame(description)?;
        camera.origin = frame.to_scene(camera.origin);
        if let Some(lens) = description.lens {
            (camera.aperture, camera.focus) = (lens.radius * frame.scale, lens.focus * frame.scale);
        }

        let mut warnings = Vec::new();
        let mut objects = Vec::new();
        let (triangles, mut materials, mut corners) =
            gather_triangles(description, frame, &mut objects, &mut warnings)?;
        let balls = gather_balls(description, frame, &mut objects, &mut materials)?;
        let visible = description.spheres.iter().filter(|sphere| sphere.radius > 0.0);
        corners.turn_spheres(visible.map(|sphere| sphere.turn).collect());
        if materials.is_empty() {
            return Err(SceneError::Empty);
        }
        let emits =
            |material: u16| !description.materials[usize::from(material)].emission.is_black();
        let shines = description.lights.iter().any(|light| !light.kind.is_dark());
        if !shines && !materials.iter().any(|&m| emits(m)) {
            return Err(SceneError::NoLight);
        }
        let spheres = balls.len();
        let mut accel = Accel::new(triangles, balls);
        let lifted = lifted_lights(&accel, |i| emits(materials[i]));
        if !lifted.is_empty() {
            warnings.push(format!(
                "{} light triangles lie in the plane of another surface; they were moved \
                 {:e} units to their front",
                lifted.len(),
                LIGHT_LIFT / frame.scale
            ));
            let mut triangles = accel.triangles().to_vec();
            for (i, moved) in lifted {
                triangles[i] = moved;
            }
            accel = Accel::new(triangles, accel.balls().to_vec());
        }
        let (emitters, primitives, radiance_scale) =
            light_up(description, frame, &accel, &materials);
        let surfaces: Vec<SurfaceMaterial> = description
            .materials
            .iter()
            .map(|m| SurfaceMaterial::new(description, m, 1.0 / radiance_scale))
            .collect();
        let used = used_surfaces(&materials, &surfaces);
        let features = SceneFeatures::of(&used, spheres, corners.has_normals(), &emitters, &camera);
        if !features.textures {
            corners.drop_texcoords();
        }
        Ok(Self {
            name: description.name.clone(),
            hash: digest(description),
            frame: SceneFrame { light: radiance_scale, ..frame },
            camera,
            max_edges: description.max_edges,
            features,
            accel,
            primitives,
            surfaces,
            corners,
            maps: description.textures.iter().map(Map::new).collect(),
            emitters,
            lamp_names: description.lights.iter().map(|light| light.name.clone()).collect(),
            objects,
            warnings,
        })
    }
}

/// The materials that some shape has, each once.
fn used_surfaces<'a>(materials: &[u16], all: &'a [SurfaceMaterial]) -> Vec<&'a SurfaceMaterial> {
    let mut used = materials.to_vec();
    used.sort_unstable();
    used.dedup();
    used.into_iter().map(|m| &all[usize::from(m)]).collect()
}

/// The frame that brings the scene's largest extent into [1024, 2048): the box test of the
/// hierarchy then has a relative error of 1e-7 whatever the units of the file.
fn normalising_frame(description: &SceneDescription) -> Result<SceneFrame, SceneError> {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let mut include = |p: DVec3| {
        low = low.min(p);
        high = high.max(p);
    };
    for mesh in &description.meshes {
        if !mesh.positions.iter().all(|p| p.is_finite()) {
            return Err(SceneError::NotFinite { shape: format!("mesh `{}`", mesh.name) });
        }
        for &index in mesh.triangles.as_flattened() {
            let count = mesh.positions.len();
            let position = mesh.positions.get(index as usize).ok_or_else(|| {
                let shape = format!("mesh `{}`", mesh.name);
                SceneError::BadIndex { shape, what: "vertex", index: index as usize, count }
            })?;
            include(*position);
        }
    }
    for sphere in &description.spheres {
        if !(sphere.centre.is_finite() && sphere.radius.is_finite()) {
            return Err(SceneError::NotFinite { shape: format!("sphere `{}`", sphere.name) });
        }
        include(sphere.centre - sphere.radius);
        include(sphere.centre + sphere.radius);
    }
    let extent = (high - low).max_element();
    if !(extent > 0.0) || !extent.is_finite() {
        return Err(SceneError::Empty);
    }
    Ok(SceneFrame {
        centre: 0.5 * (low + high),
        scale: 2_f64.powi(10 - exponent(extent)),
        light: 1.0,
    })
}

/// The exponent of the power of two just below a positive number. Read from the bits, since a
/// logarithm could round up at a power of two.
fn exponent(x: f64) -> i32 {
    ((x.to_bits() >> 52) & 0x7ff) as i32 - 1023
}

fn gather_triangles(
    description: &SceneDescription,
    frame: SceneFrame,
    objects: &mut Vec<FilterObject>,
    warnings: &mut Vec<String>,
) -> Result<(Vec<Triangle>, Vec<u16>, Corners), SceneError> {
    let count = description.materials.len();
    let (mut triangles, mut materials) = (Vec::new(), Vec::new());
    let mut corners = Corners::default();
    let (mut degenerate, mut repeated) = (0_usize, 0_usize);
    let mut lights = BTreeSet::new();
    for mesh in &description.meshes {
        let first = materials.len() as u32;
        let listed = mesh.triangles.iter().zip(&mesh.materials).enumerate();
        for (index, (indices, &material)) in listed {
            if usize::from(material) >= count {
                let shape = format!("mesh `{}`", mesh.name);
                let index = usize::from(material);
                return Err(SceneError::BadIndex { shape, what: "material", index, count });
            }
            // Rounded to single precision, so that the traversal sees the same triangle.
            let corner = |i: u32| frame.to_scene(mesh.positions[i as usize]).as_vec3().as_dvec3();
            let emits = !description.materials[usize::from(material)].emission.is_black();
            let corner_points = indices.map(corner);
            match Triangle::new(corner_points) {
                Some(_) if emits && !lights.insert(place_of(corner_points)) => repeated += 1,
                Some(triangle) => {
                    corners.push(mesh, index, &triangle, triangles.len());
                    triangles.push(triangle);
                    materials.push(material);
                }
                None => degenerate += 1,
            }
        }
        let primitives = first..materials.len() as u32;
        objects.push(FilterObject { name: mesh.name.clone(), primitives });
    }
    if degenerate > 0 {
        warnings.push(format!("{degenerate} triangles without area were ignored"));
    }
    if repeated > 0 {
        warnings.push(format!(
            "{repeated} light triangles were ignored: each has another one in the same place"
        ));
    }
    Ok((triangles, materials, corners))
}

/// What triangles have in common that cover each other and face the same way: the corners in their
/// order, the least one first.
fn place_of(corners: [DVec3; 3]) -> [[u64; 3]; 3] {
    // Adding zero makes one zero of the two.
    let mut bits = corners.map(|corner| (corner + 0.0).to_array().map(f64::to_bits));
    let least = (0..3).min_by_key(|&i| bits[i]).unwrap_or(0);
    bits.rotate_left(least);
    bits
}

fn gather_balls(
    description: &SceneDescription,
    frame: SceneFrame,
    objects: &mut Vec<FilterObject>,
    materials: &mut Vec<u16>,
) -> Result<Vec<Ball>, SceneError> {
    let count = description.materials.len();
    let mut balls = Vec::new();
    for sphere in &description.spheres {
        let index = usize::from(sphere.material);
        if index >= count {
            let shape = format!("sphere `{}`", sphere.name);
            return Err(SceneError::BadIndex { shape, what: "material", index, count });
        }
        if sphere.radius > 0.0 {
            balls.push(Ball::new(frame.to_scene(sphere.centre), sphere.radius * frame.scale));
            let primitive = materials.len() as u32;
            materials.push(sphere.material);
            let primitives = primitive..primitive + 1;
            objects.push(FilterObject { name: sphere.name.clone(), primitives });
        }
    }
    Ok(balls)
}

/// Light triangles that coincide with another surface, each moved to its front: which of two
/// coplanar faces a ray meets first is noise. With their indices.
fn lifted_lights(accel: &Accel, is_light: impl Fn(usize) -> bool) -> Vec<(usize, Triangle)> {
    let lift = |(i, triangle): (usize, &Triangle)| {
        let middle = triangle.sample(4.0 / 9.0, 0.5);
        let span = 0.5 * LIGHT_LIFT * triangle.normal;
        let beside = |offset: DVec3, primitive: u32| Anchor {
            position: middle + offset,
            normal: triangle.normal,
            primitive,
        };
        // A ray through the light's own plane; the light itself does not count.
        if accel.visible(&beside(span, NO_PRIMITIVE), &beside(-span, i as u32)) {
            return None;
        }
        let moved = triangle
            .corners()
            .map(|corner| (corner + LIGHT_LIFT * triangle.normal).as_vec3().as_dvec3());
        Some((i, Triangle::new(moved)?))
    };
    let triangles = accel.triangles().iter().enumerate();
    triangles.filter(|(i, _)| is_light(*i)).filter_map(lift).collect()
}

/// Emitters, the table of primitives, and the power of two that emission is divided by.
fn light_up(
    description: &SceneDescription,
    frame: SceneFrame,
    accel: &Accel,
    materials: &[u16],
) -> (Emitters, Vec<Primitive>, f64) {
    let areas =
        accel.triangles().iter().map(Triangle::area).chain(accel.balls().iter().map(Ball::area));
    let mut sources: Vec<(u32, Rgb, f64)> = Vec::new();
    let mut primitives = Vec::with_capacity(materials.len());
    for (i, (&material, area)) in materials.iter().zip(areas).enumerate() {
        let emission = description.materials[usize::from(material)].emission;
        let mut emitter = NO_EMITTER;
        if !emission.is_black() {
            emitter = sources.len() as u32;
            sources.push((i as u32, emission, area));
        }
        primitives.push(Primitive { material, emitter });
    }
    let bounds = bounds(accel);
    let mut lamps: Vec<Lamp> =
        description.lights.iter().map(|light| lamp(&light.kind, frame)).collect();
    let of_surfaces: f64 =
        sources.iter().map(|&(_, radiance, area)| radiance.luminance() * area).sum();
    let power = of_surfaces + lamps.iter().map(|lamp| lamp.power(&bounds)).sum::<f64>();
    let radiance_scale = 2_f64.powi(exponent(power).clamp(-1000, 1000));
    for (_, radiance, _) in &mut sources {
        *radiance = *radiance / radiance_scale;
    }
    for lamp in &mut lamps {
        lamp.dim(radiance_scale);
    }
    (Emitters::new(&sources, lamps, bounds), primitives, radiance_scale)
}

/// The ball around the box around all surfaces.
fn bounds(accel: &Accel) -> Bounds {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for corner in accel.triangles().iter().flat_map(Triangle::corners) {
        (low, high) = (low.min(corner), high.max(corner));
    }
    for ball in accel.balls() {
        (low, high) = (low.min(ball.centre - ball.radius), high.max(ball.centre + ball.radius));
    }
    Bounds { centre: 0.5 * (low + high), radius: 0.5 * (high - low).length() }
}

/// A lamp in scene units. Intensity grows with the square of the unit of length.
fn lamp(kind: &LightKind, frame: SceneFrame) -> Lamp {
    let area = frame.scale * frame.scale;
    match *kind {
        LightKind::Point { position, intensity } => {
            Lamp::Point { position: frame.to_scene(position), intensity: intensity * area }
        }
        LightKind::Spot { position, direction, intensity, cutoff, beam } => Lamp::Spot {
            position: frame.to_scene(position),
            intensity: intensity * area,
            cone: Cone {
                axis: direction.normalize_or(DVec3::NEG_Y),
                cos_cutoff: cutoff.to_radians().cos(),
                cos_beam: beam.to_radians().cos(),
            },
        },
        LightKind::Directional { direction, irradiance } => {
            Lamp::Sun { direction: direction.normalize_or(DVec3::NEG_Y), irradiance }
        }
        LightKind::Environment { radiance, ref image, rotation } => Lamp::Sky(match image {
            Some(image) => Sky::of_image(image.clone(), rotation, radiance),
            None => Sky::constant(radiance),
        }),
    }
}
