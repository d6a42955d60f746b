//! Where images lie on shapes, and which side of them is the front.

use glam::DVec3;

use crate::scene::load::load;
use crate::scene::{Anchor, NO_PRIMITIVE, Scene, SceneDescription, Tracer};

/// A picture of two by two texels: red and green above blue and white.
fn picture() -> image::RgbImage {
    let texels = [[255, 0, 0], [0, 255, 0], [0, 0, 255], [255; 3]];
    image::RgbImage::from_fn(2, 2, |x, y| texels[(2 * y + x) as usize].into())
}

/// A scene of these shapes under an even sky.
fn read(version: &str, shapes: &str) -> SceneDescription {
    let directory = tempfile::tempdir().expect("a directory");
    picture().save(directory.path().join("a.png")).expect("written");
    let text = format!(
        "<scene version='{version}'><sensor type='perspective'/><emitter type='constant'/>{shapes}\
         </scene>"
    );
    let path = directory.path().join("s.xml");
    std::fs::write(&path, text).expect("written");
    load(path.to_str().expect("UTF-8")).expect("a scene").description
}

/// A shape with the picture on it.
fn painted(shape: &str, steps: &str, texture: &str) -> Scene {
    let text = format!(
        "<shape type='{shape}'><transform name='to_world'>{steps}</transform><bsdf type='diffuse'>\
         <texture name='reflectance' type='bitmap'><string name='filename' value='a.png'/>{texture}\
         </texture></bsdf></shape>"
    );
    Scene::new(&read("3.0.0", &text)).expect("sound")
}

/// The colour of the surface that is met from `from` towards `to`, in units of the file.
fn color(scene: &Scene, from: [f64; 3], to: [f64; 3]) -> &'static str {
    let frame = scene.frame();
    let [from, to] = [from, to].map(|point| frame.to_scene(DVec3::from(point)));
    let eye = Anchor { position: from, normal: (to - from).normalize(), primitive: NO_PRIMITIVE };
    let hit = Tracer::new(scene).closest(&eye, (to - from).normalize()).expect("it is met");
    let at = Anchor { position: hit.position, normal: hit.normal, primitive: hit.primitive };
    let local = scene.local(&at, scene.material_of(hit.primitive));
    let color = local.bsdf().preview_color();
    let names = [("red", [1, 0, 0]), ("green", [0, 1, 0]), ("blue", [0, 0, 1]), ("white", [1; 3])];
    let near = |rgb: [i32; 3]| [color.r, color.g, color.b].map(|c| i32::from(c > 0.5)) == rgb;
    names.into_iter().find(|(_, rgb)| near(*rgb)).map_or("another", |(name, _)| name)
}

#[test]
fn images_lie_on_shapes_as_their_renderer_has_them() {
    const S: f64 = std::f64::consts::FRAC_1_SQRT_2;
    let sphere = [[0.0, S, S], [0.0, -S, S], [0.0, S, -S], [0.0, -S, -S]];
    let met = |scene: &Scene, points: [[f64; 3]; 4], away: [f64; 3]| {
        points.map(|point| {
            let from = [0, 1, 2].map(|i| point[i] + 5.0 * away[i]);
            color(scene, if away == [0.0; 3] { point.map(|c| 5.0 * c) } else { from }, point)
        })
    };
    let names = ["red", "green", "blue", "white"];
    let up = [0.0, 0.0, 1.0];
    // Longitude from +x to +y, and the angle from +z.
    assert_eq!(met(&painted("sphere", "", ""), sphere, [0.0; 3]), names);
    let turned = sphere.map(|[x, y, z]| [x, -z, y]);
    let quarter = "<rotate x='1' angle='90'/>";
    assert_eq!(met(&painted("sphere", quarter, ""), turned, [0.0; 3]), names, "it goes along");
    let long = sphere.map(|[x, y, z]| [x, y, 2.0 * z]);
    let stretched = painted("sphere", "<scale z='2'/>", "");
    assert_eq!(met(&stretched, long, [0.0; 3]), names, "also where it becomes a mesh");
    // The distance from the middle, and the longitude.
    let disk = [[0.0, 0.25, 0.0], [0.0, 0.75, 0.0], [0.0, -0.25, 0.0], [0.0, -0.75, 0.0]];
    assert_eq!(met(&painted("disk", "", ""), disk, up), names);
    // From 0 to 1 along x and y.
    let square = [[-0.5, -0.5, 0.0], [0.5, -0.5, 0.0], [-0.5, 0.5, 0.0], [0.5, 0.5, 0.0]];
    assert_eq!(met(&painted("rectangle", "", ""), square, up), names);
    // The longitude, and the way along the axis.
    let side = [[0.0, 1.0, 0.25], [0.0, -1.0, 0.25], [0.0, 1.0, 0.75], [0.0, -1.0, 0.75]];
    let cylinder = painted("cylinder", "", "");
    let seen = side.map(|[x, y, z]| color(&cylinder, [x, 5.0 * y, z], [x, y, z]));
    assert_eq!(seen, names);
}

#[test]
fn images_lie_on_each_face_of_a_cube() {
    let cube = painted("cube", "", "");
    for (red, green, away) in [
        ([-0.5, -0.5, 1.0], [-0.5, 0.5, 1.0], [0.0, 0.0, 5.0]),
        ([-0.5, 0.5, -1.0], [-0.5, -0.5, -1.0], [0.0, 0.0, -5.0]),
        ([0.5, 1.0, 0.5], [-0.5, 1.0, 0.5], [0.0, 5.0, 0.0]),
        ([-0.5, -1.0, -0.5], [-0.5, -1.0, 0.5], [0.0, -5.0, 0.0]),
        ([1.0, -0.5, 0.5], [1.0, 0.5, 0.5], [5.0, 0.0, 0.0]),
        ([-1.0, -0.5, -0.5], [-1.0, 0.5, -0.5], [-5.0, 0.0, 0.0]),
    ] {
        let from = |point: [f64; 3]| [0, 1, 2].map(|i| point[i] + away[i]);
        let seen = [red, green].map(|point| color(&cube, from(point), point));
        assert_eq!(seen, ["red", "green"], "towards {away:?}");
    }
}

#[test]
fn images_are_moved_on_their_surfaces() {
    let red = |texture: &str| {
        color(&painted("rectangle", "", texture), [-0.5, -0.5, 5.0], [-0.5, -0.5, 0.0])
    };
    let moved = |step: &str| red(&format!("<transform name='to_uv'>{step}</transform>"));
    assert_eq!(red(""), "red");
    assert_eq!(moved("<translate x='0.5'/>"), "green");
    assert_eq!(moved("<translate y='0.5'/>"), "blue");
    assert_eq!(moved("<scale x='3' y='3'/>"), "white", "three quarters of the way");
    assert_eq!(red("<float name='uoffset' value='0.5'/>"), "green");
    assert_eq!(red("<float name='vscale' value='3'/>"), "blue");
}

#[test]
fn the_front_of_a_sphere_follows_flips_and_mirrors() {
    let lamp = |version: &str, inside: &str| {
        let text = format!(
            "<shape type='sphere'>{inside}<emitter type='area'><rgb name='radiance' value='1'/>\
             </emitter></shape>"
        );
        let description = read(version, &text);
        (description.spheres.len(), description.meshes.len())
    };
    let mirror = "<transform name='to_world'><scale x='-1'/></transform>";
    let flip = "<boolean name='flip_normals' value='true'/>";
    assert_eq!(lamp("3.0.0", ""), (1, 0), "it shines outwards");
    assert_eq!(lamp("3.0.0", flip), (0, 1), "inwards: a mesh");
    assert_eq!(lamp("3.0.0", mirror), (0, 1), "mirrored: inwards");
    assert_eq!(lamp("0.6.0", mirror), (1, 0), "which was another thing once");
    assert_eq!(lamp("3.0.0", &format!("{mirror}{flip}")), (1, 0), "twice");
}
