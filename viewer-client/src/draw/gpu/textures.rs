//! Textures of surfaces, as the layers of one array with smaller and smaller copies.

use common::TexturePreview;

use super::pipeline::sampled_layout;

/// Bytes that all layers may take on the graphics card, smaller copies aside.
const BUDGET: usize = 64 << 20;
/// Side of a layer in texels: the largest, and the smallest that still tells a texture from another.
const SIDES: [u32; 4] = [512, 256, 128, 64];

/// The array, and how shaders read it.
#[derive(Debug)]
pub(super) struct Textures {
    pub(super) layout: wgpu::BindGroupLayout,
    pub(super) group: wgpu::BindGroup,
    sampler: wgpu::Sampler,
}

impl Textures {
    /// One white layer, since an array cannot be empty.
    pub(super) fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Self {
        let layout = sampled_layout(device, "textures", wgpu::TextureViewDimension::D2Array);
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("texture"),
            address_mode_u: wgpu::AddressMode::Repeat,
            address_mode_v: wgpu::AddressMode::Repeat,
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            mipmap_filter: wgpu::MipmapFilterMode::Linear,
            ..wgpu::SamplerDescriptor::default()
        });
        let group = group(device, queue, &layout, &sampler, &[]);
        Self { layout, group, sampler }
    }

    pub(super) fn set(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        list: &[TexturePreview],
    ) {
        self.group = group(device, queue, &self.layout, &self.sampler, list);
    }
}

fn group(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    layout: &wgpu::BindGroupLayout,
    sampler: &wgpu::Sampler,
    list: &[TexturePreview],
) -> wgpu::BindGroup {
    let most = device.limits().max_texture_array_layers as usize;
    let list = list.get(..most).unwrap_or(list);
    let side = if list.is_empty() { 1 } else { side_for(list.len()) };
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("textures"),
        size: wgpu::Extent3d {
            width: side,
            height: side,
            depth_or_array_layers: list.len().max(1) as u32,
        },
        mip_level_count: side.ilog2() + 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8UnormSrgb,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let white = TexturePreview { width: 1, height: 1, texels: vec![[255; 3]] };
    let white = [white];
    let shown = if list.is_empty() { &white } else { list };
    for (layer, preview) in shown.iter().enumerate() {
        for (level, (side, texels)) in levels(preview, side).into_iter().enumerate() {
            write(queue, &texture, layer, level, side, &texels);
        }
    }
    let view = texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..wgpu::TextureViewDescriptor::default()
    });
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("textures"),
        layout,
        entries: &[
            wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::TextureView(&view),
            },
            wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::Sampler(sampler) },
        ],
    })
}

fn write(
    queue: &wgpu::Queue,
    texture: &wgpu::Texture,
    layer: usize,
    level: usize,
    side: u32,
    texels: &[[u8; 4]],
) {
    queue.write_texture(
        wgpu::TexelCopyTextureInfo {
            texture,
            mip_level: level as u32,
            origin: wgpu::Origin3d { x: 0, y: 0, z: layer as u32 },
            aspect: wgpu::TextureAspect::All,
        },
        texels.as_flattened(),
        wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(4 * side),
            rows_per_image: None,
        },
        wgpu::Extent3d { width: side, height: side, depth_or_array_layers: 1 },
    );
}

/// The largest side at which so many layers fit.
fn side_for(layers: usize) -> u32 {
    let fits = |side: &u32| layers * 4 * (side * side) as usize <= BUDGET;
    SIDES.into_iter().find(fits).unwrap_or(SIDES[SIDES.len() - 1])
}

/// The picture as a square of `side` texels, a power of two, and then ever half of that, down to one
/// texel.
fn levels(preview: &TexturePreview, side: u32) -> Vec<(u32, Vec<[u8; 4]>)> {
    let mut levels = vec![(side, stretched(preview, side))];
    while let Some((side, texels)) = levels.last()
        && *side > 1
    {
        let half = side / 2;
        let at = |x: u32, y: u32| texels.get((y * side + x) as usize).copied().unwrap_or_default();
        let place = |i: u32| (2 * (i % half), 2 * (i / half));
        let mean = |i: u32| {
            let (x, y) = place(i);
            mean([at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y + 1)])
        };
        let texels = (0..half * half).map(mean).collect();
        levels.push((half, texels));
    }
    levels
}

/// The picture stretched, or shrunk, to a square; each texel is the nearest one.
fn stretched(preview: &TexturePreview, side: u32) -> Vec<[u8; 4]> {
    let from = |to: u32, size: u32| (2 * to + 1) * size / (2 * side);
    let texel = |i: u32| {
        let (x, y) = (from(i % side, preview.width), from(i / side, preview.height));
        let texel = preview.texels.get((y * preview.width + x) as usize).copied();
        let [r, g, b] = texel.unwrap_or_default();
        [r, g, b, 255]
    };
    (0..side * side).map(texel).collect()
}

/// The mean of codes: near enough to that of light for copies that are seen from afar.
fn mean(texels: [[u8; 4]; 4]) -> [u8; 4] {
    std::array::from_fn(|c| {
        let sum: u16 = texels.iter().map(|texel| u16::from(texel[c])).sum();
        ((sum + 2) / 4) as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn copies_halve_down_to_the_mean() {
        let texels = vec![[0; 3], [200; 3], [0; 3], [200; 3]];
        let preview = TexturePreview { width: 2, height: 2, texels };
        let levels = levels(&preview, 4);
        let sides: Vec<u32> = levels.iter().map(|(side, _)| *side).collect();
        assert_eq!(sides, [4, 2, 1], "down to one texel");
        assert_eq!(levels[0].1[1..3], [[0, 0, 0, 255], [200, 200, 200, 255]], "stretched");
        assert_eq!(levels[2].1, [[100, 100, 100, 255]], "the mean");
    }

    #[test]
    fn many_textures_are_smaller() {
        assert_eq!([1, 64, 65, 256].map(side_for), [512, 512, 256, 256], "within the budget");
    }
}
