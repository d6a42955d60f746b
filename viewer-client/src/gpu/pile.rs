//! Paths in many sheets, the newest on top: where the upper sheets let nothing through, the lower ones
//! cost next to nothing.
//!
//! Laying a sheet *under* those that are there gives the same picture as laying those *over* it
//! [Porter and Duff 1984], but the newest paths come first, and pixels that they fill are shut by the
//! depth buffer for all older ones.

use shaders::PILE;

use super::cover::Cover;
use super::pipeline::{FrameGroup, Ink, module};
use super::target::Pile;

/// What lays sheets and piles.
#[derive(Debug)]
pub(super) struct Piling {
    under: Cover,
    over: Cover,
    shut: Cover,
}

impl Piling {
    pub(super) fn new(device: &wgpu::Device, frame: &FrameGroup) -> Self {
        let module = module(device, PILE);
        let cover = |label, (vertex, fragment), ink| {
            Cover::new(device, frame, label, (&module, vertex, fragment), ink, 1)
        };
        Self {
            under: cover("under", ("vs_pile", "fs_sheet"), Ink::Under),
            over: cover("over", ("vs_pile", "fs_pile"), Ink::Over),
            shut: cover("shut", ("vs_near", "fs_saturated"), Ink::Opaque),
        }
    }

    /// Shuts the pixels of an empty sheet that nothing under `pile` would be seen in.
    pub(super) fn shut(&self, device: &wgpu::Device, pass: &mut wgpu::RenderPass<'_>, pile: &Pile) {
        self.shut.draw(device, pass, &[&pile.whole.resolved]);
    }

    /// Lays the sheet under the pile that `pass` draws into.
    pub(super) fn under(
        &self,
        device: &wgpu::Device,
        pass: &mut wgpu::RenderPass<'_>,
        pile: &Pile,
    ) {
        self.under.draw(device, pass, &[&pile.sheet.resolved]);
    }

    /// Lays the pile over what `pass` has drawn.
    pub(super) fn over(&self, device: &wgpu::Device, pass: &mut wgpu::RenderPass<'_>, pile: &Pile) {
        self.over.draw(device, pass, &[&pile.whole.resolved]);
    }
}
