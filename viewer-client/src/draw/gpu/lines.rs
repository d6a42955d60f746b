//! Polylines on the graphics card: pages of paths, and drawing aids.

use shaders::{LINES, LinePoint};
use wgpu::util::DeviceExt as _;

use super::pages::{PageRange, Pages};
use super::pipeline::{FrameGroup, Ink, Recipe, attributes, module};
use super::progress::{Crossing, Layer};

const STRIDE: u64 = size_of::<LinePoint>() as u64;

/// One pipeline a layer.
#[derive(Debug)]
struct Pipelines {
    visible: wgpu::RenderPipeline,
    hidden: wgpu::RenderPipeline,
    dots: wgpu::RenderPipeline,
}

/// All polylines and their pipelines.
#[derive(Debug)]
pub(super) struct Lines {
    /// The newest on top.
    stacked: Pipelines,
    /// In any order.
    weighed: Pipelines,
    aids: Option<(wgpu::Buffer, usize)>,
}

/// Binds the points of a buffer from `first` on, and answers how many of `points` they are. Offsets
/// stand in for a first instance, which WebGL 2 does not have.
fn bind(
    pass: &mut wgpu::RenderPass<'_>,
    buffer: &wgpu::Buffer,
    points: usize,
    first: usize,
) -> u32 {
    let start = first as u64 * STRIDE;
    if first >= points {
        return 0;
    }
    pass.set_vertex_buffer(0, buffer.slice(start..));
    pass.set_vertex_buffer(1, buffer.slice(start + STRIDE..));
    (points - first) as u32
}

impl Lines {
    pub(super) fn new(device: &wgpu::Device, frame: &FrameGroup) -> Self {
        let module = module(device, LINES);
        let count = LinePoint::ATTRIBUTES.len() as u32;
        let (a, b) =
            (attributes(&LinePoint::ATTRIBUTES, 0), attributes(&LinePoint::ATTRIBUTES, count));
        let layout = |attributes| {
            Some(wgpu::VertexBufferLayout {
                array_stride: STRIDE,
                step_mode: wgpu::VertexStepMode::Instance,
                attributes,
            })
        };
        let buffers = [layout(&a), layout(&b)];
        let build = |label, vertex, depth, (ink, fragment)| {
            let recipe = Recipe {
                label,
                module: &module,
                vertex,
                fragment,
                buffers: &buffers,
                topology: wgpu::PrimitiveTopology::TriangleStrip,
                depth,
                ink,
                extra: None,
            };
            recipe.build(device, frame)
        };
        let pipelines = |ink| Pipelines {
            visible: build("lines", "vs_line", wgpu::CompareFunction::GreaterEqual, ink),
            hidden: build("hidden lines", "vs_line_hidden", wgpu::CompareFunction::Less, ink),
            dots: build("dots", "vs_dot", wgpu::CompareFunction::GreaterEqual, ink),
        };
        Self {
            stacked: pipelines((Ink::Over, "fs_stroke")),
            weighed: pipelines((Ink::Weighed, "fs_weighed")),
            aids: None,
        }
    }

    pub(super) fn set_aids(&mut self, device: &wgpu::Device, points: &[LinePoint]) {
        let mut padded = points.to_vec();
        padded.push(LinePoint::default());
        let buffer = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("drawing aids"),
            contents: bytemuck::cast_slice(&padded),
            usage: wgpu::BufferUsages::VERTEX,
        });
        self.aids = (!points.is_empty()).then_some((buffer, points.len()));
    }

    pub(super) fn draw_aids(&self, pass: &mut wgpu::RenderPass<'_>) {
        let Some((buffer, points)) = &self.aids else { return };
        pass.set_pipeline(&self.stacked.visible);
        let points = bind(pass, buffer, *points, 0);
        pass.draw(0..4, 0..points.saturating_sub(1));
    }

    /// Draws one layer of the points of a page from `range` on.
    pub(super) fn draw_page(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        pages: &Pages,
        layer: Layer,
        range: PageRange,
        crossing: Crossing,
    ) {
        let Some((buffer, points)) = pages.on_card(range.serial) else { return };
        let pipelines = match crossing {
            Crossing::Stacked => &self.stacked,
            Crossing::Weighed => &self.weighed,
        };
        let (pipeline, less) = match layer {
            Layer::Hidden => (&pipelines.hidden, 1),
            Layer::Visible => (&pipelines.visible, 1),
            Layer::Dots => (&pipelines.dots, 0),
        };
        let points = bind(pass, buffer, points, range.first);
        if points > less {
            pass.set_pipeline(pipeline);
            pass.draw(0..4, 0..points - less);
        }
    }
}
