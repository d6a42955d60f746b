//! The textures that the picture is drawn into.

use super::progress::Crossing;

/// Half floats, so that light adds up beyond white before it is softened.
pub(super) const COLOR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Sums of weights.
pub(super) const WEIGHT_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R16Float;
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
    color: Layer,
    depth: wgpu::TextureView,
    sums: Option<Sums>,
}

/// A texture that is drawn into.
#[derive(Debug)]
pub(super) struct Layer {
    /// With several samples a pixel, where there are several.
    samples: Option<wgpu::TextureView>,
    /// What is read in the end.
    pub(super) resolved: wgpu::TextureView,
}

/// Where paths are added up that are weighed against each other.
#[derive(Debug)]
pub(super) struct Sums {
    /// Of weighted colours, and products of what shines through.
    pub(super) color: Layer,
    /// Of weights.
    pub(super) weight: Layer,
}

impl Target {
    pub(super) fn new(
        device: &wgpu::Device,
        size: [u32; 2],
        samples: u32,
        crossing: Crossing,
    ) -> Self {
        let layer = |label, format| Layer::new(device, label, format, size, samples);
        let mut usage = wgpu::TextureUsages::RENDER_ATTACHMENT;
        if samples == 1 {
            // The processor, too, needs to know what surfaces hide.
            usage |= wgpu::TextureUsages::COPY_SRC;
        }
        Self {
            color: layer("picture", COLOR_FORMAT),
            depth: view(device, "picture depth", DEPTH_FORMAT, size, samples, usage),
            sums: (crossing == Crossing::Weighed).then(|| Sums {
                color: layer("sum of colours", COLOR_FORMAT),
                weight: layer("sum of weights", WEIGHT_FORMAT),
            }),
        }
    }

    /// The finished picture.
    pub(super) fn resolved(&self) -> &wgpu::TextureView {
        &self.color.resolved
    }

    /// How near everything is, where a pixel has one sample.
    pub(super) fn depth(&self) -> &wgpu::Texture {
        self.depth.texture()
    }

    /// Where paths are added up, if they are.
    pub(super) fn sums(&self) -> Option<&Sums> {
        self.sums.as_ref()
    }

    /// Begins a pass that draws a part of the picture.
    pub(super) fn begin<'a>(
        &self,
        encoder: &'a mut wgpu::CommandEncoder,
        part: Part,
    ) -> wgpu::RenderPass<'a> {
        let attachment = self.color.attachment(part, wgpu::Color::TRANSPARENT);
        self.pass(encoder, "picture", &[Some(attachment)], part)
    }

    /// Begins a pass that adds up paths among the surfaces that are there.
    pub(super) fn begin_sums<'a>(
        &self,
        encoder: &'a mut wgpu::CommandEncoder,
        sums: &Sums,
        part: Part,
    ) -> wgpu::RenderPass<'a> {
        // Nothing is added yet, and everything shines through.
        let color = sums.color.attachment(part, wgpu::Color::BLACK);
        let weight = sums.weight.attachment(part, wgpu::Color::BLACK);
        // The picture goes on after them.
        let part = Part { first: false, last: false };
        self.pass(encoder, "sums", &[Some(color), Some(weight)], part)
    }

    fn pass<'a>(
        &self,
        encoder: &'a mut wgpu::CommandEncoder,
        label: &'static str,
        attachments: &[Option<wgpu::RenderPassColorAttachment<'_>>],
        part: Part,
    ) -> wgpu::RenderPass<'a> {
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(label),
            color_attachments: attachments,
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.depth,
                depth_ops: Some(wgpu::Operations {
                    load: if part.first { wgpu::LoadOp::Clear(0.0) } else { wgpu::LoadOp::Load },
                    store: if part.last { wgpu::StoreOp::Discard } else { wgpu::StoreOp::Store },
                }),
                stencil_ops: None,
            }),
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        })
    }
}

impl Layer {
    fn new(
        device: &wgpu::Device,
        label: &'static str,
        format: wgpu::TextureFormat,
        size: [u32; 2],
        samples: u32,
    ) -> Self {
        let drawn = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let read = drawn | wgpu::TextureUsages::TEXTURE_BINDING;
        Self {
            samples: (samples > 1).then(|| view(device, label, format, size, samples, drawn)),
            resolved: view(device, label, format, size, 1, read),
        }
    }

    fn attachment(&self, part: Part, nothing: wgpu::Color) -> wgpu::RenderPassColorAttachment<'_> {
        let kept = if part.last { wgpu::StoreOp::Discard } else { wgpu::StoreOp::Store };
        let (view, resolve_target, store) = match &self.samples {
            Some(samples) => (samples, Some(&self.resolved), kept),
            None => (&self.resolved, None, wgpu::StoreOp::Store),
        };
        let load = if part.first { wgpu::LoadOp::Clear(nothing) } else { wgpu::LoadOp::Load };
        wgpu::RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target,
            ops: wgpu::Operations { load, store },
        }
    }
}

fn view(
    device: &wgpu::Device,
    label: &'static str,
    format: wgpu::TextureFormat,
    size: [u32; 2],
    sample_count: u32,
    usage: wgpu::TextureUsages,
) -> wgpu::TextureView {
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
}
