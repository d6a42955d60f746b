//! Panels show what they should, and clicks say what they should; without a window.

use std::time::{Duration, Instant};

use common::{ChainTotals, FailureCount, FilmTile, Statistics, StrategyStatistics};
use egui::accesskit::Role as WidgetRole;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use super::*;
use crate::camera::ViewCamera;
use crate::command::{
    CameraCommand, CloudCommand, ImageCommand, LayoutCommand, PathCommand, SceneCommand, Switch,
    ThemeName, VertexStep,
};
use crate::film::Film;
use crate::imaging::Reference;
use crate::selection::Selection;
use crate::settings::Settings;
use crate::status::{LinkState, Status};
use crate::store::Store;
use crate::synthetic::welcome;

/// Everything a panel may read, and what it said.
pub(super) struct Stage {
    pub(super) settings: Settings,
    pub(super) camera: ViewCamera,
    pub(super) status: Status,
    pub(super) store: Store,
    pub(super) film: Film,
    pub(super) reference: Option<Reference>,
    pub(super) selection: Option<Selection>,
    pub(super) recent: Vec<String>,
    pub(super) model: Option<crate::model::Model>,
    pub(super) playback: Option<crate::playback::Playback>,
    pub(super) panel: Box<dyn Panel>,
    pub(super) said: Vec<Command>,
}

impl Stage {
    pub(super) fn new(panel: impl Panel + 'static) -> Self {
        Self {
            settings: Settings::default(),
            camera: ViewCamera::default(),
            status: Status::new("127.0.0.1:50061".to_owned(), false),
            store: Store::new(64 << 20),
            film: Film::default(),
            reference: None,
            selection: None,
            recent: Vec::new(),
            model: None,
            playback: None,
            panel: Box::new(panel),
            said: Vec::new(),
        }
    }

    pub(super) fn harness(self) -> Harness<'static, Self> {
        Harness::builder().with_size(egui::vec2(520.0, 700.0)).build_ui_state(
            |ui, stage: &mut Self| {
                let world = World {
                    settings: &stage.settings,
                    camera: &stage.camera,
                    status: &stage.status,
                    store: &stage.store,
                    film: &stage.film,
                    reference: stage.reference.as_ref(),
                    selection: stage.selection.as_ref(),
                    moment: stage.status.steering.focus.moment(None),
                    scrub: None,
                    recent: &stage.recent,
                    playback: stage.playback.as_ref(),
                    counted: None,
                    model: stage.model.as_ref(),
                    now: Instant::now(),
                };
                stage.panel.ui(ui, &world, &mut stage.said);
            },
            self,
        )
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
pub(super) fn shows(harness: &Harness<'_, Stage>, text: &str) -> bool {
    harness.query_all_by_label_contains(text).next().is_some()
}

#[test]
fn statistics_show_rates_and_fates() {
    let mut stage = Stage::new(statistics::StatisticsPanel);
    stage.status.welcome(welcome());
    stage.status.statistics(statistics());
    let mut harness = stage.harness();
    harness.run();
    for text in [
        "1.23 M",
        "0.2500 ± 0.2 %",
        "bidirectional",
        "lens",
        "2.00 k",
        "75.0 %",
        "12.5 %",
        "74.0 %",
        "4.50 M",
    ] {
        assert!(shows(&harness, text), "`{text}` is missing");
    }
    harness.get_by_label("lens").hover();
    harness.run_steps(30);
    assert!(shows(&harness, "failed: off film"), "the reasons come with the pointer");
}

#[test]
fn empty_panels_say_what_will_come() {
    let mut harness = Stage::new(statistics::StatisticsPanel).harness();
    harness.run();
    assert!(shows(&harness, "No statistics yet"), "no counts");
    let mut harness = Stage::new(image::ImagePanel::default()).harness();
    harness.run();
    assert!(shows(&harness, "No image yet"), "no image");
    let mut harness = Stage::new(diagnostics::DiagnosticsPanel).harness();
    harness.run();
    assert!(shows(&harness, "No chains yet"), "no chains");
}

#[test]
fn the_image_panel_shows_the_film() {
    let mut stage = Stage::new(image::ImagePanel::default());
    let rgb = vec![0.5; 40 * 30 * 3];
    let tile = FilmTile { sequence: 1, width: 40, height: 30, first_row: 0, steps: 2400, rgb };
    assert!(stage.film.accept(&tile), "a whole image");
    let mut harness = stage.harness();
    harness.run();
    assert!(shows(&harness, "40 × 30, 2 mutations a pixel"), "size and effort");
    harness.get_by_label("2:1").click();
    harness.run();
    assert_eq!(harness.state().said, [Command::Image(ImageCommand::Zoom(2.0))], "zoom");
}

/// An image panel with a whole film, and perhaps a reference that is a tenth darker.
fn image_stage(compared: bool) -> Stage {
    let mut stage = Stage::new(image::ImagePanel::default());
    let rgb = vec![0.5; 40 * 30 * 3];
    let tile = FilmTile { sequence: 1, width: 40, height: 30, first_row: 0, steps: 2400, rgb };
    assert!(stage.film.accept(&tile), "a whole image");
    let pixels = vec![common::Rgb::grey(0.4); 40 * 30];
    let reference = Reference { name: "right.exr".to_owned(), width: 40, height: 30, pixels };
    stage.reference = compared.then_some(reference);
    stage
}

#[test]
fn a_pixel_or_a_rectangle_of_the_image_becomes_the_filter() {
    let mut stage = image_stage(false);
    stage.settings.filter.text = "edges >= 3".to_owned();
    let mut harness = stage.harness();
    harness.run();
    let film = harness.get_by_role_and_label(WidgetRole::Image, "Film").rect();
    let pixel = film.height() / 30.0;
    let corner = egui::pos2(film.center().x - 20.0 * pixel, film.top());
    let at = |x: f32, y: f32| corner + pixel * egui::vec2(x, y);
    let filter = |harness: &mut Harness<'_, Stage>| {
        let said = harness.state_mut().said.drain(..).collect::<Vec<_>>();
        match said.as_slice() {
            [Command::Filter(crate::command::FilterCommand::Set(text))] => text.clone(),
            other => panic!("{other:?} instead of a filter"),
        }
    };
    harness.hover_at(at(10.5, 5.5));
    harness.run();
    assert!(shows(&harness, "10, 5") && shows(&harness, "0.5000"), "the values of a pixel");
    harness.drag_at(at(10.5, 5.5));
    harness.run();
    harness.drop_at(at(10.5, 5.5));
    harness.run();
    let text = filter(&mut harness);
    let [u0, v0, u1, v1] = crate::region::region_of(&text).expect("a rectangle");
    assert!((u0 - 0.25).abs() < 1e-9 && (v0 - 5.0 / 30.0).abs() < 1e-9, "{text}");
    assert!((u1 - 11.0 / 40.0).abs() < 1e-6 && (v1 - 6.0 / 30.0).abs() < 1e-6, "{text}");
    assert!(text.contains("edges >= 3"), "the other condition stays: {text}");
    harness.drag_at(at(4.5, 3.5));
    harness.run_steps(1);
    harness.hover_at(at(20.5, 10.5));
    harness.run_steps(2);
    harness.drop_at(at(20.5, 10.5));
    harness.run();
    let text = filter(&mut harness);
    let [u0, v0, u1, v1] = crate::region::region_of(&text).expect("a rectangle");
    let expected = [4.0 / 40.0, 3.0 / 30.0, 21.0 / 40.0, 11.0 / 30.0];
    for (value, expected) in [u0, v0, u1, v1].into_iter().zip(expected) {
        assert!((value - expected).abs() < 1e-6, "{text}");
    }
    harness.state_mut().settings.filter.text = text;
    harness.run();
    assert!(shows(&harness, "Paths to 17 × 8 pixels"), "what is wanted");
    harness.get_by_label("All").click();
    harness.run();
    assert_eq!(filter(&mut harness), "edges >= 3", "and back");
}

#[test]
fn the_image_is_compared_with_a_reference() {
    let mut harness = image_stage(false).harness();
    harness.run();
    harness.get_by_label("Difference").click();
    harness.run();
    assert_eq!(harness.state().said, [], "there is nothing to compare with");
    let mut harness = image_stage(true).harness();
    harness.run();
    // 0.1^2 / (0.4^2 + 0.01)
    for text in ["right.exr", "relMSE", "0.059", "125.00 %"] {
        assert!(shows(&harness, text), "`{text}` is missing");
    }
    for label in ["Difference", "False colour", "Forget"] {
        harness.get_by_label(label).click();
        harness.run();
    }
    let expected = [
        ImageCommand::Show(crate::command::Layer::Difference),
        ImageCommand::Tone(crate::command::ToneCurve::False),
        ImageCommand::Forget,
    ];
    assert_eq!(harness.state().said, expected.map(Command::Image), "three clicks");
    harness.state_mut().settings.image.layer = crate::command::Layer::Error;
    harness.run();
    assert!(shows(&harness, "relative squared error"), "its colours are explained");
}

#[test]
fn chains_that_disagree_raise_an_alarm_that_leads_there() {
    let mut stage = Stage::new(diagnostics::DiagnosticsPanel);
    stage.film = image_stage(false).film;
    stage.status.welcome(welcome());
    stage.status.statistics(diagnosed());
    let mut harness = stage.harness();
    harness.run();
    for text in [
        "Chains disagree in 0.3 % of the image, R-hat to 1.37",
        "25.0 k",
        "steps for an independent one",
        "bidirectional",
        "off film",
        "DDD",
    ] {
        assert!(shows(&harness, text), "`{text}` is missing");
    }
    for label in ["Show where", "Paths to the worst", "Acceptance", "Explore", "Show"] {
        harness.get_by_label(label).click();
        harness.run();
    }
    let said = harness.state().said.as_slice();
    let [show, Command::Filter(crate::command::FilterCommand::Set(text)), map, explore, show_path] =
        said
    else {
        panic!("five clicks, not {said:?}");
    };
    let layer = |layer| Command::Image(ImageCommand::Show(layer));
    assert_eq!(*show, layer(crate::command::Layer::Disagreement), "the map");
    assert_eq!(*map, layer(crate::command::Layer::Acceptance), "another one");
    let [u0, v0, ..] = crate::region::region_of(text).expect("a rectangle");
    assert!((u0 - 2.0 / 40.0).abs() < 1e-9 && (v0 - 4.0 / 30.0).abs() < 1e-9, "{text}");
    assert_eq!(explore.to_string(), "explorer seed 0.0.0", "the path where a chain stayed");
    assert_eq!(show_path.to_string(), "path stay 0", "and the same path in the view");
}

#[test]
fn maps_wait_for_the_daemon() {
    let mut stage = image_stage(false);
    stage.settings.image.layer = crate::command::Layer::Dwell;
    stage.status.statistics(diagnosed());
    let mut harness = stage.harness();
    harness.run();
    assert!(shows(&harness, "mean stay at a path"), "its colours are explained");
    let film = harness.get_by_role_and_label(WidgetRole::Image, "Film").rect();
    harness.hover_at(film.center());
    harness.run();
    assert!(shows(&harness, "dwell") && shows(&harness, "8"), "the value under the cursor");
    let mut harness = image_stage(false).harness();
    harness.run();
    harness.get_by_label("Dwell").click();
    harness.run();
    assert_eq!(harness.state().said, [], "there is no map yet");
}

#[test]
fn the_status_bar_tells_every_state() {
    let state = |link: LinkState| {
        let mut stage = Stage::new(status::StatusBar);
        stage.status.link = link;
        let mut harness = stage.harness();
        harness.run_steps(3);
        harness
    };
    assert!(shows(&state(LinkState::Connecting), "Connecting to 127.0.0.1:50061"), "connecting");
    assert!(shows(&state(LinkState::Connected), "Connected to 127.0.0.1:50061"), "connected");
    let retry_at = Instant::now() + Duration::from_secs(90);
    let mut lost = state(LinkState::Disconnected { reason: "gone".to_owned(), retry_at });
    assert!(shows(&lost, "Disconnected: gone; retrying in"), "lost, with its reason");
    lost.get_by_label("Now").click();
    lost.run_steps(3);
    assert_eq!(lost.state().said, [Command::Reconnect], "connect now");
}

#[test]
fn the_cloud_panel_speaks_in_commands() {
    let mut harness = Stage::new(cloud::Cloud).harness();
    harness.run();
    harness.get_by_label("Freeze").click();
    harness.run();
    harness.get_by_label("Clear").click();
    harness.run();
    harness.get_by_label("Tint start and end").click();
    harness.run();
    let expected =
        [CloudCommand::Freeze(Switch::On), CloudCommand::Clear, CloudCommand::Ends(Switch::Off)];
    assert_eq!(harness.state().said, expected.map(Command::Cloud), "three clicks");
}

#[test]
fn a_slider_at_rest_says_nothing() {
    let mut stage = Stage::new(cloud::Cloud);
    // Values that no slider can show exactly.
    stage.settings.cloud.width = 0.123_456;
    stage.settings.cloud.fade = 1e9;
    let mut harness = stage.harness();
    harness.run();
    assert_eq!(harness.state().said, [], "rounding is not the user's hand");
}

#[test]
fn long_numbers_do_not_widen_their_panel() {
    let mut stage = Stage::new(cloud::Cloud);
    stage.settings.cloud.fade = 1e7;
    stage.settings.cloud.shown = 10_000_000;
    stage.settings.cloud.budget_mib = 65_536;
    let harness = Harness::builder().with_size(egui::vec2(800.0, 700.0)).build_ui_state(
        |ui, (stage, widths): &mut (Stage, Vec<f32>)| {
            let said = &mut stage.said;
            let world = World {
                settings: &stage.settings,
                camera: &stage.camera,
                status: &stage.status,
                store: &stage.store,
                film: &stage.film,
                reference: stage.reference.as_ref(),
                selection: stage.selection.as_ref(),
                moment: stage.status.steering.focus.moment(None),
                scrub: None,
                recent: &stage.recent,
                playback: None,
                counted: None,
                model: stage.model.as_ref(),
                now: Instant::now(),
            };
            let panel = &mut stage.panel;
            let left = egui::Panel::left("left").default_size(LEFT_WIDTH);
            let shown = left.show(ui, |ui| panel.ui(ui, &world, said));
            widths.push(shown.response.rect.width());
        },
        (stage, Vec::new()),
    );
    let mut harness = harness;
    harness.run_steps(5);
    let widths = &harness.state().1;
    assert!(widths.windows(2).all(|w| w[0] == w[1]), "the panel creeps: {widths:?}");
}

#[test]
fn the_scene_panel_speaks_in_commands() {
    let mut harness = Stage::new(scene::Scene).harness();
    harness.run();
    for label in ["Grid", "Frame all", "Fly"] {
        harness.get_by_label(label).click();
        harness.run();
    }
    let expected = [
        Command::Scene(SceneCommand::Grid(Switch::Off)),
        Command::Camera(CameraCommand::Frame),
        Command::Camera(CameraCommand::Fly(Switch::Toggle)),
    ];
    assert_eq!(harness.state().said, expected, "three clicks");
}

#[test]
fn menus_hold_every_key() {
    let mut stage = Stage::new(menu::Menu::default());
    stage.status.welcome(welcome());
    let mut harness = stage.harness();
    harness.run();
    assert!(shows(&harness, "a room"), "the scene's name");
    harness.get_by_label("Light").click();
    harness.run();
    harness.get_by_label("Paths").click();
    harness.run();
    harness.get_by_label_contains("Forget every path").click();
    harness.run();
    let expected = [
        Command::Layout(LayoutCommand::Theme(ThemeName::Toggle)),
        Command::Cloud(CloudCommand::Clear),
    ];
    assert_eq!(harness.state().said, expected, "a button and a menu");
}

#[test]
fn the_connection_menu_leads_back_and_passes_on() {
    let mut stage = Stage::new(menu::Menu::default());
    stage.recent = vec!["render-box:50061".to_owned(), "127.0.0.1:50061".to_owned()];
    let mut harness = stage.harness();
    harness.run();
    for label in ["render-box:50061", "Copy link to this view", "Screenshot"] {
        harness.get_by_label("Connection").click();
        harness.run();
        harness.get_by_label(label).click();
        harness.run();
    }
    let expected = ["connect render-box:50061", "share", "screenshot lvis.png"];
    let said: Vec<String> = harness.state().said.iter().map(ToString::to_string).collect();
    assert_eq!(said, expected, "three entries");
}

#[test]
fn the_first_steps_go_when_they_are_known() {
    let mut stage = Stage::new(hint::Hint);
    let mut harness = stage.harness();
    harness.run();
    assert!(!shows(&harness, "Got it"), "not for those who know");
    stage = Stage::new(hint::Hint);
    stage.settings.layout.hint = true;
    stage.model = crate::model::Model::new(crate::synthetic::mesh());
    let mut harness = stage.harness();
    harness.run();
    harness.get_by_label("Got it").click();
    harness.run();
    let expected = [Command::Layout(LayoutCommand::Hint(Switch::Off))];
    assert_eq!(harness.state().said, expected, "one click");
}

#[test]
fn the_help_sheet_lists_every_key() {
    let mut stage = Stage::new(help::Help);
    stage.settings.layout.help = true;
    let mut harness = stage.harness();
    harness.run_steps(4);
    for binding in crate::keys::bindings(crate::keys::KeyPreset::Today) {
        assert!(shows(&harness, binding.help), "`{}` is missing", binding.help);
    }
}

#[test]
fn the_path_panel_tells_all_of_a_path() {
    let mut stage = Stage::new(path::PathPanel);
    stage.status.welcome(welcome());
    let batch = crate::synthetic::batch(&[&[[1.0, 2.0, 3.0], [4.0, 6.0, 3.0]]]);
    let mut reader = batch.reader();
    let view = reader.next().expect("a path");
    let (header, vertices) = (view.header, view.vertices.to_vec());
    stage.selection = Some(Selection { header, vertices, vertex: Some(1), place: (2, 3) });
    let mut harness = stage.harness();
    harness.run();
    for text in ["D D D", "2 of 3 here", "bidirectional", "1.0000e0", "4.000 6.000 3.000"] {
        assert!(shows(&harness, text), "`{text}` is missing");
    }
    assert!(shows(&harness, "5.000000"), "the edge before the vertex");
    harness.get_by_label("D x2").click();
    harness.run();
    harness.get_by_label("Deselect").click();
    harness.run();
    let expected = [PathCommand::Vertex(VertexStep::To(2)), PathCommand::Deselect];
    assert_eq!(harness.state().said, expected.map(Command::Path), "two clicks");
}

#[test]
fn a_click_in_the_viewport_picks() {
    let mut harness = Stage::new(viewport::Viewport).harness();
    harness.run_steps(2);
    harness.get_by_role_and_label(WidgetRole::Canvas, "Viewport").click();
    harness.run_steps(2);
    let said = &harness.state().said;
    let picked = |c: &Command| matches!(c, Command::Path(PathCommand::Pick(aim)) if aim.at[0].abs() < 1e-3 && aim.reach > 0.0);
    assert!(said.iter().any(picked), "the middle was clicked: {said:?}");
}

#[test]
fn dragging_in_the_viewport_turns_the_camera() {
    let mut harness = Stage::new(viewport::Viewport).harness();
    harness.run_steps(2);
    let view = harness.get_by_role_and_label(WidgetRole::Canvas, "Viewport").rect();
    harness.drag_at(view.center());
    harness.run_steps(1);
    harness.hover_at(view.center() + egui::vec2(70.0, 0.0));
    harness.run_steps(2);
    harness.drop_at(view.center() + egui::vec2(70.0, 0.0));
    harness.run_steps(1);
    let turned: f32 = harness
        .state()
        .said
        .iter()
        .map(|command| match command {
            Command::Camera(CameraCommand::Orbit(right, up)) => {
                assert_eq!(*up, 0.0, "a level drag");
                *right
            }
            other => panic!("{other} instead of a turn"),
        })
        .sum();
    assert!((turned - 20.0).abs() < 0.5, "a tenth of the height turns 20 degrees, not {turned}");
}

#[test]
fn a_file_of_paths_is_stepped_and_told() {
    let mut stage = Stage::new(playback::PlaybackPanel);
    let mut file = crate::playback::Playback::new(crate::dump::tests::stage());
    file.apply(crate::command::PlayCommand::To(2));
    stage.playback = Some(file);
    let mut harness = stage.harness();
    harness.run();
    for text in
        ["Step 3 of 4", "rejected, a = 0.2500", "E - e - c", "lens: 0.0 % of 2 accepted, 1 failed"]
    {
        assert!(shows(&harness, text), "`{text}` is missing");
    }
    for button in ["Accepted", "Back", "Play"] {
        harness.get_by_label(button).click();
        harness.run();
    }
    let said: Vec<String> = harness.state().said.iter().map(ToString::to_string).collect();
    assert_eq!(said, ["play accepted", "play by -1", "play toggle"], "three clicks");
}
