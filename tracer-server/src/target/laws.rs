//! Laws of targets, and targets for the laws of everything that runs on them.

use std::sync::Arc;

use super::{Base, Equalised, Selective, Target};
use crate::math::{Rng, Stream};
use crate::path::{BidirectionalSampler, CameraSample, Path};
use crate::scene::fixtures::{every_light, specular_room};
use crate::scene::{Scene, Tracer};

/// Tiles along each side of a coarse image.
const TILES: usize = 6;

/// Calls `visit` with every path of 2000 bidirectional samples and its weight.
fn census(scene: &Scene, mut visit: impl FnMut(&Path, f64)) {
    let scene = Tracer::new(scene);
    let mut sampler = BidirectionalSampler::new(&scene);
    let mut rng = Rng::new(77, Stream::Laboratory, 0);
    for _ in 0..2000 {
        let aim = CameraSample::from_numbers(&scene, &mut rng);
        sampler.sample(&scene, aim, &mut rng, &mut visit);
    }
}

/// A dial at which half of the paths have less of their light than they leave to the base sampler.
pub(crate) fn middling(scene: &Scene, base: Base) -> f64 {
    let mut sums = Vec::new();
    census(scene, |path, _| sums.extend(Some(base.density_sum(path)).filter(|sum| *sum > 0.0)));
    sums.sort_by(f64::total_cmp);
    sums.get(sums.len() / 2).map_or(1.0, |median| median.recip())
}

fn coarse(scene: &Scene) -> Equalised {
    let mut tiles = vec![0.0; TILES * TILES];
    census(scene, |path, weight| {
        let place = path.film() * TILES as f64;
        tiles[place.y as usize * TILES + place.x as usize] += weight;
    });
    Equalised::new(TILES, &tiles)
}

/// Targets other than the whole, each of which changes how often paths are visited by a lot.
pub(crate) fn targets(scene: &Scene) -> Vec<Target> {
    let selective = |base| Target::Selective(Selective { base, tau: middling(scene, base) });
    let equalised = || Target::Equalised(Arc::new(coarse(scene)));
    vec![selective(Base::Path), equalised(), selective(Base::Bidirectional).times(equalised())]
}

/// What base sampler and chains get of a path is all of its light, and no base sample is brighter
/// than the dial allows.
#[test]
fn selective_shares_make_a_whole() {
    for (name, fixture) in every_light().into_iter().chain([("specular", specular_room())]) {
        let scene = fixture.build();
        for base in Base::ALL {
            let middle = middling(&scene, base);
            for tau in [0.0, 1e-300, 0.01 * middle, middle, 100.0 * middle, 1e300, f64::INFINITY] {
                let selective = Selective { base, tau };
                let mut seen = 0;
                census(&scene, |path, _| {
                    let sum = base.density_sum(path);
                    let (g, rest) = (
                        selective.chains_share(path),
                        selective.base_share(sum, path.edge_count()),
                    );
                    assert!((g + rest - 1.0).abs() < 4e-16, "{name}, {tau}: {g} + {rest}");
                    let found = sum > 0.0;
                    let bound = 0.5 * tau * (1.0 + 1e-12);
                    let is_direct = path.edge_count() == 1;
                    assert!(
                        !found || is_direct || !(rest / sum > bound),
                        "{name}, {tau}: {}",
                        rest / sum
                    );
                    assert!(tau > 0.0 || g == 1.0, "{name}: all is the chains'");
                    assert!(tau.is_finite() || g == f64::from(u8::from(!found)), "{name}: {g}");
                    assert!(found || g == 1.0, "{name}, {tau}: the base cannot find it");
                    seen += 1;
                });
                assert!(seen > 100, "{name}: only {seen} paths");
            }
        }
    }
}

/// What is wanted of a path is all of it but for what a selective target leaves to its base sampler.
#[test]
fn targets_say_what_is_wanted() {
    let scene = specular_room().build();
    let parts = targets(&scene);
    let [Target::Selective(selective), equalised, product] = &parts[..] else {
        panic!("three targets")
    };
    let Target::Product(both) = product else { panic!("a product") };
    let (mut low, mut high) = (f64::INFINITY, 0.0_f64);
    census(&scene, |path, _| {
        let wanted = |target: &Target| {
            let importance = target.importance(path);
            importance.rho * importance.share
        };
        assert!((wanted(equalised) - 1.0).abs() < 1e-14, "whatever is seen");
        let g = selective.chains_share(path);
        assert!((wanted(&parts[0]) - g).abs() < 1e-14, "the share of the chains");
        let factors = both.each_ref().map(|part| part.importance(path));
        let importance = product.importance(path);
        assert_eq!(importance.rho, factors[0].rho * factors[1].rho, "a product");
        let rho = equalised.importance(path).rho;
        (low, high) = (low.min(rho), high.max(rho));
    });
    assert!(high > 1.5 * low, "the coarse image has contrast: {low} to {high}");
}
