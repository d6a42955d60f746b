//! Laws that every scattering model must obey. To put a new model on trial, add it to [`models`].

use common::{Event, Rgb};
use glam::DVec3;
use tests::{FALSE_ALARM, chi_square_test};

use super::{
    Bsdf, Dielectric, Fresnel, Ggx, Lambert, Mirror, Plastic, RoughConductor, RoughDielectric,
    RoughPlastic, Scatter as _,
};
use crate::math::{Rng, Stream, uniform_sphere};

const CLEAR: Dielectric =
    Dielectric { eta: 1.5, reflectance: Rgb::WHITE, transmittance: Rgb::WHITE };
const COAT: Fresnel = Fresnel::Dielectric { eta: 1.5, tint: Rgb::WHITE };
const GOLD: Fresnel = Fresnel::Conductor {
    eta: Rgb::new(0.18, 0.42, 1.37),
    k: Rgb::new(3.42, 2.35, 1.77),
    tint: Rgb::WHITE,
};
const RED: Rgb = Rgb::new(0.8, 0.2, 0.05);

/// Every model with parameters that matter.
fn models() -> Vec<(&'static str, Bsdf)> {
    let metal =
        |fresnel, alpha| Bsdf::RoughConductor(RoughConductor { fresnel, facets: Ggx::new(alpha) });
    let glass = |eta, alpha| {
        let facet = Dielectric { eta, ..CLEAR };
        Bsdf::RoughDielectric(RoughDielectric { facet, facets: Ggx::new(alpha) })
    };
    let paint = |diffuse, fresnel, alpha| {
        Bsdf::RoughPlastic(RoughPlastic::new(diffuse, fresnel, Ggx::new(alpha)))
    };
    let tinted = Fresnel::Dielectric { eta: 1.3, tint: Rgb::new(0.5, 0.4, 0.9) };
    vec![
        ("lambert", Bsdf::Lambert(Lambert { reflectance: Rgb::new(0.9, 0.5, 0.1) })),
        ("white lambert", Bsdf::Lambert(Lambert { reflectance: Rgb::WHITE })),
        ("mirror", Bsdf::Mirror(Mirror::new(Rgb::new(0.9, 0.8, 0.7)))),
        ("smooth gold", Bsdf::Mirror(Mirror { fresnel: GOLD })),
        ("glass", Bsdf::Dielectric(CLEAR)),
        ("bubble", Bsdf::Dielectric(Dielectric { eta: 1.0 / 1.33, ..CLEAR })),
        ("nothing", Bsdf::Dielectric(Dielectric { eta: 1.0, ..CLEAR })),
        ("nearly nothing", Bsdf::Dielectric(Dielectric { eta: 1.0 + 1e-7, ..CLEAR })),
        ("polished gold", metal(GOLD, 0.08)),
        ("brushed steel", metal(Fresnel::Schlick(Rgb::new(0.56, 0.57, 0.58)), 0.35)),
        ("matt silver", metal(Fresnel::Constant(Rgb::WHITE), 1.0)),
        ("hazy glass", glass(1.5, 0.12)),
        ("frosted glass", glass(1.5, 0.5)),
        ("rough bubble", glass(1.0 / 1.33, 0.3)),
        ("plastic", Bsdf::Plastic(Plastic::new(RED, COAT))),
        ("white plastic", Bsdf::Plastic(Plastic::new(Rgb::WHITE, COAT))),
        ("tinted coat", Bsdf::Plastic(Plastic::new(RED, tinted))),
        ("black glass", Bsdf::Plastic(Plastic::new(Rgb::BLACK, COAT))),
        ("rough plastic", paint(RED, COAT, 0.1)),
        ("white rough plastic", paint(Rgb::WHITE, COAT, 0.4)),
        ("phong", paint(RED, Fresnel::Schlick(Rgb::new(0.5, 0.4, 0.3)), 0.2)),
        ("rough tinted coat", paint(RED, tinted, 0.6)),
    ]
}

const N: DVec3 = DVec3::new(0.0, 0.6, 0.8);

fn directions(count: usize) -> impl Iterator<Item = DVec3> {
    let mut rng = Rng::new(8, Stream::Laboratory, 0);
    (0..count).map(move |_| uniform_sphere(rng.uniform(), rng.uniform()))
}

#[test]
fn every_variant_is_on_trial() {
    // A new variant does not compile here: give it the next number, and add it to the models.
    let number = |bsdf: &Bsdf| match bsdf {
        Bsdf::Lambert(_) => 0,
        Bsdf::Mirror(_) => 1,
        Bsdf::Dielectric(_) => 2,
        Bsdf::RoughConductor(_) => 3,
        Bsdf::RoughDielectric(_) => 4,
        Bsdf::Plastic(_) => 5,
        Bsdf::RoughPlastic(_) => 6,
    };
    let mut seen: Vec<usize> = models().iter().map(|(_, bsdf)| number(bsdf)).collect();
    seen.dedup();
    assert_eq!(seen, (0..=6).collect::<Vec<_>>(), "a variant is not among the models");
}

#[test]
fn samples_are_unit_vectors_that_evaluate() {
    let mut rng = Rng::new(8, Stream::Laboratory, 1);
    for (name, bsdf) in models() {
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
        assert!(drawn > 1000, "{name}: only {drawn} samples");
    }
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-6 * a.abs().max(b.abs())
}

/// Index of refraction on the side of `w_e` over that on the side of `w_l`.
fn index_ratio(bsdf: &Bsdf, w_l: DVec3, w_e: DVec3) -> f64 {
    let eta = match bsdf {
        Bsdf::Dielectric(m) => m.eta,
        Bsdf::RoughDielectric(m) => m.facet.eta,
        _ => 1.0,
    };
    match (N.dot(w_l) > 0.0, N.dot(w_e) > 0.0) {
        (true, false) => eta,
        (false, true) => 1.0 / eta,
        _ => 1.0,
    }
}

/// The value does not depend on which neighbour is the light: `f(a, b) = f(b, a)`, and for
/// refraction the eye's factor is the squared ratio of indices.
#[test]
fn scattering_is_reciprocal() {
    let mut rng = Rng::new(8, Stream::Laboratory, 2);
    for (name, bsdf) in models() {
        for w in directions(2000) {
            let Some((onward, event)) = bsdf.sample(N, w, rng.array()) else { continue };
            let there = bsdf.evaluate(N, onward, w, event).expect("a drawn direction");
            let back = bsdf.evaluate(N, w, onward, event).expect("and its reverse");
            let squared = index_ratio(&bsdf, onward, w).powi(2);
            let (a, b) = (<[f64; 3]>::from(there.color), <[f64; 3]>::from(back.color));
            for (a, b) in a.into_iter().zip(b) {
                assert!(close(a, b), "{name}: colour {there:?} {back:?}");
            }
            let (a, b) = (there.connection, back.connection * squared);
            assert!(close(a, b), "{name}: {there:?} {back:?}");
            // Fresnel's reflectance, for one, is the same from both sides of the boundary.
            assert!(close(there.eye_pdf, back.light_pdf), "{name}: {there:?} {back:?}");
            assert!(close(there.light_pdf, back.eye_pdf), "{name}: {there:?} {back:?}");
            if event.is_specular() {
                let (flux, radiance) =
                    (there.light_weight * there.light_pdf, there.eye_weight * there.eye_pdf);
                assert!(close(flux * squared, radiance), "{name}: radiance scale {there:?}");
            }
        }
    }
}

/// The weights are `f cos / pdf`, however they were found.
#[test]
fn weights_are_quotients() {
    let mut rng = Rng::new(8, Stream::Laboratory, 7);
    for (name, bsdf) in models() {
        for w in directions(2000) {
            let Some((onward, event)) = bsdf.sample(N, w, rng.array()) else { continue };
            if event.is_specular() {
                continue;
            }
            let s = bsdf.evaluate(N, onward, w, event).expect("a drawn direction");
            let light = s.connection * N.dot(w).abs() / s.light_pdf;
            let eye = s.connection * N.dot(onward).abs() / s.eye_pdf;
            assert!(close(s.light_weight, light), "{name}: {light} {s:?}");
            assert!(close(s.eye_weight, eye), "{name}: {eye} {s:?}");
        }
    }
}

/// The share of the light from `w` that is scattered, one value a channel, by numbers that cover
/// the unit cube evenly: multiples of powers of the reciprocal of the root of x^4 = x + 1.
fn scattered(bsdf: &Bsdf, w: DVec3) -> Rgb {
    const POINTS: u32 = 20_000;
    const ROOT: f64 = 1.220_744_084_605_759_5;
    let point = |i: u32| {
        let i = f64::from(i) + 0.5;
        [(i / ROOT).fract(), (i / ROOT.powi(2)).fract(), (i / ROOT.powi(3)).fract()]
    };
    let mut sum = Rgb::BLACK;
    for i in 0..POINTS {
        if let Some((onward, event)) = bsdf.sample(N, w, point(i)) {
            // Made by a walk from the light, which carries flux.
            let s = bsdf.evaluate(N, w, onward, event).expect("a drawn direction");
            sum += s.color * s.light_weight;
        }
    }
    sum / f64::from(POINTS)
}

/// No model reflects more than it receives; and clear glass, white walls, mirrors, the boundary
/// between equal media, and white paint under a clear coat lose nothing.
#[test]
fn energy_is_not_made() {
    for (name, bsdf) in models() {
        let albedo = bsdf.albedo();
        assert!((0.0..=1.0).contains(&albedo), "{name}: {albedo}");
        for w in directions(64) {
            let sum = scattered(&bsdf, w);
            // Where weights vary, the evenness of the numbers limits what is known.
            let limit = match bsdf {
                Bsdf::RoughPlastic(_) => 5e-3,
                Bsdf::Plastic(_) => 1e-3,
                _ => 1e-9,
            };
            assert!(sum.max_channel() <= 1.0 + limit, "{name}: {sum:?} from {w}");
            let exact = match bsdf {
                Bsdf::Lambert(m) => Some((m.reflectance, 1e-9)),
                Bsdf::Mirror(m) => Some((m.fresnel.at(N.dot(w).abs()), 1e-9)),
                Bsdf::Dielectric(_) => Some((Rgb::WHITE, 1e-9)),
                Bsdf::Plastic(m) if m.diffuse == Rgb::WHITE => Some((Rgb::WHITE, 1e-3)),
                Bsdf::RoughPlastic(m) if m.diffuse == Rgb::WHITE => Some((Rgb::WHITE, 5e-3)),
                _ => None,
            };
            if let Some((due, margin)) = exact {
                let off = (sum + due * -1.0).max_channel().max((due + sum * -1.0).max_channel());
                assert!(off < margin, "{name}: {sum:?} of {due:?} from {w}");
            }
        }
    }
}

/// Rows and columns of the grid of directions.
const GRID: (usize, usize) = (20, 40);
/// Cells of the grid, mirror reflection, smooth refraction, and what is absorbed.
const CELLS: usize = GRID.0 * GRID.1 + 3;

/// Samples fall as the density says, for walks from the eye and from the light.
///
/// Chi-square over a grid of the sphere, the probabilities of Dirac events and the share absorbed.
/// The threshold is Holm's for the smallest p-value of all tests.
#[test]
fn samples_follow_their_density() {
    const SAMPLES: usize = 100_000;
    let mut rng = Rng::new(8, Stream::Laboratory, 4);
    let mut results = Vec::new();
    for (name, bsdf) in models() {
        for w in directions(3) {
            let mut observed = vec![0_u64; CELLS];
            for _ in 0..SAMPLES {
                let drawn = bsdf.sample(N, w, rng.array());
                observed[drawn.map_or(CELLS - 1, |(onward, event)| match event {
                    Event::Reflect => CELLS - 3,
                    Event::Transmit => CELLS - 2,
                    _ => cell_of(onward),
                })] += 1;
            }
            for from_eye in [true, false] {
                let expected = expected_counts(&bsdf, w, from_eye, SAMPLES);
                // Only rounding and quadrature fall into cells that expect nothing.
                let impossible = observed.iter().zip(&expected).any(|(o, e)| *o > 40 && *e < 1e-2);
                assert!(!impossible, "{name} from {w}: samples without density");
                if expected.iter().filter(|e| **e > 20.0).count() < 2 {
                    let whole = expected.iter().copied().fold(0.0, f64::max);
                    assert!(whole > SAMPLES as f64 - 21.0, "{name} from {w}: {whole}");
                    continue;
                }
                let result = chi_square_test(&observed, &expected, 20.0).expect("valid counts");
                results.push((result.p_value, name, w, from_eye));
            }
        }
    }
    let count = results.len();
    assert!(count > 80, "only {count} tests");
    let worst = results.iter().min_by(|a, b| a.0.total_cmp(&b.0)).expect("results");
    assert!(worst.0 > FALSE_ALARM / count as f64, "of {count}: {worst:?}");
}

/// Cells of equal solid angle: slices in z, sectors in azimuth.
fn cell_of(w: DVec3) -> usize {
    let (rows, columns) = GRID;
    let row = ((0.5 * (w.z + 1.0)) * rows as f64) as usize;
    let turn = w.y.atan2(w.x) / std::f64::consts::TAU + 0.5;
    row.min(rows - 1) * columns + ((turn * columns as f64) as usize).min(columns - 1)
}

/// How often a patch is split at most.
const DEPTH: u32 = 5;

/// A rectangle in (z, azimuth), whose area is its solid angle.
#[derive(Clone, Copy)]
struct Patch {
    z: (f64, f64),
    azimuth: (f64, f64),
}

impl Patch {
    /// Midpoints on a grid.
    fn estimate(self, steps: usize, density: &impl Fn(DVec3) -> f64) -> f64 {
        let at = |(low, high): (f64, f64), i| low + (high - low) * (i as f64 + 0.5) / steps as f64;
        let mut sum = 0.0;
        for (i, j) in (0..steps).flat_map(|i| (0..steps).map(move |j| (i, j))) {
            let (z, azimuth) = (at(self.z, i), at(self.azimuth, j));
            let r = (1.0 - z * z).sqrt();
            sum += density(DVec3::new(r * azimuth.cos(), r * azimuth.sin(), z));
        }
        sum * (self.z.1 - self.z.0) * (self.azimuth.1 - self.azimuth.0) / (steps * steps) as f64
    }

    /// Splits the patch in four, at least once, until two estimates agree.
    fn integrate(self, depth: u32, density: &impl Fn(DVec3) -> f64) -> f64 {
        let (coarse, fine) = (self.estimate(4, density), self.estimate(7, density));
        if depth == 0 || depth < DEPTH && (coarse - fine).abs() < 1e-6 + 1e-4 * fine {
            return fine;
        }
        let middle = |(low, high): (f64, f64)| 0.5 * (low + high);
        let halves = |range: (f64, f64)| [(range.0, middle(range)), (middle(range), range.1)];
        let quarters =
            halves(self.z).into_iter().flat_map(|z| halves(self.azimuth).map(|a| (z, a)));
        quarters.map(|(z, azimuth)| Self { z, azimuth }.integrate(depth - 1, density)).sum()
    }
}

fn expected_counts(bsdf: &Bsdf, w: DVec3, from_eye: bool, samples: usize) -> Vec<f64> {
    let density = |onward: DVec3, event: Event| {
        let s = if from_eye {
            bsdf.evaluate(N, onward, w, event).map(|s| s.eye_pdf)
        } else {
            bsdf.evaluate(N, w, onward, event).map(|s| s.light_pdf)
        };
        s.unwrap_or(0.0)
    };
    let (rows, columns) = GRID;
    let mut expected = vec![0.0; CELLS];
    if let Some(event) = bsdf.connectable() {
        for (row, column) in (0..rows).flat_map(|r| (0..columns).map(move |c| (r, c))) {
            let z = |i: usize| 2.0 * i as f64 / rows as f64 - 1.0;
            let azimuth = |i: usize| (i as f64 / columns as f64 - 0.5) * std::f64::consts::TAU;
            let patch =
                Patch { z: (z(row), z(row + 1)), azimuth: (azimuth(column), azimuth(column + 1)) };
            let share = patch.integrate(DEPTH, &|onward| density(onward, event));
            // A density that only touches a corner may be missed.
            expected[row * columns + column] = (share * samples as f64).max(1e-3);
        }
    }
    for (slot, event) in [(CELLS - 3, Event::Reflect), (CELLS - 2, Event::Transmit)] {
        let drawn = bsdf.follow(N, w, event).map(|onward| density(onward, event));
        expected[slot] = drawn.unwrap_or(0.0) * samples as f64;
    }
    // Quadrature may tell a trifle more than all.
    expected[CELLS - 1] = (samples as f64 - expected.iter().sum::<f64>()).max(0.0);
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
    for elevation in [1e-4, 1e-12, 1e-200] {
        let grazing = DVec3::new(1.0, 0.0, elevation).normalize();
        for (name, bsdf) in models() {
            for _ in 0..50 {
                if let Some((onward, event)) = bsdf.sample(DVec3::Z, grazing, rng.array())
                    && let Some(s) = bsdf.evaluate(DVec3::Z, onward, grazing, event)
                {
                    let sound = s.eye_weight.is_finite() && s.eye_pdf.is_finite();
                    assert!(sound && s.connection.is_finite(), "{name}: {s:?}");
                }
            }
        }
    }
}

/// The inverse gives numbers that make the same sample again, and numbers that were uniform before
/// they made a sample are uniform again: chi-square over each pair of them.
#[test]
fn inverses_lead_back_to_uniform_numbers() {
    const SAMPLES: usize = 60_000;
    const CELLS: usize = 16;
    let mut rng = Rng::new(8, Stream::Laboratory, 6);
    for (name, bsdf) in models() {
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
                assert!(result.p_value > 1e-9, "{name} from {w}: p = {:e}", result.p_value);
            }
        }
    }
}

/// Where only one sampler can have made a direction, the inverse finds its very numbers.
#[test]
fn inverses_find_the_numbers() {
    let mut rng = Rng::new(8, Stream::Laboratory, 9);
    for (name, bsdf) in models() {
        if !matches!(bsdf, Bsdf::Lambert(_) | Bsdf::RoughConductor(_) | Bsdf::RoughDielectric(_)) {
            continue;
        }
        for w in directions(500) {
            let u = rng.array();
            let Some((onward, event)) = bsdf.sample(N, w, u) else { continue };
            let found = bsdf.invert(N, w, onward, event, &mut rng);
            for (a, b) in u.into_iter().zip(found).skip(1) {
                // Azimuths of 0 and 1 are the same.
                let off = (a - b).abs().min(1.0 - (a - b).abs());
                assert!(off < 1e-9 || a < 1e-6, "{name}: {u:?} and {found:?}");
            }
        }
    }
}
