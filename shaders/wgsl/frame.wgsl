// What every pipeline knows of the picture being drawn. Twin: `FrameUniforms`.
// Only vec4 and mat4 members, so that both languages lay it out alike.
struct Frame {
    view_projection: mat4x4<f32>,
    // xyz: the eye in scene units; w: distance of the near plane.
    eye: vec4<f32>,
    // xyz: the scene's up direction; w: 1 for a dark theme, 0 for a light one.
    up: vec4<f32>,
    // Width and height of the picture in pixels, then their inverses.
    viewport: vec4<f32>,
    // Lines: width in pixels, opacity, opacity where hidden, opacity at the lens end.
    line: vec4<f32>,
    // Age at which a path has faded to 1/e (in paths), brightness it fades to, glow (0 covers,
    // 1 adds light), radius of the dots at the light end in pixels.
    fade: vec4<f32>,
    // log2 of the radiance drawn darkest, 1 / (log2 of the brightest - that), radius of the other
    // vertices' dots in pixels, 1 to tint the two ends.
    tone: vec4<f32>,
    // Surfaces: opacity, opacity of those that face away, wireframe strength, 1 for shading.
    surface: vec4<f32>,
    // xyz: the light that surfaces are seen by; w: 1 for Phong's model, 0 for one with a soft sky.
    light: vec4<f32>,
    // 1 to draw textures; the rest is unused.
    paint: vec4<f32>,
    // Ordinal of the newest path (24 bits), colour mode (see `path_color`), 1 to draw dots at the two ends of a
    // path only, 1 for logarithmic scales.
    count: vec4<u32>,
    // What lies on the positive side of this plane is drawn: dot(xyz, position) + w >= 0.
    clip: vec4<f32>,
    // Depth cue: strength, distance where it begins, 1 / (distance over which it grows); then the
    // relative opacity of paths that the filter does not match.
    cue: vec4<f32>,
    // The colour of all paths where colour says nothing, linear.
    constant: vec4<f32>,
    // Colours that stay apart: strategies, chains, classes, kinds; linear.
    palette: array<vec4<f32>, 16>,
    // Colours from low to high, linear.
    ramp: array<vec4<f32>, 8>,
}

@group(0) @binding(0) var<uniform> frame: Frame;

// Corner number `index` of one triangle that covers the picture, in clip space.
fn covering(index: u32) -> vec2<f32> {
    return vec2<f32>(f32((index << 1u) & 2u), f32(index & 2u)) * 2.0 - 1.0;
}

