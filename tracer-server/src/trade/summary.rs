//! What the runs of a point have in common.

use serde::Serialize;
use tests::Accumulator;

use super::{Plan, Point, Run};

/// Where a tenth, half and nine tenths of values lie below.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Quantiles {
    /// A tenth are below.
    pub low: f64,
    /// Half are below.
    pub median: f64,
    /// Nine tenths are below.
    pub high: f64,
}

impl Quantiles {
    /// By linear interpolation between the sorted values; NaN without values.
    pub fn of(mut values: Vec<f64>) -> Self {
        values.sort_by(f64::total_cmp);
        let at = |share: f64| {
            let Some(last) = values.len().checked_sub(1) else { return f64::NAN };
            let place = share * last as f64;
            let below = place.floor() as usize;
            let above = (below + 1).min(last);
            let rest = place - below as f64;
            values[below] * (1.0 - rest) + values[above] * rest
        };
        Self { low: at(0.1), median: at(0.5), high: at(0.9) }
    }
}

/// How many times as efficient as another setting with the same budget.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Efficiency {
    /// Ratio of the geometric means of `1 / (error x CPU seconds)`.
    pub ratio: f64,
    /// Factor that spans the interval of two standard errors about it, both ways.
    pub factor: f64,
}

/// One line of the table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// Name of the setting.
    pub setting: String,
    /// Number of its budget in the plan.
    pub budget: usize,
    /// Runs.
    pub runs: usize,
    /// Mean of the seconds of all cores together.
    pub cpu_seconds: f64,
    /// Mean of the mutations, or samples, for each pixel.
    pub per_pixel: f64,
    /// Mean of the relative mean squared errors.
    pub relative_mse: f64,
    /// Their quantiles.
    pub quantiles: Quantiles,
    /// Mean of the errors without the worst pixel in a thousand.
    pub trimmed: f64,
    /// Mean of error times CPU seconds.
    pub cost: f64,
    /// The same of the trimmed errors.
    pub trimmed_cost: f64,
    /// Squared systematic error over the squared error of a run: within noise of zero where a
    /// setting is without bias, and then it can be negative. NaN for a single run.
    pub bias_share: f64,
    /// Mean ratio of all pictures to the reference.
    pub mean_ratio: f64,
    /// Compared with the plan's first setting.
    pub efficiency: Option<Efficiency>,
}

/// One line a point.
pub fn summarize(plan: &Plan<'_>, points: &[Point]) -> Vec<Summary> {
    let first = |budget| points.iter().find(|p| p.setting == 0 && p.budget == budget);
    let summary = |point: &Point| {
        let base = first(point.budget).filter(|_| point.setting != 0);
        Summary {
            efficiency: base.and_then(|base| efficiency(&point.runs, &base.runs)),
            ..plain(plan, point)
        }
    };
    points.iter().map(summary).collect()
}

fn plain(plan: &Plan<'_>, point: &Point) -> Summary {
    let runs = &point.runs;
    let count = runs.len() as f64;
    let mean = |value: &dyn Fn(&Run) -> f64| runs.iter().map(value).sum::<f64>() / count;
    let relative_mse = mean(&|run| run.relative_mse);
    // With E the mean error of a run and E' the error of their mean, E = bias^2 + variance and
    // E' = bias^2 + variance / n.
    let bias = (count * point.error_of_mean - relative_mse) / (count - 1.0);
    Summary {
        setting: plan.settings[point.setting].name.clone(),
        budget: point.budget,
        runs: runs.len(),
        cpu_seconds: mean(&|run| run.cpu_seconds),
        per_pixel: mean(&|run| run.mutations as f64) / plan.reference.pixels().len() as f64,
        relative_mse,
        quantiles: Quantiles::of(runs.iter().map(|run| run.relative_mse).collect()),
        trimmed: mean(&|run| run.trimmed),
        cost: mean(&|run| run.relative_mse * run.cpu_seconds),
        trimmed_cost: mean(&|run| run.trimmed * run.cpu_seconds),
        bias_share: if runs.len() > 1 { bias / relative_mse } else { f64::NAN },
        mean_ratio: mean(&|run| run.mean_ratio),
        efficiency: None,
    }
}

/// Of `a` over `b`; none without two runs of each.
fn efficiency(a: &[Run], b: &[Run]) -> Option<Efficiency> {
    let logs = |runs: &[Run]| {
        let mut logs = Accumulator::default();
        for run in runs {
            logs.push((run.relative_mse * run.cpu_seconds).ln());
        }
        (runs.len() > 1).then_some(logs)
    };
    let (a, b) = (logs(a)?, logs(b)?);
    let error = a.standard_error().hypot(b.standard_error());
    Some(Efficiency { ratio: (b.mean() - a.mean()).exp(), factor: (2.0 * error).exp() })
}

/// Slope of log error over log CPU seconds through the points of one setting: -1 when it has no
/// bias. None with fewer than two budgets.
pub fn slope(points: &[Point], setting: usize) -> Option<f64> {
    let logs: Vec<(f64, f64)> = points
        .iter()
        .filter(|point| point.setting == setting)
        .flat_map(|point| &point.runs)
        .map(|run| (run.cpu_seconds.ln(), run.relative_mse.ln()))
        .collect();
    let count = logs.len() as f64;
    let (x, y) = logs.iter().fold((0.0, 0.0), |(x, y), (a, b)| (x + a / count, y + b / count));
    let (xx, xy) = logs
        .iter()
        .fold((0.0, 0.0), |(xx, xy), (a, b)| (xx + (a - x) * (a - x), xy + (a - x) * (b - y)));
    let budgets = points.iter().filter(|point| point.setting == setting).count();
    (budgets > 1 && xx > 0.0).then_some(xy / xx)
}
