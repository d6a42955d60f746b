//! Scenes with something hidden in them that no light reaches.
//!
//! The hidden thing makes the scene need a feature that it can do without: the transport then runs
//! its general code, and must make the same picture. So the gain of leaving a feature out can be
//! measured, and that leaving it out is right can be proved.

use std::sync::Arc;

use common::Rgb;
use glam::{DAffine2, DMat3, DVec3, Vec2, Vec3};
use tracer_server::bsdf::{ColorInput, LambertDescription, MirrorDescription};
use tracer_server::scene::load::load;
use tracer_server::scene::{
    Coding, Material, Mesh, Scene, SceneDescription, SceneFeatures, Sphere, Texels, Texture,
};

/// A name, and whether a scene has it.
pub(crate) type Feature = (&'static str, fn(SceneFeatures) -> bool);

/// What can be hidden.
pub(crate) const FEATURES: [Feature; 5] = [
    ("spheres", |f| f.spheres),
    ("shading normals", |f| f.shading_normals),
    ("textures", |f| f.textures),
    ("one-sided", |f| f.one_sided),
    ("specular", |f| f.specular),
];

/// The middle of the tall block of the built-in Cornell box.
const INSIDE: DVec3 = DVec3::new(-0.37, 0.6, -0.32);
/// The size of what is hidden there.
const SIZE: f64 = 0.01;

/// The Cornell box with a triangle in the tall block. With `feature`, the triangle, or a sphere
/// beside it, has this feature.
///
/// # Errors
///
/// When the scene could not be built.
pub(crate) fn cornell(side: u32, feature: Option<&str>) -> anyhow::Result<Scene> {
    let mut description = load("cornell")?.description;
    (description.width, description.height) = (side, side);
    let material = description.materials.len() as u16;
    let reflectance = ColorInput::Constant(Rgb::grey(0.5));
    let mut hidden = Material::new("hidden", LambertDescription { reflectance });
    let mut mesh = triangle(material);
    match feature {
        Some("spheres") => description.spheres.push(Sphere {
            turn: DMat3::IDENTITY,
            name: "hidden".to_owned(),
            centre: INSIDE + DVec3::X * 0.1,
            radius: SIZE,
            material,
        }),
        Some("shading normals") => mesh.normals = vec![[Vec3::new(0.1, 0.2, 1.0); 3]],
        Some("textures") => {
            mesh.texcoords = vec![[Vec2::ZERO, Vec2::X, Vec2::Y]];
            description.textures.push(checks());
            let reflectance = ColorInput::Texture { texture: 0, factor: Rgb::WHITE };
            hidden.bsdf = LambertDescription { reflectance }.into();
        }
        Some("one-sided") => hidden.two_sided = false,
        Some("specular") => hidden.bsdf = MirrorDescription { reflectance: Rgb::WHITE }.into(),
        _ => {}
    }
    add(&mut description, hidden, mesh);
    Ok(Scene::new(&description)?)
}

fn add(description: &mut SceneDescription, material: Material, mesh: Mesh) {
    description.materials.push(material);
    description.meshes.push(mesh);
}

fn triangle(material: u16) -> Mesh {
    Mesh {
        name: "hidden".to_owned(),
        positions: vec![INSIDE, INSIDE + DVec3::X * SIZE, INSIDE + DVec3::Y * SIZE],
        triangles: vec![[0, 1, 2]],
        materials: vec![material],
        ..Mesh::default()
    }
}

fn checks() -> Texture {
    Texture {
        name: "checks".to_owned(),
        width: 2,
        height: 1,
        texels: Texels::Codes(Arc::new([[20; 3], [230; 3]]), Coding::Srgb),
        placing: DAffine2::IDENTITY,
    }
}
