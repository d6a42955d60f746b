//! The scene, cut into chunks and put together again.

use common::{FilterObject, MaterialInfo, SceneFrame, SceneMesh, TexturePreview};

use super::{WireError, camera, check, column};
use crate::v1;
use crate::v1::scene_chunk::Part;

/// Vertices in a chunk: 32 bytes each at most.
const VERTICES_PER_CHUNK: usize = 16 << 10;
/// Triangles in a chunk: 18 bytes each.
const TRIANGLES_PER_CHUNK: usize = 16 << 10;
/// Materials in a chunk: less than 700 bytes each, whatever their names.
const MATERIALS_PER_CHUNK: usize = 1 << 10;
/// Most materials; triangles refer to them by two bytes.
const MAX_MATERIALS: u32 = 1 << 16;
/// Objects in a chunk: less than 300 bytes each.
const OBJECTS_PER_CHUNK: usize = 1 << 10;
/// Most vertices, triangles and objects that a viewer accepts.
const MAX_ELEMENTS: u32 = 1 << 26;

/// The scene as chunks below 1 MiB, cut as they are taken.
pub fn scene_chunks<'a>(
    hash: &str,
    frame: SceneFrame,
    mesh: &'a SceneMesh,
) -> impl Iterator<Item = v1::SceneChunk> + 'a {
    let header = v1::SceneHeader {
        hash: hash.to_owned(),
        unchanged: false,
        frame: Some(frame.into()),
        camera: mesh.camera.map(Into::into),
        material_count: mesh.materials.len() as u32,
        vertex_count: mesh.positions.len() as u32,
        triangle_count: mesh.triangles.len() as u32,
        object_count: mesh.objects.len() as u32,
        texture_count: mesh.textures.len() as u32,
    };
    let materials = mesh.materials.chunks(MATERIALS_PER_CHUNK).map(|part| {
        Part::Materials(v1::SceneMaterials { materials: part.iter().map(Into::into).collect() })
    });
    let textures = mesh.textures.iter().map(|texture| {
        Part::Texture(v1::SceneTexture {
            width: texture.width,
            height: texture.height,
            texels: column::encode(&texture.texels),
        })
    });
    let texcoords = mesh.texcoords.chunks(VERTICES_PER_CHUNK).chain(std::iter::repeat(&[][..]));
    let vertices = mesh
        .positions
        .chunks(VERTICES_PER_CHUNK)
        .zip(mesh.normals.chunks(VERTICES_PER_CHUNK))
        .zip(texcoords)
        .map(|((positions, normals), texcoords)| {
            Part::Vertices(v1::SceneVertices {
                position: column::encode(positions),
                normal: column::encode(normals),
                texcoord: column::encode(texcoords),
            })
        });
    let triangles = mesh
        .triangles
        .chunks(TRIANGLES_PER_CHUNK)
        .zip(mesh.triangle_materials.chunks(TRIANGLES_PER_CHUNK))
        .zip(mesh.primitives.chunks(TRIANGLES_PER_CHUNK))
        .map(|((triangles, materials), primitives)| {
            Part::Triangles(v1::SceneTriangles {
                vertices: column::encode(triangles),
                material: column::encode(materials),
                primitive: column::encode(primitives),
            })
        });
    let objects = mesh.objects.chunks(OBJECTS_PER_CHUNK).map(|part| {
        Part::Objects(v1::SceneObjects { objects: part.iter().map(Into::into).collect() })
    });
    std::iter::once(Part::Header(header))
        .chain(materials)
        .chain(objects)
        .chain(textures)
        .chain(vertices)
        .chain(triangles)
        .map(|part| v1::SceneChunk { part: Some(part) })
}

/// The answer to a viewer that already holds the scene.
pub fn unchanged_scene(hash: &str) -> v1::SceneChunk {
    let header =
        v1::SceneHeader { hash: hash.to_owned(), unchanged: true, ..v1::SceneHeader::default() };
    v1::SceneChunk { part: Some(Part::Header(header)) }
}

/// A scene as it was received.
#[derive(Clone, Debug, PartialEq)]
pub struct ReceivedScene {
    /// Digest of its content.
    pub hash: String,
    /// How its units relate to those of the file.
    pub frame: SceneFrame,
    /// Its surfaces, checked: every index points at something.
    pub mesh: SceneMesh,
}

/// Puts the chunks of one answer together. It never holds more than was received.
#[derive(Debug, Default)]
pub struct SceneAssembler {
    header: Option<v1::SceneHeader>,
    mesh: SceneMesh,
}

impl SceneAssembler {
    /// Adds the next chunk. Chunks of a later version are ignored.
    pub fn push(&mut self, chunk: v1::SceneChunk) -> Result<(), WireError> {
        let Some(part) = chunk.part else { return Ok(()) };
        if let Part::Header(header) = part {
            return self.begin(header);
        }
        let header = self.header.as_ref().ok_or(WireError::Scene("the header is not first"))?;
        let mesh = &mut self.mesh;
        match part {
            Part::Header(_) => {}
            Part::Materials(part) => {
                for material in part.materials {
                    mesh.materials.push(material.try_into()?);
                }
                complete_at_most(mesh.materials.len(), header.material_count)?;
            }
            Part::Objects(part) => {
                for object in part.objects {
                    mesh.objects.push(object.try_into()?);
                }
                complete_at_most(mesh.objects.len(), header.object_count)?;
            }
            Part::Vertices(part) => {
                let count = part.position.len() / 12;
                mesh.positions.extend(column::decode::<[f32; 3]>(
                    "position",
                    &part.position,
                    count,
                )?);
                mesh.normals.extend(column::decode::<[f32; 3]>("normal", &part.normal, count)?);
                if !part.texcoord.is_empty() {
                    let texcoords = column::decode("texcoord", &part.texcoord, count)?;
                    mesh.texcoords.extend::<Vec<[f32; 2]>>(texcoords);
                }
                complete_at_most(mesh.positions.len(), header.vertex_count)?;
            }
            Part::Triangles(part) => {
                let count = part.primitive.len() / 4;
                mesh.triangles.extend(column::decode::<[u32; 3]>(
                    "vertices",
                    &part.vertices,
                    count,
                )?);
                mesh.triangle_materials.extend(column::decode::<u16>(
                    "material",
                    &part.material,
                    count,
                )?);
                mesh.primitives.extend(column::decode::<u32>("primitive", &part.primitive, count)?);
                complete_at_most(mesh.triangles.len(), header.triangle_count)?;
            }
            Part::Texture(part) => {
                mesh.textures.push(part.try_into()?);
                complete_at_most(mesh.textures.len(), header.texture_count)?;
            }
        }
        Ok(())
    }

    /// The scene, once the stream has ended; `None` when the one that the viewer already holds is
    /// the current one.
    pub fn finish(self) -> Result<Option<ReceivedScene>, WireError> {
        let Self { header, mut mesh } = self;
        let header = header.ok_or(WireError::Scene("there is no header"))?;
        if header.unchanged {
            return Ok(None);
        }
        let whole = mesh.materials.len() == header.material_count as usize
            && mesh.positions.len() == header.vertex_count as usize
            && mesh.triangles.len() == header.triangle_count as usize
            && mesh.objects.len() == header.object_count as usize
            && mesh.textures.len() == header.texture_count as usize;
        if !whole {
            return Err(WireError::Scene("it is shorter than its header says"));
        }
        check_mesh(&mesh)?;
        mesh.camera = header.camera.map(TryInto::try_into).transpose()?;
        let frame = check::required("scene.frame", header.frame)?.try_into()?;
        Ok(Some(ReceivedScene { hash: header.hash, frame, mesh }))
    }

    fn begin(&mut self, mut header: v1::SceneHeader) -> Result<(), WireError> {
        if self.header.is_some() {
            return Err(WireError::Scene("there are two headers"));
        }
        header.hash = check::text("scene.hash", header.hash, check::MAX_NAME)?;
        check::within("scene.material_count", header.material_count, 0, MAX_MATERIALS)?;
        check::within("scene.vertex_count", header.vertex_count, 0, MAX_ELEMENTS)?;
        check::within("scene.triangle_count", header.triangle_count, 0, MAX_ELEMENTS)?;
        check::within("scene.object_count", header.object_count, 0, MAX_ELEMENTS)?;
        let most = TexturePreview::MAX_COUNT as u32;
        check::within("scene.texture_count", header.texture_count, 0, most)?;
        self.header = Some(header);
        Ok(())
    }
}

fn complete_at_most(found: usize, announced: u32) -> Result<(), WireError> {
    if found > announced as usize {
        return Err(WireError::Scene("it is longer than its header says"));
    }
    Ok(())
}

fn check_mesh(mesh: &SceneMesh) -> Result<(), WireError> {
    check::all_finite("position", mesh.positions.as_flattened())?;
    check::all_finite("normal", mesh.normals.as_flattened())?;
    check::all_finite("texcoord", mesh.texcoords.as_flattened())?;
    let vertices = mesh.positions.len();
    if !mesh.texcoords.is_empty() && mesh.texcoords.len() != vertices {
        return Err(WireError::Scene("only some vertices have texture coordinates"));
    }
    let textures = mesh.textures.len();
    if mesh.materials.iter().filter_map(|m| m.texture).any(|index| usize::from(index) >= textures) {
        return Err(WireError::Scene("a material names a texture that is not there"));
    }
    if mesh.triangles.as_flattened().iter().any(|&index| index as usize >= vertices) {
        return Err(WireError::Scene("a triangle names a vertex that is not there"));
    }
    let materials = mesh.materials.len();
    if mesh.triangle_materials.iter().any(|&index| usize::from(index) >= materials) {
        return Err(WireError::Scene("a triangle names a material that is not there"));
    }
    Ok(())
}

impl From<&FilterObject> for v1::SceneObject {
    fn from(object: &FilterObject) -> Self {
        Self {
            name: check::cut(&object.name, check::MAX_NAME),
            first_primitive: object.primitives.start,
            primitive_count: object.primitives.len() as u32,
        }
    }
}

impl TryFrom<v1::SceneObject> for FilterObject {
    type Error = WireError;

    fn try_from(wire: v1::SceneObject) -> Result<Self, WireError> {
        let end = wire.first_primitive.checked_add(wire.primitive_count);
        let end = end.ok_or(WireError::Scene("an object has shapes beyond the last one"))?;
        Ok(Self {
            name: check::text("object.name", wire.name, check::MAX_NAME)?,
            primitives: wire.first_primitive..end,
        })
    }
}

impl From<&MaterialInfo> for v1::Material {
    fn from(material: &MaterialInfo) -> Self {
        Self {
            name: check::cut(&material.name, check::MAX_NAME),
            model: check::cut(&material.model, check::MAX_NAME),
            color: Some(material.color.into()),
            emission: Some(material.emission.into()),
            transparent: material.transparent,
            texture: material.texture.map_or(0, |index| u32::from(index) + 1),
        }
    }
}

impl TryFrom<v1::SceneTexture> for TexturePreview {
    type Error = WireError;

    fn try_from(wire: v1::SceneTexture) -> Result<Self, WireError> {
        let width = check::within("texture.width", wire.width, 1, Self::MAX_SIDE)?;
        let height = check::within("texture.height", wire.height, 1, Self::MAX_SIDE)?;
        let texels = column::decode("texels", &wire.texels, (width * height) as usize)?;
        Ok(Self { width, height, texels })
    }
}

impl TryFrom<v1::Material> for MaterialInfo {
    type Error = WireError;

    fn try_from(wire: v1::Material) -> Result<Self, WireError> {
        let most = TexturePreview::MAX_COUNT as u32;
        Ok(Self {
            name: check::text("material.name", wire.name, check::MAX_NAME)?,
            model: check::text("material.model", wire.model, check::MAX_NAME)?,
            color: camera::color("material.color", wire.color)?,
            emission: camera::color("material.emission", wire.emission)?,
            transparent: wire.transparent,
            texture: check::within("material.texture", wire.texture, 0, most)?
                .checked_sub(1)
                .map(|index| index as u16),
        })
    }
}
