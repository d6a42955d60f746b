//! Paths that were drawn apart from the surfaces, laid over them.

use shaders::BLEND;

use super::cover::{Cover, Program};
use super::pipeline::{FrameGroup, Ink, module};
use super::target::Sums;

/// What lays paths over the surfaces.
#[derive(Debug)]
pub(super) struct Blend {
    sums: Cover,
    sheet: Cover,
}

impl Blend {
    pub(super) fn new(device: &wgpu::Device, frame: &FrameGroup) -> Self {
        let module = module(device, BLEND);
        let cover = |label, fragment, textures| {
            let program = Program { module: &module, vertex: "vs_blend", fragment };
            Cover::new(device, frame, label, program, Ink::Over, textures)
        };
        Self { sums: cover("blend", "fs_blend", 2), sheet: cover("sheet", "fs_sheet", 1) }
    }

    /// Draws sums over what is there [McGuire and Bavoil 2013].
    pub(super) fn draw_sums(
        &self,
        device: &wgpu::Device,
        pass: &mut wgpu::RenderPass<'_>,
        sums: &Sums,
    ) {
        self.sums.draw(device, pass, &[&sums.color.resolved, &sums.weight.resolved]);
    }

    /// Draws colours times their opacity over what is there.
    pub(super) fn draw_sheet(
        &self,
        device: &wgpu::Device,
        pass: &mut wgpu::RenderPass<'_>,
        sheet: &wgpu::TextureView,
    ) {
        self.sheet.draw(device, pass, &[sheet]);
    }
}
