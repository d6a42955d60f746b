// Polylines of constant width in pixels, and dots at their vertices.
//
// The buffer of points is bound twice, the second time one point further, so that instance `i`
// sees points `i` and `i + 1`: a segment costs no more than its vertex. The last point of a
// polyline says so, and the segment to the next polyline's first point is thrown away.

const ROLE_START: u32 = 1u;
const ROLE_LAST: u32 = 2u;
const ROLE_ANNOTATION: u32 = 4u;
const ROLE_DIMMED: u32 = 8u;
const KIND_SHIFT: u32 = 4u;
const ORDINAL_BITS: u32 = 24u;
const THROUGHPUT_CODES: f32 = 8.0;
const THROUGHPUT_LOWEST: f32 = -28.0;

// Twin: `LinePoint`, at locations 0 to 3 and again at 4 to 7.
struct Segment {
    @location(0) position_a: vec3<f32>,
    // rgb: square root of the colour over its largest channel; a: code of the radiance.
    @location(1) color_a: vec4<f32>,
    // Number of the path; above it acceptance in fifteenths and log2 of the dwell.
    @location(2) ordinal_a: u32,
    // Role bits and kind of vertex, strategy and number of edges, chain and class colours, throughput.
    @location(3) info_a: vec4<u32>,
    @location(4) position_b: vec3<f32>,
    @location(5) color_b: vec4<f32>,
    @location(6) ordinal_b: u32,
    @location(7) info_b: vec4<u32>,
}

struct Fragment {
    @builtin(position) position: vec4<f32>,
    // Premultiplied colour without coverage.
    @location(0) color: vec4<f32>,
    // Distance from the middle in pixels times w, then w: their quotient is linear on the screen,
    // which WebGL 2 cannot interpolate by itself.
    @location(1) across: vec3<f32>,
    @location(2) @interpolate(flat) half_width: f32,
}

const CODE_STOPS: f32 = 64.0;
const CODE_LOWEST: f32 = -40.0;
const NOWHERE = vec4<f32>(2.0, 2.0, 2.0, 1.0);
// Lines win over the surface they lie on: this much of the distance, towards the eye.
const DEPTH_BIAS: f32 = 1.001;
// Drawing aids keep one width in pixels.
const ANNOTATION_WIDTH: f32 = 1.25;
const START_TINT = vec3<f32>(1.0, 0.55, 0.10);
const END_TINT = vec3<f32>(0.16, 0.48, 1.0);

// Where the ramp of lengths ends, in edges.
const LONGEST: f32 = 10.0;
// Where the logarithmic ramp of throughputs begins, in stops.
const FAINTEST: f32 = -10.0;
// Where the ramp of dwells ends, in stops: 16 steps and more; a chain is shown for some twenty.
const LONGEST_DWELL: f32 = 4.0;
const UNKNOWN = vec3<f32>(0.18, 0.18, 0.18);

fn ramp(place: f32) -> vec3<f32> {
    let x = clamp(place, 0.0, 1.0) * 7.0;
    let i = u32(min(x, 6.0));
    return mix(frame.ramp[i].rgb, frame.ramp[i + 1u].rgb, x - f32(i));
}

fn hue_of_length(edges: u32) -> vec3<f32> {
    let e = max(f32(edges), 1.0);
    return ramp(select((e - 1.0) / (LONGEST - 1.0), log2(e) / log2(LONGEST), frame.logarithmic == 1u));
}

fn radiance_code_to_brightness(code: f32) -> f32 {
    let stops = code * CODE_STOPS + CODE_LOWEST;
    return clamp((stops - frame.darkest) * frame.inverse_range, 0.0, 1.0);
}

fn hue_of_luminance(code: f32) -> vec3<f32> {
    let place = radiance_code_to_brightness(code);
    // Linear in the radiance itself: each stop below the brightest halves it.
    let linear = exp2((place - 1.0) / max(frame.inverse_range, 1e-6));
    return ramp(select(linear, place, frame.logarithmic == 1u));
}

fn hue_of_throughput(code: u32) -> vec3<f32> {
    if code == 0u {
        return UNKNOWN;
    }
    let stops = (f32(code) - 1.0) / THROUGHPUT_CODES + THROUGHPUT_LOWEST;
    return ramp(select(exp2(stops), 1.0 - stops / FAINTEST, frame.logarithmic == 1u));
}

// 1 for the newest path, 1/e after the fading age.
fn freshness(ordinal: u32) -> f32 {
    let age = (frame.newest - ordinal) & ((1u << ORDINAL_BITS) - 1u);
    return exp(-f32(age) / max(frame.fade_age, 1.0));
}

fn path_color(color: vec4<f32>, ordinal: u32, info: vec4<u32>) -> vec3<f32> {
    switch frame.color_mode {
        case 1u: { return frame.palette[info.y & 15u].rgb; }
        case 2u: { return hue_of_length(info.y >> 4u); }
        case 3u: { return hue_of_luminance(color.a); }
        case 4u: { return ramp(freshness(ordinal)); }
        case 5u: { return frame.palette[info.x >> KIND_SHIFT].rgb; }
        case 6u: { return frame.palette[info.z & 15u].rgb; }
        case 7u: { return frame.palette[info.z >> 4u].rgb; }
        case 8u: { return frame.constant; }
        case 9u: { return hue_of_throughput(info.w); }
        case 10u: { return ramp(f32(ordinal >> (ORDINAL_BITS + 4u)) / LONGEST_DWELL); }
        case 11u: { return ramp(f32((ordinal >> ORDINAL_BITS) & 15u) / 15.0); }
        default: { return color.rgb * color.rgb; }
    }
}

// How much is left of a line's opacity at a distance along the view.
fn cue(distance: f32) -> f32 {
    let depth = clamp((distance - frame.cue_begin) * frame.cue_inverse_reach, 0.0, 1.0);
    return 1.0 - 0.95 * frame.cue_strength * depth;
}

// Colour and opacity of one end of a segment.
fn shade(color: vec4<f32>, ordinal: u32, info: vec4<u32>) -> vec4<f32> {
    if (info.x & ROLE_ANNOTATION) != 0u {
        return vec4<f32>(color.rgb * color.rgb, color.a);
    }
    let fresh = mix(frame.faded, 1.0, freshness(ordinal));
    var rgb = path_color(color, ordinal, info);
    if frame.tint_ends == 1u && (info.x & ROLE_START) != 0u {
        rgb = mix(rgb, START_TINT, 0.8);
    } else if frame.tint_ends == 1u && (info.x & ROLE_LAST) != 0u {
        rgb = mix(rgb, END_TINT, 0.8);
    }
    // Where colour does not say how bright a path is, opacity must not suggest it.
    var bright = 0.8;
    if frame.color_mode == 0u {
        bright = mix(0.22, 1.0, radiance_code_to_brightness(color.a));
    }
    if (info.x & ROLE_DIMMED) != 0u {
        bright *= frame.unmatched_opacity;
    }
    return vec4<f32>(rgb, frame.line_opacity * fresh * bright);
}

fn line_vertex(s: Segment, corner: u32) -> Fragment {
    var out: Fragment;
    out.position = NOWHERE;
    if (s.info_a.x & ROLE_LAST) != 0u {
        return out;
    }
    let side_a = dot(frame.clip.xyz, s.position_a) + frame.clip.w;
    let side_b = dot(frame.clip.xyz, s.position_b) + frame.clip.w;
    if side_a < 0.0 && side_b < 0.0 {
        return out;
    }
    var a = frame.view_projection * vec4<f32>(s.position_a, 1.0);
    var b = frame.view_projection * vec4<f32>(s.position_b, 1.0);
    var color_a = shade(s.color_a, s.ordinal_a, s.info_a);
    var color_b = shade(s.color_b, s.ordinal_b, s.info_b);
    if side_a < 0.0 {
        a = mix(a, b, side_a / (side_a - side_b));
    } else if side_b < 0.0 {
        b = mix(b, a, side_b / (side_b - side_a));
    }
    let annotation = (s.info_a.x & ROLE_ANNOTATION) != 0u;
    if !annotation && (s.info_b.x & ROLE_LAST) != 0u {
        // All paths end in one point, the pinhole: thinned out towards it, or it would blind.
        color_a.a *= mix(frame.lens_opacity, 1.0, 0.22);
        color_b.a *= frame.lens_opacity;
    }
    if !annotation {
        color_a.a *= cue(a.w);
        color_b.a *= cue(b.w);
    }
    let near = frame.near;
    if a.w < near && b.w < near {
        return out;
    }
    // Cut at the near plane: behind the eye the projection turns over.
    if a.w < near {
        let t = (near - a.w) / (b.w - a.w);
        a = mix(a, b, t);
        color_a = mix(color_a, color_b, t);
    } else if b.w < near {
        let t = (near - b.w) / (a.w - b.w);
        b = mix(b, a, t);
        color_b = mix(color_b, color_a, t);
    }
    let half_size = 0.5 * frame.size;
    let pixel_a = a.xy / a.w * half_size;
    let pixel_b = b.xy / b.w * half_size;
    let delta = pixel_b - pixel_a;
    let length_px = length(delta);
    let direction = select(vec2<f32>(1.0, 0.0), delta / length_px, length_px > 1e-4);
    let normal = vec2<f32>(-direction.y, direction.x);

    let wanted = select(frame.line_width, ANNOTATION_WIDTH, annotation);
    let width = max(wanted, 1.0);
    // Half a pixel beyond the edge the coverage is zero; software pays for every fragment.
    let reach = 0.5 * width + 0.5;
    let side = select(-1.0, 1.0, (corner & 1u) == 1u);
    let at_b = corner >= 2u;
    let clip = select(a, b, at_b);
    let shift = (normal * side * reach + direction * select(-0.5, 0.5, at_b)) / half_size;
    let color = select(color_a, color_b, at_b);
    // Lines below a pixel keep one pixel and lose opacity instead.
    let alpha = color.a * min(wanted, 1.0);

    out.position = vec4<f32>(clip.xy + shift * clip.w, clip.z * DEPTH_BIAS, clip.w);
    out.color = vec4<f32>(color.rgb * alpha, alpha);
    out.across = vec3<f32>(side * reach * clip.w, 0.0, clip.w);
    out.half_width = 0.5 * width;
    return out;
}

@vertex
fn vs_line(s: Segment, @builtin(vertex_index) corner: u32) -> Fragment {
    return line_vertex(s, corner);
}

// The same, as faint as the part of a path behind a surface is drawn.
@vertex
fn vs_line_hidden(s: Segment, @builtin(vertex_index) corner: u32) -> Fragment {
    var out = line_vertex(s, corner);
    out.color *= frame.hidden_opacity;
    return out;
}

@vertex
fn vs_dot(s: Segment, @builtin(vertex_index) corner: u32) -> Fragment {
    var out: Fragment;
    out.position = NOWHERE;
    let starts = (s.info_a.x & ROLE_START) != 0u;
    let ends = (s.info_a.x & ROLE_LAST) != 0u;
    // The lens is one point for all paths; their visible end is the vertex before it.
    let seen = (s.info_b.x & ROLE_LAST) != 0u && !ends;
    let wanted = frame.ends_only == 0u || starts || seen;
    let radius = select(0.0, select(frame.dot_radius, frame.start_radius, starts), wanted);
    let clip = frame.view_projection * vec4<f32>(s.position_a, 1.0);
    let skipped = (s.info_a.x & ROLE_ANNOTATION) != 0u || ends || radius <= 0.0;
    let clipped = dot(frame.clip.xyz, s.position_a) + frame.clip.w < 0.0;
    if skipped || clipped || clip.w < frame.near {
        return out;
    }
    let reach = radius + 1.0;
    let offset = vec2<f32>(
        select(-reach, reach, (corner & 1u) == 1u),
        select(-reach, reach, corner >= 2u),
    );
    var color = shade(s.color_a, s.ordinal_a, s.info_a);
    if frame.ends_only == 1u && frame.tint_ends == 1u && seen {
        color = vec4<f32>(mix(color.rgb, END_TINT, 0.8), color.a);
    }
    let alpha = min(color.a * 1.6 * cue(clip.w), 1.0);
    let shift = offset / (0.5 * frame.size);
    out.position = vec4<f32>(clip.xy + shift * clip.w, clip.z * DEPTH_BIAS, clip.w);
    out.color = vec4<f32>(color.rgb * alpha, alpha);
    out.across = vec3<f32>(offset * clip.w, clip.w);
    out.half_width = radius;
    return out;
}

@fragment
fn fs_stroke(in: Fragment) -> @location(0) vec4<f32> {
    let distance = length(in.across.xy / in.across.z);
    let coverage = clamp(in.half_width + 0.5 - distance, 0.0, 1.0);
    let color = in.color * coverage;
    // Glow: less of what lies behind is taken away, so that crossing paths add up like light.
    return vec4<f32>(color.rgb, color.a * (1.0 - frame.glow));
}

// Weighted blending [McGuire and Bavoil 2013]: what no order of drawing changes.
struct Weighed {
    // rgb: the sum of weighted colours; a: what shines through all of them, as a product.
    @location(0) sum: vec4<f32>,
    // r: the sum of weights.
    @location(1) weight: vec4<f32>,
}

@fragment
fn fs_weighed(in: Fragment) -> Weighed {
    let distance = length(in.across.xy / in.across.z);
    let coverage = clamp(in.half_width + 0.5 - distance, 0.0, 1.0);
    let color = in.color * coverage;
    // Near paths count more than far ones. Sums of half floats must not overflow.
    let depth = clamp((in.across.z - frame.cue_begin) * frame.cue_inverse_reach, 0.0, 1.0);
    let weight = 4.0 * exp(-4.0 * depth);
    var out: Weighed;
    out.sum = vec4<f32>(color.rgb * weight, color.a);
    out.weight = vec4<f32>(color.a * weight, 0.0, 0.0, color.a);
    return out;
}
