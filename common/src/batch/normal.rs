//! Unit normals in four bytes.

use glam::Vec3;

/// Full scale of one octahedral normal component.
pub const NORMAL_SCALE: f32 = 32767.0;

/// Packs a unit normal into two 16-bit octahedral coordinates [Cigolle et al. 2014].
pub fn encode_normal(n: Vec3) -> [i16; 2] {
    let sum = n.x.abs() + n.y.abs() + n.z.abs();
    if !(sum > 0.0) {
        return [0, 0];
    }
    let (mut x, mut y) = (n.x / sum, n.y / sum);
    if n.z < 0.0 {
        (x, y) = ((1.0 - y.abs()) * x.signum(), (1.0 - x.abs()) * y.signum());
    }
    [(x * NORMAL_SCALE).round() as i16, (y * NORMAL_SCALE).round() as i16]
}

/// Unpacks an octahedral normal to a unit vector.
pub fn decode_normal(packed: [i16; 2]) -> Vec3 {
    let (x, y) = (f32::from(packed[0]) / NORMAL_SCALE, f32::from(packed[1]) / NORMAL_SCALE);
    let z = 1.0 - x.abs() - y.abs();
    let fold = (-z).max(0.0);
    let unfold = |c: f32| if c >= 0.0 { c - fold } else { c + fold };
    Vec3::new(unfold(x), unfold(y), z).normalize_or(Vec3::Z)
}
