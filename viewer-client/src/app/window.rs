//! The viewer in a window of the desktop.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};
use std::{process, thread};

use anyhow::{Context as _, anyhow};
use egui_wgpu::{RenderState, WgpuConfiguration, WgpuSetup, WgpuSetupCreateNew};
use host::Quiet;
use host::signal::Endings;
use tokio::runtime::Runtime;

use super::preferences::{Keeper, Preferences};
use crate::app::Viewer;
use crate::app::desktop::Connect;
use crate::app::pace::{CALM, FRAME, Pace};
use crate::command::Command;
use crate::draw::gpu::Quality;
use crate::source::connection::{Link, Peer, Urgency, Waker};

/// The window's first size in points.
const SIZE: [f32; 2] = [1440.0, 860.0];
/// The smallest size at which all panels are legible.
const SMALLEST: [f32; 2] = [900.0, 560.0];
/// A window that was told to close by a signal has this long for that.
const FAREWELL: Duration = Duration::from_secs(3);

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
    let quiet = Quiet::begin();
    let create = move |cc: &eframe::CreationContext<'_>| {
        told_by_drivers(&quiet.end());
        let gpu = cc.wgpu_render_state.as_ref().context("no graphics adapter was found")?;
        Viewer::install(&cc.egui_ctx, gpu, quality(gpu));
        keep_within(&cc.egui_ctx, gpu);
        let mut viewer = viewer;
        let ctx = cc.egui_ctx.clone();
        let is_ending = Arc::new(AtomicBool::new(false));
        end_by_signals(Arc::clone(&is_ending), ctx.clone())?;
        let is_calm = Arc::new(AtomicBool::new(false));
        let calm = Arc::clone(&is_calm);
        let connect: Connect = Box::new(move |peer| {
            let (ctx, calm) = (ctx.clone(), Arc::clone(&calm));
            let waker: Waker = Box::new(move |haste| {
                let patient = haste == Urgency::Whenever && calm.load(Ordering::Relaxed);
                ctx.request_repaint_after(if patient { CALM } else { FRAME });
            });
            Link::start(peer, waker)
        });
        if let Some(peer) = peer {
            viewer.set_link(connect(peer)?);
        }
        let file = Preferences::file();
        let (preferences, complaints) = file.as_deref().map(Preferences::load).unwrap_or_default();
        let keeper = file.map(|file| Keeper::new(file, preferences.clone()));
        viewer.adopt(preferences, connect);
        for complaint in complaints {
            tracing::warn!("{complaint}");
            viewer.complain(complaint);
        }
        viewer.run_script(commands);
        let pace = Pace::default();
        let app: Box<dyn eframe::App> =
            Box::new(Window { viewer, pace, is_calm, is_ending, keeper });
        Ok(app)
    };
    eframe::run_native("Lvis", options, Box::new(create)).map_err(|error| {
        anyhow!(
            "cannot open a window: {error}; without a display, use --headless --screenshot-to \
             OUT.png"
        )
    })
}

/// What graphics drivers had to say of displays that they passed over.
pub(crate) fn told_by_drivers(text: &str) {
    if !text.is_empty() {
        tracing::debug!("printed while the graphics adapter was opened:\n{text}");
    }
}

/// Sides of the largest window that the graphics card can draw, in points.
fn most(ctx: &egui::Context, gpu: &RenderState) -> f32 {
    gpu.device.limits().max_texture_dimension_2d as f32 / ctx.pixels_per_point()
}

/// No window is larger than what the graphics card can draw.
fn keep_within(ctx: &egui::Context, gpu: &RenderState) {
    let most = egui::Vec2::splat(most(ctx, gpu));
    ctx.send_viewport_cmd(egui::ViewportCommand::MaxInnerSize(most));
    // Where nobody heeds that, the window is too large until it is made smaller again, and nothing can be
    // drawn meanwhile; which is no reason to end.
    let told = Mutex::new(String::new());
    gpu.device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
        let error = error.to_string();
        let mut told = told.lock().unwrap_or_else(PoisonError::into_inner);
        // The same goes wrong in every frame.
        if *told != error {
            tracing::error!("the graphics card cannot do this: {error}");
            *told = error;
        }
    }));
}

/// What a window of `size` must shrink to, if it is too large.
fn shrunk(size: egui::Vec2, most: f32) -> Option<egui::Vec2> {
    (size.max_elem() > most).then(|| size.min(egui::Vec2::splat(most)))
}

/// Has signals close the window, so that what is remembered is saved. The second one ends the program
/// at once, and so does a window that does not close.
fn end_by_signals(is_ending: Arc<AtomicBool>, ctx: egui::Context) -> anyhow::Result<()> {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
    let mut endings = {
        let _context = runtime.enter();
        Endings::listen()?
    };
    let wait = move || {
        let first = runtime.block_on(endings.next());
        tracing::info!("closing: {}", first.name());
        is_ending.store(true, Ordering::Relaxed);
        ctx.request_repaint();
        patiently(&runtime, &mut endings);
        #[expect(clippy::exit, reason = "a window that does not close must not keep the program")]
        process::exit(i32::from(first.exit_code()));
    };
    // It lasts as long as the program does.
    drop(thread::Builder::new().name("signals".to_owned()).spawn(wait)?);
    Ok(())
}

/// Until the next signal, or until there was time enough to end.
fn patiently(runtime: &Runtime, endings: &mut Endings) {
    runtime.block_on(async {
        tokio::select! {
            _ = endings.next() => {}
            () = tokio::time::sleep(FAREWELL) => {}
        }
    });
}

/// Programs that stand in for a graphics card spend most of their time on samples.
pub(crate) fn quality(gpu: &RenderState) -> Quality {
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
    /// A signal has asked the program to end.
    is_ending: Arc<AtomicBool>,
    /// Keeps what the user is used to; absent where there is no folder for settings.
    keeper: Option<Keeper>,
}

impl Window {
    /// Saves what is to be remembered when it is time to, and closes the window where that was asked for.
    fn settle(&mut self, ctx: &egui::Context) {
        if let Some(keeper) = &mut self.keeper {
            if let Some(wait) = keeper.update(self.viewer.preferences(), Instant::now()) {
                ctx.request_repaint_after(wait);
            }
            if let Some(problem) = keeper.problem() {
                self.viewer.complain(problem);
            }
        }
        if self.viewer.is_closing() || self.is_ending.load(Ordering::Relaxed) {
            ctx.send_viewport_cmd(egui::ViewportCommand::Close);
        }
    }
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
        if let Some(gpu) = frame.wgpu_render_state() {
            let size = ui.ctx().content_rect().size();
            if let Some(size) = shrunk(size, most(ui.ctx(), gpu)) {
                ui.ctx().send_viewport_cmd(egui::ViewportCommand::InnerSize(size));
            }
            if self.viewer.upload(gpu) {
                ui.ctx().request_repaint();
            }
        }
        self.viewer.ui(ui);
        self.settle(ui.ctx());
    }

    /// A window that nobody sees is not drawn, but must still be closed, and what was changed just before
    /// it was hidden be saved.
    fn logic(&mut self, ctx: &egui::Context, _frame: &mut eframe::Frame) {
        if ctx.input(|input| input.viewport().visible() == Some(false)) {
            self.settle(ctx);
        }
    }

    fn on_exit(&mut self) {
        if let Some(keeper) = &mut self.keeper {
            keeper.finish(self.viewer.preferences());
        }
    }
}

#[cfg(test)]
mod tests {
    use egui::vec2;

    use super::*;

    #[test]
    fn a_window_that_is_too_large_shrinks() {
        assert_eq!(shrunk(vec2(1440.0, 860.0), 8192.0), None);
        assert_eq!(shrunk(vec2(8192.0, 8192.0), 8192.0), None);
        assert_eq!(shrunk(vec2(17_000.0, 600.0), 8192.0), Some(vec2(8192.0, 600.0)));
        assert_eq!(shrunk(vec2(600.0, 9000.0), 8192.0), Some(vec2(600.0, 8192.0)));
    }
}
