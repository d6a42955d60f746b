//! The picture of error against time.

use plotters::coord::Shift;
use plotters::prelude::*;

use super::Summary;

/// Colours that people with any colour vision tell apart: Okabe and Ito's.
const COLORS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
    RGBColor(0, 0, 0),
];

/// Draws mean errors over mean CPU seconds, both logarithmic, with the span from the 10 % to the
/// 90 % quantile, one line a setting; the answer is the text of an SVG.
///
/// # Errors
///
/// When there is nothing to draw.
pub fn draw(title: &str, lines: &[Summary]) -> anyhow::Result<String> {
    let mut svg = String::new();
    draw_on(&SVGBackend::with_string(&mut svg, (960, 600)).into_drawing_area(), title, lines)?;
    Ok(svg)
}

fn draw_on(
    area: &DrawingArea<SVGBackend<'_>, Shift>,
    title: &str,
    lines: &[Summary],
) -> anyhow::Result<()> {
    area.fill(&WHITE)?;
    let times = range(lines.iter().map(|line| line.cpu_seconds))?;
    let errors = range(lines.iter().flat_map(|line| [line.quantiles.low, line.quantiles.high]))?;
    let mut chart = ChartBuilder::on(area)
        .caption(title, ("sans-serif", 22))
        .margin(16)
        .x_label_area_size(48)
        .y_label_area_size(80)
        .build_cartesian_2d(times.log_scale(), errors.log_scale())?;
    chart
        .configure_mesh()
        .x_desc("CPU seconds, seeding included")
        .y_desc("relMSE: mean, and from the 10 % to the 90 % quantile")
        .y_label_formatter(&|error| format!("{error:.0e}"))
        .label_style(("sans-serif", 15))
        .draw()?;
    let mut names: Vec<&str> = Vec::new();
    for line in lines {
        if !names.contains(&line.setting.as_str()) {
            names.push(&line.setting);
        }
    }
    for (index, name) in names.iter().enumerate() {
        let color = COLORS[index % COLORS.len()];
        let own = || lines.iter().filter(|line| line.setting == *name);
        let means = own().map(|line| (line.cpu_seconds, line.relative_mse));
        chart
            .draw_series(LineSeries::new(means, color.stroke_width(2)).point_size(4))?
            .label(*name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], color.stroke_width(2)));
        chart.draw_series(own().map(|line| {
            let (x, span) = (line.cpu_seconds, line.quantiles);
            PathElement::new([(x, span.low), (x, span.high)], color.stroke_width(1))
        }))?;
    }
    chart
        .configure_series_labels()
        .label_font(("sans-serif", 16))
        .background_style(WHITE.mix(0.8))
        .border_style(BLACK.mix(0.3))
        .draw()?;
    area.present()?;
    Ok(())
}

/// From a bit below the least to a bit above the largest value.
fn range(values: impl Iterator<Item = f64>) -> anyhow::Result<std::ops::Range<f64>> {
    let drawn = values.filter(|value| *value > 0.0 && value.is_finite());
    let (low, high) =
        drawn.fold((f64::INFINITY, 0.0_f64), |(low, high), v| (low.min(v), high.max(v)));
    anyhow::ensure!(low <= high, "there is no error to plot: is the reference the picture itself?");
    Ok(low / 1.3..high * 1.3)
}
