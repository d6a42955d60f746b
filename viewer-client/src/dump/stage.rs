//! A dump in the units and the vocabulary of the viewer, as if a daemon had sent it.

use common::{
    Camera, CameraPose, ChainId, MaterialInfo, PathHeader, PathId, Rgb, SceneFrame, SceneMesh,
    StrategyId, VertexRecord, encode_normal,
};
use glam::{DVec3, Vec3};

use super::{Dump, DumpVertex, Outcome, Record, Step};

/// Field of view of a camera that tells none, in degrees.
const USUAL_FOV: f64 = 40.0;

/// One record, ready to be drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Act {
    /// All but the vertices.
    pub header: PathHeader,
    /// From the light to the lens.
    pub vertices: Vec<VertexRecord>,
}

/// A dump that can be played.
#[derive(Clone, Debug)]
pub struct Stage {
    /// How coordinates relate to those of the file.
    pub frame: SceneFrame,
    /// The camera that the sensor tells of.
    pub camera: Camera,
    /// Names of the mutations.
    pub strategies: Vec<String>,
    /// The surfaces, as far as they are known: the places that paths touch.
    pub mesh: SceneMesh,
    /// The records, in the order of the file.
    pub acts: Vec<Act>,
    /// The steps, in the order of the file.
    pub steps: Vec<Step>,
    /// The file tells what became of every step.
    pub annotated: bool,
}

/// Further away than this nothing is drawn.
const FAR: DVec3 = DVec3::splat(1e30);

impl Stage {
    /// Makes a dump ready, in the frame of a scene where one is shown with it.
    pub fn new(dump: Dump, scene: Option<(SceneFrame, SceneMesh)>) -> Self {
        let (frame, mesh) =
            scene.map_or_else(|| (frame_of(&dump.records), None), |(f, m)| (f, Some(m)));
        let camera = mesh.as_ref().and_then(|m| m.camera).unwrap_or_else(|| camera(&dump, frame));
        let mut mesh = mesh.unwrap_or_else(|| touched(&dump.records, frame));
        mesh.camera = Some(camera);
        let mut strategies: Vec<String> = Vec::new();
        for step in &dump.steps {
            if !step.mutation.is_empty() && !strategies.contains(&step.mutation) {
                strategies.push(step.mutation.clone());
            }
        }
        let mut stage = Self {
            frame,
            camera,
            strategies,
            mesh,
            acts: Vec::with_capacity(dump.records.len()),
            steps: dump.steps,
            annotated: dump.annotated,
        };
        for record in &dump.records {
            let act = stage.act(record);
            stage.acts.push(act);
        }
        stage.describe_steps();
        stage
    }

    fn act(&mut self, record: &Record) -> Act {
        let [x, y] = record.pixel;
        let film =
            [(x / f64::from(self.camera.width)) as f32, (y / f64::from(self.camera.height)) as f32];
        // The file tells what was sampled, not what the path is worth.
        let header = PathHeader { film, luminance: 1.0, rgb: [1.0; 3], ..PathHeader::default() };
        let vertices = record.vertices.iter().map(|vertex| self.vertex(vertex)).collect();
        Act { header, vertices }
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
            let Some(act) = self.acts.get_mut(step.record) else { continue };
            let header = &mut act.header;
            if !step.outcome.has_path() {
                header.dwell = header.dwell.saturating_add(1);
                header.weight += 1.0;
                continue;
            }
            header.id = PathId { chain: ChainId(step.chain), epoch: 0, step: step.number };
            header.strategy = strategy(&self.strategies, &step.mutation);
            header.weight += 1.0;
            header.acceptance = match step.outcome {
                Outcome::Accepted(Some(a)) => a as f32,
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

/// A frame of the same kind as the daemon's: the largest extent lies in [1024, 2048).
fn frame_of(records: &[Record]) -> SceneFrame {
    let places = || inner(records).map(|vertex| vertex.position);
    let low = places().reduce(DVec3::min).unwrap_or(DVec3::ZERO);
    let high = places().reduce(DVec3::max).unwrap_or(DVec3::ONE);
    let extent = (high - low).max_element().max(1e-6);
    let scale = 2_f64.powi(10 - extent.log2().floor() as i32);
    SceneFrame { centre: 0.5 * (low + high), scale }
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
