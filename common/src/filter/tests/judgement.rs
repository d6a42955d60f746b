//! What filters say of paths, and what a tally makes of it.

use proptest::prelude::*;

use super::*;
use crate::{ChainId, PathId, StrategyId};

fn header() -> PathHeader {
    PathHeader {
        id: PathId { chain: ChainId(3), epoch: 1, step: 1 << 40 },
        strategy: StrategyId(2),
        dwell: 7,
        weight: 32.0,
        acceptance: 0.1,
        film: [0.25, 0.75],
        luminance: 1.5,
        rgb: [1.0; 3],
    }
}

/// Conditions that hold for the path `LDTDE` at `(0..5, 0, 0)` under [`header`], and that do not.
#[test]
fn conditions_mean_what_they_say() {
    let path = path("LDTDE");
    let holding = "start in sphere(0, 0, 0, 0.5); end in box(3.5, -1, -1, 4.5, 1, 1); \
        any in sphere(2, 0, 0, 0.25); all in box(0.5, -1, -1, 3.5, 1, 1); \
        all not in sphere(0, 0, 0, 0.5); any through sphere(2.5, 0.4, 0, 0.41); \
        start through sphere(0.5, 0, 0, 0.1); end through box(3.2, -1, -1, 3.4, 1, 1); \
        all through box(0, 0, 0, 4, 0, 0); any on material glass; start on light lamp; \
        any on object table; any (in sphere(2, 0, 0, 0.5) and on material glass); \
        any (is diffuse and on material wall); any is refract; start is light; end is camera; \
        not any is reflect; film in rect(0.2, 0.7, 0.3, 0.8); edges == 4; depth == 4; \
        edges in 4..4; length == 4; length in 3.99..4.01; luminance == 1.5; acceptance == 0.1; \
        acceptance <= 0.1; dwell > 6; chain == 3; epoch != 0; step == 1099511627776; \
        specular == 1; diffuse == 2; glossy == 0; strategy == lens-subpath; \
        strategy in (lens, \"lens subpath\"); strategy != seed; true; lpe \"CDTDL\"; \
        edges < 4 or edges > 3; not (edges < 4 and chain == 3)";
    for text in holding.split(';') {
        assert!(wants(text, &header(), &path), "`{}` does not hold", text.trim());
        let negated = format!("not ({text})");
        assert!(!wants(&negated, &header(), &path), "`{negated}` holds");
    }
    let failing = "start in sphere(1, 0, 0, 0.5); end in sphere(0, 0, 0, 0.5); \
        all in sphere(2, 0, 0, 0.5); any in sphere(2.5, 0, 0, 0.4); \
        any (in sphere(1, 0, 0, 0.5) and on material glass); start on light glass; \
        any on object vase; end on material wall; any through sphere(2, 1, 0, 0.9); \
        film in rect(0.3, 0, 1, 1); edges in 5..9; strategy == lens; strategy == seed; false; \
        end through sphere(0.5, 0, 0, 0.1); all through sphere(0, 0, 0, 1.5)";
    for text in failing.split(';') {
        assert!(!wants(text, &header(), &path), "`{}` holds", text.trim());
    }
}

#[test]
fn two_vertices_are_not_one() {
    let path = path("LDTDE");
    let (near_the_wall, glass) = ("in sphere(1, 0, 0, 0.5)", "on material glass");
    assert!(wants(&format!("any {near_the_wall} and any {glass}"), &header(), &path), "any two");
    assert!(!wants(&format!("any ({near_the_wall} and {glass})"), &header(), &path), "the same");
}

#[test]
fn a_lamp_seen_directly_has_no_inner_vertices() {
    let path = path("LE");
    assert!(wants("all in sphere(9, 9, 9, 1)", &header(), &path), "there is none outside");
    assert!(!wants("any (not is light and not is camera)", &header(), &path), "there is none");
}

#[test]
fn selectors_combine_by_kind() {
    let selector = |kind, x, by_segment| Selector {
        kind,
        volume: Volume::Sphere { centre: DVec3::new(x, 0.0, 0.0), radius: 0.25 },
        by_segment,
    };
    let path = path("LDTDE");
    let wanted = |selectors: &[Selector]| {
        let filter = Filter::from_selectors(selectors);
        let text = filter.to_string();
        assert_eq!(Filter::parse(&text).as_ref(), Ok(&filter), "{text}");
        filter.compile(&scene()).expect("bounded").matches(&header(), &path)
    };
    use SelectorKind::{All, Any, End, Start};
    assert!(wanted(&[]), "no selector asks for nothing");
    assert!(wanted(&[selector(Start, 0.0, false), selector(Start, 9.0, false)]), "either start");
    assert!(!wanted(&[selector(Start, 0.0, false), selector(End, 0.0, false)]), "kinds are AND-ed");
    assert!(wanted(&[selector(Any, 9.0, false), selector(Any, 2.0, false)]), "either vertex");
    assert!(wanted(&[selector(All, 1.0, false), selector(All, 2.0, false)]), "both hold one");
    assert!(!wanted(&[selector(All, 1.0, false), selector(All, 9.0, false)]), "one is empty");
    assert!(!wanted(&[selector(Any, 2.5, false)]), "no vertex");
    assert!(wanted(&[selector(Any, 2.5, true)]), "but a segment");
}

fn coordinate() -> impl Strategy<Value = f64> {
    -2.0..2.0_f64
}

fn any_point() -> impl Strategy<Value = DVec3> {
    [coordinate(), coordinate(), coordinate()].prop_map(DVec3::from_array)
}

proptest! {
    #[test]
    fn segments_meet_what_their_points_lie_in(a in any_point(), b in any_point(), c in any_point(), d in any_point(), radius in 0.01..1.5_f64) {
        for volume in [
            Volume::Sphere { centre: c, radius },
            Volume::Box { min: c.min(d), max: c.max(d) },
        ] {
            let meets = volume.meets_segment(a, b);
            let samples = 512;
            let at = |i: i32| a.lerp(b, f64::from(i) / f64::from(samples));
            let inside = (0..=samples).any(|i| volume.contains(at(i)));
            prop_assert!(meets || !inside, "{volume:?} holds a point of {a} {b}");
            // No sample lies inside, but one must then lie close.
            let grain = (b - a).length() / f64::from(samples);
            let larger = match volume {
                Volume::Sphere { centre, radius } => Volume::Sphere { centre, radius: radius + grain },
                Volume::Box { min, max } => Volume::Box { min: min - grain, max: max + grain },
            };
            prop_assert!(!meets || (0..=samples).any(|i| larger.contains(at(i))), "{volume:?} far from {a} {b}");
            prop_assert_eq!(volume.meets_segment(b, a), meets, "the same backwards");
        }
    }
}

#[test]
fn a_segment_without_length_is_a_point() {
    let volume = Volume::Sphere { centre: DVec3::ZERO, radius: 1.0 };
    assert!(volume.meets_segment(DVec3::X, DVec3::X), "on the surface");
    assert!(!volume.meets_segment(2.0 * DVec3::X, 2.0 * DVec3::X), "outside");
    let volume = Volume::Box { min: -DVec3::ONE, max: DVec3::ONE };
    assert!(volume.meets_segment(DVec3::ONE, DVec3::ONE), "at a corner");
    assert!(!volume.meets_segment(2.0 * DVec3::X, 2.0 * DVec3::X), "outside");
}

#[test]
fn a_tally_counts_conditions_and_energy() {
    let filter = compiled("edges == 2 and chain < 2");
    let mut tally = FilterTally::new(9, &filter);
    assert!(tally.counts().energy_error.is_nan(), "nothing is known yet");
    // Chains 0 to 3 spend 3, 1, 2 and 0 of 4 steps on paths of two edges.
    for (chain, steps) in [(0, 3.0), (1, 1.0), (2, 2.0), (3, 0.0)] {
        for (letters, weight) in [("LDE", steps), ("LE", 4.0 - steps)] {
            let id = PathId { chain: ChainId(chain), epoch: 0, step: 0 };
            let header = PathHeader { id, weight: weight as f32, ..PathHeader::default() };
            let conditions = filter.conditions(&header, &path(letters));
            tally.count(&header, conditions, filter.wants(conditions));
        }
    }
    let counts = tally.counts();
    assert_eq!((counts.revision, counts.seen, counts.matched), (9, 8, 2), "paths");
    assert_eq!(counts.conditions, [4, 4], "paths that meet each condition alone");
    assert_eq!((counts.seen_steps, counts.matched_steps), (16.0, 4.0), "steps");
    assert_eq!(counts.energy_share, 0.25, "share");
    // Residuals 2, 0, -1, -1: sqrt(6 * 4 / 3) / 16.
    assert!((counts.energy_error - 8.0_f64.sqrt() / 16.0).abs() < 1e-15, "{}", counts.energy_error);
}

/// Chains whose paths match with chances of their own, which vary as the estimator must see: the
/// claimed error is the spread of the shares that many runs find.
#[test]
fn the_claimed_error_is_the_real_one() {
    let filter = compiled("edges == 2");
    let mut random = 0x9E37_79B9_7F4A_7C15_u64;
    let mut uniform = || {
        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        (random >> 11) as f64 / (1_u64 << 53) as f64
    };
    let (runs, chains) = (2000, 32);
    let (mut shares, mut errors) = (Vec::new(), 0.0);
    for _ in 0..runs {
        let mut tally = FilterTally::new(0, &filter);
        for chain in 0..chains {
            // A chain that dwells: all its ten steps share one chance.
            let chance = uniform();
            for _ in 0..10 {
                let matches = uniform() < chance;
                let id = PathId { chain: ChainId(chain), epoch: 0, step: 0 };
                let header = PathHeader { id, weight: 1.0, ..PathHeader::default() };
                tally.count(&header, u64::from(matches), matches);
            }
        }
        let counts = tally.counts();
        shares.push(counts.energy_share);
        errors += counts.energy_error * counts.energy_error / f64::from(runs);
    }
    let mean = shares.iter().sum::<f64>() / shares.len() as f64;
    let variance: f64 =
        shares.iter().map(|s| (s - mean) * (s - mean)).sum::<f64>() / (shares.len() - 1) as f64;
    // Relative error of a variance from n runs is sqrt(2 / n) = 3 %; six of them.
    assert!((errors / variance - 1.0).abs() < 0.2, "claimed {errors}, found {variance}");
    // Steps taken as independent would claim (p q / n) = 7.8e-4, a third of what is found.
    assert!(variance > 1.5 * 0.25 / 320.0, "the test tells the two apart: {variance}");
}

/// What the tally says about paths of which none matches `text`.
fn nearest(text: &str, letters: &[&str]) -> Option<NearestMiss> {
    let filter = compiled(text);
    let mut tally = FilterTally::new(1, &filter);
    for (step, letters) in (0..).zip(letters) {
        let header = PathHeader { id: PathId { step, ..header().id }, ..header() };
        let path = path(letters);
        let conditions = filter.conditions(&header, &path);
        let wanted = filter.wants(conditions);
        tally.count(&header, conditions, wanted);
        if !wanted {
            tally.count_miss(&filter, &header, &path, conditions);
        }
    }
    tally.counts().nearest
}

#[test]
fn the_nearest_miss_is_named_with_what_it_lacks() {
    let of = |text: &str, letters: &[&str]| {
        let miss = nearest(text, letters).expect("nothing matches");
        let failed: Vec<_> = miss.failed.iter().map(|f| (f.condition, f.by)).collect();
        (miss.path.step, miss.asked, failed)
    };
    // Vertices lie at x = 0, 1, 2, ...
    let (step, asked, failed) =
        of("any in sphere(9, 0, 0, 0.5) and edges >= 2 and chain == 3", &["LDE", "LDDDE", "LDDE"]);
    assert_eq!((step, asked), (1, 3), "the longest comes nearest to x = 9");
    assert_eq!(failed, [(0, Some(4.5))], "from x = 4 to the sphere");
    let (_, _, failed) = of("chain == 3 and lpe \"CS+L\"", &["LDE"]);
    assert_eq!(failed, [(1, None)], "an expression has no measure");
    let (step, asked, failed) = of("edges >= 9 or edges == 5", &["LDE", "LDDE"]);
    assert_eq!((step, asked, failed), (1, 1, vec![(1, Some(2.0))]), "the nearest alternative");
    let (_, _, failed) = of("any through box(2.25, 1, -1, 2.75, 2, 1)", &["LDDE"]);
    assert!(failed[0].1.is_some_and(|by| (by - 1.0).abs() < 1e-6), "below the box: {failed:?}");
    let (_, asked, failed) = of("not edges == 2 and film in rect(0.5, 0, 1, 1)", &["LDE"]);
    assert_eq!((asked, failed), (2, vec![(0, None), (1, Some(0.25))]), "a negation, and the film");
    let (_, asked, failed) = of("false and edges > 1", &["LDE"]);
    assert_eq!((asked, failed), (2, Vec::new()), "no path can");
    assert_eq!(nearest("edges == 2", &["LDDE", "LDE"]), None, "one matches");
}

proptest! {
    /// Whatever the filter, a path that is not wanted lacks something, and one condition less than it
    /// is asked for at least; what is named are conditions that it indeed does not meet as wanted.
    #[test]
    fn a_miss_names_conditions_that_fail(x in -1.0..9.0_f64, radius in 0.1..2.0_f64, edges in 0..6_u32) {
        let text = format!(
            "(any in sphere({x}, 0, 0, {radius}) or start is camera) and edges == {edges} and luminance < 1"
        );
        let filter = compiled(&text);
        let path = path("LDTDE");
        let conditions = filter.conditions(&header(), &path);
        let miss = filter.miss(&header(), &path, conditions);
        prop_assert!(!filter.wants(conditions), "the luminance is 1.5");
        prop_assert!(!miss.failed.is_empty() && miss.failed.len() <= miss.asked as usize);
        for Shortfall { condition, by } in miss.failed {
            prop_assert_eq!(conditions >> condition & 1, 0, "it holds");
            prop_assert!(by.is_none_or(|by| by >= 0.0 && by.is_finite()), "{:?}", by);
        }
    }
}
