//! Files of every kind.

use std::fmt::Write as _;
use std::path::PathBuf;

use common::{Event, Rgb, SceneFrame, SceneMesh, VertexKind};
use glam::DVec3;

use super::parse::Parser;
use super::text::Lines;
use super::*;
use crate::source::Source;

/// A path from a lamp over a mirror to the camera.
const RECORD: &str = "\
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
      shFrame = Frame[
        n = [1, 0, 0]
      ],
      novelty = 7,
      shape = Rectangle[
        name = \"floor, polished\",
        bsdf = X[
          name = \"no\"
        ]
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
";

/// The whole of it, and the first thing that is wrong.
fn parse_all(text: &str) -> (Dump, Option<Fault>) {
    let mut parser = Parser::default();
    let mut lines = Lines::new(std::io::Cursor::new(text.to_owned())).expect("memory");
    while let Some(line) = lines.next().expect("memory") {
        parser.line(&line);
    }
    parser.finish()
}

fn parse(text: &str) -> Result<Dump, Fault> {
    let (dump, fault) = parse_all(text);
    fault.map_or(Ok(dump), Err)
}

#[test]
fn a_record_is_read_with_its_nested_keys() {
    let dump = parse(RECORD).expect("a record");
    let record = &dump.records[0];
    let kinds: Vec<_> = record.vertices.iter().map(|v| (v.kind, v.event)).collect();
    let mirror = (VertexKind::Specular, Event::Reflect);
    let ends = [(VertexKind::Light, Event::End), (VertexKind::Eye, Event::End)];
    assert_eq!(kinds, [ends[0], mirror, ends[1]], "L S E");
    let mirror = &record.vertices[1];
    assert_eq!(mirror.normal.to_array(), [0.0, 1.0, 0.0], "of the geometry, not for shading");
    assert_eq!(mirror.shape, "floor, polished", "the shape's own name");
    assert_eq!(record.vertices[0].position.to_array(), [0.0, 4.0, 0.0], "not the object's");
    assert_eq!(record.pixel, [12.5, 30.25], "of the sensor");
    assert_eq!(dump.sensor, Sensor { fov: Some([40.0, 30.0]), film: Some([64.0, 48.0]) });
    let windows = parse(&RECORD.replace('\n', "\r\n")).expect("other line ends");
    assert_eq!(windows, dump, "line ends do not matter");
}

#[test]
fn a_truncated_record_is_left_out_and_told() {
    for cut in 6..RECORD.len() - 2 {
        let dump = parse(&format!("{RECORD}{}", &RECORD[..cut])).expect("a dump");
        assert_eq!((dump.records.len(), dump.warnings.len()), (1, 1), "{:?}", dump.warnings);
        assert!(dump.warnings[0].contains("line 71"), "{:?}", dump.warnings);
    }
}

/// Steps of [`annotated`].
pub(crate) const STEPS: usize = 4;

fn annotated() -> Dump {
    let text = format!(
        "# a remark\n# seed chain=4 step=0 pixel=12.5,30.25 k=4 config=E - e - Sd - c - Cd\n{RECORD}\
         # step=0 failed mut=lens\n# step=1 rejected mut=lens a=0.25 pixel=1,2 k=3 config=E - e - c\n\
         # step=2 accepted mut=bidirectional a=0.5 l=0 m=2 ka=2 pixel=1,2 k=4 config=E\n{RECORD}"
    );
    parse(&text).expect("an annotated dump")
}

/// A dump of two paths and four steps, ready to be played.
pub(crate) fn playable() -> PlayableDump {
    PlayableDump::new(annotated(), None)
}

#[test]
fn steps_are_told_with_what_was_rejected() {
    let dump = annotated();
    let told: Vec<_> = dump.steps.iter().map(|s| (s.number, s.outcome, s.record)).collect();
    let accepted = Outcome::Accepted(0.5);
    let expected = [
        (0, Outcome::Seed, 0),
        (1, Outcome::Failed, 0),
        (2, Outcome::Rejected(0.25), 0),
        (3, accepted, 1),
    ];
    assert_eq!(told, expected, "every step");
    assert!(dump.steps.iter().all(|s| s.chain == 4), "of the chain");
    let playable = PlayableDump::new(dump, None);
    let [seed, next] = [&playable.paths[0].header, &playable.paths[1].header];
    assert_eq!((seed.dwell, seed.weight, next.dwell), (2, 3.0, 0), "how long it stayed");
    assert_eq!((next.id.to_string(), next.acceptance), ("4.0.3".to_owned(), 0.5), "its name");
    assert_eq!(playable.strategies, ["lens", "bidirectional"], "the mutations");
    assert_eq!(seed.film, [12.5 / 64.0, 30.25 / 48.0], "on the film");
}

/// The record with densities and weights: the number of the vertex in the tens, the way in the ones.
fn with_numbers() -> String {
    let mut parts = RECORD.split("  ],\n  Edge");
    let mut text = parts.next().unwrap_or_default().to_owned();
    for (i, part) in parts.enumerate() {
        write!(
            text,
            "    weight[importance] = [{i}1, 2, 3],\n    weight[radiance] = [{i}2, 2, 3],\n    \
             pdf[importance] = {i}1e-2,\n    pdf[radiance] = {i}2e-2\n  ],\n  Edge{part}"
        )
        .expect("a string takes all");
    }
    let end = "    type = sensorSupernode,\n";
    let last = "    weight[radiance] = [1, 1, 1],\n    pdf[radiance] = inf,\n";
    text.replace(end, &format!("{end}{last}"))
}

/// A dump of one path that has densities and weights, and no word on how it came about.
pub(crate) fn stage_with_numbers() -> PlayableDump {
    PlayableDump::new(parse(&with_numbers()).expect("a record"), None)
}

#[test]
fn densities_and_weights_belong_to_the_vertex_that_a_step_makes() {
    let dump = parse(&with_numbers()).expect("a record");
    let vertices = &dump.records[0].vertices;
    let pdfs = |walked: Option<Walked>| walked.map(|walked| walked.pdf);
    let told: Vec<_> =
        vertices.iter().map(|v| (pdfs(v.numbers.from_light), pdfs(v.numbers.from_eye))).collect();
    let expected = [(Some(0.01), Some(0.22)), (Some(0.11), Some(0.32)), (Some(0.21), None)];
    assert_eq!(told, expected, "of the steps before and after; what overflows is not known");
    let lens = vertices[2].numbers.from_light.expect("a step");
    assert_eq!((lens.weight, lens.is_discrete), (Rgb::new(21.0, 2.0, 3.0), true), "off a mirror");
    let playable = PlayableDump::new(dump, None);
    let numbers: Vec<_> = playable.paths[0].numbers.iter().map(|n| pdfs(n.from_light)).collect();
    assert_eq!(numbers, [Some(0.01), Some(0.11), Some(0.21)], "with the path");
    let plain = parse(RECORD).expect("a record");
    let nothing = plain.records[0].vertices.iter().all(|v| v.numbers == Numbers::default());
    assert!(nothing, "a file need not tell them");
    for (from, to) in [("= 01e-2", "= much"), ("= [01, 2, 3]", "= [01, 2]")] {
        let fault = parse(&with_numbers().replacen(from, to, 1)).expect_err(to);
        assert!(fault.problem.contains("[importance]") && fault.line < 8, "{fault:?}");
    }
}

#[test]
fn records_without_a_word_claim_nothing() {
    let dump = parse(&format!("{RECORD}{RECORD}")).expect("two records");
    let outcomes: Vec<_> = dump.steps.iter().map(|step| step.outcome).collect();
    assert_eq!(outcomes, [Outcome::Recorded; 2], "neither a seed nor accepted");
    let playable = PlayableDump::new(dump, None);
    assert!(
        playable.paths.iter().all(|path| path.outcome == Outcome::Recorded),
        "{:?}",
        playable.paths
    );
    let lines: Vec<_> = playable.paths.iter().map(|path| path.line).collect();
    assert_eq!(lines, [1, 71], "where they are");
}

#[test]
fn the_picture_has_lenses_and_surfaces_that_fit() {
    let scene = |centre: DVec3| {
        let frame = SceneFrame { centre, scale: 256.0, light: 1.0 };
        let positions = vec![[-512.0, -512.0, -512.0], [512.0, 640.0, 512.0]];
        (frame, SceneMesh { positions, ..SceneMesh::default() })
    };
    let fits = PlayableDump::new(parse(RECORD).expect("a record"), Some(scene(DVec3::Y * 2.0)));
    assert_eq!(fits.warnings, [""; 0], "lamp and mirror lie within");
    let bounds = fits.bounds().expect("a box");
    assert_eq!(bounds.max.x, 1024.0, "the lens lies outside of the surfaces, and is shown");
    let far = PlayableDump::new(parse(RECORD).expect("a record"), Some(scene(DVec3::splat(90.0))));
    assert!(far.warnings[0].contains("only 0 of 2"), "{:?}", far.warnings);
    let bounds = far.bounds().expect("a box");
    assert!(bounds.min.x < -20_000.0 && bounds.max.x == 512.0, "both are shown: {bounds:?}");
}

#[test]
fn faults_name_their_line() {
    for (from, to, line, part) in [
        ("p = [0, 0, 0]", "p = [0, nan, 0]", 27, "3 finite numbers"),
        ("p = [0, 0, 0]", "q = [0, 0, 0]", 70, "line 24"),
        ("p = [0, 0, 0]", "p = [0, 1e39, 0]", 27, "1e15 at most"),
        ("Vertex 2 =>", "Vertex 3 =>", 24, "Vertex 2"),
        ("type = emitterSample", "type = teapot", 70, "`teapot`"),
        ("type = emitterSample", "type = emitterSupernode", 70, "emitterSample"),
        ("componentType = 32", "componentType = x", 42, "is not a number"),
        ("Path[", "# step=1 rejected mut=lens\nPath[", 1, "`a=A`"),
        ("Path[", "# step=1 failed mut=lens\nPath[", 1, "begins with a seed"),
        ("Path[", "# seed chain=x step=0\nPath[", 1, "`chain=x`"),
        ("Path[", "# seed chain=1\nPath[", 1, "`step=N`"),
    ] {
        let fault = parse(&RECORD.replacen(from, to, 1)).expect_err(to);
        assert!(fault.problem.contains(part), "`{to}`: {fault:?}");
        assert_eq!(fault.line, line, "`{to}`: {fault:?}");
    }
}

/// A record in which something is wrong takes nothing else with it.
#[test]
fn a_faulty_record_is_left_out_with_its_steps_and_told() {
    for (from, to) in [
        ("p = [0, 0, 0]", "p = [nan, 0, 0]"),
        ("p = [0, 0, 0]", "p = [-nan(ind), 0, 0]"),
        ("p = [0, 0, 0]", "p = [1.#QNAN, 0, 0]"),
        ("p = [0, 0, 0]", "p = [0, 1e999, 0]"),
        ("p = [0, 0, 0]", "p = [0,5, 0,5, 0,5]"),
        ("n = [0, -1, 0]", "n = [nan, nan, nan]"),
        ("uv = [12.5, 30.25]", "uv = [inf, 30.25]"),
        ("type = emitterSample", "type = teapot"),
        ("Vertex 2 =>", "Vertex 3 =>"),
    ] {
        let bad = RECORD.replacen(from, to, 1);
        let text = format!(
            "# seed chain=1 step=0\n{RECORD}# step=0 accepted mut=lens a=0.5\n{bad}\
             # step=1 rejected mut=lens a=0.5\n# step=2 accepted mut=caustic a=0.5\n{RECORD}\
             # step=3 failed mut=lens\n"
        );
        let (dump, fault) = parse_all(&text);
        let told: Vec<_> = dump.steps.iter().map(|step| (step.number, step.record)).collect();
        assert_eq!(told, [(0, 0), (3, 1), (4, 1)], "{to}: neither the record nor what follows");
        assert_eq!(dump.records.len(), 2, "{to}");
        let line = fault.expect("it is wrong").line;
        assert!((73..=142).contains(&line), "{to}: line {line}");
        let warning = &dump.warnings[0];
        let begins = warning.starts_with(&format!("line {line}: ")) && warning.contains("line 73");
        assert!(begins, "{to}: {:?}", dump.warnings);
        assert!(dump.warnings[1].starts_with("1 steps"), "{to}: {:?}", dump.warnings);
        assert_eq!(dump.warnings.len(), 2, "{to}: {:?}", dump.warnings);
    }
    let comma = parse(&RECORD.replacen("p = [0, 0, 0]", "p = [0,5, 0,5, 0,5]", 1));
    assert!(comma.expect_err("no numbers").problem.contains("a point divides"));
}

#[test]
fn what_is_no_number_in_a_density_is_not_known() {
    for none in ["nan", "-nan(ind)", "1.#QNAN", "-1.#IND", "inf", "1.#INF"] {
        let text = with_numbers().replacen("= 11e-2", &format!("= {none}"), 1);
        let dump = parse(&text).unwrap_or_else(|fault| panic!("{none}: {fault:?}"));
        let numbers = dump.records[0].vertices[1].numbers;
        assert!(numbers.from_light.is_none() && numbers.from_eye.is_some(), "{none}: {numbers:?}");
    }
}

#[test]
fn many_faults_are_counted() {
    let bad = RECORD.replacen("p = [0, 0, 0]", "p = [nan, 0, 0]", 1);
    let (dump, _) = parse_all(&format!("{}{RECORD}", bad.repeat(25)));
    assert_eq!((dump.records.len(), dump.warnings.len()), (1, 11), "{:?}", dump.warnings);
    assert!(dump.warnings[10].starts_with("15 more"), "{:?}", dump.warnings);
}

#[test]
fn a_file_is_read_in_any_encoding_and_refused_by_its_first_fault() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("paths.txt");
    let marked: Vec<u8> =
        format!("\u{feff}{RECORD}").encode_utf16().flat_map(u16::to_le_bytes).collect();
    host::file::write(&file, &marked).expect("writable");
    let dump = read(&file).expect("a dump");
    assert_eq!(dump, parse(RECORD).expect("a record"));
    let faulty = RECORD.replace("p = [4, 4, 0]", "p = [4, nan, 0]");
    host::file::write(&file, faulty.as_bytes()).expect("writable");
    let error = read(&file).expect_err("nothing is left").to_string();
    assert!(error.contains("paths.txt, line 52: "), "{error}");
    host::file::write(&file, b"\xff\xfe\x00\xd8\x00").expect("writable");
    assert!(matches!(read(&file), Err(DumpError::Empty(_))), "half a character");
}

#[test]
fn a_record_that_is_left_out_is_told_and_no_failure() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("paths.txt");
    let faulty = RECORD.replace("p = [4, 4, 0]", "p = [4, nan, 0]");
    host::file::write(&file, format!("{RECORD}{faulty}").as_bytes()).expect("writable");
    let playable = PlayableDump::new(read(&file).expect("one path"), None);
    let mut source = Source::file("paths.txt", playable);
    let notice = source.status.notice.as_ref().expect("the user is told");
    assert!(notice.is_bad && notice.text.contains("was skipped"), "{}", notice.text);
    assert!(source.status.take_failures().is_empty(), "the file is open all the same");
}

#[test]
fn files_of_thousands_of_paths_are_read() {
    let shared =
        std::env::var_os("LVIS_SHARED").map_or_else(|| "../../shared".into(), PathBuf::from);
    for (name, annotated) in [
        ("paths_cornell_100chains.txt", false),
        ("paths_caustic_100chains.txt", false),
        ("paths_caustic_100chains_annotated.txt", true),
    ] {
        let file = shared.join("paths").join(name);
        if !file.exists() {
            ::tests::skip(&format!("{} is not there", file.display()));
            return;
        }
        let dump = read(&file).expect("a dump");
        assert_eq!((dump.records.len(), dump.annotated), (2000, annotated), "{name}");
        assert_eq!(dump.warnings, [""; 0], "{name}");
        assert!(dump.steps.len() >= 2000, "{name}");
        let playable = PlayableDump::new(dump, None);
        let (eye, camera) = (playable.camera.origin.as_vec3(), playable.camera);
        for path in &playable.paths {
            // The film point is where the last inner vertex is seen.
            let last = glam::Vec3::from(path.vertices[path.vertices.len() - 2].position) - eye;
            let [x, y, z] =
                [camera.right, camera.up, camera.forward].map(|a| a.as_vec3().dot(last));
            let seen = [
                0.5 * (1.0 + x / z / camera.tan_x as f32),
                0.5 * (1.0 - y / z / camera.tan_y as f32),
            ];
            let off = (seen[1] - path.header.film[1]).abs();
            assert!(
                off < 5e-3,
                "{name}, path {}: {seen:?} is not {:?}",
                path.header.id,
                path.header.film
            );
        }
    }
}
