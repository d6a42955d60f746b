//! Paths that were added up, laid over the surfaces [McGuire and Bavoil 2013].

use shaders::BLEND;

use super::cover::Cover;
use super::pipeline::{FrameGroup, Ink, module};
use super::target::Sums;

/// What lays the sums over the surfaces.
#[derive(Debug)]
pub(super) struct Blend(Cover);

impl Blend {
    pub(super) fn new(device: &wgpu::Device, frame: &FrameGroup) -> Self {
        let module = module(device, BLEND);
        let shaders = (&module, "vs_blend", "fs_blend");
        Self(Cover::new(device, frame, "blend", shaders, Ink::Over, 2))
    }

    /// Draws the sums over what is there.
    pub(super) fn draw(&self, device: &wgpu::Device, pass: &mut wgpu::RenderPass<'_>, sums: &Sums) {
        self.0.draw(device, pass, &[&sums.color.resolved, &sums.weight.resolved]);
    }
}
