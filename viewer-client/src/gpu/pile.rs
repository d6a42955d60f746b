//! Paths in many sheets, the newest on top: where the upper sheets let nothing through, the lower ones
//! cost next to nothing.
//!
//! Laying a sheet *under* those that are there gives the same picture as laying those *over* it
//! [Porter and Duff 1984], but the newest paths come first, and pixels that they fill are shut by the
//! depth buffer for all older ones.

use shaders::PILE;

use super::pipeline::{FrameGroup, Ink, Recipe, module};
use super::target::Pile;

/// The pipelines, and what they read.
#[derive(Debug)]
pub(super) struct Piling {
    under: wgpu::RenderPipeline,
    over: wgpu::RenderPipeline,
    shut: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
}

impl Piling {
    pub(super) fn new(device: &wgpu::Device, frame: &FrameGroup) -> Self {
        let layout = layout(device);
        let module = module(device, PILE);
        let build = |label, vertex, fragment, ink| {
            let recipe = Recipe {
                label,
                module: &module,
                vertex,
                fragment,
                buffers: &[],
                topology: wgpu::PrimitiveTopology::TriangleList,
                depth: wgpu::CompareFunction::Always,
                ink,
                extra: Some(&layout),
            };
            recipe.build(device, frame)
        };
        Self {
            under: build("under", "vs_pile", "fs_sheet", Ink::Under),
            over: build("over", "vs_pile", "fs_pile", Ink::Over),
            shut: build("shut", "vs_near", "fs_saturated", Ink::Opaque),
            layout,
        }
    }

    /// Shuts the pixels of an empty sheet that nothing under `pile` would be seen in.
    pub(super) fn shut(&self, device: &wgpu::Device, pass: &mut wgpu::RenderPass<'_>, pile: &Pile) {
        self.lay(device, pass, (&self.shut, &pile.whole.resolved));
    }

    /// Lays the sheet under the pile that `pass` draws into.
    pub(super) fn under(
        &self,
        device: &wgpu::Device,
        pass: &mut wgpu::RenderPass<'_>,
        pile: &Pile,
    ) {
        self.lay(device, pass, (&self.under, &pile.sheet.resolved));
    }

    /// Lays the pile over what `pass` has drawn.
    pub(super) fn over(&self, device: &wgpu::Device, pass: &mut wgpu::RenderPass<'_>, pile: &Pile) {
        self.lay(device, pass, (&self.over, &pile.whole.resolved));
    }

    fn lay(
        &self,
        device: &wgpu::Device,
        pass: &mut wgpu::RenderPass<'_>,
        (pipeline, read): (&wgpu::RenderPipeline, &wgpu::TextureView),
    ) {
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("pile"),
            layout: &self.layout,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::TextureView(read),
            }],
        });
        pass.set_pipeline(pipeline);
        pass.set_bind_group(1, &group, &[]);
        pass.draw(0..3, 0..1);
    }
}

fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("pile"),
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty: wgpu::BindingType::Texture {
                sample_type: wgpu::TextureSampleType::Float { filterable: false },
                view_dimension: wgpu::TextureViewDimension::D2,
                multisampled: false,
            },
            count: None,
        }],
    })
}
