//! Everything on the graphics card, and the order in which it is drawn.

use std::time::{Duration, Instant};

use common::TexturePreview;
use egui_wgpu::{CallbackResources, CallbackTrait, ScreenDescriptor};
use shaders::{LinePoint, MeshVertex};

use super::composite::Composite;
use super::kit::Kit;
use super::pages::{Draws, PageRange, Uploaded};
use super::progress::{Allowance, Layer, Picture};
use super::software::{Painted, Software};
use super::target::{Part, Target};

/// How well to draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quality {
    /// Four samples a pixel.
    Smooth,
    /// One, and the processor draws the paths itself: where it stands in for the graphics card anyway.
    Fast,
    /// One, where it stands in for the card and is not told how near surfaces are.
    Plain,
}

/// All buffers, textures and pipelines of the viewport.
#[derive(Debug)]
pub struct Renderer {
    kit: Kit,
    composite: Composite,
    /// What the window shows.
    shown: Option<Shown>,
    /// What takes its place when it is done.
    coming: Option<PictureInProgress>,
    allowance: Allowance,
    /// Where the processor draws the paths.
    software: Option<Software>,
    /// Grows with every upload.
    content: u64,
    /// More of the same is about to be uploaded.
    uploading: bool,
}

/// The picture in the window.
#[derive(Debug)]
struct Shown {
    target: Target,
    picture: Picture,
    content: u64,
    /// It is the whole picture rather than a glance.
    whole: bool,
}

/// A picture that takes several frames.
#[derive(Debug)]
struct PictureInProgress {
    target: Target,
    picture: Picture,
    content: u64,
    steps: Vec<(Layer, PageRange)>,
    next: usize,
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
        let (samples, draws) = match quality {
            Quality::Smooth => (4, Draws::Card),
            Quality::Fast => (1, Draws::Processor),
            Quality::Plain => (1, Draws::Card),
        };
        let kit = Kit::new(device, queue, samples, draws, page_points);
        Self {
            composite: Composite::new(&kit.device, &kit.frame, format),
            kit,
            shown: None,
            coming: None,
            allowance: Allowance::new(if samples == 1 { 1 << 15 } else { 1 << 20 }),
            software: (draws == Draws::Processor).then(Software::default),
            content: 0,
            uploading: false,
        }
    }

    /// Replaces all surfaces and their textures.
    pub fn set_mesh(&mut self, corners: &[MeshVertex], textures: &[TexturePreview]) {
        let Kit { device, queue, mesh, .. } = &mut self.kit;
        mesh.set(device, corners);
        mesh.set_textures(device, queue, textures);
        self.content += 1;
    }

    /// Replaces the drawing aids.
    pub fn set_aids(&mut self, points: &[LinePoint]) {
        self.kit.set_aids(points);
        self.content += 1;
    }

    /// What of a page is here already.
    pub fn uploaded(&self, serial: u64) -> Option<Uploaded> {
        self.kit.pages.uploaded(serial)
    }

    /// Appends points to a page, or replaces them when the page has another revision.
    pub fn append_points(&mut self, serial: u64, uploaded: Uploaded, points: &[LinePoint]) {
        let Kit { device, queue, pages, .. } = &mut self.kit;
        pages.append(device, queue, serial, uploaded, points);
        self.content += 1;
    }

    /// Says whether more of the same is about to be uploaded: until then only a glance is drawn.
    pub fn set_uploading(&mut self, uploading: bool) {
        self.uploading = uploading;
    }

    /// Draws no more than `points` points in the next frame.
    #[cfg(test)]
    pub(crate) fn limit(&mut self, points: usize) {
        self.allowance = Allowance::new(points);
    }

    /// True while the window shows less than what was asked for.
    pub fn is_refining(&self) -> bool {
        self.coming.is_some()
            || self.software.as_ref().is_some_and(Software::is_painting)
            || self.shown.as_ref().is_some_and(|shown| !shown.whole)
    }

    /// How long the processor has drawn in place of the graphics card since this was last asked.
    pub fn take_drawing_time(&mut self) -> Duration {
        self.software.as_mut().map(Software::take_time).unwrap_or_default()
    }

    /// Gives up every page older than `first`.
    pub fn retain_from(&mut self, first: u64) {
        self.kit.pages.retain_from(first);
    }

    /// Bytes of all pages, on the graphics card or not, textures aside.
    pub fn byte_len(&self) -> u64 {
        self.kit.mesh.byte_len() + self.kit.pages.byte_len()
    }

    fn prepare(&mut self, encoder: &mut wgpu::CommandEncoder, picture: &Picture) {
        let up_to_date = self.shown.as_ref().is_some_and(|shown| {
            shown.whole && shown.content == self.content && shown.picture == *picture
        });
        if up_to_date {
            self.coming = None;
            self.allowance.rest();
            if let Some(software) = &mut self.software {
                software.rest();
            }
            return;
        }
        if self.software.is_some() {
            self.paint(encoder, picture);
            return;
        }
        self.allowance.tick(Instant::now());
        if picture.cost(&self.kit.pages) <= self.allowance.points() {
            self.coming = None;
            self.draw_at_once(encoder, picture, picture, true);
            return;
        }
        let seen = self.shown.as_ref().is_some_and(|shown| shown.picture.same_view(picture));
        if !seen {
            self.coming = None;
            let glance = picture.glance(&self.kit.pages, self.allowance.points());
            self.draw_at_once(encoder, &glance, picture, false);
        } else if !self.uploading {
            self.go_on(encoder, picture);
        }
    }

    /// Draws `drawn` in one pass, as what the window shows of `picture`.
    fn draw_at_once(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        drawn: &Picture,
        picture: &Picture,
        whole: bool,
    ) {
        let fits = |shown: &Shown| {
            shown.picture.size == picture.size && shown.picture.crossing == picture.crossing
        };
        let target = match self.shown.take() {
            Some(shown) if fits(&shown) => shown.target,
            _ => self.kit.new_target(picture),
        };
        self.composite.set_picture(&self.kit.device, target.resolved());
        self.kit.frame.write(&self.kit.queue, &drawn.uniforms);
        self.kit.draw(encoder, &target, drawn, &drawn.steps(), Part { first: true, last: true });
        let (picture, content) = (picture.clone(), self.content);
        self.shown = Some(Shown { target, picture, content, whole });
    }

    /// Lets the processor go on with the picture, and shows what there is of it unless the window
    /// shows the same view already.
    fn paint(&mut self, encoder: &mut wgpu::CommandEncoder, wanted: &Picture) {
        let Some(software) = &mut self.software else { return };
        let seen = self.shown.as_ref().is_some_and(|shown| shown.picture.same_view(wanted));
        if seen && self.uploading {
            return;
        }
        let shows_whole = seen && self.shown.as_ref().is_some_and(|shown| shown.whole);
        let fits = |shown: &Shown| shown.picture.size == wanted.size;
        let mut spare = if shows_whole {
            None
        } else {
            self.shown.take().filter(fits).map(|shown| shown.target)
        };
        let whole = software.go_on(&self.kit, wanted, self.content, &mut spare);
        if shows_whole && !whole {
            return;
        }
        let Some(painted) = software.show(&self.kit, encoder, spare) else { return };
        if whole || self.uploading {
            software.rest();
        }
        let Painted { target, picture, content } = painted;
        self.composite.set_picture(&self.kit.device, target.resolved());
        self.shown = Some(Shown { target, picture, content, whole });
    }

    /// Draws the next part of the coming picture, which is `wanted` or one that differs only by the
    /// paths that have come since it was begun.
    fn go_on(&mut self, encoder: &mut wgpu::CommandEncoder, wanted: &Picture) {
        let coming = self.coming.take().filter(|coming| coming.picture.same_view(wanted));
        let mut coming = coming.unwrap_or_else(|| PictureInProgress {
            target: self.kit.new_target(wanted),
            picture: wanted.clone(),
            content: self.content,
            steps: wanted.steps(),
            next: 0,
        });
        self.kit.frame.write(&self.kit.queue, &coming.picture.uniforms);
        let mut end = coming.next;
        let mut room = self.allowance.points();
        while let Some((_, range)) = coming.steps.get(end).filter(|_| room > 0) {
            room = room.saturating_sub(self.kit.pages.points_of(*range));
            end += 1;
        }
        let part = Part { first: coming.next == 0, last: end == coming.steps.len() };
        let steps = coming.steps.get(coming.next..end).unwrap_or_default();
        self.kit.draw(encoder, &coming.target, &coming.picture, steps, part);
        coming.next = end;
        if part.last {
            let PictureInProgress { target, picture, content, .. } = coming;
            self.composite.set_picture(&self.kit.device, target.resolved());
            self.shown = Some(Shown { target, picture, content, whole: true });
        } else {
            self.coming = Some(coming);
        }
    }
}

/// Draws a picture where egui paints it.
#[derive(Debug)]
pub struct ViewportCallback {
    /// What to draw.
    pub picture: Picture,
    /// Told when the picture needs another frame.
    pub ctx: egui::Context,
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
            if renderer.is_refining() {
                self.ctx.request_repaint();
            }
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
            renderer.composite.draw(pass, &renderer.kit.frame);
        }
    }
}
