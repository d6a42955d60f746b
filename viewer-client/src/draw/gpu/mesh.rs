//! Surfaces, in pages of whole triangles.

use common::TexturePreview;
use shaders::{MESH, MeshVertex};
use wgpu::util::DeviceExt as _;

use super::pipeline::{FrameGroup, Ink, Recipe, attributes, module};
use super::textures::Textures;

/// Corners a page holds: 32 MiB, well below what any device allows for one buffer.
const PAGE_CORNERS: usize = 3 * 350_000;

/// All surfaces and their pipelines.
#[derive(Debug)]
pub(super) struct Mesh {
    opaque: wgpu::RenderPipeline,
    translucent: wgpu::RenderPipeline,
    textures: Textures,
    pages: Vec<(wgpu::Buffer, u32)>,
}

impl Mesh {
    pub(super) fn new(device: &wgpu::Device, queue: &wgpu::Queue, frame: &FrameGroup) -> Self {
        let textures = Textures::new(device, queue);
        let module = module(device, MESH);
        let attributes = attributes(&MeshVertex::ATTRIBUTES, 0);
        let buffers = [Some(wgpu::VertexBufferLayout {
            array_stride: size_of::<MeshVertex>() as u64,
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &attributes,
        })];
        let build = |label, fragment, ink| {
            let recipe = Recipe {
                label,
                module: &module,
                vertex: "vs_mesh",
                fragment,
                buffers: &buffers,
                topology: wgpu::PrimitiveTopology::TriangleList,
                depth: wgpu::CompareFunction::GreaterEqual,
                ink,
                extra: Some(&textures.layout),
            };
            recipe.build(device, frame)
        };
        Self {
            opaque: build("opaque surfaces", "fs_opaque", Ink::Opaque),
            translucent: build("translucent surfaces", "fs_translucent", Ink::Over),
            pages: Vec::new(),
            textures,
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

    /// Replaces all textures.
    pub(super) fn set_textures(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        list: &[TexturePreview],
    ) {
        self.textures.set(device, queue, list);
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
        pass.set_bind_group(1, &self.textures.group, &[]);
        for (buffer, corners) in &self.pages {
            pass.set_vertex_buffer(0, buffer.slice(..));
            pass.draw(0..*corners, 0..1);
        }
    }
}
