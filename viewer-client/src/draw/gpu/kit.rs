//! What pictures are drawn with.

use shaders::LinePoint;

use super::blend::Blend;
use super::lines::Lines;
use super::mesh::Mesh;
use super::pages::{Draws, PageRange, Pages};
use super::pipeline::FrameGroup;
use super::progress::{Crossing, Layer, Picture};
use super::target::{Part, Target};

/// The scene, its paths and their pipelines.
#[derive(Debug)]
pub(super) struct Kit {
    pub(super) device: wgpu::Device,
    pub(super) queue: wgpu::Queue,
    pub(super) frame: FrameGroup,
    pub(super) mesh: Mesh,
    pub(super) pages: Pages,
    lines: Lines,
    blend: Blend,
}

impl Kit {
    /// For pictures of so many samples a pixel, and pages of `page_points` points.
    pub(super) fn new(
        device: wgpu::Device,
        queue: wgpu::Queue,
        samples: u32,
        draws: Draws,
        page_points: usize,
    ) -> Self {
        let frame = FrameGroup::new(&device, samples);
        Self {
            mesh: Mesh::new(&device, &queue, &frame),
            pages: Pages::new(draws, page_points),
            lines: Lines::new(&device, &frame),
            blend: Blend::new(&device, &frame),
            frame,
            device,
            queue,
        }
    }

    pub(super) fn set_aids(&mut self, points: &[LinePoint]) {
        self.lines.set_aids(&self.device, points);
    }

    pub(super) fn new_target(&self, picture: &Picture) -> Target {
        Target::new(&self.device, picture.size, self.frame.samples, picture.crossing)
    }

    /// Lays paths over what `pass` has drawn, and over them what lies there. Their colours are times
    /// their opacity.
    pub(super) fn lay_over(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        paths: &wgpu::TextureView,
        picture: &Picture,
    ) {
        self.blend.draw_sheet(&self.device, pass, paths);
        self.end(pass, picture);
    }

    /// Draws a part of a picture: what lies under the paths, these steps of the paths, and what lies
    /// over them.
    pub(super) fn draw(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        target: &Target,
        picture: &Picture,
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
            self.blend.draw_sums(&self.device, &mut pass, sums);
            self.end(&mut pass, picture);
        }
    }

    fn draw_steps(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        steps: &[(Layer, PageRange)],
        crossing: Crossing,
    ) {
        for &(layer, range) in steps {
            self.lines.draw_page(pass, &self.pages, layer, range, crossing);
        }
    }

    /// What lies under the paths.
    pub(super) fn begin(&self, pass: &mut wgpu::RenderPass<'_>, picture: &Picture) {
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
