//! The numbers behind one path: what it is made of, and how probable each way to make it was.

use crate::{PathId, Rgb};

/// The answer to a question about a path.
#[derive(Clone, Debug, PartialEq)]
pub struct DetailReply {
    /// The path.
    pub path: PathId,
    /// Its numbers, or why there are none and what to do about it, for people.
    pub found: Result<PathDetail, String>,
}

/// The numbers behind one vertex.
///
/// A value and a density have the same measure: solid angle at the vertex that it is made from. The
/// start on a surface has a density per area, the start on the sky one per solid angle, and the choice of
/// a point, a spot or the sun is a probability; the next vertex from sky or sun has one per area of a disk
/// that faces it. The areas of lens and film are taken as one. Behind a Dirac event the density is the
/// event's probability.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct VertexDetail {
    /// What the vertex gives to the colour of the path: emission at the start, reflectance or
    /// transmittance inside, white on the lens.
    pub color: Rgb,
    /// Density of making it from the light side; zero where no walk generates it.
    pub light_pdf: f64,
    /// Value over density of making it from the light side, without colour.
    pub light_weight: f64,
    /// Density of making it from the eye side; zero where no walk generates it.
    pub eye_pdf: f64,
    /// Value over density of making it from the eye side, without colour.
    pub eye_weight: f64,
    /// What it gives to an explicit connection, without colour, in 1/sr; zero at a Dirac event.
    pub connection: f64,
}

/// The numbers behind a path of `k` edges.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PathDetail {
    /// `k + 1` entries, the light first.
    pub vertices: Vec<VertexDetail>,
    /// `k` entries: the geometry term of the edge from vertex `j` to its successor, in scene units;
    /// on the edge to the lens times film area per solid angle.
    pub geometry: Vec<f64>,
    /// `k + 1` entries: `1 / lum C_i` of the split with as many vertices on the light side as the index
    /// says; zero where that split cannot make the path.
    pub reciprocals: Vec<f64>,
}

impl PathDetail {
    /// Luminance of the path's value to a bidirectional path tracer, `1 / sum_i (1 / lum C_i)`.
    pub fn luminance(&self) -> f64 {
        1.0 / self.density_sum()
    }

    /// `S(x)`.
    fn density_sum(&self) -> f64 {
        self.reciprocals.iter().sum()
    }

    /// Share of a split in `S(x)`: its weight by the balance heuristic [Veach and Guibas 1995].
    pub fn share(&self, light: usize) -> f64 {
        self.reciprocals.get(light).map_or(0.0, |reciprocal| reciprocal / self.density_sum())
    }

    /// What a walk from the light carries when it has made vertex `j`.
    pub fn light_throughput(&self, j: usize) -> Rgb {
        let made = self.vertices.iter().take(j + 1);
        let colors = self.vertices.iter().take(j);
        let weight: f64 = made.map(|vertex| vertex.light_weight).product();
        colors.fold(Rgb::grey(weight), |product, vertex| product * vertex.color)
    }

    /// What a walk from the eye carries when it has made vertex `j`.
    pub fn eye_throughput(&self, j: usize) -> Rgb {
        let made = self.vertices.iter().skip(j);
        let colors = self.vertices.iter().skip(j + 1);
        let weight: f64 = made.map(|vertex| vertex.eye_weight).product();
        colors.fold(Rgb::grey(weight), |product, vertex| product * vertex.color)
    }

    /// `C_i` of the split with `light` vertices on the light side, from the numbers of vertices and
    /// edges alone.
    pub fn contribution(&self, light: usize) -> Option<Rgb> {
        let b = self.vertices.get(light)?;
        let eye = b.color * self.eye_throughput(light);
        let Some(i) = light.checked_sub(1) else { return Some(eye) };
        let a = self.vertices.get(i)?;
        let connection = a.connection * self.geometry.get(i)? * b.connection;
        Some(self.light_throughput(i) * a.color * (eye * connection))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grey lamp over a grey floor, from the light, by a connection, or by a hit.
    fn detail() -> PathDetail {
        let light = VertexDetail {
            color: Rgb::grey(10.0),
            light_pdf: 0.5,
            light_weight: 2.0,
            eye_pdf: 0.25,
            eye_weight: 3.0,
            connection: 1.0,
        };
        let floor = VertexDetail {
            color: Rgb::new(0.8, 0.4, 0.2),
            light_pdf: 0.3,
            light_weight: 3.0,
            eye_pdf: 1.0,
            eye_weight: 1.0,
            connection: 0.3,
        };
        let lens = VertexDetail {
            color: Rgb::WHITE,
            eye_pdf: 1.0,
            eye_weight: 1.0,
            connection: 1.0,
            ..VertexDetail::default()
        };
        let lum = |c: f64| c * Rgb::new(8.0, 4.0, 2.0).luminance();
        PathDetail {
            vertices: vec![light, floor, lens],
            geometry: vec![0.01, 0.02],
            reciprocals: vec![
                1.0 / lum(3.0),
                1.0 / lum(2.0 * 0.01 * 0.3),
                1.0 / lum(2.0 * 3.0 * 0.3 * 0.02),
            ],
        }
    }

    #[test]
    fn contributions_follow_from_the_parts() {
        let detail = detail();
        for (light, reciprocal) in detail.reciprocals.iter().enumerate() {
            let contribution = detail.contribution(light).expect("a split").luminance();
            assert!((contribution * reciprocal - 1.0).abs() < 1e-12, "split {light}");
        }
        let shares: f64 = (0..3).map(|light| detail.share(light)).sum();
        assert!((shares - 1.0).abs() < 1e-12, "the weights of all splits");
        assert!(detail.contribution(3).is_none() && detail.share(3) == 0.0, "no such split");
        assert_eq!(detail.light_throughput(0), Rgb::grey(2.0));
        assert_eq!(detail.light_throughput(1), Rgb::grey(60.0), "with what the light emits");
        assert_eq!(detail.eye_throughput(1), Rgb::WHITE);
        assert_eq!(detail.eye_throughput(0), Rgb::new(0.8, 0.4, 0.2) * 3.0);
    }
}
