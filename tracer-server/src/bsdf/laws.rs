//! Laws that every scattering model must obey. A model that is in the list of `models!` is on trial,
//! with the [`Specimens`] that its own file names.

use common::{Event, Rgb};
use glam::DVec3;
use tests::{FALSE_ALARM, chi_square_test};

use super::{Bsdf, Dielectric, MODELS, Scatter, specimens};
use crate::math::{Rng, Stream, uniform_sphere};

/// What the laws must know about a model.
pub(super) trait Specimens: Scatter + Copy + 'static {
    /// How far a sum over its samples may be from the truth: where weights vary, the evenness of the
    /// numbers limits what is known.
    const MARGIN: f64 = 1e-9;

    /// The model with parameters that matter, each with a name.
    fn specimens() -> Vec<(&'static str, Self)>;

    /// How many ways there are to draw the same direction with this event: none where it does not
    /// depend on the last two numbers.
    fn samplers(event: Event) -> u32;

    /// The share of the light from that cosine that is scattered, where it is known.
    fn scatters(&self, _cosine: f64) -> Option<Rgb> {
        None
    }

    /// Index of refraction behind the surface over that in front of it.
    fn index(&self) -> f64 {
        1.0
    }
}

/// A model on trial.
pub(super) struct Specimen {
    name: &'static str,
    bsdf: Bsdf,
    margin: f64,
    samplers: fn(Event) -> u32,
    scatters: Box<dyn Fn(f64) -> Option<Rgb>>,
    index: f64,
}

/// The specimens of one model.
pub(super) fn specimens_of<M: Specimens>(bsdf: fn(M) -> Bsdf) -> Vec<Specimen> {
    let specimen = |(name, model): (&'static str, M)| Specimen {
        name,
        bsdf: bsdf(model),
        margin: M::MARGIN,
        samplers: M::samplers,
        scatters: Box::new(move |cosine| model.scatters(cosine)),
        index: model.index(),
    };
    let all: Vec<Specimen> = M::specimens().into_iter().map(specimen).collect();
    assert!(!all.is_empty(), "{} has no specimen", M::NAME);
    all
}

/// Every model with parameters that matter.
fn models() -> impl Iterator<Item = (&'static str, Bsdf)> {
    specimens().into_iter().map(|specimen| (specimen.name, specimen.bsdf))
}

const N: DVec3 = DVec3::new(0.0, 0.6, 0.8);

fn directions(count: usize) -> impl Iterator<Item = DVec3> {
    let mut rng = Rng::new(8, Stream::Laboratory, 0);
    (0..count).map(move |_| uniform_sphere(rng.uniform(), rng.uniform()))
}

/// Names stand for one thing each.
#[test]
fn names_are_told_apart() {
    let plugins = MODELS.iter().flat_map(|kind| kind.plugins).copied().collect();
    let kinds = MODELS.iter().map(|kind| kind.name).collect();
    let specimens = models().map(|(name, _)| name).collect();
    for mut names in [plugins, kinds, specimens] as [Vec<&str>; 3] {
        let count = names.len();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), count, "one name stands for two: {names:?}");
    }
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

/// A direction exactly along the surface, as between two points of one flat wall, carries nothing to
/// either side: its density is zero, and quotients of densities would be NaN.
#[test]
fn nothing_is_scattered_along_the_surface() {
    let along = DVec3::X;
    for (name, bsdf) in models() {
        for w in directions(200).chain([DVec3::Y]) {
            for event in [Event::Diffuse, Event::Glossy] {
                for (w_l, w_e) in [(along, w), (w, along)] {
                    let found = bsdf.evaluate(DVec3::Z, w_l, w_e, event);
                    assert_eq!(found, None, "{name}: {event:?} from {w_l} to {w_e}");
                }
            }
        }
    }
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-6 * a.abs().max(b.abs())
}

/// Index of refraction on the side of `w_e` over that on the side of `w_l`.
fn index_ratio(index: f64, w_l: DVec3, w_e: DVec3) -> f64 {
    match (N.dot(w_l) > 0.0, N.dot(w_e) > 0.0) {
        (true, false) => index,
        (false, true) => 1.0 / index,
        (true, true) | (false, false) => 1.0,
    }
}

/// The value does not depend on which neighbour is the light: `f(a, b) = f(b, a)`, and for
/// refraction the eye's factor is the squared ratio of indices.
#[test]
fn scattering_is_reciprocal() {
    let mut rng = Rng::new(8, Stream::Laboratory, 2);
    for Specimen { name, bsdf, index, .. } in specimens() {
        for w in directions(2000) {
            let Some((onward, event)) = bsdf.sample(N, w, rng.array()) else { continue };
            let there = bsdf.evaluate(N, onward, w, event).expect("a drawn direction");
            let back = bsdf.evaluate(N, w, onward, event).expect("and its reverse");
            let squared = index_ratio(index, onward, w).powi(2);
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

/// No model reflects more than it receives, and what is known of it is so: clear glass, white walls,
/// mirrors, the boundary between equal media, and white paint under a clear coat lose nothing.
#[test]
fn energy_is_not_made() {
    let mut known = 0;
    for Specimen { name, bsdf, margin, scatters, .. } in specimens() {
        let albedo = bsdf.albedo();
        assert!((0.0..=1.0).contains(&albedo), "{name}: {albedo}");
        for w in directions(64) {
            let sum = scattered(&bsdf, w);
            assert!(sum.max_channel() <= 1.0 + margin, "{name}: {sum:?} from {w}");
            if let Some(due) = scatters(N.dot(w).abs()) {
                known += 1;
                let off = (sum + due * -1.0).max_channel().max((due + sum * -1.0).max_channel());
                assert!(off < margin, "{name}: {sum:?} of {due:?} from {w}");
            }
        }
    }
    assert!(known >= 64 * 10, "only {known} sums are known");
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
        let drawn = bsdf.specular_direction(N, w, event).map(|onward| density(onward, event));
        expected[slot] = drawn.unwrap_or(0.0) * samples as f64;
    }
    // Quadrature may tell a trifle more than all.
    expected[CELLS - 1] = (samples as f64 - expected.iter().sum::<f64>()).max(0.0);
    expected
}

#[test]
fn total_reflection_and_grazing_light_are_no_trap() {
    let glass = Bsdf::Dielectric(Dielectric::clear(1.5));
    // From inside, beyond the critical angle.
    let inside = (DVec3::new(1.0, 0.0, 0.0) - 0.1 * DVec3::Z).normalize();
    assert_eq!(
        glass.specular_direction(DVec3::Z, inside, Event::Transmit),
        None,
        "nothing is refracted"
    );
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

/// The inverse finds the very numbers behind a direction where only one sampler can have drawn it.
///
/// Among several it draws one as often as it was the true one, which is true in at least one of so
/// many cases. A direction that no number tells is the same for all of them.
#[test]
fn inverses_find_the_numbers() {
    const SAMPLES: u32 = 4000;
    let mut rng = Rng::new(8, Stream::Laboratory, 9);
    for Specimen { name, bsdf, samplers, .. } in specimens() {
        // By number of samplers: samples, and those whose numbers were found.
        let mut counts = [(0_u32, 0_u32); 4];
        for w in directions(SAMPLES as usize) {
            let u = rng.array();
            let Some((onward, event)) = bsdf.sample(N, w, u) else { continue };
            let samplers = samplers(event);
            if samplers == 0 {
                let other = [u[0], rng.uniform(), rng.uniform()];
                assert_eq!(bsdf.sample(N, w, other), Some((onward, event)), "{name}: {u:?}");
                continue;
            }
            let found = bsdf.invert(N, w, onward, event, &mut rng);
            let is_found = u.into_iter().zip(found).skip(1).all(|(a, b)| {
                // Azimuths of 0 and 1 are the same.
                let off = (a - b).abs().min(1.0 - (a - b).abs());
                off < 1e-9 || a < 1e-6
            });
            assert!(is_found || samplers > 1, "{name}: {u:?} and {found:?}");
            let count = &mut counts[samplers as usize];
            *count = (count.0 + 1, count.1 + u32::from(is_found));
        }
        for (samplers, (drawn, found)) in counts.into_iter().enumerate().skip(2) {
            // Seven standard deviations of a fair coin below the least share.
            let least = f64::from(drawn) / samplers as f64 - 3.5 * f64::from(drawn).sqrt();
            assert!(f64::from(found) >= least, "{name}: only {found} of {drawn} were found");
        }
    }
}
