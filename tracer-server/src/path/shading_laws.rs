//! Shading normals: forgetting an adjoint factor must show in the image.

use glam::DVec2;
use tests::Accumulator;

use super::laws::shading;
use super::{BidirectionalSampler, CameraSample, Path};
use crate::math::{Rng, Stream};
use crate::scene::Tracer;
use crate::scene::fixtures::{Fixture, bumpy_room};

/// `|n_s . w| / |n_g . w|` for the direction to the light, of vertex `j`.
fn arrival(scene: &Tracer<'_>, path: &Path, j: usize) -> f64 {
    let (at, w) = (&path.vertices()[j], path.edges()[j - 1].direction);
    (shading(scene, at).dot(w) / at.normal.dot(w)).abs()
}

/// Which adjoint factors are forgotten.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Forgotten {
    Nothing,
    InTheWalk,
    AtTheConnection,
}

/// `S` of a path when factors of arrival are forgotten.
fn forgetful_sum(scene: &Tracer<'_>, path: &Path, forgotten: Forgotten) -> f64 {
    let k = path.edge_count();
    let split = |light: usize| {
        let lost: f64 = match forgotten {
            Forgotten::InTheWalk => (1..light).map(|j| arrival(scene, path, j)).product(),
            Forgotten::AtTheConnection if (1..k).contains(&light) => arrival(scene, path, light),
            Forgotten::AtTheConnection | Forgotten::Nothing => 1.0,
        };
        path.reciprocal(light) * lost
    };
    (0..=k).map(split).sum()
}

/// The light in blocks of the film and on all of it, by bidirectional samples whose weights have
/// the sum `S` of `density_sum`.
fn light_on_film(
    fixture: &Fixture,
    seed: u64,
    density_sum: impl Fn(&Tracer<'_>, &Path) -> f64,
) -> Vec<Accumulator> {
    const BLOCKS: usize = 4;
    let scene = fixture.build();
    let scene = Tracer::new(&scene);
    let mut sampler = BidirectionalSampler::new(&scene);
    let mut rng = Rng::new(seed, Stream::Laboratory, 0);
    let mut sums = vec![Accumulator::default(); BLOCKS * BLOCKS + 1];
    for _ in 0..240_000 {
        let aim = CameraSample::through(&scene, DVec2::from(rng.array()), || [0.0; 2]);
        let mut light = [0.0; BLOCKS * BLOCKS + 1];
        sampler.sample(&scene, aim, &mut rng, |path, weight| {
            let weight = weight * path.density_sum() / density_sum(&scene, path);
            let at = (path.film() * BLOCKS as f64).as_uvec2();
            light[at.y as usize * BLOCKS + at.x as usize] += weight;
            light[BLOCKS * BLOCKS] += weight;
        });
        for (sum, light) in sums.iter_mut().zip(light) {
            sum.push(light);
        }
    }
    sums
}

fn worst_z(a: &[Accumulator], b: &[Accumulator]) -> f64 {
    let z = |(a, b): (&Accumulator, &Accumulator)| {
        (a.mean() - b.mean()) / a.standard_error().hypot(b.standard_error())
    };
    a.iter().zip(b).map(z).fold(0.0, |worst, z| z.abs().max(worst))
}

/// Forgetting the adjoint factor in walks from the light, or at connections, is found; splits of
/// all lengths compete in every weight, so that either error shows in the image.
#[test]
fn forgotten_factors_of_shading_normals_are_found() {
    let room = bumpy_room();
    let right = light_on_film(&room, 1, |_, path| path.density_sum());
    let again =
        light_on_film(&room, 2, |scene, path| forgetful_sum(scene, path, Forgotten::Nothing));
    assert!(worst_z(&right, &again) < 6.0, "right: {}", worst_z(&right, &again));
    for forgotten in [Forgotten::InTheWalk, Forgotten::AtTheConnection] {
        let wrong = light_on_film(&room, 3, |scene, path| forgetful_sum(scene, path, forgotten));
        let z = worst_z(&right, &wrong);
        assert!(z > 6.0, "{forgotten:?}: only |z| = {z}");
    }
}
