// Lays paths over the surfaces that were drawn apart from them.

// Sums of weighted colours and products of what shines through, or colours times their opacity.
@group(1) @binding(0) var sums: texture_2d<f32>;
@group(1) @binding(1) var weights: texture_2d<f32>;

@vertex
fn vs_blend(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(covering(index), 0.0, 1.0);
}

// [McGuire and Bavoil 2013, equation 6].
@fragment
fn fs_blend(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let place = vec2<i32>(position.xy);
    let sum = textureLoad(sums, place, 0);
    let weight = textureLoad(weights, place, 0).r;
    let covered = 1.0 - sum.a;
    return vec4<f32>(sum.rgb / max(weight, 1e-5) * covered, covered);
}

@fragment
fn fs_sheet(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    return textureLoad(sums, vec2<i32>(position.xy), 0);
}
