//! The scene as a viewer draws it.

use std::f64::consts::{PI, TAU};

use common::{MaterialInfo, Rgb, SceneMesh, TexturePreview};
use glam::{DMat3, DVec3};

use super::surface::Ball;
use super::{Scene, SurfaceMaterial};

/// A sphere is drawn with this many segments round its equator.
const SEGMENTS: u32 = 48;
/// And this many from pole to pole.
const RINGS: u32 = 24;

impl Scene {
    /// All surfaces as flat-shaded triangles and smooth spheres, in scene units.
    pub fn preview_mesh(&self) -> SceneMesh {
        let mut pictures = Pictures::default();
        let mut mesh = SceneMesh {
            materials: self.material_infos(&mut pictures).collect(),
            objects: self.objects.clone(),
            camera: Some(self.camera),
            ..SceneMesh::default()
        };
        for (i, triangle) in self.accel.triangles().iter().enumerate() {
            let first = mesh.positions.len() as u32;
            mesh.positions.extend(triangle.corners().map(|c| c.as_vec3().to_array()));
            mesh.normals.extend([triangle.normal.as_vec3().to_array(); 3]);
            mesh.texcoords
                .extend(self.corners.texcoords(i).unwrap_or_default().map(|c| c.to_array()));
            self.push_triangle(&mut mesh, i as u32, [first, first + 1, first + 2]);
        }
        let first_ball = self.accel.triangles().len();
        for (i, ball) in self.accel.balls().iter().enumerate() {
            let turn = self.corners.turn(i);
            self.push_ball(&mut mesh, (first_ball + i) as u32, ball, turn.transpose());
        }
        if pictures.list.is_empty() {
            mesh.texcoords = Vec::new();
        }
        mesh.textures = pictures.list;
        mesh
    }

    fn push_triangle(&self, mesh: &mut SceneMesh, primitive: u32, corners: [u32; 3]) {
        mesh.triangles.push(corners);
        mesh.triangle_materials.push(self.material_of(primitive));
        mesh.primitives.push(primitive);
    }

    fn push_ball(&self, mesh: &mut SceneMesh, primitive: u32, ball: &Ball, axes: DMat3) {
        let first = mesh.positions.len() as u32;
        for ring in 0..=RINGS {
            let (sin, cos) = (PI * f64::from(ring) / f64::from(RINGS)).sin_cos();
            for segment in 0..=SEGMENTS {
                let (s, c) = (TAU * f64::from(segment) / f64::from(SEGMENTS)).sin_cos();
                let normal = axes * DVec3::new(sin * c, cos, sin * s);
                mesh.positions.push((ball.centre + ball.radius * normal).as_vec3().to_array());
                mesh.normals.push(normal.as_vec3().to_array());
                // As [`super::globe`] has it, but without its jump behind the ball.
                let across = segment as f32 / SEGMENTS as f32;
                mesh.texcoords.push([across, 1.0 - ring as f32 / RINGS as f32]);
            }
        }
        let row = SEGMENTS + 1;
        for ring in 0..RINGS {
            for segment in 0..SEGMENTS {
                let a = first + ring * row + segment;
                let (b, c, d) = (a + 1, a + row, a + row + 1);
                if ring > 0 {
                    self.push_triangle(mesh, primitive, [a, b, c]);
                }
                if ring + 1 < RINGS {
                    self.push_triangle(mesh, primitive, [b, d, c]);
                }
            }
        }
    }

    /// The surfaces' materials, then the lights without a surface.
    fn material_infos(&self, pictures: &mut Pictures) -> impl Iterator<Item = MaterialInfo> {
        let lamps = self.lamps().map(|lamp| MaterialInfo {
            name: lamp.name.to_owned(),
            model: lamp.kind.to_owned(),
            color: Rgb::BLACK,
            emission: lamp.color,
            transparent: false,
            texture: None,
        });
        self.surfaces.iter().map(|s| self.material_info(s, pictures)).chain(lamps)
    }

    fn material_info(&self, surface: &SurfaceMaterial, pictures: &mut Pictures) -> MaterialInfo {
        let emission: Rgb = surface.emission * self.radiance_scale();
        MaterialInfo {
            name: surface.name.clone(),
            model: surface.bsdf.name().to_owned(),
            color: surface.bsdf.preview_color(),
            emission,
            transparent: surface.bsdf.is_transparent(),
            texture: self.picture(surface, pictures),
        }
    }

    /// The picture that a surface's colour is read from; further ones than viewers take are left
    /// out, and their materials keep their mean colours.
    fn picture(&self, surface: &SurfaceMaterial, pictures: &mut Pictures) -> Option<u16> {
        let (texture, factor) = surface.textured?.color_texture()?;
        let map = self.maps.get(usize::from(texture))?;
        let known = pictures.read.iter().position(|read| *read == (texture, factor));
        let index = known.unwrap_or(pictures.read.len());
        if index == TexturePreview::MAX_COUNT {
            return None;
        }
        if known.is_none() {
            pictures.read.push((texture, factor));
            pictures.list.push(map.preview(factor));
        }
        Some(index as u16)
    }
}

/// The pictures found so far.
#[derive(Debug, Default)]
struct Pictures {
    /// Texture and factor of each.
    read: Vec<(u16, Rgb)>,
    list: Vec<TexturePreview>,
}

#[cfg(test)]
mod tests {
    use glam::{DAffine2, Vec2};

    use super::*;
    use crate::bsdf::{BsdfDescription, ColorInput, LambertDescription};
    use crate::scene::description::{Coding, Texels, Texture};
    use crate::scene::fixtures::diffuse_room;

    #[test]
    fn textures_reach_viewers_with_their_places() {
        let mut fixture = diffuse_room();
        let without = fixture.build().preview_mesh();
        assert!(without.textures.is_empty() && without.texcoords.is_empty(), "nothing to paint");
        let factor = Rgb::new(1.0, 0.5, 1.0);
        let painted = BsdfDescription::Lambert(LambertDescription {
            reflectance: ColorInput::Texture { texture: 0, factor },
        });
        fixture.description.textures.push(Texture {
            name: "checks".to_owned(),
            width: 2,
            height: 1,
            texels: Texels::Codes(vec![[255, 255, 0], [10, 0, 0]].into(), Coding::Srgb),
            placing: DAffine2::IDENTITY,
        });
        let material = fixture.material(painted, Rgb::BLACK);
        let floor = &mut fixture.description.meshes[2];
        let corners = [[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [0.0, 2.0]].map(Vec2::from);
        floor.texcoords = floor.triangles.iter().map(|t| t.map(|i| corners[i as usize])).collect();
        floor.materials.fill(material);
        let fixture = fixture.sphere(painted, Rgb::BLACK, [0.0, 0.0, 0.0], 0.2);
        let mesh = fixture.build().preview_mesh();
        let list = &mesh.textures;
        assert_eq!(list.len(), 1, "read by two materials, sent once");
        assert_eq!(list[0].texels, [[255, 188, 0], [10, 0, 0]], "with its factor");
        assert_eq!(mesh.texcoords.len(), mesh.positions.len(), "one a vertex");
        let textured = |triangle: usize| {
            let material = usize::from(mesh.triangle_materials[triangle]);
            mesh.materials[material].texture.is_some()
        };
        let triangles = 0..mesh.triangles.len();
        let first = triangles.clone().find(|t| textured(*t)).expect("the floor");
        let places = mesh.triangles[first].map(|i| mesh.texcoords[i as usize]);
        assert_eq!(places, [[0.0, 0.0], [3.0, 0.0], [3.0, 2.0]], "as the mesh has them");
        assert!(triangles.filter(|t| textured(*t)).count() > 100, "the ball, too");
    }
}
