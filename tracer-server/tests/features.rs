//! What a scene does not contain is not modelled: without it, the picture has the same bits.

mod decoy;

use tracer_server::chain::{Ensemble, EnsembleSettings};
use tracer_server::film::Film;
use tracer_server::integrator::{BidirectionalTracer, PathTracer};
use tracer_server::mutation::{KINDS, StrategyOptions};
use tracer_server::scene::Scene;

/// Every strategy but the one that only mirrors and glass switch on.
fn strategies() -> StrategyOptions {
    let mut options = StrategyOptions::default();
    let common = KINDS.iter().filter(|kind| kind.key() != "multi-chain");
    let list: Vec<_> = common.map(|kind| (kind.key(), None)).collect();
    options.restrict(&list).expect("names from the list of strategies");
    options
}

fn pictures(scene: &Scene) -> [Film; 3] {
    let settings = EnsembleSettings {
        seed: 3,
        chains: 8,
        threads: 1,
        strategies: strategies(),
        bootstrap_samples: 1 << 13,
    };
    let mut ensemble = Ensemble::new(scene, &settings, |_| ());
    ensemble.advance(scene, 5000, None);
    let mut bidirectional = BidirectionalTracer::new(scene, 3);
    bidirectional.advance(scene, 4, 1);
    let mut path = PathTracer::new(scene, 3);
    path.advance(scene, 4, 1);
    [ensemble.image(scene), bidirectional.image(scene), path.image(scene)]
}

#[test]
fn what_is_hidden_changes_no_bit() {
    let plain = decoy::cornell(24, None).expect("a scene");
    let expected = pictures(&plain);
    assert!(expected.iter().all(|film| film.total_luminance() > 0.0), "the scene has light");
    for (name, has) in decoy::FEATURES {
        let general = decoy::cornell(24, Some(name)).expect("a scene");
        assert!(has(general.features()), "{name}: the hidden thing asks for it");
        assert!(!has(plain.features()), "{name}: the plain scene does without");
        assert!(pictures(&general) == expected, "{name}: another picture");
    }
}
