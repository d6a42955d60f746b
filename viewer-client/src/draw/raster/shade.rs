//! Colours and opacities of points, and where they are on the screen.
//!
//! Twin of the vertex stage of `lines.wgsl`, where every number is explained; a test holds their
//! pictures against each other in every mode of colour.

use glam::{Vec3, Vec4};
use shaders::{FrameUniforms, LinePoint, ORDINAL_BITS, THROUGHPUT_CODE, decode_radiance, role};

const DEPTH_BIAS: f32 = 1.001;
const START_TINT: Vec3 = Vec3::new(1.0, 0.55, 0.10);
const END_TINT: Vec3 = Vec3::new(0.16, 0.48, 1.0);
const LONGEST: f32 = 10.0;
const FAINTEST: f32 = -10.0;
const LONGEST_DWELL: f32 = 4.0;
const UNKNOWN: Vec3 = Vec3::splat(0.18);

/// A point in clip space with the colour that it has there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shaded {
    /// Depth is reversed.
    pub(super) clip: Vec4,
    /// On which side of the clip plane it lies: what is negative is not drawn.
    pub(super) side: f32,
    /// Linear colour, and opacity before the depth cue.
    pub(super) color: Vec4,
    /// Role bits and kind.
    role: u8,
}

impl Shaded {
    pub(super) fn starts(self) -> bool {
        self.role & role::START != 0
    }

    /// No segment follows.
    pub(super) fn is_last(self) -> bool {
        self.role & role::LAST != 0
    }
}

/// Shades points as a picture wants them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shader<'a> {
    pub(super) frame: &'a FrameUniforms,
}

impl Shader<'_> {
    pub(super) fn shade(self, point: &LinePoint) -> Shaded {
        let frame = self.frame;
        let position = Vec3::from(point.position);
        let [role, ..] = point.info;
        let mut rgb = self.path_color(point);
        if frame.tint_ends == 1 && role & role::START != 0 {
            rgb = rgb.lerp(START_TINT, 0.8);
        } else if frame.tint_ends == 1 && role & role::LAST != 0 {
            rgb = rgb.lerp(END_TINT, 0.8);
        }
        let mut bright = if frame.color_mode == 0 {
            0.22 + (1.0 - 0.22) * self.brightness(point.color[3])
        } else {
            0.8
        };
        if role & role::DIMMED != 0 {
            bright *= frame.unmatched_opacity;
        }
        let fresh = frame.faded + (1.0 - frame.faded) * self.freshness(point.ordinal);
        let mut clip = frame.view_projection * position.extend(1.0);
        clip.z *= DEPTH_BIAS;
        Shaded {
            clip,
            side: frame.clip.dot(position.extend(1.0)),
            color: rgb.extend(frame.line_opacity * fresh * bright),
            role,
        }
    }

    /// How much is left of an opacity at a distance along the view.
    pub(super) fn cue(self, distance: f32) -> f32 {
        1.0 - 0.95 * self.frame.cue_strength * self.depth(distance)
    }

    /// What a path weighs at a distance, where paths are weighed against each other.
    pub(super) fn weight(self, distance: f32) -> f32 {
        4.0 * (-4.0 * self.depth(distance)).exp()
    }

    /// A distance along the view from 0, where the cue begins, to 1.
    fn depth(self, distance: f32) -> f32 {
        ((distance - self.frame.cue_begin) * self.frame.cue_inverse_reach).clamp(0.0, 1.0)
    }

    /// The tint of the last vertex that is seen, where dots mark ends only.
    pub(super) fn end_of(self, color: Vec4) -> Vec4 {
        let tinted = self.frame.ends_only == 1 && self.frame.tint_ends == 1;
        if tinted { color.truncate().lerp(END_TINT, 0.8).extend(color.w) } else { color }
    }

    fn path_color(self, point: &LinePoint) -> Vec3 {
        let frame = self.frame;
        let [kind, strategy, hues, throughput] = point.info;
        let palette = |i: u8| frame.palette[usize::from(i & 15)].truncate();
        match frame.color_mode {
            1 => palette(strategy),
            2 => {
                let edges = f32::from(strategy >> 4).max(1.0);
                let linear = (edges - 1.0) / (LONGEST - 1.0);
                self.scaled(edges.log2() / LONGEST.log2(), linear)
            }
            3 => {
                let place = self.brightness(point.color[3]);
                self.scaled(place, ((place - 1.0) / frame.inverse_range.max(1e-6)).exp2())
            }
            4 => self.ramp(self.freshness(point.ordinal)),
            5 => palette(kind >> role::KIND_SHIFT),
            6 => palette(hues),
            7 => palette(hues >> 4),
            8 => frame.constant,
            9 if throughput == 0 => UNKNOWN,
            9 => {
                let [codes, lowest] = THROUGHPUT_CODE;
                let stops = (f32::from(throughput) - 1.0) / codes + lowest;
                self.scaled(1.0 - stops / FAINTEST, stops.exp2())
            }
            10 => self.ramp((point.ordinal >> (ORDINAL_BITS + 4)) as f32 / LONGEST_DWELL),
            11 => self.ramp(((point.ordinal >> ORDINAL_BITS) & 15) as f32 / 15.0),
            _ => {
                let [r, g, b, _] = point.color.map(|c| f32::from(c) / 255.0);
                Vec3::new(r * r, g * g, b * b)
            }
        }
    }

    /// A colour of the ramp, on whichever scale is chosen.
    fn scaled(self, logarithmic: f32, linear: f32) -> Vec3 {
        self.ramp(if self.frame.logarithmic == 1 { logarithmic } else { linear })
    }

    fn ramp(self, place: f32) -> Vec3 {
        let x = place.clamp(0.0, 1.0) * 7.0;
        let i = x.min(6.0) as usize;
        let [low, high] = [self.frame.ramp[i], self.frame.ramp[i + 1]];
        low.truncate().lerp(high.truncate(), x - i as f32)
    }

    fn brightness(self, code: u8) -> f32 {
        let Self { frame } = self;
        ((decode_radiance(code) - frame.darkest) * frame.inverse_range).clamp(0.0, 1.0)
    }

    fn freshness(self, ordinal: u32) -> f32 {
        let age = self.frame.newest.wrapping_sub(ordinal) & ((1 << ORDINAL_BITS) - 1);
        (-(age as f32) / self.frame.fade_age.max(1.0)).exp()
    }
}
