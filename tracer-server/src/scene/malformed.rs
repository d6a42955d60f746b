//! Bad input of every kind: each must give a message that names file, place and remedy.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use proptest::prelude::*;

use super::builtin::BUILTINS;
use super::load::{Loaded, load};
use super::{LightKind, SceneDescription, ThinLens, Wish};
use crate::bsdf::{BsdfDescription, DielectricDescription};

/// A smallest scene that loads.
const GOOD: &str = r#"max_edges = 4

[film]
width = 8
height = 6

[camera]
origin = [0, 0, 5]
target = [0, 0, 0]
vertical_fov = 30

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

[[spheres]]
name = "ball"
material = "glass"
centre = [0, 0, 1]
radius = 0.5
"#;

fn load_text(name: &str, text: impl AsRef<[u8]>) -> Result<Loaded, String> {
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join(name);
    fs::write(&path, text).expect("written");
    load(path.to_str().expect("a UTF-8 path")).map_err(|error| error.to_string())
}

fn description(text: &str) -> SceneDescription {
    load_text("good.toml", text).expect("valid").description
}

#[test]
fn wishes_about_strategies_are_kept_with_their_lines() {
    let text =
        format!("{GOOD}[strategies]\ncaustic = 0\nlens = {{ radius = [1, 2], weight = 3 }}\n");
    let loaded = load_text("good.toml", &text).expect("valid");
    let first = GOOD.lines().count() + 2;
    let wishes: Vec<_> =
        loaded.strategies.iter().map(|s| (s.strategy.as_str(), s.place.line, &s.wish)).collect();
    let radius = Wish::Parameter("radius".to_owned(), vec![1.0, 2.0]);
    let expected = [
        ("caustic", Some(first), &Wish::Weight(0.0)),
        ("lens", Some(first + 1), &radius),
        ("lens", Some(first + 1), &Wish::Weight(3.0)),
    ];
    assert_eq!(wishes, expected);
    let text = format!("{GOOD}[strategies]\nlens = \"much\"\n");
    let error = load_text("good.toml", &text).expect_err("no weight");
    assert!(error.contains("a weight, or a table of weight and parameters"), "{error}");
}

#[test]
fn the_smallest_scene_loads() {
    let scene = description(GOOD);
    assert_eq!((scene.name.as_str(), scene.width, scene.height), ("good", 8, 6));
    assert_eq!((scene.max_edges, scene.meshes.len(), scene.spheres.len()), (4, 1, 1));
    assert_eq!(scene.materials[0].emission, common::Rgb::grey(2.0));
    let glass = BsdfDescription::from(DielectricDescription::clear(1.5));
    assert_eq!(scene.materials[1].bsdf, glass);
}

#[test]
fn every_mistake_in_a_toml_scene_is_located() {
    // What to replace, by what, the line of the complaint, and words in it.
    let cases = [
        ("max_edges = 4", "max_edges = 0", "1", "max_edges is 0"),
        ("max_edges = 4", "max_edges = 9999", "1", "between 1 and"),
        ("max_edges = 4", "max_edge = 4", "1", "unknown field `max_edge`"),
        ("max_edges = 4", "max_edges = -1", "1", "-1"),
        ("width = 8", "width = 0", "4", "width is 0"),
        ("width = 8", "width = 100000", "4", "width is 100000"),
        ("width = 8", "width = 8.5", "4", "floating point"),
        ("height = 6", "", "3", "missing field `height`"),
        ("target = [0, 0, 0]", "target = [0, 0, 5]", "7", "same point"),
        ("target = [0, 0, 0]", "target = [0, 5, 5]", "7", "up vector"),
        ("target = [0, 0, 0]", "target = [0, nan, 0]", "9", "not finite"),
        ("origin = [0, 0, 5]", "origin = [0, 1e300, 5]", "8", "too far away"),
        ("origin = [0, 0, 5]", "origin = [0, 5]", "8", "3"),
        ("origin = [0, 0, 5]", "origin = \"here\"", "8", "string"),
        ("vertical_fov = 30", "vertical_fov = 180", "7", "180"),
        ("vertical_fov = 30", "", "7", "missing field `vertical_fov`"),
        ("material = \"lamp\"", "material = \"lmap\"", "25", "the materials are lamp, glass"),
        ("material = \"lamp\"", "", "24", "has no material"),
        ("[[0, 1, 2]]", "[[0, 1, 3]]", "27", "refers to position 3"),
        ("[[0, 1, 2]]", "[[0, 1, -2]]", "27", "-2"),
        ("[[0, 1, 2]]", "[[0, 1]]", "27", "3"),
        ("triangles = [[0, 1, 2]]", "", "24", "positions need triangles"),
        ("triangles = [[0, 1, 2]]", "obj = \"a.obj\"", "24", "exactly one of"),
        ("[1, 0, 0], [0, 1, 0]]", "[1, 0, inf], [0, 1, 0]]", "26", "position 1"),
        ("[1, 0, 0], [0, 1, 0]]", "[1, 0, 1e16], [0, 1, 0]]", "26", "too far away"),
        ("radius = 0.5", "radius = 0", "33", "sphere `ball`, radius"),
        ("radius = 0.5", "radius = nan", "33", "positive"),
        ("centre = [0, 0, 1]", "centre = [0, 0, nan]", "32", "sphere `ball`, centre"),
        ("centre = [0, 0, 1]", "center = [0, 0, 1]", "32", "unknown field `center`"),
        ("radius = 0.5", "radius = 0.5\nradius = 1", "34", "duplicate key"),
        ("[film]", "[film", "3", ""),
    ];
    for case in cases {
        assert_located(case);
    }
}

#[test]
fn every_mistake_in_a_material_is_located() {
    let cases = [
        ("\"lambert\"", "\"phong\"", "14", "no model `phong`; the models are lambert, mirror"),
        ("[0.5, 0.5, 0.5]", "[0.5, 1.5, 0.5]", "15", "material `lamp`, reflectance"),
        ("[0.5, 0.5, 0.5]", "[0.5, -0.1, 0.5]", "15", "[0, 1]"),
        ("[0.5, 0.5, 0.5]", "[0.5, 0.5]", "15", "a number, three numbers"),
        ("[0.5, 0.5, 0.5]", "nan", "15", "[0, 1]"),
        ("reflectance = [0.5, 0.5, 0.5]", "", "12", "reflectance: this model requires it"),
        ("emission = 2", "emission = -2", "16", "material `lamp`, emission"),
        ("emission = 2", "emission = inf", "16", "finite"),
        ("emission = 2", "emission = 1e30", "16", "at most"),
        (
            "emission = 2",
            "eta = 1.5",
            "16",
            "only the models `dielectric`, `conductor`, `plastic` have it",
        ),
        ("emission = 2", "k = 1.5", "16", "only the model `conductor` has it"),
        ("emission = 2", "colour = 1", "16", "unknown field `colour`"),
        ("emission = 2", "emission = \"red\"", "16", "three numbers [r, g, b]"),
        ("name = \"glass\"", "", "18", "missing field `name`"),
        ("model = \"dielectric\"", "", "18", "missing field `model`"),
        ("eta = 1.5", "eta = [1.5, 1.5, 1.6]", "21", "it must be a single number"),
        ("eta = 1.5", "eta = \"glass\"", "21", "expected a number"),
        ("eta = 1.5", "eta = { texture = \"a.png\" }", "21", "a texture is not possible here"),
        ("eta = 1.5", "eta = 1.5\nroughness = 2", "22", "0 is smooth, 1 is matt"),
        ("eta = 1.5", "eta = 1.5\nroughness = { texture = \"a.png\" }", "22", "a.png"),
        ("emission = 2", "", "", "no light"),
        ("name = \"glass\"", "name = \"lamp\"", "19", "bad.toml:13; rename one"),
        ("eta = 1.5", "eta = 0", "21", "index of refraction"),
        ("eta = 1.5", "eta = 1001", "21", "index of refraction"),
        ("eta = 1.5", "eta = -1.5", "21", "material `glass`, eta"),
        ("eta = 1.5", "", "18", "requires it (glass is 1.5)"),
    ];
    for case in cases {
        assert_located(case);
    }
}

/// That the smallest scene with `from` replaced by `to` is refused, with a complaint at that line that
/// holds those words.
fn assert_located((from, to, line, words): (&str, &str, &str, &str)) {
    assert!(GOOD.contains(from), "the case replaces nothing: {from}");
    let message = load_text("bad.toml", GOOD.replacen(from, to, 1))
        .map(|_| ())
        .expect_err(&format!("must be refused: {to}"));
    let place = if line.is_empty() { "bad.toml: ".into() } else { format!("bad.toml:{line}:") };
    assert!(message.contains(&place), "{from} -> {to}: {message} (line {line} expected)");
    assert!(message.contains(words), "{from} -> {to}: {message}");
    assert!(!message.contains('\n'), "one line: {message}");
}

#[test]
fn senseless_transforms_are_located() {
    for (step, words) in [
        ("{ scale = 0 }", "plate`, transform: scale"),
        ("{ rotate = { axis = [0, 0, 0], degrees = 3 } }", "axis"),
        ("{ translate = [1e300, 0, 0] }", "too far away"),
        ("{ skew = 1 }", "unknown variant `skew`"),
    ] {
        let from = "triangles = [[0, 1, 2]]";
        let text = GOOD.replace(from, &format!("{from}\ntransform = [{step}]"));
        let message = load_text("bad.toml", text).map(|_| ()).expect_err("must be refused");
        assert!(message.contains("bad.toml:2") && message.contains(words), "{message}");
    }
}

#[test]
fn triangles_without_area_are_left_out_and_told() {
    let text = GOOD.replace("[[0, 1, 2]]", "[[0, 1, 2], [0, 1, 1], [2, 2, 2]]");
    let loaded = load_text("thin.toml", text).expect("valid");
    assert_eq!(loaded.description.meshes[0].triangles, [[0, 1, 2]]);
    assert_eq!(loaded.description.meshes[0].materials.len(), 1, "one material a triangle");
    let told = loaded.warnings[0].to_string();
    assert!(told.contains("thin.toml:23: mesh `plate`: 2 triangles without area"), "{told}");

    let flat = GOOD.replace("[[0, 1, 2]]", "[[0, 1, 1]]");
    let message = load_text("flat.toml", flat).map(|_| ()).expect_err("no light is left");
    assert!(message.contains("material `lamp` emits, but no surface"), "{message}");
}

#[test]
fn an_obj_file_is_placed_by_a_toml_scene() {
    let directory = tempfile::tempdir().expect("a directory");
    let write = |name: &str, text: &str| fs::write(directory.path().join(name), text);
    write("part.mtl", "newmtl lamp\nKd 0.1 0.1 0.1\nKe 3 3 3\n").expect("written");
    let obj = "mtllib part.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl lamp\nf 1 2 3\n";
    write("part.obj", obj).expect("written");
    let inline = "material = \"lamp\"\npositions = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\n\
                  triangles = [[0, 1, 2]]";
    let placed = "obj = \"part.obj\"\ntransform = [{ scale = 2 }, { translate = [0, 0, 1] }]";
    write("scene.toml", &GOOD.replace(inline, placed)).expect("written");
    let path = directory.path().join("scene.toml");
    let scene = load(path.to_str().expect("UTF-8")).expect("valid").description;
    let mesh = &scene.meshes[0];
    assert_eq!(mesh.positions[1], glam::DVec3::new(2.0, 0.0, 1.0));
    let material = &scene.materials[usize::from(mesh.materials[0])];
    assert_eq!(material.name, "plate/lamp", "its own material, under a name of its own");
    assert_eq!(material.emission, common::Rgb::grey(3.0));

    // The directory holds one TOML scene; the mesh beside it is a part of it.
    let found = load(directory.path().to_str().expect("UTF-8")).expect("valid").description;
    assert_eq!(found, scene);

    fs::remove_file(directory.path().join("part.obj")).expect("removed");
    let message = load(path.to_str().expect("UTF-8")).expect_err("gone").to_string();
    assert!(message.contains("scene.toml:25: mesh `plate`, obj: cannot read"), "{message}");
}

#[test]
fn a_missing_library_or_texture_is_a_warning() {
    let mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl lamp\nf 1 2 3\n";
    let message = load_text("a.obj", format!("mtllib gone.mtl\n{mesh}"))
        .map(|_| ())
        .expect_err("without materials there is no light");
    assert!(message.contains("a.obj: the scene has no light"), "{message}");
    let cause = "a.obj:1: cannot read the material library";
    assert!(message.contains(cause), "the error tells what led to it: {message}");

    let directory = tempfile::tempdir().expect("a directory");
    let write = |name: &str, text: &str| fs::write(directory.path().join(name), text);
    write("a.mtl", "newmtl lamp\nKe 1 1 1\nmap_Kd gone.png\n").expect("written");
    let obj = format!("mtllib gone.mtl\nmtllib a.mtl\n{mesh}usemtl wall\nf 1 3 2\nf 3 2 1\n");
    write("a.obj", &obj).expect("written");
    let path = directory.path().join("a.obj");
    let loaded = load(path.to_str().expect("UTF-8")).expect("lit by a.mtl");
    let told: Vec<String> = loaded.warnings.iter().map(ToString::to_string).collect();
    let expected = ["a.obj:1: cannot read the material library", "a.obj:8: no library", "gone.png"];
    for words in expected {
        assert!(told.iter().any(|w| w.contains(words)), "{words} is missing from {told:?}");
    }
    assert_eq!(loaded.description.materials.last().map(|m| m.name.as_str()), Some("(none)"));
}

#[test]
fn what_is_no_scene_is_refused() {
    let directory = tempfile::tempdir().expect("a directory");
    let folder = directory.path().to_str().expect("UTF-8");
    let refused = |spec: &str| load(spec).expect_err("must be refused").to_string();
    assert!(refused("cornel").contains("Did you mean `cornell`?"), "a misspelt built-in");
    assert!(refused("/no/such/file.toml").contains("Built in: cornell, caustic"), "no such file");
    assert!(refused("").contains("no scene ``"), "nothing");
    assert!(refused(folder).contains("holds no .toml, .xml or .obj"), "an empty directory");
    for name in ["a.obj", "b.obj", "d.glb", "e"] {
        fs::write(directory.path().join(name), "").expect("written");
    }
    assert!(refused(folder).contains("holds 2 scenes; name one of them: a.obj, b.obj"), "several");
    let inside = |name: &str| refused(Path::new(folder).join(name).to_str().expect("UTF-8"));
    assert!(inside("d.glb").contains("glTF scenes are not supported"), "glTF");
    assert!(inside("e").contains("extensionless scenes are not supported"), "no extension");
    assert!(inside("a.obj").contains("no surface"), "an empty OBJ");
}

#[test]
fn materials_may_be_called_anything() {
    let names =
        ["Material #25", "Material #26", "a;b 100%", "O'Brien \"glass\"", "стекло", "##", "lamp"];
    let directory = tempfile::tempdir().expect("a directory");
    let mut mtl = String::from("# made by hand\n");
    let mut obj = String::from("mtllib part #1.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n");
    for name in names {
        writeln!(mtl, "newmtl {name}\nKd 0.5 0.5 0.5 # grey\nKe 1 1 1").expect("a string");
        writeln!(obj, "usemtl {name}\nf 1 2 3 # a face").expect("a string");
    }
    // A comment behind a name is none of it where another name fits only so.
    mtl += "newmtl red # shiny\nKd 1 0 0\n";
    obj += "usemtl red\nf 1 2 3\nusemtl lamp # the same\nf 1 3 2\n";
    fs::write(directory.path().join("part #1.mtl"), mtl).expect("written");
    let path = directory.path().join("a.obj");
    fs::write(&path, obj).expect("written");
    let loaded = load(path.to_str().expect("UTF-8")).expect("a scene");
    let description = loaded.description;
    let found: Vec<&str> = description.materials.iter().map(|m| m.name.as_str()).collect();
    assert_eq!(found, [&names[..], &["red # shiny"]].concat(), "as many materials as names");
    let used: Vec<u16> = description.meshes.iter().flat_map(|m| m.materials.clone()).collect();
    assert_eq!(used, [0, 1, 2, 3, 4, 5, 6, 7, 6], "each face has its own");
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
}

#[test]
fn numbers_that_make_the_parser_panic_are_caught_before_it() {
    let mtl = "newmtl lamp\nKe 1 1\n";
    let directory = tempfile::tempdir().expect("a directory");
    fs::write(directory.path().join("a.mtl"), mtl).expect("written");
    let path = directory.path().join("a.obj");
    fs::write(&path, "mtllib a.mtl\n").expect("written");
    let message = load(path.to_str().expect("UTF-8")).expect_err("refused").to_string();
    assert!(message.contains("a.mtl:2: material `lamp`, Ke: `1 1` is not a colour"), "{message}");
}

/// Some bytes of a good file replaced by others that mean something to the parsers.
fn mutated(good: Vec<u8>) -> impl Strategy<Value = Vec<u8>> {
    let at = any::<prop::sample::Index>();
    let tokens: Vec<&[u8]> = vec![
        b"-", b"1e999", b"nan", b"#", b"\\\n", b"\n", b"/", b"=", b"[", b"\"", b"\xff", b"", b"0",
        b"99", b" ",
    ];
    let edit = (at, 0_usize..4, prop::sample::select(tokens));
    prop::collection::vec(edit, 1..6).prop_map(move |edits| {
        let mut bytes = good.clone();
        for (at, length, token) in edits {
            let start = at.index(bytes.len().max(1)).min(bytes.len());
            let end = (start + length).min(bytes.len());
            bytes.splice(start..end, token.iter().copied());
        }
        bytes
    })
}

const GOOD_OBJ: &str = "# a plate\nmtllib a.mtl\no plate\nv -1 0 0\nv 1.5 0 0 # right\nv 1 1e0 0\n\
                        v -1 1 0\nvt 0 0\nvn 0 0 1\nusemtl lamp\nf -4//1 -3//1 -2//1 -1//1\ns off\n\
                        g rest\nusemtl glass\nf 1 \\\n 2 3\n";
const GOOD_MTL: &str = "newmtl lamp\nKd .5 .5 .5\nKe 1 2 3 # bright\nmap_Kd -s 1 1 1 a.png\nillum 2\n\
                        newmtl glass\nNi 1.5\nTf 1 1 1\nTr 0.9\nillum 7\nPr 0\n";

/// A scene that got through must hold what the tracer relies on.
fn is_sound(scene: &SceneDescription) -> bool {
    let meshes = scene.meshes.iter().all(|mesh| {
        mesh.positions.iter().all(|p| p.is_finite())
            && mesh.triangles.len() == mesh.materials.len()
            && mesh.triangles.as_flattened().iter().all(|&v| (v as usize) < mesh.positions.len())
            && mesh.materials.iter().all(|&m| usize::from(m) < scene.materials.len())
    });
    let spheres = scene.spheres.iter().all(|s| s.radius > 0.0 && s.centre.is_finite());
    let materials = scene.materials.iter().all(|m| m.emission.is_physical());
    meshes && spheres && materials && !(scene.meshes.is_empty() && scene.spheres.is_empty())
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(400) })]

    #[test]
    fn no_mutated_toml_panics_or_gets_through_unsound(text in mutated(GOOD.into())) {
        match load_text("m.toml", text) {
            Ok(loaded) => prop_assert!(is_sound(&loaded.description)),
            Err(message) => prop_assert!(message.contains("m.toml"), "{}", message),
        }
    }

    #[test]
    fn no_mutated_builtin_panics(text in mutated(BUILTINS[2].text.into())) {
        match load_text("m.toml", text) {
            Ok(loaded) => prop_assert!(is_sound(&loaded.description)),
            Err(message) => prop_assert!(message.contains("m.toml"), "{}", message),
        }
    }

    #[test]
    fn no_mutated_obj_panics_or_gets_through_unsound(
        obj in mutated(GOOD_OBJ.into()),
        mtl in mutated(GOOD_MTL.into()),
    ) {
        let directory = tempfile::tempdir().expect("a directory");
        fs::write(directory.path().join("a.mtl"), mtl).expect("written");
        let path = directory.path().join("a.obj");
        fs::write(&path, obj).expect("written");
        match load(path.to_str().expect("UTF-8")) {
            Ok(loaded) => prop_assert!(is_sound(&loaded.description)),
            Err(error) => {
                let message = error.to_string();
                let located = message.contains("a.obj") || message.contains("a.mtl");
                prop_assert!(located, "{}", message);
            }
        }
    }
}

#[test]
fn the_unmutated_obj_loads() {
    let directory = tempfile::tempdir().expect("a directory");
    fs::write(directory.path().join("a.mtl"), GOOD_MTL).expect("written");
    let path = directory.path().join("a.obj");
    fs::write(&path, GOOD_OBJ).expect("written");
    let loaded = load(path.to_str().expect("UTF-8")).expect("valid").description;
    let triangles: Vec<usize> = loaded.meshes.iter().map(|m| m.triangles.len()).collect();
    assert_eq!(triangles, [2, 1]);
    assert!(is_sound(&loaded));
}

/// A scene with this entry of `[[lights]]`.
fn lit_by(light: &str) -> String {
    format!("{GOOD}\n[[lights]]\nname = \"lamp\"\n{light}\n")
}

#[test]
fn lights_without_a_surface_are_read() {
    let kind = |light: &str| description(&lit_by(light)).lights[0].kind.clone();
    let point = kind("point = { position = [0, 1, 2], intensity = 3 }");
    assert!(matches!(point, LightKind::Point { intensity, .. } if intensity.g == 3.0), "{point:?}");
    let spot = kind("spot = { position = [0, 2, 0], target = [0, 0, 0], intensity = [1, 2, 3] }");
    assert!(matches!(spot, LightKind::Spot { cutoff: 30.0, beam: 22.5, .. }), "{spot:?}");
    let sun = kind("directional = { direction = [0, -2, 0], irradiance = 1 }");
    assert!(matches!(sun, LightKind::Directional { .. }), "{sun:?}");
    let sky = kind("environment = { rotate = [{ axis = [0, 1, 0], degrees = 90 }] }");
    let turned =
        |rotation: glam::DMat3| (rotation * glam::DVec3::Z - glam::DVec3::X).length() < 1e-12;
    assert!(matches!(sky, LightKind::Environment { rotation, .. } if turned(rotation)), "{sky:?}");
    let lens = GOOD.replace("vertical_fov = 30", "vertical_fov = 30\nlens_radius = 0.1");
    assert_eq!(
        description(&lens).lens,
        Some(ThinLens { radius: 0.1, focus: 5.0 }),
        "on the target"
    );
}

#[test]
fn bad_lights_and_lenses_are_refused() {
    let cases = [
        ("", "exactly one of"),
        ("point = { position = [0, 0, 0], intensity = 1 }\nenvironment = {}", "exactly one of"),
        ("point = { position = [0, 0, inf], intensity = 1 }", "not finite"),
        ("point = { position = [0, 0, 0], intensity = -1 }", "not negative"),
        ("point = { position = [0, 0, 0], power = 1 }", "power"),
        ("spot = { position = [0, 0, 0], target = [0, 0, 0], intensity = 1 }", "no length"),
        ("spot = { position = [0, 0, 0], target = [0, 1, 0], intensity = 1, cutoff = 200 }", "180"),
        ("spot = { position = [0, 0, 0], target = [0, 1, 0], intensity = 1, beam = 31 }", "beam"),
        ("directional = { direction = [0, 0, 0], irradiance = 1 }", "no length"),
        ("environment = { image = \"absent.hdr\" }", "absent.hdr"),
        ("environment = { rotate = [{ axis = [0, 0, 0], degrees = 1 }] }", "axis"),
    ];
    for (light, expected) in cases {
        let message = load_text("bad.toml", lit_by(light)).expect_err("refused");
        assert!(message.contains(expected) && message.contains("bad.toml:3"), "{light}: {message}");
    }
    let two = lit_by("environment = {}\n[[lights]]\nname = \"second\"\nenvironment = {}");
    let message = load_text("two.toml", two).expect_err("refused");
    assert!(message.contains("only one") && message.contains("second"), "{message}");
    let lens = GOOD.replace("vertical_fov = 30", "vertical_fov = 30\nlens_radius = 0");
    let message = load_text("lens.toml", lens).expect_err("refused");
    assert!(message.contains("lens_radius") && message.contains("positive"), "{message}");
}
