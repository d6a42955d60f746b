//! The textures that the picture is drawn into.

/// Half floats, so that light adds up beyond white before it is softened.
pub(super) const COLOR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Reversed depth needs floats.
pub(super) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Which part of a picture a pass draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Part {
    /// The picture begins: nothing in it yet, at infinity.
    pub(super) first: bool,
    /// The picture is done: only its colours are kept.
    pub(super) last: bool,
}

/// A picture of one size.
#[derive(Debug)]
pub(super) struct Target {
    /// The picture with several samples a pixel, where there are several.
    samples: Option<wgpu::TextureView>,
    depth: wgpu::TextureView,
    /// The finished picture.
    pub(super) resolved: wgpu::TextureView,
}

impl Target {
    pub(super) fn new(device: &wgpu::Device, size: [u32; 2], samples: u32) -> Self {
        let attachment = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let view = |label, format, sample_count, usage| {
            let texture = device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage,
                view_formats: &[],
            });
            texture.create_view(&wgpu::TextureViewDescriptor::default())
        };
        Self {
            samples: (samples > 1)
                .then(|| view("picture samples", COLOR_FORMAT, samples, attachment)),
            depth: view("picture depth", DEPTH_FORMAT, samples, attachment),
            resolved: view(
                "picture",
                COLOR_FORMAT,
                1,
                attachment | wgpu::TextureUsages::TEXTURE_BINDING,
            ),
        }
    }

    /// Begins a pass that draws a part of the picture.
    pub(super) fn begin<'a>(
        &self,
        encoder: &'a mut wgpu::CommandEncoder,
        part: Part,
    ) -> wgpu::RenderPass<'a> {
        let kept = if part.last { wgpu::StoreOp::Discard } else { wgpu::StoreOp::Store };
        let (view, resolve_target, store) = match &self.samples {
            Some(samples) => (samples, Some(&self.resolved), kept),
            None => (&self.resolved, None, wgpu::StoreOp::Store),
        };
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("picture"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target,
                ops: wgpu::Operations {
                    load: if part.first {
                        wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT)
                    } else {
                        wgpu::LoadOp::Load
                    },
                    store,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.depth,
                depth_ops: Some(wgpu::Operations {
                    load: if part.first { wgpu::LoadOp::Clear(0.0) } else { wgpu::LoadOp::Load },
                    store: kept,
                }),
                stencil_ops: None,
            }),
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        })
    }
}
