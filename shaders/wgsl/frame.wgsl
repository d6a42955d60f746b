// What every pipeline knows of the picture being drawn. Twin: `FrameUniforms`.
// Three numbers are followed by one more, and others come in fours, so that both languages lay them
// out alike.
struct Frame {
    view_projection: mat4x4<f32>,
    // The eye in scene units, and the distance of the near plane.
    eye: vec3<f32>,
    near: f32,
    // The scene's up direction; 1 for a dark theme, 0 for a light one.
    up: vec3<f32>,
    dark: f32,
    // The light that surfaces are seen by; 1 for Phong's model, 0 for one with a soft sky.
    light: vec3<f32>,
    phong: f32,
    // The colour of all paths where colour says nothing, linear.
    constant: vec3<f32>,
    // What crossing paths do: 0 covers, 1 adds light.
    glow: f32,
    // What lies on the positive side of this plane is drawn: dot(xyz, position) + w >= 0.
    clip: vec4<f32>,
    // Lines: width in pixels, opacity, opacity where hidden, opacity at the lens end.
    line_width: f32,
    line_opacity: f32,
    hidden_opacity: f32,
    lens_opacity: f32,
    // Radius of the dots at the light end, and of those at other vertices, in pixels.
    start_radius: f32,
    dot_radius: f32,
    // Surfaces: opacity, opacity of those that face away, wireframe strength, 1 for shading.
    surface_opacity: f32,
    back_opacity: f32,
    edge_strength: f32,
    shaded: f32,
    // Depth cue: strength, distance where it begins, 1 / (distance over which it grows).
    cue_strength: f32,
    cue_begin: f32,
    cue_inverse_reach: f32,
    // Age at which a path has faded to 1/e (in paths), and the brightness that it fades to.
    fade_age: f32,
    faded: f32,
    // log2 of the radiance drawn darkest, 1 / (log2 of the brightest - that).
    darkest: f32,
    inverse_range: f32,
    // Relative opacity of paths that the filter does not match.
    unmatched_opacity: f32,
    // Ordinal of the newest path (24 bits).
    newest: u32,
    // See `path_color`.
    color_mode: u32,
    // 1 to draw dots at the two ends of a path only.
    ends_only: u32,
    // 1 for logarithmic scales.
    logarithmic: u32,
    // 1 to tint the two ends.
    tint_ends: u32,
    // 1 to draw textures.
    textured: u32,
    // Width and height of the picture in pixels.
    size: vec2<f32>,
    padding: vec2<u32>,
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

