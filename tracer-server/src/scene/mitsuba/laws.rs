//! Scene files must mean what their authors meant, and mistakes in them must be located.

use std::fs;

use common::Rgb;
use glam::{DVec2, DVec3};
use proptest::prelude::*;

use crate::bsdf::{
    BsdfDescription, ConductorDescription, DielectricDescription, Fresnel, LambertDescription,
    NumberInput, PlasticDescription,
};
use crate::scene::load::{Loaded, load};
use crate::scene::{LightKind, Mesh, Scene, ThinLens};

/// A scene that uses every kind of value, a line each.
const GOOD: &str = r#"<?xml version="1.0"?>
<scene version="0.6.0">
<default name="depth" value="7"/>
<default name="wide" value="8"/>
<integrator type="path"><integer name="maxDepth" value="$depth"/></integrator>
<sensor type="perspective">
<float name="fov" value="40"/>
<transform name="toWorld"><lookat origin="0, 0, -5" target="0, 0, 0" up="0, 1, 0"/></transform>
<film type="hdrfilm"><integer name="width" value="$wide"/><integer name="height" value="4"/></film>
</sensor>
<bsdf type="twosided" id="red"><bsdf type="diffuse"><rgb name="reflectance" value="0.5, 0.1, 0"/></bsdf></bsdf>
<bsdf type="dielectric" id="glass"><float name="intIOR" value="1.5"/><string name="extIOR" value="vacuum"/></bsdf>
<shape type="rectangle"><transform name="toWorld"><scale value="2"/><translate z="3"/></transform><ref id="red"/></shape>
<shape type="sphere"><point name="center" x="1" y="2" z="3"/><float name="radius" value="0.5"/><ref id="glass"/></shape>
<shape type="rectangle" id="lamp"><emitter type="area"><rgb name="radiance" value="1 2 3"/></emitter></shape>
</scene>
"#;

fn load_text(text: impl AsRef<[u8]>) -> Result<Loaded, String> {
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("s.xml");
    fs::write(&path, text).expect("written");
    load(path.to_str().expect("a UTF-8 path")).map_err(|error| error.to_string())
}

fn good(text: &str) -> Loaded {
    load_text(text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// A good scene with `shape` added.
fn with(shape: &str) -> Loaded {
    good(&GOOD.replace("</scene>", &format!("{shape}\n</scene>")))
}

fn last_mesh(loaded: &Loaded) -> &Mesh {
    loaded.description.meshes.last().expect("a mesh")
}

/// Six times the volume that a mesh encloses; positive when it faces outwards.
fn volume(mesh: &Mesh) -> f64 {
    let corner = |i: u32| mesh.positions[i as usize];
    mesh.triangles.iter().map(|t| corner(t[0]).dot(corner(t[1]).cross(corner(t[2])))).sum()
}

/// The sum of a mesh's face normals, of the length of its area.
fn area(mesh: &Mesh) -> DVec3 {
    let corner = |i: u32| mesh.positions[i as usize];
    let doubled = |t: &[u32; 3]| (corner(t[1]) - corner(t[0])).cross(corner(t[2]) - corner(t[0]));
    0.5 * mesh.triangles.iter().map(doubled).sum::<DVec3>()
}

#[test]
fn a_scene_is_what_its_file_says() {
    let loaded = good(GOOD);
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    let scene = loaded.description;
    assert_eq!((scene.width, scene.height, scene.max_edges), (8, 4, 7));
    assert_eq!((scene.meshes.len(), scene.spheres.len()), (2, 1));
    let tangent = (0.5 * scene.camera.vertical_fov.to_radians()).tan();
    let expected = 20.0_f64.to_radians().tan() / 2.0;
    assert!((tangent - expected).abs() < 1e-12, "40 degrees across a film of two by one");
    let material = |i: u16| &scene.materials[usize::from(i)];
    let red = material(scene.meshes[0].materials[0]);
    let reflectance = Rgb::new(0.5, 0.1, 0.0).into();
    assert_eq!(red.bsdf, BsdfDescription::Lambert(LambertDescription { reflectance }));
    assert!(red.two_sided && red.name == "red", "{red:?}");
    assert_eq!(scene.meshes[0].positions[0], DVec3::new(-2.0, -2.0, 3.0), "scaled, then moved");
    assert!(matches!(
        material(scene.spheres[0].material).bsdf,
        BsdfDescription::Dielectric(DielectricDescription { eta: 1.5, .. })
    ));
    let lamp = material(scene.meshes[1].materials[0]);
    assert_eq!(lamp.emission, Rgb::new(1.0, 2.0, 3.0));
    let black = BsdfDescription::Lambert(LambertDescription { reflectance: Rgb::BLACK.into() });
    assert_eq!((lamp.name.as_str(), lamp.bsdf), ("lamp", black), "a lamp reflects nothing");
}

#[test]
fn both_versions_of_the_format_spell_one_scene() {
    let newer = GOOD
        .replace("maxDepth", "max_depth")
        .replace("toWorld", "to_world")
        .replace("intIOR", "int_ior")
        .replace("extIOR", "ext_ior")
        .replace("<scale value=\"2\"/>", "<scale x=\"2\" y=\"2\" z=\"2\"/>")
        .replace("x=\"1\" y=\"2\" z=\"3\"", "value=\"1, 2, 3\"");
    assert_eq!(good(&newer).description, good(GOOD).description);
}

#[test]
fn the_picture_is_not_mirrored() {
    // Seen along +z with +y up, +x lies to the left.
    let scene = Scene::new(&good(GOOD).description).expect("a sound scene");
    let camera = scene.camera();
    let seen = |point: DVec3| camera.project(scene.frame().to_scene(point) - camera.origin);
    let left = seen(DVec3::new(1.0, 0.5, 0.0)).expect("in the picture");
    assert!(left.x < 0.5 && left.y < 0.5, "{left}");
    // The same by a matrix, and by a turn and a shift.
    let lookat = "<lookat origin=\"0, 0, -5\" target=\"0, 0, 0\" up=\"0, 1, 0\"/>";
    for same in [
        "<matrix value=\"1 0 0 0  0 1 0 0  0 0 1 -5  0 0 0 1\"/>",
        "<rotate y=\"1\" angle=\"180\"/><translate z=\"5\"/><rotate y=\"1\" angle=\"180\"/>",
        "<scale x=\"-3\" y=\"3\" z=\"-3\"/><translate z=\"5\"/><scale x=\"-1\" z=\"-1\"/>",
    ] {
        let scene = Scene::new(&good(&GOOD.replace(lookat, same)).description).expect("sound");
        let camera = scene.camera();
        let point = scene.frame().to_scene(DVec3::new(1.0, 0.5, 0.0)) - camera.origin;
        let again = camera.project(point).unwrap_or(DVec2::NAN);
        assert!((again - left).length() < 1e-9, "{same}: {again} instead of {left}");
    }
}

#[test]
fn fields_of_view_refer_to_their_axis() {
    let fov = |lines: &str| {
        let text = GOOD.replace("<float name=\"fov\" value=\"40\"/>", lines);
        good(&text).description.camera.vertical_fov
    };
    let of = |axis: &str| {
        fov(&format!(
            "<float name=\"fov\" value=\"40\"/><string name=\"fovAxis\" value=\"{axis}\"/>"
        ))
    };
    let degrees = |tangent: f64| 2.0 * tangent.atan().to_degrees();
    let t = 20.0_f64.to_radians().tan();
    for (axis, tan_y) in [
        ("x", t / 2.0),
        ("y", t),
        ("smaller", t),
        ("larger", t / 2.0),
        ("diagonal", t / 5_f64.sqrt()),
    ] {
        assert!((of(axis) - degrees(tan_y)).abs() < 1e-9, "{axis}: {}", of(axis));
    }
    // Half the diagonal of 36 mm x 24 mm before 50 mm.
    let tan_y = 0.5 * (36.0_f64 * 36.0 + 24.0 * 24.0).sqrt() / 50.0 / 5_f64.sqrt();
    assert!((fov("") - degrees(tan_y)).abs() < 1e-9, "50 mm when nothing is said");
    let focal = fov("<string name=\"focalLength\" value=\"100mm\"/>");
    assert!((focal - degrees(0.5 * tan_y)).abs() < 1e-9, "{focal}");
}

#[test]
fn shapes_keep_their_front_whatever_the_transform() {
    let mirror = "<transform name=\"to_world\"><scale x=\"-1\" y=\"2\" z=\"1\"/></transform>";
    let flip = "<boolean name=\"flip_normals\" value=\"true\"/>";
    for (extra, sign) in [("", 1.0), (flip, -1.0)] {
        let cube = with(&format!("<shape type=\"cube\">{mirror}{extra}</shape>"));
        assert_eq!(volume(last_mesh(&cube)), sign * 6.0 * 16.0, "{extra}");
        let ellipsoid = with(&format!("<shape type=\"sphere\">{mirror}{extra}</shape>"));
        let exact = 6.0 * 4.0 / 3.0 * std::f64::consts::PI * 2.0;
        let ratio = volume(last_mesh(&ellipsoid)) / exact;
        assert!((ratio - sign).abs() < 1e-3, "{extra}: {ratio}");
        let normal = last_mesh(&ellipsoid).normals[0][0];
        let corner = last_mesh(&ellipsoid).triangles[0][0] as usize;
        let outwards = last_mesh(&ellipsoid).positions[corner].as_vec3().dot(normal);
        assert!(f64::from(outwards) * sign > 0.9, "{extra}: {outwards}");
        let disk = with(&format!("<shape type=\"disk\">{extra}</shape>"));
        let expected = DVec3::Z * sign * std::f64::consts::PI;
        assert!((area(last_mesh(&disk)) - expected).length() < 1e-9, "the area of the circle");
    }
    let cylinder = with("<shape type=\"cylinder\"><point name=\"p1\" z=\"3\"/></shape>");
    // The open side alone: two thirds of what with the ends would be three volumes.
    let ratio = volume(last_mesh(&cylinder)) / (6.0 * std::f64::consts::PI * 2.0);
    assert!((ratio - 1.0).abs() < 1e-3, "outwards: {ratio}");
}

#[test]
fn a_sphere_stays_exact_under_a_similarity() {
    let loaded = with(
        "<shape type=\"sphere\"><transform name=\"to_world\"><scale value=\"-2\"/>\
         <rotate x=\"1\" y=\"1\" angle=\"33\"/><translate x=\"5\"/></transform></shape>",
    );
    let ball = loaded.description.spheres.last().expect("a sphere");
    assert!((ball.radius - 2.0).abs() < 1e-12 && (ball.centre.x - 5.0).abs() < 1e-12, "{ball:?}");
    // Glass whose front is its inside is a hollow in glass.
    let loaded = with(
        "<shape type=\"sphere\"><boolean name=\"flipNormals\" value=\"true\"/><ref id=\"glass\"/></shape>",
    );
    let ball = loaded.description.spheres.last().expect("a sphere");
    match loaded.description.materials[usize::from(ball.material)].bsdf {
        BsdfDescription::Dielectric(DielectricDescription { eta, .. }) => {
            assert!((eta - 1.0 / 1.5).abs() < 1e-15);
        }
        other => panic!("{other:?}"),
    }
}

/// A square of two triangles, with a comment and an element that means nothing here.
const PLY: &str = "ply\nformat ascii 1.0\ncomment a square\nelement vertex 4\nproperty float x\n\
    property float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\n\
    element edge 1\nproperty int a\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n7\n";

fn load_ply(ply: &[u8], extra: &str) -> Result<Loaded, String> {
    let directory = tempfile::tempdir().expect("a directory");
    fs::write(directory.path().join("m.ply"), ply).expect("written");
    let shape = format!(
        "<shape type=\"ply\"><string name=\"filename\" value=\"m.ply\"/>{extra}</shape></scene>"
    );
    let path = directory.path().join("s.xml");
    fs::write(&path, GOOD.replace("</scene>", &shape)).expect("written");
    load(path.to_str().expect("UTF-8")).map_err(|error| error.to_string())
}

/// The square in a binary form.
fn binary_ply(
    format: &str,
    number: impl Fn(f32) -> [u8; 4],
    index: impl Fn(i32) -> [u8; 4],
) -> Vec<u8> {
    let head = PLY.split("element edge").next().expect("the head");
    let mut bytes = format!("{}end_header\n", head.replace("ascii", format)).into_bytes();
    for x in [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0] {
        bytes.extend(number(x));
    }
    bytes.push(4);
    (0..4).for_each(|i| bytes.extend(index(i)));
    bytes
}

#[test]
fn ply_is_read_as_text_and_in_both_binary_forms() {
    let little = binary_ply("binary_little_endian", f32::to_le_bytes, i32::to_le_bytes);
    let big = binary_ply("binary_big_endian", f32::to_be_bytes, i32::to_be_bytes);
    for bytes in [PLY.as_bytes(), &little, &big] {
        let loaded = load_ply(bytes, "").unwrap_or_else(|error| panic!("{error}"));
        let mesh = last_mesh(&loaded);
        assert_eq!((mesh.name.as_str(), mesh.triangles.len()), ("m", 2));
        assert_eq!(area(mesh), DVec3::Z, "{mesh:?}");
        assert_eq!(mesh.normals, [[glam::Vec3::Z; 3]; 2], "smooth normals of a plane");
    }
    let flat = load_ply(PLY.as_bytes(), "<boolean name=\"faceNormals\" value=\"true\"/>");
    assert!(last_mesh(&flat.expect("loads")).normals.is_empty(), "flat when asked for");
}

#[test]
fn a_mistake_in_a_ply_file_is_located() {
    for (from, to, words) in [
        ("4 0 1 2 3", "4 0 1 2 4", "m.ply: face 0 refers to vertex 4"),
        ("4 0 1 2 3", "2 0 1", "m.ply: face 0 has fewer"),
        ("4 0 1 2 3", "4 0 1 2 -3", "m.ply:17: "),
        ("element vertex 4", "element vertex 400000000", "m.ply: the header promises 400000000"),
        ("1 1 0\n", "1 one 0\n", "m.ply:15: "),
        ("1 1 0\n", "1 nan 0\n", "m.ply"),
        ("ply\n", "plier\n", "m.ply:1: "),
        ("4 0 1 2 3\n7\n", "", "m.ply"),
    ] {
        assert!(PLY.contains(from), "{from}");
        let message = load_ply(PLY.replacen(from, to, 1).as_bytes(), "");
        let message = message.map(|_| ()).expect_err(&format!("must be refused: {to}"));
        assert!(message.contains(words) || message.contains("s.xml:16"), "{to}: {message}");
        assert!(!message.contains('\n'), "{message}");
    }
}

#[test]
fn an_obj_file_takes_the_material_of_its_shape() {
    let directory = tempfile::tempdir().expect("a directory");
    let obj = "mtllib gone.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl lost\nf 1 2 3\n";
    fs::write(directory.path().join("a.obj"), obj).expect("written");
    let shape = "<shape type=\"obj\"><string name=\"filename\" value=\"a.obj\"/><ref id=\"red\"/></shape></scene>";
    let path = directory.path().join("s.xml");
    let text = GOOD.replace("</scene>", shape);
    fs::write(&path, &text).expect("written");
    let spec = path.to_str().expect("UTF-8");
    let loaded = load(spec).unwrap_or_else(|error| panic!("{error}"));
    assert!(loaded.warnings.is_empty(), "its own materials do not matter: {:?}", loaded.warnings);
    let mesh = last_mesh(&loaded);
    let material = &loaded.description.materials[usize::from(mesh.materials[0])];
    assert_eq!((mesh.name.as_str(), material.name.as_str()), ("a", "red"));
    // A folder with one XML file stands for it, whatever meshes lie beside it.
    assert_eq!(
        load(directory.path().to_str().expect("UTF-8")).expect("loads").description,
        loaded.description
    );
    fs::remove_file(directory.path().join("a.obj")).expect("removed");
    let message = load(spec).expect_err("gone").to_string();
    assert!(message.contains("s.xml:16:1: ") && message.contains("cannot read"), "{message}");
}

#[test]
fn every_mistake_is_located() {
    // What to replace, by what, line and column of the complaint, and words in it.
    let cases = [
        ("$depth", "$deep", "5:25", "`$deep` has no value"),
        ("value=\"$depth\"", "value=\"seven\"", "5:25", "`seven` is not a whole number"),
        ("value=\"$depth\"", "", "5:25", "the attribute `value` is missing"),
        ("\"perspective\"", "\"spherical\"", "6:1", "supported: perspective"),
        ("value=\"40\"", "value=\"180\"", "6:1", "between 0 and 180"),
        ("value=\"40\"", "value=\"nan\"", "7:1", "not a finite number"),
        ("target=\"0, 0, 0\"", "target=\"0, 0, -5\"", "8:27", "the same point"),
        ("target=\"0, 0, 0\"", "target=\"0, 0\"", "8:27", "one or three"),
        ("up=\"0, 1, 0\"", "up=\"0, 0, 1\"", "8:27", "up is zero"),
        ("<lookat", "<scale x=\"-1\"/><lookat", "6:1", "mirrors the picture"),
        ("value=\"$wide\"", "value=\"0\"", "9:1", "positive number of pixels"),
        ("value=\"$wide\"", "value=\"70000\"", "6:1", "width is 70000"),
        ("0.5, 0.1, 0\"", "0.5, 1.5, 0\"", "11:1", "must have all channels in [0, 1]"),
        ("0.5, 0.1, 0\"", "400:0.1, 700:0.2\"", "11:53", "a spectrum over wavelengths"),
        ("type=\"diffuse\"", "type=\"velvet\"", "11:32", "supported: diffuse"),
        ("value=\"1.5\"", "value=\"-1\"", "12:36", "glass is 1.5"),
        ("vacuum", "kryptonite", "12:70", "no medium of that name"),
        ("<scale value=\"2\"/>", "<scale value=\"0\"/>", "13:25", "are singular"),
        ("<scale value=\"2\"/>", "<skew/>", "13:51", "not a step of a transform"),
        ("<scale value=\"2\"/>", "<matrix value=\"1 2 3\"/>", "13:51", "3 numbers where 16 or 9"),
        ("<scale value=\"2\"/>", "<rotate angle=\"3\"/>", "13:51", "the axis is zero"),
        ("<translate z=\"3\"/>", "<translate z=\"1e300\"/>", "13:1", "too far away"),
        ("<ref id=\"red\"/>", "<ref id=\"rad\"/>", "13:99", "no element has the id `rad`"),
        ("id=\"glass\"", "id=\"red\"", "12:1", "s.xml:11:1; rename one"),
        ("value=\"0.5\"", "value=\"-0.5\"", "14:1", "radius is -0.5"),
        ("type=\"sphere\"", "type=\"hair\"", "14:1", "unknown shape"),
        ("<rgb name=\"radiance\" value=\"1 2 3\"/>", "", "15:35", "`radiance` is missing"),
        ("value=\"1 2 3\"", "value=\"1 2 -3\"", "15:1", "not negative"),
        ("<emitter type=\"area\">", "<emitter type=\"point\">", "15:35", "of type `area`"),
        ("</scene>", "<include filename=\"a.xml\"/></scene>", "16:1", "paste the content"),
        (
            "</scene>",
            "<shape type=\"cube\"><medium/></shape></scene>",
            "16:20",
            "participating media",
        ),
        ("</scene>", "</scen>", "16:1", "not well-formed XML"),
        (
            "<?xml version=\"1.0\"?>",
            "<!DOCTYPE a [<!ENTITY b \"c\">]>",
            "1:1",
            "not well-formed XML",
        ),
    ];
    for (from, to, place, words) in cases {
        assert!(GOOD.contains(from), "the case replaces nothing: {from}");
        let message = load_text(GOOD.replacen(from, to, 1)).map(|_| ());
        let message = message.expect_err(&format!("must be refused: {to}"));
        assert!(
            message.contains(&format!("s.xml:{place}: ")),
            "{to}: {message} ({place} expected)"
        );
        assert!(message.contains(words), "{to}: {message}");
        assert!(!message.contains('\n'), "one line: {message}");
    }
    let lamp = "<emitter type=\"area\"><rgb name=\"radiance\" value=\"1 2 3\"/></emitter>";
    let dark = load_text(GOOD.replace(lamp, "")).map(|_| ()).expect_err("no light");
    assert!(dark.contains("the scene has no light"), "{dark}");
    let page = load_text("<html/>").map(|_| ()).expect_err("no scene");
    assert!(page.contains("s.xml:1:1: `<html>`: not a scene"), "{page}");
}

#[test]
fn models_that_contain_themselves_are_refused() {
    let message = load_text(GOOD.replace(
        "<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.5, 0.1, 0\"/></bsdf>",
        "<ref id=\"red\"/>",
    ));
    let message = message.map(|_| ()).expect_err("a circle");
    assert!(message.contains("within itself"), "{message}");
    let depth = 100_000;
    let deep = format!("{}{}", "<scene>".repeat(depth), "</scene>".repeat(depth));
    assert!(load_text(deep).is_err(), "deep nesting is no scene, and does not overflow the stack");
}

#[test]
fn what_is_ignored_is_told_with_its_line() {
    let text = GOOD
        .replace("value=\"$depth\"", "value=\"-1\"")
        .replace("<film type", "<float name=\"farClip\" value=\"6\"/><film type")
        .replace(
            "</film>",
            "<rfilter type=\"gaussian\"/><boolean name=\"banner\" value=\"true\"/></film>",
        )
        .replace(
            "</scene>",
            "<shape type=\"cube\"><bsdf type=\"null\"/></shape>\n\
                 <shape type=\"disk\"><float name=\"wobble\" value=\"1\"/></shape>\n\
                 <emitter type=\"sun\"/><bsdf type=\"fur\" id=\"unused\"/></scene>",
        );
    let told: Vec<String> = good(&text).warnings.iter().map(ToString::to_string).collect();
    for words in [
        "s.xml:5:1: `<integrator type=\"path\">`: paths without an end: 12 edges",
        "s.xml:6:1: `<sensor type=\"perspective\">`: near_clip and far_clip are ignored",
        "`<rfilter type=\"gaussian\">`: pixels are averaged",
        "s.xml:16:1: `<shape type=\"cube\">`: ignored",
        "s.xml:17:1: `<shape type=\"disk\">`: the disk becomes a polygon",
        "s.xml:17:20: `<float name=\"wobble\">` in `<shape type=\"disk\">` is ignored",
        "s.xml:18:1: `<emitter type=\"sun\">`: ignored: unknown emitter",
    ] {
        assert!(told.iter().any(|line| line.contains(words)), "{words} is missing from {told:#?}");
    }
    assert_eq!(told.len(), 7, "nothing else: {told:#?}");
}

/// Some bytes of a good file replaced by others that mean something to the parser.
fn mutated() -> impl Strategy<Value = Vec<u8>> {
    let tokens: Vec<&[u8]> = vec![
        b"<",
        b"/>",
        b"\"",
        b"$",
        b"-",
        b"1e999",
        b"nan",
        b"\xff",
        b"",
        b"0",
        b"&lt;",
        b" ",
        b"<ref id=\"red\"/>",
    ];
    let edit = (any::<prop::sample::Index>(), 0_usize..6, prop::sample::select(tokens));
    prop::collection::vec(edit, 1..5).prop_map(|edits| {
        let mut bytes = GOOD.as_bytes().to_vec();
        for (at, length, token) in edits {
            let start = at.index(bytes.len());
            let end = (start + length).min(bytes.len());
            bytes.splice(start..end, token.iter().copied());
        }
        bytes
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(400) })]

    #[test]
    fn no_mutated_scene_panics_or_gets_through_unsound(text in mutated()) {
        match load_text(text) {
            Ok(loaded) => prop_assert!(Scene::new(&loaded.description).is_ok()),
            Err(message) => prop_assert!(message.contains("s.xml"), "{}", message),
        }
    }

    #[test]
    fn no_mutated_ply_panics(at in any::<prop::sample::Index>(), byte in any::<u8>(), length in 0_usize..9) {
        let mut bytes = binary_ply("binary_little_endian", f32::to_le_bytes, i32::to_le_bytes);
        let start = at.index(bytes.len());
        let end = (start + length).min(bytes.len());
        bytes.splice(start..end, [byte]);
        if let Err(message) = load_ply(&bytes, "") {
            prop_assert!(message.contains("m.ply") || message.contains("s.xml"), "{}", message);
        }
    }
}

#[test]
fn emitters_without_a_shape_and_lenses_are_read() {
    let text = GOOD
        .replace("type=\"perspective\">", "type=\"thinlens\"><float name=\"aperture_radius\" value=\"0.2\"/><float name=\"focusDistance\" value=\"5\"/>")
        .replace("</scene>", "<emitter type=\"point\"><point name=\"position\" value=\"1, 2, 3\"/><rgb name=\"intensity\" value=\"1, 2, 3\"/></emitter>
            <emitter type=\"spot\"><transform name=\"toWorld\"><lookat origin=\"0, 3, 0\" target=\"0, 1, 0\" up=\"0, 0, 1\"/></transform><float name=\"cutoffAngle\" value=\"40\"/></emitter>
            <emitter type=\"directional\"><vector name=\"direction\" x=\"0\" y=\"-1\" z=\"0\"/><float name=\"irradiance\" value=\"2\"/></emitter>
            <emitter type=\"constant\"><float name=\"radiance\" value=\"0.5\"/></emitter></scene>");
    let loaded = good(&text);
    assert_eq!(loaded.description.lens, Some(ThinLens { radius: 0.2, focus: 5.0 }));
    let kinds: Vec<&LightKind> =
        loaded.description.lights.iter().map(|light| &light.kind).collect();
    let [point, spot, sun, sky] = kinds.as_slice() else { panic!("{kinds:?}") };
    let at = DVec3::new(1.0, 2.0, 3.0);
    assert!(
        matches!(point, LightKind::Point { position, intensity } if *position == at && intensity.b == 3.0)
    );
    let down = |direction: DVec3| (direction.normalize() + DVec3::Y).length() < 1e-12;
    assert!(
        matches!(spot, LightKind::Spot { direction, cutoff: 40.0, beam: 30.0, .. } if down(*direction))
    );
    assert!(
        matches!(sun, LightKind::Directional { direction, irradiance } if down(*direction) && irradiance.r == 2.0)
    );
    assert!(
        matches!(sky, LightKind::Environment { image: None, radiance, .. } if radiance.g == 0.5)
    );
    assert!(Scene::new(&loaded.description).is_ok(), "sound");
}

#[test]
fn rough_models_and_metals_are_read() {
    let model = |xml: &str| {
        let loaded = with(&format!("<shape type=\"cube\">{xml}</shape>"));
        loaded.description.materials.last().expect("a material").bsdf
    };
    let gold = model(
        "<bsdf type=\"roughconductor\"><string name=\"material\" value=\"Au\"/><float name=\"alpha\" value=\"0.3\"/></bsdf>",
    );
    assert!(
        matches!(
            gold,
            BsdfDescription::Conductor(ConductorDescription {
                fresnel: Fresnel::Conductor { .. },
                roughness: NumberInput::Constant(0.3)
            })
        ),
        "{gold:?}"
    );
    let mirror =
        model("<bsdf type=\"conductor\"><string name=\"material\" value=\"none\"/></bsdf>");
    assert!(
        matches!(
            mirror,
            BsdfDescription::Conductor(ConductorDescription {
                fresnel: Fresnel::Constant(Rgb::WHITE),
                roughness: NumberInput::Constant(0.0)
            })
        ),
        "{mirror:?}"
    );
    let paint = model(
        "<bsdf type=\"plastic\"><float name=\"intIOR\" value=\"1.5\"/><float name=\"extIOR\" value=\"1\"/></bsdf>",
    );
    assert!(
        matches!(
            paint,
            BsdfDescription::Plastic(PlasticDescription {
                fresnel: Fresnel::Dielectric { eta: 1.5, .. },
                nonlinear: false,
                ..
            })
        ),
        "{paint:?}"
    );
    let frosted = model(
        "<bsdf type=\"roughdielectric\"><string name=\"distribution\" value=\"ggx\"/></bsdf>",
    );
    let BsdfDescription::Dielectric(frosted) = frosted else { panic!("{frosted:?}") };
    assert_eq!(frosted.roughness, NumberInput::Constant(0.1), "as Mitsuba has it");
    let unknown = GOOD.replace("type=\"dielectric\" id", "type=\"conductor\" id");
    let unknown = unknown.replace(
        "<float name=\"intIOR\" value=\"1.5\"/>",
        "<string name=\"material\" value=\"Unobtainium\"/>",
    );
    let message = load_text(unknown).expect_err("no such metal");
    assert!(message.contains("s.xml:12") && message.contains("Au"), "{message}");
}
