//! Polylines: pages of paths, and drawing aids.

use std::collections::BTreeMap;

use shaders::{LINES, LinePoint};
use wgpu::util::DeviceExt as _;

use super::pipeline::{FrameGroup, Ink, Recipe, attributes, module};
use super::progress::Crossing;

const STRIDE: u64 = size_of::<LinePoint>() as u64;

/// Which points of a page to draw: from `first` to the last one uploaded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PageRange {
    /// The page.
    pub serial: u64,
    /// Its first point to be drawn, which begins a path.
    pub first: usize,
}

/// How much of a page is on the graphics card.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Uploaded {
    /// Revision of the page that the points are of.
    pub revision: u32,
    /// Paths of the page that were taken in, drawn or not.
    pub paths: usize,
}

#[derive(Debug)]
struct LinePage {
    buffer: wgpu::Buffer,
    points: usize,
    uploaded: Uploaded,
}

impl LinePage {
    /// Binds the points from `first` on, and answers how many they are. Offsets stand in for a first
    /// instance, which WebGL 2 does not have.
    fn bind(&self, pass: &mut wgpu::RenderPass<'_>, first: usize) -> u32 {
        let start = first as u64 * STRIDE;
        if first >= self.points {
            return 0;
        }
        pass.set_vertex_buffer(0, self.buffer.slice(start..));
        pass.set_vertex_buffer(1, self.buffer.slice(start + STRIDE..));
        (self.points - first) as u32
    }
}

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
    pages: BTreeMap<u64, LinePage>,
    /// Buffers of pages that are gone, for the next ones.
    spare: Vec<wgpu::Buffer>,
    page_points: usize,
    aids: Option<LinePage>,
}

impl Lines {
    pub(super) fn new(device: &wgpu::Device, frame: &FrameGroup, page_points: usize) -> Self {
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
            pages: BTreeMap::new(),
            spare: Vec::new(),
            page_points,
            aids: None,
        }
    }

    /// What of a page is here already.
    pub(super) fn uploaded(&self, serial: u64) -> Option<Uploaded> {
        self.pages.get(&serial).map(|page| page.uploaded)
    }

    /// Appends points to a page, or replaces all of them when the page has another revision; what
    /// does not fit is left out.
    pub(super) fn append(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        serial: u64,
        uploaded: Uploaded,
        points: &[LinePoint],
    ) {
        let page = self.pages.entry(serial).or_insert_with(|| {
            let buffer = self.spare.pop().unwrap_or_else(|| {
                device.create_buffer(&wgpu::BufferDescriptor {
                    label: Some("path page"),
                    // One more, because the buffer is also read one point further on.
                    size: (self.page_points as u64 + 1) * STRIDE,
                    usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
                    mapped_at_creation: false,
                })
            });
            LinePage { buffer, points: 0, uploaded }
        });
        if page.uploaded.revision != uploaded.revision {
            page.points = 0;
        }
        page.uploaded = uploaded;
        let room = self.page_points - page.points;
        let points = points.get(..room).unwrap_or(points);
        queue.write_buffer(&page.buffer, page.points as u64 * STRIDE, bytemuck::cast_slice(points));
        page.points += points.len();
    }

    /// Gives up every page older than `first`, and all of them when there is no page any more.
    pub(super) fn retain_from(&mut self, first: u64) {
        let kept = self.pages.split_off(&first);
        let gone = std::mem::replace(&mut self.pages, kept);
        self.spare.extend(gone.into_values().map(|page| page.buffer));
        // A cleared store would otherwise keep its memory for ever.
        self.spare.truncate(self.pages.len().max(1));
    }

    pub(super) fn set_aids(&mut self, device: &wgpu::Device, points: &[LinePoint]) {
        let mut padded = points.to_vec();
        padded.push(LinePoint::default());
        self.aids = (!points.is_empty()).then(|| LinePage {
            buffer: device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some("drawing aids"),
                contents: bytemuck::cast_slice(&padded),
                usage: wgpu::BufferUsages::VERTEX,
            }),
            points: points.len(),
            uploaded: Uploaded::default(),
        });
    }

    /// Bytes on the graphics card.
    pub(super) fn byte_len(&self) -> u64 {
        let buffers = (self.pages.len() + self.spare.len()) as u64;
        buffers * (self.page_points as u64 + 1) * STRIDE
    }

    pub(super) fn draw_aids(&self, pass: &mut wgpu::RenderPass<'_>) {
        let Some(aids) = &self.aids else { return };
        pass.set_pipeline(&self.stacked.visible);
        let points = aids.bind(pass, 0);
        pass.draw(0..4, 0..points.saturating_sub(1));
    }

    /// Draws one layer of the points of a page from `range` on, and answers how many they are.
    pub(super) fn draw_page(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        range: PageRange,
        layer: Layer,
        crossing: Crossing,
    ) -> usize {
        let Some(page) = self.pages.get(&range.serial) else { return 0 };
        let pipelines = match crossing {
            Crossing::Stacked => &self.stacked,
            Crossing::Weighed => &self.weighed,
        };
        let (pipeline, less) = match layer {
            Layer::Hidden => (&pipelines.hidden, 1),
            Layer::Visible => (&pipelines.visible, 1),
            Layer::Dots => (&pipelines.dots, 0),
        };
        let points = page.bind(pass, range.first);
        if points > less {
            pass.set_pipeline(pipeline);
            pass.draw(0..4, 0..points - less);
        }
        points as usize
    }

    /// Points that a range holds on the graphics card.
    pub(super) fn points_of(&self, range: PageRange) -> usize {
        self.pages.get(&range.serial).map_or(0, |page| page.points.saturating_sub(range.first))
    }
}

/// What is drawn of the paths, one after the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Layer {
    /// Lines behind surfaces.
    Hidden,
    /// Lines in front of them.
    Visible,
    /// Dots at vertices.
    Dots,
}
