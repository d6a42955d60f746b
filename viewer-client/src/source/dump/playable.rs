//! A dump in the units and the vocabulary of the viewer, as if a daemon had sent it.

use common::{
    Camera, CameraPose, ChainId, MaterialInfo, PathHeader, PathId, Rgb, SceneFrame, SceneMesh,
    StrategyId, VertexRecord, encode_normal,
};
use glam::{DVec3, Vec3};

use super::{Dump, DumpVertex, Numbers, Outcome, Record, Step};
use crate::value::Bounds;

/// Field of view of a camera that tells none, in degrees.
const USUAL_FOV: f64 = 40.0;

/// One record, ready to be drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct DumpPath {
    /// All but the vertices.
    pub header: PathHeader,
    /// From the light to the lens.
    pub vertices: Vec<VertexRecord>,
    /// How each of them was generated, as far as the file says.
    pub numbers: Vec<Numbers>,
    /// How the path came about. If the file does not say, name, strategy, acceptance probability
    /// and stay in the header are meaningless.
    pub outcome: Outcome,
    /// The line where its record begins.
    pub line: usize,
}

/// A dump, prepared for playback.
#[derive(Clone, Debug)]
pub struct PlayableDump {
    /// How coordinates relate to those of the file.
    pub frame: SceneFrame,
    /// The camera that the sensor describes.
    pub camera: Camera,
    /// Names of the mutations.
    pub strategies: Vec<String>,
    /// The surfaces, as far as they are known: the places that paths touch.
    pub mesh: SceneMesh,
    /// The records, in the order of the file.
    pub paths: Vec<DumpPath>,
    /// The steps, in the order of the file.
    pub steps: Vec<Step>,
    /// The file tells what became of every step.
    pub annotated: bool,
    /// What was left out, or does not fit, for people.
    pub warnings: Vec<String>,
}

/// Further away than this nothing is drawn.
const FAR: DVec3 = DVec3::splat(1e30);
/// Nothing further away is part of the picture as a whole, in scene units.
const REACH: f32 = 1e9;
/// Nor is a lens that is further from what it looks at, in radii of that.
const NEAR_LENS: f32 = 8.0;
/// So much of the surfaces' radius may a path reach beyond them.
const MARGIN: f32 = 0.02;

impl PlayableDump {
    /// Makes a dump ready, in the frame of a scene where one is shown with it.
    pub fn new(mut dump: Dump, scene: Option<(SceneFrame, SceneMesh)>) -> Self {
        let (frame, mesh) =
            scene.map_or_else(|| (frame_of(&dump.records), None), |(f, m)| (f, Some(m)));
        let mut warnings = std::mem::take(&mut dump.warnings);
        let surfaces = mesh.as_ref().and_then(|mesh| Bounds::of(&mesh.positions));
        warnings.extend(surfaces.and_then(|bounds| misfit(bounds, &dump.records, frame)));
        let camera = mesh.as_ref().and_then(|m| m.camera).unwrap_or_else(|| camera(&dump, frame));
        let mut mesh = mesh.unwrap_or_else(|| touched(&dump.records, frame));
        mesh.camera = Some(camera);
        let mut strategies: Vec<String> = Vec::new();
        for step in &dump.steps {
            if !step.mutation.is_empty() && !strategies.contains(&step.mutation) {
                strategies.push(step.mutation.clone());
            }
        }
        let mut playable = Self {
            frame,
            camera,
            strategies,
            mesh,
            paths: Vec::with_capacity(dump.records.len()),
            steps: dump.steps,
            annotated: dump.annotated,
            warnings,
        };
        for record in &dump.records {
            let path = playable.path(record);
            playable.paths.push(path);
        }
        playable.describe_steps();
        playable
    }

    /// The box round surfaces and paths, lenses included unless they are far away.
    pub fn bounds(&self) -> Option<Bounds> {
        let inner = self.paths.iter().flat_map(|path| path.vertices.iter().rev().skip(1));
        let places = self.mesh.positions.iter().copied().chain(inner.map(|v| v.position));
        let near = |place: &[f32; 3]| place.iter().all(|x| x.abs() <= REACH);
        let body = Bounds::of(&places.filter(near).collect::<Vec<_>>())?;
        let farthest = NEAR_LENS * body.radius();
        let lenses = self.paths.iter().filter_map(|path| path.vertices.last());
        let lenses = lenses
            .map(|lens| Vec3::from(lens.position))
            .filter(|lens| (*lens - body.centre()).length() <= farthest);
        Some(lenses.fold(body, |b, lens| Bounds { min: b.min.min(lens), max: b.max.max(lens) }))
    }

    fn path(&mut self, record: &Record) -> DumpPath {
        let [x, y] = record.pixel;
        let film =
            [(x / f64::from(self.camera.width)) as f32, (y / f64::from(self.camera.height)) as f32];
        // The file tells what was sampled, not what the path is worth.
        let header = PathHeader { film, luminance: 1.0, rgb: [1.0; 3], ..PathHeader::default() };
        let vertices = record.vertices.iter().map(|vertex| self.vertex(vertex)).collect();
        let numbers = record.vertices.iter().map(|vertex| vertex.numbers).collect();
        DumpPath { header, vertices, numbers, outcome: Outcome::Recorded, line: record.line }
    }

    fn vertex(&mut self, vertex: &DumpVertex) -> VertexRecord {
        VertexRecord {
            // A camera may be as far from a tiny scene as it likes.
            position: self.frame.to_scene(vertex.position).clamp(-FAR, FAR).as_vec3().to_array(),
            normal: encode_normal(vertex.normal.as_vec3()),
            kind: vertex.kind,
            event: vertex.event,
            material: self.material(&vertex.shape),
            primitive: u32::MAX,
        }
    }

    /// The number of the material that stands for a shape.
    fn material(&mut self, shape: &str) -> u16 {
        let materials = &mut self.mesh.materials;
        let index = materials.iter().position(|m| m.name == shape).unwrap_or_else(|| {
            materials.push(MaterialInfo {
                name: shape.to_owned(),
                model: "unknown".to_owned(),
                color: Rgb::grey(0.5),
                emission: Rgb::BLACK,
                transparent: false,
                texture: None,
            });
            materials.len() - 1
        });
        u16::try_from(index).unwrap_or(u16::MAX)
    }

    /// Names the paths by the steps that made them, and counts how long chains stayed.
    fn describe_steps(&mut self) {
        for step in &self.steps {
            let Some(path) = self.paths.get_mut(step.record) else { continue };
            let header = &mut path.header;
            if !step.outcome.has_path() {
                header.dwell = header.dwell.saturating_add(1);
                header.weight += 1.0;
                continue;
            }
            path.outcome = step.outcome;
            header.id = PathId { chain: ChainId(step.chain), epoch: 0, step: step.number };
            header.strategy = strategy(&self.strategies, &step.mutation);
            header.weight += 1.0;
            header.acceptance = match step.outcome {
                Outcome::Accepted(a) => a as f32,
                _ => 1.0,
            };
        }
    }
}

fn strategy(names: &[String], name: &str) -> StrategyId {
    let index = names.iter().position(|known| known == name);
    index.and_then(|i| u8::try_from(i).ok()).map_or(PathHeader::NO_STRATEGY, StrategyId)
}

/// The points of the scene that paths touch: all vertices but those on the lens.
fn inner(records: &[Record]) -> impl Iterator<Item = &DumpVertex> {
    let of_record = |record: &'_ Record| record.vertices.len().saturating_sub(1);
    records.iter().flat_map(move |record| record.vertices.iter().take(of_record(record)))
}

/// A warning where most of what paths touch lies outside of the surfaces.
fn misfit(surfaces: Bounds, records: &[Record], frame: SceneFrame) -> Option<String> {
    let margin = Vec3::splat(MARGIN * surfaces.radius());
    let (low, high) = (surfaces.min - margin, surfaces.max + margin);
    let places = || inner(records).map(|v| frame.to_scene(v.position).clamp(-FAR, FAR).as_vec3());
    let is_within = |place: &Vec3| place.cmpge(low).all() && place.cmple(high).all();
    let (all, within) = (places().count(), places().filter(is_within).count());
    (2 * within < all).then(|| {
        format!(
            "only {within} of {all} vertices lie within the bounds of the surfaces, which may \
            belong to another scene or use other units"
        )
    })
}

/// A frame of the same kind as the daemon's: the largest extent lies in [1024, 2048).
fn frame_of(records: &[Record]) -> SceneFrame {
    let places = || inner(records).map(|vertex| vertex.position);
    let low = places().reduce(DVec3::min).unwrap_or(DVec3::ZERO);
    let high = places().reduce(DVec3::max).unwrap_or(DVec3::ONE);
    let extent = (high - low).max_element().max(1e-6);
    let scale = 2_f64.powi(10 - extent.log2().floor() as i32);
    SceneFrame { centre: 0.5 * (low + high), scale, light: 1.0 }
}

fn touched(records: &[Record], frame: SceneFrame) -> SceneMesh {
    let place = |v: &DumpVertex| frame.to_scene(v.position).as_vec3().to_array();
    let normal = |v: &DumpVertex| v.normal.as_vec3().normalize_or(Vec3::Y).to_array();
    SceneMesh {
        positions: inner(records).map(place).collect(),
        normals: inner(records).map(normal).collect(),
        ..SceneMesh::default()
    }
}

/// The camera of the first record, in scene units; square pixels.
fn camera(dump: &Dump, frame: SceneFrame) -> Camera {
    let eye = dump.records.first().and_then(|record| record.vertices.last());
    let (origin, forward) = eye.map_or((DVec3::ZERO, DVec3::Z), |v| (v.position, v.normal));
    let forward = forward.normalize_or(DVec3::Z);
    let up = if forward.y.abs() < 0.99 { DVec3::Y } else { DVec3::Z };
    let largest = |axis: usize| {
        let farthest = dump.records.iter().map(|r| r.pixel[axis]).fold(1.0, f64::max);
        farthest.ceil()
    };
    let [width, height] = dump.sensor.film.unwrap_or_else(|| [largest(0), largest(1)]);
    let side = |pixels: f64| pixels.clamp(1.0, 65_536.0) as u32;
    let origin = frame.to_scene(origin);
    let vertical_fov = dump.sensor.fov.map_or(USUAL_FOV, |[_, y]| y).clamp(0.1, 179.0);
    let pose = CameraPose { origin, target: origin + forward, up, vertical_fov };
    Camera::new(&pose, side(width), side(height)).unwrap_or_else(|_problem| Camera {
        origin,
        right: DVec3::X,
        up: DVec3::Y,
        forward: -DVec3::Z,
        tan_x: 0.5,
        tan_y: 0.5,
        width: side(width),
        height: side(height),
        aperture: 0.0,
        focus: 1.0,
    })
}
