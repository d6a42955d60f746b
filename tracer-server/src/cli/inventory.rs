//! What a scene holds, counted and measured: the content of `tracer-server info`.

use std::f64::consts::PI;

use common::{CameraPose, Rgb};
use glam::DVec3;
use serde::Serialize;

use crate::bsdf::{Bsdf, BsdfDescription, Inputs as _, Value};
use crate::scene::load::Loaded;
use crate::scene::{Material, Mesh, Scene, SceneDescription};

/// Everything that is reported about a scene; lengths in the units of its file.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Inventory {
    /// The scene's name.
    pub(crate) name: String,
    /// Digest of its content.
    pub(crate) hash: String,
    /// Number of triangles.
    pub(crate) triangles: usize,
    /// Number of analytic spheres.
    pub(crate) spheres: usize,
    /// Smallest and largest coordinates.
    pub(crate) bounds: [[f64; 3]; 2],
    /// The render camera.
    pub(crate) camera: CameraPose,
    /// Width and height in pixels.
    pub(crate) film: [u32; 2],
    /// Longest path in edges.
    pub(crate) max_edges: usize,
    /// The materials.
    pub(crate) materials: Vec<MaterialRow>,
    /// The materials that emit.
    pub(crate) lights: Vec<LightRow>,
    /// What the tracer has to deal with.
    pub(crate) features: Vec<&'static str>,
    /// What it may leave out.
    pub(crate) switched_off: Vec<&'static str>,
    /// What in the file is not supported, and what was repaired.
    pub(crate) warnings: Vec<String>,
    /// Time to read and check the files, in seconds.
    pub(crate) load_seconds: f64,
    /// Time to build what is traced, in seconds.
    pub(crate) build_seconds: f64,
}

/// One material.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct MaterialRow {
    /// Its name.
    pub(crate) name: String,
    /// Its scattering model.
    pub(crate) model: &'static str,
    /// Its reflectance at normal incidence, or its transmittance for glass.
    pub(crate) color: Rgb,
    /// Its index of refraction, for glass.
    pub(crate) eta: Option<f64>,
    /// Roughness of its facets (alpha of GGX), if it may be rough; the mean of a texture.
    pub(crate) roughness: Option<f64>,
    /// The radiance it emits.
    pub(crate) emission: Rgb,
    /// Number of triangles and spheres of it.
    pub(crate) shapes: usize,
}

/// All shapes of one emitting material.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct LightRow {
    /// The name of the material, or of a light without a surface.
    pub(crate) material: String,
    /// What it is.
    pub(crate) kind: &'static str,
    /// Number of triangles and spheres.
    pub(crate) shapes: usize,
    /// Their area in square units of the file.
    pub(crate) area: f64,
    /// Radiance emitted to the front or from the environment; intensity of points and spots;
    /// irradiance of the sun.
    pub(crate) radiance: Rgb,
    /// Flux into the scene, in luminance and units of the file.
    pub(crate) power: f64,
}

impl Inventory {
    /// Counts and measures; loading times are still zero.
    pub(crate) fn new(loaded: &Loaded, scene: &Scene) -> Self {
        let description = &loaded.description;
        let usage = usage(description);
        let (low, high) = bounds(description);
        let features = scene.features();
        let told = loaded.warnings.iter().map(ToString::to_string);
        Self {
            name: description.name.clone(),
            hash: scene.hash().to_owned(),
            triangles: description.meshes.iter().map(|mesh| mesh.triangles.len()).sum(),
            spheres: description.spheres.len(),
            bounds: [low.to_array(), high.to_array()],
            camera: description.camera,
            film: [description.width, description.height],
            max_edges: description.max_edges,
            materials: material_rows(description, scene, &usage),
            lights: light_rows(description, &usage).into_iter().chain(lamp_rows(scene)).collect(),
            features: features.present(),
            switched_off: features.switched_off(),
            warnings: told.chain(scene.warnings().iter().cloned()).collect(),
            load_seconds: 0.0,
            build_seconds: 0.0,
        }
    }
}

/// How much of a scene one material covers.
#[derive(Clone, Copy, Debug, Default)]
struct Usage {
    shapes: usize,
    area: f64,
}

fn usage(description: &SceneDescription) -> Vec<Usage> {
    let mut usage = vec![Usage::default(); description.materials.len()];
    let mut add = |material: u16, area: f64| {
        if let Some(entry) = usage.get_mut(usize::from(material)) {
            entry.shapes += 1;
            entry.area += area;
        }
    };
    for mesh in &description.meshes {
        for (triangle, &material) in mesh.triangles.iter().zip(&mesh.materials) {
            let [a, b, c] = corners(mesh, *triangle);
            add(material, 0.5 * (b - a).cross(c - a).length());
        }
    }
    for sphere in &description.spheres {
        add(sphere.material, 4.0 * PI * sphere.radius * sphere.radius);
    }
    usage
}

fn corners(mesh: &Mesh, triangle: [u32; 3]) -> [DVec3; 3] {
    triangle.map(|vertex| mesh.positions.get(vertex as usize).copied().unwrap_or_default())
}

fn bounds(description: &SceneDescription) -> (DVec3, DVec3) {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let mut include = |point: DVec3| {
        low = low.min(point);
        high = high.max(point);
    };
    for mesh in &description.meshes {
        for triangle in &mesh.triangles {
            corners(mesh, *triangle).into_iter().for_each(&mut include);
        }
    }
    for sphere in &description.spheres {
        include(sphere.centre - sphere.radius);
        include(sphere.centre + sphere.radius);
    }
    (low, high)
}

fn material_rows(
    description: &SceneDescription,
    scene: &Scene,
    usage: &[Usage],
) -> Vec<MaterialRow> {
    let models = scene.models();
    let row = |((material, model), usage): ((&Material, &Bsdf), &Usage)| {
        let (eta, roughness) = numbers_of(material.bsdf, description);
        MaterialRow {
            name: material.name.clone(),
            model: model.name(),
            color: model.preview_color(),
            eta,
            roughness,
            emission: material.emission,
            shapes: usage.shapes,
        }
    };
    description.materials.iter().zip(models).zip(usage).map(row).collect()
}

/// A model's index of refraction, where it is the same for all colours, and its roughness.
fn numbers_of(
    mut bsdf: BsdfDescription,
    description: &SceneDescription,
) -> (Option<f64>, Option<f64>) {
    let (mut eta, mut roughness) = (None, None);
    bsdf.parameters(&mut |name, value| {
        let number = match value {
            Value::Number(number, _) => Some(*number),
            Value::NumberInput(input, _) => Some(description.number(*input)),
            Value::Share(_) | Value::ShareInput(_) | Value::Indices(_) | Value::Flag(_) => None,
        };
        match name {
            "eta" => eta = number,
            "roughness" => roughness = number,
            _ => {}
        }
    });
    (eta, roughness)
}

fn light_rows(description: &SceneDescription, usage: &[Usage]) -> Vec<LightRow> {
    let lit = description
        .materials
        .iter()
        .zip(usage)
        .filter(|(material, usage)| !material.emission.is_black() && usage.shapes > 0);
    lit.map(|(material, usage)| LightRow {
        material: material.name.clone(),
        kind: "surface",
        shapes: usage.shapes,
        area: usage.area,
        radiance: material.emission,
        power: PI * usage.area * material.emission.luminance(),
    })
    .collect()
}

fn lamp_rows(scene: &Scene) -> impl Iterator<Item = LightRow> {
    scene.lamps().map(|lamp| LightRow {
        material: lamp.name.to_owned(),
        kind: lamp.kind,
        shapes: 0,
        area: 0.0,
        radiance: lamp.color,
        power: lamp.power,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::load::load;

    #[test]
    fn a_box_of_two_units_is_measured() {
        let loaded = load("furnace").expect("built in");
        let scene = Scene::new(&loaded.description).expect("a sound scene");
        let inventory = Inventory::new(&loaded, &scene);
        assert_eq!((inventory.triangles, inventory.spheres), (12, 0));
        assert_eq!(inventory.bounds, [[-1.0; 3], [1.0; 3]]);
        let light = &inventory.lights[0];
        assert!((light.area - 24.0).abs() < 1e-12, "six sides of four: {}", light.area);
        assert!((light.power - PI * 12.0).abs() < 1e-9, "radiance one half: {}", light.power);
        assert!(inventory.features.is_empty() && inventory.switched_off.len() == 7);
    }

    #[test]
    fn a_sphere_counts_with_its_extent() {
        let loaded = load("caustic").expect("built in");
        let scene = Scene::new(&loaded.description).expect("a sound scene");
        let inventory = Inventory::new(&loaded, &scene);
        let glass = inventory.materials.iter().find(|row| row.model == "dielectric");
        assert_eq!(glass.map(|row| (row.eta, row.shapes)), Some((Some(1.5), 1)));
        assert_eq!(inventory.switched_off.len(), 5, "{:?}", inventory.switched_off);
    }
}
