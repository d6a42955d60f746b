//! A step of a chain allocates no memory: neither proposing nor splatting does.
//!
//! This is a program of its own, because it counts what the whole process allocates.

use std::alloc::System;

use common::{ChainId, Rgb};
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};
use tracer_server::bsdf::{
    BsdfDescription, ConductorDescription, DielectricDescription, Fresnel, PlasticDescription,
};
use tracer_server::chain::{Chain, Ensemble, EnsembleSettings};
use tracer_server::film::Film;
use tracer_server::mutation::{KINDS, StrategyOptions};
use tracer_server::scene::load::load;
use tracer_server::scene::{Scene, SceneDescription, Tracer};

#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// Steps of all chains of a scene and a mixture together before anything is counted.
const WARM_UP: u64 = 20_000;
/// Steps that are counted, likewise.
const STEPS: u64 = 120_000;
/// Chains that share the steps.
const CHAINS: u32 = 8;

fn small(name: &str) -> SceneDescription {
    let mut description = load(name).expect("a built-in scene").description;
    (description.width, description.height) = (32, 24);
    description
}

/// The Cornell box with every matt surface coated and every other one rough.
fn rough_cornell() -> SceneDescription {
    let mut description = small("cornell");
    let fresnel = Fresnel::Dielectric { eta: 1.5, tint: Rgb::WHITE };
    for material in &mut description.materials {
        material.bsdf = if let BsdfDescription::Lambert(matt) = &material.bsdf {
            let diffuse = matt.reflectance;
            PlasticDescription { diffuse, fresnel, roughness: 0.2, nonlinear: true }.into()
        } else if let BsdfDescription::Dielectric(glass) = &material.bsdf {
            DielectricDescription { roughness: 0.2.into(), ..*glass }.into()
        } else {
            let fresnel = Fresnel::Schlick(Rgb::grey(0.8));
            ConductorDescription { fresnel, roughness: 0.3.into() }.into()
        };
    }
    description
}

/// The mixture as it is used, and each strategy nearly alone.
fn mixtures() -> Vec<(&'static str, StrategyOptions)> {
    let mut mixtures = vec![("all", StrategyOptions::default())];
    for kind in KINDS {
        let mut alone = StrategyOptions::default();
        let list = [("independent".to_owned(), Some(0.05)), (kind.key(), Some(0.95))];
        alone.restrict(&list).expect("names from the list of strategies");
        mixtures.push((kind.name, alone));
    }
    mixtures
}

fn advance(
    chains: &mut [Chain],
    tracer: &Tracer<'_>,
    ensemble: &Ensemble,
    film: &mut Film,
    steps: u64,
) {
    for chain in chains {
        for _ in 0..steps / u64::from(CHAINS) {
            chain.step(tracer, ensemble.kernel(), film);
        }
        chain.flush(film);
    }
}

/// Allocations and reallocations in [`STEPS`] steps, and how many proposals were accepted.
fn count(scene: &Scene, strategies: &StrategyOptions) -> (usize, u64) {
    let settings = EnsembleSettings {
        seed: 3,
        chains: CHAINS,
        threads: 1,
        strategies: *strategies,
        bootstrap_samples: 1 << 13,
    };
    let ensemble = Ensemble::new(scene, &settings, |_| ());
    let mut chains: Vec<Chain> = ensemble
        .chains()
        .zip(0..)
        .map(|(c, id)| Chain::new(ChainId(id), 3, c.current().clone(), ensemble.kernel()))
        .collect();
    assert_eq!(chains.len(), CHAINS as usize, "the scene has light");
    // Looking at every step allocates nothing either.
    let size = [scene.camera().width, scene.camera().height];
    for chain in &mut chains {
        chain.watch_every_step(size);
    }
    let tracer = Tracer::new(scene);
    let mut film = Film::new(scene.camera().width, scene.camera().height);
    advance(&mut chains, &tracer, &ensemble, &mut film, WARM_UP);
    let region = Region::new(ALLOCATOR);
    advance(&mut chains, &tracer, &ensemble, &mut film, STEPS);
    let change = region.change();
    let splats = film.total_luminance() / (WARM_UP + STEPS) as f64;
    assert!((splats - 1.0).abs() < 1e-9, "every step must be on the film, not {splats} of them");
    let accepted = chains.iter().flat_map(|c| &c.statistics().strategies).map(|s| s.accepted).sum();
    (change.allocations + change.reallocations, accepted)
}

#[test]
fn a_step_allocates_nothing() {
    // The counter counts; without this, zero would prove nothing.
    let region = Region::new(ALLOCATOR);
    drop(std::hint::black_box(vec![1_u8]));
    assert_eq!(region.change().allocations, 1, "one allocation");
    let mut scenes: Vec<_> = ["cornell", "caustic", "terrace"].map(small).into();
    scenes.push(rough_cornell());
    for description in &scenes {
        let scene = Scene::new(description).expect("a sound scene");
        for (strategies, options) in mixtures() {
            let (allocations, accepted) = count(&scene, &options);
            let what = format!("{}, {strategies}", scene.name());
            assert!(accepted > 500, "{what}: hardly anything happened: {accepted} accepted");
            assert_eq!(allocations, 0, "{what}: allocations in {STEPS} steps");
        }
    }
}
