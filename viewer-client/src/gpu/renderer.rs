//! Everything on the graphics card, and the order in which it is drawn.

use egui_wgpu::{CallbackResources, CallbackTrait, ScreenDescriptor};
use shaders::{FrameUniforms, LinePoint, MeshVertex};

use super::composite::Composite;
use super::lines::{Lines, PageRange, PathLayers};
use super::mesh::Mesh;
use super::pipeline::FrameGroup;
use super::target::Target;

/// What to draw.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The eye and every number of the shaders.
    pub uniforms: FrameUniforms,
    /// The paths, newest page first.
    pub paths: Vec<PageRange>,
    /// Surfaces are drawn at all.
    pub surfaces: bool,
}

/// How well to draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quality {
    /// Four samples a pixel.
    Smooth,
    /// One, for graphics drivers that are slow.
    Fast,
}

/// All buffers, textures and pipelines of the viewport.
#[derive(Debug)]
pub struct Renderer {
    device: wgpu::Device,
    queue: wgpu::Queue,
    frame: FrameGroup,
    mesh: Mesh,
    lines: Lines,
    composite: Composite,
    target: Option<Target>,
    /// What the target shows, until something is uploaded.
    drawn: Option<Picture>,
}

impl Renderer {
    /// A renderer for windows of `format` whose pages of paths hold `page_points` points.
    pub fn new(
        device: wgpu::Device,
        queue: wgpu::Queue,
        format: wgpu::TextureFormat,
        page_points: usize,
        quality: Quality,
    ) -> Self {
        let samples = match quality {
            Quality::Smooth => 4,
            Quality::Fast => 1,
        };
        let frame = FrameGroup::new(&device, samples);
        Self {
            mesh: Mesh::new(&device, &frame),
            lines: Lines::new(&device, &frame, page_points),
            composite: Composite::new(&device, &frame, format),
            frame,
            target: None,
            drawn: None,
            device,
            queue,
        }
    }

    /// Replaces all surfaces.
    pub fn set_mesh(&mut self, corners: &[MeshVertex]) {
        self.mesh.set(&self.device, corners);
        self.drawn = None;
    }

    /// Replaces the drawing aids.
    pub fn set_aids(&mut self, points: &[LinePoint]) {
        self.lines.set_aids(&self.device, points);
        self.drawn = None;
    }

    /// Points of a page that are here already.
    pub fn uploaded(&self, serial: u64) -> usize {
        self.lines.uploaded(serial)
    }

    /// Appends points to a page.
    pub fn append_points(&mut self, serial: u64, points: &[LinePoint]) {
        if !points.is_empty() {
            self.lines.append(&self.device, &self.queue, serial, points);
            self.drawn = None;
        }
    }

    /// Gives up every page older than `first`.
    pub fn retain_from(&mut self, first: u64) {
        self.lines.retain_from(first);
    }

    /// Bytes on the graphics card, textures aside.
    pub fn byte_len(&self) -> u64 {
        self.mesh.byte_len() + self.lines.byte_len()
    }

    fn prepare(&mut self, encoder: &mut wgpu::CommandEncoder, picture: &Picture) {
        if self.drawn.as_ref() == Some(picture) {
            return;
        }
        let target = match self.target.take() {
            Some(target) if target.size == picture.size => target,
            _ => {
                let target = Target::new(&self.device, picture.size, self.frame.samples);
                self.composite.set_picture(&self.device, &target.resolved);
                target
            }
        };
        self.frame.write(&self.queue, &picture.uniforms);
        self.draw(&mut target.begin(encoder), picture);
        self.target = Some(target);
        self.drawn = Some(picture.clone());
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, picture: &Picture) {
        pass.set_bind_group(0, &self.frame.group, &[]);
        let uniforms = &picture.uniforms;
        if picture.surfaces {
            self.mesh.draw_opaque(pass);
        }
        self.lines.draw_aids(pass);
        let layers = PathLayers {
            hidden: picture.surfaces && uniforms.line.z > 0.0,
            dots: uniforms.fade.w > 0.0 || uniforms.tone.z > 0.0,
        };
        self.lines.draw_paths(pass, &picture.paths, layers);
        if picture.surfaces {
            self.mesh.draw_translucent(pass);
        }
    }
}

/// Draws a picture where egui paints it.
#[derive(Debug)]
pub struct ViewportCallback {
    /// What to draw.
    pub picture: Picture,
}

impl CallbackTrait for ViewportCallback {
    fn prepare(
        &self,
        _device: &wgpu::Device,
        _queue: &wgpu::Queue,
        _screen: &ScreenDescriptor,
        encoder: &mut wgpu::CommandEncoder,
        resources: &mut CallbackResources,
    ) -> Vec<wgpu::CommandBuffer> {
        if let Some(renderer) = resources.get_mut::<Renderer>() {
            renderer.prepare(encoder, &self.picture);
        }
        Vec::new()
    }

    fn paint(
        &self,
        _info: egui::PaintCallbackInfo,
        pass: &mut wgpu::RenderPass<'static>,
        resources: &CallbackResources,
    ) {
        if let Some(renderer) = resources.get::<Renderer>() {
            renderer.composite.draw(pass, &renderer.frame);
        }
    }
}
