// Surfaces: a light, a hemisphere, and what material and texture say.

const KIND_TRANSPARENT: u32 = 1u;
const KIND_EMITTER: u32 = 2u;
const KIND_MIRROR: u32 = 3u;

// Twin: `MeshVertex`.
struct Corner {
    @location(0) position: vec3<f32>,
    // xyz: the unit normal; w: number of the texture from 1, in 32767ths, or 0.
    @location(1) normal: vec4<f32>,
    // rgb: square root of the linear colour; a: kind of material in 255ths.
    @location(2) color: vec4<f32>,
    // Upwards, while rows of texels count downwards.
    @location(3) texcoord: vec2<f32>,
}

@group(1) @binding(0) var textures: texture_2d_array<f32>;
@group(1) @binding(1) var texture_sampler: sampler;

struct Surface {
    @builtin(position) clip: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) color: vec3<f32>,
    @location(3) corner: vec3<f32>,
    @location(4) texcoord: vec2<f32>,
    // Kind of material, then the number of the texture from 1.
    @location(5) @interpolate(flat) kind: vec2<u32>,
}

@vertex
fn vs_mesh(v: Corner, @builtin(vertex_index) index: u32) -> Surface {
    var out: Surface;
    out.clip = frame.view_projection * vec4<f32>(v.position, 1.0);
    out.position = v.position;
    out.normal = v.normal.xyz;
    out.color = v.color.rgb * v.color.rgb;
    // Triangles are drawn without an index, so the vertex number tells the corner.
    let corner = index % 3u;
    out.corner = vec3<f32>(
        select(0.0, 1.0, corner == 0u),
        select(0.0, 1.0, corner == 1u),
        select(0.0, 1.0, corner == 2u),
    );
    out.texcoord = v.texcoord;
    out.kind = vec2<u32>(u32(v.color.a * 255.0 + 0.5), u32(max(v.normal.w, 0.0) * 32767.0 + 0.5));
    return out;
}

// 1 on the edges of the triangle, 0 inside, about a pixel wide.
fn edge(in: Surface) -> f32 {
    let slope = fwidth(in.corner);
    let near = smoothstep(vec3<f32>(0.0), 1.1 * slope, in.corner);
    return 1.0 - min(near.x, min(near.y, near.z));
}

fn sky(direction: vec3<f32>) -> vec3<f32> {
    let height = 0.5 + 0.5 * dot(direction, frame.up);
    return mix(vec3<f32>(0.20, 0.19, 0.18), vec3<f32>(0.62, 0.70, 0.82), height);
}

// The material's colour, read from its texture where it has one.
fn painted(in: Surface) -> vec3<f32> {
    let place = vec2<f32>(in.texcoord.x, 1.0 - in.texcoord.y);
    let texel = textureSample(textures, texture_sampler, place, i32(max(in.kind.y, 1u)) - 1);
    return select(in.color, texel.rgb, in.kind.y > 0u && frame.textured == 1u);
}

// Light and shade of a preview with a soft sky.
fn soft(color: vec3<f32>, normal: vec3<f32>, to_light: vec3<f32>) -> vec3<f32> {
    // On dark ground surfaces step back behind the paths.
    let strength = mix(1.0, 0.55, frame.dark);
    let facing = max(dot(normal, to_light), 0.0);
    return strength * color * (0.14 + 0.36 * sky(normal) + 0.50 * facing);
}

// Phong's model with one point light, and with the numbers of the Lvis of 2014.
fn phong(color: vec3<f32>, normal: vec3<f32>, to_light: vec3<f32>, to_eye: vec3<f32>) -> vec3<f32> {
    let facing = max(dot(normal, to_light), 0.0);
    let shine = select(0.0, pow(max(dot(reflect(-to_light, normal), to_eye), 0.0), 4.0), facing > 0.0);
    return color * (0.05 + 0.7 * facing) + vec3<f32>(shine);
}

struct Lit {
    color: vec3<f32>,
    alpha: f32,
    edge: f32,
}

fn lit(in: Surface, front: bool) -> Lit {
    var out: Lit;
    let to_eye = normalize(frame.eye - in.position);
    var normal = normalize(in.normal);
    normal = select(-normal, normal, dot(normal, to_eye) >= 0.0);
    let facing = max(dot(normal, to_eye), 0.0);
    let grazing = pow(1.0 - facing, 3.0);

    let color = painted(in);
    let to_light = normalize(frame.light - in.position);
    var shaded = soft(color, normal, to_light);
    if frame.phong > 0.5 {
        shaded = phong(color, normal, to_light, to_eye);
    }
    out.color = mix(color, shaded, frame.shaded);
    out.alpha = frame.surface_opacity;
    if in.kind.x == KIND_EMITTER {
        out.color = in.color * (2.2 + 0.8 * facing);
    } else if in.kind.x == KIND_MIRROR {
        let mirrored = sky(reflect(-to_eye, normal));
        out.color = in.color * (0.15 + 0.85 * mirrored) + 0.25 * grazing;
    } else if in.kind.x == KIND_TRANSPARENT {
        let shine = pow(max(reflect(-to_eye, normal).x * 0.4 + facing * 0.6, 0.0), 24.0);
        out.color = mix(in.color * 0.35, sky(reflect(-to_eye, normal)) * 1.3, 0.25 + grazing);
        out.color += 0.8 * shine;
        out.alpha *= clamp(0.10 + 0.65 * grazing + 0.5 * shine, 0.0, 0.9);
    }
    if !front && in.kind.x != KIND_TRANSPARENT {
        out.alpha *= frame.back_opacity;
    }
    out.edge = edge(in) * frame.edge_strength;
    let ink = select(vec3<f32>(0.02), vec3<f32>(0.75, 0.82, 0.9), frame.dark > 0.5);
    out.color = mix(out.color, ink, 0.55 * out.edge);
    out.alpha = max(out.alpha, 0.5 * out.edge);
    return out;
}

fn is_clipped(in: Surface) -> bool {
    return dot(frame.clip.xyz, in.position) + frame.clip.w < 0.0;
}

@fragment
fn fs_opaque(in: Surface, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    if is_clipped(in) {
        discard;
    }
    let surface = lit(in, front);
    if surface.alpha < 0.999 {
        discard;
    }
    return vec4<f32>(surface.color, 1.0);
}

@fragment
fn fs_translucent(in: Surface, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    if is_clipped(in) {
        discard;
    }
    let surface = lit(in, front);
    if surface.alpha >= 0.999 || surface.alpha < 0.002 {
        discard;
    }
    return vec4<f32>(surface.color * surface.alpha, surface.alpha);
}
