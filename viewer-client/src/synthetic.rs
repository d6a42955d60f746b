//! A made-up daemon's messages, for tests.

use std::sync::Arc;

use common::{
    BatchBuilder, BatchLimits, Camera, CameraPose, Event, FilmTile, FilterObject, MaterialInfo,
    PathBatch, PathHeader, Rgb, Role, SceneFrame, SceneMesh, TracerEvent, VertexKind, VertexRecord,
    Welcome,
};
use glam::DVec3;
use proto::ReceivedScene;

use crate::source::connection::{Arrival, Inbox};
use crate::source::status::LinkState;

/// A camera in front of the scene, which looks along -z.
pub(crate) fn camera() -> Camera {
    let pose = CameraPose {
        origin: DVec3::new(0.0, 0.0, 1500.0),
        target: DVec3::ZERO,
        up: DVec3::Y,
        vertical_fov: 40.0,
    };
    Camera::new(&pose, 40, 30).expect("a valid pose")
}

pub(crate) fn welcome() -> Welcome {
    Welcome {
        session: 7,
        server_version: "0.1.0".to_owned(),
        scene_name: "a room".to_owned(),
        scene_hash: "abc".to_owned(),
        frame: SceneFrame { centre: DVec3::ZERO, scale: 1.0, light: 1.0 },
        camera: camera(),
        strategies: vec!["bidirectional".to_owned(), "lens".to_owned()],
        failure_reasons: vec!["occluded".to_owned(), "off film".to_owned()],
        chains: 128,
        max_edges: 20,
        role: Role::Observer,
        resume: String::new(),
    }
}

/// A grey wall at z = -512 that fills the scene's bounds, which reach to z = 512.
pub(crate) fn mesh() -> SceneMesh {
    let material = |name: &str, emission| MaterialInfo {
        name: name.to_owned(),
        model: "lambert".to_owned(),
        color: Rgb::grey(0.5),
        emission,
        transparent: false,
        texture: None,
    };
    let positions = vec![
        [-512.0, -512.0, -512.0],
        [512.0, -512.0, -512.0],
        [512.0, 512.0, -512.0],
        [-512.0, 512.0, -512.0],
        // A splinter in front, seen edge-on.
        [512.0, 512.0, 512.0],
    ];
    SceneMesh {
        texcoords: Vec::new(),
        normals: vec![[0.0, 0.0, 1.0]; positions.len()],
        positions,
        triangles: vec![[0, 1, 2], [0, 2, 3], [2, 4, 2]],
        triangle_materials: vec![0, 0, 1],
        primitives: vec![0, 1, 2],
        materials: vec![material("wall", Rgb::BLACK), material("lamp", Rgb::WHITE)],
        objects: vec![FilterObject { name: "room".to_owned(), primitives: 0..2 }],
        textures: Vec::new(),
        camera: Some(camera()),
    }
}

/// Paths through the given points; each ends at the camera.
pub(crate) fn batch(paths: &[&[[f32; 3]]]) -> PathBatch {
    let mut builder = BatchBuilder::new(BatchLimits { bytes: usize::MAX });
    for points in paths {
        let lens = camera().origin.as_vec3().to_array();
        let vertex = |position| VertexRecord {
            position,
            normal: [0, 0],
            kind: VertexKind::Diffuse,
            event: Event::Diffuse,
            material: 0,
            primitive: 0,
        };
        let vertices: Vec<_> = points.iter().copied().chain([lens]).map(vertex).collect();
        let header = PathHeader { luminance: 1.0, rgb: [1.0; 3], ..PathHeader::default() };
        assert!(builder.push(&header, &vertices, None).is_none(), "the batch has no limit");
    }
    builder.finish().expect("a batch with paths")
}

/// What a viewer gets in its first second.
#[derive(Clone, Debug)]
pub(crate) struct SyntheticSession {
    pub(crate) welcome: Welcome,
    pub(crate) scene: ReceivedScene,
    pub(crate) film: FilmTile,
    pub(crate) batches: Vec<PathBatch>,
    /// Further messages of the tracer.
    pub(crate) more: Vec<TracerEvent>,
}

impl SyntheticSession {
    /// Puts all of it in.
    pub(crate) fn put(self, inbox: &Inbox) {
        let Self { welcome, scene, film, batches, more } = self;
        inbox.push(Arrival::Link(LinkState::Connected));
        inbox.put(TracerEvent::Welcome(Box::new(welcome)));
        inbox.push(Arrival::Scene(Box::new(scene)));
        inbox.put(TracerEvent::Film(film));
        let paths = batches.into_iter().map(|batch| TracerEvent::Paths(Arc::new(batch)));
        for event in more.into_iter().chain(paths) {
            inbox.put(event);
        }
    }
}

/// Everything, with these paths.
pub(crate) fn delivery(paths: &[&[[f32; 3]]]) -> SyntheticSession {
    let rgb = [0.1, 0.3, 0.6].repeat(40 * 30);
    let welcome = welcome();
    let (hash, frame) = (welcome.scene_hash.clone(), welcome.frame);
    SyntheticSession {
        welcome,
        scene: ReceivedScene { hash, frame, mesh: mesh() },
        film: FilmTile { sequence: 1, width: 40, height: 30, first_row: 0, steps: 2400, rgb },
        batches: vec![batch(paths)],
        more: Vec::new(),
    }
}
