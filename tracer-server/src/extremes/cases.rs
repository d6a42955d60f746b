//! The tables.

use common::Rgb;
use glam::{DMat3, DVec3};

use super::{Expected, Extreme, SIDE, check_all, like, row};
use crate::bsdf::{
    BsdfDescription, ConductorDescription, DielectricDescription, Fresnel, MirrorDescription,
};
use crate::integrator::laws::{BLACK, bidirectional, furnace, lit_by_sphere, sphere_over_plane};
use crate::scene::fixtures::{Fixture, MIRROR, coated_room, diffuse_room, lambert, specular_room};
use crate::scene::{LightKind, Mesh, SkyImage};

fn small(fixture: Fixture) -> Fixture {
    fixture.film(SIDE, SIDE).max_edges(5)
}

fn base() -> Fixture {
    small(specular_room())
}

fn changed(mut fixture: Fixture, change: impl FnOnce(&mut Fixture)) -> Fixture {
    change(&mut fixture);
    fixture
}

/// Lengths, places and light far from one.
#[test]
fn sizes_places_and_brightness() {
    let scaled = |factor| changed(base(), |f| f.scale(factor));
    let moved =
        |sizes: f64| changed(base(), |f| f.translate(2.0 * sizes * DVec3::new(1., -0.7, 0.3)));
    let brighter = |factor| {
        changed(base(), |f| {
            f.description.materials.iter_mut().for_each(|m| m.emission = m.emission * factor);
        })
    };
    let mut rows: Vec<Extreme> = Vec::new();
    for (name, factor) in
        [("size 1e-6", 1e-6), ("size 1e-3", 1e-3), ("size 1e3", 1e3), ("size 1e6", 1e6)]
    {
        rows.push(row(name, scaled(factor), like(base(), 1.0)));
    }
    for (name, sizes) in [("moved by 1e3 sizes", 1e3), ("moved by 1e6 sizes", 1e6)] {
        rows.push(row(name, moved(sizes), like(base(), 1.0)));
    }
    for (name, factor) in [("light 1e-30", 1e-30), ("light 1e30", 1e30)] {
        rows.push(row(name, brighter(factor), like(base(), factor)));
    }
    check_all(&rows);
}

/// A plane under the sun at an elevation.
fn sun(elevation: f64) -> Fixture {
    let direction = DVec3::new(elevation.cos(), -elevation.sin(), 0.0);
    Fixture::new(DVec3::new(0.0, 1.0, 0.4), DVec3::ZERO, 10.0)
        .quad(lambert(0.6, 0.6, 0.6), Rgb::BLACK, [-9., 0., -9.], [0., 0., 18.], [18., 0., 0.])
        .light(LightKind::Directional { direction, irradiance: Rgb::grey(3.0) })
        .film(4, 4)
        .max_edges(2)
}

/// A plane seen from straight above, and a point light just above the plane. All its light falls
/// on a spot of the size of that height: the mean over the film is `2 rho I / (2 d tan(fov/2))^2`.
fn point_near_plane(height: f64) -> (Fixture, f64) {
    let (distance, fov, rho, i) = (2.0, 40.0_f64, 0.6, 5.0);
    let fixture = Fixture::new(DVec3::new(0.1, distance, 0.2), DVec3::new(0.1, 0.0, 0.2), fov)
        .quad(lambert(rho, rho, rho), Rgb::BLACK, [-9., 0., -9.], [0., 0., 18.], [18., 0., 0.])
        .light(LightKind::Point {
            position: DVec3::new(0.17, height, 0.26),
            intensity: Rgb::grey(i),
        })
        .film(4, 4)
        .max_edges(2);
    let side = 2.0 * distance * (0.5 * fov.to_radians()).tan();
    // On a plane that faces the camera, equal areas fill equal shares of the film.
    let seen = 2.0 * rho * i / (side * side);
    (fixture, seen)
}

/// An even sky with one texel that outshines it.
fn hot_sky() -> LightKind {
    let (width, height) = (16, 8);
    let mut texels = vec![[0.5; 3]; width * height];
    texels[2 * width + 7] = [1e10; 3];
    let image = Some(SkyImage { width, height, texels });
    LightKind::Environment { radiance: Rgb::WHITE, image, rotation: DMat3::from_rotation_y(0.4) }
}

/// The lamp of the room cut into `2 n^2` triangles.
fn many_lights(n: u32) -> Fixture {
    changed(small(diffuse_room()), |fixture| {
        let lamp = &mut fixture.description.meshes[6];
        let material = lamp.materials[0];
        *lamp = grid(lamp, n, material);
    })
}

/// A parallelogram cut into `2 n^2` triangles.
fn grid(mesh: &Mesh, n: u32, material: u16) -> Mesh {
    let corner = mesh.positions[0];
    let (u, v) = (mesh.positions[1] - corner, mesh.positions[3] - corner);
    let share = |i: u32| f64::from(i) / f64::from(n);
    let mut fine = Mesh { name: mesh.name.clone(), ..Mesh::default() };
    for (i, j) in (0..=n).flat_map(|i| (0..=n).map(move |j| (i, j))) {
        fine.positions.push(corner + share(i) * u + share(j) * v);
    }
    for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
        let at = |i: u32, j: u32| i * (n + 1) + j;
        let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
        fine.triangles.extend([[a, b, c], [a, c, d]]);
    }
    fine.materials = vec![material; fine.triangles.len()];
    fine
}

#[test]
fn lights() {
    let radius = 18e-6;
    let elevation = 1e-4_f64;
    let sunlit = 0.6 * 3.0 * elevation.sin() / std::f64::consts::PI;
    let (near, seen) = point_near_plane(1e-5);
    let tiny = sphere_over_plane(radius, 2.0, 1.0);
    let under_hot_sky = Fixture::new(DVec3::new(0.3, 1.0, 1.4), DVec3::ZERO, 50.0)
        .quad(lambert(0.6, 0.5, 0.4), Rgb::BLACK, [-2., 0., -2.], [0., 0., 4.], [4., 0., 0.])
        .sphere(lambert(0.3, 0.5, 0.6), Rgb::BLACK, [0.0, 0.3, 0.0], 0.3)
        .light(hot_sky());
    check_all(&[
        row("lamp of 1e-6 sizes", tiny, Expected::Mean(lit_by_sphere(radius, 2.0, 1.0), 0.0)),
        row("sun at 1e-4 rad", sun(elevation), Expected::Mean(sunlit, 0.0)),
        row("point light 1e-6 sizes above a plane", near, Expected::Mean(seen, 0.0)),
        row("sky with a texel of 1e10", small(under_hot_sky), Expected::AgreementOfThree),
        row("100 352 lights", many_lights(224), like(small(diffuse_room()), 1.0)),
    ]);
}

/// Everything glows with radiance one, and there is a ball.
fn ball_in_glow(bsdf: BsdfDescription, origin: DVec3, edges: usize) -> Fixture {
    Fixture::new(origin, origin - DVec3::Z, 50.0)
        .room(&[BLACK; 6], Rgb::WHITE)
        .sphere(bsdf, Rgb::BLACK, [0.0; 3], 0.5)
        .film(SIDE, SIDE)
        .max_edges(edges)
}

fn clear(eta: f64) -> BsdfDescription {
    BsdfDescription::from(DielectricDescription::clear(eta))
}

/// The room with its mirror ball of another material.
fn ball_of(bsdf: BsdfDescription) -> Fixture {
    changed(base(), |f| {
        let material = usize::from(f.description.spheres[1].material);
        f.description.materials[material].bsdf = bsdf;
    })
}

fn rough_mirror(roughness: f64) -> BsdfDescription {
    let BsdfDescription::Mirror(MirrorDescription { reflectance }) = MIRROR else {
        unreachable!("it is a mirror");
    };
    BsdfDescription::Conductor(ConductorDescription {
        fresnel: Fresnel::Constant(reflectance),
        roughness: roughness.into(),
    })
}

#[test]
fn materials() {
    let outside = DVec3::new(0.0, 0.0, 0.9);
    let glass = |eta| ball_in_glow(clear(eta), outside, 8);
    check_all(&[
        row("eta 1", glass(1.0), Expected::Mean(1.0, 0.0)),
        row("eta 1 + 1e-7", glass(1.0 + 1e-7), Expected::Mean(1.0, 0.0)),
        // What enters is reflected inside nearly for ever: up to 1 - F = 0.4 % end too late.
        row("eta 1e3", glass(1e3), Expected::Mean(1.0, 0.004)),
        row("albedo 0", furnace(0.0, 6), Expected::Mean(1.0, 0.0)),
        row("albedo 1", furnace(1.0, 6), Expected::Mean(6.0, 0.0)),
        // Few runs, since they take long: their spread alone would be a poor measure.
        row("albedo 1, 64 edges", furnace(1.0, 64).film(2, 2), Expected::Mean(64.0, 0.01)),
        row("1 edge", furnace(0.5, 1), Expected::Mean(1.0, 0.0)),
        row("2 edges", furnace(0.5, 2), Expected::Mean(1.5, 0.0)),
        row("roughness 1e-4", ball_of(rough_mirror(1e-4)), like(base(), 1.0)),
        row("roughness 1", ball_of(rough_mirror(1.0)), Expected::AgreementOfThree),
        row("everything coated", small(coated_room()), Expected::Agreement),
    ]);
}

/// The floor's first triangle cut so that fifty needles run along the diagonal.
fn needles() -> Fixture {
    changed(base(), |fixture| {
        let floor = &mut fixture.description.meshes[2];
        let [a, b, c] = [floor.positions[0], floor.positions[1], floor.positions[2]];
        let middle = 0.5 * (a + c);
        // Each is as long as half the diagonal and a millionth of that wide.
        let step = 1e-6 * (c - a).length() * 0.5 * (b - middle).normalize();
        let first = floor.positions.len() as u32;
        floor.positions.extend((0..=50).map(|i| middle + f64::from(i) * step));
        let last = first + 50;
        floor.triangles[0] = [0, 1, last];
        floor.triangles.push([1, 2, last]);
        for i in first..last {
            floor.triangles.extend([[0, i + 1, i], [i + 1, 2, i]]);
        }
        floor.materials = vec![floor.materials[0]; floor.triangles.len()];
    })
}

/// A narrow view of a patch of triangles of 1e-5, lit by a ball.
fn tiny_triangles() -> Fixture {
    changed(sphere_over_plane(0.5, 2.0, 1.0), |fixture| {
        fixture.description.camera.vertical_fov = 1e-3;
        let (half, n) = (2e-4, 40);
        let corner = DVec3::new(-half, 0.0, -half);
        let (z, x) = (2.0 * half * DVec3::Z, 2.0 * half * DVec3::X);
        let plane = &mut fixture.description.meshes[0];
        plane.positions = vec![corner, corner + z, corner + z + x, corner + x];
        *plane = grid(plane, n, plane.materials[0]);
    })
}

/// The same mesh twice in the same place.
fn twice(mesh: usize) -> Fixture {
    changed(base(), |fixture| {
        let again = fixture.description.meshes[mesh].clone();
        fixture.description.meshes.push(again);
    })
}

#[test]
fn shapes_and_views() {
    let lit = lit_by_sphere(0.5, 2.0, 1.0);
    let view = |fov| changed(furnace(0.5, 6), |f| f.description.camera.vertical_fov = fov);
    let narrow = changed(sphere_over_plane(0.5, 2.0, 1.0), |f| {
        f.description.camera.vertical_fov = 1e-3;
    });
    let on_floor = changed(furnace(0.5, 6), |f| {
        f.description.camera.origin = DVec3::new(0.2, -1.0, 0.3);
    });
    let strip =
        changed(furnace(0.5, 6).film(8192, 1), |f| f.description.camera.vertical_fov = 0.01);
    let glow = (1.0 - 0.5_f64.powi(6)) / 0.5;
    check_all(&[
        row("needles of aspect 1e6", needles(), like(base(), 1.0)),
        row("triangles of 1e-5", tiny_triangles(), Expected::Mean(lit, 1e-4)),
        row("coincident floors", twice(2), like(base(), 1.0)),
        row("field of view 1e-3 degrees", narrow, Expected::Mean(lit, 0.0)),
        row("field of view 170 degrees", view(170.0), Expected::Mean(glow, 0.0)),
        row("camera on the floor", on_floor, Expected::Mean(glow, 0.0)),
        // Radiance in glass is eta^2 times that outside.
        row("camera in glass", ball_in_glow(clear(1.5), DVec3::ZERO, 8), Expected::Mean(2.25, 0.0)),
        row("film of 1 x 1", furnace(0.5, 6).film(1, 1), Expected::Mean(glow, 0.0)),
        row("film of 8192 x 1", strip, Expected::Mean(glow, 0.0)),
    ]);
}

/// Nearer than about 1e-7 sizes to a surface, traversal in single precision loses a point light's
/// brightest spot: the picture gets too dark, but stays a picture.
#[test]
fn light_is_lost_right_at_a_surface() {
    let (fixture, seen) = point_near_plane(1e-9);
    let image = bidirectional(&fixture.build(), 1, 64);
    assert!(image.pixels().iter().all(|p| p.is_physical()), "a pixel is no radiance");
    let share = image.mean().g / seen;
    assert!(share < 0.5, "{share}: no longer lost, so the documentation is out of date");
}

/// Of two lamps in the same place only one counts, and there is a warning.
#[test]
fn a_lamp_in_the_place_of_another_is_left_out() {
    let scene = twice(6).build();
    let told = scene.warnings().iter().any(|w| w.starts_with("2 light triangles were ignored"));
    assert!(told, "{:?}", scene.warnings());
    check_all(&[row("coincident lamps", twice(6), like(base(), 1.0))]);
}
