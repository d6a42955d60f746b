//! Small scenes for the laws, built in code.

use std::f64::consts::{PI, TAU};

use std::path::{Path, PathBuf};

use common::{CameraPose, Rgb};
use glam::{DMat3, DVec3, Vec3, Vec3Swizzles as _};

use super::{
    LightDescription, LightKind, Material, Mesh, Scene, SceneDescription, SkyImage, Sphere,
    ThinLens,
};
use crate::bsdf::{
    BsdfDescription, ColorInput, ConductorDescription, DielectricDescription, Fresnel,
    LambertDescription, MirrorDescription, PlasticDescription,
};

/// Builds descriptions shape by shape.
#[derive(Clone, Debug)]
pub(crate) struct Fixture {
    pub(crate) description: SceneDescription,
}

pub(crate) const fn lambert(r: f64, g: f64, b: f64) -> BsdfDescription {
    BsdfDescription::Lambert(LambertDescription {
        reflectance: ColorInput::Constant(Rgb::new(r, g, b)),
    })
}

pub(crate) const MIRROR: BsdfDescription =
    BsdfDescription::Mirror(MirrorDescription { reflectance: Rgb::new(0.9, 0.85, 0.8) });

pub(crate) const GLASS: BsdfDescription = BsdfDescription::Dielectric(DielectricDescription {
    transmittance: Rgb::new(0.95, 1.0, 0.9),
    ..DielectricDescription::clear(1.5)
});

impl Fixture {
    /// An empty scene with a camera at `origin` that looks at `target`.
    pub(crate) fn new(origin: DVec3, target: DVec3, fov: f64) -> Self {
        let up = if (target - origin).normalize().y.abs() > 0.99 { DVec3::Z } else { DVec3::Y };
        let camera = CameraPose { origin, target, up, vertical_fov: fov };
        Self { description: SceneDescription::empty("fixture", camera, [32, 32], 6) }
    }

    pub(crate) fn material(&mut self, bsdf: BsdfDescription, emission: Rgb) -> u16 {
        let name = format!("material {}", self.description.materials.len());
        self.description.materials.push(Material { emission, ..Material::new(name, bsdf) });
        (self.description.materials.len() - 1) as u16
    }

    /// A parallelogram whose front side is the one that `u x v` points to.
    pub(crate) fn quad(
        mut self,
        bsdf: BsdfDescription,
        emission: Rgb,
        corner: [f64; 3],
        u: [f64; 3],
        v: [f64; 3],
    ) -> Self {
        let material = self.material(bsdf, emission);
        let (c, u, v) = (DVec3::from(corner), DVec3::from(u), DVec3::from(v));
        self.description.meshes.push(Mesh {
            name: format!("quad {material}"),
            positions: vec![c, c + u, c + u + v, c + v],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            materials: vec![material; 2],
            ..Mesh::default()
        });
        self
    }

    pub(crate) fn sphere(
        mut self,
        bsdf: BsdfDescription,
        emission: Rgb,
        centre: [f64; 3],
        radius: f64,
    ) -> Self {
        let material = self.material(bsdf, emission);
        let name = format!("sphere {material}");
        self.description.spheres.push(Sphere {
            name,
            centre: centre.into(),
            radius,
            turn: DMat3::IDENTITY,
            material,
        });
        self
    }

    /// The six inner walls of the cube [-1, 1]^3, all of one material.
    pub(crate) fn room(self, walls: &[BsdfDescription; 6], emission: Rgb) -> Self {
        let &[left, right, floor, ceiling, back, front] = walls;
        self.quad(left, emission, [-1., -1., -1.], [0., 2., 0.], [0., 0., 2.])
            .quad(right, emission, [1., -1., -1.], [0., 0., 2.], [0., 2., 0.])
            .quad(floor, emission, [-1., -1., -1.], [0., 0., 2.], [2., 0., 0.])
            .quad(ceiling, emission, [-1., 1., -1.], [2., 0., 0.], [0., 0., 2.])
            .quad(back, emission, [-1., -1., -1.], [2., 0., 0.], [0., 2., 0.])
            .quad(front, emission, [-1., -1., 1.], [0., 2., 0.], [2., 0., 0.])
    }

    pub(crate) fn light(mut self, kind: LightKind) -> Self {
        let name = format!("light {}", self.description.lights.len());
        self.description.lights.push(LightDescription { name, kind });
        self
    }

    pub(crate) fn lens(mut self, radius: f64, focus: f64) -> Self {
        self.description.lens = Some(ThinLens { radius, focus });
        self
    }

    pub(crate) fn film(mut self, width: u32, height: u32) -> Self {
        self.description.width = width;
        self.description.height = height;
        self
    }

    pub(crate) fn max_edges(mut self, max_edges: usize) -> Self {
        self.description.max_edges = max_edges;
        self
    }

    /// Multiplies every length.
    pub(crate) fn scale(&mut self, factor: f64) {
        let description = &mut self.description;
        description.camera.origin *= factor;
        description.camera.target *= factor;
        for mesh in &mut description.meshes {
            mesh.positions.iter_mut().for_each(|p| *p *= factor);
        }
        for sphere in &mut description.spheres {
            sphere.centre *= factor;
            sphere.radius *= factor;
        }
        if let Some(lens) = &mut description.lens {
            lens.radius *= factor;
            lens.focus *= factor;
        }
        for light in &mut description.lights {
            if let LightKind::Point { position, intensity }
            | LightKind::Spot { position, intensity, .. } = &mut light.kind
            {
                *position *= factor;
                *intensity = *intensity * (factor * factor);
            }
        }
    }

    /// Moves every mesh, every sphere and the camera.
    pub(crate) fn translate(&mut self, by: DVec3) {
        let description = &mut self.description;
        description.camera.origin += by;
        description.camera.target += by;
        for mesh in &mut description.meshes {
            mesh.positions.iter_mut().for_each(|p| *p += by);
        }
        description.spheres.iter_mut().for_each(|sphere| sphere.centre += by);
    }

    pub(crate) fn build(&self) -> Scene {
        Scene::new(&self.description).expect("a fixture is a valid scene")
    }
}

const RED: BsdfDescription = lambert(0.7, 0.2, 0.15);
const GREEN: BsdfDescription = lambert(0.2, 0.6, 0.2);
const WHITE: BsdfDescription = lambert(0.7, 0.7, 0.65);
const BLACK: BsdfDescription = lambert(0.0, 0.0, 0.0);

/// A room with coloured walls and a lamp under its ceiling.
pub(crate) fn diffuse_room() -> Fixture {
    Fixture::new(DVec3::new(0.1, 0.0, 0.95), DVec3::new(0.0, -0.1, -1.0), 70.0)
        .room(&[RED, GREEN, WHITE, WHITE, WHITE, WHITE], Rgb::BLACK)
        .quad(BLACK, Rgb::new(12.0, 9.0, 6.0), [-0.3, 0.9, -0.3], [0.6, 0., 0.], [0., 0., 0.5])
}

/// The same room with a glass and a mirror sphere.
pub(crate) fn specular_room() -> Fixture {
    diffuse_room().sphere(GLASS, Rgb::BLACK, [-0.45, -0.6, -0.1], 0.35).sphere(
        MIRROR,
        Rgb::BLACK,
        [0.45, -0.55, -0.4],
        0.4,
    )
}

/// A room whose walls reflect one channel each: the luminance of a product of colours is far from
/// the product of their luminances.
pub(crate) fn saturated_room() -> Fixture {
    let (red, green, blue) =
        (lambert(0.9, 0.05, 0.05), lambert(0.05, 0.9, 0.05), lambert(0.05, 0.05, 0.9));
    Fixture::new(DVec3::new(0.1, 0.0, 0.95), DVec3::new(0.0, -0.1, -1.0), 70.0)
        .room(&[red, green, blue, WHITE, red, green], Rgb::BLACK)
        .quad(BLACK, Rgb::new(12.0, 9.0, 6.0), [-0.3, 0.9, -0.3], [0.6, 0., 0.], [0., 0., 0.5])
}

/// The same room with a smoothly coated floor and back wall, a roughly coated wall, and spheres of
/// rough metal and of rough glass.
pub(crate) fn coated_room() -> Fixture {
    let coat = Fresnel::Dielectric { eta: 1.5, tint: Rgb::WHITE };
    let paint = |r, g, b, roughness| {
        BsdfDescription::Plastic(PlasticDescription {
            diffuse: Rgb::new(r, g, b).into(),
            fresnel: coat,
            roughness,
            nonlinear: false,
        })
    };
    let lacquer = BsdfDescription::Plastic(PlasticDescription {
        diffuse: Rgb::new(0.5, 0.4, 0.2).into(),
        fresnel: Fresnel::Schlick(Rgb::grey(0.3)),
        roughness: 0.0,
        nonlinear: false,
    });
    let steel = BsdfDescription::Conductor(ConductorDescription {
        fresnel: Fresnel::Schlick(Rgb::new(0.9, 0.7, 0.5)),
        roughness: 0.3.into(),
    });
    let frosted = BsdfDescription::Dielectric(DielectricDescription {
        eta: 1.5,
        reflectance: Rgb::WHITE,
        transmittance: Rgb::new(0.9, 1.0, 0.8),
        roughness: 0.25.into(),
    });
    let walls =
        [paint(0.7, 0.2, 0.1, 0.2), GREEN, lacquer, WHITE, paint(0.7, 0.7, 0.6, 0.0), WHITE];
    Fixture::new(DVec3::new(0.1, 0.0, 0.95), DVec3::new(0.0, -0.1, -1.0), 70.0)
        .room(&walls, Rgb::BLACK)
        .quad(BLACK, Rgb::new(12.0, 9.0, 6.0), [-0.3, 0.9, -0.3], [0.6, 0., 0.], [0., 0., 0.5])
        .sphere(frosted, Rgb::BLACK, [-0.45, -0.6, -0.1], 0.35)
        .sphere(steel, Rgb::BLACK, [0.45, -0.55, -0.4], 0.4)
}

/// The same room with a coarse ball and a floor whose shading normals are far from the geometric
/// ones.
pub(crate) fn bumpy_room() -> Fixture {
    let mut fixture = diffuse_room();
    let material = fixture.material(WHITE, Rgb::BLACK);
    let (rings, segments) = (6_u32, 9_u32);
    let point = |ring: u32, segment: u32| {
        let theta = PI * f64::from(ring) / f64::from(rings);
        let phi = TAU * f64::from(segment) / f64::from(segments);
        DVec3::new(theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin())
    };
    let mut ball = Mesh { name: "ball".to_owned(), ..Mesh::default() };
    let mut corner = |direction: DVec3| {
        ball.positions.push(DVec3::new(0.1, -0.35, -0.2) + 0.55 * direction);
        (ball.positions.len() - 1) as u32
    };
    let mut faces = Vec::new();
    for (ring, segment) in (0..rings).flat_map(|r| (0..segments).map(move |s| (r, s))) {
        let (a, b) = (point(ring, segment), point(ring, segment + 1));
        let (c, d) = (point(ring + 1, segment), point(ring + 1, segment + 1));
        if ring > 0 {
            faces.push([a, b, c]);
        }
        if ring + 1 < rings {
            faces.push([b, d, c]);
        }
    }
    let bump = |n: DVec3| (n + 0.5 * (7.0 * n.zxy()).map(f64::sin)).as_vec3();
    for face in faces {
        ball.triangles.push(face.map(&mut corner));
        ball.normals.push(face.map(bump));
        ball.materials.push(material);
    }
    fixture.description.meshes.push(ball);
    let floor = &mut fixture.description.meshes[2];
    let tilted = |x: f32, z: f32| Vec3::new(x, 1.0, z);
    let corners = [tilted(-0.7, 0.0), tilted(0.0, 0.8), tilted(0.9, 0.0), tilted(0.0, -0.6)];
    floor.normals = floor.triangles.iter().map(|t| t.map(|i| corners[i as usize])).collect();
    fixture
}

/// A high-contrast floor under a wide lamp, seen through a small glass ball before the camera.
pub(crate) fn floor_through_glass() -> Fixture {
    let mut fixture = Fixture::new(DVec3::new(0.0, 0.9, 0.0), DVec3::new(0.0, -1.0, 0.0), 60.0)
        .quad(BLACK, Rgb::new(9.0, 9.0, 9.0), [-1., 2., -1.], [2., 0., 0.], [0., 0., 2.])
        .sphere(GLASS, Rgb::BLACK, [0.0, 0.6, 0.0], 0.2);
    for x in 0..6 {
        for z in 0..6 {
            let tone =
                if (x + z) % 2 == 0 { lambert(0.9, 0.6, 0.3) } else { lambert(0.02, 0.05, 0.1) };
            let corner = [-1.0 + f64::from(x) / 3.0, -1.0, -1.0 + f64::from(z) / 3.0];
            fixture = fixture.quad(tone, Rgb::BLACK, corner, [0., 0., 1. / 3.], [1. / 3., 0., 0.]);
        }
    }
    fixture
}

/// A lit wall mirrored in a pane of glass that is seen from steep to grazing angles; beyond the
/// pane there is nothing.
pub(crate) fn wall_in_a_pane() -> Fixture {
    Fixture::new(DVec3::new(0.0, 0.2, 1.5), DVec3::new(0.0, -0.5, 0.0), 80.0)
        .quad(GLASS, Rgb::BLACK, [-3., -0.5, -2.], [0., 0., 4.], [6., 0., 0.])
        .quad(WHITE, Rgb::BLACK, [-3., -0.5, -2.], [6., 0., 0.], [0., 4., 0.])
        .quad(BLACK, Rgb::grey(20.0), [-0.5, 3.0, -0.5], [1., 0., 0.], [0., 0., 1.])
}

/// A slab of dense glass between a wide lamp and a diffuse floor; the camera looks through the
/// slab at many angles, or from below it.
pub(crate) fn slab_over_floor(through: bool) -> Fixture {
    let dense = BsdfDescription::from(DielectricDescription::clear(2.4));
    let (origin, target) = if through {
        (DVec3::new(0.3, 1.2, 1.6), DVec3::new(0.0, 0.5, 0.3))
    } else {
        (DVec3::new(0.3, 0.35, 1.0), DVec3::ZERO)
    };
    Fixture::new(origin, target, 60.0)
        .quad(WHITE, Rgb::BLACK, [-2., 0., -2.], [0., 0., 4.], [4., 0., 0.])
        .quad(dense, Rgb::BLACK, [-3., 0.9, -3.], [0., 0., 6.], [6., 0., 0.])
        .quad(dense, Rgb::BLACK, [-3., 0.7, -3.], [6., 0., 0.], [0., 0., 6.])
        .quad(BLACK, Rgb::new(6.0, 5.0, 3.0), [-2., 2.2, -2.], [4., 0., 0.], [0., 0., 4.])
        .max_edges(8)
}

/// A wall that is mirrored, and lit by the mirror image of a wide lamp, in one pane of glass: both
/// at many angles, so that the probabilities of reflection differ from path to path.
pub(crate) fn wall_and_lamp_in_a_pane() -> Fixture {
    Fixture::new(DVec3::new(0.0, 0.0, 1.5), DVec3::new(0.0, -0.5, 0.0), 80.0)
        .quad(GLASS, Rgb::BLACK, [-3., -0.5, -2.], [0., 0., 6.], [6., 0., 0.])
        .quad(WHITE, Rgb::BLACK, [-3., -0.5, -2.], [6., 0., 0.], [0., 2., 0.])
        .quad(BLACK, Rgb::grey(20.0), [-3.0, 1.6, -1.9], [6., 0., 0.], [0., 0., 5.])
}

/// A room that is open to the front and above, without a light.
pub(crate) fn open_room() -> Fixture {
    Fixture::new(DVec3::new(0.1, 0.1, 2.5), DVec3::new(0.0, -0.1, -1.0), 45.0)
        .quad(RED, Rgb::BLACK, [-1., -1., -1.], [0., 2., 0.], [0., 0., 2.])
        .quad(GREEN, Rgb::BLACK, [1., -1., -1.], [0., 0., 2.], [0., 2., 0.])
        .quad(WHITE, Rgb::BLACK, [-1., -1., -1.], [0., 0., 2.], [2., 0., 0.])
        .quad(WHITE, Rgb::BLACK, [-1., -1., -1.], [2., 0., 0.], [0., 2., 0.])
        .sphere(WHITE, Rgb::BLACK, [0.45, -0.55, -0.4], 0.4)
        .max_edges(5)
}

/// The same with a ball of glass.
pub(crate) fn open_room_with_glass() -> Fixture {
    open_room().sphere(GLASS, Rgb::BLACK, [-0.45, -0.6, -0.1], 0.35)
}

/// A sky with a bright spot.
pub(crate) fn image_sky() -> LightKind {
    let (width, height) = (16, 8);
    let mut texels = vec![[0.4, 0.5, 0.7]; width * height];
    texels[2 * width + 7] = [90.0, 80.0, 50.0];
    texels[2 * width + 8] = [60.0, 60.0, 40.0];
    texels[5 * width..].fill([0.1, 0.08, 0.05]);
    let rotation = DMat3::from_rotation_y(0.4);
    let image = Some(SkyImage { width, height, texels });
    LightKind::Environment { radiance: Rgb::new(1.0, 1.0, 0.9), image, rotation }
}

/// One fixture with each kind of light, and one with a lens that has an area.
pub(crate) fn every_light() -> Vec<(&'static str, Fixture)> {
    let position = DVec3::new(0.3, 0.7, 0.2);
    let direction = DVec3::new(-0.3, -1.0, -0.3);
    let intensity = Rgb::new(3.0, 2.5, 2.0);
    let spot = LightKind::Spot { position, direction, intensity, cutoff: 50.0, beam: 25.0 };
    let plain = LightKind::Environment {
        radiance: Rgb::new(0.6, 0.7, 0.9),
        image: None,
        rotation: DMat3::IDENTITY,
    };
    vec![
        ("point", open_room().light(LightKind::Point { position, intensity })),
        ("spot", open_room().light(spot)),
        ("sun", open_room().light(LightKind::Directional { direction, irradiance: intensity })),
        ("point and glass", open_room_with_glass().light(LightKind::Point { position, intensity })),
        ("even sky", open_room_with_glass().light(plain)),
        ("image sky", open_room_with_glass().light(image_sky())),
        ("lens", specular_room().lens(0.05, 1.6).max_edges(5)),
    ]
}

#[test]
fn every_kind_of_light_is_there() {
    // A new variant does not compile here: give it the next number, and add it to the lights.
    let number = |kind: &LightKind| match kind {
        LightKind::Point { .. } => 0,
        LightKind::Spot { .. } => 1,
        LightKind::Directional { .. } => 2,
        LightKind::Environment { .. } => 3,
    };
    let lights = every_light().into_iter().flat_map(|(_, fixture)| fixture.description.lights);
    let mut seen: Vec<usize> = lights.map(|light| number(&light.kind)).collect();
    seen.sort_unstable();
    seen.dedup();
    assert_eq!(seen, [0, 1, 2, 3], "a kind of light is not among them");
}

/// The folder of scenes made by others; `None`, and the test is skipped, where it is not there.
pub(crate) fn shared_scenes() -> Option<PathBuf> {
    let shared = std::env::var_os("LVIS_SHARED")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared"), PathBuf::from);
    let scenes = shared.join("scenes");
    if scenes.is_dir() {
        return Some(scenes);
    }
    let scenes = scenes.display();
    tests::skip(&format!("there are no scenes in {scenes}; set LVIS_SHARED to their folder"));
    None
}
