//! Laws of paths: every cached value can be recomputed, and the splits agree on one contribution.

use std::f64::consts::PI;

use common::Rgb;
use glam::DVec3;
use tests::chi_square_test;

use super::{BidirectionalSampler, CameraSample, Path, Vertex, emit, light_vertex};
use crate::bsdf::Bsdf;
use crate::math::{Rng, Stream};
use crate::scene::fixtures::{Fixture, bumpy_room, diffuse_room, every_light, specular_room};
use crate::scene::{LightKind, Tracer};

/// Paths of bidirectional samples, one from each sample that has any.
pub(super) fn sample_paths(scene: &Tracer<'_>, samples: u64) -> Vec<Path> {
    let mut sampler = BidirectionalSampler::new(scene);
    let mut rng = Rng::new(5, Stream::Laboratory, 0);
    let mut paths = Vec::new();
    for _ in 0..samples {
        let aim = CameraSample::from_numbers(scene, &mut rng);
        sampler.sample(scene, aim, &mut rng, |path, _| paths.push(path.clone()));
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

/// What the light at the start of a path gives, written down a second time.
///
/// Colour, density of the start, and the start's part of the geometry of an edge to a point in direction `w` at distance
/// `r`; then the density of the second vertex, per area facing the light there.
struct Start {
    color: Rgb,
    pdf: f64,
    geometry: f64,
    next_pdf: f64,
}

fn start(scene: &Tracer<'_>, path: &Path, fixture: &Fixture) -> Start {
    let [light, next, ..] = path.vertices() else { panic!("a path has two vertices") };
    let w = path.edges()[0].direction;
    let r2 = (next.position - light.position).length_squared();
    let frame = scene.frame();
    let scale = frame.scale * frame.scale / scene.radiance_scale();
    let emission = scene.emission(light.primitive, light.material, w).expect("a light");
    let kind = fixture.description.lights.first().map(|light| &light.kind);
    match kind.filter(|_| light.is_lamp()) {
        None => Start {
            color: emission.color,
            pdf: emission.pdf,
            geometry: light.normal.dot(w) / r2,
            next_pdf: light.normal.dot(w) / PI / r2,
        },
        Some(LightKind::Point { intensity, .. }) => Start {
            color: *intensity * scale,
            pdf: emission.pdf,
            geometry: 1.0 / r2,
            next_pdf: 1.0 / (4.0 * PI) / r2,
        },
        Some(LightKind::Spot { intensity, direction, cutoff, beam, .. }) => {
            let cosine = |degrees: f64| degrees.to_radians().cos();
            let t = (direction.normalize().dot(w) - cosine(*cutoff))
                / (cosine(*beam) - cosine(*cutoff));
            let t = t.clamp(0.0, 1.0);
            Start {
                color: *intensity * scale * (t * t * (3.0 - 2.0 * t)),
                pdf: emission.pdf,
                geometry: 1.0 / r2,
                next_pdf: 1.0 / (2.0 * PI * (1.0 - cosine(*cutoff))) / r2,
            }
        }
        Some(LightKind::Directional { .. } | LightKind::Environment { .. }) => {
            // The ball around the cube of two units in which the fixtures with such lights lie.
            let radius2 = 3.0 * frame.scale * frame.scale;
            Start {
                color: emission.color,
                pdf: emission.pdf,
                geometry: 1.0,
                next_pdf: 1.0 / (PI * radius2),
            }
        }
    }
}

/// The normal that a surface is shaded by.
pub(super) fn shading(scene: &Tracer<'_>, at: &Vertex) -> DVec3 {
    scene.local(&at.anchor(), at.material).shading()
}

/// Luminance of `f` with respect to area measure, factor by factor from the vertices.
///
/// At an infinite start the measure is solid angle. Edges have geometric cosines at their light end and shading cosines at
/// their eye end.
fn area_contribution(scene: &Tracer<'_>, path: &Path, start: &Start) -> f64 {
    let v = path.vertices();
    let k = path.edge_count();
    let mut color = start.color;
    let mut scalar = start.geometry;
    for j in 0..k {
        let span = v[j + 1].position - v[j].position;
        let (r2, w) = (span.length_squared(), span.normalize());
        let at_lens = j + 1 == k;
        let far = if at_lens { 1.0 } else { shading(scene, &v[j + 1]).dot(w).abs() };
        scalar *= if j == 0 { far } else { v[j].normal.dot(w).abs() * far / r2 };
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
fn area_density(scene: &Tracer<'_>, path: &Path, light: usize, start: &Start) -> f64 {
    let v = path.vertices();
    let k = path.edge_count();
    let facing = |from: DVec3, to: usize| {
        let w = (v[to].position - from).normalize();
        v[to].normal.dot(w).abs()
    };
    // Density of drawing `to` from `from` with density cos / pi, per unit area at `to`; a start
    // infinitely far away is drawn per solid angle.
    let cosine_sampled = |from: usize, to: usize| {
        let span = v[to].position - v[from].position;
        let (r2, w) = (span.length_squared(), span.normalize());
        let out = shading(scene, &v[from]).dot(w).abs() / PI;
        if to == 0 && path.is_lit_from_afar() {
            out
        } else {
            out * facing(v[from].position, to) / r2
        }
    };
    let mut density = 1.0;
    for j in 0..light {
        density *= match j {
            0 => start.pdf,
            1 => start.next_pdf * facing(v[0].position, 1),
            _ => cosine_sampled(j - 1, j),
        };
    }
    for j in (light..k).rev() {
        density *= if j + 1 == k {
            let span = v[k].position - v[j].position;
            let (r2, w) = (span.length_squared(), span.normalize());
            let cosine = -v[k].normal.dot(w);
            let seen = scene.camera().film_per_solid_angle(cosine);
            if j == 0 && path.is_lit_from_afar() {
                seen
            } else {
                seen * v[j].normal.dot(w).abs() / r2
            }
        } else {
            cosine_sampled(j + 1, j)
        };
    }
    density
}

#[test]
fn all_splits_tell_one_contribution() {
    let rooms = [("surface", diffuse_room()), ("shading normals", bumpy_room())];
    for (name, fixture) in rooms.into_iter().chain(every_light()) {
        let scene = fixture.build();
        let scene = Tracer::new(&scene);
        let mut compared = 0;
        for path in sample_paths(&scene, 400) {
            assert!(path.is_fresh(&scene), "{name}: a cached value is stale");
            if path.vertices().iter().any(|vertex| vertex.event.is_specular()) {
                continue;
            }
            let start = start(&scene, &path, &fixture);
            let f = area_contribution(&scene, &path, &start);
            for light in 0..=path.edge_count() {
                // p_i / lum f, once from the cached weights and once from explicit densities.
                let expected = area_density(&scene, &path, light, &start) / f;
                let found = path.reciprocal(light);
                if light == 0 && found == 0.0 && !scene.features().hittable {
                    continue;
                }
                let error = (found / expected - 1.0).abs();
                assert!(error < 1e-7, "{name}, {} split {light}: off by {error}", path.class());
                compared += 1;
            }
        }
        assert!(compared > 1000, "{name}: only {compared} splits compared");
    }
}

/// The inverses of light points and emission make the same light vertex again, and lead from
/// uniform numbers to uniform numbers.
#[test]
fn light_points_and_emission_are_inverted() {
    let lamps = specular_room().sphere(
        crate::scene::fixtures::lambert(0.1, 0.1, 0.1),
        Rgb::new(9.0, 9.0, 9.0),
        [0.6, 0.6, 0.0],
        0.2,
    );
    for (name, fixture) in std::iter::once(("surfaces", lamps)).chain(every_light()) {
        let scene = fixture.build();
        assert_inverted(name, &Tracer::new(&scene));
    }
}

fn assert_inverted(name: &str, scene: &Tracer<'_>) {
    const SAMPLES: usize = 50_000;
    const CELLS: usize = 32;
    let mut rng = Rng::new(6, Stream::Laboratory, 0);
    let mut observed = vec![vec![0_u64; CELLS]; 5];
    for _ in 0..SAMPLES {
        let light = light_vertex(scene, rng.array());
        let (from, direction) = emit(scene, &light, rng.array());
        let next = from.position + 700.0 * direction;
        let point = scene.invert_light(&light.light_sample(), &mut rng).expect("a light");
        let aim = scene.invert_emission(&light.light_sample(), direction, next);
        let again = light_vertex(scene, point);
        assert_eq!(again.material, light.material, "{name}: another light");
        let off = (again.position - light.position).length();
        // Scenes are about a thousand units wide.
        assert!(off < 1e-4, "{name}: the point is off by {off}");
        let (from_again, direction_again) = emit(scene, &again, aim);
        assert!((direction_again - direction).length() < 1e-6, "{name}: another direction");
        assert!((from_again.position - from.position).length() < 1e-3, "{name}: another ray");
        for (counts, u) in observed.iter_mut().zip(point.into_iter().chain(aim)) {
            counts[(u * CELLS as f64) as usize] += 1;
        }
    }
    let expected = vec![SAMPLES as f64 / CELLS as f64; CELLS];
    for (i, counts) in observed.iter().enumerate() {
        let result = chi_square_test(counts, &expected, 20.0).expect("valid counts");
        assert!(result.p_value > 1e-8, "{name}: number {i}: p = {:e}", result.p_value);
    }
}
