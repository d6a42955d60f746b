//! What was shown can be made again, and the explorer tells exactly what it does.

use common::{ChainId, PathBatch, PathId, RatioFactors, Seed, VertexRecord};

use super::*;
use crate::chain::{Ensemble, EnsembleSettings, Gone, Round};
use crate::film::Film;
use crate::scene::Tracer;
use crate::scene::fixtures::specular_room;

const WINDOW: u64 = 32;

fn scene() -> Arc<Scene> {
    Arc::new(specular_room().build())
}

/// Chains that were watched for `rounds` rounds, with what was shown of them.
fn watched(scene: &Scene, rounds: usize, limit: usize) -> (Archive, Vec<PathBatch>, Ensemble) {
    let settings = EnsembleSettings {
        seed: 3,
        chains: 9,
        threads: 2,
        bootstrap_samples: 1 << 13,
        ..EnsembleSettings::default()
    };
    let mut ensemble = Ensemble::new(scene, &settings, |_| ());
    let archive = Archive::new(limit);
    let mut shown = Vec::new();
    for round in 0..rounds {
        if round == rounds / 2 {
            // Another mixture, and another epoch, in the middle of it.
            let mut weights = ensemble.mixture().weights();
            weights[0] *= 3.0;
            ensemble.begin_epoch(1, &weights);
        }
        shown.extend(ensemble.advance(scene, 200, Some(WINDOW)));
        let checkpoints = ensemble.take_checkpoints();
        archive.put(Round::new(ensemble.shared_kernel(), 1.0, WINDOW, checkpoints));
    }
    (archive, shown, ensemble)
}

fn records(path: &crate::path::Path) -> Vec<VertexRecord> {
    let mut out = Vec::new();
    path.record_into(&mut out);
    out
}

#[test]
fn every_path_that_was_shown_is_made_again_exactly() {
    let scene = scene();
    let (archive, shown, _) = watched(&scene, 8, usize::MAX);
    let tracer = Tracer::new(&scene);
    let mut film = Film::new(scene.camera().width, scene.camera().height);
    let (mut count, mut moved) = (0, 0);
    for batch in &shown {
        let mut reader = batch.reader();
        while let Some(view) = reader.next() {
            let (path, _) = archive.path(&tracer, view.header.id, &mut film).expect("it was shown");
            assert_eq!(records(&path), view.vertices, "{}", view.header.id);
            assert_eq!(path.film().as_vec2().to_array(), view.header.film, "{}", view.header.id);
            assert!(path.is_fresh(&tracer), "all that is cached follows from the vertices");
            count += 1;
            moved += usize::from(!view.keyframe);
        }
    }
    assert!(count > 500 && moved > 200, "{count} paths, {moved} of them by steps");
}

#[test]
fn the_longest_stays_are_kept_although_they_were_not_shown() {
    let scene = scene();
    let (archive, shown, mut ensemble) = watched(&scene, 1, usize::MAX);
    ensemble.monitor();
    drop(ensemble.advance(&scene, 2000, None));
    let tracer = Tracer::new(&scene);
    let mut film = Film::new(scene.camera().width, scene.camera().height);
    let longest = ensemble.diagnostics().and_then(|d| d.longest).expect("stays");
    let ids: Vec<PathId> = longest.headers().map(|header| header.id).collect();
    let is_shown = |id| shown.iter().any(|batch| batch.headers().any(|header| header.id == id));
    assert!(ids.len() > 4 && ids.iter().any(|&id| !is_shown(id)), "not all were shown: {ids:?}");
    let before = ids.iter().filter(|&&id| archive.path(&tracer, id, &mut film).is_ok()).count();
    assert!(before < ids.len(), "some cannot be found");
    for _ in 0..3 {
        archive.keep(ensemble.longest_stays());
    }
    let mut reader = longest.reader();
    while let Some(view) = reader.next() {
        let (path, _) = archive.path(&tracer, view.header.id, &mut film).expect("it is kept");
        assert_eq!(records(&path), view.vertices, "{}", view.header.id);
        assert_eq!(path.film().as_vec2().to_array(), view.header.film, "{}", view.header.id);
    }
}

#[test]
fn what_was_not_shown_is_told_to_be_gone() {
    let scene = scene();
    let tracer = Tracer::new(&scene);
    let mut film = Film::new(scene.camera().width, scene.camera().height);
    let mut path = |archive: &Archive, id| archive.path(&tracer, id, &mut film).map(drop);
    let id = |chain, epoch, step| PathId { chain: ChainId(chain), epoch, step };
    assert_eq!(path(&Archive::new(1), id(0, 0, 0)), Err(Gone::Empty), "before anything is shown");
    let (archive, shown, _) = watched(&scene, 8, 20_000);
    let first = shown[0].headers().next().expect("a path").id;
    assert!(matches!(path(&archive, first), Err(Gone::TooOld(..))), "pushed out");
    for unknown in [id(99, 1, 5), id(0, 1, u64::MAX), id(0, 7, 1), id(0, 1, 150)] {
        let found = path(&archive, unknown);
        assert!(matches!(found, Err(Gone::Unknown(_))), "{unknown}: {found:?}");
    }
    let newest = archive.newest_path().expect("something was shown");
    assert_eq!(path(&archive, newest), Ok(()), "the newest is kept");
}

fn walker(scene: &Arc<Scene>, archive: &Archive) -> Walker {
    let mut walker = Walker::new(Arc::clone(scene), 7);
    walker.seed(Seed::Newest, archive).expect("something was shown");
    walker
}

#[test]
fn fans_and_looking_leave_the_walk_alone() {
    let scene = scene();
    let (archive, ..) = watched(&scene, 2, usize::MAX);
    let mut quiet = walker(&scene, &archive);
    let mut looked_at = walker(&scene, &archive);
    let mut fanned = 0;
    for round in 0..250_u8 {
        let (step, after) = quiet.step();
        let (same, also) = looked_at.step();
        let numbered = FocusStep { number: step.number, ..FocusStep::clone(&same) };
        assert_eq!(*step, numbered, "the same step, fans or not");
        assert_eq!(after.vertices, also.vertices);
        looked_at.open_fan();
        let before = looked_at.current().map(|path| path.vertices.clone());
        for i in 0..3 {
            let strategy = StrategyId((round / 2 + i) % looked_at.strategies().len() as u8);
            let news = looked_at.probe(strategy);
            let told = news.step.expect("a proposal");
            assert!(told.fan && told.strategy == strategy, "{told:?}");
            fanned += u32::from(told.outcome == FocusOutcome::Accepted);
        }
        assert_eq!(looked_at.current().map(|path| path.vertices.clone()), before, "it stands");
    }
    assert!(fanned > 20, "{fanned} proposals would have been accepted");
    assert_eq!(quiet.film(), looked_at.film(), "nor do fans touch the film");
    let film = quiet.film().expect("it has moved");
    // Looking for paths that were not there leaves no trace either.
    let ids = (1..=WINDOW).map(|step| PathId { chain: ChainId(0), epoch: 1, step });
    let tracer = Tracer::new(&scene);
    let mut scratch = Film::new(scene.camera().width, scene.camera().height);
    let missing: Vec<PathId> =
        ids.filter(|&id| archive.path(&tracer, id, &mut scratch).is_err()).collect();
    assert!(!missing.is_empty(), "some steps are not accepted");
    for id in missing {
        assert!(quiet.seed(Seed::Path(id), &archive).is_err(), "{id} was not there");
    }
    assert_eq!(quiet.film().as_ref(), Some(&film), "and it goes on where it was");
    let total: f64 = film.pixels.iter().map(|p| p.luminance()).sum();
    let mean = total / film.pixels.len() as f64;
    assert!((mean - 1.0).abs() < 1e-9, "every step is on the film: {mean}");
}

#[test]
fn steps_tell_what_happened_and_nothing_is_missing() {
    let scene = scene();
    let (archive, ..) = watched(&scene, 2, usize::MAX);
    let mut walker = walker(&scene, &archive);
    let mut path = walker.current().expect("a path").as_ref().clone();
    let (mut outcomes, mut blocked, mut meant) = ([0; 3], 0, 0);
    for i in 0..3000 {
        let (step, after) = walker.step();
        assert_eq!(step.id.step, i + 1, "every step is told");
        path = path.after(&step).expect("each follows the one before");
        assert_eq!(path, *after, "step {i}");
        assert!(step.kept_light + step.kept_eye <= step.length, "{step:?}");
        let told = step.factors;
        let ratio = told.backward / told.forward * told.mixture_current / told.mixture_proposed
            * told.target_proposed
            / told.target_current;
        match step.outcome {
            FocusOutcome::Failed(_) => {
                outcomes[0] += 1;
                assert_eq!((step.acceptance, told), (0.0, RatioFactors::default()), "{step:?}");
                blocked += usize::from(step.blocker.is_some());
                meant += usize::from(step.kept_light < step.length);
            }
            outcome => {
                outcomes[1 + usize::from(outcome == FocusOutcome::Accepted)] += 1;
                let expected = if told.mixture_proposed > 0.0 { ratio.min(1.0) } else { 0.0 };
                assert!(
                    (step.acceptance - expected).abs() < 1e-12,
                    "{step:?} instead of {expected}"
                );
                assert!(step.luminance > 0.0 && step.rays > 0, "{step:?}");
            }
        }
    }
    assert!(outcomes.iter().all(|&count| count > 100), "every outcome is seen: {outcomes:?}");
    assert!(blocked > 20, "{blocked} blocked connections are marked");
    assert!(meant * 10 > outcomes[0] * 9, "{meant} of {} failures say their range", outcomes[0]);
    let progress = walker.progress();
    assert_eq!((progress.steps, progress.accepted), (3000, outcomes[2] as u64));
}

#[test]
fn only_allowed_strategies_act_and_old_paths_are_found_again() {
    let scene = scene();
    let (archive, ..) = watched(&scene, 2, usize::MAX);
    let mut walker = walker(&scene, &archive);
    let lens = walker.strategies().iter().position(|name| name == "lens").expect("the lens");
    let lens = StrategyId(lens as u8);
    let epoch = walker.current().expect("a path").header.id.epoch;
    walker.allow(StrategySet(0).with(lens, true)).expect("one is left");
    assert!(walker.allow(StrategySet(1 << 40)).is_err(), "none is left");
    assert_eq!(
        walker.allowed(),
        StrategySet(0).with(lens, true),
        "a refused order changes nothing"
    );
    let mut seen = Vec::new();
    for _ in 0..500 {
        let (step, after) = walker.step();
        // No strategy may act on a path that this one can do nothing with.
        assert!([lens.0, u8::MAX].contains(&step.strategy.0), "{step:?}");
        if step.outcome == FocusOutcome::Accepted {
            assert_eq!(after.header.id.epoch, epoch + 1, "the change has opened an epoch");
            seen.push(after);
        }
    }
    assert!(seen.len() > 20, "{} steps were accepted", seen.len());
    for path in [&seen[0], &seen[seen.len() / 2]] {
        let news = walker.seed(Seed::Path(path.header.id), &archive).expect("it is remembered");
        assert_eq!(news.after.vertices, path.vertices, "the same path");
        assert_eq!(walker.origin(), Some(path.header.id));
    }
    let never = PathId { chain: ChainId::EXPLORER, epoch: 1, step: 1 << 50 };
    assert!(walker.seed(Seed::Path(never), &archive).is_err(), "it was never there");
}
