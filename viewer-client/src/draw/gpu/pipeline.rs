//! What all pipelines share.

use shaders::{Attribute, AttributeFormat, FrameUniforms, Shader};
use wgpu::util::DeviceExt as _;

use super::target::{COLOR_FORMAT, DEPTH_FORMAT, WEIGHT_FORMAT};

/// The uniforms of a picture, in group 0 of every pipeline.
#[derive(Debug)]
pub(super) struct FrameGroup {
    buffer: wgpu::Buffer,
    pub(super) layout: wgpu::BindGroupLayout,
    pub(super) group: wgpu::BindGroup,
    /// Samples a pixel of the picture.
    pub(super) samples: u32,
}

impl FrameGroup {
    pub(super) fn new(device: &wgpu::Device, samples: u32) -> Self {
        let zeroed: FrameUniforms = bytemuck::Zeroable::zeroed();
        let buffer = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("frame uniforms"),
            contents: bytemuck::bytes_of(&zeroed),
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        });
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("frame"),
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: false,
                    min_binding_size: wgpu::BufferSize::new(size_of::<FrameUniforms>() as u64),
                },
                count: None,
            }],
        });
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("frame"),
            layout: &layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() }],
        });
        Self { buffer, layout, group, samples }
    }

    pub(super) fn write(&self, queue: &wgpu::Queue, uniforms: &FrameUniforms) {
        queue.write_buffer(&self.buffer, 0, bytemuck::bytes_of(uniforms));
    }
}

/// Compiles a module.
pub(super) fn module(device: &wgpu::Device, shader: Shader) -> wgpu::ShaderModule {
    device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(shader.name),
        source: wgpu::ShaderSource::Wgsl(shader.source.into()),
    })
}

/// How a struct of the shaders crate is read, from `location` on.
pub(super) fn attributes(list: &[Attribute], location: u32) -> Vec<wgpu::VertexAttribute> {
    let format = |format| match format {
        AttributeFormat::Float32x2 => wgpu::VertexFormat::Float32x2,
        AttributeFormat::Float32x3 => wgpu::VertexFormat::Float32x3,
        AttributeFormat::Unorm8x4 => wgpu::VertexFormat::Unorm8x4,
        AttributeFormat::Snorm16x4 => wgpu::VertexFormat::Snorm16x4,
        AttributeFormat::Uint8x4 => wgpu::VertexFormat::Uint8x4,
        AttributeFormat::Uint32 => wgpu::VertexFormat::Uint32,
    };
    let numbered = list.iter().zip(location..);
    numbered
        .map(|(a, shader_location)| wgpu::VertexAttribute {
            format: format(a.format),
            offset: a.offset,
            shader_location,
        })
        .collect()
}

/// What sets one pipeline that draws into the picture apart from the others.
#[derive(Debug)]
pub(super) struct Recipe<'a> {
    pub(super) label: &'static str,
    pub(super) module: &'a wgpu::ShaderModule,
    pub(super) vertex: &'static str,
    pub(super) fragment: &'static str,
    pub(super) buffers: &'a [Option<wgpu::VertexBufferLayout<'a>>],
    pub(super) topology: wgpu::PrimitiveTopology,
    /// Depth is reversed: `Greater` lets pass what is nearer.
    pub(super) depth: wgpu::CompareFunction,
    /// How the new colour is combined with the one already there.
    pub(super) ink: Ink,
    /// What it reads in addition to the uniforms, in group 1.
    pub(super) extra: Option<&'a wgpu::BindGroupLayout>,
}

/// How the new colour is combined with the one already there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ink {
    /// It is replaced, and so is the depth.
    Opaque,
    /// It is covered as far as the new one is opaque.
    Over,
    /// Sums of weighted colours, and of weights, into targets of their own.
    Weighed,
}

impl Ink {
    /// Products of what shines through, beside sums: the same for both targets, since WebGL 2 has
    /// one blending for all.
    const WEIGHED: wgpu::BlendState = wgpu::BlendState {
        color: wgpu::BlendComponent {
            src_factor: wgpu::BlendFactor::One,
            dst_factor: wgpu::BlendFactor::One,
            operation: wgpu::BlendOperation::Add,
        },
        alpha: wgpu::BlendComponent {
            src_factor: wgpu::BlendFactor::Zero,
            dst_factor: wgpu::BlendFactor::OneMinusSrcAlpha,
            operation: wgpu::BlendOperation::Add,
        },
    };

    fn targets(self) -> Vec<Option<wgpu::ColorTargetState>> {
        let over = wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING;
        let write_mask = wgpu::ColorWrites::ALL;
        let target = |format, blend| Some(wgpu::ColorTargetState { format, blend, write_mask });
        match self {
            Self::Opaque => vec![target(COLOR_FORMAT, None)],
            Self::Over => vec![target(COLOR_FORMAT, Some(over))],
            Self::Weighed => vec![
                target(COLOR_FORMAT, Some(Self::WEIGHED)),
                target(WEIGHT_FORMAT, Some(Self::WEIGHED)),
            ],
        }
    }
}

impl Recipe<'_> {
    pub(super) fn build(&self, device: &wgpu::Device, frame: &FrameGroup) -> wgpu::RenderPipeline {
        let both = [Some(&frame.layout), self.extra];
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(self.label),
            bind_group_layouts: match &self.extra {
                Some(_) => &both,
                None => &both[..1],
            },
            immediate_size: 0,
        });
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(self.label),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: self.module,
                entry_point: Some(self.vertex),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: self.buffers,
            },
            primitive: wgpu::PrimitiveState {
                topology: self.topology,
                ..wgpu::PrimitiveState::default()
            },
            depth_stencil: Some(wgpu::DepthStencilState {
                format: DEPTH_FORMAT,
                depth_write_enabled: Some(self.ink == Ink::Opaque),
                depth_compare: Some(self.depth),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            multisample: wgpu::MultisampleState {
                count: frame.samples,
                ..wgpu::MultisampleState::default()
            },
            fragment: Some(wgpu::FragmentState {
                module: self.module,
                entry_point: Some(self.fragment),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &self.ink.targets(),
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

/// A group of one texture of colours and its sampler, for fragments.
pub(super) fn sampled_layout(
    device: &wgpu::Device,
    label: &str,
    view_dimension: wgpu::TextureViewDimension,
) -> wgpu::BindGroupLayout {
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty,
        count: None,
    };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(label),
        entries: &[
            entry(
                0,
                wgpu::BindingType::Texture {
                    sample_type: wgpu::TextureSampleType::Float { filterable: true },
                    view_dimension,
                    multisampled: false,
                },
            ),
            entry(1, wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering)),
        ],
    })
}
