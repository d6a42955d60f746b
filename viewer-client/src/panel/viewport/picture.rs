//! The choices of the user as numbers for the shaders.

use egui::Rgba;
use glam::{UVec4, Vec4};
use shaders::{FrameUniforms, PALETTE_SIZE};

use crate::camera::NEAR;
use crate::command::{ColorMode, Shading};
use crate::gpu::{PageRange, Picture};
use crate::settings::SceneSettings;
use crate::theme;
use crate::world::World;

/// Opacity of surfaces seen from behind when backs are cut away.
const CUTAWAY: f32 = 0.07;
/// Brightness that old paths fade to.
const FADED: f32 = 0.10;
/// Opacity of a path's last edge where it reaches the pinhole, relative to the rest.
const AT_LENS: f32 = 0.06;
/// Light ground outshines thin lines; there they are this much more opaque.
const ON_LIGHT_GROUND: f32 = 1.7;
/// How much crossing paths add up on dark ground: 0 cover, 1 add.
const GLOW: f32 = 0.6;

/// What to draw in a viewport of `size` pixels.
pub(super) fn of(world: &World<'_>, size: [u32; 2], pixels_per_point: f32) -> Picture {
    let [width, height] = size.map(|side| side as f32);
    let lens = world.camera.lens(width / height);
    let cloud = &world.settings.cloud;
    let dark = world.settings.layout.dark;
    let (darkest, brightest) = world.store.tone().range();
    let start_dots = if cloud.ends { 0.9 * cloud.width + 0.6 } else { cloud.dots };
    let uniforms = FrameUniforms {
        view_projection: lens.view_projection(),
        eye: lens.eye.extend(NEAR),
        up: world.camera.up().extend(if dark { 1.0 } else { 0.0 }),
        viewport: Vec4::new(width, height, 1.0 / width, 1.0 / height),
        line: line(world, pixels_per_point),
        fade: Vec4::new(
            cloud.fade,
            FADED,
            if dark { GLOW } else { 0.0 },
            start_dots * pixels_per_point,
        ),
        tone: Vec4::new(
            darkest,
            1.0 / (brightest - darkest).max(1e-3),
            cloud.dots * pixels_per_point,
            if cloud.ends { 1.0 } else { 0.0 },
        ),
        surface: surface(&world.settings.scene),
        count: UVec4::new(world.store.newest_ordinal(), color_code(cloud.color), 0, 0),
        palette: palette(),
    };
    let ranges = world.store.newest(cloud.shown as usize);
    Picture {
        size,
        uniforms,
        paths: ranges.into_iter().map(|(serial, first)| PageRange { serial, first }).collect(),
        surfaces: world.settings.scene.shading != Shading::Off,
    }
}

fn line(world: &World<'_>, pixels_per_point: f32) -> Vec4 {
    let cloud = &world.settings.cloud;
    // Seen from the pinhole itself, the last edges are points on the screen and hide nothing.
    let at_lens = if world.camera.is_through() { 1.0 } else { AT_LENS };
    let strength = if world.settings.layout.dark { 1.0 } else { ON_LIGHT_GROUND };
    let opacity = (strength * cloud.opacity).min(1.0);
    Vec4::new(cloud.width * pixels_per_point, opacity, cloud.hidden, at_lens)
}

fn surface(scene: &SceneSettings) -> Vec4 {
    let (opacity, edges) = match scene.shading {
        Shading::Shaded | Shading::Off => (scene.opacity, 0.0),
        Shading::Edges => (scene.opacity, 1.0),
        Shading::Wireframe => (0.0, 1.0),
    };
    let backs = if scene.cutaway { CUTAWAY } else { 1.0 };
    Vec4::new(opacity, backs, edges, 1.0)
}

/// The shader's code of a colour mode.
fn color_code(mode: ColorMode) -> u32 {
    match mode {
        ColorMode::Radiance => 0,
        ColorMode::Strategy => 1,
        ColorMode::Length => 2,
    }
}

fn palette() -> [Vec4; PALETTE_SIZE] {
    std::array::from_fn(|index| Rgba::from(theme::strategy_color(index)).to_array().into())
}
