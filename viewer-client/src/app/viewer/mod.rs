//! The viewer itself: what is looked at, what the user chose, and what is on the graphics card.

mod elsewhere;
#[cfg(test)]
mod elsewhere_tests;
mod on_card;
mod scripted;
mod selecting;
#[cfg(test)]
mod tests;

use std::time::{Duration, Instant};

use common::{Appearance, Gaze, Order};
use egui_wgpu::RenderState;

use super::background::{BackgroundTasks, Outcome, TaskResult};
use super::desktop::{Connect, Desktop};
use super::preferences::Preferences;
use crate::command::{
    CloudCommand, Command, FilterCommand, ImageCommand, PlayCommand, SessionCommand, Trait,
};
use crate::draw::gpu::{Quality, Renderer};
use crate::imaging::{Finding, Job};
use crate::keys;
use crate::panel::{self, NOTICE_TIME, Panel, Slot};
use crate::settings::Settings;
use crate::source::connection::{Inbox, Link};
use crate::source::model::Model;
use crate::source::status::{LinkState, Status};
use crate::source::store::PAGE_POINTS;
use crate::source::{Daemon, HAND, Origin, Source};
use crate::value::history::History;
use crate::value::{Bounds, Theme, theme};
use crate::world::World;

use on_card::OnCard;

/// The longest pause between two frames that a file of paths plays on by, in seconds.
const LONGEST_FRAME: f32 = 0.1;

/// Everything behind the window.
#[derive(Debug)]
pub struct Viewer {
    settings: Settings,
    history: History<Settings>,
    source: Source,
    panels: Vec<(Slot, Box<dyn Panel>)>,
    desktop: Desktop,
    tasks: BackgroundTasks,
    on_card: OnCard,
    started: Instant,
    closing: bool,
    /// Commands that give something away wait.
    holds_back: bool,
}

impl Viewer {
    /// A viewer that looks at `source`.
    pub fn new(source: Source) -> Self {
        let home = source.status.embedded.then(|| source.status.address.clone());
        let mut viewer = Self {
            settings: Settings::default(),
            history: History::default(),
            source: Source::nothing(),
            panels: panel::all(),
            desktop: Desktop::new(home),
            tasks: BackgroundTasks::default(),
            on_card: OnCard::default(),
            started: Instant::now(),
            closing: false,
            holds_back: false,
        };
        viewer.look_at(source);
        viewer
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

    /// Leaves what was looked at, with everything that came of it, for something else.
    pub fn look_at(&mut self, source: Source) {
        self.source = source;
        self.source.adopt(&mut self.settings);
    }

    /// Takes over a connection to the daemon that is looked at.
    pub fn set_link(&mut self, link: Link) {
        self.source.attach(link);
    }

    /// Takes over what was remembered, and how to connect elsewhere.
    pub fn adopt(&mut self, preferences: Preferences, connect: Connect) {
        preferences.restore(&mut self.settings);
        self.desktop.preferences = preferences;
        self.desktop.connect = Some(connect);
    }

    /// Tells the user of something that went wrong.
    pub fn complain(&mut self, problem: String) {
        self.say(Err(problem));
    }

    /// What is worth remembering by now.
    pub fn preferences(&self) -> Preferences {
        Preferences::of(&self.settings, &self.desktop.preferences)
    }

    /// True once the user wants to leave.
    pub fn is_closing(&self) -> bool {
        self.closing
    }

    /// Paths that have come so far.
    pub fn paths_received(&self) -> u64 {
        self.source.shown.store.counts().paths
    }

    /// True when scene, image, statistics and all paths that have come are taken in, and nothing is left to
    /// do.
    pub fn is_settled(&self) -> bool {
        self.has_everything() && self.is_idle()
    }

    /// True when scene, image, statistics and all paths that have come are taken in.
    pub fn has_everything(&self) -> bool {
        let Source { origin, shown, status, .. } = &self.source;
        let threshold = self.settings.cloud.threshold as usize;
        let agrees = match origin {
            Origin::Daemon(daemon) => {
                daemon.inbox().paths() <= threshold && daemon.agrees_on_paths()
            }
            Origin::Nothing | Origin::File(_) => true,
        };
        let whole = shown.model.is_some() && shown.image.film.size() != [0, 0];
        whole && agrees && status.statistics.is_some()
    }

    /// What the user has chosen.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// What is known of the daemon.
    pub fn status(&self) -> &Status {
        &self.source.status
    }

    /// What went wrong since the last call, for use without a window.
    pub fn take_failures(&mut self) -> Vec<String> {
        self.source.status.take_failures()
    }

    /// Where what comes from the daemon waits: for harnesses without a network.
    pub fn inbox(&self) -> Option<&Inbox> {
        self.source.as_daemon().map(Daemon::inbox)
    }

    /// True when something has come that is not taken in.
    pub fn has_news(&self) -> bool {
        self.inbox().is_some_and(Inbox::has_news)
    }

    /// True while the user wants the paths to stand still.
    pub fn is_frozen(&self) -> bool {
        self.settings.cloud.frozen
    }

    /// Takes in what has come. True when there was anything.
    pub fn receive(&mut self) -> bool {
        let arrived = self.source.receive(&mut self.settings);
        if arrived.session && !self.source.status.embedded {
            self.desktop.preferences.add_recent(&self.source.status.address);
        }
        let finished = self.work_on();
        self.appear();
        arrived.news || finished
    }

    /// Does what was asked for, so that it can be undone where it changed a setting.
    pub fn apply(&mut self, command: Command) {
        tracing::trace!("{command}");
        let restored = match command {
            Command::Session(SessionCommand::Undo) => self.history.undo(self.settings.clone()),
            Command::Session(SessionCommand::Redo) => self.history.redo(self.settings.clone()),
            _ => {
                let before = self.settings.clone();
                let form = command.form();
                self.carry_out(command);
                if self.settings != before && !form.is(Trait::Passing) {
                    let time = self.started.elapsed().as_secs_f64();
                    self.history.record(before, form.words, time);
                }
                return;
            }
        };
        if let Some(settings) = restored {
            self.settings = settings;
            self.source.shown.configure(&self.settings.cloud);
            self.source.fit(&mut self.settings);
            self.source.filter_changed(&self.settings);
        }
    }

    fn carry_out(&mut self, command: Command) {
        match command {
            Command::Camera(command) => self.source.shown.camera.apply(command),
            Command::Cloud(command) => {
                self.settings.cloud.set(&command);
                self.source.shown.configure(&self.settings.cloud);
                if command == CloudCommand::Clear {
                    self.source.shown.store.clear();
                }
            }
            Command::Scene(command) => self.settings.scene.set(&command),
            Command::Filter(command) => {
                self.settings.filter.apply(&command);
                self.tell_misfit(&command);
                self.source.filter_changed(&self.settings);
            }
            Command::Image(command) => {
                self.settings.image.apply(&command);
                self.change_image(&command);
            }
            Command::Window(command) => self.settings.window.set(&command),
            Command::Layout(command) => self.settings.layout.apply(command),
            Command::Desktop(command) => self.use_desktop(command),
            Command::Order(order) => self.send(order),
            Command::Path(command) => self.select(command),
            Command::Play(command) => self.play(command),
            Command::Scrub(number) => self.source.status.steering.focus.scrub = number,
            // What these change is not what they can undo.
            Command::Session(SessionCommand::Undo | SessionCommand::Redo) => {}
            Command::Session(SessionCommand::Reconnect) => {
                self.source.as_daemon().into_iter().for_each(Daemon::retry_now);
            }
            Command::Session(SessionCommand::Quit) => self.closing = true,
        }
    }

    /// Tells why a filter that was just set is left out.
    fn tell_misfit(&mut self, command: &FilterCommand) {
        if matches!(command, FilterCommand::Set(_))
            && let Some(error) = self.settings.filter.complaint()
        {
            self.say(Err(format!("The filter is left out: {}.", error.message)));
        }
    }

    fn say(&mut self, said: Result<String, String>) {
        self.source.status.say(said);
    }

    /// Does what an image command asks for beyond the settings.
    fn change_image(&mut self, command: &ImageCommand) {
        let look = self.source.suited(&self.settings).image;
        let Source { shown, status, .. } = &mut self.source;
        let started = match shown.image.job(command, &look, status.provenance()) {
            Ok(Some(job)) => self.start(job),
            Ok(None) => Ok(()),
            Err(problem) => Err(problem),
        };
        if let Err(problem) = started {
            self.say(Err(problem));
        }
    }

    fn start(&mut self, job: Job) -> Result<(), String> {
        let of = self.source.shown.serial();
        self.tasks.start(move || job().map(|finding| TaskResult::Image { of, finding }))
    }

    /// Takes in what background tasks have brought back. True when there was anything.
    fn finish_tasks(&mut self) -> bool {
        let outcomes = self.tasks.finished();
        let any = !outcomes.is_empty();
        for outcome in outcomes {
            if let Some(said) = self.finish(outcome) {
                self.say(said);
            }
        }
        if !self.tasks.is_busy() {
            let next = self.source.shown.image.next_comparison(&self.settings.image);
            let started = next.and_then(|job| job.map_or(Ok(()), |job| self.start(job)));
            if let Err(problem) = started {
                self.settings.image.layer = crate::value::Layer::Difference;
                self.say(Err(problem));
            }
        }
        any
    }

    /// Takes in what a background task has brought back; the answer is for the user.
    fn finish(&mut self, outcome: Outcome) -> Option<Result<String, String>> {
        match outcome {
            Ok(TaskResult::Done(text) | TaskResult::Image { finding: Finding::Done(text), .. }) => {
                Some(Ok(text))
            }
            Ok(TaskResult::Image { of, finding }) => {
                let shown = &mut self.source.shown;
                let image = (of == shown.serial()).then_some(&mut shown.image)?;
                image.finish(finding, &mut self.settings.image)
            }
            Ok(TaskResult::Opened { name, playable }) => {
                self.look_at(Source::file(&name, *playable));
                None
            }
            Err(problem) => Some(Err(problem)),
        }
    }

    /// Shows the others where this viewer looks, if the user shares that.
    fn appear(&mut self) {
        let Self { settings, source: Source { origin, status, shown, .. }, .. } = self;
        let Origin::Daemon(daemon) = origin else { return };
        if !status.is_connected() {
            return;
        }
        daemon.appear(|| {
            if !settings.window.seen {
                return Appearance::default();
            }
            let lens = shown.camera.lens(1.0);
            let far = lens.eye + 0.5 * shown.camera.bounds().radius() * lens.forward;
            let gaze = Gaze { eye: lens.eye.into(), target: far.into() };
            Appearance { gaze: Some(gaze), filter: settings.filter.whole().to_string() }
        });
    }

    /// Follows a command about the file of paths.
    fn play(&mut self, command: PlayCommand) {
        if !self.source.play(command) {
            let problem = "There is no file of paths to play; open one with `viewer-client FILE`.";
            self.say(Err(problem.to_owned()));
        }
    }

    fn send(&mut self, order: Order) {
        let Source { origin, status, .. } = &mut self.source;
        let problem = match origin {
            Origin::File(_) => {
                "A file of paths has no daemon with chains to steer or explore; open the scene \
                itself with `viewer-client --scene SCENE`."
            }
            Origin::Nothing => "There is no daemon to steer; connect to one first.",
            Origin::Daemon(daemon) => {
                if matches!(order, Order::Explorer(_)) {
                    // What comes of it is at the end of the timeline.
                    status.steering.focus.scrub = None;
                }
                if !daemon.order(order) {
                    let problem = "it was not sent, because there is no connection".to_owned();
                    status.steering.remark(Err(problem));
                }
                return;
            }
        };
        self.say(Err(problem.to_owned()));
    }

    /// Shows everything, and does what the user asks for.
    pub fn ui(&mut self, ui: &mut egui::Ui) {
        let theme = match self.settings.window.theme {
            Theme::Dark => egui::Theme::Dark,
            Theme::Light => egui::Theme::Light,
        };
        ui.ctx().set_theme(theme);
        ui.ctx().set_zoom_factor(f32::from(self.settings.window.scale) / 100.0);
        if let Err(problem) = self.desktop.work(ui.ctx(), &mut self.tasks) {
            self.say(Err(problem));
        }
        let seconds = ui.ctx().input(|input| input.stable_dt).min(LONGEST_FRAME);
        self.source.play_on(seconds);
        let mut commands = Vec::new();
        let mut panels = std::mem::take(&mut self.panels);
        let seen = self.source.suited(&self.settings);
        let world = self.world(&seen);
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
    }

    /// All that panels may read; `seen` are the settings as the source suits them.
    fn world<'a>(&'a self, seen: &'a Settings) -> World<'a> {
        let Source { status, shown, .. } = &self.source;
        let playback = self.source.playback();
        World {
            settings: seen,
            camera: &shown.camera,
            status,
            store: &shown.store,
            film: &shown.image.film,
            reference: shown.image.reference.as_ref(),
            flip: shown.image.flip.as_ref(),
            selection: shown.selection.as_ref(),
            moment: match playback {
                Some(playback) => playback.moment(),
                None => status.steering.focus.moment(),
            },
            playback,
            counted: shown.counted.as_ref(),
            scrub: status.steering.focus.scrub,
            waiting: self.inbox().map_or(0, Inbox::paths),
            recent: &self.desktop.preferences.recent,
            has_home: self.desktop.home.is_some(),
            model: shown.model.as_ref(),
            filter_scene: &shown.filter_scene,
            now: Instant::now(),
        }
    }

    /// Countdowns run by themselves.
    fn keep_time(&self, ctx: &egui::Context) {
        if let Some(notice) = &self.source.status.notice {
            let left = NOTICE_TIME.saturating_sub(notice.at.elapsed());
            if !left.is_zero() {
                ctx.request_repaint_after(left);
            }
        }
        if self.source.as_daemon().is_some_and(Daemon::filter_is_changing) {
            ctx.request_repaint_after(HAND);
        }
        if self.source.is_moving(&self.settings) {
            ctx.request_repaint();
        } else if self.tasks.is_busy() {
            ctx.request_repaint_after(Duration::from_millis(50));
        } else if matches!(self.source.status.link, LinkState::Disconnected { .. }) {
            ctx.request_repaint_after(Duration::from_millis(250));
        }
    }

    /// Brings the graphics card up to date, as far as one frame allows. True when more is to come.
    pub fn upload(&mut self, gpu: &RenderState) -> bool {
        self.on_card.update(gpu, &self.source.shown, &self.settings)
    }

    /// Shows paths without a scene: only the box round them is known.
    pub fn show_bounds(&mut self, bounds: Bounds) {
        let model = Model { mesh: common::SceneMesh::default(), bounds };
        self.source.set_model(Some(model), &mut self.settings);
        self.go_on();
    }

    /// The box round the scene, once it has come.
    pub fn bounds(&self) -> Option<Bounds> {
        self.source.shown.model.as_ref().map(|model| model.bounds)
    }
    /// Triangles of the scene on screen, once it has come.
    pub fn triangles(&self) -> Option<usize> {
        self.source.shown.model.as_ref().map(|model| model.mesh.triangles.len())
    }
}
