//! The viewer in a window of the desktop.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use anyhow::{Context as _, anyhow};
use egui_wgpu::{WgpuConfiguration, WgpuSetup, WgpuSetupCreateNew};

use crate::app::Viewer;
use crate::app::desktop::Connect;
use crate::app::pace::{CALM, FRAME, Pace};
use crate::command::Command;
use crate::draw::gpu::Quality;
use crate::habits::{Habits, Keeper};
use crate::source::connection::{Haste, Link, Peer, Waker};

/// The window's first size in points.
const SIZE: [f32; 2] = [1440.0, 860.0];
/// The smallest size at which all panels are legible.
const SMALLEST: [f32; 2] = [900.0, 560.0];

/// How to reach a graphics card: with all that its driver allows.
pub(crate) fn graphics_setup() -> WgpuSetupCreateNew {
    WgpuSetupCreateNew {
        device_descriptor: Arc::new(|adapter| wgpu::DeviceDescriptor {
            label: Some("Lvis"),
            // The defaults for OpenGL are those of WebGL 2, far below what drivers offer.
            required_limits: adapter.limits(),
            ..wgpu::DeviceDescriptor::default()
        }),
        ..WgpuSetupCreateNew::without_display_handle()
    }
}

/// Opens the window with what is remembered, follows the commands, and returns when it is closed.
/// Without a daemon, the viewer has all it needs.
pub fn run(viewer: Viewer, peer: Option<Peer>, commands: Vec<Command>) -> anyhow::Result<()> {
    let options = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_title("Lvis")
            .with_app_id("lvis")
            .with_inner_size(SIZE)
            .with_min_inner_size(SMALLEST),
        wgpu_options: WgpuConfiguration {
            wgpu_setup: WgpuSetup::CreateNew(graphics_setup()),
            ..WgpuConfiguration::default()
        },
        ..eframe::NativeOptions::default()
    };
    let create = move |cc: &eframe::CreationContext<'_>| {
        let gpu = cc.wgpu_render_state.as_ref().context("no graphics card was found")?;
        Viewer::install(&cc.egui_ctx, gpu, quality(gpu));
        let mut viewer = viewer;
        let ctx = cc.egui_ctx.clone();
        let is_calm = Arc::new(AtomicBool::new(false));
        let calm = Arc::clone(&is_calm);
        let connect: Connect = Box::new(move |peer| {
            let (ctx, calm) = (ctx.clone(), Arc::clone(&calm));
            let waker: Waker = Box::new(move |haste| {
                let patient = haste == Haste::Whenever && calm.load(Ordering::Relaxed);
                ctx.request_repaint_after(if patient { CALM } else { FRAME });
            });
            Link::start(peer, waker)
        });
        if let Some(peer) = peer {
            viewer.set_link(connect(peer)?);
        }
        let file = Habits::file();
        let habits = file.as_deref().map(Habits::load).unwrap_or_default();
        let keeper = file.map(|file| Keeper::new(file, habits.clone()));
        viewer.adopt(habits, connect);
        viewer.run_script(commands);
        let pace = Pace::default();
        let app: Box<dyn eframe::App> = Box::new(Window { viewer, pace, is_calm, keeper });
        Ok(app)
    };
    eframe::run_native("Lvis", options, Box::new(create)).map_err(|error| {
        anyhow!(
            "cannot open a window: {error}; without a display, use --headless --screenshot-to \
             OUT.png"
        )
    })
}

/// Programs that stand in for a graphics card spend most of their time on samples.
pub(crate) fn quality(gpu: &egui_wgpu::RenderState) -> Quality {
    let tells_depth = wgpu::DownlevelFlags::DEPTH_TEXTURE_AND_BUFFER_COPIES;
    match gpu.adapter.get_info().device_type {
        wgpu::DeviceType::Cpu
            if gpu.adapter.get_downlevel_capabilities().flags.contains(tells_depth) =>
        {
            Quality::Fast
        }
        wgpu::DeviceType::Cpu => Quality::Plain,
        _ => Quality::Smooth,
    }
}

struct Window {
    viewer: Viewer,
    pace: Pace,
    /// The cloud is frozen: what comes all the time can wait. The connection's thread reads it.
    is_calm: Arc<AtomicBool>,
    /// Keeps what the user is used to; absent where there is no folder for settings.
    keeper: Option<Keeper>,
}

impl eframe::App for Window {
    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        self.is_calm.store(self.viewer.is_frozen(), Ordering::Relaxed);
        match self.pace.wait(Instant::now()) {
            Some(wait) if self.viewer.has_news() => ui.ctx().request_repaint_after(wait),
            None if self.viewer.receive() => {
                self.pace.news(Instant::now());
                // The next frame begins when this one is done, and tells how long it took.
                ui.ctx().request_repaint();
            }
            Some(_) | None => {}
        }
        if let Some(gpu) = frame.wgpu_render_state()
            && self.viewer.upload(gpu)
        {
            ui.ctx().request_repaint();
        }
        self.viewer.ui(ui);
        if let Some(keeper) = &mut self.keeper
            && let Some(wait) = keeper.note(self.viewer.habits(), Instant::now())
        {
            ui.ctx().request_repaint_after(wait);
        }
        if self.viewer.is_closing() {
            ui.ctx().send_viewport_cmd(egui::ViewportCommand::Close);
        }
    }

    fn on_exit(&mut self) {
        if let Some(keeper) = &mut self.keeper {
            keeper.finish(self.viewer.habits());
        }
    }
}
