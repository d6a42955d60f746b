// Brings the drawn picture into the window: background, soft highlights, sRGB.

@group(1) @binding(0) var picture: texture_2d<f32>;
@group(1) @binding(1) var picture_sampler: sampler;

struct Pixel {
    @builtin(position) position: vec4<f32>,
    @location(0) uv: vec2<f32>,
}

@vertex
fn vs_composite(@builtin(vertex_index) index: u32) -> Pixel {
    let corner = covering(index);
    var out: Pixel;
    out.position = vec4<f32>(corner, 0.0, 1.0);
    out.uv = vec2<f32>(0.5 + 0.5 * corner.x, 0.5 - 0.5 * corner.y);
    return out;
}

fn background(uv: vec2<f32>) -> vec3<f32> {
    let centre = length((uv - vec2<f32>(0.5, 0.45)) * vec2<f32>(1.0, 0.9));
    let dark = mix(vec3<f32>(0.022, 0.025, 0.032), vec3<f32>(0.006, 0.007, 0.010), centre * 1.4);
    let light = mix(vec3<f32>(0.86, 0.88, 0.90), vec3<f32>(0.66, 0.69, 0.73), centre * 1.3);
    return select(light, dark, frame.dark > 0.5);
}

// Linear up to the knee, then bent so that no highlight clips. The largest channel is bent and the
// others follow it, so that bright colours stay colours; only the brightest turn a little whiter.
fn soften(color: vec3<f32>) -> vec3<f32> {
    let knee = 0.6;
    let peak = max(color.r, max(color.g, color.b));
    if peak <= knee {
        return color;
    }
    let bent = knee + (1.0 - knee) * (1.0 - exp(-(peak - knee) / (1.0 - knee) * 0.5));
    let hue = color / peak;
    return bent * mix(hue, vec3<f32>(1.0), 0.45 * (1.0 - exp(-0.10 * (peak - knee))));
}

fn composed(uv: vec2<f32>) -> vec3<f32> {
    let drawn = textureSample(picture, picture_sampler, uv);
    return soften(drawn.rgb + background(uv) * (1.0 - clamp(drawn.a, 0.0, 1.0)));
}

fn to_srgb(linear: vec3<f32>) -> vec3<f32> {
    let low = 12.92 * linear;
    let high = 1.055 * pow(max(linear, vec3<f32>(0.0)), vec3<f32>(1.0 / 2.4)) - 0.055;
    return select(high, low, linear <= vec3<f32>(0.0031308));
}

// For a window whose format stores what it is given.
@fragment
fn fs_encoded(in: Pixel) -> @location(0) vec4<f32> {
    return vec4<f32>(to_srgb(composed(in.uv)), 1.0);
}

// For a window whose format encodes by itself.
@fragment
fn fs_linear(in: Pixel) -> @location(0) vec4<f32> {
    return vec4<f32>(composed(in.uv), 1.0);
}
