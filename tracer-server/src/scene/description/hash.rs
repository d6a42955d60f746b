//! A digest of a scene's content: the key under which viewers cache its geometry.

use glam::DVec3;

use super::{BsdfDescription, ColorInput, Glow, NumberInput, SceneDescription};
use crate::bsdf::Fresnel;
use common::Rgb;

/// Hex digest of everything that the picture depends on, names included.
pub(crate) fn digest(description: &SceneDescription) -> String {
    let mut h = Digest(blake3::Hasher::new());
    h.text(&description.name);
    h.camera(description);
    for material in &description.materials {
        h.text(&material.name);
        h.color(material.emission);
        h.0.update(&[u8::from(material.two_sided)]);
        h.bsdf(&material.bsdf);
    }
    for mesh in &description.meshes {
        h.text(&mesh.name);
        h.count(mesh.positions.len());
        mesh.positions.iter().for_each(|&p| h.point(p));
        h.count(mesh.triangles.len());
        h.0.update(bytemuck::cast_slice(&mesh.triangles));
        h.0.update(bytemuck::cast_slice(&mesh.materials));
        h.count(mesh.normals.len());
        h.0.update(bytemuck::cast_slice(&mesh.normals));
        h.count(mesh.texcoords.len());
        h.0.update(bytemuck::cast_slice(&mesh.texcoords));
    }
    for texture in &description.textures {
        h.count(texture.width as usize);
        h.count(texture.height as usize);
        h.count(texture.coding as usize);
        h.0.update(texture.texels.as_flattened());
    }
    for sphere in &description.spheres {
        h.text(&sphere.name);
        h.point(sphere.centre);
        h.number(sphere.radius);
        h.count(usize::from(sphere.material));
    }
    for light in &description.lights {
        h.text(&light.name);
        h.glow(&light.glow);
    }
    h.0.finalize().to_hex()[..32].to_owned()
}

struct Digest(blake3::Hasher);

impl Digest {
    fn text(&mut self, text: &str) {
        self.count(text.len());
        self.0.update(text.as_bytes());
    }

    fn count(&mut self, n: usize) {
        self.0.update(&(n as u64).to_le_bytes());
    }

    fn number(&mut self, x: f64) {
        self.0.update(&x.to_bits().to_le_bytes());
    }

    fn point(&mut self, p: DVec3) {
        p.to_array().into_iter().for_each(|x| self.number(x));
    }

    fn color(&mut self, c: Rgb) {
        for x in <[f64; 3]>::from(c) {
            self.number(x);
        }
    }

    fn camera(&mut self, description: &SceneDescription) {
        let camera = &description.camera;
        for p in [camera.origin, camera.target, camera.up] {
            self.point(p);
        }
        self.number(camera.vertical_fov);
        self.count(description.width as usize);
        self.count(description.height as usize);
        self.count(description.max_edges);
        if let Some(lens) = description.lens {
            self.number(lens.radius);
            self.number(lens.focus);
        }
    }

    fn glow(&mut self, glow: &Glow) {
        self.color(glow.color());
        match glow {
            Glow::Point { position, .. } => self.point(*position),
            Glow::Spot { position, direction, cutoff, beam, .. } => {
                self.point(*position);
                self.point(*direction);
                self.number(*cutoff);
                self.number(*beam);
            }
            Glow::Directional { direction, .. } => self.point(*direction),
            Glow::Environment { image, rotation, .. } => {
                rotation.to_cols_array().into_iter().for_each(|x| self.number(x));
                if let Some(image) = image {
                    self.count(image.width);
                    self.count(image.height);
                    self.0.update(bytemuck::cast_slice(&image.texels));
                }
            }
        }
    }

    fn color_input(&mut self, input: ColorInput) {
        match input {
            ColorInput::Constant(color) => {
                self.count(0);
                self.color(color);
            }
            ColorInput::Texture { texture, factor } => {
                self.count(1 + usize::from(texture));
                self.color(factor);
            }
        }
    }

    fn number_input(&mut self, input: NumberInput) {
        match input {
            NumberInput::Constant(number) => {
                self.count(0);
                self.number(number);
            }
            NumberInput::Texture { texture, factor } => {
                self.count(1 + usize::from(texture));
                self.number(factor);
            }
        }
    }

    fn fresnel(&mut self, fresnel: Fresnel) {
        match fresnel {
            Fresnel::Constant(color) => {
                self.count(0);
                self.color(color);
            }
            Fresnel::Schlick(color) => {
                self.count(1);
                self.color(color);
            }
            Fresnel::Conductor { eta, k, tint } => {
                self.count(2);
                self.color(eta);
                self.color(k);
                self.color(tint);
            }
            Fresnel::Dielectric { eta, tint } => {
                self.count(3);
                self.number(eta);
                self.color(tint);
            }
        }
    }

    fn bsdf(&mut self, bsdf: &BsdfDescription) {
        match *bsdf {
            BsdfDescription::Lambert { reflectance } => {
                self.count(0);
                self.color_input(reflectance);
            }
            BsdfDescription::Mirror { reflectance } => {
                self.count(1);
                self.color(reflectance);
            }
            BsdfDescription::Dielectric { eta, reflectance, transmittance } => {
                self.count(2);
                self.number(eta);
                self.color(reflectance);
                self.color(transmittance);
            }
            BsdfDescription::RoughDielectric { eta, reflectance, transmittance, roughness } => {
                self.count(3);
                self.number(eta);
                self.color(reflectance);
                self.color(transmittance);
                self.number_input(roughness);
            }
            BsdfDescription::Conductor { fresnel, roughness } => {
                self.count(4);
                self.fresnel(fresnel);
                self.number_input(roughness);
            }
            BsdfDescription::Plastic { diffuse, fresnel, roughness, nonlinear } => {
                self.count(5);
                self.color_input(diffuse);
                self.fresnel(fresnel);
                self.number(roughness);
                self.count(usize::from(nonlinear));
            }
        }
    }
}
