//! What every scene must fulfil, whatever file it came from; checked in this one place.

mod light;
mod material;

use common::Camera;
use glam::DVec3;

use super::{MAX_EDGES, Mesh, SceneDescription, Sphere};
use light::check_lights;
use material::{check_material, check_texture};

/// Coordinates beyond this are a mistake: squares and products of them stay far inside an `f64`,
/// but nothing that a picture needs is lost in their rounding.
pub(crate) const MAX_COORDINATE: f64 = 1e15;
/// The most triangles that are read from one scene.
pub(crate) const MAX_TRIANGLES: usize = 20_000_000;
/// The longest side of a film in pixels.
const MAX_FILM_SIDE: u32 = 16_384;
/// The most pixels of a film.
const MAX_FILM_PIXELS: u64 = 1 << 26;
/// A triangle is degenerate when its doubled area is below this share of its longest side squared.
const DEGENERATE: f64 = 1e-12;

/// Which part of a description is meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
    /// The scene as a whole.
    Scene,
    /// The camera.
    Camera,
    /// The film.
    Film,
    /// A material, by index.
    Material(usize),
    /// A mesh, by index.
    Mesh(usize),
    /// A sphere, by index.
    Sphere(usize),
    /// A light without a surface, by index.
    Light(usize),
}

/// What is wrong with a description.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Problem {
    /// Where.
    pub(crate) part: Part,
    /// The field of that part, as the project's own scene files spell it; may be empty.
    pub(crate) field: String,
    /// What, and what to do.
    pub(crate) message: String,
}

impl Problem {
    pub(crate) fn new(part: Part, field: &str, message: impl Into<String>) -> Self {
        Self { part, field: field.to_owned(), message: message.into() }
    }
}

/// What was mended in a mesh, and may be told in a warning.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Dropped {
    /// The mesh, by the index it had before meshes without triangles were removed.
    pub(crate) mesh: usize,
    /// How many of its triangles had no area.
    pub(crate) triangles: usize,
}

/// Checks a description, and removes triangles without area and meshes without triangles.
pub(crate) fn validate(scene: &mut SceneDescription) -> Result<Vec<Dropped>, Problem> {
    check_film(scene)?;
    check_camera(scene)?;
    for texture in &scene.textures {
        check_texture(texture).map_err(|fault| fault.of(Part::Scene))?;
    }
    for (i, material) in scene.materials.iter().enumerate() {
        check_material(material, scene.textures.len())
            .map_err(|fault| fault.of(Part::Material(i)))?;
    }
    let materials = scene.materials.len();
    for (i, mesh) in scene.meshes.iter().enumerate() {
        check_mesh(mesh, materials).map_err(|fault| fault.of(Part::Mesh(i)))?;
    }
    for (i, sphere) in scene.spheres.iter().enumerate() {
        check_sphere(sphere, materials).map_err(|fault| fault.of(Part::Sphere(i)))?;
    }
    check_lights(scene)?;
    let count = scene.meshes.iter().map(|m| m.triangles.len()).sum::<usize>();
    if count > MAX_TRIANGLES {
        let message = format!("the scene has {count} triangles; at most {MAX_TRIANGLES} are read");
        return Err(Problem::new(Part::Scene, "", message));
    }
    let dropped = drop_degenerate(scene);
    check_whole(scene, count)?;
    Ok(dropped)
}

/// What is wrong with a part of a description.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Fault {
    /// The field, as the project's own scene files spell it; may be empty.
    pub(crate) field: String,
    /// What, and what to do.
    pub(crate) message: String,
}

impl Fault {
    pub(crate) fn new(field: impl Into<String>, message: impl Into<String>) -> Self {
        Self { field: field.into(), message: message.into() }
    }

    /// With the part that has it.
    fn of(self, part: Part) -> Problem {
        Problem { part, field: self.field, message: self.message }
    }
}

fn check_film(scene: &SceneDescription) -> Result<(), Problem> {
    let (width, height) = (scene.width, scene.height);
    for (field, side) in [("width", width), ("height", height)] {
        if !(1..=MAX_FILM_SIDE).contains(&side) {
            let message =
                format!("the film's {field} is {side}; it must lie between 1 and {MAX_FILM_SIDE}");
            return Err(Problem::new(Part::Film, field, message));
        }
    }
    if u64::from(width) * u64::from(height) > MAX_FILM_PIXELS {
        let message = format!(
            "a film of {width} x {height} pixels is too large; at most {MAX_FILM_PIXELS} pixels"
        );
        return Err(Problem::new(Part::Film, "width", message));
    }
    if !(1..=MAX_EDGES).contains(&scene.max_edges) {
        let message = format!(
            "max_edges is {}; it must lie between 1 and {MAX_EDGES} (1 = a lamp seen directly)",
            scene.max_edges
        );
        return Err(Problem::new(Part::Scene, "max_edges", message));
    }
    Ok(())
}

fn check_camera(scene: &SceneDescription) -> Result<(), Problem> {
    let pose = &scene.camera;
    for (field, point) in [("origin", pose.origin), ("target", pose.target), ("up", pose.up)] {
        check_point(point).map_err(|m| Problem::new(Part::Camera, field, m))?;
    }
    if let Some(lens) = scene.lens {
        for (field, length) in [("lens_radius", lens.radius), ("focus_distance", lens.focus)] {
            if !(length > 0.0 && length <= MAX_COORDINATE) {
                let message = format!("{length} must be positive and at most {MAX_COORDINATE:e}");
                return Err(Problem::new(Part::Camera, field, message));
            }
        }
    }
    Camera::new(pose, scene.width, scene.height)
        .map(|_| ())
        .map_err(|error| Problem::new(Part::Camera, "", error.to_string()))
}

/// A message when `point` is no place for anything.
pub(crate) fn check_point(point: DVec3) -> Result<(), String> {
    if !point.is_finite() {
        return Err(format!(
            "({}, {}, {}) holds a number that is not finite",
            point.x, point.y, point.z
        ));
    }
    if point.abs().max_element() > MAX_COORDINATE {
        return Err(format!(
            "({:e}, {:e}, {:e}) is too far away; coordinates must stay within {MAX_COORDINATE:e}: \
            use a larger unit",
            point.x, point.y, point.z
        ));
    }
    Ok(())
}

fn check_mesh(mesh: &Mesh, materials: usize) -> Result<(), Fault> {
    for (i, &position) in mesh.positions.iter().enumerate() {
        check_point(position).map_err(|m| Fault::new("positions", format!("position {i}: {m}")))?;
    }
    let vertices = mesh.positions.len();
    for (i, triangle) in mesh.triangles.iter().enumerate() {
        if let Some(bad) = triangle.iter().find(|&&v| v as usize >= vertices) {
            let message = format!(
                "triangle {i} refers to position {bad}, but there are only {vertices} (counted \
                 from 0)"
            );
            return Err(Fault::new("triangles", message));
        }
    }
    if mesh.materials.len() != mesh.triangles.len() {
        let message = format!(
            "{} triangles, but {} material indices",
            mesh.triangles.len(),
            mesh.materials.len()
        );
        return Err(Fault::new("material", message));
    }
    check_corners(mesh)?;
    match mesh.materials.iter().find(|&&m| usize::from(m) >= materials) {
        Some(bad) => {
            let message = format!("material {bad} does not exist; there are {materials}");
            Err(Fault::new("material", message))
        }
        None => Ok(()),
    }
}

/// Normals and texture coordinates: none, or three finite ones a triangle.
fn check_corners(mesh: &Mesh) -> Result<(), Fault> {
    let triangles = mesh.triangles.len();
    let listed = |field: &'static str, count: usize| {
        let message = || format!("{triangles} triangles, but {count} triples of {field}");
        if count == 0 || count == triangles { Ok(()) } else { Err(Fault::new(field, message())) }
    };
    listed("normals", mesh.normals.len())?;
    listed("texcoords", mesh.texcoords.len())?;
    let not_finite = |i| format!("triangle {i} holds a number that is not finite");
    if let Some(i) = mesh.normals.iter().position(|t| !t.iter().all(|n| n.is_finite())) {
        return Err(Fault::new("normals", not_finite(i)));
    }
    match mesh.texcoords.iter().position(|t| !t.iter().all(|uv| uv.is_finite())) {
        Some(i) => Err(Fault::new("texcoords", not_finite(i))),
        None => Ok(()),
    }
}

fn check_sphere(sphere: &Sphere, materials: usize) -> Result<(), Fault> {
    check_point(sphere.centre).map_err(|m| Fault::new("centre", m))?;
    if !(sphere.radius > 0.0 && sphere.radius <= MAX_COORDINATE) {
        let message = format!("{} must be positive and at most {MAX_COORDINATE:e}", sphere.radius);
        return Err(Fault::new("radius", message));
    }
    if usize::from(sphere.material) >= materials {
        let message = format!("material {} does not exist", sphere.material);
        return Err(Fault::new("material", message));
    }
    Ok(())
}

fn drop_degenerate(scene: &mut SceneDescription) -> Vec<Dropped> {
    let mut dropped = Vec::new();
    for (index, mesh) in scene.meshes.iter_mut().enumerate() {
        let before = mesh.triangles.len();
        let keep: Vec<bool> =
            mesh.triangles.iter().map(|&t| !is_degenerate(&mesh.positions, t)).collect();
        keep_flagged(&mut mesh.triangles, &keep);
        keep_flagged(&mut mesh.materials, &keep);
        keep_flagged(&mut mesh.normals, &keep);
        keep_flagged(&mut mesh.texcoords, &keep);
        let triangles = before - mesh.triangles.len();
        if triangles > 0 {
            dropped.push(Dropped { mesh: index, triangles });
        }
    }
    scene.meshes.retain(|mesh| !mesh.triangles.is_empty());
    dropped
}

/// Keeps the items whose flag is set; an empty list stays empty.
fn keep_flagged<T>(items: &mut Vec<T>, keep: &[bool]) {
    let mut flags = keep.iter();
    items.retain(|_| flags.next().copied().unwrap_or(false));
}

/// True for a triangle without area, to the precision of its coordinates.
fn is_degenerate(positions: &[DVec3], triangle: [u32; 3]) -> bool {
    let corner = |i: usize| positions.get(triangle[i] as usize).copied().unwrap_or_default();
    let (a, b, c) = (corner(0), corner(1), corner(2));
    let longest = (b - a).length_squared().max((c - b).length_squared());
    let longest = longest.max((a - c).length_squared());
    !((b - a).cross(c - a).length() > DEGENERATE * longest)
}

fn check_whole(scene: &SceneDescription, triangles: usize) -> Result<(), Problem> {
    if scene.meshes.is_empty() && scene.spheres.is_empty() {
        let message = if triangles == 0 {
            "the scene has no surface: it needs at least one triangle or sphere".to_owned()
        } else {
            format!("none of the scene's {triangles} triangles has any area")
        };
        return Err(Problem::new(Part::Scene, "", message));
    }
    let emits = |&material: &u16| {
        scene.materials.get(usize::from(material)).is_some_and(|m| !m.emission.is_black())
    };
    let lit = scene.meshes.iter().any(|mesh| mesh.materials.iter().any(emits))
        || scene.spheres.iter().any(|sphere| emits(&sphere.material))
        || scene.lights.iter().any(|light| !light.kind.is_dark());
    if lit {
        return Ok(());
    }
    let unused = scene.materials.iter().find(|m| !m.emission.is_black());
    let message = match unused {
        Some(material) => format!(
            "the scene has no light: material `{}` emits, but no surface of non-zero area uses it",
            material.name
        ),
        None => "the scene has no light: give some surface a material that emits (`emission` in \
                 .toml, `Ke` in .mtl), or add `[[lights]]`"
            .to_owned(),
    };
    Err(Problem::new(Part::Scene, "", message))
}
