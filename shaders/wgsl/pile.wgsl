// Sheets of paths, laid under those that are drawn already, the newest first.

@group(1) @binding(0) var sheet: texture_2d<f32>;

// Where no more than this shines through, nothing further down is worth drawing.
const SATURATED: f32 = 0.997;

fn corner(index: u32) -> vec2<f32> {
    // One triangle that covers the picture.
    return vec2<f32>(f32((index << 1u) & 2u), f32(index & 2u)) * 2.0 - 1.0;
}

@vertex
fn vs_pile(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(corner(index), 0.0, 1.0);
}

// Nearer than anything: depth is reversed.
@vertex
fn vs_near(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(corner(index), 1.0, 1.0);
}

@fragment
fn fs_pile(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    return textureLoad(sheet, vec2<i32>(position.xy), 0);
}

// Keeps the depth of saturated pixels only.
@fragment
fn fs_saturated(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    if textureLoad(sheet, vec2<i32>(position.xy), 0).a < SATURATED {
        discard;
    }
    return vec4<f32>(0.0);
}
