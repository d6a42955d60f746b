//! The project's own scene file: TOML, every key documented on the type that it fills.
//!
//! Lengths are in any one unit, angles in degrees, colours linear RGB with Rec. 709 primaries.
//! Unknown keys are errors: a misspelt key must not silently become a default.

use std::path::Path;

use common::{CameraPose, Rgb};
use glam::DVec3;
use serde::Deserialize;
use toml::Spanned;

use super::description::{BsdfDescription, Material, Mesh, SceneDescription, Sphere};
use super::diagnostic::{LoadError, Place, Warning};
use super::obj;
use super::origin::Origins;
use super::shape::{Cuboid, Quad, Step, Surface};
use super::strategies::{self, StrategySetting, StrategyTable};
use super::validate::Part;

/// A scene file, verbatim.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SceneFile {
    /// One line for people: what there is to see.
    #[serde(default)]
    pub(super) description: String,
    /// Longest path, in edges from light to camera (1 = a lamp seen directly); default 12.
    #[serde(default = "default_max_edges")]
    max_edges: usize,
    /// The picture's size; default 256 x 256.
    #[serde(default)]
    film: Film,
    /// The render camera.
    camera: Camera,
    /// What surfaces are made of: `[[materials]]`.
    #[serde(default)]
    materials: Vec<Spanned<MaterialEntry>>,
    /// Triangle meshes: `[[meshes]]`.
    #[serde(default)]
    meshes: Vec<Spanned<MeshEntry>>,
    /// Analytic spheres: `[[spheres]]`.
    #[serde(default)]
    spheres: Vec<Spanned<SphereEntry>>,
    /// Weights and sizes of the mutation strategies, by name: `[strategies]`.
    #[serde(default)]
    strategies: StrategyTable,
}

/// Longest path where a scene does not say, in edges.
pub(super) const DEFAULT_MAX_EDGES: usize = 12;

fn default_max_edges() -> usize {
    DEFAULT_MAX_EDGES
}

/// `[film]`: the picture's size.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Film {
    /// Width in pixels.
    width: u32,
    /// Height in pixels.
    height: u32,
}

impl Default for Film {
    fn default() -> Self {
        Self { width: 256, height: 256 }
    }
}

/// `[camera]`: an ideal pinhole.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Camera {
    /// The eye point.
    origin: DVec3,
    /// A point in the middle of the picture.
    target: DVec3,
    /// A direction that points up in the picture; default +y.
    #[serde(default = "plus_y")]
    up: DVec3,
    /// Full vertical field of view in degrees, between 0 and 180.
    vertical_fov: f64,
}

fn plus_y() -> DVec3 {
    DVec3::Y
}

/// `[[materials]]`: how a surface scatters and emits.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct MaterialEntry {
    /// The name that shapes refer to.
    name: String,
    /// `"lambert"`, `"mirror"` or `"dielectric"`.
    model: Model,
    /// Share of light reflected, in [0, 1]; a number or `[r, g, b]`. Needed by `lambert` and
    /// `mirror`; for `dielectric` a tint of what the Fresnel equations reflect, default 1.
    reflectance: Option<Color>,
    /// `dielectric` only: tint of what is refracted at each crossing, in [0, 1]; default 1.
    transmittance: Option<Color>,
    /// `dielectric` only, needed: index of refraction behind the surface over that in front.
    eta: Option<f64>,
    /// Radiance emitted from the front side, a number or `[r, g, b]`; default 0.
    emission: Option<Color>,
}

/// A scattering model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Model {
    /// Ideal diffuse reflection on both sides.
    Lambert,
    /// Ideal mirror on both sides.
    Mirror,
    /// A smooth boundary between two transparent media.
    Dielectric,
}

/// A grey value or a colour.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(untagged, expecting = "a number, or three numbers [r, g, b]")]
enum Color {
    /// The same in all channels.
    Grey(f64),
    /// Red, green and blue.
    Rgb(Rgb),
}

impl From<Color> for Rgb {
    fn from(color: Color) -> Self {
        match color {
            Color::Grey(value) => Self::grey(value),
            Color::Rgb(rgb) => rgb,
        }
    }
}

/// `[[meshes]]`: triangles, given in exactly one of four ways: `rectangle`, `box`, `positions`
/// with `triangles`, or `obj`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct MeshEntry {
    /// A name for people.
    name: String,
    /// Name of the material. Needed, but for `obj`, where it replaces the file's own materials.
    material: Option<String>,
    /// `{ corner, u, v }`: a parallelogram that faces `u` cross `v`.
    rectangle: Option<Quad>,
    /// `{ min, max }`: a box along the axes that faces outwards.
    #[serde(rename = "box")]
    cuboid: Option<Cuboid>,
    /// Vertex positions `[[x, y, z], ...]`.
    positions: Option<Vec<DVec3>>,
    /// Indices into `positions`, counted from 0; counter-clockwise seen from the front.
    triangles: Option<Vec<[u32; 3]>>,
    /// An OBJ file, relative to this one.
    obj: Option<String>,
    /// Steps that apply in order: `{ translate = [x, y, z] }`,
    /// `{ rotate = { axis = [x, y, z], degrees = d } }`, `{ scale = s }` or `{ scale = [x, y, z] }`.
    #[serde(default)]
    transform: Vec<Step>,
    /// True to turn the front sides to the back; default false.
    #[serde(default)]
    flip: bool,
}

/// `[[spheres]]`: an exact sphere whose front side is its outside.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct SphereEntry {
    /// A name for people.
    name: String,
    /// Name of the material.
    material: String,
    /// Its middle.
    centre: DVec3,
    /// Its radius, positive.
    radius: f64,
}

/// A scene file's content, before it is validated.
#[derive(Debug)]
pub(super) struct Read {
    /// The scene.
    pub(super) description: SceneDescription,
    /// Where its parts were written.
    pub(super) origins: Origins,
    /// What it asks for in vain.
    pub(super) warnings: Vec<Warning>,
    /// What it asks of the mutation strategies.
    pub(super) strategies: Vec<StrategySetting>,
}

/// Parses the text of a scene file.
pub(super) fn parse(text: &str, file: &Path) -> Result<SceneFile, LoadError> {
    toml::from_str(text).map_err(|error| {
        let start = error.span().map_or(0, |span| span.start);
        let message = error.message().replace('\n', "; ");
        Place::offset(file, text, start).error(message)
    })
}

/// Parses a scene file, and reads the files that it names, relative to `file`.
pub(super) fn read(text: &str, file: &Path, name: &str) -> Result<Read, LoadError> {
    let scene = parse(text, file)?;
    let camera = CameraPose {
        origin: scene.camera.origin,
        target: scene.camera.target,
        up: scene.camera.up,
        vertical_fov: scene.camera.vertical_fov,
    };
    let description = SceneDescription {
        name: name.to_owned(),
        camera,
        width: scene.film.width,
        height: scene.film.height,
        max_edges: scene.max_edges,
        materials: Vec::new(),
        textures: Vec::new(),
        meshes: Vec::new(),
        spheres: Vec::new(),
        lights: Vec::new(),
        lens: None,
    };
    let origins = Origins::of_text(file, text);
    let strategies = strategies::settings(&scene.strategies, text, file);
    let mut out = Read { description, origins, warnings: Vec::new(), strategies };
    for entry in &scene.materials {
        out.material(text, entry)?;
    }
    for entry in &scene.meshes {
        out.mesh(text, entry)?;
    }
    for entry in &scene.spheres {
        out.sphere(text, entry)?;
    }
    Ok(out)
}

impl Read {
    fn place<T>(&self, text: &str, entry: &Spanned<T>) -> Place {
        let place = Place::offset(&self.origins.whole.file, text, entry.span().start);
        Place { column: None, ..place }
    }

    fn error(&self, place: &Place, field: &str, message: impl Into<String>) -> LoadError {
        self.origins.field(place, field).error(message)
    }

    fn material(&mut self, text: &str, entry: &Spanned<MaterialEntry>) -> Result<(), LoadError> {
        let place = self.place(text, entry);
        let material = entry.get_ref();
        let name = &material.name;
        if let Some(before) = self.index_of(name) {
            let before = self.origins.of(Part::Material(before), "name");
            let message = format!("material `{name}` was defined before, at {before}; rename one");
            return Err(self.error(&place, "name", message));
        }
        let bsdf = material.bsdf().map_err(|(field, message)| {
            self.error(&place, field, format!("material `{name}`, {field}: {message}"))
        })?;
        self.description.materials.push(Material {
            emission: material.emission.map_or(Rgb::BLACK, Rgb::from),
            ..Material::new(name, bsdf)
        });
        self.origins.materials.push(place);
        Ok(())
    }

    fn index_of(&self, material: &str) -> Option<usize> {
        self.description.materials.iter().position(|m| m.name == material)
    }

    /// The index of a material, or an error that lists the names there are.
    fn material_index(&self, place: &Place, name: &str) -> Result<u16, LoadError> {
        let Some(index) = self.index_of(name) else {
            let names: Vec<&str> =
                self.description.materials.iter().take(40).map(|m| m.name.as_str()).collect();
            let names =
                if names.is_empty() { "none is defined".to_owned() } else { names.join(", ") };
            let message = format!("there is no material `{name}`; the materials: {names}");
            return Err(self.error(place, "material", message));
        };
        u16::try_from(index)
            .map_err(|_error| self.error(place, "material", "more than 65,536 materials"))
    }

    fn mesh(&mut self, text: &str, entry: &Spanned<MeshEntry>) -> Result<(), LoadError> {
        let place = self.place(text, entry);
        let mesh = entry.get_ref();
        let material = match &mesh.material {
            Some(name) => Some(self.material_index(&place, name)?),
            None => None,
        };
        let surfaces = match mesh.inline().map_err(|message| {
            self.error(&place, "name", format!("mesh `{}`: {message}", mesh.name))
        })? {
            Given::Inline(surface) => {
                let material = material.ok_or_else(|| {
                    let message =
                        format!("mesh `{}` has no material; add `material = \"...\"`", mesh.name);
                    self.error(&place, "name", message)
                })?;
                vec![(mesh.name.clone(), vec![material; surface.triangles.len()], surface)]
            }
            Given::File(name) => self.mesh_file(&place, mesh, name, material)?,
        };
        for (name, materials, mut surface) in surfaces {
            surface.transform(&mesh.transform).map_err(|message| {
                self.error(&place, "transform", format!("mesh `{name}`, transform: {message}"))
            })?;
            if mesh.flip {
                surface.flip();
            }
            let Surface { positions, triangles } = surface;
            let mesh = Mesh { name, positions, triangles, materials, ..Mesh::default() };
            self.description.meshes.push(mesh);
            self.origins.meshes.push(place.clone());
        }
        Ok(())
    }

    /// The groups of an OBJ file; its materials are appended unless `material` replaces them.
    fn mesh_file(
        &mut self,
        place: &Place,
        mesh: &MeshEntry,
        name: &str,
        material: Option<u16>,
    ) -> Result<Vec<(String, Vec<u16>, Surface)>, LoadError> {
        let folder = self.origins.whole.file.parent().unwrap_or_else(|| Path::new(""));
        let path = folder.join(name);
        let scene = obj::read(&path).map_err(|error| match error {
            LoadError::Unreadable { .. } => {
                self.error(place, "obj", format!("mesh `{}`, obj: {error}", mesh.name))
            }
            other => other,
        })?;
        let offset = self.description.materials.len();
        if material.is_none() {
            for (mut material, place) in scene.materials.into_iter().zip(scene.places) {
                if self.index_of(&material.name).is_some() {
                    material.name = format!("{}/{}", mesh.name, material.name);
                }
                self.description.materials.push(material);
                self.origins.materials.push(place);
            }
            self.warnings.extend(scene.warnings);
        }
        let too_many = || self.error(place, "obj", "more than 65,536 materials");
        let shift = u16::try_from(offset).map_err(|_error| too_many())?;
        let mut surfaces = Vec::new();
        for group in scene.meshes {
            let materials: Option<Vec<u16>> = group
                .materials
                .iter()
                .map(|own| material.map_or_else(|| own.checked_add(shift), Some))
                .collect();
            let surface = Surface { positions: group.positions, triangles: group.triangles };
            surfaces.push((group.name, materials.ok_or_else(too_many)?, surface));
        }
        Ok(surfaces)
    }

    fn sphere(&mut self, text: &str, entry: &Spanned<SphereEntry>) -> Result<(), LoadError> {
        let place = self.place(text, entry);
        let sphere = entry.get_ref();
        self.description.spheres.push(Sphere {
            name: sphere.name.clone(),
            centre: sphere.centre,
            radius: sphere.radius,
            material: self.material_index(&place, &sphere.material)?,
        });
        self.origins.spheres.push(place);
        Ok(())
    }
}

/// How a mesh is given.
enum Given<'a> {
    /// In the scene file itself.
    Inline(Surface),
    /// In the file of this name.
    File(&'a str),
}

impl MeshEntry {
    fn inline(&self) -> Result<Given<'_>, &'static str> {
        let Self { rectangle, cuboid, positions, triangles, obj, .. } = self;
        match (rectangle, cuboid, positions, triangles, obj) {
            (Some(quad), None, None, None, None) => Ok(Given::Inline(quad.surface())),
            (None, Some(cuboid), None, None, None) => {
                if cuboid.min.cmplt(cuboid.max).all() {
                    Ok(Given::Inline(cuboid.surface()))
                } else {
                    Err("each coordinate of the box's min must be below that of max")
                }
            }
            (None, None, Some(positions), Some(triangles), None) => {
                let (positions, triangles) = (positions.clone(), triangles.clone());
                Ok(Given::Inline(Surface { positions, triangles }))
            }
            (None, None, None, None, Some(file)) => Ok(Given::File(file)),
            (None, None, Some(_), None, None) => Err("positions need triangles"),
            (None, None, None, Some(_), None) => Err("triangles need positions"),
            _ => Err("give exactly one of rectangle, box, positions with triangles, or obj"),
        }
    }
}

impl MaterialEntry {
    /// The model with its parameters, or the field that is amiss.
    fn bsdf(&self) -> Result<BsdfDescription, (&'static str, &'static str)> {
        let needed = ("reflectance", "this model needs it: a number or [r, g, b] in [0, 1]");
        let reflectance = self.reflectance.map(Rgb::from);
        if self.model != Model::Dielectric {
            let glass_only = "only the model `dielectric` has it; remove it or change the model";
            if self.eta.is_some() {
                return Err(("eta", glass_only));
            }
            if self.transmittance.is_some() {
                return Err(("transmittance", glass_only));
            }
        }
        match self.model {
            Model::Lambert => {
                Ok(BsdfDescription::Lambert { reflectance: reflectance.ok_or(needed)?.into() })
            }
            Model::Mirror => {
                Ok(BsdfDescription::Mirror { reflectance: reflectance.ok_or(needed)? })
            }
            Model::Dielectric => Ok(BsdfDescription::Dielectric {
                eta: self.eta.ok_or(("eta", "the model `dielectric` needs it (glass is 1.5)"))?,
                reflectance: reflectance.unwrap_or(Rgb::WHITE),
                transmittance: self.transmittance.map_or(Rgb::WHITE, Rgb::from),
            }),
        }
    }
}
