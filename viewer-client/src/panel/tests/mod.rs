//! Panels show what they should, and clicks say what they should; without a window. A file a kind of
//! panel.

mod bars;
mod chains;
mod cloud;
mod image;
mod paths;
mod sections;
mod settings;
mod viewport;

use std::time::Instant;

use common::{ChainTotals, FailureCount, FilterScene, Statistics, StrategyStatistics};
use egui::{Event, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use super::*;
use crate::camera::ViewCamera;
use crate::imaging::Reference;
use crate::imaging::film::Film;
use crate::settings::Settings;
use crate::source::filter_scene;
use crate::source::selection::Selection;
use crate::source::status::Status;
use crate::source::store::Store;

/// Everything a panel may read, and the commands it returned.
pub(super) struct Fixture {
    pub(super) settings: Settings,
    pub(super) camera: ViewCamera,
    pub(super) status: Status,
    pub(super) store: Store,
    pub(super) film: Film,
    pub(super) reference: Option<Reference>,
    pub(super) flip: Option<crate::imaging::FlipMap>,
    pub(super) selection: Option<Selection>,
    pub(super) recent: Vec<String>,
    pub(super) model: Option<crate::source::model::Model>,
    pub(super) playback: Option<crate::source::playback::Playback>,
    filter_scene: FilterScene,
    panel: Option<Box<dyn Panel>>,
    pub(super) said: Vec<Command>,
}

impl Fixture {
    pub(super) fn new(panel: impl Panel + 'static) -> Self {
        Self {
            settings: Settings::default(),
            camera: ViewCamera::default(),
            status: Status::new("127.0.0.1:50061".to_owned(), false),
            store: Store::new(64 << 20),
            film: Film::default(),
            reference: None,
            flip: None,
            selection: None,
            recent: Vec::new(),
            model: None,
            playback: None,
            filter_scene: filter_scene(None, None),
            panel: Some(Box::new(panel)),
            said: Vec::new(),
        }
    }

    pub(super) fn harness(self) -> Harness<'static, Self> {
        Harness::builder()
            .with_size(vec2(520.0, 700.0))
            .build_ui_state(|ui, fixture: &mut Self| fixture.show(ui), self)
    }

    /// All that the panel may read.
    pub(super) fn world(&self) -> World<'_> {
        World {
            waiting: 0,
            settings: &self.settings,
            camera: &self.camera,
            status: &self.status,
            store: &self.store,
            film: &self.film,
            reference: self.reference.as_ref(),
            flip: self.flip.as_ref(),
            selection: self.selection.as_ref(),
            moment: self.status.steering.focus.moment(),
            scrub: self.status.steering.focus.scrub,
            recent: &self.recent,
            has_home: true,
            playback: self.playback.as_ref(),
            counted: None,
            model: self.model.as_ref(),
            filter_scene: &self.filter_scene,
            now: Instant::now(),
        }
    }

    /// Shows the panel, and keeps what it says.
    pub(super) fn show(&mut self, ui: &mut Ui) {
        let Some(mut panel) = self.panel.take() else { return };
        let mut said = std::mem::take(&mut self.said);
        let mesh = self.model.as_ref().map(|model| &model.mesh);
        self.filter_scene = filter_scene(self.status.welcome.as_ref(), mesh);
        let world = self.world();
        hover::begin(ui.ctx());
        panel.ui(ui, &world, &mut said);
        hover::end(ui.ctx());
        self.said = said;
        self.panel = Some(panel);
    }
}

fn statistics() -> Statistics {
    let failures = vec![FailureCount { reason: 1, count: 500 }];
    let strategy = |accepted| StrategyStatistics {
        proposed: 2000,
        generated: 1500,
        accepted,
        acceptance_sum: 900.0,
        failures: failures.clone(),
    };
    Statistics {
        mutations_per_second: 1_234_567.0,
        strategies: vec![strategy(250), strategy(1480)],
        normalization: 0.25,
        normalization_error: 0.0005,
        totals: ChainTotals { rays: 4_500_000, ..ChainTotals::default() },
        ..Statistics::default()
    }
}

/// Statistics with diagnostics: chains agree but for one tile.
fn diagnosed() -> Statistics {
    let tiles = 20 * 15;
    let mut r_hat = vec![1.002; tiles];
    r_hat[41] = 1.37;
    let diagnostics = common::Diagnostics {
        grid: common::TileGrid { side: 2, columns: 20, rows: 15 },
        maps: common::TileMaps {
            acceptance: vec![0.3; tiles],
            dwell: vec![8.0; tiles],
            visits: vec![1.0; tiles],
            spread: vec![0.01; tiles],
            r_hat,
        },
        autocorrelation: vec![0.95, 0.7, 0.3, 0.1, 0.0],
        correlation_steps: 40.0,
        effective_samples: 25_000.0,
        r_hat: 1.01,
        longest: Some(crate::synthetic::batch(&[&[[1.0, 2.0, 3.0], [4.0, 6.0, 3.0]]])),
    };
    Statistics {
        elapsed_seconds: 10.0,
        diagnostics: Some(std::sync::Arc::new(diagnostics)),
        ..statistics()
    }
}

/// True when some label contains `text`.
pub(super) fn shows(harness: &Harness<'_, Fixture>, text: &str) -> bool {
    harness.query_all_by_label_contains(text).next().is_some()
}

#[test]
fn empty_panels_say_what_will_come() {
    let mut harness = Fixture::new(statistics::StatisticsPanel).harness();
    harness.run();
    assert!(shows(&harness, "No statistics yet"), "no counts");
    let mut harness = Fixture::new(super::image::ImagePanel::default()).harness();
    harness.run();
    assert!(shows(&harness, "No image yet"), "no image");
    let mut harness = Fixture::new(diagnostics::DiagnosticsPanel).harness();
    harness.run();
    assert!(shows(&harness, "No chains yet"), "no chains");
}
