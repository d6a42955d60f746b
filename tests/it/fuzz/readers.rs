//! The readers, and what each must keep to.

use std::path::Path;

use common::{Filter, FocusPath, SceneMesh, TracerEvent};
use prost::Message as _;
use proto::{SceneAssembler, ViewerEvent, scene_chunks, v1};
use tracer_server::scene::Scene;
use tracer_server::scene::builtin::BUILTINS;
use tracer_server::scene::load::load;
use viewer_client::app::share;
use viewer_client::command::{Command, Form, forms};
use viewer_client::source::dump::{self, PlayableDump};

use super::campaign::{Answer, Target};
use super::mutate::Mutator;
use super::seeds;
use crate::stream::fixture::{session_info, strip};

/// Surfaces above which a scene that was understood is not built.
const MOST_TRIANGLES: usize = 20_000;

fn bytes(texts: impl IntoIterator<Item = impl AsRef<str>>) -> Vec<Vec<u8>> {
    texts.into_iter().map(|text| text.as_ref().as_bytes().to_vec()).collect()
}

/// The name of an event's kind.
fn kind(event: &impl std::fmt::Debug) -> String {
    format!("{event:?}").chars().take(12).collect()
}

#[test]
fn what_viewers_send_is_checked() {
    let seeds = seeds::viewer_events();
    let seeds = seeds.into_iter().map(|e| v1::ViewerMessage::from(e).encode_to_vec()).collect();
    let target = Target { name: "viewer", seeds, mutator: Mutator::Wire, count: 30_000 };
    target.run(|bytes| {
        let wire = v1::ViewerMessage::decode(bytes).map_err(|error| error.to_string())?;
        let event = ViewerEvent::try_from(wire).map_err(|error| error.to_string())?;
        let again = ViewerEvent::try_from(v1::ViewerMessage::from(event.clone()));
        assert_eq!(again.as_ref(), Ok(&event), "what got through travels");
        Ok(kind(&event))
    });
}

#[test]
fn what_daemons_send_is_checked() {
    let seeds = seeds::tracer_events();
    let seeds = seeds.iter().map(|e| v1::TracerMessage::from(e).encode_to_vec()).collect();
    let target = Target { name: "tracer", seeds, mutator: Mutator::Wire, count: 30_000 };
    let at = FocusPath { vertices: crate::stream::fixture::path(1, 6), ..FocusPath::default() };
    target.run(|bytes| {
        let wire = v1::TracerMessage::decode(bytes).map_err(|error| error.to_string())?;
        let event = TracerEvent::try_from(wire).map_err(|error| error.to_string())?;
        match &event {
            TracerEvent::Paths(batch) => {
                let mut reader = batch.reader();
                let mut paths = 0;
                while let Some(path) = reader.next() {
                    assert!((2..=65).contains(&path.vertices.len()), "a path's length");
                    assert!(path.vertices.iter().all(|v| v.position.iter().all(|x| x.is_finite())));
                    paths += 1;
                }
                assert_eq!(paths, batch.len(), "each record is a path");
            }
            TracerEvent::FocusStep(step) => {
                let at = FocusPath { next: step.number, ..at.clone() };
                drop(at.after(step));
            }
            _ => {}
        }
        let again = TracerEvent::try_from(v1::TracerMessage::from(&event));
        assert_eq!(again.as_ref(), Ok(&event), "what got through travels");
        Ok(kind(&event))
    });
}

/// The chunks of a scene as fields of a message that does not exist.
fn chunks(mesh: &SceneMesh) -> Vec<u8> {
    let info = session_info().welcome;
    let mut bytes = Vec::new();
    for chunk in scene_chunks("cafe", info.frame, mesh) {
        bytes.push(0x0a);
        chunk.encode_length_delimited(&mut bytes).expect("memory");
    }
    bytes
}

#[test]
fn scenes_from_daemons_are_checked() {
    let camera = session_info().welcome.camera;
    let seeds = vec![chunks(&strip(3, camera)), chunks(&strip(40, camera))];
    let target = Target { name: "scene-chunks", seeds, mutator: Mutator::Wire, count: 20_000 };
    target.run(|mut bytes| {
        let mut assembler = SceneAssembler::default();
        while bytes.split_off_first() == Some(&0x0a) {
            let chunk = v1::SceneChunk::decode_length_delimited(&mut bytes);
            let chunk = chunk.map_err(|error| error.to_string())?;
            assembler.push(chunk).map_err(|error| error.to_string())?;
        }
        let scene = assembler.finish().map_err(|error| error.to_string())?;
        if let Some(mesh) = scene.map(|scene| scene.mesh) {
            let vertices = mesh.positions.len();
            assert!(mesh.triangles.as_flattened().iter().all(|&i| (i as usize) < vertices));
        }
        Ok("a scene".to_owned())
    });
}

/// Words of filters, expressions and their names.
const FILTER_WORDS: &[&str] = &[
    " and ",
    " or ",
    "not ",
    "(",
    ")",
    "any ",
    "all ",
    "start ",
    "end ",
    "in ",
    "through ",
    "on ",
    "is ",
    "material ",
    "object ",
    "light ",
    "sphere(0, 0, 0, 1)",
    "box(0, 0, 0, 1, 1, 1)",
    "film in rect(0, 0, 1, 1)",
    "strategy ",
    "lens",
    "glass",
    "\"",
    "\\",
    "==",
    "!=",
    "<",
    ">=",
    "..",
    ",",
    "edges",
    "length",
    "luminance",
    "acceptance",
    "dwell",
    "chain",
    "step",
    "specular",
    "true",
    "false",
    "lpe \"CD*L\"",
    "é",
    "\u{2028}",
];

/// Judges paths by a text, which is printed and read again first.
fn filter(text: &str) -> Answer {
    let scene = seeds::filter_scene();
    let placed = |error: common::FilterError| {
        assert!(error.span.start <= text.len(), "{error:?}");
        assert!(!error.pointed(text).is_empty(), "{error:?}");
        error.message
    };
    let filter = Filter::parse(text).map_err(placed)?;
    let printed = filter.to_string();
    match Filter::parse(&printed) {
        Ok(again) => assert_eq!(again, filter, "`{printed}` means something else"),
        // What is printed may be longer than what was written.
        Err(error) => assert!(printed.len() > common::MAX_FILTER_BYTES, "`{printed}`: {error:?}"),
    }
    let compiled = filter.compile(&scene).map_err(placed)?;
    let mut wanted = String::new();
    for (header, vertices) in seeds::judged() {
        let conditions = compiled.conditions(&header, &vertices);
        let wants = compiled.wants(conditions);
        assert_eq!(wants, compiled.matches(&header, &vertices), "one judgement");
        wanted.push(if wants { 'x' } else { '.' });
    }
    Ok(wanted)
}

#[test]
fn any_text_of_a_filter_is_answered() {
    let mutator = Mutator::Text(FILTER_WORDS);
    let target = Target { name: "filter", seeds: bytes(seeds::filters()), mutator, count: 20_000 };
    target.run(|bytes| filter(&String::from_utf8_lossy(bytes)));
}

#[test]
fn any_light_path_expression_is_answered() {
    let words = [
        "C", "E", "L", "O", "B", "R", "T", "V", "D", "G", "S", "s", ".", "*", "+", "?", "{2}",
        "{2,}", "{,4}", "{60,64}", "|", "(", ")", "[^", "[", "]", "<", ">", "'glass'", "'", "\\",
    ];
    let seeds = bytes(seeds::expressions());
    let target =
        Target { name: "expression", seeds, mutator: Mutator::Text(&words), count: 20_000 };
    target.run(|bytes| {
        let text = String::from_utf8_lossy(bytes).replace(['"', '\\'], "'");
        filter(&format!("lpe \"{text}\""))
    });
}

/// Builds a scene that was understood, and sends it to a viewer.
fn scene(file: &Path) -> Answer {
    let loaded = load(file.to_str().expect("UTF-8")).map_err(|error| {
        let text = error.to_string();
        text.rsplit(": ").next().unwrap_or_default().to_owned()
    })?;
    let description = loaded.description;
    if description.meshes.iter().map(|mesh| mesh.triangles.len()).sum::<usize>() > MOST_TRIANGLES {
        return Ok("large".to_owned());
    }
    let scene = Scene::new(&description).map_err(|error| error.to_string())?;
    let mut assembler = SceneAssembler::default();
    for chunk in scene_chunks(scene.hash(), scene.frame(), &scene.preview_mesh()) {
        assembler.push(chunk).expect("viewers understand what is understood");
    }
    assert!(assembler.finish().expect("a whole scene").is_some(), "not one that is known");
    Ok(format!("{:?}", scene.features()))
}

/// A folder in memory where the system has one: its files are written thousands of times.
fn folder() -> tempfile::TempDir {
    let memory = Path::new("/dev/shm");
    let made = if memory.is_dir() { tempfile::tempdir_in(memory) } else { tempfile::tempdir() };
    made.expect("a folder")
}

/// Writes what `parts` makes of an input into files of one folder, and loads the first.
fn scene_files<'a>(
    parts: impl Fn(&'a [u8]) -> Vec<(&'static str, &'a [u8])>,
    input: &'a [u8],
) -> Answer {
    thread_local! {
        static FOLDER: tempfile::TempDir = folder();
    }
    FOLDER.with(|folder| {
        let files = parts(input);
        for (name, content) in &files {
            std::fs::write(folder.path().join(name), content).expect("written");
        }
        scene(&folder.path().join(files[0].0))
    })
}

#[test]
fn any_toml_scene_is_answered() {
    let words = [
        "[",
        "]",
        "[[",
        "]]",
        "=",
        "{",
        "}",
        ",",
        "\"",
        "[[meshes]]",
        "[[spheres]]",
        "[[materials]]",
        "[[lights]]",
        "[strategies]",
        "model",
        "lambert",
        "dielectric",
        "conductor",
        "mirror",
        "plastic",
        "emission",
        "roughness",
        "transform",
        "environment",
        "point",
        "directional",
        "positions",
        "triangles",
        "uv",
        "normals",
        "true",
    ];
    let small = BUILTINS.iter().map(|builtin| builtin.text).filter(|text| text.len() < 8 << 10);
    let seeds = bytes(small.chain([seeds::TOML]));
    let target = Target { name: "toml", seeds, mutator: Mutator::Text(&words), count: 4000 };
    target.run(|bytes| scene_files(|bytes| vec![("s.toml", bytes)], bytes));
}

#[test]
fn any_obj_and_its_materials_are_answered() {
    let words = [
        "v", "vt", "vn", "f", "usemtl", "mtllib", "newmtl", "Kd", "Ke", "Ks", "Ns", "Ni", "Tf",
        "Tr", "d", "illum", "map_Kd", "Pr", "o", "g", "s", "/", "//", "-", "#", "\\\n", "\n",
        "lamp",
    ];
    let seeds = bytes([seeds::OBJ]);
    let target = Target { name: "obj", seeds, mutator: Mutator::Text(&words), count: 6000 };
    target.run(|bytes| {
        let parts = |bytes| {
            let (obj, mtl) = split(bytes);
            vec![("a.obj", obj), ("a.mtl", mtl)]
        };
        scene_files(parts, bytes)
    });
}

/// What stands before the first byte 0, and what stands after it.
fn split(bytes: &[u8]) -> (&[u8], &[u8]) {
    let at = bytes.iter().position(|&byte| byte == 0).unwrap_or(bytes.len());
    (&bytes[..at], bytes.get(at + 1..).unwrap_or_default())
}

#[test]
fn any_mitsuba_scene_is_answered() {
    let words = [
        "<",
        ">",
        "/>",
        "</",
        "\"",
        "=",
        "<shape type=\"",
        "<bsdf type=\"",
        "<transform name=\"",
        "<emitter type=\"",
        "<ref id=\"",
        "sphere",
        "cylinder",
        "disk",
        "rectangle",
        "twosided",
        "mask",
        "mixturebsdf",
        "plastic",
        "conductor",
        "roughdielectric",
        "thindielectric",
        "point",
        "spot",
        "constant",
        "envmap",
        "directional",
        "$depth",
        "&#0;",
        "&amp;",
        "<!--",
        "spectrum",
        "boolean",
        "flipNormals",
        "toWorld",
    ];
    let seeds = bytes([seeds::MITSUBA]);
    let target = Target { name: "mitsuba", seeds, mutator: Mutator::Text(&words), count: 5000 };
    target.run(|bytes| scene_files(|bytes| vec![("s.xml", bytes)], bytes));
}

#[test]
fn any_ply_mesh_is_answered() {
    let words = [
        "element",
        "property",
        "list",
        "uchar",
        "int",
        "float",
        "double",
        "vertex",
        "face",
        "nx",
        "ny",
        "nz",
        "u",
        "v",
        "end_header\n",
        "format",
        "ascii",
        "binary_little_endian",
        "binary_big_endian",
        "comment",
        "\n",
    ];
    let seeds = bytes([seeds::PLY]);
    let target = Target { name: "ply", seeds, mutator: Mutator::Text(&words), count: 5000 };
    let with_ply = seeds::with_ply();
    target.run(|bytes| {
        scene_files(|bytes| vec![("s.xml", with_ply.as_bytes()), ("m.ply", bytes)], bytes)
    });
}

#[test]
fn any_file_of_paths_is_answered() {
    let words = [
        "Path[\n",
        "]\n",
        "],\n",
        "Vertex ",
        "Edge ",
        "=> PathVertex[\n",
        "type = ",
        "surfaceInteraction",
        "emitterSample",
        "sensorSample",
        "p = [",
        "n = [",
        "uv = [",
        "componentType = ",
        "# seed ",
        "# step=",
        "accepted",
        "rejected",
        "failed",
        "chain=",
        "a=",
        "pixel=",
        "mut=",
        "k=",
        "\n",
    ];
    let twice =
        format!("{}{}", seeds::DUMP, &seeds::DUMP[seeds::DUMP.find("Path[").unwrap_or(0)..]);
    let seeds = bytes([seeds::DUMP, &twice]);
    let target = Target { name: "dump", seeds, mutator: Mutator::Text(&words), count: 10_000 };
    let folder = folder();
    let file = folder.path().join("paths.txt");
    target.run(|bytes| {
        std::fs::write(&file, bytes).expect("written");
        let dump = dump::read(&file).map_err(|error| {
            error.to_string().rsplit(": ").next().unwrap_or_default().to_owned()
        })?;
        let warnings = dump.warnings.first().cloned();
        let playable = PlayableDump::new(dump, None);
        for path in &playable.paths {
            assert!(path.vertices.iter().all(|v| v.position.iter().all(|x| x.is_finite())));
        }
        Ok(warnings.unwrap_or_default())
    });
}

#[test]
fn any_command_is_answered() {
    let texts: Vec<String> = forms().map(Form::text).collect();
    let words: Vec<&str> =
        texts.iter().flat_map(|form| form.split(' ')).chain([" ", "~"]).collect();
    let examples = forms().flat_map(|form| (form.examples)());
    let seeds = bytes(examples.map(|command| command.to_string()));
    let target = Target { name: "command", seeds, mutator: Mutator::Text(&words), count: 20_000 };
    target.run(|bytes| {
        let text = String::from_utf8_lossy(bytes);
        let command: Command =
            text.parse().map_err(|error: viewer_client::value::CommandError| error.to_string())?;
        let printed = command.to_string();
        let again: Result<Command, _> = printed.parse();
        assert_eq!(again.as_ref(), Ok(&command), "`{printed}` means something else");
        Ok(printed.split(' ').take(2).collect::<Vec<_>>().join(" "))
    });
}

#[test]
fn any_link_is_answered() {
    let seeds = bytes([
        "lvis://127.0.0.1:50061#camera%20frame;filter%20set%20edges%20%3E%202",
        "lvis://box/#",
    ]);
    let words = ["lvis://", "#", ";", "%", "%20", "%00", "%ff", ":", "/", "camera%20frame", "quit"];
    let target = Target { name: "link", seeds, mutator: Mutator::Text(&words), count: 10_000 };
    target.run(|bytes| {
        let text = String::from_utf8_lossy(bytes);
        let shared = share::read(&text).map_err(|error| error.to_string())?;
        Ok(shared.commands.iter().map(kind).collect())
    });
}
