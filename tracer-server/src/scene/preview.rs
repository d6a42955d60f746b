//! The scene as a viewer draws it.

use std::f64::consts::{PI, TAU};

use common::{MaterialInfo, Rgb, SceneMesh};
use glam::DVec3;

use super::Scene;
use super::surface::Ball;

/// A sphere is drawn with this many segments round its equator.
const SEGMENTS: u32 = 48;
/// And this many from pole to pole.
const RINGS: u32 = 24;

impl Scene {
    /// All surfaces as flat-shaded triangles and smooth spheres, in scene units.
    pub fn preview_mesh(&self) -> SceneMesh {
        let mut mesh = SceneMesh {
            materials: self.material_infos().collect(),
            objects: self.objects.clone(),
            camera: Some(self.camera),
            ..SceneMesh::default()
        };
        for (i, triangle) in self.accel.triangles().iter().enumerate() {
            let first = mesh.positions.len() as u32;
            mesh.positions.extend(triangle.corners().map(|c| c.as_vec3().to_array()));
            mesh.normals.extend([triangle.normal.as_vec3().to_array(); 3]);
            self.push_triangle(&mut mesh, i as u32, [first, first + 1, first + 2]);
        }
        let first_ball = self.accel.triangles().len();
        for (i, ball) in self.accel.balls().iter().enumerate() {
            self.push_ball(&mut mesh, (first_ball + i) as u32, ball);
        }
        mesh
    }

    fn push_triangle(&self, mesh: &mut SceneMesh, primitive: u32, corners: [u32; 3]) {
        mesh.triangles.push(corners);
        mesh.triangle_materials.push(self.material_of(primitive));
        mesh.primitives.push(primitive);
    }

    fn push_ball(&self, mesh: &mut SceneMesh, primitive: u32, ball: &Ball) {
        let first = mesh.positions.len() as u32;
        for ring in 0..=RINGS {
            let (sin, cos) = (PI * f64::from(ring) / f64::from(RINGS)).sin_cos();
            for segment in 0..=SEGMENTS {
                let (s, c) = (TAU * f64::from(segment) / f64::from(SEGMENTS)).sin_cos();
                let normal = DVec3::new(sin * c, cos, sin * s);
                mesh.positions.push((ball.centre + ball.radius * normal).as_vec3().to_array());
                mesh.normals.push(normal.as_vec3().to_array());
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
    fn material_infos(&self) -> impl Iterator<Item = MaterialInfo> {
        let lamps = self.lamps().map(|lamp| MaterialInfo {
            name: lamp.name.to_owned(),
            model: lamp.kind.to_owned(),
            color: Rgb::BLACK,
            emission: lamp.color,
            transparent: false,
        });
        self.surfaces.iter().map(|s| self.material_info(s)).chain(lamps)
    }

    fn material_info(&self, surface: &super::SurfaceMaterial) -> MaterialInfo {
        let emission: Rgb = surface.emission * self.radiance_scale;
        MaterialInfo {
            name: surface.name.clone(),
            model: surface.bsdf.name().to_owned(),
            color: surface.bsdf.preview_color(),
            emission,
            transparent: surface.bsdf.is_transparent(),
        }
    }
}
