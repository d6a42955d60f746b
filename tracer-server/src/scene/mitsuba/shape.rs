//! Shapes: meshes from files, exact spheres, and the rest as triangles.

use std::f64::consts::TAU;
use std::path::Path;

use glam::{DMat3, DMat4, DVec3, Vec2, Vec3};

use super::document::Element;
use super::transform::uniform_scale;
use super::{mesh, ply};
use crate::scene::description::Mesh;
use crate::scene::obj;
use crate::scene::reading::diagnostic::{LoadError, Warning};
use crate::scene::reading::shape;

/// Number of sides that stand for a circle.
const SIDES: u32 = 256;
/// Rings of a sphere that a transform makes an ellipsoid.
const RINGS: u32 = 128;

/// What a shape is, in the units of the world and still without a material.
#[derive(Debug)]
pub(super) enum Geometry {
    /// Triangles.
    Meshes(Vec<Mesh>),
    /// An exact sphere.
    Sphere {
        /// Its middle.
        centre: DVec3,
        /// Its radius.
        radius: f64,
        /// From directions in the world to those of its texture.
        turn: DMat3,
        /// True when its front side is its inside.
        inwards: bool,
    },
}

/// A shape, and what of it is not supported.
#[derive(Debug)]
pub(super) struct Shape {
    /// A name for people.
    pub(super) name: String,
    /// Its surface.
    pub(super) geometry: Geometry,
    /// What is not modelled of it.
    pub(super) warnings: Vec<Warning>,
}

/// Reads a `shape`.
pub(super) fn read(element: Element<'_>) -> Result<Shape, LoadError> {
    let to_world = element.transform("to_world")?;
    let flip = element.flag("flip_normals")?;
    let mut shape = Shape {
        name: element.label(),
        geometry: Geometry::Meshes(Vec::new()),
        warnings: Vec::new(),
    };
    let plugin = element.plugin()?;
    let mut meshes = match plugin.as_str() {
        "sphere" => match sphere(element, &to_world, flip, &mut shape)? {
            Some(ellipsoid) => vec![ellipsoid],
            None => return Ok(shape),
        },
        "obj" | "ply" => file(element, &plugin, &mut shape)?,
        "rectangle" => vec![rectangle()],
        "cube" => vec![cube()],
        "disk" => {
            let message = format!("the disk becomes a polygon of {SIDES} sides and the same area");
            shape.warnings.push(element.warning(message));
            vec![disk()]
        }
        "cylinder" => {
            let message = format!("the cylinder becomes a prism of {SIDES} sides");
            shape.warnings.push(element.warning(message));
            vec![cylinder(element)?]
        }
        _ => {
            let message = "unknown shape; supported: obj, ply, sphere, rectangle, cube, disk, \
                cylinder. Remove it, or convert it to one of these";
            return Err(element.error(message));
        }
    };
    let from_file = matches!(plugin.as_str(), "obj" | "ply");
    // The faces of a file keep their winding whatever the transform; the normals of other shapes
    // go along with them, and so does their front.
    let mirrored = !from_file && DMat3::from_mat4(to_world).determinant() < 0.0;
    for mesh in &mut meshes {
        mesh::transform(mesh, &to_world);
        if mirrored {
            mesh::flip(mesh);
        }
        mesh::face_along_normals(mesh);
    }
    finish(element, &mut meshes, from_file)?;
    for mesh in &mut meshes {
        mesh.name.clone_from(&shape.name);
    }
    shape.geometry = Geometry::Meshes(meshes);
    Ok(shape)
}

/// Shading normals as the shape asks for them, and the side it calls its front.
fn finish(element: Element<'_>, meshes: &mut [Mesh], from_file: bool) -> Result<(), LoadError> {
    let flat = element.flag("face_normals")?;
    let flip = element.flag("flip_normals")?;
    for mesh in meshes {
        if flat {
            mesh.normals.clear();
        } else if from_file && mesh.normals.is_empty() {
            mesh::smooth(mesh);
        }
        if flip {
            mesh::flip(mesh);
            mesh::negate_normals(mesh);
        }
    }
    Ok(())
}

fn file(element: Element<'_>, format: &str, shape: &mut Shape) -> Result<Vec<Mesh>, LoadError> {
    let name = element.string("filename")?.ok_or_else(|| {
        element.error("the parameter `filename` is missing: the file with the mesh")
    })?;
    let path = element.file(&name);
    if !element.is_named()
        && let Some(stem) = Path::new(&name).file_stem()
    {
        shape.name = stem.to_string_lossy().into_owned();
    }
    let meshes = if format == "obj" { read_obj(&path, shape) } else { Ok(vec![ply::read(&path)?]) };
    let mut meshes = meshes.map_err(|error| {
        let is_unreadable = matches!(error, LoadError::Unreadable { .. });
        if is_unreadable { element.error(error.to_string()) } else { error }
    })?;
    // Images of OBJ files stand upright; those of the renderer's own have v pointing down.
    let upright = element.boolean("flip_tex_coords")?.unwrap_or(format == "obj");
    if !upright {
        meshes.iter_mut().for_each(mesh::turn_texture_over);
    }
    Ok(meshes)
}

fn read_obj(path: &Path, shape: &mut Shape) -> Result<Vec<Mesh>, LoadError> {
    let (meshes, warnings) = obj::read_geometry(path)?;
    shape.warnings.extend(warnings);
    Ok(meshes)
}

/// Makes `shape` an exact sphere, or returns the ellipsoid that the transform makes of it.
fn sphere(
    element: Element<'_>,
    to_world: &DMat4,
    flip: bool,
    shape: &mut Shape,
) -> Result<Option<Mesh>, LoadError> {
    let centre = element.point("center")?.unwrap_or(DVec3::ZERO);
    let radius = element.number("radius")?.unwrap_or(1.0);
    if !(radius > 0.0) {
        return Err(element.error(format!("radius is {radius}; it must be positive")));
    }
    if let Some(scale) = uniform_scale(to_world) {
        let centre = to_world.transform_point3(centre);
        let linear = DMat3::from_mat4(*to_world) * (1.0 / scale);
        // The renderer's poles are at +z and -z.
        let poles = DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::Y);
        let turn = poles * linear.transpose();
        // A mirror turns it inside out from version 1 on.
        let mirrored = linear.determinant() < 0.0 && !element.is_of_old();
        let inwards = flip != mirrored;
        shape.geometry = Geometry::Sphere { centre, radius: radius * scale, turn, inwards };
        return Ok(None);
    }
    let message = "its transform makes it an ellipsoid, which becomes a mesh";
    shape.warnings.push(element.warning(message));
    Ok(Some(ellipsoid(centre, radius)))
}

/// The square [-1, 1] x [-1, 1] in the plane z = 0, which faces +z.
fn rectangle() -> Mesh {
    let quad =
        shape::Quad { corner: DVec3::new(-1.0, -1.0, 0.0), u: 2.0 * DVec3::X, v: 2.0 * DVec3::Y };
    // The renderer's images begin at v = 0, at the lower edge: they hang upside down.
    let [a, b, c, d] = [Vec2::new(0.0, 1.0), Vec2::ONE, Vec2::new(1.0, 0.0), Vec2::ZERO];
    flat(quad.surface(), vec![[a, b, c], [a, c, d]])
}

/// The cube from (-1, -1, -1) to (1, 1, 1), which faces outwards.
fn cube() -> Mesh {
    let cuboid = shape::Cuboid { min: DVec3::NEG_ONE, max: DVec3::ONE };
    // As the renderer lays an image over each face: (0, 1), (1, 1), (1, 0), (0, 0), hanging upside down.
    let coordinates = |point: DVec3, normal: DVec3| {
        let [x, y, z] = point.to_array().map(|c| 0.5 + 0.5 * c as f32);
        match normal.to_array().map(|c| c.round() as i32) {
            [_, -1, _] => Vec2::new(z, 1.0 - x),
            [_, 1, _] => Vec2::new(1.0 - x, z),
            [1, ..] => Vec2::new(y, z),
            [_, _, 1] => Vec2::new(y, 1.0 - x),
            [-1, ..] => Vec2::new(y, 1.0 - z),
            _ => Vec2::new(1.0 - y, 1.0 - x),
        }
    };
    let surface = cuboid.surface();
    let of_triangle = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|i| surface.positions[i as usize]);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        [a, b, c].map(|corner| coordinates(corner, normal))
    };
    let texcoords = surface.triangles.iter().map(of_triangle).collect();
    flat(surface, texcoords)
}

/// The unit disk in the plane z = 0, which faces +z: a fan about its middle.
fn disk() -> Mesh {
    let sides = f64::from(SIDES);
    // The polygon has the area of the circle, so that a lamp keeps its power.
    let radius = (TAU / (sides * (TAU / sides).sin())).sqrt();
    let rim = (0..SIDES).map(|i| radius * circle(i));
    Mesh {
        positions: std::iter::once(DVec3::ZERO).chain(rim).collect(),
        triangles: (0..SIDES).map(|i| [0, 1 + i, 1 + (i + 1) % SIDES]).collect(),
        // The radius, and the share of a turn, from the image's other edge.
        texcoords: (0..SIDES)
            .map(|i| {
                let share = |i: f32| 1.0 - i / SIDES as f32;
                let i = i as f32;
                [(0.0, i + 0.5), (1.0, i), (1.0, i + 1.0)].map(|(r, i)| Vec2::new(r, share(i)))
            })
            .collect(),
        ..Mesh::default()
    }
}

/// Point `i` of a unit circle about the z axis.
fn circle(i: u32) -> DVec3 {
    let (sin, cos) = (TAU * f64::from(i) / f64::from(SIDES)).sin_cos();
    DVec3::new(cos, sin, 0.0)
}

/// The side of a cylinder from `p0` to `p1`, without its ends, which faces outwards.
fn cylinder(element: Element<'_>) -> Result<Mesh, LoadError> {
    let p0 = element.point("p0")?.unwrap_or(DVec3::ZERO);
    let p1 = element.point("p1")?.unwrap_or(DVec3::Z);
    let radius = element.number("radius")?.unwrap_or(1.0);
    let axis = (p1 - p0).try_normalize();
    let Some(axis) = axis.filter(|_| radius > 0.0) else {
        return Err(element.error("p0 and p1 must differ, and the radius be positive"));
    };
    let (x, y) = axis.any_orthonormal_pair();
    let out = |i: u32| DMat3::from_cols(x, y, axis) * circle(i);
    let rims = [p0, p1].map(|end| (0..SIDES).map(move |i| end + radius * out(i)));
    let mut mesh = Mesh { positions: rims.into_iter().flatten().collect(), ..Mesh::default() };
    for i in 0..SIDES {
        let j = (i + 1) % SIDES;
        let [n, m] = [i, j].map(|k| out(k).as_vec3());
        mesh.triangles.extend([[i, j, SIDES + j], [i, SIDES + j, SIDES + i]]);
        mesh.normals.extend([[n, m, m], [n, m, n]]);
        // The share of a turn, and that of the way from p0 to p1.
        let corner = |i: u32, along: f32| Vec2::new(i as f32 / SIDES as f32, 1.0 - along);
        let [a, b] = [i, i + 1].map(|i| corner(i, 0.0));
        let [c, d] = [i, i + 1].map(|i| corner(i, 1.0));
        mesh.texcoords.extend([[a, b, d], [a, d, c]]);
    }
    Ok(mesh)
}

/// A sphere of triangles that faces inwards; `turn` leads to the directions of its texture.
pub(super) fn hollow(centre: DVec3, radius: f64, turn: DMat3) -> Mesh {
    let mut mesh = ellipsoid(DVec3::ZERO, radius);
    let poles = DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::Y);
    let axes = DMat4::from_mat3(turn.transpose() * poles);
    mesh::transform(&mut mesh, &(DMat4::from_translation(centre) * axes));
    mesh::face_along_normals(&mut mesh);
    mesh::flip(&mut mesh);
    mesh
}

/// A sphere of triangles with the normals of a sphere, which faces outwards.
fn ellipsoid(centre: DVec3, radius: f64) -> Mesh {
    let columns = 2 * RINGS;
    let mut normals: Vec<DVec3> = Vec::new();
    for ring in 0..=RINGS {
        let (sin, cos) = (0.5 * TAU * f64::from(ring) / f64::from(RINGS)).sin_cos();
        for column in 0..columns {
            let (y, x) = (TAU * f64::from(column) / f64::from(columns)).sin_cos();
            normals.push(DVec3::new(sin * x, sin * y, cos));
        }
    }
    let mut mesh = Mesh {
        positions: normals.iter().map(|&normal| centre + radius * normal).collect(),
        ..Mesh::default()
    };
    let mut push = |triangle: [u32; 3], texcoords: [Vec2; 3]| {
        let normal = |i: u32| normals.get(i as usize).map_or(Vec3::Z, |n| n.as_vec3());
        mesh.triangles.push(triangle);
        mesh.normals.push(triangle.map(normal));
        mesh.texcoords.push(texcoords);
    };
    for ring in 0..RINGS {
        for column in 0..columns {
            let at = |ring: u32, column: u32| ring * columns + column % columns;
            let [a, b] = [at(ring, column), at(ring, column + 1)];
            let [c, d] = [at(ring + 1, column), at(ring + 1, column + 1)];
            let coordinate = |ring: u32, column: u32| {
                Vec2::new(column as f32 / columns as f32, 1.0 - ring as f32 / RINGS as f32)
            };
            let [ta, tb] = [coordinate(ring, column), coordinate(ring, column + 1)];
            let [tc, td] = [coordinate(ring + 1, column), coordinate(ring + 1, column + 1)];
            // At the poles one of the two triangles has no area.
            if ring + 1 < RINGS {
                push([a, c, d], [ta, tc, td]);
            }
            if ring > 0 {
                push([a, d, b], [ta, td, tb]);
            }
        }
    }
    mesh
}

fn flat(surface: shape::Surface, texcoords: Vec<[Vec2; 3]>) -> Mesh {
    let shape::Surface { positions, triangles, .. } = surface;
    Mesh { positions, triangles, texcoords, ..Mesh::default() }
}
