//! Everything on the graphics card, and the order in which it is drawn.

use std::time::Instant;

use common::TexturePreview;
use egui_wgpu::{CallbackResources, CallbackTrait, ScreenDescriptor};
use shaders::{LinePoint, MeshVertex};

use super::blend::Blend;
use super::composite::Composite;
use super::lines::{Layer, Lines, PageRange, Uploaded};
use super::mesh::Mesh;
use super::pile::Piling;
use super::pipeline::FrameGroup;
use super::progress::{Allowance, Crossing, Picture};
use super::target::{Part, Target};

/// Points of paths after which a sheet is laid under the pile.
const SHEET_POINTS: usize = 1 << 16;

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
    blend: Blend,
    piling: Piling,
    composite: Composite,
    /// What the window shows.
    shown: Option<Shown>,
    /// What takes its place when it is done.
    coming: Option<Coming>,
    allowance: Allowance,
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
struct Coming {
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
        let (samples, points) = match quality {
            Quality::Smooth => (4, 1 << 20),
            Quality::Fast => (1, 1 << 15),
        };
        let frame = FrameGroup::new(&device, samples);
        Self {
            mesh: Mesh::new(&device, &queue, &frame),
            blend: Blend::new(&device, &frame),
            piling: Piling::new(&device, &frame),
            lines: Lines::new(&device, &frame, page_points),
            composite: Composite::new(&device, &frame, format),
            frame,
            shown: None,
            coming: None,
            allowance: Allowance::new(points),
            content: 0,
            uploading: false,
            device,
            queue,
        }
    }

    /// Replaces all surfaces and their textures.
    pub fn set_mesh(&mut self, corners: &[MeshVertex], textures: &[TexturePreview]) {
        self.mesh.set(&self.device, corners);
        self.mesh.set_textures(&self.device, &self.queue, textures);
        self.content += 1;
    }

    /// Replaces the drawing aids.
    pub fn set_aids(&mut self, points: &[LinePoint]) {
        self.lines.set_aids(&self.device, points);
        self.content += 1;
    }

    /// What of a page is here already.
    pub fn uploaded(&self, serial: u64) -> Option<Uploaded> {
        self.lines.uploaded(serial)
    }

    /// Appends points to a page, or replaces them when the page has another revision.
    pub fn append_points(&mut self, serial: u64, uploaded: Uploaded, points: &[LinePoint]) {
        self.lines.append(&self.device, &self.queue, serial, uploaded, points);
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
        self.coming.is_some() || self.shown.as_ref().is_some_and(|shown| !shown.whole)
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
        let up_to_date = self.shown.as_ref().is_some_and(|shown| {
            shown.whole && shown.content == self.content && shown.picture == *picture
        });
        if up_to_date {
            self.coming = None;
            self.allowance.rest();
            return;
        }
        self.allowance.tick(Instant::now());
        if picture.cost(&self.lines) <= self.allowance.points() {
            self.coming = None;
            self.draw_at_once(encoder, picture, picture, true);
            return;
        }
        let seen = self.shown.as_ref().is_some_and(|shown| shown.picture.same_view(picture));
        if !seen {
            self.coming = None;
            let glance = picture.glance(&self.lines, self.allowance.points());
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
            _ => self.new_target(picture),
        };
        self.composite.set_picture(&self.device, target.resolved());
        self.frame.write(&self.queue, &drawn.uniforms);
        self.draw(encoder, (&target, drawn), &drawn.steps(), Part { first: true, last: true });
        let (picture, content) = (picture.clone(), self.content);
        self.shown = Some(Shown { target, picture, content, whole });
    }

    /// Draws the next part of the coming picture, which is `wanted` or one that differs only by the
    /// paths that have come since it was begun.
    fn go_on(&mut self, encoder: &mut wgpu::CommandEncoder, wanted: &Picture) {
        let coming = self.coming.take().filter(|coming| coming.picture.same_view(wanted));
        let mut coming = coming.unwrap_or_else(|| Coming {
            target: self.new_target_in_parts(wanted),
            picture: wanted.clone(),
            content: self.content,
            steps: wanted.steps_in_parts(),
            next: 0,
        });
        self.frame.write(&self.queue, &coming.picture.uniforms);
        let mut end = coming.next;
        let mut room = self.allowance.points();
        while let Some((_, range)) = coming.steps.get(end).filter(|_| room > 0) {
            room = room.saturating_sub(self.lines.points_of(*range));
            end += 1;
        }
        let part = Part { first: coming.next == 0, last: end == coming.steps.len() };
        let steps = coming.steps.get(coming.next..end).unwrap_or_default();
        match wanted.crossing {
            Crossing::Stacked => {
                self.pile_up(encoder, (&coming.target, &coming.picture), steps, part);
            }
            Crossing::Weighed => {
                self.draw(encoder, (&coming.target, &coming.picture), steps, part);
            }
        }
        coming.next = end;
        if part.last {
            let Coming { target, picture, content, .. } = coming;
            self.composite.set_picture(&self.device, target.resolved());
            let target = target.without_pile();
            self.shown = Some(Shown { target, picture, content, whole: true });
        } else {
            self.coming = Some(coming);
        }
    }

    fn new_target(&self, picture: &Picture) -> Target {
        Target::new(&self.device, picture.size, self.frame.samples, picture.crossing)
    }

    /// Where a picture is drawn that takes several frames.
    fn new_target_in_parts(&self, picture: &Picture) -> Target {
        let target = self.new_target(picture);
        match picture.crossing {
            Crossing::Stacked => target.with_pile(&self.device, picture.size, self.frame.samples),
            Crossing::Weighed => target,
        }
    }

    /// Draws a part of a picture of several frames: these steps, the topmost first, as sheets under
    /// those that are there; and at last the pile between what lies under and over the paths.
    fn pile_up(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        (target, picture): (&Target, &Picture),
        steps: &[(Layer, PageRange)],
        part: Part,
    ) {
        let Some(pile) = target.pile() else { return };
        if part.first {
            // For their depth: surfaces hide paths.
            let mut pass = target.begin(encoder, Part { first: true, last: false });
            pass.set_bind_group(0, &self.frame.group, &[]);
            self.begin(&mut pass, picture);
        }
        let mut first = part.first;
        for sheet in self.sheets(steps) {
            let mut pass = target.begin_sheet(encoder, pile);
            pass.set_bind_group(0, &self.frame.group, &[]);
            if !first {
                self.piling.shut(&self.device, &mut pass, pile);
            }
            for (layer, range) in sheet.iter().rev() {
                self.lines.draw_page(&mut pass, *range, *layer, Crossing::Stacked);
            }
            drop(pass);
            let mut pass = target.begin_pile(encoder, pile, first);
            pass.set_bind_group(0, &self.frame.group, &[]);
            self.piling.under(&self.device, &mut pass, pile);
            first = false;
        }
        if part.last {
            let mut pass = target.begin(encoder, Part { first: true, last: true });
            pass.set_bind_group(0, &self.frame.group, &[]);
            self.begin(&mut pass, picture);
            self.piling.over(&self.device, &mut pass, pile);
            self.end(&mut pass, picture);
        }
    }

    /// Steps that share a sheet: few enough for the next ones to profit from what they fill.
    fn sheets<'a>(
        &'a self,
        steps: &'a [(Layer, PageRange)],
    ) -> impl Iterator<Item = &'a [(Layer, PageRange)]> {
        let mut rest = steps;
        std::iter::from_fn(move || {
            let mut points = 0;
            let fits = |(_, range): &&(Layer, PageRange)| {
                let room = points < SHEET_POINTS;
                points += self.lines.points_of(*range);
                room
            };
            let (sheet, others) = rest.split_at(rest.iter().take_while(fits).count());
            rest = others;
            (!sheet.is_empty()).then_some(sheet)
        })
    }

    /// Draws a part of a picture: what lies under the paths, these steps of the paths, and what lies
    /// over them.
    fn draw(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        (target, picture): (&Target, &Picture),
        steps: &[(Layer, PageRange)],
        part: Part,
    ) {
        let Some(sums) = target.sums() else {
            let mut pass = target.begin(encoder, part);
            pass.set_bind_group(0, &self.frame.group, &[]);
            if part.first {
                self.begin(&mut pass, picture);
            }
            self.draw_steps(&mut pass, steps, Crossing::Stacked);
            if part.last {
                self.end(&mut pass, picture);
            }
            return;
        };
        if part.first {
            let mut pass = target.begin(encoder, Part { last: false, ..part });
            pass.set_bind_group(0, &self.frame.group, &[]);
            self.begin(&mut pass, picture);
        }
        let mut pass = target.begin_sums(encoder, sums, part);
        pass.set_bind_group(0, &self.frame.group, &[]);
        self.draw_steps(&mut pass, steps, Crossing::Weighed);
        drop(pass);
        if part.last {
            let mut pass = target.begin(encoder, Part { first: false, ..part });
            pass.set_bind_group(0, &self.frame.group, &[]);
            self.blend.draw(&self.device, &mut pass, sums);
            self.end(&mut pass, picture);
        }
    }

    fn draw_steps(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        steps: &[(Layer, PageRange)],
        crossing: Crossing,
    ) {
        for (layer, range) in steps {
            self.lines.draw_page(pass, *range, *layer, crossing);
        }
    }

    /// What lies under the paths.
    fn begin(&self, pass: &mut wgpu::RenderPass<'_>, picture: &Picture) {
        if picture.surfaces {
            self.mesh.draw_opaque(pass);
        }
        self.lines.draw_aids(pass);
    }

    /// What lies over them.
    fn end(&self, pass: &mut wgpu::RenderPass<'_>, picture: &Picture) {
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
            renderer.composite.draw(pass, &renderer.frame);
        }
    }
}
