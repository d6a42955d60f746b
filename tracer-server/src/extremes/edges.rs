//! Scenes without an image, what is refused, and rays that slip through a closed surface.

use std::f64::consts::{PI, TAU};

use common::Rgb;
use glam::DVec3;

use crate::chain::Ensemble;
use crate::integrator::laws::{bidirectional, furnace, path_traced, settings};
use crate::math::{Rng, Stream, uniform_sphere};
use crate::scene::fixtures::{Fixture, diffuse_room, lambert};
use crate::scene::{Anchor, Mesh, NO_PRIMITIVE, Scene, SceneError};

/// A lamp whose light cannot get to the camera: `b` is zero, and seeding ends.
#[test]
fn a_black_picture_has_no_normalization() {
    let scene = Fixture::new(DVec3::new(5.0, 0.0, 0.0), DVec3::new(9.0, 0.0, 0.0), 40.0)
        .room(&[lambert(0.5, 0.5, 0.5); 6], Rgb::WHITE)
        .quad(lambert(0.5, 0.5, 0.5), Rgb::BLACK, [8., -1., -1.], [0., 0., 2.], [0., 2., 0.])
        .film(8, 8)
        .build();
    let mut ensemble = Ensemble::new(&scene, &settings(0, 64), |_| ());
    ensemble.advance(&scene, 100, None);
    assert_eq!(ensemble.chain_count(), 0, "there is nothing to start from");
    assert_eq!(ensemble.pool().normalization().to_bits(), 0, "b = 0");
    for image in [ensemble.image(&scene), path_traced(&scene, 1, 4), bidirectional(&scene, 1, 4)] {
        assert!(image.pixels().iter().all(|p| p.is_black()), "black, not NaN");
    }
}

#[test]
fn scenes_without_surface_or_light_are_refused() {
    let empty = Fixture::new(DVec3::ZERO, DVec3::Z, 40.0);
    assert!(matches!(Scene::new(&empty.description), Err(SceneError::Empty)), "no surface");
    let mut dark = diffuse_room();
    dark.description.materials.iter_mut().for_each(|m| m.emission = Rgb::BLACK);
    assert!(matches!(Scene::new(&dark.description), Err(SceneError::NoLight)), "no light");
    for edges in [0, 65] {
        let scene = Scene::new(&furnace(0.5, edges).description);
        assert!(matches!(scene, Err(SceneError::BadMaxEdges(_))), "{edges} edges");
    }
}

/// A closed ball of flat triangles; it glows, since a scene needs a light.
fn closed_ball(rings: u32) -> Scene {
    let segments = 2 * rings;
    let mut fixture = Fixture::new(DVec3::ZERO, DVec3::Z, 40.0);
    let material = fixture.material(lambert(0.5, 0.5, 0.5), Rgb::WHITE);
    let mut ball = Mesh { name: "ball".to_owned(), ..Mesh::default() };
    for (ring, segment) in (0..=rings).flat_map(|r| (0..segments).map(move |s| (r, s))) {
        let theta = PI * f64::from(ring) / f64::from(rings);
        let phi = TAU * f64::from(segment) / f64::from(segments);
        let sine = if ring == 0 || ring == rings { 0.0 } else { theta.sin() };
        ball.positions.push(DVec3::new(sine * phi.cos(), theta.cos(), sine * phi.sin()));
    }
    for (ring, segment) in (0..rings).flat_map(|r| (0..segments).map(move |s| (r, s))) {
        let at = |r: u32, s: u32| r * segments + s % segments;
        let (a, b) = (at(ring, segment), at(ring, segment + 1));
        let (c, d) = (at(ring + 1, segment), at(ring + 1, segment + 1));
        if ring > 0 {
            ball.triangles.push([a, b, c]);
        }
        if ring + 1 < rings {
            ball.triangles.push([b, d, c]);
        }
    }
    ball.materials = vec![material; ball.triangles.len()];
    fixture.description.meshes.push(ball);
    fixture.build()
}

/// Hardly a ray slips between the triangles of a closed surface.
#[test]
#[expect(clippy::print_stdout, reason = "the figure that the documentation quotes")]
fn a_closed_surface_hardly_leaks() {
    let rays = 4_000_000_u32;
    let scene = closed_ball(100);
    let mut rng = Rng::new(7, Stream::Laboratory, 0);
    let mut lost = 0_u32;
    // In scene units the ball's radius lies in [512, 1024).
    for _ in 0..rays {
        let position = 500.0 * rng.uniform() * uniform_sphere(rng.uniform(), rng.uniform());
        let from = Anchor { position, normal: DVec3::Y, primitive: NO_PRIMITIVE };
        let direction = uniform_sphere(rng.uniform(), rng.uniform());
        lost += u32::from(scene.closest(&from, direction).is_none());
    }
    println!("{lost} of {rays} rays left a closed ball of 39 600 triangles");
    // A tenth of a pixel's worth in a picture of a million: invisible. Most often there is none.
    assert!(lost <= 40, "{lost} of {rays} rays left a closed ball");
}
