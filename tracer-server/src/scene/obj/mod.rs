//! OBJ and MTL files; the only file that names tobj.

mod library;
mod material;
mod text;

use std::collections::BTreeMap;
use std::fmt::Display;
use std::path::{Path, PathBuf};

use common::Rgb;
use glam::{DVec3, Vec2, Vec3};

use crate::bsdf::LambertDescription;
use crate::scene::description::{Coding, Material, Mesh, Texture};
use crate::scene::reading::diagnostic::{LoadError, Place, Warning};
use crate::scene::reading::image::read_texture;
use crate::scene::reading::text::{read_lossy, without_comment};
use library::{MtlText, texture_file};
use material::{Mapped, MtlEntry, UNKNOWN_GREY, phong_roughness};
use text::ObjText;

/// The most bytes of an OBJ file that are read.
const MAX_OBJ_BYTES: u64 = 2 << 30;
/// The most bytes of an MTL file that are read.
const MAX_MTL_BYTES: u64 = 64 << 20;

/// The surfaces of an OBJ file.
#[derive(Debug, Default)]
pub(crate) struct ObjScene {
    /// Its materials, the grey one for faces without any last.
    pub(crate) materials: Vec<Material>,
    /// Where each material was defined.
    pub(crate) places: Vec<Place>,
    /// Its groups.
    pub(crate) meshes: Vec<Mesh>,
    /// The textures that its materials read.
    pub(crate) textures: Vec<Texture>,
    /// What of it is not supported.
    pub(crate) warnings: Vec<Warning>,
}

/// Reads an OBJ file, its material libraries and what is needed of their textures.
pub(crate) fn read(path: &Path) -> Result<ObjScene, LoadError> {
    let text = read_lossy(path, MAX_OBJ_BYTES)?;
    let mut obj = text::scan(&text, path)?;
    drop(text);
    let mut warnings = std::mem::take(&mut obj.warnings);
    let mut mtl = read_libraries(path, &obj.libraries, &mut warnings)?;
    warnings.append(&mut mtl.warnings);
    find_bare_names(&mut obj, &mtl);
    tell_unknown_materials(path, &obj, &mtl, &mut warnings);

    let library =
        tobj::load_mtl_buf(&mut mtl.text.as_bytes()).map_err(|error| unforeseen(path, &error))?;
    // The library was read above; the text names none, so the parser asks for this one once.
    obj.text.insert_str(0, "mtllib -\n");
    let options = tobj::LoadOptions { triangulate: true, ..tobj::LoadOptions::default() };
    let (models, parsed) =
        tobj::load_obj_buf(&mut obj.text.as_bytes(), &options, |_| Ok(library.clone()))
            .map_err(|error| unforeseen(path, &error))?;
    drop(obj);
    let parsed = parsed.map_err(|error| unforeseen(path, &error))?;

    let mut scene = ObjScene { warnings, ..ObjScene::default() };
    let mut images = Images { folder: folder_of(path), ..Images::default() };
    for source in &parsed {
        let place = mtl.places.get(&source.name).cloned().unwrap_or_else(|| Place::file(path));
        let (material, notes) = images.entry(source).to_material();
        for note in notes {
            let message = format!("material `{}`: {note}", material.name);
            scene.warnings.push(place.clone().warning(message));
        }
        scene.materials.push(material);
        scene.places.push(place);
    }
    scene.textures = images.textures;
    add_meshes(path, models, &mut scene)?;
    Ok(scene)
}

/// Reads only the surfaces of an OBJ file: the scene that places them says what they are made of.
pub(crate) fn read_geometry(path: &Path) -> Result<(Vec<Mesh>, Vec<Warning>), LoadError> {
    let text = read_lossy(path, MAX_OBJ_BYTES)?;
    let mut obj = text::scan(&text, path)?;
    drop(text);
    let options = tobj::LoadOptions { triangulate: true, ..tobj::LoadOptions::default() };
    // The scan takes the names of libraries out of the text, so that none is asked for.
    let no_library = |_: &Path| Err(tobj::LoadError::OpenFileFailed);
    let (models, _) = tobj::load_obj_buf(&mut obj.text.as_bytes(), &options, no_library)
        .map_err(|error| unforeseen(path, &error))?;
    let mut scene = ObjScene::default();
    add_meshes(path, models, &mut scene)?;
    Ok((scene.meshes, std::mem::take(&mut obj.warnings)))
}

/// The parser met what the scan before it let pass.
fn unforeseen(path: &Path, error: &dyn Display) -> LoadError {
    Place::file(path).error(format!("the OBJ parser refuses this file: {error}"))
}

fn folder_of(path: &Path) -> PathBuf {
    path.parent().map(Path::to_path_buf).unwrap_or_default()
}

/// Reads all libraries into one text; missing ones are reported.
fn read_libraries(
    path: &Path,
    libraries: &[(String, usize)],
    warnings: &mut Vec<Warning>,
) -> Result<MtlText, LoadError> {
    let folder = folder_of(path);
    let mut out = MtlText::default();
    for (names, line) in libraries {
        // The rest of the line may be one name with spaces, or several names.
        let place = |name: &str| folder.join(name.replace('\\', "/"));
        let bare = without_comment(names).trim_end();
        let whole = [names, bare].map(place).into_iter().find(|file| file.is_file());
        let files = match whole {
            Some(whole) => vec![whole],
            None => bare.split_whitespace().map(place).collect(),
        };
        for file in files {
            match read_lossy(&file, MAX_MTL_BYTES) {
                Ok(text) => library::scan(&text, &file, &mut out)?,
                Err(LoadError::Unreadable { source, .. }) => {
                    let message = format!(
                        "cannot read the material library {}: {source}; its materials become grey",
                        file.display()
                    );
                    warnings.push(Place::line(path, *line).warning(message));
                }
                Err(error) => return Err(error),
            }
        }
    }
    Ok(out)
}

/// A material that is used by a name that no library has is one whose name differs only by a comment
/// behind it, if there is such a one.
fn find_bare_names(obj: &mut ObjText, mtl: &MtlText) {
    let bare = |name: &str| without_comment(name).trim_end().to_owned();
    let unknown: Vec<String> =
        obj.used.keys().filter(|name| !mtl.places.contains_key(*name)).cloned().collect();
    for name in unknown {
        let wanted = bare(&name);
        let Some(known) = mtl.places.keys().find(|known| bare(known) == wanted) else { continue };
        let uses = |name: &str| format!("usemtl {name}\n");
        obj.text = obj.text.replace(&uses(&name), &uses(known));
        if let Some(line) = obj.used.remove(&name) {
            obj.used.entry(known.clone()).or_insert(line);
        }
    }
}

fn tell_unknown_materials(path: &Path, obj: &ObjText, mtl: &MtlText, warnings: &mut Vec<Warning>) {
    for (name, line) in &obj.used {
        if !mtl.places.contains_key(name) {
            let message = format!("no library defines material `{name}`; its faces become grey");
            warnings.push(Place::line(path, *line).warning(message));
        }
    }
}

/// Textures read so far: several materials may share one.
#[derive(Debug, Default)]
struct Images {
    folder: PathBuf,
    textures: Vec<Texture>,
    known: BTreeMap<(PathBuf, Coding), Result<Mapped, String>>,
}

impl Images {
    /// The file that a statement names, with or without what looks like a comment.
    fn file(&self, value: &str) -> PathBuf {
        let whole = self.folder.join(texture_file(value));
        let bare = || self.folder.join(texture_file(without_comment(value).trim_end()));
        if whole.is_file() { whole } else { bare() }
    }

    /// Reads a texture unless it is known, and tells its mean.
    fn map(&mut self, value: &str, coding: Coding) -> Result<Mapped, String> {
        let file = self.file(value);
        let Self { textures, known, .. } = self;
        let read = |(file, coding): &(PathBuf, Coding)| {
            let texture = read_texture(file, *coding)?;
            let index = u16::try_from(textures.len())
                .map_err(|_error| "more than 65,536 textures".to_owned())?;
            let mean = texture.mean();
            textures.push(texture);
            Ok(Mapped { texture: index, mean })
        };
        known.entry((file, coding)).or_insert_with_key(read).clone()
    }

    /// A texture of Phong exponents as one of roughness.
    fn exponents(&mut self, value: &str, full: f64) -> Result<Mapped, String> {
        let file = self.file(value);
        let mut texture = read_texture(&file, Coding::Linear)?;
        let rough =
            |code: u8| (255.0 * phong_roughness(full * f64::from(code) / 255.0)).round() as u8;
        texture.texels = texture.texels.iter().map(|texel| texel.map(rough)).collect();
        let index = u16::try_from(self.textures.len())
            .map_err(|_error| "more than 65,536 textures".to_owned())?;
        let mean = texture.mean();
        self.textures.push(texture);
        Ok(Mapped { texture: index, mean })
    }

    /// The mean of an emission texture, which is not kept.
    fn mean(&self, value: &str) -> Result<Rgb, String> {
        Ok(read_texture(&self.file(value), Coding::Srgb)?.mean())
    }

    fn entry(&mut self, source: &tobj::Material) -> MtlEntry {
        let parameter = |name: &str| source.unknown_param.get(name).map(String::as_str);
        let number = |name| parameter(name)?.parse::<f64>().ok();
        let filter = parameter("Tf").and_then(|text| {
            let mut words = text.split_whitespace().map_while(|word| word.parse::<f64>().ok());
            Some(Rgb::new(words.next()?, words.next()?, words.next()?))
        });
        MtlEntry {
            name: source.name.clone(),
            diffuse: source.diffuse.map(Rgb::from),
            specular: source.specular.map(Rgb::from),
            emission: source.emissive.map(Rgb::from),
            filter,
            opacity: source.dissolve.or_else(|| number("Tr").map(|tr| 1.0 - tr)),
            eta: source.optical_density,
            shininess: source.shininess,
            roughness: number("Pr"),
            metallic: number("Pm"),
            illumination: source.illumination_model,
            diffuse_map: source
                .diffuse_texture
                .as_deref()
                .map(|value| self.map(value, Coding::Srgb)),
            roughness_map: match (parameter("map_Pr"), source.shininess_texture.as_deref()) {
                (Some(value), _) => Some(self.map(value, Coding::Linear)),
                (None, Some(value)) => Some(self.exponents(value, source.shininess.unwrap_or(1.0))),
                (None, None) => None,
            },
            emission_map: parameter("map_Ke").map(|value| self.mean(value)),
        }
    }
}

/// Appends the groups, and a grey material when some face has none.
fn add_meshes(
    path: &Path,
    models: Vec<tobj::Model>,
    scene: &mut ObjScene,
) -> Result<(), LoadError> {
    let grey = scene.materials.len();
    let needs_grey = |m: &tobj::Model| m.mesh.material_id.is_none() && !m.mesh.indices.is_empty();
    if models.iter().any(needs_grey) {
        let grey = LambertDescription { reflectance: Rgb::grey(UNKNOWN_GREY).into() };
        scene.materials.push(Material::new("(none)", grey));
        scene.places.push(Place::file(path));
    }
    for tobj::Model { mesh, name } in models {
        if mesh.indices.is_empty() {
            continue;
        }
        let material = mesh.material_id.unwrap_or(grey);
        let material = u16::try_from(material).map_err(|_error| {
            Place::file(path).error("more than 65,536 materials; merge those that look the same")
        })?;
        scene.meshes.push(to_mesh(&mesh, name, material));
    }
    Ok(())
}

/// One group with the attributes of its corners.
fn to_mesh(mesh: &tobj::Mesh, name: String, material: u16) -> Mesh {
    let triangles = mesh.indices.as_chunks::<3>().0.to_vec();
    let positions = mesh.positions.as_chunks::<3>().0;
    let listed = mesh.normals.as_chunks::<3>().0;
    let normal = |i: u32| {
        let [x, y, z] = listed.get(i as usize).copied().unwrap_or_default();
        Vec3::new(x as f32, y as f32, z as f32)
    };
    let normals = mesh.normal_indices.as_chunks::<3>().0;
    let listed = mesh.texcoords.as_chunks::<2>().0;
    let texcoord = |i: u32| {
        let [u, v] = listed.get(i as usize).copied().unwrap_or_default();
        Vec2::new(u as f32, v as f32)
    };
    let texcoords = mesh.texcoord_indices.as_chunks::<3>().0;
    Mesh {
        name,
        positions: positions.iter().map(|&p| DVec3::from_array(p)).collect(),
        materials: vec![material; triangles.len()],
        normals: normals.iter().map(|corners| corners.map(normal)).collect(),
        texcoords: texcoords.iter().map(|corners| corners.map(texcoord)).collect(),
        triangles,
    }
}
