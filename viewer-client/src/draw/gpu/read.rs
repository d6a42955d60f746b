//! Pictures back from the graphics card.

use anyhow::Context as _;

/// Submits what is encoded, and reads what it leaves in a texture: the bytes of its pixels, of which
/// each has so many, row by row from the top.
pub fn read_back(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    mut encoder: wgpu::CommandEncoder,
    source: wgpu::TexelCopyTextureInfo<'_>,
    pixel_bytes: u32,
) -> anyhow::Result<Vec<u8>> {
    let size = source.texture.size();
    let row = pixel_bytes * size.width;
    let padded = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("read back"),
        size: u64::from(padded) * u64::from(size.height),
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(padded),
        rows_per_image: None,
    };
    let target = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
    encoder.copy_texture_to_buffer(source, target, size);
    queue.submit(Some(encoder.finish()));
    let (sender, receiver) = std::sync::mpsc::sync_channel(1);
    buffer.map_async(wgpu::MapMode::Read, .., move |result| {
        // The receiver waits below; it is gone only when the wait failed.
        drop(sender.send(result));
    });
    device
        .poll(wgpu::PollType::wait_indefinitely())
        .context("the graphics driver stopped responding")?;
    receiver.recv().context("the picture was never mapped")??;
    let mapped = buffer.get_mapped_range(..).context("the picture cannot be read")?;
    let rows = mapped.chunks_exact(padded as usize);
    Ok(rows.flat_map(|r| r.get(..row as usize).unwrap_or_default()).copied().collect())
}
