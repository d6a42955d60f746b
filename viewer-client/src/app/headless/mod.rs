//! The viewer without a window: the same interface, drawn into a texture and written to a file.

mod job;

use std::sync::Arc;
use std::time::{Duration, Instant};

use anyhow::Context as _;
use egui_wgpu::{RenderState, RendererOptions, ScreenDescriptor, WgpuConfiguration, WgpuSetup};
use host::Quiet;

use crate::app::Viewer;
use crate::app::window;
use crate::draw::gpu::{Quality, Renderer, read_back};

pub use job::{Job, Wait, run};

/// How long to wait between looks into the inbox.
const LOOK: Duration = Duration::from_millis(20);
/// Frames that egui may need until nothing moves any more.
const SETTLING_FRAMES: usize = 6;

async fn graphics(backends: wgpu::Backends) -> Result<RenderState, egui_wgpu::WgpuError> {
    let mut setup = window::graphics_setup();
    setup.instance_descriptor.backends = wgpu::Backends::from_env().unwrap_or(backends);
    let config = WgpuConfiguration {
        wgpu_setup: WgpuSetup::CreateNew(setup),
        ..WgpuConfiguration::default()
    };
    let instance = config.wgpu_setup.new_instance().await;
    RenderState::create(&config, &instance, None, RendererOptions::PREDICTABLE).await
}

/// How long a frame took.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameCost {
    /// Until all commands were submitted to the graphics card, excluding work done in its place.
    pub cpu: Duration,
    /// Until the picture was finished.
    pub wall: Duration,
}

/// An egui context and a graphics card that draw without a window on screen.
pub struct OffscreenWindow {
    ctx: egui::Context,
    gpu: RenderState,
    size: [u32; 2],
    target: wgpu::Texture,
    time: f64,
    /// When the interface wants another frame without input.
    due: Option<Instant>,
    /// Text that would go to the clipboard, if there were one.
    copied: Vec<String>,
    /// Callers waiting for a screenshot.
    waiting: Vec<egui::ScreenshotCallback>,
}

impl std::fmt::Debug for OffscreenWindow {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("OffscreenWindow").field("size", &self.size).finish_non_exhaustive()
    }
}

impl OffscreenWindow {
    /// A window of `size` pixels for pictures to keep.
    pub fn new(size: [u32; 2]) -> anyhow::Result<Self> {
        Self::with(size, |_| Quality::Smooth)
    }

    /// A window of `size` pixels that draws with the quality of a real one.
    pub fn like_a_window(size: [u32; 2]) -> anyhow::Result<Self> {
        Self::with(size, window::quality)
    }

    fn with(size: [u32; 2], quality: fn(&RenderState) -> Quality) -> anyhow::Result<Self> {
        let runtime = tokio::runtime::Builder::new_current_thread().build()?;
        let quiet = Quiet::begin();
        // Looking for OpenGL without a display makes drivers complain, so it comes last.
        let gpu = runtime
            .block_on(graphics(wgpu::Backends::PRIMARY))
            .or_else(|_| runtime.block_on(graphics(wgpu::Backends::GL)));
        window::told_by_drivers(&quiet.end());
        let gpu =
            gpu.context("no graphics driver was found; on Debian, install mesa-vulkan-drivers")?;
        let size = within(size, &gpu);
        let ctx = egui::Context::default();
        Viewer::install(&ctx, &gpu, quality(&gpu));
        let target = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("window"),
            size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: gpu.target_format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        Ok(Self {
            ctx,
            gpu,
            size,
            target,
            time: 0.0,
            due: None,
            copied: Vec::new(),
            waiting: Vec::new(),
        })
    }

    /// Draws until nothing is left to upload and nothing moves, and reads the picture back.
    pub fn settled(&mut self, viewer: &mut Viewer) -> anyhow::Result<image::RgbaImage> {
        for _ in 0..SETTLING_FRAMES {
            self.frame(viewer)?;
        }
        while self.is_refining() {
            self.frame(viewer)?;
        }
        self.read_back()
    }

    /// True while the picture takes more frames.
    pub fn is_refining(&self) -> bool {
        let renderer = self.gpu.renderer.read();
        renderer.callback_resources.get::<Renderer>().is_some_and(Renderer::is_refining)
    }

    fn take_drawing_time(&self) -> Duration {
        let mut renderer = self.gpu.renderer.write();
        let renderer = renderer.callback_resources.get_mut::<Renderer>();
        renderer.map(Renderer::take_drawing_time).unwrap_or_default()
    }

    /// One frame of the interface.
    pub fn frame(&mut self, viewer: &mut Viewer) -> anyhow::Result<FrameCost> {
        let started = Instant::now();
        while viewer.upload(&self.gpu) {
            // What was written waits in memory until it is submitted.
            self.gpu.queue.submit([]);
            let done = self.gpu.device.poll(wgpu::PollType::wait_indefinitely());
            done.context("the graphics driver stopped responding")?;
        }
        let pixels = egui::vec2(self.size[0] as f32, self.size[1] as f32);
        let screen = pixels / self.ctx.zoom_factor();
        let input = egui::RawInput {
            screen_rect: Some(egui::Rect::from_min_size(egui::Pos2::ZERO, screen)),
            time: Some(self.time),
            ..egui::RawInput::default()
        };
        // Half a second a frame: animations are over after a few frames.
        self.time += 0.5;
        let mut output = self.ctx.run_ui(input, |ui| viewer.ui(ui));
        self.heed(&mut output, started);
        let primitives = self.ctx.tessellate(output.shapes, output.pixels_per_point);
        let commands =
            self.encode(&primitives, &mut output.textures_delta, output.pixels_per_point);
        let cpu = started.elapsed().saturating_sub(self.take_drawing_time());
        self.gpu.queue.submit(commands);
        let done = self.gpu.device.poll(wgpu::PollType::wait_indefinitely());
        done.context("the graphics driver stopped responding")?;
        let cost = FrameCost { cpu, wall: started.elapsed() };
        tracing::debug!("a frame took {:.0} ms", 1e3 * cost.wall.as_secs_f64());
        Ok(cost)
    }

    /// Does what a desktop does for a program.
    fn heed(&mut self, output: &mut egui::FullOutput, now: Instant) {
        for command in output.platform_output.commands.drain(..) {
            if let egui::OutputCommand::CopyText(text) = command {
                self.copied.push(text);
            }
        }
        let Some(root) = output.viewport_output.get_mut(&egui::ViewportId::ROOT) else { return };
        self.due = now.checked_add(root.repaint_delay);
        for command in root.commands.drain(..) {
            if let egui::ViewportCommand::Screenshot(callback) = command {
                self.waiting.push(callback);
            }
        }
    }

    /// What was copied since this was asked last.
    fn take_copied(&mut self) -> Vec<String> {
        std::mem::take(&mut self.copied)
    }

    /// Gives pictures of the window to those who wait for one, when nothing moves any more.
    fn give_pictures(&mut self, viewer: &mut Viewer) -> anyhow::Result<()> {
        let waiting = std::mem::take(&mut self.waiting);
        if waiting.is_empty() {
            return Ok(());
        }
        let picture = self.settled(viewer)?;
        let size = self.size.map(|side| side as usize);
        let picture = Arc::new(egui::ColorImage::from_rgba_unmultiplied(size, picture.as_raw()));
        for callback in waiting {
            callback.complete(Arc::clone(&picture));
        }
        Ok(())
    }

    /// Lets `time` go by as a window does where nobody touches it: frames are drawn only when
    /// something has come, or when the interface wants one. Answers how many that were.
    pub fn rest(&mut self, viewer: &mut Viewer, time: Duration) -> anyhow::Result<u32> {
        let end = Instant::now() + time;
        let mut frames = 0;
        while Instant::now() < end {
            if viewer.receive() || self.due.is_some_and(|due| due <= Instant::now()) {
                self.frame(viewer)?;
                frames += 1;
            }
            std::thread::sleep(LOOK);
        }
        Ok(frames)
    }

    fn encode(
        &self,
        primitives: &[egui::ClippedPrimitive],
        textures: &mut egui::TexturesDelta,
        pixels_per_point: f32,
    ) -> Vec<wgpu::CommandBuffer> {
        let RenderState { device, queue, .. } = &self.gpu;
        let mut renderer = self.gpu.renderer.write();
        #[expect(clippy::iter_over_hash_type, reason = "textures do not depend on each other")]
        for (id, deltas) in textures.set.drain() {
            for delta in deltas {
                renderer.update_texture(device, queue, id, &delta);
            }
        }
        let mut encoder =
            device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("frame") });
        let screen = ScreenDescriptor { size_in_pixels: self.size, pixels_per_point };
        let more = renderer.update_buffers(device, queue, &mut encoder, primitives, &screen);
        let view = self.target.create_view(&wgpu::TextureViewDescriptor::default());
        let mut pass = encoder
            .begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("window"),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &view,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                        store: wgpu::StoreOp::Store,
                    },
                })],
                ..wgpu::RenderPassDescriptor::default()
            })
            .forget_lifetime();
        renderer.render(&mut pass, primitives, &screen);
        drop(pass);
        #[expect(clippy::iter_over_hash_type, reason = "textures do not depend on each other")]
        for id in textures.free.drain() {
            renderer.free_texture(&id);
        }
        more.into_iter().chain(Some(encoder.finish())).collect()
    }

    fn read_back(&self) -> anyhow::Result<image::RgbaImage> {
        let RenderState { device, queue, .. } = &self.gpu;
        let [width, height] = self.size;
        let encoder = device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("read back") });
        let bytes = read_back(device, queue, encoder, self.target.as_image_copy(), 4)?;
        image::RgbaImage::from_raw(width, height, bytes).context("the picture has a wrong size")
    }
}

/// The size of a picture, or as much of it as the graphics card can draw.
fn within(size: [u32; 2], gpu: &RenderState) -> [u32; 2] {
    let most = gpu.device.limits().max_texture_dimension_2d;
    let [width, height] = size.map(|side| side.min(most));
    if [width, height] != size {
        tracing::warn!("the graphics card can only draw {width} x {height} of these pixels");
    }
    [width, height]
}

#[cfg(test)]
mod look_tests;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod twin_tests;
