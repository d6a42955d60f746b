//! PLY files, as text and in both binary forms; the only file that names their parser.

use std::io::{BufRead, Cursor};
use std::path::Path;

use glam::{DVec3, Vec2, Vec3};
use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{ElementDef, Header, Property, PropertyAccess, PropertyAccessResult};

use super::document::shorten;
use crate::scene::description::Mesh;
use crate::scene::description::check::MAX_TRIANGLES;
use crate::scene::reading::diagnostic::{LoadError, Place};
use crate::scene::reading::text::read_bytes;

/// The most bytes of a PLY file that are read.
const MAX_PLY_BYTES: u64 = 2 << 30;
/// The longest message of the parser that is passed on, in characters.
const MAX_MESSAGE: usize = 160;
/// The names that files give to the two texture coordinates.
const TEXCOORD_NAMES: [[&str; 2]; 3] = [["u", "v"], ["s", "t"], ["texture_u", "texture_v"]];
/// The names that files give to a face's list of corners.
const FACE_NAMES: [&str; 2] = ["vertex_indices", "vertex_index"];

/// Reads the triangles of a PLY file; the mesh has neither name nor materials yet.
pub(super) fn read(path: &Path) -> Result<Mesh, LoadError> {
    let bytes = read_bytes(path, MAX_PLY_BYTES)?;
    let length = bytes.len();
    let mut reader = Reader::new(Cursor::new(bytes));
    let header =
        Parser::<Vertex>::new().read_header(&mut reader).map_err(|error| refused(path, &error))?;
    let mut polygons = Polygons::default();
    for element in header.elements.values() {
        // Each takes at least a byte; a file that promises more would only fill the memory.
        if element.count > length || element.count > MAX_TRIANGLES {
            let message = format!(
                "the header promises {} of `{}`: more than the file can hold, or than \
                 {MAX_TRIANGLES}",
                element.count,
                shorten(&element.name)
            );
            return Err(Place::file(path).error(message));
        }
        polygons.read(&mut reader, element, &header).map_err(|error| refused(path, &error))?;
    }
    polygons.triangulate().map_err(|message| Place::file(path).error(message))
}

fn refused(path: &Path, error: &ParseError) -> LoadError {
    let place = error.line().map_or_else(|| Place::file(path), |line| Place::line(path, line));
    let message = error.to_string().split_whitespace().collect::<Vec<_>>().join(" ");
    let message: String = message.chars().take(MAX_MESSAGE).collect();
    place.error(format!("the PLY parser refuses this file: {message}"))
}

/// One `vertex`.
#[derive(Clone, Copy, Debug, Default)]
struct Vertex {
    position: DVec3,
    normal: Vec3,
    texcoord: Vec2,
}

impl PropertyAccess for Vertex {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let Some(number) = scalar(&property) else { return PropertyAccessResult::UnsupportedType };
        match name {
            "x" => self.position.x = number,
            "y" => self.position.y = number,
            "z" => self.position.z = number,
            "nx" => self.normal.x = number as f32,
            "ny" => self.normal.y = number as f32,
            "nz" => self.normal.z = number as f32,
            _ if TEXCOORD_NAMES.iter().any(|[u, _]| *u == name) => self.texcoord.x = number as f32,
            _ if TEXCOORD_NAMES.iter().any(|[_, v]| *v == name) => self.texcoord.y = number as f32,
            _ => return PropertyAccessResult::Ignored,
        }
        PropertyAccessResult::Set
    }
}

fn scalar(property: &Property) -> Option<f64> {
    match *property {
        Property::Char(value) => Some(f64::from(value)),
        Property::UChar(value) => Some(f64::from(value)),
        Property::Short(value) => Some(f64::from(value)),
        Property::UShort(value) => Some(f64::from(value)),
        Property::Int(value) => Some(f64::from(value)),
        Property::UInt(value) => Some(f64::from(value)),
        Property::Float(value) => Some(f64::from(value)),
        Property::Double(value) => Some(value),
        Property::ListChar(_)
        | Property::ListUChar(_)
        | Property::ListShort(_)
        | Property::ListUShort(_)
        | Property::ListInt(_)
        | Property::ListUInt(_)
        | Property::ListFloat(_)
        | Property::ListDouble(_) => None,
    }
}

/// One `face`: the indices of its corners.
#[derive(Clone, Debug, Default)]
struct Face(Vec<u32>);

impl PropertyAccess for Face {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        if !FACE_NAMES.contains(&name) {
            return PropertyAccessResult::Ignored;
        }
        match property.to_u32_list() {
            Some(corners) => {
                self.0 = corners;
                PropertyAccessResult::Set
            }
            None => PropertyAccessResult::UnsupportedType,
        }
    }
}

/// An element that is skipped.
#[derive(Clone, Copy, Debug)]
struct Other;

impl PropertyAccess for Other {
    fn new() -> Self {
        Self
    }
}

/// The content of a file.
#[derive(Debug, Default)]
struct Polygons {
    vertices: Vec<Vertex>,
    faces: Vec<Face>,
    has_normals: bool,
    has_texcoords: bool,
}

impl Polygons {
    fn read(
        &mut self,
        reader: &mut Reader<impl BufRead>,
        element: &ElementDef,
        header: &Header,
    ) -> Result<(), ParseError> {
        match element.name.as_str() {
            "vertex" => {
                let has = |name: &str| element.properties.contains_key(name);
                self.has_normals = ["nx", "ny", "nz"].into_iter().all(has);
                self.has_texcoords = TEXCOORD_NAMES.iter().any(|pair| pair.iter().all(|n| has(n)));
                self.vertices = Parser::new().read_payload_for_element(reader, element, header)?;
            }
            "face" => {
                self.faces = Parser::new().read_payload_for_element(reader, element, header)?;
            }
            _ => {
                let parser = Parser::<Other>::new();
                parser.read_payload_for_element(reader, element, header)?;
            }
        }
        Ok(())
    }

    /// Cuts polygons into fans.
    fn triangulate(&self) -> Result<Mesh, String> {
        let positions = self.vertices.iter().map(|vertex| vertex.position).collect();
        let mut mesh = Mesh { positions, ..Mesh::default() };
        for (i, Face(corners)) in self.faces.iter().enumerate() {
            let Some((&first, rest)) = corners.split_first().filter(|(_, rest)| rest.len() > 1)
            else {
                return Err(format!("face {i} has fewer than three corners"));
            };
            for pair in rest.windows(2) {
                let triangle = [first, pair[0], pair[1]];
                self.push(&mut mesh, triangle).map_err(|bad| {
                    let count = self.vertices.len();
                    format!("face {i} refers to vertex {bad}, but there are only {count}")
                })?;
            }
            if mesh.triangles.len() > MAX_TRIANGLES {
                return Err(format!("more than {MAX_TRIANGLES} triangles; use a coarser mesh"));
            }
        }
        Ok(mesh)
    }

    /// Appends a triangle, or tells the index that no vertex has.
    fn push(&self, mesh: &mut Mesh, triangle: [u32; 3]) -> Result<(), u32> {
        let mut corners = [Vertex::default(); 3];
        for (corner, index) in corners.iter_mut().zip(triangle) {
            *corner = *self.vertices.get(index as usize).ok_or(index)?;
        }
        mesh.triangles.push(triangle);
        if self.has_normals {
            mesh.normals.push(corners.map(|corner| corner.normal));
        }
        if self.has_texcoords {
            mesh.texcoords.push(corners.map(|corner| corner.texcoord));
        }
        Ok(())
    }
}
