//! Paths that were added up, laid over the surfaces [McGuire and Bavoil 2013].

use shaders::BLEND;

use super::pipeline::{FrameGroup, Ink, Recipe, module};
use super::target::Sums;

/// The pipeline, and what it reads.
#[derive(Debug)]
pub(super) struct Blend {
    pipeline: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
}

impl Blend {
    pub(super) fn new(device: &wgpu::Device, frame: &FrameGroup) -> Self {
        let layout = layout(device);
        let recipe = Recipe {
            label: "blend",
            module: &module(device, BLEND),
            vertex: "vs_blend",
            fragment: "fs_blend",
            buffers: &[],
            topology: wgpu::PrimitiveTopology::TriangleList,
            depth: wgpu::CompareFunction::Always,
            ink: Ink::Over,
            extra: Some(&layout),
        };
        Self { pipeline: recipe.build(device, frame), layout }
    }

    /// Draws the sums over what is there.
    pub(super) fn draw(&self, device: &wgpu::Device, pass: &mut wgpu::RenderPass<'_>, sums: &Sums) {
        let entry = |binding, view| wgpu::BindGroupEntry {
            binding,
            resource: wgpu::BindingResource::TextureView(view),
        };
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("sums"),
            layout: &self.layout,
            entries: &[entry(0, &sums.color.resolved), entry(1, &sums.weight.resolved)],
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(1, &group, &[]);
        pass.draw(0..3, 0..1);
    }
}

fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let entry = |binding| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty: wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: false },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        },
        count: None,
    };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("sums"),
        entries: &[entry(0), entry(1)],
    })
}
