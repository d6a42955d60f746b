//! The choices of the user as numbers for the shaders.

use egui::{Color32, Rgba};
use glam::{Vec2, Vec3, Vec4};
use shaders::{FrameUniforms, PALETTE_SIZE, RAMP_SIZE};

use crate::camera::NEAR;
use crate::draw::gpu::{Crossing, PageRange, Picture};
use crate::settings::{CloudSettings, SceneSettings};
use crate::value::theme;
use crate::value::{Blend, ColorMode, ColorScale, Light, Lighting, Marks, Shading};
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
    let cloud = &world.settings.cloud;
    let ranges = world.store.newest(cloud.shown as usize);
    Picture {
        size,
        uniforms: uniforms(world, size, pixels_per_point),
        paths: ranges.into_iter().map(|(serial, first)| PageRange { serial, first }).collect(),
        surfaces: world.settings.scene.shading != Shading::Off,
        lines: cloud.marks == Marks::Lines,
        crossing: match cloud.blend {
            Blend::Weighted => Crossing::Weighed,
            Blend::Newest | Blend::Add => Crossing::Stacked,
        },
    }
}

fn uniforms(world: &World<'_>, size: [u32; 2], pixels_per_point: f32) -> FrameUniforms {
    let [width, height] = size.map(|side| side as f32);
    let lens = world.camera.lens(width / height);
    let cloud = &world.settings.cloud;
    let dark = world.settings.window.is_dark();
    let (darkest, brightest) = world.store.tone().range();
    let [start_radius, dot_radius] = dots(cloud).map(|points| points * pixels_per_point);
    let [opacity, edges] = surfaces(&world.settings.scene);
    let is = u32::from;
    FrameUniforms {
        view_projection: lens.view_projection(),
        eye: lens.eye,
        near: NEAR,
        up: world.camera.up(),
        dark: f32::from(u8::from(dark)),
        light: light(world, lens.eye),
        phong: f32::from(u8::from(world.settings.scene.lighting == Lighting::Phong)),
        constant: linear(theme::ACCENT).truncate(),
        glow: glow(cloud.blend, dark),
        clip: world.settings.scene.clip_plane(world.camera.bounds()),
        line_width: cloud.width * pixels_per_point,
        line_opacity: (if dark { 1.0 } else { ON_LIGHT_GROUND } * cloud.opacity).min(1.0),
        hidden_opacity: cloud.hidden,
        // Seen from the pinhole itself, the last edges are points on the screen and hide nothing.
        lens_opacity: if world.camera.is_through() { 1.0 } else { AT_LENS },
        start_radius,
        dot_radius,
        surface_opacity: opacity,
        back_opacity: if world.settings.scene.cutaway { CUTAWAY } else { 1.0 },
        edge_strength: edges,
        shaded: if world.settings.scene.shading == Shading::Texture { 0.0 } else { 1.0 },
        cue_strength: cloud.cue,
        cue_begin: cue_begin(world, lens.eye),
        cue_inverse_reach: 0.5 / world.camera.bounds().radius(),
        fade_age: cloud.fade,
        faded: FADED,
        darkest,
        inverse_range: 1.0 / (brightest - darkest).max(1e-3),
        unmatched_opacity: cloud.dim,
        newest: world.store.newest_ordinal(),
        color_mode: color_code(cloud.color),
        ends_only: is(cloud.marks == Marks::Ends),
        logarithmic: is(cloud.scale == ColorScale::Log),
        tint_ends: is(cloud.ends),
        textured: is(world.settings.scene.shading != Shading::Plain),
        size: Vec2::new(width, height),
        padding: [0; 2],
        palette: palette(),
        ramp: ramp(dark),
    }
}

/// Radius of the dots at the light end, and of the others, in points.
fn dots(cloud: &CloudSettings) -> [f32; 2] {
    let inner = if cloud.marks == Marks::Lines { cloud.dots } else { cloud.dots.max(LONE_DOT) };
    [if cloud.ends { 0.9 * cloud.width + 0.6 } else { inner }, inner]
}

/// Opacity of surfaces, and strength of their edges.
fn surfaces(scene: &SceneSettings) -> [f32; 2] {
    match scene.shading {
        Shading::Shaded | Shading::Plain | Shading::Texture | Shading::Off => [scene.opacity, 0.0],
        Shading::Edges => [scene.opacity, 1.0],
        Shading::Wireframe => [0.0, 1.0],
    }
}

/// Where the light is, in scene units.
fn light(world: &World<'_>, eye: Vec3) -> Vec3 {
    match world.settings.scene.light {
        Light::Camera => eye,
        Light::At(place) => world.names().scene(place.into()).as_vec3(),
    }
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
fn cue_begin(world: &World<'_>, eye: Vec3) -> f32 {
    let bounds = world.camera.bounds();
    ((bounds.centre() - eye).length() - bounds.radius()).max(0.0)
}
