use super::*;
use crate::chain::EnsembleSettings;
use crate::integrator::pssmlt::PrimarySettings;
use crate::render::Integrator;
use crate::replicate::Dial;
use crate::scene::fixtures::diffuse_room;

fn setting(name: &str, integrator: Integrator) -> Setting {
    let render = RenderSettings {
        integrator,
        budget: Budget::PerPixel(1),
        ensemble: EnsembleSettings { seed: 5, chains: 8, threads: 1, ..Default::default() },
        primary: PrimarySettings::default(),
        dial: Dial::default(),
    };
    Setting { name: name.to_owned(), render }
}

/// Points of path tracing of a small room, and what became of them.
fn traded(reference_factor: f64) -> (Vec<Point>, Vec<Summary>) {
    let scene = diffuse_room().film(6, 6).max_edges(3).build();
    let path = setting("path", Integrator::Path);
    let good = RenderSettings { budget: Budget::PerPixel(4096), ..path.render };
    let mut reference = Reference::render(&scene, &good, Floor::Relative, |_| ());
    assert!(reference.error.is_some_and(|e| e > 0.0 && e < 1e-3), "{:?}", reference.error);
    reference.image.scale(reference_factor);
    let settings = [path, setting("bdpt", Integrator::Bdpt)];
    let budgets = [Budget::PerPixel(4), Budget::PerPixel(64)];
    let plan = Plan {
        settings: &settings,
        budgets: &budgets,
        runs: 12,
        reference: &reference.image,
        floor: Floor::Relative,
    };
    let done = |_: f64, _: &Run| Ok::<(), ()>(());
    let points = plan.measure(&scene, done).expect("nothing stops it");
    let lines = summarize(&plan, &points);
    (points, lines)
}

#[test]
fn error_falls_with_samples_and_holds_no_bias() {
    let (points, lines) = traded(1.0);
    assert_eq!(points.len(), 4);
    let of = |name: &str, budget| {
        lines.iter().find(|l| l.setting == name && l.budget == budget).expect("a line")
    };
    for name in ["path", "bdpt"] {
        let (few, many) = (of(name, 0), of(name, 1));
        let ratio = few.relative_mse / many.relative_mse;
        assert!((8.0..32.0).contains(&ratio), "{name}: 16 times the samples, {ratio} the error");
        assert!(few.bias_share.abs() < 0.3, "{name}: {}", few.bias_share);
        assert!(few.quantiles.low <= few.quantiles.median, "{name}: sorted");
        assert!(few.trimmed <= few.relative_mse, "{name}: the worst pixel is left out");
        assert_eq!((few.runs, few.per_pixel), (12, 4.0));
    }
    assert!(of("path", 0).efficiency.is_none(), "it is what others are compared with");
    assert!(of("bdpt", 0).efficiency.is_some_and(|e| e.ratio > 0.0 && e.factor > 1.0));
    let seeds: std::collections::BTreeSet<u64> =
        points.iter().filter(|p| p.setting == 0).flat_map(|p| &p.runs).map(|r| r.seed).collect();
    assert_eq!(seeds.len(), 24, "no run of a setting repeats another");
}

#[test]
fn a_systematic_error_is_found() {
    let (_, lines) = traded(1.2);
    let line = lines.iter().find(|l| l.setting == "bdpt" && l.budget == 1).expect("a line");
    assert!(line.bias_share > 0.8, "{}", line.bias_share);
    assert!((line.mean_ratio - 1.0 / 1.2).abs() < 0.02, "{}", line.mean_ratio);
}

#[test]
fn quantiles_lie_between_values() {
    let q = Quantiles::of(vec![4.0, 0.0, 1.0, 3.0, 2.0]);
    assert!((q.low - 0.4).abs() < 1e-12 && (q.high - 3.6).abs() < 1e-12, "{q:?}");
    assert_eq!(q.median, 2.0);
    assert!(Quantiles::of(Vec::new()).median.is_nan(), "of nothing");
}

#[test]
fn the_slope_is_that_of_the_points() {
    let run = |cpu_seconds: f64, relative_mse: f64| Run {
        setting: String::new(),
        budget: 0,
        seed: 0,
        cpu_seconds,
        wall_seconds: 0.0,
        mutations: 0,
        relative_mse,
        trimmed: relative_mse,
        mean_ratio: 1.0,
    };
    let point = |budget, runs| Point {
        setting: 0,
        budget,
        runs,
        error_of_mean: 0.0,
        picture: Film::new(1, 1),
    };
    let points = [
        point(0, vec![run(1.0, 0.5), run(1.0, 0.5)]),
        point(1, vec![run(4.0, 0.125), run(4.0, 0.125)]),
    ];
    let found = slope(&points, 0).expect("two budgets");
    assert!((found + 1.0).abs() < 1e-12, "{found}");
    assert!(slope(&points[..1], 0).is_none() && slope(&points, 1).is_none());
}
