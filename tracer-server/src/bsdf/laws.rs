//! Laws that every scattering model must obey. To put a new model on trial, add it to [`MODELS`].

use common::{Event, Rgb};
use glam::DVec3;
use tests::chi_square_test;

use super::{Bsdf, Dielectric, Lambert, Mirror, Scatter as _};
use crate::math::{Rng, Stream, uniform_sphere};

const CLEAR: Dielectric =
    Dielectric { eta: 1.5, reflectance: Rgb::WHITE, transmittance: Rgb::WHITE };

/// Every model with parameters that matter.
const MODELS: [(&str, Bsdf); 7] = [
    ("lambert", Bsdf::Lambert(Lambert { reflectance: Rgb::new(0.9, 0.5, 0.1) })),
    ("white lambert", Bsdf::Lambert(Lambert { reflectance: Rgb::WHITE })),
    ("mirror", Bsdf::Mirror(Mirror { reflectance: Rgb::new(0.9, 0.8, 0.7) })),
    ("glass", Bsdf::Dielectric(CLEAR)),
    ("bubble", Bsdf::Dielectric(Dielectric { eta: 1.0 / 1.33, ..CLEAR })),
    ("nothing", Bsdf::Dielectric(Dielectric { eta: 1.0, ..CLEAR })),
    ("nearly nothing", Bsdf::Dielectric(Dielectric { eta: 1.0 + 1e-7, ..CLEAR })),
];

const N: DVec3 = DVec3::new(0.0, 0.6, 0.8);

fn directions(count: usize) -> impl Iterator<Item = DVec3> {
    let mut rng = Rng::new(8, Stream::Laboratory, 0);
    (0..count).map(move |_| uniform_sphere(rng.uniform(), rng.uniform()))
}

#[test]
fn samples_are_unit_vectors_that_evaluate() {
    let mut rng = Rng::new(8, Stream::Laboratory, 1);
    for (name, bsdf) in MODELS {
        let mut drawn = 0;
        for w in directions(2000) {
            let Some((onward, event)) = bsdf.sample(N, w, rng.array()) else { continue };
            drawn += 1;
            assert!((onward.length() - 1.0).abs() < 1e-9, "{name}: {onward} is no unit vector");
            let s = bsdf.evaluate(N, onward, w, event);
            let s = s.unwrap_or_else(|| panic!("{name}: {event:?} from {w} to {onward} is black"));
            let values = [s.connection, s.light_weight, s.eye_weight, s.light_pdf, s.eye_pdf];
            assert!(values.iter().all(|v| v.is_finite() && *v >= 0.0), "{name}: {s:?}");
            assert!(s.eye_pdf > 0.0, "{name}: drawn with no probability");
        }
        assert!(drawn > 1500, "{name}: only {drawn} samples");
    }
}

/// The value does not depend on which neighbour is the light: `f(a, b) = f(b, a)`, and for
/// refraction the eye's factor is the squared ratio of indices.
#[test]
fn scattering_is_reciprocal() {
    let mut rng = Rng::new(8, Stream::Laboratory, 2);
    for (name, bsdf) in MODELS {
        for w in directions(2000) {
            let Some((onward, event)) = bsdf.sample(N, w, rng.array()) else { continue };
            let there = bsdf.evaluate(N, onward, w, event).expect("a drawn direction");
            let back = bsdf.evaluate(N, w, onward, event).expect("and its reverse");
            assert_eq!(there.color, back.color, "{name}: colour");
            let close = |a: f64, b: f64| (a - b).abs() <= 1e-6 * a.abs().max(b.abs());
            assert!(close(there.connection, back.connection), "{name}: {there:?} {back:?}");
            // Fresnel's reflectance, for one, is the same from both sides of the boundary.
            assert!(close(there.eye_pdf, back.light_pdf), "{name}: {there:?} {back:?}");
            if event.is_specular() {
                assert!(close(there.eye_weight * back.eye_weight, 1.0), "{name}: radiance scale");
            }
        }
    }
}

/// No model reflects more than it receives, and clear glass, white walls and the boundary between
/// equal media lose nothing: the mean weight of samples is their albedo.
#[test]
fn energy_is_not_made() {
    let mut rng = Rng::new(8, Stream::Laboratory, 3);
    for (name, bsdf) in MODELS {
        for w in directions(64) {
            let mut sum = 0.0;
            for _ in 0..500 {
                let Some((onward, event)) = bsdf.sample(N, w, rng.array()) else { continue };
                // Made by a walk from the light, which carries flux.
                let s = bsdf.evaluate(N, w, onward, event).expect("a drawn direction");
                sum += (s.color * s.light_weight).max_channel() / 500.0;
            }
            assert!(sum <= bsdf.albedo() + 1e-9, "{name}: albedo {sum} from {w}");
            assert!(sum > bsdf.albedo() - 1e-9, "{name}: {sum} of {} is left", bsdf.albedo());
        }
    }
}

/// Samples fall as the density says, chi-square over a grid of the sphere; Dirac events by their
/// probabilities.
#[test]
fn samples_follow_their_density() {
    const SAMPLES: usize = 200_000;
    const CELLS: usize = 16;
    let mut rng = Rng::new(8, Stream::Laboratory, 4);
    let mut judged = 0;
    for (name, bsdf) in MODELS {
        for w in directions(3) {
            let mut observed = vec![0_u64; CELLS * CELLS + 2];
            for _ in 0..SAMPLES {
                let Some((onward, event)) = bsdf.sample(N, w, rng.array()) else { continue };
                let cell = match event {
                    Event::Reflect => CELLS * CELLS,
                    Event::Transmit => CELLS * CELLS + 1,
                    _ => cell_of(onward, CELLS),
                };
                observed[cell] += 1;
            }
            let expected = expected_counts(&bsdf, w, CELLS, SAMPLES);
            if bsdf.connectable().is_none() {
                // Two cells, or one: the probabilities of the events.
                for (seen, due) in observed.iter().zip(&expected) {
                    let sd = (due * (1.0 - due / SAMPLES as f64)).sqrt();
                    assert!((*seen as f64 - due).abs() <= 6.0 * sd + 1.0, "{name} from {w}");
                }
            } else {
                let result = chi_square_test(&observed, &expected, 20.0).expect("valid counts");
                assert!(result.p_value > 1e-7, "{name} from {w}: p = {:e}", result.p_value);
            }
            judged += 1;
        }
    }
    assert_eq!(judged, 3 * MODELS.len(), "every model was on trial");
}

/// Cells of equal solid angle: slices in z, sectors in azimuth.
fn cell_of(w: DVec3, cells: usize) -> usize {
    let row = ((0.5 * (w.z + 1.0)) * cells as f64) as usize;
    let turn = w.y.atan2(w.x) / std::f64::consts::TAU + 0.5;
    row.min(cells - 1) * cells + ((turn * cells as f64) as usize).min(cells - 1)
}

fn expected_counts(bsdf: &Bsdf, w: DVec3, cells: usize, samples: usize) -> Vec<f64> {
    const FINE: usize = 24;
    let mut expected = vec![0.0; cells * cells + 2];
    let steps = cells * FINE;
    let solid_angle = 4.0 * std::f64::consts::PI / (steps * steps) as f64;
    for i in 0..steps {
        for j in 0..steps {
            let u = (i as f64 + 0.5) / steps as f64;
            let azimuth = ((j as f64 + 0.5) / steps as f64 - 0.5) * std::f64::consts::TAU;
            let z = 2.0 * u - 1.0;
            let r = (1.0 - z * z).sqrt();
            let onward = DVec3::new(r * azimuth.cos(), r * azimuth.sin(), z);
            if let Some(s) = bsdf.evaluate(N, onward, w, Event::Diffuse) {
                expected[cell_of(onward, cells)] += s.eye_pdf * solid_angle * samples as f64;
            }
        }
    }
    for (slot, event) in [(0, Event::Reflect), (1, Event::Transmit)] {
        let drawn = bsdf.follow(N, w, event).and_then(|o| bsdf.evaluate(N, o, w, event));
        expected[cells * cells + slot] = drawn.map_or(0.0, |s| s.eye_pdf * samples as f64);
    }
    expected
}

#[test]
fn total_reflection_and_grazing_light_are_no_trap() {
    let glass = Bsdf::Dielectric(CLEAR);
    // From inside, beyond the critical angle.
    let inside = (DVec3::new(1.0, 0.0, 0.0) - 0.1 * DVec3::Z).normalize();
    assert_eq!(glass.follow(DVec3::Z, inside, Event::Transmit), None, "nothing is refracted");
    let mut rng = Rng::new(8, Stream::Laboratory, 5);
    for _ in 0..100 {
        let (_, event) = glass.sample(DVec3::Z, inside, rng.array()).expect("all is reflected");
        assert_eq!(event, Event::Reflect, "total internal reflection");
    }
    let grazing = DVec3::new(1.0, 0.0, 1e-12).normalize();
    for (name, bsdf) in MODELS {
        if let Some((onward, event)) = bsdf.sample(DVec3::Z, grazing, rng.array())
            && let Some(s) = bsdf.evaluate(DVec3::Z, onward, grazing, event)
        {
            assert!(s.eye_weight.is_finite() && s.eye_pdf.is_finite(), "{name}: {s:?}");
        }
    }
}

/// The inverse gives numbers that make the same sample again, and numbers that were uniform before
/// they made a sample are uniform again: chi-square over each pair of them.
#[test]
fn inverses_lead_back_to_uniform_numbers() {
    const SAMPLES: usize = 100_000;
    const CELLS: usize = 16;
    let mut rng = Rng::new(8, Stream::Laboratory, 6);
    for (name, bsdf) in MODELS {
        for w in directions(3) {
            let mut observed = vec![vec![0_u64; CELLS * CELLS]; 3];
            for _ in 0..SAMPLES {
                let mut u = rng.array();
                if let Some((onward, event)) = bsdf.sample(N, w, u) {
                    u = bsdf.invert(N, w, onward, event, &mut rng);
                    assert!(u.iter().all(|u| (0.0..1.0).contains(u)), "{name}: {u:?}");
                    let (again, same) = bsdf.sample(N, w, u).expect("a sample");
                    assert_eq!(same, event, "{name}: another event");
                    let error = (again - onward).length();
                    assert!(error < 1e-7, "{name}: {again} instead of {onward}");
                }
                let cell = u.map(|u| (u * CELLS as f64) as usize);
                for (pair, (i, j)) in [(0, 1), (1, 2), (2, 0)].into_iter().enumerate() {
                    observed[pair][cell[i] * CELLS + cell[j]] += 1;
                }
            }
            let expected = vec![SAMPLES as f64 / (CELLS * CELLS) as f64; CELLS * CELLS];
            for observed in observed {
                let result = chi_square_test(&observed, &expected, 20.0).expect("valid counts");
                assert!(result.p_value > 1e-8, "{name} from {w}: p = {:e}", result.p_value);
            }
        }
    }
}
