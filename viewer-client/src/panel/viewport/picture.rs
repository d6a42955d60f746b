//! The choices of the user as numbers for the shaders.

use egui::{Color32, Rgba};
use glam::{UVec4, Vec3, Vec4};
use shaders::{FrameUniforms, PALETTE_SIZE, RAMP_SIZE};

use crate::camera::NEAR;
use crate::command::{Blend, ColorMode, ColorScale, Light, Lighting, Marks, Shading};
use crate::draw::gpu::{Crossing, PageRange, Picture};
use crate::settings::SceneSettings;
use crate::value::theme;
use crate::world::World;

/// Opacity of surfaces seen from behind when backs are cut away.
const CUTAWAY: f32 = 0.07;
/// Brightness that old paths fade to.
const FADED: f32 = 0.10;
/// Opacity of a path's last edge where it reaches the pinhole, relative to the rest.
const AT_LENS: f32 = 0.06;
/// Light ground outshines thin lines; there they are this much more opaque.
const ON_LIGHT_GROUND: f32 = 1.7;
/// How much crossing paths add up on dark ground where the newest lies on top.
const GLOW: f32 = 0.6;
/// Smallest radius of dots that stand alone, in points.
const LONE_DOT: f32 = 1.5;

/// What to draw in a viewport of `size` pixels.
pub(super) fn of(world: &World<'_>, size: [u32; 2], pixels_per_point: f32) -> Picture {
    let [width, height] = size.map(|side| side as f32);
    let lens = world.camera.lens(width / height);
    let cloud = &world.settings.cloud;
    let dark = world.settings.layout.dark;
    let (darkest, brightest) = world.store.tone().range();
    let inner_dots =
        if cloud.marks == Marks::Lines { cloud.dots } else { cloud.dots.max(LONE_DOT) };
    let start_dots = if cloud.ends { 0.9 * cloud.width + 0.6 } else { inner_dots };
    let textured = world.settings.scene.shading != Shading::Plain;
    let uniforms = FrameUniforms {
        view_projection: lens.view_projection(),
        eye: lens.eye.extend(NEAR),
        up: world.camera.up().extend(if dark { 1.0 } else { 0.0 }),
        viewport: Vec4::new(width, height, 1.0 / width, 1.0 / height),
        line: line(world, pixels_per_point),
        fade: Vec4::new(cloud.fade, FADED, glow(cloud.blend, dark), start_dots * pixels_per_point),
        tone: Vec4::new(
            darkest,
            1.0 / (brightest - darkest).max(1e-3),
            inner_dots * pixels_per_point,
            if cloud.ends { 1.0 } else { 0.0 },
        ),
        surface: surface(&world.settings.scene),
        light: light(world, lens.eye),
        paint: Vec4::new(f32::from(u8::from(textured)), 0.0, 0.0, 0.0),
        count: UVec4::new(
            world.store.newest_ordinal(),
            color_code(cloud.color),
            u32::from(cloud.marks == Marks::Ends),
            u32::from(cloud.scale == ColorScale::Log),
        ),
        clip: world.settings.scene.clip_plane(world.camera.bounds()),
        cue: cue(world, lens.eye),
        constant: linear(theme::ACCENT),
        palette: palette(),
        ramp: ramp(dark),
    };
    let ranges = world.store.newest(cloud.shown as usize);
    Picture {
        size,
        uniforms,
        paths: ranges.into_iter().map(|(serial, first)| PageRange { serial, first }).collect(),
        surfaces: world.settings.scene.shading != Shading::Off,
        lines: cloud.marks == Marks::Lines,
        crossing: match cloud.blend {
            Blend::Weighted => Crossing::Weighed,
            Blend::Newest | Blend::Add => Crossing::Stacked,
        },
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
        Shading::Shaded | Shading::Plain | Shading::Texture | Shading::Off => (scene.opacity, 0.0),
        Shading::Edges => (scene.opacity, 1.0),
        Shading::Wireframe => (0.0, 1.0),
    };
    let backs = if scene.cutaway { CUTAWAY } else { 1.0 };
    let shaded = if scene.shading == Shading::Texture { 0.0 } else { 1.0 };
    Vec4::new(opacity, backs, edges, shaded)
}

/// Where the light is, in scene units, and by which model surfaces answer it.
fn light(world: &World<'_>, eye: Vec3) -> Vec4 {
    let scene = &world.settings.scene;
    let place = match scene.light {
        Light::Camera => eye,
        Light::At(place) => world.names().scene(place.into()).as_vec3(),
    };
    place.extend(if scene.lighting == Lighting::Phong { 1.0 } else { 0.0 })
}

/// How much crossing paths add up: 0 cover, 1 add.
fn glow(blend: Blend, dark: bool) -> f32 {
    match blend {
        Blend::Newest if dark => GLOW,
        Blend::Newest | Blend::Weighted => 0.0,
        Blend::Add => 1.0,
    }
}

/// The shader's code of a colour mode.
fn color_code(mode: ColorMode) -> u32 {
    match mode {
        ColorMode::Radiance => 0,
        ColorMode::Strategy => 1,
        ColorMode::Length => 2,
        ColorMode::Luminance => 3,
        ColorMode::Age => 4,
        ColorMode::Kind => 5,
        ColorMode::Chain => 6,
        ColorMode::Class => 7,
        ColorMode::Constant => 8,
        ColorMode::Throughput => 9,
        ColorMode::Dwell => 10,
        ColorMode::Acceptance => 11,
    }
}

fn palette() -> [Vec4; PALETTE_SIZE] {
    std::array::from_fn(|index| linear(theme::strategy_color(index)))
}

fn ramp(dark: bool) -> [Vec4; RAMP_SIZE] {
    theme::ramp(dark).map(linear)
}

fn linear(color: Color32) -> Vec4 {
    Rgba::from(color).to_array().into()
}

/// The depth cue begins where the scene does.
fn cue(world: &World<'_>, eye: Vec3) -> Vec4 {
    let cloud = &world.settings.cloud;
    let (centre, radius) = (world.camera.bounds().centre(), world.camera.bounds().radius());
    let begin = ((centre - eye).length() - radius).max(0.0);
    Vec4::new(cloud.cue, begin, 0.5 / radius, cloud.dim)
}
