//! A path as it travels.

use common::{Rgb, VertexRecord, encode_normal, encode_throughput};

use super::{Path, Vertex};

impl Vertex {
    /// The vertex rounded to what travels.
    pub fn record(&self) -> VertexRecord {
        VertexRecord {
            position: self.position.as_vec3().to_array(),
            normal: encode_normal(self.normal.as_vec3()),
            kind: self.kind,
            event: self.event,
            material: self.material,
            primitive: self.primitive,
        }
    }
}

impl Path {
    /// Replaces the contents of `out` by all vertices, the light first.
    pub fn record_into(&self, out: &mut Vec<VertexRecord>) {
        out.clear();
        out.extend(self.vertices().iter().map(Vertex::record));
    }

    /// Replaces the contents of `out` by the luminance of the throughput at every vertex, the light
    /// first, as [`common::encode_throughput`] has it: what a path tracer that samples the path's
    /// directions from the lens carries when it arrives there, which is one where the lens looks.
    pub fn throughputs_into(&self, out: &mut Vec<u8>) {
        out.clear();
        out.resize(self.vertices().len(), encode_throughput(1.0));
        let mut carried = Rgb::grey(1.0);
        for j in (1..self.edge_count()).rev() {
            let scattering = self.scattering(j);
            carried = carried * scattering.color * scattering.eye_weight;
            out[j - 1] = encode_throughput(carried.luminance() as f32);
        }
    }
}

#[cfg(test)]
mod tests {
    use common::decode_throughput;

    use crate::bsdf::Bsdf;
    use crate::math::{Rng, Stream};
    use crate::path::{BidirectionalSampler, CameraSample};
    use crate::scene::Tracer;
    use crate::scene::fixtures::diffuse_room;

    #[test]
    fn throughputs_are_products_of_albedos_where_all_is_matt() {
        let scene = diffuse_room().build();
        let scene = Tracer::new(&scene);
        let mut sampler = BidirectionalSampler::new(&scene);
        let mut rng = Rng::new(3, Stream::Laboratory, 0);
        let (mut codes, mut seen) = (Vec::new(), 0);
        let albedo = |material: u16| match scene.bsdf(material) {
            Bsdf::Lambert(matt) => matt.reflectance,
            other => panic!("all is matt, but {}", other.name()),
        };
        for _ in 0..200 {
            let aim = CameraSample::from_numbers(&scene, &mut rng);
            sampler.sample(&scene, aim, &mut rng, |path, _| {
                path.throughputs_into(&mut codes);
                let mut product = common::Rgb::grey(1.0);
                for j in (0..path.edge_count()).rev() {
                    let stops = decode_throughput(codes[j]).expect("known");
                    let expected = product.luminance().log2() as f32;
                    assert!((stops - expected).abs() <= 0.07, "{stops} at {j}, not {expected}");
                    product *= albedo(path.vertices()[j].material);
                    seen += 1;
                }
                assert_eq!(codes.len(), path.vertices().len(), "one a vertex");
            });
        }
        assert!(seen > 1000, "only {seen} vertices");
    }
}
