//! What each part of the window says, as text for the clipboard.

use common::Role;

use super::filter::found;
use crate::command::{CloudCommand, Command, PanelName, SceneCommand, Source, Switch};
use crate::imaging::Comparison;
use crate::source::status::LinkState;
use crate::value::format;
use crate::world::World;

/// The text of a part of the window; blank where it has nothing to say.
pub fn text(world: &World<'_>, source: Source) -> String {
    match source {
        Source::Status => status(world),
        Source::Panel(PanelName::Cloud) => cloud(world),
        Source::Panel(PanelName::Scene) => scene(world),
        Source::Panel(PanelName::Filter) => filter(world),
        Source::Panel(PanelName::Image) => image(world),
        Source::Panel(PanelName::Path) => {
            world.selection.map_or_else(String::new, |selection| selection.text(&world.names()))
        }
        Source::Panel(PanelName::Explorer) => explorer(world),
        Source::Panel(PanelName::Playback) => world.playback.map_or_else(String::new, |playback| {
            let (step, steps) = playback.place();
            format!("step {step} of {steps}\n")
        }),
        Source::Panel(PanelName::Statistics) => statistics(world),
        Source::Panel(PanelName::Diagnostics) => diagnostics(world),
    }
}

/// Appends a line to a text.
macro_rules! line {
    ($text:ident, $($part:tt)*) => {{
        $text.push_str(&format!($($part)*));
        $text.push('\n');
    }};
}

/// The state of the session.
fn status(world: &World<'_>) -> String {
    let status = world.status;
    let mut text = String::new();
    line!(text, "daemon\t{}", status.address);
    match &status.link {
        LinkState::Connected => line!(text, "state\tconnected"),
        LinkState::Connecting => line!(text, "state\tconnecting"),
        LinkState::Disconnected { reason, .. } => line!(text, "state\tdisconnected: {reason}"),
    }
    if let Some(welcome) = &status.welcome {
        line!(text, "scene\t{}\t{}", welcome.scene_name, welcome.scene_hash);
        line!(text, "session\t{}\tdaemon {}", welcome.session, welcome.server_version);
        let role = if status.role() == Role::Driver { "driver" } else { "observer" };
        line!(text, "role\t{role}");
    }
    if let Some(latency) = status.latency {
        line!(text, "latency\t{:.2} ms", 1e3 * latency.as_secs_f64());
    }
    if let Some(statistics) = &status.statistics {
        line!(text, "mutations a second\t{:.0}", status.mutation_rate());
        line!(text, "paths dropped\t{}", statistics.paths_dropped);
        line!(text, "daemon's memory\t{}", format::bytes(statistics.memory_bytes));
    }
    line!(text, "viewer's memory for paths\t{}", format::bytes(world.store.byte_len() as u64));
    text
}

/// Commands, one a line, as a script has them.
fn script(commands: impl IntoIterator<Item = Command>) -> String {
    let mut text = String::new();
    for command in commands {
        line!(text, "{command}");
    }
    text
}

fn cloud(world: &World<'_>) -> String {
    use CloudCommand as C;
    let cloud = &world.settings.cloud;
    let commands = [
        C::Color(cloud.color),
        C::Scale(cloud.scale),
        C::Marks(cloud.marks),
        C::Width(cloud.width),
        C::Opacity(cloud.opacity),
        C::Hidden(cloud.hidden),
        C::Fade(cloud.fade),
        C::Shown(cloud.shown),
        C::Budget(cloud.budget_mib),
        C::Ends(Switch::to(cloud.ends)),
        C::Dots(cloud.dots),
        C::Cue(cloud.cue),
        C::Dim(cloud.dim),
    ];
    script(commands.map(Command::Cloud))
}

fn scene(world: &World<'_>) -> String {
    use SceneCommand as S;
    let scene = &world.settings.scene;
    let commands = [
        S::Shading(scene.shading),
        S::Opacity(scene.opacity),
        S::Cutaway(Switch::to(scene.cutaway)),
        S::Camera(Switch::to(scene.aids.camera)),
        S::Grid(Switch::to(scene.aids.grid)),
        S::Clip(scene.clip),
        S::Cut(scene.cut),
    ];
    script(commands.map(Command::Scene))
}

/// The whole filter, what it found, and what each condition lets through.
fn filter(world: &World<'_>) -> String {
    let mut text = String::new();
    line!(text, "{}", world.settings.filter.whole());
    let Some(counts) = world.filter_counts() else { return text };
    line!(text, "{}", found::text(world, counts));
    line!(text, "energy\t{}", found::energy(counts));
    let reply = world.status.filter.as_ref();
    let conditions = match (world.playback, world.store.filter()) {
        (Some(_), Some(filter)) => filter.condition_texts(),
        _ => reply.map(|reply| reply.conditions.as_slice()).unwrap_or_default(),
    };
    for (condition, count) in conditions.iter().zip(&counts.conditions) {
        line!(text, "{count}\t{condition}");
    }
    text
}

fn image(world: &World<'_>) -> String {
    let mut text = String::new();
    let [width, height] = world.film.size();
    line!(text, "pixels\t{width} × {height}");
    let effort = world.film.steps() as f64 / (width * height).max(1) as f64;
    line!(text, "mutations a pixel\t{effort:.1}");
    line!(text, "exposure\t{} EV", world.settings.image.exposure);
    let Some(reference) = world.reference else { return text };
    line!(text, "reference\t{}", reference.name);
    if let Some(comparison) = Comparison::of(world.film, reference) {
        line!(text, "relMSE\t{:.6e}", comparison.relative_mse);
        line!(text, "relMSE, best 99 %\t{:.6e}", comparison.trimmed);
        line!(text, "energy\t{:.3} %", 100.0 * comparison.mean_ratio);
    }
    if let Some(flip) = world.flip {
        line!(text, "FLIP\t{:.5}", flip.mean);
    }
    text
}

fn explorer(world: &World<'_>) -> String {
    let state = &world.status.steering.explorer;
    let mut text = String::new();
    if let Some(path) = state.current {
        line!(text, "path\t{path}");
    }
    line!(text, "steps\t{}\taccepted\t{}", state.steps, state.accepted);
    if let Some(moment) = world.moment {
        let step = &moment.step;
        let strategy = world.strategy_name(usize::from(step.strategy.0));
        line!(text, "step\t{}\t{strategy}\t{:?}", step.number, step.outcome);
        line!(text, "acceptance\t{:.6}", step.acceptance);
    }
    text
}

/// The table of strategies, and the totals.
fn statistics(world: &World<'_>) -> String {
    let mut text = String::new();
    let Some(statistics) = &world.status.statistics else { return text };
    line!(text, "mutations a second\t{:.0}", world.status.mutation_rate());
    let (b, error) = (statistics.normalization, statistics.normalization_error);
    line!(text, "b\t{b:.8}\t±\t{error:.2e}");
    line!(text, "strategy\tproposed\tgenerated\taccepted\tmean acceptance");
    for (index, strategy) in statistics.strategies.iter().enumerate() {
        let mean = strategy.acceptance_sum / strategy.proposed.max(1) as f64;
        let name = world.strategy_name(index);
        let (proposed, generated) = (strategy.proposed, strategy.generated);
        line!(text, "{name}\t{proposed}\t{generated}\t{}\t{mean:.5}", strategy.accepted);
        for failure in &strategy.failures {
            let reason = world.failure_reason(usize::from(failure.reason));
            line!(text, "\t{}\t{reason}", failure.count);
        }
    }
    let totals = statistics.totals;
    line!(
        text,
        "steps\t{}\trays\t{}\tshadow rays\t{}",
        totals.steps,
        totals.rays,
        totals.shadow_rays
    );
    line!(text, "not finite\t{}\tlongest stay\t{}", totals.not_finite, totals.longest_dwell);
    text
}

fn diagnostics(world: &World<'_>) -> String {
    let mut text = String::new();
    let Some(diagnostics) = world.diagnostics() else { return text };
    line!(text, "R-hat\t{:.5}", diagnostics.r_hat);
    let worst = diagnostics.maps.r_hat.iter().copied().fold(0.0_f32, f32::max);
    line!(text, "R-hat of the worst tile\t{worst:.4}");
    line!(text, "effective samples\t{:.0}", diagnostics.effective_samples);
    line!(text, "steps for one\t{:.1}", diagnostics.correlation_steps);
    for (power, correlation) in diagnostics.autocorrelation.iter().enumerate() {
        line!(text, "correlation of stretches of\t{}\t{correlation:.4}", 1_u64 << power.min(63));
    }
    text
}
