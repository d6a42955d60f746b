// Sheets of paths, laid under those that are drawn already, the newest first.

@group(1) @binding(0) var layer: texture_2d<f32>;

// Where less than this shines through, two steps of dark grey at most, nothing further down is worth
// drawing.
const FAINTEST: f32 = 0.0006;

@vertex
fn vs_pile(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(covering(index), 0.0, 1.0);
}

// Nearer than anything: depth is reversed.
@vertex
fn vs_near(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(covering(index), 1.0, 1.0);
}

// A sheet: colours times their opacity, and their opacity.
@fragment
fn fs_sheet(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    return textureLoad(layer, vec2<i32>(position.xy), 0);
}

// The pile keeps what shines through in place of opacity: half floats are finer near 0 than near 1.
@fragment
fn fs_pile(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let pile = textureLoad(layer, vec2<i32>(position.xy), 0);
    return vec4<f32>(pile.rgb, 1.0 - pile.a);
}

// Keeps the depth of saturated pixels only.
@fragment
fn fs_saturated(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    if textureLoad(layer, vec2<i32>(position.xy), 0).a >= FAINTEST {
        discard;
    }
    return vec4<f32>(0.0);
}
