//! Scenes in the XML format of the renderer Mitsuba, versions 0.6 and 3 [Jakob 2010; Jakob et al. 2022].
//!
//! What is understood becomes a [`SceneDescription`]; what is not is told, element by element.

mod bsdf;
mod document;
mod emitter;
mod include;
#[cfg(test)]
mod laws;
mod mesh;
mod palette;
mod ply;
mod sensor;
mod shape;
#[cfg(test)]
mod surface_tests;
mod texture;
mod transform;
mod value;

use std::path::Path;

use common::{CameraPose, Rgb};
use glam::DVec3;

use crate::scene::description::{MAX_EDGES, SceneDescription, Sphere};
use crate::scene::reading::diagnostic::{LoadError, Warning};
use crate::scene::reading::origin::Origins;
use crate::scene::reading::{DEFAULT_MAX_EDGES, Read, viewpoint};
use document::{Element, Source};
use include::Text;
use palette::Palette;
use shape::{Geometry, Shape};

/// Reads a scene file and the files that it names, relative to it.
pub(super) fn read(path: &Path, name: &str) -> Result<Read, LoadError> {
    let text = Text::read(path)?;
    let source = Source::parse(&text)?;
    let root = source.root().read();
    if root.tag() != "scene" {
        return Err(root.error("not a scene: the outermost element must be `<scene>`"));
    }
    if let Some(medium) = root.find("medium") {
        let message = "participating media are not supported, and the picture would be wrong \
            without them; remove every `<medium>` to render the surfaces alone";
        return Err(medium.error(message));
    }
    let mut loader = Loader::new(path, name);
    loader.scene(root)?;
    loader.warnings.extend(source.unread());
    Ok(loader.finish())
}

/// A scene as far as it has been read.
struct Loader {
    description: SceneDescription,
    origins: Origins,
    palette: Palette,
    warnings: Vec<Warning>,
}

impl Loader {
    fn new(path: &Path, name: &str) -> Self {
        let view = viewpoint::guess(&[]);
        let size = [view.width, view.height];
        let description = SceneDescription::empty(name, view.camera, size, DEFAULT_MAX_EDGES);
        let origins = Origins::of_file(path);
        Self { description, origins, palette: Palette::default(), warnings: Vec::new() }
    }

    fn scene(&mut self, root: Element<'_>) -> Result<(), LoadError> {
        self.integrator(root)?;
        for shape in root.objects("shape")? {
            self.shape(shape)?;
        }
        for emitter in root.objects("emitter")? {
            if let Some(light) = emitter::read(emitter, &mut self.warnings)? {
                self.description.lights.push(light);
                self.origins.lights.push(emitter.place());
            }
        }
        self.sensor(root)
    }

    /// The limit on the length of paths, in edges from light to camera, which is the renderer's own
    /// way to count; how to sample is the user's choice and not the scene's.
    fn integrator(&mut self, root: Element<'_>) -> Result<(), LoadError> {
        let Some(integrator) = root.objects("integrator")?.first().copied() else { return Ok(()) };
        // An integrator may be wrapped in another one.
        let inner = integrator.objects("integrator")?.first().copied().unwrap_or(integrator);
        // Direct light is a light, a surface and the camera.
        let edges = match inner.plugin()?.as_str() {
            "direct" => 2,
            _ => inner.integer("max_depth")?.unwrap_or(-1),
        };
        match usize::try_from(edges) {
            Ok(edges) if edges > MAX_EDGES => {
                let message = format!("max_depth is {edges}; {MAX_EDGES} is used");
                self.warnings.push(inner.warning(message));
                self.description.max_edges = MAX_EDGES;
            }
            Ok(edges) => self.description.max_edges = edges,
            Err(_) => {
                let message = format!("paths without an end: {DEFAULT_MAX_EDGES} edges are used");
                self.warnings.push(inner.warning(message));
            }
        }
        Ok(())
    }

    fn sensor(&mut self, root: Element<'_>) -> Result<(), LoadError> {
        let sensors = root.objects("sensor")?;
        let view = if let Some(&sensor) = sensors.first() {
            let read = sensor::read(sensor)?;
            self.warnings.extend(read.warnings);
            if self.is_clipped(&read.view.camera, read.clip) {
                let message = "near_clip and far_clip are ignored: everything is shown, whatever \
                    its distance";
                self.warnings.push(sensor.warning(message));
            }
            self.origins.camera = sensor.place();
            self.description.lens = read.lens;
            read.view
        } else {
            let message = "no `<sensor>`: the point of view is a guess";
            self.warnings.push(root.warning(message));
            viewpoint::guess(&self.description.meshes)
        };
        for other in sensors.iter().skip(1) {
            self.warnings.push(other.warning("only the first sensor is used"));
        }
        self.description.camera = view.camera;
        self.description.width = view.width;
        self.description.height = view.height;
        Ok(())
    }

    /// True when some corner before the camera lies outside the depths of `clip`.
    fn is_clipped(&self, camera: &CameraPose, clip: [f64; 2]) -> bool {
        let forward = (camera.target - camera.origin).normalize_or_zero();
        let outside = |point: DVec3, reach: f64| {
            let depth = (point - camera.origin).dot(forward);
            depth + reach > 0.0 && (depth - reach < clip[0] || depth + reach > clip[1])
        };
        let description = &self.description;
        let corners = description.meshes.iter().flat_map(|mesh| &mesh.positions);
        corners.into_iter().any(|&corner| outside(corner, 0.0))
            || description.spheres.iter().any(|ball| outside(ball.centre, ball.radius))
    }

    fn shape(&mut self, element: Element<'_>) -> Result<(), LoadError> {
        let Shape { name, geometry, warnings } = shape::read(element)?;
        self.warnings.extend(warnings);
        let Some(material) = self.material_of(element, &name)? else {
            self.warnings.push(element.warning("ignored, because nothing can see it"));
            return Ok(());
        };
        match geometry {
            Geometry::Meshes(meshes) => {
                for mut mesh in meshes {
                    mesh.materials = vec![material; mesh.triangles.len()];
                    self.description.meshes.push(mesh);
                    self.origins.meshes.push(element.place());
                }
            }
            Geometry::Sphere { centre, radius, turn, inwards } => {
                let turned =
                    if inwards { self.inside_out(element, material)? } else { Some(material) };
                if let Some(material) = turned {
                    self.description.spheres.push(Sphere { name, centre, radius, turn, material });
                    self.origins.spheres.push(element.place());
                } else {
                    let message = "its front is its inside, so it becomes a mesh";
                    self.warnings.push(element.warning(message));
                    let mut mesh = shape::hollow(centre, radius, turn);
                    mesh.name = name;
                    mesh.materials = vec![material; mesh.triangles.len()];
                    self.description.meshes.push(mesh);
                    self.origins.meshes.push(element.place());
                }
            }
        }
        Ok(())
    }

    /// The index of a shape's material; `None` for a surface that nobody sees.
    fn material_of(&mut self, shape: Element<'_>, name: &str) -> Result<Option<u16>, LoadError> {
        let emission = emission_of(shape)?;
        let models = shape.objects("bsdf")?;
        let base = match models.first() {
            Some(&model) => match self.palette.material(model)? {
                None => return Ok(None),
                index => index,
            },
            None => None,
        };
        let place = shape.place();
        match (base, emission) {
            (base, Some(emission)) => self.palette.lamp(base, name, emission, place).map(Some),
            (Some(index), None) => Ok(Some(index)),
            (None, None) => self.palette.default_material(place).map(Some),
        }
    }

    /// The material of an exact sphere, whose front is its outside, that looks like `material` with the
    /// inside for its front; `None` where there is none.
    fn inside_out(
        &mut self,
        element: Element<'_>,
        material: u16,
    ) -> Result<Option<u16>, LoadError> {
        if let Some(index) = self.palette.inside_out(material, element.place())? {
            return Ok(Some(index));
        }
        let opaque = self.palette.materials.get(usize::from(material));
        let same = opaque.is_some_and(|m| m.two_sided && m.emission.is_black());
        Ok(same.then_some(material))
    }

    fn finish(self) -> Read {
        let Self { mut description, mut origins, palette, mut warnings } = self;
        description.materials = palette.materials;
        description.textures = palette.textures.list;
        origins.materials = palette.places;
        warnings.extend(palette.textures.warnings);
        Read { description, origins, warnings, strategies: Vec::new() }
    }
}

/// The radiance that a shape emits to its front.
fn emission_of(shape: Element<'_>) -> Result<Option<Rgb>, LoadError> {
    let Some(emitter) = shape.objects("emitter")?.first().copied() else { return Ok(None) };
    if emitter.plugin()? != "area" {
        return Err(emitter.error("a shape can only have an emitter of type `area`"));
    }
    let radiance = emitter.color("radiance")?;
    radiance.map(Some).ok_or_else(|| emitter.error("the parameter `radiance` is missing"))
}
