//! The viewer itself: owns what came, what the user chose, and what is on the graphics card.

mod arrival;
mod elsewhere;
mod filtering;
mod playing;
mod selecting;

use std::time::{Duration, Instant};

use common::{Appearance, FilterText, Gaze};
use egui_wgpu::RenderState;

use crate::app::desktop::{Connect, Desk};
use crate::camera::ViewCamera;
use crate::command::{
    CameraCommand, CloudCommand, Command, ImageCommand, LayoutCommand, PathCommand,
};
use crate::draw::gpu::{Quality, Renderer, Uploaded};
use crate::draw::pick::Aim;
use crate::habits::Habits;
use crate::imaging::view::Darkroom;
use crate::keys;
use crate::panel::{self, NOTICE_TIME, Panel, Slot};
use crate::settings::Settings;
use crate::source::Backlog;
use crate::source::connection::Link;
use crate::source::model::{Model, corners, drawing_aids};
use crate::source::playback::Playback;
use crate::source::selection::Selection;
use crate::source::status::{LinkState, Status};
use crate::source::store::{Drawn, PAGE_POINTS, Store};
use crate::value::Bounds;
use crate::value::history::History;
use crate::value::theme;
use crate::world::World;

/// Points of paths that go to the graphics card in one frame at most: 6 MiB.
const UPLOAD_POINTS: usize = 16 * PAGE_POINTS;
/// The others are told of a new point of view this often at most.
const APPEARANCE: Duration = Duration::from_millis(500);

/// Everything behind the window.
#[derive(Debug)]
pub struct Viewer {
    settings: Settings,
    camera: ViewCamera,
    status: Status,
    store: Store,
    darkroom: Darkroom,
    desk: Desk,
    model: Option<Model>,
    /// Hash of the scene that is shown.
    scene_hash: String,
    link: Option<Link>,
    waiting: Backlog,
    panels: Vec<(Slot, Box<dyn Panel>)>,
    stale: Stale,
    /// The graphics card holds paths of this viewer, not of one before it.
    uploaded_any: bool,
    started: Instant,
    closing: bool,
    /// Commands that wait for the scene, the image or the first paths.
    script: Vec<Command>,
    /// Orders given so far: the number of the last one.
    orders: u32,
    /// What the others were shown of this viewer last, and when.
    appearance: (Appearance, Instant),
    /// Filters set so far: the number of the last one.
    filters: u32,
    /// The filter that was asked for last, and when the user changed it since.
    asked_for: FilterText,
    filter_changed: Option<Instant>,
    /// The filter that the daemon last said it follows.
    filter_in_force: u32,
    /// The path that is looked at, and where the user pointed to select it.
    selection: Option<Selection>,
    pointed: Option<Aim>,
    history: History<Settings>,
    /// What the filter wants of a file of paths.
    counted: Option<common::FilterCounts>,
    /// A file of paths in the place of a daemon.
    playback: Option<Playback>,
    /// Number of the explorer's step that is shown; the newest without.
    scrub: Option<u64>,
}

/// What on the graphics card no longer fits what the viewer holds.
#[derive(Clone, Copy, Debug)]
struct Stale {
    surfaces: bool,
    aids: bool,
}

impl Viewer {
    /// A viewer that has not connected yet.
    pub fn new(status: Status) -> Self {
        let settings = Settings::default();
        let home = status.embedded.then(|| status.address.clone());
        Self {
            store: Store::new(budget_bytes(settings.cloud.budget_mib)),
            settings,
            camera: ViewCamera::default(),
            status,
            darkroom: Darkroom::default(),
            desk: Desk::new(home),
            model: None,
            scene_hash: String::new(),
            link: None,
            waiting: Backlog::default(),
            panels: panel::all(),
            stale: Stale { surfaces: true, aids: true },
            uploaded_any: false,
            started: Instant::now(),
            closing: false,
            script: Vec::new(),
            orders: 0,
            appearance: (Appearance::default(), Instant::now()),
            filters: 0,
            asked_for: FilterText::default(),
            filter_changed: None,
            filter_in_force: 0,
            selection: None,
            pointed: None,
            history: History::default(),
            counted: None,
            playback: None,
            scrub: None,
        }
    }

    /// Sets up what egui and the graphics card need, once.
    pub fn install(ctx: &egui::Context, gpu: &RenderState, quality: Quality) {
        theme::install(ctx);
        let renderer = Renderer::new(
            gpu.device.clone(),
            gpu.queue.clone(),
            gpu.target_format,
            PAGE_POINTS,
            quality,
        );
        gpu.renderer.write().callback_resources.insert(renderer);
    }

    /// Takes over a connection.
    pub fn set_link(&mut self, link: Link) {
        self.link = Some(link);
        if !self.settings.filter.whole().wants_all() {
            self.ask_for_paths();
        }
    }

    /// Takes over what the user is used to, and how to connect elsewhere. Who comes for the first time
    /// sees the first steps.
    pub fn adopt(&mut self, habits: Habits, connect: Connect) {
        match &habits.layout {
            Some(layout) => self.settings.layout.clone_from(layout),
            None => self.settings.layout.hint = true,
        }
        self.settings.filter.keep_all(&habits.filters);
        self.desk.habits = habits;
        self.desk.connect = Some(connect);
    }

    /// What the user is used to by now.
    pub fn habits(&self) -> Habits {
        let mut filters = self.settings.filter.kept().to_vec();
        for kept in &mut filters {
            kept.on = false;
        }
        let layout = Some(self.settings.layout.clone());
        Habits { filters, layout, ..self.desk.habits.clone() }
    }

    /// Follows the commands of a script. Those for the camera wait for the scene, which would
    /// otherwise undo them; those that give the image away wait for the image; and those that need a
    /// daemon that listens, or a path to pick, wait for the first paths.
    pub fn run_script(&mut self, commands: Vec<Command>) {
        for command in commands {
            let must_wait = match command {
                Command::Camera(_) | Command::Path(PathCommand::Show(..)) => self.model.is_none(),
                Command::Path(PathCommand::Vertex(_)) => self.selection.is_none(),
                Command::Path(PathCommand::Stay(_)) => self.longest_stays().is_none(),
                Command::Order(_) | Command::Path(_) => self.store.is_empty(),
                Command::Image(ImageCommand::Save(_) | ImageCommand::Tev(_)) => {
                    self.darkroom.film.size() == [0, 0]
                }
                _ => false,
            };
            if must_wait {
                self.script.push(command);
            } else {
                self.apply(command);
            }
        }
    }

    /// True once the user wants to leave.
    pub fn is_closing(&self) -> bool {
        self.closing
    }

    /// Paths that have come so far.
    pub fn paths_received(&self) -> u64 {
        self.store.counts().paths
    }

    /// True when scene, image, statistics and all paths that have come are taken in.
    pub fn is_settled(&self) -> bool {
        let enough = self.waiting.paths() <= self.settings.cloud.threshold as usize;
        let whole = self.model.is_some() && self.darkroom.film.size() != [0, 0];
        let idle =
            self.script.is_empty() && self.filter_changed.is_none() && !self.darkroom.is_busy();
        whole && idle && enough && self.status.statistics.is_some()
    }

    /// What is known of the daemon.
    pub fn status(&self) -> &Status {
        &self.status
    }

    /// True when something has come that is not taken in.
    pub fn has_news(&self) -> bool {
        self.link.as_ref().is_some_and(Link::has_news)
    }

    /// True while the user wants the paths to stand still.
    pub fn is_frozen(&self) -> bool {
        self.settings.cloud.frozen
    }

    /// Goes on with the script as far as what has come allows.
    fn go_on(&mut self) {
        let commands = std::mem::take(&mut self.script);
        self.run_script(commands);
    }

    /// Does what was asked for, so that it can be undone where it changed a setting.
    pub fn apply(&mut self, command: Command) {
        tracing::trace!("{command}");
        let restored = match command {
            Command::Undo => self.history.undo(self.settings.clone()),
            Command::Redo => self.history.redo(self.settings.clone()),
            _ => {
                let before = self.settings.clone();
                let text = command.to_string();
                let is_sheet = matches!(
                    command,
                    Command::Layout(
                        LayoutCommand::Help(_) | LayoutCommand::Hint(_) | LayoutCommand::Palette(_)
                    )
                );
                self.carry_out(command);
                if self.settings != before && !is_sheet {
                    let time = self.started.elapsed().as_secs_f64();
                    self.history.note(before, kind(&text), time);
                }
                return;
            }
        };
        if let Some(settings) = restored {
            self.restore(settings);
        }
    }

    /// Goes back, or forth, to other settings.
    fn restore(&mut self, settings: Settings) {
        self.settings = settings;
        self.stale.aids = true;
        self.store.set_budget(budget_bytes(self.settings.cloud.budget_mib));
        self.store.set_drawn(drawn(self.settings.cloud.dim));
        self.filter_changed = Some(Instant::now());
    }

    fn carry_out(&mut self, command: Command) {
        // The model of the camera would stand before the user's eyes.
        self.stale.aids |= matches!(command, Command::Camera(CameraCommand::Through(_)));
        match command {
            Command::Camera(command) => self.camera.apply(command),
            Command::Cloud(command) => {
                self.settings.cloud.apply(command);
                match command {
                    CloudCommand::Clear => self.store.clear(),
                    CloudCommand::Budget(mib) => self.store.set_budget(budget_bytes(mib)),
                    CloudCommand::Dim(x) => self.store.set_drawn(drawn(x)),
                    _ => {}
                }
            }
            Command::Scene(command) => {
                self.settings.scene.apply(command);
                self.stale.aids = true;
            }
            Command::Filter(command) => {
                self.settings.filter.apply(&command);
                self.filter_changed = Some(Instant::now());
                // Files are small, and nobody else has to be asked.
                if self.playback.is_some() {
                    self.judge();
                }
            }
            Command::Image(command) => {
                self.settings.image.apply(&command);
                self.darkroom.apply(&command, &self.settings.image, &mut self.status);
            }
            Command::Layout(command) => self.settings.layout.apply(command),
            Command::Desk(command) => self.go_beyond(command),
            Command::Order(order) => self.send(order),
            Command::Path(command) => self.select(command),
            Command::Play(command) => self.play(command),
            Command::Scrub(number) => self.scrub = number,
            // What these change is not what they can undo.
            Command::Undo | Command::Redo => {}
            Command::Reconnect => {
                if let Some(link) = &self.link {
                    link.retry_now();
                }
            }
            Command::Quit => self.closing = true,
        }
    }

    /// Shows the others where this viewer looks, if the user wishes, when that has changed.
    fn appear(&mut self) {
        let (shown, at) = &self.appearance;
        if at.elapsed() < APPEARANCE || !self.status.is_connected() {
            return;
        }
        let appearance = if self.settings.layout.seen {
            let lens = self.camera.lens(1.0);
            let far = lens.eye + 0.5 * self.camera.bounds().radius() * lens.forward;
            let gaze = Gaze { eye: lens.eye.into(), target: far.into() };
            Appearance { gaze: Some(gaze), filter: self.settings.filter.whole().to_string() }
        } else {
            Appearance::default()
        };
        if appearance != *shown && self.link.as_ref().is_some_and(|l| l.show(appearance.clone())) {
            self.appearance = (appearance, Instant::now());
        }
    }

    fn send(&mut self, order: common::Order) {
        if self.refuse_to_steer() {
            return;
        }
        if matches!(order, common::Order::Explorer(_)) {
            // What comes of it is at the end of the timeline.
            self.scrub = None;
        }
        self.orders += 1;
        let sent = self.link.as_ref().is_some_and(|link| link.order(self.orders, order));
        if !sent {
            self.status.steering.remark(Err("not sent: there is no connection".to_owned()));
        }
    }

    /// Shows everything, and does what the user asks for.
    pub fn ui(&mut self, ui: &mut egui::Ui) {
        let theme = if self.settings.layout.dark { egui::Theme::Dark } else { egui::Theme::Light };
        ui.ctx().set_theme(theme);
        ui.ctx().set_zoom_factor(f32::from(self.settings.layout.scale) / 100.0);
        self.desk.work(ui.ctx(), &mut self.darkroom, &mut self.status);
        self.play_on(ui.ctx());
        let was_through = self.camera.is_through();
        let mut commands = Vec::new();
        let mut panels = std::mem::take(&mut self.panels);
        let world = self.world();
        keys::pressed(ui.ctx(), &world, &mut commands);
        panel::show(&mut panels, ui, &world, &mut commands);
        self.panels = panels;
        self.keep_time(ui.ctx());
        if !commands.is_empty() {
            ui.ctx().request_repaint();
        }
        for command in commands {
            self.apply(command);
        }
        self.stale.aids |= self.camera.is_through() != was_through;
    }

    /// All that panels may read.
    fn world(&self) -> World<'_> {
        World {
            settings: &self.settings,
            camera: &self.camera,
            status: &self.status,
            store: &self.store,
            film: &self.darkroom.film,
            reference: self.darkroom.reference.as_ref(),
            flip: self.darkroom.flip.as_ref(),
            selection: self.selection.as_ref(),
            moment: match &self.playback {
                Some(playback) => playback.moment(),
                None => self.status.steering.focus.moment(self.scrub),
            },
            playback: self.playback.as_ref(),
            counted: self.counted.as_ref(),
            scrub: self.scrub,
            waiting: self.waiting.paths(),
            recent: &self.desk.habits.recent,
            has_home: self.desk.home.is_some(),
            model: self.model.as_ref(),
            now: Instant::now(),
        }
    }

    /// Countdowns run by themselves.
    fn keep_time(&mut self, ctx: &egui::Context) {
        if let Some(notice) = &self.status.notice {
            let left = NOTICE_TIME.saturating_sub(notice.at.elapsed());
            if !left.is_zero() {
                ctx.request_repaint_after(left);
            }
        }
        if self.filter_changed.is_some() {
            ctx.request_repaint_after(arrival::HAND);
        }
        if self.waiting.is_due(self.settings.cloud.threshold as usize) {
            ctx.request_repaint();
        } else if self.darkroom.is_busy() {
            ctx.request_repaint_after(Duration::from_millis(50));
        } else if matches!(self.status.link, LinkState::Disconnected { .. }) {
            ctx.request_repaint_after(Duration::from_millis(250));
        }
    }

    /// Brings the graphics card up to date, as far as one frame allows. True when more is to come.
    pub fn upload(&mut self, gpu: &RenderState) -> bool {
        let mut egui_renderer = gpu.renderer.write();
        let Some(renderer) = egui_renderer.callback_resources.get_mut::<Renderer>() else {
            return false;
        };
        if std::mem::take(&mut self.stale.surfaces) {
            let mesh = self.model.as_ref().map(|model| &model.mesh);
            let textures = mesh.map(|mesh| mesh.textures.as_slice()).unwrap_or_default();
            renderer.set_mesh(&mesh.map(corners).unwrap_or_default(), textures);
        }
        if std::mem::take(&mut self.stale.aids) {
            renderer.set_aids(&self.aids());
        }
        if !std::mem::replace(&mut self.uploaded_any, true) {
            renderer.retain_from(u64::MAX);
        }
        renderer.retain_from(self.store.first_serial());
        let more = upload_paths(&self.store, renderer);
        renderer.set_uploading(more);
        more
    }

    fn aids(&self) -> Vec<shaders::LinePoint> {
        let Some(Model { bounds, .. }) = self.model else { return Vec::new() };
        let camera = self.camera.render_camera().filter(|_| !self.camera.is_through());
        drawing_aids(bounds, camera, self.camera.up(), self.settings.scene.aids)
    }

    /// Shows paths without a scene: only the box round them is known.
    pub fn show_bounds(&mut self, bounds: Bounds) {
        self.set_model(Some(Model { mesh: common::SceneMesh::default(), bounds }));
    }

    /// The box round the scene, once it has come.
    pub fn bounds(&self) -> Option<Bounds> {
        self.model.as_ref().map(|model| model.bounds)
    }
}

/// The first two words of a command: what it concerns.
fn kind(text: &str) -> &str {
    let second = text.find(' ').map_or(text.len(), |i| i + 1);
    let end = text[second..].find(' ').map_or(text.len(), |i| second + i);
    &text[..end]
}

/// Which paths are drawn when those that the filter leaves out have this opacity.
fn drawn(dim: f32) -> Drawn {
    if dim > 0.0 { Drawn::All } else { Drawn::Matched }
}

/// Appends what is missing on the graphics card, newest pages first, since they are looked at.
fn upload_paths(store: &Store, renderer: &mut Renderer) -> bool {
    let mut room = UPLOAD_POINTS;
    let mut points = Vec::new();
    for page in store.pages().rev() {
        let whole = Uploaded { revision: page.revision(), paths: page.paths().len() };
        let there = renderer.uploaded(page.serial());
        if there == Some(whole) {
            continue;
        }
        if room == 0 {
            return true;
        }
        let skip = there.filter(|t| t.revision == whole.revision).map_or(0, |t| t.paths);
        points.clear();
        points.extend(page.points(skip, store.drawn()));
        renderer.append_points(page.serial(), whole, &points);
        room = room.saturating_sub(points.len());
    }
    false
}

fn budget_bytes(mebibytes: u32) -> usize {
    (mebibytes as usize) << 20
}
