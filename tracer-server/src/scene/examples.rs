//! The built-in scenes and real scenes made by others must load as their authors meant them.

use std::path::Path;
use std::time::Instant;

use common::Rgb;

use super::Scene;
use super::builtin::{BUILTINS, Builtin};
use super::fixtures::shared_scenes;
use super::load::{Loaded, load};
use crate::bsdf::{BsdfDescription, DielectricDescription, MirrorDescription};

fn triangles(loaded: &Loaded) -> usize {
    loaded.description.meshes.iter().map(|mesh| mesh.triangles.len()).sum()
}

fn bsdf(loaded: &Loaded, name: &str) -> BsdfDescription {
    let material = loaded.description.materials.iter().find(|m| m.name == name);
    material.unwrap_or_else(|| panic!("there is no material {name}")).bsdf
}

#[test]
fn every_built_in_scene_loads_without_a_warning() {
    for builtin in BUILTINS {
        let loaded = load(builtin.name).unwrap_or_else(|error| panic!("{error}"));
        assert!(loaded.warnings.is_empty(), "{}: {:?}", builtin.name, loaded.warnings);
        assert_eq!(loaded.description.name, builtin.name);
        let summary = builtin.summary().expect("parsed");
        assert!((20..80).contains(&summary.len()), "{}: `{summary}`", builtin.name);
    }
    assert_eq!(Builtin::find("nowhere"), None);
}

#[test]
fn the_built_in_scenes_are_what_their_heads_say() {
    let cornell = load("cornell").expect("loads");
    assert_eq!(triangles(&cornell), 36);
    assert!(cornell.description.spheres.is_empty());
    let diffuse = |loaded: &Loaded| {
        let mut materials = loaded.description.materials.iter();
        materials.all(|m| matches!(m.bsdf, BsdfDescription::Lambert(_)))
    };
    assert!(diffuse(&cornell) && diffuse(&load("door").expect("loads")), "matt only");
    let caustic = load("caustic").expect("loads");
    assert_eq!(caustic.description.spheres.len(), 1);
    assert!(matches!(
        bsdf(&caustic, "glass"),
        BsdfDescription::Dielectric(DielectricDescription { eta: 1.5, .. })
    ));
    let mirrors = load("mirror-caustic").expect("loads");
    assert!(matches!(bsdf(&mirrors, "silver"), BsdfDescription::Mirror(_)));
    let door = triangles(&load("door").expect("loads"));
    assert!((50..400).contains(&door), "{door} triangles");
}

#[test]
fn the_example_of_the_scenes_readme_loads() {
    let readme = include_str!("../../../scenes/README.md");
    let example = readme.split("```toml").nth(1).and_then(|rest| rest.split("```").next());
    let directory = tempfile::tempdir().expect("a directory");
    let write = |name: &str, text: &str| std::fs::write(directory.path().join(name), text);
    write("scene.toml", example.expect("a block of TOML")).expect("written");
    write("statue.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("written");
    image::Rgb32FImage::from_pixel(4, 2, [1.0, 2.0, 3.0].into())
        .save(directory.path().join("sky.hdr"))
        .expect("written");
    let loaded = load(directory.path().to_str().expect("UTF-8")).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(triangles(&loaded), 2 + 12 + 1 + 1);
    let scene = Scene::new(&loaded.description).expect("a sound scene");
    let sky = scene.lamps().find(|lamp| lamp.kind == "environment").expect("a sky");
    assert!((sky.color.b - 3.0).abs() < 0.02, "{sky:?}");
}

fn load_shared(scenes: &Path, name: &str) -> Loaded {
    load(scenes.join(name).to_str().expect("UTF-8")).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn all_mcguire_boxes_load() {
    let Some(scenes) = shared_scenes() else { return };
    let boxes = [
        ("Empty-CO", 12),
        ("Empty-RG", 12),
        ("Empty-White", 12),
        ("Empty-Squashed", 12),
        ("Glossy", 1_112),
        ("Glossy-Floor", 1_112),
        ("Mirror", 36),
        ("Original", 36),
        ("Sphere", 2_188),
        ("Water", 7_088),
    ];
    for (name, count) in boxes {
        let loaded = load_shared(&scenes, &format!("cornell-mcguire/CornellBox-{name}.obj"));
        assert_eq!(triangles(&loaded), count, "{name}: {:?}", loaded.warnings);
        let camera = loaded.description.camera;
        let usual = glam::DVec3::new(0.0, 1.0, 6.8);
        assert!((camera.origin - usual).length() < 0.3, "{name} is seen from {}", camera.origin);
    }
}

#[test]
fn a_mesh_without_a_light_is_refused() {
    let Some(scenes) = shared_scenes() else { return };
    let path = scenes.join("cornell-mcguire/water.obj");
    let message = load(path.to_str().expect("UTF-8")).expect_err("no light").to_string();
    assert!(message.contains("water.obj: the scene has no light: give some surface"), "{message}");
}

#[test]
fn mirror_glass_and_water_are_recognised() {
    let Some(scenes) = shared_scenes() else { return };
    let water = load_shared(&scenes, "cornell-mcguire/CornellBox-Water.obj");
    let eta = |name| match bsdf(&water, name) {
        BsdfDescription::Dielectric(DielectricDescription { eta, .. }) => eta,
        other => panic!("{name} is {other:?}"),
    };
    assert_eq!((eta("water"), eta("rightSphere")), (1.33, 1.5));
    let mirror = BsdfDescription::Mirror(MirrorDescription { reflectance: Rgb::grey(0.95) });
    assert_eq!(bsdf(&water, "leftSphere"), mirror);
    let original = load_shared(&scenes, "cornell-mcguire/CornellBox-Original.obj");
    let light = original.description.materials.iter().find(|m| m.name == "light");
    assert_eq!(light.map(|m| m.emission), Some(Rgb::new(17.0, 12.0, 4.0)));
    assert!(original.warnings.is_empty(), "{:?}", original.warnings);
}

#[test]
fn scenes_with_a_camera_file_load() {
    let Some(scenes) = shared_scenes() else { return };
    let expected = [
        ("cornell-box-bitterli", 36, 1024),
        ("veach-mis", 11_956, 720),
        ("veach-bidir", 11_544, 1024),
        ("water-caustic", 103_487, 1024),
        ("staircase2", 31_247, 1024),
    ];
    for (name, count, height) in expected {
        // A folder that holds one scene stands for it.
        let loaded = load_shared(&scenes, name);
        let dropped = loaded.warnings.iter().filter(|w| w.message.contains("without area")).count();
        let complete = triangles(&loaded) == count || dropped > 0;
        assert!(complete && triangles(&loaded) <= count, "{name}: {}", triangles(&loaded));
        assert_eq!(loaded.description.height, height, "{name}");
    }
}

#[test]
#[expect(clippy::print_stderr, reason = "the loading time is worth knowing, but not a law")]
fn a_scene_of_many_triangles_loads() {
    let Some(scenes) = shared_scenes() else { return };
    let start = Instant::now();
    let ajar = load_shared(&scenes, "veach-ajar");
    eprintln!("veach-ajar: {} triangles in {:.2?}", triangles(&ajar), start.elapsed());
    for warning in &ajar.warnings {
        eprintln!("{warning}");
    }
    assert!((382_000..=382_690).contains(&triangles(&ajar)), "{}", triangles(&ajar));
    let textures = &ajar.description.textures;
    assert_eq!(textures.len(), 3, "one with a space in its name: {textures:?}");
    let smooth = ajar.description.meshes.iter().filter(|mesh| !mesh.normals.is_empty()).count();
    assert!(smooth > 0, "shading normals are read");
}
