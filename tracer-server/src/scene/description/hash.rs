//! A digest of a scene's content: the key under which viewers cache its geometry.

use common::Rgb;
use glam::{DAffine2, DMat3, DVec3};

use super::{LightKind, SceneDescription, Texels};
use crate::bsdf::{BsdfDescription, ColorInput, NumberInput, Value};

/// Hex digest of everything that the picture depends on, names included.
pub(crate) fn digest(description: &SceneDescription) -> String {
    let mut h = Digest(blake3::Hasher::new());
    h.text(&description.name);
    h.camera(description);
    for material in &description.materials {
        h.text(&material.name);
        h.color(material.emission);
        h.0.update(&[u8::from(material.two_sided)]);
        h.bsdf(material.bsdf);
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
        match &texture.texels {
            Texels::Codes(codes, coding) => {
                h.count(*coding as usize);
                h.0.update(codes.as_flattened());
            }
            Texels::Numbers(numbers) => {
                h.text("numbers");
                h.0.update(bytemuck::cast_slice(numbers));
            }
        }
        if texture.placing != DAffine2::IDENTITY {
            texture.placing.to_cols_array().into_iter().for_each(|x| h.number(x));
        }
    }
    for sphere in &description.spheres {
        h.text(&sphere.name);
        h.point(sphere.centre);
        h.number(sphere.radius);
        h.count(usize::from(sphere.material));
        if sphere.turn != DMat3::IDENTITY {
            sphere.turn.to_cols_array().into_iter().for_each(|x| h.number(x));
        }
    }
    for light in &description.lights {
        h.text(&light.name);
        h.kind(&light.kind);
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

    fn kind(&mut self, kind: &LightKind) {
        self.color(kind.color());
        match kind {
            LightKind::Point { position, .. } => {
                self.text("point");
                self.point(*position);
            }
            LightKind::Spot { position, direction, cutoff, beam, .. } => {
                self.text("spot");
                self.point(*position);
                self.point(*direction);
                self.number(*cutoff);
                self.number(*beam);
            }
            LightKind::Directional { direction, .. } => {
                self.text("directional");
                self.point(*direction);
            }
            LightKind::Environment { image, rotation, .. } => {
                self.text("environment");
                rotation.to_cols_array().into_iter().for_each(|x| self.number(x));
                if let Some(image) = image {
                    self.count(image.width);
                    self.count(image.height);
                    self.0.update(bytemuck::cast_slice(&image.texels));
                }
            }
        }
    }

    /// Every parameter under its name, so that no two models are taken for each other.
    fn bsdf(&mut self, mut bsdf: BsdfDescription) {
        self.text(bsdf.name());
        bsdf.parameters(&mut |name, mut value| {
            self.text(name);
            self.count(value.texture().map_or(0, |texture| 1 + usize::from(*texture)));
            match value {
                Value::Share(color)
                | Value::Indices(color)
                | Value::ShareInput(
                    ColorInput::Constant(color) | ColorInput::Texture { factor: color, .. },
                ) => self.color(*color),
                Value::Number(number, _)
                | Value::NumberInput(
                    NumberInput::Constant(number) | NumberInput::Texture { factor: number, .. },
                    _,
                ) => self.number(*number),
                Value::Flag(flag) => self.count(usize::from(*flag)),
            }
        });
    }
}
