//! Functions of a path whose expectations no mutation may change.

use common::VertexKind;
use glam::DVec2;

use crate::path::Path;

/// Film bins along each side.
const BINS: usize = 6;
/// Path lengths that are watched one by one, in edges.
const LENGTHS: usize = 6;
/// Limits on the shortest edge, in units of the scene's own size.
const SHORTEST: [f64; 3] = [0.05, 0.2, 0.5];
/// The classes of paths that are watched apart, lest they drown among the rest.
const CLASSES: [&str; 3] =
    ["seen through mirrors or glass", "caustics", "several chains from the lens"];

/// What is watched of every path, in the order of [`evaluate`].
fn basic_names() -> Vec<String> {
    let mut names = Vec::new();
    for row in 0..BINS {
        names.extend((0..BINS).map(|column| format!("film row {row}, column {column}")));
    }
    names.extend(
        ["film |u - 1/2|", "film |v - 1/2|", "film distance from the middle"].map(str::to_owned),
    );
    names.extend((1..=LENGTHS).map(|k| format!("{k} edges")));
    names.push("number of specular vertices".to_owned());
    for end in ["first diffuse vertex", "light"] {
        names.extend(["x", "y", "z"].map(|axis| format!("{end}, {axis}")));
    }
    names.push("cosine at the light".to_owned());
    names.extend(SHORTEST.map(|limit| format!("shortest edge below {limit}")));
    names.push("magnitude of 1/S".to_owned());
    names.push("cosine at the vertex that is seen".to_owned());
    names.push("share of red".to_owned());
    names
}

/// The names of all functions, in the order of [`evaluate`].
pub fn names() -> Vec<String> {
    let basic = basic_names();
    let mut names = basic.clone();
    for class in CLASSES {
        names.push(class.to_owned());
        names.extend(basic.iter().map(|name| format!("{class}: {name}")));
    }
    names
}

/// Puts the values of all functions of `path` into `out`.
pub fn evaluate(path: &Path, out: &mut Vec<f64>) {
    let indicator = |condition: bool| f64::from(u8::from(condition));
    out.clear();
    let film = path.film();
    let bin = (film.y * BINS as f64) as usize * BINS + (film.x * BINS as f64) as usize;
    out.extend((0..BINS * BINS).map(|i| indicator(i == bin)));
    let off_centre = (film - DVec2::splat(0.5)).abs();
    out.extend([off_centre.x, off_centre.y, off_centre.max_element()]);
    let k = path.edge_count();
    out.extend((1..=LENGTHS).map(|n| indicator(n == k)));
    let vertices = path.vertices();
    out.push(vertices.iter().filter(|v| v.kind == VertexKind::Specular).count() as f64);
    // The size of a scene in its own units.
    let unit = 1.0 / 1024.0;
    let d = path.first_diffuse_from_eye();
    out.extend((vertices[d].position * unit).to_array());
    out.extend((vertices[0].position * unit).to_array());
    out.push(vertices[0].normal.dot(path.edges()[0].direction));
    let lengths = vertices.windows(2).map(|v| (v[1].position - v[0].position).length() * unit);
    let shortest = lengths.fold(f64::INFINITY, f64::min);
    out.extend(SHORTEST.map(|limit| indicator(shortest < limit)));
    out.push((1.0 / path.density_sum()).log10().floor());
    let seen = &vertices[k - 1];
    out.push(seen.normal.dot(path.edges()[k - 1].direction).abs());
    out.push(path.unit_color().r);

    let through_specular = k >= 2 && !path.is_connectable(k - 1);
    let caustic = k >= 3 && path.is_connectable(k - 1) && !path.is_connectable(k - 2);
    let several_chains = d >= 1 && !path.is_connectable(d - 1);
    let basic = out.len();
    for class in [through_specular, caustic, several_chains] {
        out.push(indicator(class));
        if class {
            out.extend_from_within(..basic);
        } else {
            out.resize(out.len() + basic, 0.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Rng, Stream};
    use crate::path::{BidirectionalSampler, CameraSample};
    use crate::scene::Tracer;
    use crate::scene::fixtures::specular_room;

    #[test]
    fn every_value_has_a_name() {
        let scene = specular_room().build();
        let scene = Tracer::new(&scene);
        let (names, mut values, mut paths) = (names(), Vec::new(), 0);
        let mut rng = Rng::new(1, Stream::Laboratory, 0);
        let aim = CameraSample::through(&scene, DVec2::splat(0.5), || [0.0; 2]);
        BidirectionalSampler::new(&scene).sample(&scene, aim, &mut rng, |path, _| {
            evaluate(path, &mut values);
            assert_eq!(values.len(), names.len(), "{}", path.class());
            let edges =
                names.iter().position(|name| *name == format!("{} edges", path.edge_count()));
            assert_eq!(edges.map(|index| values[index]), Some(1.0), "{}", path.class());
            paths += 1;
        });
        assert!(paths > 0, "the sample holds paths");
    }
}
