//! Pictures whose surfaces the graphics card draws, and whose paths the processor.

use std::time::{Duration, Instant};

use shaders::{LinePoint, role};

use super::kit::Kit;
use super::pages::PageRange;
use super::progress::{Layer, Picture};
use super::read::read_back;
use super::target::{Part, Target};
use crate::draw::raster::{Canvas, Crossing};

/// How long it may draw in the first frame of a view, so that a view that moves is smooth.
const GLANCE: Duration = Duration::from_millis(50);
/// The same for later frames, of which few then draw the interface for nothing.
const LONGEST: Duration = Duration::from_millis(150);

/// Points that are drawn before the clock is looked at.
const SLICE: usize = 4096;

/// What the processor draws with, and the picture that it is at.
#[derive(Debug, Default)]
pub(super) struct Software {
    canvas: Canvas,
    painting: Option<Painting>,
    /// The canvas as the graphics card sees it.
    sheet: Option<wgpu::Texture>,
    spent: Duration,
}

/// A picture on the canvas.
#[derive(Debug)]
struct Painting {
    picture: Picture,
    content: u64,
    /// What to draw of the paths, topmost first.
    steps: Vec<(Layer, PageRange)>,
    next: usize,
    /// Points of the next step that are drawn already, from its end on.
    drawn: usize,
    /// Frames that it has taken.
    frames: u32,
    /// The surfaces, until paths are laid over them.
    surfaces: Option<Target>,
}

/// What a window can show.
#[derive(Debug)]
pub(super) struct Painted {
    pub(super) target: Target,
    pub(super) picture: Picture,
    pub(super) content: u64,
}

impl Software {
    /// True while a picture is not done.
    pub(super) fn is_painting(&self) -> bool {
        self.painting.is_some()
    }

    /// Leaves the picture as it is.
    pub(super) fn rest(&mut self) {
        self.painting = None;
    }

    /// Time spent on drawing since this was last asked.
    pub(super) fn take_time(&mut self) -> Duration {
        std::mem::take(&mut self.spent)
    }

    /// Draws for as long as a frame may take, and answers whether all paths are drawn: of the picture
    /// at hand if it differs from the one that is `wanted` only by the paths that have come since, else
    /// of that one, whose surfaces are drawn on the spare target.
    pub(super) fn go_on(
        &mut self,
        kit: &Kit,
        wanted: &Picture,
        content: u64,
        spare: &mut Option<Target>,
    ) -> bool {
        let begun = Instant::now();
        let painting = self.painting.take().filter(|p| p.picture.same_view(wanted));
        let mut painting = painting.unwrap_or_else(|| {
            let (surfaces, depths) = draw_surfaces(kit, wanted, spare.take());
            self.canvas.begin(wanted.size, wanted.crossing, depths);
            let (picture, mut steps) = (wanted.clone(), wanted.steps());
            steps.reverse();
            let surfaces = Some(surfaces);
            Painting { picture, content, steps, next: 0, drawn: 0, frames: 0, surfaces }
        });
        painting.frames += 1;
        // However long surfaces took: a view that moves must not lose its paths.
        let started = Instant::now();
        let goal = LONGEST.min(painting.frames * GLANCE);
        let Painting { picture, steps, next, drawn, .. } = &mut painting;
        while let Some((layer, range)) = steps.get(*next) {
            let points = kit.pages.in_memory(*range).unwrap_or_default();
            let left = &points[..points.len().saturating_sub(*drawn)];
            let newest = &left[slice_of(left)..];
            self.canvas.draw(newest, &picture.uniforms, *layer, picture.crossing);
            *drawn += newest.len();
            if newest.len() == left.len() {
                (*next, *drawn) = (*next + 1, 0);
            }
            if started.elapsed() >= goal {
                break;
            }
        }
        let done = painting.next == painting.steps.len();
        self.painting = Some(painting);
        self.spent += begun.elapsed();
        done
    }

    /// Lays the paths as far as they are drawn over the surfaces.
    pub(super) fn show(
        &mut self,
        kit: &Kit,
        encoder: &mut wgpu::CommandEncoder,
        spare: Option<Target>,
    ) -> Option<Painted> {
        let started = Instant::now();
        let painting = self.painting.as_mut()?;
        let picture = painting.picture.clone();
        let paths = upload(kit, &mut self.sheet, &self.canvas, picture.size);
        kit.frame.write(&kit.queue, &picture.uniforms);
        let drawn = painting.surfaces.take();
        let part = Part { first: drawn.is_none(), last: true };
        let target = drawn.or(spare).unwrap_or_else(|| new_target(kit, &picture));
        let mut pass = target.begin(encoder, part);
        pass.set_bind_group(0, &kit.frame.group, &[]);
        if part.first {
            kit.begin(&mut pass, &picture);
        }
        kit.lay_over(&mut pass, &paths, &picture);
        drop(pass);
        let content = painting.content;
        self.spent += started.elapsed();
        Some(Painted { target, picture, content })
    }
}

/// Where the newest paths of a page begin that are drawn at once.
fn slice_of(points: &[LinePoint]) -> usize {
    let mut start = points.len().saturating_sub(SLICE);
    while start > 0 && points[start - 1].info[0] & role::LAST == 0 {
        start -= 1;
    }
    start
}

/// Paths are weighed on the canvas, if they are: the target needs no room for that.
fn new_target(kit: &Kit, picture: &Picture) -> Target {
    Target::new(&kit.device, picture.size, kit.frame.samples, Crossing::Stacked)
}

/// Draws what lies under the paths, and answers how near surfaces are: row by row, reversed, nothing
/// where there are none.
fn draw_surfaces(kit: &Kit, picture: &Picture, spare: Option<Target>) -> (Target, Vec<f32>) {
    let target = spare.unwrap_or_else(|| new_target(kit, picture));
    let descriptor = wgpu::CommandEncoderDescriptor { label: Some("surfaces") };
    let mut encoder = kit.device.create_command_encoder(&descriptor);
    kit.frame.write(&kit.queue, &picture.uniforms);
    let mut pass = target.begin(&mut encoder, Part { first: true, last: false });
    pass.set_bind_group(0, &kit.frame.group, &[]);
    kit.begin(&mut pass, picture);
    drop(pass);
    if !picture.surfaces {
        kit.queue.submit(Some(encoder.finish()));
        return (target, Vec::new());
    }
    let source = wgpu::TexelCopyTextureInfo {
        aspect: wgpu::TextureAspect::DepthOnly,
        ..target.depth().as_image_copy()
    };
    let read = read_back(&kit.device, &kit.queue, encoder, source, size_of::<f32>() as u32);
    let bytes = read.unwrap_or_else(|error| {
        tracing::warn!("surfaces do not hide paths: {error:#}");
        Vec::new()
    });
    (target, bytemuck::pod_collect_to_vec(&bytes))
}

/// Copies the canvas to where the graphics card reads it.
fn upload(
    kit: &Kit,
    sheet: &mut Option<wgpu::Texture>,
    canvas: &Canvas,
    [width, height]: [u32; 2],
) -> wgpu::TextureView {
    let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
    let texture = sheet.take().filter(|sheet| sheet.size() == size).unwrap_or_else(|| {
        kit.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("paths"),
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba32Float,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        })
    });
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(size_of::<[f32; 4]>() as u32 * width),
        rows_per_image: None,
    };
    let pixels = canvas.finished();
    kit.queue.write_texture(texture.as_image_copy(), bytemuck::cast_slice(&pixels), layout, size);
    let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
    *sheet = Some(texture);
    view
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slices_are_whole_paths_and_make_the_whole() {
        let path = |length: usize| {
            (0..length).map(move |i| LinePoint {
                info: [if i + 1 == length { role::LAST } else { 0 }, 0, 0, 0],
                ..LinePoint::default()
            })
        };
        let points: Vec<_> = (0..3000).flat_map(|i| path(2 + i % 9)).collect();
        let (mut left, mut slices) = (points.as_slice(), 0);
        while !left.is_empty() {
            let start = slice_of(left);
            let begins = start == 0 || left[start - 1].info[0] == role::LAST;
            assert!(begins && left.len() - start < SLICE + 10, "from {start} to {}", left.len());
            (left, slices) = (&left[..start], slices + 1);
        }
        assert_eq!(slices, points.len().div_ceil(SLICE), "none is small but the last");
    }
}
