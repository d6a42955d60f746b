//! Surfaces, in pages of whole triangles.

use shaders::{MESH, MeshVertex};
use wgpu::util::DeviceExt as _;

use super::pipeline::{FrameGroup, Recipe, attributes, module};

/// Corners a page holds: 24 MiB, well below what any device allows for one buffer.
const PAGE_CORNERS: usize = 3 * 350_000;

/// All surfaces and their pipelines.
#[derive(Debug)]
pub(super) struct Mesh {
    opaque: wgpu::RenderPipeline,
    translucent: wgpu::RenderPipeline,
    pages: Vec<(wgpu::Buffer, u32)>,
}

impl Mesh {
    pub(super) fn new(device: &wgpu::Device, frame: &FrameGroup) -> Self {
        let module = module(device, MESH);
        let attributes = attributes(&MeshVertex::ATTRIBUTES, 0);
        let buffers = [Some(wgpu::VertexBufferLayout {
            array_stride: size_of::<MeshVertex>() as u64,
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &attributes,
        })];
        let build = |label, fragment, opaque| {
            let recipe = Recipe {
                label,
                module: &module,
                vertex: "vs_mesh",
                fragment,
                buffers: &buffers,
                topology: wgpu::PrimitiveTopology::TriangleList,
                depth: wgpu::CompareFunction::GreaterEqual,
                opaque,
            };
            recipe.build(device, frame)
        };
        Self {
            opaque: build("opaque surfaces", "fs_opaque", true),
            translucent: build("translucent surfaces", "fs_translucent", false),
            pages: Vec::new(),
        }
    }

    /// Replaces all surfaces.
    pub(super) fn set(&mut self, device: &wgpu::Device, corners: &[MeshVertex]) {
        self.pages = corners
            .chunks(PAGE_CORNERS)
            .map(|page| {
                let buffer = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                    label: Some("surface page"),
                    contents: bytemuck::cast_slice(page),
                    usage: wgpu::BufferUsages::VERTEX,
                });
                (buffer, page.len() as u32)
            })
            .collect();
    }

    /// Bytes on the graphics card.
    pub(super) fn byte_len(&self) -> u64 {
        self.pages.iter().map(|(buffer, _)| buffer.size()).sum()
    }

    pub(super) fn draw_opaque(&self, pass: &mut wgpu::RenderPass<'_>) {
        self.draw(pass, &self.opaque);
    }

    pub(super) fn draw_translucent(&self, pass: &mut wgpu::RenderPass<'_>) {
        self.draw(pass, &self.translucent);
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, pipeline: &wgpu::RenderPipeline) {
        pass.set_pipeline(pipeline);
        for (buffer, corners) in &self.pages {
            pass.set_vertex_buffer(0, buffer.slice(..));
            pass.draw(0..*corners, 0..1);
        }
    }
}
