//! What the readers understand.

use common::{
    Appearance, Attendee, Author, ChainCommand, ChainId, ChainState, Event, ExplorerCommand,
    ExplorerState, FailureCount, FilmTile, FilterCounts, FilterError, FilterMaterial, FilterObject,
    FilterReply, FilterScene, FilterText, FocusOutcome, FocusPath, FocusStep, Gap, Gaze,
    LeaseEvent, LeaseNotice, LeaseRequest, Notice, Order, OrderReply, PathHeader, PathId, Presence,
    Role, SceneFrame, Seed, SkipTo, Statistics, StrategyId, StrategySet, StrategyStatistics,
    TracerEvent, VertexKind, VertexRecord,
};
use glam::DVec3;
use proto::{Hello, NumberedOrder, ProtocolVersion, ViewerEvent, WantedFilter};

use crate::stream::fixture::{batch, path, session_info};

fn author() -> Author {
    Author { session: 3, name: "anna".to_owned() }
}

fn id() -> PathId {
    PathId { chain: ChainId::EXPLORER, epoch: 2, step: 77 }
}

/// A message of every kind that viewers send.
pub(super) fn viewer_events() -> Vec<ViewerEvent> {
    let filter = WantedFilter { revision: 4, filter: FilterText::read("edges > 2") };
    let hello = Hello {
        version: ProtocolVersion::CURRENT,
        viewer_name: "anna".to_owned(),
        wanted_role: Role::Driver,
        data_budget: 1 << 20,
        filter: Some(filter.clone()),
        focus: true,
        resume: "0a1b".to_owned(),
    };
    let gaze = Some(Gaze { eye: [1.0, 2.0, 3.0], target: [0.0; 3] });
    let strategy = StrategyId(1);
    let orders = [
        Order::Explorer(ExplorerCommand::Seed(Seed::Path(id()))),
        Order::Explorer(ExplorerCommand::Play(12.5)),
        Order::Explorer(ExplorerCommand::Step(3)),
        Order::Explorer(ExplorerCommand::Skip(SkipTo::Acceptance)),
        Order::Explorer(ExplorerCommand::Skip(SkipTo::Strategy(strategy))),
        Order::Explorer(ExplorerCommand::Allow(StrategySet(5))),
        Order::Explorer(ExplorerCommand::Fan { strategy, count: 9 }),
        Order::Chains(ChainCommand::Pause),
        Order::Chains(ChainCommand::SetWeight { strategy, weight: 0.5 }),
        Order::Chains(ChainCommand::SetPrecision(0.01)),
        Order::Chains(ChainCommand::Restart { seed: 8 }),
        Order::Lease(LeaseRequest::Ask),
        Order::Lease(LeaseRequest::HandOver(2)),
    ];
    let orders = orders
        .into_iter()
        .zip(1..)
        .map(|(order, request)| ViewerEvent::Order(NumberedOrder { request, order: Some(order) }));
    [
        ViewerEvent::Hello(hello),
        ViewerEvent::SetBudget(9),
        ViewerEvent::SetFilter(filter),
        ViewerEvent::SetFocus(true),
        ViewerEvent::Appearance(Appearance { gaze, filter: "any is specular".to_owned() }),
        ViewerEvent::Goodbye("over".to_owned()),
    ]
    .into_iter()
    .chain(orders)
    .collect()
}

/// A message of every kind that daemons send.
pub(super) fn tracer_events() -> Vec<TracerEvent> {
    let tile = FilmTile {
        sequence: 5,
        width: 4,
        height: 10,
        first_row: 8,
        steps: 99,
        rgb: (0..24).map(|i| i as f32).collect(),
    };
    let reply = FilterReply {
        revision: 2,
        epoch: 1,
        text: "edges == 2".to_owned(),
        conditions: vec!["edges == 2".to_owned()],
        error: Some(FilterError { span: 4..9, message: "expected more".to_owned() }),
    };
    let header = PathHeader { id: id(), strategy: StrategyId(255), ..PathHeader::default() };
    let step = FocusStep {
        number: 9,
        id: id(),
        outcome: FocusOutcome::Failed(3),
        acceptance: 0.25,
        length: 6,
        kept_light: 2,
        kept_eye: 1,
        inserted: path(1, 2),
        eye_side: path(2, 1),
        blocker: Some([1.0, 2.0, 3.0]),
        ..FocusStep::default()
    };
    [
        TracerEvent::Welcome(Box::new(session_info().welcome)),
        TracerEvent::Paths(batch(1500).0.into()),
        TracerEvent::Film(tile.clone()),
        TracerEvent::ExplorerFilm(tile),
        TracerEvent::Statistics(statistics().into()),
        TracerEvent::Gap(Gap { batches: 1, paths: 2, bytes: 3 }),
        TracerEvent::FilterReply(reply),
        TracerEvent::FocusPath(FocusPath { header, vertices: path(3, 5), next: 9 }.into()),
        TracerEvent::FocusStep(step.into()),
        TracerEvent::FocusGap(7),
        TracerEvent::Goodbye("over".to_owned()),
    ]
    .into_iter()
    .chain(notices().map(TracerEvent::Notice))
    .collect()
}

/// A notice of every kind.
fn notices() -> [Notice; 5] {
    let attendee = Attendee {
        author: author(),
        role: Role::Driver,
        asks: true,
        appearance: Appearance { gaze: Some(Gaze::default()), filter: "true".to_owned() },
    };
    let explorer = ExplorerState {
        current: Some(id()),
        origin: Some(id()),
        by: Some(author()),
        rate: 4.0,
        ..ExplorerState::default()
    };
    let chains = ChainState {
        weights: vec![1.0, 0.0],
        precision: 0.01,
        change: "paused the chains".to_owned(),
        by: Some(author()),
        ..ChainState::default()
    };
    [
        Notice::Presence(Presence { viewers: vec![attendee] }),
        Notice::Explorer(explorer),
        Notice::Chains(chains),
        Notice::Lease(LeaseNotice { event: LeaseEvent::Lost, by: Some(author()) }),
        Notice::Reply(OrderReply { request: 7, error: Some("no".to_owned()) }),
    ]
}

fn statistics() -> Statistics {
    let failures = vec![FailureCount { reason: 0, count: 3 }];
    let strategy = StrategyStatistics {
        proposed: 10,
        generated: 7,
        failures,
        ..StrategyStatistics::default()
    };
    let conditions = vec![500, 20];
    Statistics {
        elapsed_seconds: 2.5,
        strategies: vec![strategy],
        filter: FilterCounts { revision: 4, seen: 1000, conditions, ..FilterCounts::default() },
        ..Statistics::default()
    }
}

/// What filters may name.
pub(super) fn filter_scene() -> FilterScene {
    let names = |all: &[&str]| all.iter().map(|&name| name.to_owned()).collect();
    FilterScene {
        frame: SceneFrame { centre: DVec3::new(0.5, 0.0, 1.0), scale: 0.25, light: 1.0 },
        materials: ["glass", "floor", "lamp"].map(FilterMaterial::from).to_vec(),
        strategies: names(&["bidirectional", "lens", "caustic"]),
        objects: vec![FilterObject { name: "vase".to_owned(), primitives: 1..3 }],
    }
}

/// Paths for filters to judge.
pub(super) fn judged() -> Vec<(PathHeader, Vec<VertexRecord>)> {
    let kinds = [VertexKind::Diffuse, VertexKind::Specular];
    let events = [Event::Diffuse, Event::Reflect, Event::Transmit, Event::Glossy];
    let judged = |tag: u32| {
        let mut vertices = path(tag, 2 + tag % 7);
        for (i, vertex) in vertices.iter_mut().enumerate() {
            vertex.kind = kinds[(i + tag as usize) % kinds.len()];
            vertex.event = events[(i * 3 + tag as usize) % events.len()];
            vertex.material = (tag % 3) as u16;
            vertex.position[0] = f32::MAX.powf(tag as f32 / 12.0) - 1.0;
        }
        let end = |kind, vertex: VertexRecord| VertexRecord { kind, event: Event::End, ..vertex };
        let last = vertices.len() - 1;
        vertices[0] = end(VertexKind::Light, vertices[0]);
        vertices[last] = end(VertexKind::Eye, vertices[last]);
        let luminance = 10_f32.powf(tag as f32 * 6.0 - 36.0);
        (PathHeader { dwell: tag, luminance, ..PathHeader::default() }, vertices)
    };
    (0..12).map(judged).collect()
}

/// The manual's filters and expressions.
pub(super) fn filters() -> Vec<String> {
    let manual = include_str!("../../../docs/FILTERS.md");
    let block = manual.split("```filter\n").nth(1).and_then(|rest| rest.split("```").next());
    block.expect("a block of examples").lines().map(str::to_owned).collect()
}

/// See [`filters`].
pub(super) fn expressions() -> Vec<String> {
    let manual = include_str!("../../../docs/FILTERS.md");
    let table = manual.split("| Path | Expression |\n").nth(1).expect("a table of expressions");
    let rows = table.lines().skip(1).take_while(|row| row.starts_with('|'));
    rows.map(|row| row.split('`').nth(1).expect("an expression").to_owned()).collect()
}

/// A scene with everything that the project's own files may hold.
pub(super) const TOML: &str = r#"max_edges = 4
[film]
width = 8
height = 6
[camera]
origin = [0, 0, 5]
target = [0, 0, 0]
vertical_fov = 30
lens_radius = 0.1
[[materials]]
name = "lamp"
model = "lambert"
reflectance = [0.5, 0.5, 0.5]
emission = 2
[[materials]]
name = "glass"
model = "dielectric"
eta = 1.5
[[meshes]]
name = "plate"
material = "lamp"
positions = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
triangles = [[0, 1, 2]]
transform = [{ scale = 2 }, { rotate = { axis = [0, 1, 0], degrees = 30 } }]
[[spheres]]
name = "ball"
material = "glass"
centre = [0, 0, 1]
radius = 0.5
[[lights]]
name = "spot"
spot = { position = [0, 2, 0], target = [0, 0, 0], intensity = [1, 2, 3] }
[strategies]
lens = { radius = [1, 2], weight = 3 }
"#;

/// A mesh with every kind of line, a byte 0, and its materials.
pub(super) const OBJ: &str = "# a plate\nmtllib a.mtl\no plate\nv -1 0 0\nv 1.5 0 0 # right\nv 1 1e0 0\n\
v -1 1 0\nvt 0 0\nvn 0 0 1\nusemtl lamp\nf -4//1 -3//1 -2//1 -1//1\ns off\ng rest\nusemtl glass\n\
f 1 \\\n 2 3\n\0newmtl lamp\nKd .5 .5 .5\nKe 1 2 3 # bright\nillum 2\nnewmtl glass\nNi 1.5\nTf 1 1 1\n\
Tr 0.9\nillum 7\nPr 0\n";

/// A scene with most of what Mitsuba's files hold.
pub(super) const MITSUBA: &str = r#"<?xml version="1.0"?>
<scene version="0.6.0">
<default name="depth" value="7"/>
<integrator type="path"><integer name="maxDepth" value="$depth"/></integrator>
<sensor type="perspective">
<float name="fov" value="40"/>
<transform name="toWorld"><lookat origin="0, 0, -5" target="0, 0, 0" up="0, 1, 0"/></transform>
<film type="hdrfilm"><integer name="width" value="8"/><integer name="height" value="4"/></film>
</sensor>
<bsdf type="twosided" id="red"><bsdf type="diffuse"><rgb name="reflectance" value="0.5, 0.1, 0"/></bsdf></bsdf>
<bsdf type="dielectric" id="glass"><float name="intIOR" value="1.5"/><string name="extIOR" value="vacuum"/></bsdf>
<bsdf type="roughconductor" id="metal"><string name="material" value="Au"/><float name="alpha" value="0.1"/></bsdf>
<shape type="rectangle"><transform name="toWorld"><scale value="2"/><rotate y="1" angle="30"/><translate z="3"/></transform><ref id="red"/></shape>
<shape type="sphere"><point name="center" x="1" y="2" z="3"/><float name="radius" value="0.5"/><ref id="glass"/></shape>
<shape type="cube"><transform name="toWorld"><matrix value="1 0 0 0  0 1 0 0  0 0 1 -5  0 0 0 1"/></transform><ref id="metal"/></shape>
<shape type="rectangle" id="lamp"><emitter type="area"><rgb name="radiance" value="1 2 3"/></emitter></shape>
</scene>
"#;

/// A square of two triangles.
pub(super) const PLY: &str = "ply\nformat ascii 1.0\ncomment a square\nelement vertex 4\n\
property float x\nproperty float y\nproperty float z\nelement face 1\n\
property list uchar int vertex_indices\nelement edge 1\nproperty int a\nend_header\n\
0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n7\n";

/// A scene that shows the mesh in `m.ply`.
pub(super) fn with_ply() -> String {
    let shape = "<shape type=\"ply\"><string name=\"filename\" value=\"m.ply\"/></shape></scene>";
    MITSUBA.replace("</scene>", shape)
}

/// A path as Mitsuba prints it, with annotations of its steps.
pub(super) const DUMP: &str = r#"# seed chain=4 step=0 pixel=12.5,30.25 k=4 config=E - e - Sd - c - Cd
Path[
  Vertex 0 => PathVertex[
    type = emitterSupernode,
    data = EndpointRecord[time=0],
  ],
  Edge 0 => PathEdge[
    length = 0
  ],
  Vertex 1 => PathVertex[
    type = emitterSample,
    data = PositionSamplingRecord[
      p = [0, 4, 0],
      n = [0, -1, 0],
      uv = [0.5, 0.5],
      object = AreaLight[
        p = [9, 9, 9]
      ]
    ],
    degenerate = false
  ],
  Edge 1 => PathEdge[
    length = 4
  ],
  Vertex 2 => PathVertex[
    type = surfaceInteraction,
    data = Intersection[
      p = [0, 0, 0],
      geoFrame = Frame[
        n = [0, 1, 0]
      ],
      shape = Rectangle[
        name = "floor, polished",
      ]
    ],
    componentType = 32,
    degenerate = true,
    measure = discrete,
  ],
  Edge 2 => PathEdge[
    length = 4
  ],
  Vertex 3 => PathVertex[
    type = sensorSample,
    data = PositionSamplingRecord[
      p = [4, 4, 0],
      n = [-1, 0, 0],
      uv = [12.5, 30.25],
      object = PerspectiveCamera[
        fov = [40, 30],
        film = HDRFilm[
          size = [64, 48],
        ]
      ]
    ]
  ],
  Edge 3 => PathEdge[
    length = 0
  ],
  Vertex 4 => PathVertex[
    type = sensorSupernode,
    data = EndpointRecord[time=0],
  ]
]
# step=0 failed mut=lens
# step=1 rejected mut=lens a=0.25 pixel=1,2 k=3 config=E - e - c
# step=2 accepted mut=bidirectional a=0.5 l=0 m=2 ka=2 pixel=1,2 k=4 config=E
"#;
