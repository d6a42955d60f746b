//! The project's own scene file: TOML, every key documented on the type that it fills.
//!
//! Lengths are in any one unit, angles in degrees, colours linear RGB with Rec. 709 primaries.
//! Unknown keys are errors: a misspelt key must not silently become a default.

mod light;
mod material;
mod strategies;

use std::path::Path;

use common::{CameraPose, Rgb};
use glam::{DMat3, DVec3, Vec2, Vec3};
use serde::Deserialize;
use toml::Spanned;

use super::obj;
use crate::scene::description::check::{Fault, Part};
use crate::scene::description::{Coding, Material, Mesh, SceneDescription, Sphere, ThinLens};
use crate::scene::reading::diagnostic::{LoadError, Place};
use crate::scene::reading::image::read_texture;
use crate::scene::reading::origin::Origins;
use crate::scene::reading::shape::{Cuboid, Quad, Step, Surface};
use crate::scene::reading::{DEFAULT_MAX_EDGES, Read};
use light::LightEntry;
use material::{MaterialEntry, ReadTexture};
use strategies::StrategyTable;

/// A scene file, verbatim.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SceneFile {
    /// One line for people: what there is to see.
    #[serde(default)]
    pub(crate) description: String,
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
    /// Lights without a surface: `[[lights]]`.
    #[serde(default)]
    lights: Vec<Spanned<LightEntry>>,
    /// Weights and sizes of the mutation strategies, by name: `[strategies]`.
    #[serde(default)]
    strategies: StrategyTable,
}

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

/// `[camera]`: an ideal pinhole, or a thin lens.
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
    /// Radius of the lens; a pinhole without.
    lens_radius: Option<f64>,
    /// Distance along the view of the plane that is sharp; default that of the target.
    focus_distance: Option<f64>,
}

fn plus_y() -> DVec3 {
    DVec3::Y
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
    /// Shading normals `[[x, y, z], ...]`, one a position; without them the mesh is flat.
    normals: Option<Vec<Vec3>>,
    /// Texture coordinates `[[u, v], ...]`, one a position; `v` runs upwards.
    texcoords: Option<Vec<Vec2>>,
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

/// Parses the text of a scene file.
pub(crate) fn parse(text: &str, file: &Path) -> Result<SceneFile, LoadError> {
    toml::from_str(text).map_err(|error| {
        let start = error.span().map_or(0, |span| span.start);
        let message = error.message().replace('\n', "; ");
        Place::offset(file, text, start).error(message)
    })
}

/// Parses a scene file, and reads the files that it names, relative to `file`.
pub(crate) fn read(text: &str, file: &Path, name: &str) -> Result<Read, LoadError> {
    let scene = parse(text, file)?;
    let camera = CameraPose {
        origin: scene.camera.origin,
        target: scene.camera.target,
        up: scene.camera.up,
        vertical_fov: scene.camera.vertical_fov,
    };
    let Film { width, height } = scene.film;
    let description = SceneDescription {
        lens: scene.camera.lens(),
        ..SceneDescription::empty(name, camera, [width, height], scene.max_edges)
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
    for entry in &scene.lights {
        out.light(text, entry)?;
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
            let message =
                format!("material `{name}` is already defined at {before}; rename one of them");
            return Err(self.error(&place, "name", message));
        }
        let (bsdf, warnings) = material.bsdf(self).map_err(|Fault { field, message }| {
            self.error(&place, &field, format!("material `{name}`, {field}: {message}"))
        })?;
        let told = warnings.into_iter().map(|w| format!("material `{name}`: {w}"));
        self.warnings.extend(told.map(|message| place.clone().warning(message)));
        self.description.materials.push(Material {
            two_sided: material.two_sided,
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
            let message = format!("there is no material `{name}`; the materials are {names}");
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
            let Surface { positions, triangles, normals, texcoords } = surface;
            let mesh = Mesh { name, positions, triangles, materials, normals, texcoords };
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
        let scene = obj::read(&path).map_err(|error| {
            if !matches!(error, LoadError::Unreadable { .. }) {
                return error;
            }
            self.error(place, "obj", format!("mesh `{}`, obj: {error}", mesh.name))
        })?;
        let offset = self.description.materials.len();
        let place_of_obj = self.origins.field(place, "obj");
        let too_many = |what| place_of_obj.clone().error(format!("more than 65,536 {what}"));
        if material.is_none() {
            let textures = u16::try_from(self.description.textures.len() + scene.textures.len())
                .map_err(|_error| too_many("textures"))?
                - scene.textures.len() as u16;
            self.description.textures.extend(scene.textures);
            for (mut material, place) in scene.materials.into_iter().zip(scene.places) {
                if self.index_of(&material.name).is_some() {
                    material.name = format!("{}/{}", mesh.name, material.name);
                }
                material.bsdf = material.bsdf.with_textures_after(textures);
                self.description.materials.push(material);
                self.origins.materials.push(place);
            }
            self.warnings.extend(scene.warnings);
        }
        let shift = u16::try_from(offset).map_err(|_error| too_many("materials"))?;
        let mut surfaces = Vec::new();
        for group in scene.meshes {
            let materials: Option<Vec<u16>> = group
                .materials
                .iter()
                .map(|own| material.map_or_else(|| own.checked_add(shift), Some))
                .collect();
            let Mesh { positions, triangles, normals, texcoords, .. } = group;
            let surface = Surface { positions, triangles, normals, texcoords };
            surfaces.push((group.name, materials.ok_or_else(|| too_many("materials"))?, surface));
        }
        Ok(surfaces)
    }

    fn light(&mut self, text: &str, entry: &Spanned<LightEntry>) -> Result<(), LoadError> {
        let place = self.place(text, entry);
        let folder = self.origins.whole.file.parent().unwrap_or_else(|| Path::new(""));
        let light = entry.get_ref().light(folder).map_err(|Fault { field, message }| {
            let message = format!("light `{}`: {message}", entry.get_ref().name);
            self.error(&place, &field, message)
        })?;
        self.description.lights.push(light);
        self.origins.lights.push(place);
        Ok(())
    }

    fn sphere(&mut self, text: &str, entry: &Spanned<SphereEntry>) -> Result<(), LoadError> {
        let place = self.place(text, entry);
        let sphere = entry.get_ref();
        self.description.spheres.push(Sphere {
            turn: DMat3::IDENTITY,
            name: sphere.name.clone(),
            centre: sphere.centre,
            radius: sphere.radius,
            material: self.material_index(&place, &sphere.material)?,
        });
        self.origins.spheres.push(place);
        Ok(())
    }
}

impl Camera {
    /// The lens, where the radius tells one.
    fn lens(&self) -> Option<ThinLens> {
        let to_target = || (self.target - self.origin).length();
        let focus = self.focus_distance.unwrap_or_else(to_target);
        self.lens_radius.map(|radius| ThinLens { radius, focus })
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
    /// The listed triangles with what the positions carry.
    fn listed(&self, positions: &[DVec3], triangles: &[[u32; 3]]) -> Result<Surface, &'static str> {
        let count = positions.len();
        if self.normals.as_ref().is_some_and(|normals| normals.len() != count) {
            return Err("there must be as many normals as positions");
        }
        if self.texcoords.as_ref().is_some_and(|texcoords| texcoords.len() != count) {
            return Err("there must be as many texcoords as positions");
        }
        Ok(Surface {
            positions: positions.to_vec(),
            triangles: triangles.to_vec(),
            normals: self.normals.as_deref().map_or_else(Vec::new, |n| at_corners(n, triangles)),
            texcoords: self
                .texcoords
                .as_deref()
                .map_or_else(Vec::new, |t| at_corners(t, triangles)),
        })
    }

    fn inline(&self) -> Result<Given<'_>, &'static str> {
        let Self { rectangle, cuboid, positions, triangles, obj, .. } = self;
        match (rectangle, cuboid, positions, triangles, obj) {
            (Some(quad), None, None, None, None) => Ok(Given::Inline(quad.surface())),
            (None, Some(cuboid), None, None, None) => {
                if cuboid.min.cmplt(cuboid.max).all() {
                    Ok(Given::Inline(cuboid.surface()))
                } else {
                    Err("each coordinate of the box's min must be less than that of max")
                }
            }
            (None, None, Some(positions), Some(triangles), None) => {
                self.listed(positions, triangles).map(Given::Inline)
            }
            (None, None, None, None, Some(file)) => Ok(Given::File(file)),
            (None, None, Some(_), None, None) => Err("positions need triangles"),
            (None, None, None, Some(_), None) => Err("triangles need positions"),
            _ => Err("give exactly one of rectangle, box, positions with triangles, or obj"),
        }
    }
}

/// The values at the corners of all triangles; of an index that does not exist the default, since
/// that index is refused later.
fn at_corners<T: Copy + Default>(values: &[T], triangles: &[[u32; 3]]) -> Vec<[T; 3]> {
    let value = |i: u32| values.get(i as usize).copied().unwrap_or_default();
    triangles.iter().map(|triangle| triangle.map(value)).collect()
}

impl ReadTexture for Read {
    fn read(&mut self, file: &str, coding: Coding) -> Result<u16, String> {
        let folder = self.origins.whole.file.parent().unwrap_or_else(|| Path::new(""));
        let texture = read_texture(&folder.join(file), coding)?;
        let textures = &mut self.description.textures;
        if let Some(known) = textures.iter().position(|other| *other == texture) {
            return u16::try_from(known).map_err(|error| error.to_string());
        }
        textures.push(texture);
        u16::try_from(textures.len() - 1).map_err(|_error| "more than 65,536 textures".to_owned())
    }
}
