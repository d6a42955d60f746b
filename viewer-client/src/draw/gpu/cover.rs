//! Textures read texel by texel, and laid over the whole picture.

use super::pipeline::{FrameGroup, Ink, Recipe};

/// A pipeline that covers the picture, and the textures that it reads in group 1.
#[derive(Debug)]
pub(super) struct Cover {
    pipeline: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
    label: &'static str,
}

/// The two shaders of a pipeline.
#[derive(Clone, Copy, Debug)]
pub(super) struct Program<'a> {
    pub(super) module: &'a wgpu::ShaderModule,
    pub(super) vertex: &'static str,
    pub(super) fragment: &'static str,
}

impl Cover {
    /// With a vertex and a fragment shader of a module, the latter of which reads so many `textures`.
    pub(super) fn new(
        device: &wgpu::Device,
        frame: &FrameGroup,
        label: &'static str,
        program: Program<'_>,
        ink: Ink,
        textures: u32,
    ) -> Self {
        let layout = layout(device, label, textures);
        let Program { module, vertex, fragment } = program;
        let recipe = Recipe {
            label,
            module,
            vertex,
            fragment,
            buffers: &[],
            topology: wgpu::PrimitiveTopology::TriangleList,
            depth: wgpu::CompareFunction::Always,
            ink,
            extra: Some(&layout),
        };
        Self { pipeline: recipe.build(device, frame), layout, label }
    }

    /// Covers the picture with what `textures` hold.
    pub(super) fn draw(
        &self,
        device: &wgpu::Device,
        pass: &mut wgpu::RenderPass<'_>,
        textures: &[&wgpu::TextureView],
    ) {
        let entry = |(binding, view)| wgpu::BindGroupEntry {
            binding,
            resource: wgpu::BindingResource::TextureView(view),
        };
        let entries: Vec<_> = (0..).zip(textures.iter().copied()).map(entry).collect();
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(self.label),
            layout: &self.layout,
            entries: &entries,
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(1, &group, &[]);
        pass.draw(0..3, 0..1);
    }
}

fn layout(device: &wgpu::Device, label: &str, textures: u32) -> wgpu::BindGroupLayout {
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
    let entries: Vec<_> = (0..textures).map(entry).collect();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(label),
        entries: &entries,
    })
}
