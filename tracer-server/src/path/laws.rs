//! Laws of paths: every cached value can be recomputed, and the splits agree on one contribution.

use std::f64::consts::PI;

use common::Rgb;
use glam::DVec2;
use tests::chi_square_test;

use super::{BidirectionalSampler, Path, emit, invert_emission, light_vertex};
use crate::bsdf::Bsdf;
use crate::math::{Rng, Stream};
use crate::scene::Tracer;
use crate::scene::fixtures::{diffuse_room, specular_room};

/// Paths of bidirectional samples, one from each sample that has any.
fn sample_paths(scene: &Tracer<'_>, samples: u64) -> Vec<Path> {
    let mut sampler = BidirectionalSampler::new(scene);
    let mut rng = Rng::new(5, Stream::Laboratory, 0);
    let mut paths = Vec::new();
    for _ in 0..samples {
        let film = DVec2::new(rng.uniform(), rng.uniform());
        sampler.sample(scene, film, &mut rng, |path, _| paths.push(path.clone()));
    }
    paths
}

#[test]
fn bidirectional_paths_can_be_rebuilt() {
    let scene = specular_room().build();
    let scene = Tracer::new(&scene);
    let paths = sample_paths(&scene, 300);
    assert!(paths.len() > 1000, "only {} paths", paths.len());
    for path in &paths {
        assert!(path.is_fresh(&scene), "a cached value is stale");
    }
}

/// Luminance of `f` with respect to area measure, factor by factor from the vertices.
fn area_contribution(scene: &Tracer<'_>, path: &Path) -> f64 {
    let v = path.vertices();
    let k = path.edge_count();
    let mut color = scene.emission(v[0].primitive).expect("a light").radiance;
    let mut scalar = 1.0;
    for j in 0..k {
        let span = v[j + 1].position - v[j].position;
        let (r2, w) = (span.length_squared(), span.normalize());
        let at_lens = j + 1 == k;
        let far = if at_lens { 1.0 } else { v[j + 1].normal.dot(w).abs() };
        scalar *= v[j].normal.dot(w).abs() * far / r2;
        if at_lens {
            let cosine = -v[k].normal.dot(w);
            scalar /= scene.camera().film_area() * cosine.powi(3);
        } else if let Bsdf::Lambert(lambert) = scene.bsdf(v[j + 1].material) {
            color *= lambert.reflectance;
            scalar /= PI;
        }
    }
    color.luminance() * scalar
}

/// Area density with which split `light` makes a path of diffuse vertices: each vertex by cosine
/// sampling from its neighbour, the first by light sampling, the last by a uniform film point.
fn area_density(scene: &Tracer<'_>, path: &Path, light: usize) -> f64 {
    let v = path.vertices();
    let k = path.edge_count();
    // Density of drawing `to` from `from` with density cos / pi, per unit area at `to`.
    let cosine_sampled = |from: usize, to: usize| {
        let span = v[to].position - v[from].position;
        let (r2, w) = (span.length_squared(), span.normalize());
        v[from].normal.dot(w).abs() / PI * v[to].normal.dot(w).abs() / r2
    };
    let mut density = 1.0;
    for j in 0..light {
        density *= match j {
            0 => scene.emission(v[0].primitive).expect("a light").area_pdf,
            _ => cosine_sampled(j - 1, j),
        };
    }
    for j in (light..k).rev() {
        density *= if j + 1 == k {
            let span = v[k].position - v[j].position;
            let (r2, w) = (span.length_squared(), span.normalize());
            let cosine = -v[k].normal.dot(w);
            scene.camera().film_per_solid_angle(cosine) * v[j].normal.dot(w).abs() / r2
        } else {
            cosine_sampled(j + 1, j)
        };
    }
    density
}

#[test]
fn all_splits_tell_one_contribution() {
    let scene = diffuse_room().build();
    let scene = Tracer::new(&scene);
    let mut compared = 0;
    for path in sample_paths(&scene, 300) {
        let f = area_contribution(&scene, &path);
        for light in 0..=path.edge_count() {
            // p_i / lum f, once from the cached weights and once from explicit densities.
            let expected = area_density(&scene, &path, light) / f;
            let error = (path.reciprocal(light) / expected - 1.0).abs();
            assert!(error < 1e-9, "{} split {light}: off by {error}", path.class());
            compared += 1;
        }
    }
    assert!(compared > 5000, "only {compared} splits compared");
}

/// The inverses of light points and emission make the same light vertex again, and lead from
/// uniform numbers to uniform numbers.
#[test]
fn light_points_and_emission_are_inverted() {
    const SAMPLES: usize = 100_000;
    const CELLS: usize = 32;
    let lamps = specular_room().sphere(
        crate::scene::fixtures::lambert(0.1, 0.1, 0.1),
        Rgb::new(9.0, 9.0, 9.0),
        [0.6, 0.6, 0.0],
        0.2,
    );
    let scene = lamps.build();
    let scene = Tracer::new(&scene);
    let mut rng = Rng::new(6, Stream::Laboratory, 0);
    let mut observed = vec![vec![0_u64; CELLS]; 5];
    for _ in 0..SAMPLES {
        let light = light_vertex(&scene, rng.array());
        let direction = emit(&light, rng.array());
        let point = scene.invert_light(light.primitive, light.position, &mut rng).expect("a light");
        let aim = invert_emission(&light, direction);
        let again = light_vertex(&scene, point);
        assert_eq!(again.primitive, light.primitive, "another light");
        let off = (again.position - light.position).length();
        // Scenes are about a thousand units wide.
        assert!(off < 1e-4, "the point is off by {off}");
        assert!((emit(&again, aim) - direction).length() < 1e-6, "another direction");
        for (counts, u) in observed.iter_mut().zip(point.into_iter().chain(aim)) {
            counts[(u * CELLS as f64) as usize] += 1;
        }
    }
    let expected = vec![SAMPLES as f64 / CELLS as f64; CELLS];
    for (i, counts) in observed.iter().enumerate() {
        let result = chi_square_test(counts, &expected, 20.0).expect("valid counts");
        assert!(result.p_value > 1e-8, "number {i}: p = {:e}", result.p_value);
    }
}
