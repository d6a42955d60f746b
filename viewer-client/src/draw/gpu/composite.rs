//! The finished picture into the window.

use shaders::COMPOSITE;

use super::pipeline::{FrameGroup, module, sampled_layout};

/// The pipeline and the texture it reads.
#[derive(Debug)]
pub(super) struct Composite {
    pipeline: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
    sampler: wgpu::Sampler,
    group: Option<wgpu::BindGroup>,
}

impl Composite {
    /// For windows of `format`.
    pub(super) fn new(
        device: &wgpu::Device,
        frame: &FrameGroup,
        format: wgpu::TextureFormat,
    ) -> Self {
        let module = module(device, COMPOSITE);
        let layout = sampled_layout(device, "picture", wgpu::TextureViewDimension::D2);
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("composite"),
            bind_group_layouts: &[Some(&frame.layout), Some(&layout)],
            immediate_size: 0,
        });
        let fragment = if format.is_srgb() { "fs_linear" } else { "fs_encoded" };
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("composite"),
            layout: Some(&pipeline_layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vs_composite"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: None,
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some(fragment),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &[Some(format.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("picture"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..wgpu::SamplerDescriptor::default()
        });
        Self { pipeline, layout, sampler, group: None }
    }

    /// Reads from `picture` from now on.
    pub(super) fn set_picture(&mut self, device: &wgpu::Device, picture: &wgpu::TextureView) {
        self.group = Some(device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("picture"),
            layout: &self.layout,
            entries: &[
                wgpu::BindGroupEntry {
                    binding: 0,
                    resource: wgpu::BindingResource::TextureView(picture),
                },
                wgpu::BindGroupEntry {
                    binding: 1,
                    resource: wgpu::BindingResource::Sampler(&self.sampler),
                },
            ],
        }));
    }

    pub(super) fn draw(&self, pass: &mut wgpu::RenderPass<'_>, frame: &FrameGroup) {
        let Some(group) = &self.group else { return };
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &frame.group, &[]);
        pass.set_bind_group(1, group, &[]);
        pass.draw(0..3, 0..1);
    }
}
