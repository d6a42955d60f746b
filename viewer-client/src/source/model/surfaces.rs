//! Surfaces as the corners of triangles, each with its material's colour.

use common::{MaterialInfo, SceneMesh};
use shaders::{MeshVertex, material_kind};

/// Full scale of a normal's components.
const NORMAL_SCALE: f32 = 32767.0;

/// Three corners a triangle. Indices that point nowhere leave their triangle out.
pub fn corners(mesh: &SceneMesh) -> Vec<MeshVertex> {
    let colors: Vec<[u8; 4]> = mesh.materials.iter().map(color_code).collect();
    let mut corners = Vec::with_capacity(3 * mesh.triangles.len());
    for (triangle, material) in mesh.triangles.iter().zip(&mesh.triangle_materials) {
        let color = colors.get(usize::from(*material)).copied().unwrap_or([186, 186, 186, 0]);
        let texture = mesh.materials.get(usize::from(*material)).and_then(|m| m.texture);
        let texture = texture.and_then(|index| i16::try_from(index + 1).ok()).unwrap_or(0);
        let corner = |index: u32| {
            let position = *mesh.positions.get(index as usize)?;
            let normal = *mesh.normals.get(index as usize)?;
            let [x, y, z] = normal.map(|c| (c.clamp(-1.0, 1.0) * NORMAL_SCALE).round() as i16);
            let texcoord = mesh.texcoords.get(index as usize).copied().unwrap_or_default();
            Some(MeshVertex { position, normal: [x, y, z, texture], color, texcoord })
        };
        if let [Some(a), Some(b), Some(c)] = triangle.map(corner) {
            corners.extend([a, b, c]);
        }
    }
    corners
}

/// The square root of the colour to draw a material with, and its kind.
fn color_code(material: &MaterialInfo) -> [u8; 4] {
    let emission = material.emission;
    let (color, kind) = if emission.max_channel() > 0.0 {
        (emission / emission.max_channel(), material_kind::EMITTER)
    } else if material.transparent {
        (material.color, material_kind::TRANSPARENT)
    } else if material.model == "mirror" {
        (material.color, material_kind::MIRROR)
    } else {
        (material.color, material_kind::OPAQUE)
    };
    let [r, g, b] = color.to_f32().map(|c| (c.clamp(0.0, 1.0).sqrt() * 255.0).round() as u8);
    [r, g, b, kind]
}

#[cfg(test)]
mod tests {
    use common::Rgb;

    use super::*;

    fn material(model: &str, color: Rgb, emission: Rgb) -> MaterialInfo {
        let transparent = model == "dielectric";
        MaterialInfo {
            name: "m".into(),
            model: model.into(),
            color,
            emission,
            transparent,
            texture: (model == "painted").then_some(1),
        }
    }

    #[test]
    fn every_triangle_gets_its_material() {
        let mesh = SceneMesh {
            positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            normals: vec![[0.0, 0.0, 1.0]; 3],
            texcoords: vec![[0.0, 0.0], [2.0, 0.0], [0.0, 3.0]],
            textures: Vec::new(),
            triangles: vec![[0, 1, 2], [2, 1, 0], [0, 1, 9]],
            triangle_materials: vec![0, 1, 0],
            primitives: vec![0, 1, 2],
            materials: vec![
                material("painted", Rgb::new(1.0, 0.25, 0.0), Rgb::BLACK),
                material("lambert", Rgb::BLACK, Rgb::new(8.0, 2.0, 0.0)),
            ],
            ..SceneMesh::default()
        };
        let corners = corners(&mesh);
        assert_eq!(corners.len(), 6, "the triangle with a bad index is left out");
        assert_eq!(corners[0].color, [255, 128, 0, material_kind::OPAQUE], "its colour");
        assert_eq!(corners[3].color, [255, 128, 0, material_kind::EMITTER], "its light's hue");
        assert_eq!(corners[0].normal, [0, 0, 32767, 2], "its normal, and its texture from 1");
        assert_eq!(corners[1].texcoord, [2.0, 0.0], "where in the texture");
        assert_eq!(corners[3].normal[3], 0, "no texture");
        let glass = color_code(&material("dielectric", Rgb::WHITE, Rgb::BLACK));
        assert_eq!(glass[3], material_kind::TRANSPARENT, "glass");
        let mirror = color_code(&material("mirror", Rgb::WHITE, Rgb::BLACK));
        assert_eq!(mirror[3], material_kind::MIRROR, "mirror");
    }
}
