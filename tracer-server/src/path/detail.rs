//! The numbers behind a path, for people.

use common::{PathDetail, VertexDetail, VertexKind};

use super::{Failure, Path};
use crate::scene::{Emission, Tracer};

impl Path {
    /// Densities, weights and geometry of every vertex and edge, and `1 / lum C_i` of every split.
    pub fn detail(&self, scene: &Tracer<'_>) -> Result<PathDetail, Failure> {
        let light = self.vertices().first().ok_or(Failure::LengthOutOfRange)?;
        let first = self.edges().first().ok_or(Failure::LengthOutOfRange)?;
        let emission = scene
            .emission(light.primitive, light.material, first.direction)
            .ok_or(Failure::ZeroContribution)?;
        let splits = 0..=self.edge_count();
        Ok(PathDetail {
            vertices: splits.clone().map(|j| self.vertex_detail(j, &emission)).collect(),
            geometry: self.edges().iter().map(|edge| edge.geometry).collect(),
            reciprocals: splits.map(|light| self.reciprocal(light)).collect(),
        })
    }

    fn vertex_detail(&self, j: usize, emission: &Emission) -> VertexDetail {
        let last = self.edge_count();
        let here = self.scattering(j);
        let (color, connection) = if j == 0 {
            (emission.color, emission.connection)
        } else {
            (here.color, here.connection)
        };
        let (light_pdf, light_weight) = match j {
            0 => (emission.pdf, 1.0 / emission.pdf),
            // Nothing hits the lens.
            j if j == last => (0.0, 0.0),
            1 => (self.departure_pdf(emission), emission.walk),
            j => (self.scattering(j - 1).light_pdf, self.scattering(j - 1).light_weight),
        };
        let (eye_pdf, eye_weight) = match j {
            0 if !emission.hittable => (0.0, 0.0),
            j if j + 1 >= last => (1.0, 1.0),
            j => (self.scattering(j + 1).eye_pdf, self.scattering(j + 1).eye_weight),
        };
        VertexDetail { color, light_pdf, light_weight, eye_pdf, eye_weight, connection }
    }

    /// Density with which a walk leaves the light along the first edge: what it would count for a
    /// connection, with the cosine of a surface, over what it counts for a walk.
    fn departure_pdf(&self, emission: &Emission) -> f64 {
        let (light, edge) = (&self.vertices()[0], &self.edges()[0]);
        let on_surface = light.kind == VertexKind::Light && !light.is_lamp();
        let cosine = if on_surface { light.normal.dot(edge.direction).abs() } else { 1.0 };
        if emission.walk > 0.0 { emission.connection * cosine / emission.walk } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::super::laws::sample_paths;
    use super::*;
    use crate::scene::fixtures::{diffuse_room, every_light, specular_room};

    fn agree(a: f64, b: f64) -> bool {
        (a - b).abs() <= 1e-9 * a.abs().max(b.abs())
    }

    /// Checks every split of a path; returns how many can make it.
    fn check_splits(name: &str, path: &Path, detail: &PathDetail) -> usize {
        let possible = detail.reciprocals.iter().enumerate().filter(|&(light, &reciprocal)| {
            let told = detail.contribution(light).expect("a split").luminance();
            let expected = if reciprocal > 0.0 { 1.0 / reciprocal } else { 0.0 };
            assert!(agree(told, expected), "{name}: {} split {light}", path.class());
            reciprocal > 0.0
        });
        possible.count()
    }

    #[test]
    fn what_is_told_gives_every_contribution() {
        let mut fixtures = every_light();
        fixtures.push(("specular room", specular_room()));
        for (name, fixture) in fixtures {
            let scene = fixture.build();
            let scene = Tracer::new(&scene);
            let mut compared = 0;
            for path in sample_paths(&scene, 150) {
                let detail = path.detail(&scene).expect("a path");
                assert!(agree(detail.luminance(), 1.0 / path.density_sum()), "{name}: the sum");
                compared += check_splits(name, &path, &detail);
            }
            assert!(compared > 500, "{name}: only {compared} splits");
        }
    }

    /// Density of the path where the split with `light` vertices on the light side makes it, per area
    /// of every vertex, or per solid angle of a start that is infinitely far away.
    fn density(path: &Path, detail: &PathDetail, light: usize) -> f64 {
        let (vertices, k) = (path.vertices(), path.edge_count());
        let per_area = |j: usize, edge: usize| {
            let cosine = vertices[j].normal.dot(path.edges()[edge].direction).abs();
            let span = vertices[edge + 1].position - vertices[edge].position;
            cosine / span.length_squared()
        };
        let from_light = (0..light).map(|j| {
            detail.vertices[j].light_pdf
                * match j {
                    0 => 1.0,
                    1 if path.is_lit_from_afar() => {
                        vertices[1].normal.dot(path.edges()[0].direction).abs()
                    }
                    j => per_area(j, j - 1),
                }
        });
        let from_eye = (light..=k).map(|j| {
            detail.vertices[j].eye_pdf
                * match j {
                    j if j == k => 1.0,
                    j if j + 1 == k => detail.geometry[j],
                    0 if path.is_lit_from_afar() => 1.0,
                    j => per_area(j, j),
                }
        });
        from_light.chain(from_eye).product()
    }

    /// What is `f = C_s p_s` for every split that can make the path.
    fn values(path: &Path, detail: &PathDetail) -> Vec<f64> {
        let possible = (0..=path.edge_count()).filter(|&s| detail.reciprocals[s] > 0.0);
        possible.map(|s| density(path, detail, s) / detail.reciprocals[s]).collect()
    }

    #[test]
    fn densities_and_contributions_are_of_one_path() {
        let mut fixtures = every_light();
        fixtures.push(("diffuse room", diffuse_room()));
        for (name, fixture) in fixtures {
            let scene = fixture.build();
            let scene = Tracer::new(&scene);
            let mut compared = 0;
            let is_plain = |path: &Path| !path.vertices().iter().any(|v| v.event.is_specular());
            for path in sample_paths(&scene, 150).into_iter().filter(is_plain) {
                let detail = path.detail(&scene).expect("a path");
                let values = values(&path, &detail);
                let same = values.windows(2).all(|pair| agree(pair[0], pair[1]));
                assert!(same, "{name}: {} {values:?}", path.class());
                compared += values.len();
            }
            assert!(compared > 300, "{name}: only {compared} splits");
        }
    }
}
