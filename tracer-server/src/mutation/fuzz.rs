//! Random scenes, random steps: every cached value is that of the vertices, every move can be undone,
//! and nothing panics.

use common::Rgb;
use glam::{DMat3, DVec3};

use super::{KINDS, Mixture, MixtureBasis, StrategyOptions};
use crate::bsdf::{BsdfDescription, ColorInput, Given, MODELS, Named, NumberInput, Value};
use crate::chain::{Ensemble, EnsembleSettings};
use crate::math::{Rng, Stream, uniform_sphere};
use crate::path::{BidirectionalSampler, CameraSample, Draft, Path};
use crate::scene::fixtures::{Fixture, lambert};
use crate::scene::{LightKind, Scene, Tracer};

const SCENES: u64 = 60;
/// Proposals of each strategy on each scene.
const TRIES: usize = 150;
/// Bidirectional samples among which a scene shows a path, or has none.
const SAMPLES: usize = 2000;

/// A number from `low` to `high`, whose logarithm is uniform.
fn between(rng: &mut Rng, low: f64, high: f64) -> f64 {
    low * (high / low).powf(rng.uniform())
}

fn color(rng: &mut Rng) -> Rgb {
    Rgb::from(rng.array::<3>())
}

fn point(rng: &mut Rng) -> [f64; 3] {
    rng.array::<3>().map(|u| 1.8 * u - 0.9)
}

/// Whatever a model asks for, three times out of four.
struct Anything<'r> {
    rng: &'r mut Rng,
}

impl Anything<'_> {
    fn given<T>(&mut self, value: impl FnOnce(&mut Rng) -> T) -> Option<T> {
        (self.rng.below(4) > 0).then(|| value(self.rng))
    }
}

impl Given for Anything<'_> {
    type Error = String;

    fn color(&mut self, _: &'static str) -> Result<Option<Rgb>, String> {
        Ok(self.given(color))
    }

    fn color_input(&mut self, _: &'static str) -> Result<Option<ColorInput>, String> {
        Ok(self.given(|rng| color(rng).into()))
    }

    fn number(&mut self, _: &'static str) -> Result<Option<f64>, String> {
        Ok(self.given(|rng| between(rng, 1e-4, 3.0)))
    }

    fn number_input(&mut self, _: &'static str) -> Result<Option<NumberInput>, String> {
        Ok(self.given(|rng| between(rng, 1e-4, 1.0).into()))
    }

    fn number_or_name(&mut self, name: &'static str) -> Result<Option<Named>, String> {
        Ok(self.number(name)?.map(Named::Number))
    }

    fn word(&mut self, _: &'static str) -> Result<Option<String>, String> {
        Ok(None)
    }

    fn flag(&mut self, _: &'static str) -> Result<bool, String> {
        Ok(self.rng.below(2) == 0)
    }

    fn error(&self, name: &'static str, message: &str) -> String {
        format!("{name}: {message}")
    }

    fn warn(&mut self, _: &str) {}
}

/// Any model with any parameters.
fn material(rng: &mut Rng) -> BsdfDescription {
    loop {
        let kind = MODELS[rng.below(MODELS.len())];
        // Not everything goes together.
        if let Some(Ok(mut model)) = BsdfDescription::read(kind.name, &mut Anything { rng }) {
            model.parameters(&mut |_, value| {
                if let Value::Number(number, range) = value {
                    *number = number.clamp(range.low, range.high);
                }
            });
            return model;
        }
    }
}

fn kind(rng: &mut Rng) -> LightKind {
    let (position, intensity) = (DVec3::from(point(rng)), color(rng) * between(rng, 0.1, 10.0));
    let direction = uniform_sphere(rng.uniform(), rng.uniform());
    match rng.below(4) {
        0 => LightKind::Point { position, intensity },
        1 => LightKind::Spot { position, direction, intensity, cutoff: 40.0, beam: 30.0 },
        2 => LightKind::Directional { direction, irradiance: intensity },
        _ => LightKind::Environment {
            radiance: intensity,
            image: None,
            rotation: DMat3::from_rotation_y(rng.uniform()),
        },
    }
}

/// A room, of which walls may be missing, with anything in it, in any size.
fn any_scene(rng: &mut Rng) -> Scene {
    let walls = std::array::from_fn(|_| material(rng));
    let target = DVec3::from(point(rng));
    let mut fixture = Fixture::new(DVec3::from(point(rng)), target, between(rng, 1.0, 120.0))
        .room(&walls, Rgb::BLACK);
    let shown = 1 + rng.below(6);
    fixture.description.meshes.truncate(shown);
    for _ in 0..rng.below(4) {
        let emission = if rng.below(3) == 0 { color(rng) } else { Rgb::BLACK };
        fixture = fixture.sphere(material(rng), emission, point(rng), between(rng, 1e-3, 0.6));
    }
    for _ in 0..rng.below(4) {
        let [u, v] = [point(rng), point(rng)];
        fixture = fixture.quad(material(rng), Rgb::BLACK, point(rng), u, v);
    }
    for _ in 0..rng.below(3) {
        fixture = fixture.light(kind(rng));
    }
    let skies = fixture
        .description
        .lights
        .iter()
        .filter(|l| matches!(l.kind, LightKind::Environment { .. }));
    if skies.count() > 1 {
        fixture.description.lights.pop();
    }
    let side = between(rng, 1e-5, 1.0);
    let lamp = fixture.quad(
        lambert(0.2, 0.3, 0.4),
        Rgb::grey(between(rng, 0.1, 100.0)),
        point(rng),
        [side, 0.0, 0.0],
        [0.0, 0.0, side],
    );
    let mut fixture =
        lamp.film(1 + rng.below(40) as u32, 1 + rng.below(40) as u32).max_edges(1 + rng.below(12));
    if rng.below(3) == 0 {
        fixture = fixture.lens(between(rng, 1e-4, 0.2), between(rng, 0.1, 5.0));
    }
    fixture.scale(between(rng, 1e-6, 1e6));
    fixture.build()
}

/// Some path of the scene, in proportion to its light; `None` where none was found.
fn any_path(scene: &Tracer<'_>, rng: &mut Rng) -> Option<Path> {
    let mut sampler = BidirectionalSampler::new(scene);
    let (mut chosen, mut sum) = (None, 0.0);
    let mut choice = Rng::new(5, Stream::Laboratory, 1);
    for _ in 0..SAMPLES {
        let aim = CameraSample::from_numbers(scene, rng);
        sampler.sample(scene, aim, rng, |path, weight| {
            sum += weight;
            if choice.uniform() * sum < weight {
                chosen = Some(path.clone());
            }
        });
    }
    chosen
}

#[test]
fn random_steps_in_random_scenes_are_sound() {
    let (mut lit, mut moved) = (0, [0_u32; KINDS.len()]);
    for number in 0..SCENES {
        let mut rng = Rng::new(3, Stream::Laboratory, number);
        let world = any_scene(&mut rng);
        let scene = Tracer::new(&world);
        let Some(start) = any_path(&scene, &mut rng) else { continue };
        lit += 1;
        let basis = MixtureBasis::of(&world, &[]);
        let (mut draft, mut x, mut y) = (Draft::default(), start, Path::default());
        for (kind, moved) in KINDS.iter().zip(&mut moved) {
            let strategy = (kind.build)(&basis, StrategyOptions::default().tuning(0));
            for _ in 0..TRIES {
                if !strategy.applicable(&x) {
                    break;
                }
                let Ok(seen) = strategy.inspect(&scene, &x, &mut rng, &mut draft, &mut y) else {
                    continue;
                };
                let what = format!("scene {number}, {}: {} to {}", kind.name, x.class(), y.class());
                assert_eq!(seen.flaw, None, "{what}");
                let product = seen.forth * seen.back;
                let undone = seen.forth == 0.0 || (product - 1.0).abs() < 1e-6;
                assert!(undone, "{what}: {seen:?}");
                if seen.forth > 0.0 && seen.applies_back {
                    *moved += 1;
                    std::mem::swap(&mut x, &mut y);
                }
            }
        }
    }
    assert!(lit > SCENES / 2, "only {lit} scenes have light");
    assert!(moved.iter().all(|&n| n > 100), "every strategy has moved: {moved:?}");
}

/// The chains of a random scene make a picture of numbers, on which every step is.
#[test]
fn random_scenes_make_pictures() {
    for number in 0..SCENES {
        let scene = any_scene(&mut Rng::new(4, Stream::Laboratory, number));
        let settings = EnsembleSettings {
            seed: number,
            chains: 16,
            threads: 1,
            strategies: StrategyOptions::default(),
            bootstrap_samples: 1 << 11,
        };
        let mut ensemble = Ensemble::new(&scene, &settings, |_| ());
        ensemble.advance(&scene, 300, None);
        let image = ensemble.image(&scene);
        assert!(image.pixels().iter().all(|p| p.is_physical()), "scene {number}");
        let (steps, splats) = (ensemble.steps() as f64, ensemble.splats().total_luminance());
        assert!((splats - steps).abs() <= 1e-9 * steps, "scene {number}: {splats} of {steps}");
        let names = Mixture::new(&settings.strategies, &MixtureBasis::of(&scene, &[])).names();
        assert_eq!(ensemble.mixture().names(), names, "scene {number}: the strategies");
    }
}
