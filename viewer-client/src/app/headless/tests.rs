//! Pictures of the whole window, drawn by whatever graphics driver there is.

use image::{Rgba, RgbaImage};

use super::*;
use crate::source::Source;
use crate::synthetic::{SyntheticSession, delivery};

pub(super) const SIZE: [u32; 2] = [1280, 720];

/// A path that crosses the view, level, at the height of 150 units; far and near of the middle.
const FAR: &[[f32; 3]] = &[[-400.0, 150.0, -400.0], [400.0, 150.0, -400.0]];
const NEAR: &[[f32; 3]] = &[[-400.0, 150.0, 400.0], [400.0, 150.0, 400.0]];

pub(super) fn offscreen() -> Option<OffscreenWindow> {
    OffscreenWindow::new(SIZE)
        .inspect_err(|error| ::tests::skip(&format!("nothing can draw here: {error:#}")))
        .ok()
}

/// The window after these commands, with these paths.
fn picture(offscreen: &mut OffscreenWindow, paths: &[&[[f32; 3]]], commands: &[&str]) -> RgbaImage {
    picture_of(offscreen, delivery(paths), commands)
}

/// The window after these commands, when this has come.
pub(super) fn picture_of(
    offscreen: &mut OffscreenWindow,
    delivery: SyntheticSession,
    commands: &[&str],
) -> RgbaImage {
    let mut viewer = Viewer::new(Source::daemon("127.0.0.1:50061".to_owned(), false));
    // A filter that stands when the paths come does not wait for the user's hand to rest.
    let (filter, commands): (Vec<&str>, Vec<&str>) =
        commands.iter().partition(|command| command.starts_with("filter"));
    for command in filter {
        viewer.apply(command.parse().expect(command));
    }
    delivery.put(viewer.inbox().expect("a daemon"));
    viewer.receive();
    let fixed = ["camera view front", "scene grid off", "scene camera off", "cloud ends off"];
    for command in fixed.into_iter().chain(commands) {
        viewer.apply(command.parse().expect(command));
    }
    offscreen.settled(&mut viewer).expect("a picture")
}

/// A column of the viewport, left of where the paths meet at the camera.
pub(super) const COLUMN: u32 = 520;

/// Rows of the column in which two pictures differ visibly.
pub(super) fn rows_that_differ(a: &RgbaImage, b: &RgbaImage) -> Vec<u32> {
    let differs = |p: &Rgba<u8>, q: &Rgba<u8>| (0..3).any(|c| p[c].abs_diff(q[c]) > 24);
    // The upper bar and the captions below it are left out.
    (70..SIZE[1] - 60)
        .filter(|y| differs(a.get_pixel(COLUMN, *y), b.get_pixel(COLUMN, *y)))
        .collect()
}

#[test]
fn lines_keep_their_width_whatever_their_distance() {
    let Some(mut offscreen) = offscreen() else { return };
    let width = "cloud width 20";
    let strong = "cloud opacity 1";
    let empty = picture(&mut offscreen, &[FAR], &["cloud shown 0"]);
    let far = rows_that_differ(&empty, &picture(&mut offscreen, &[FAR], &[width, strong]));
    let near = rows_that_differ(&empty, &picture(&mut offscreen, &[NEAR], &[width, strong]));
    for rows in [&far, &near] {
        assert!((19..=21).contains(&rows.len()), "a line of 20 pixels covers the rows {rows:?}");
        assert!(rows.windows(2).all(|w| w[1] == w[0] + 1), "without a hole: {rows:?}");
    }
    assert!(near[0] < far[0], "what is nearer is seen higher above the middle");
}

/// Pixels in which two pictures differ by more than `steps` in a channel.
fn pixels_that_differ(a: &RgbaImage, b: &RgbaImage, steps: u8) -> usize {
    let pairs = a.pixels().zip(b.pixels());
    pairs.filter(|(p, q)| (0..3).any(|c| p[c].abs_diff(q[c]) > steps)).count()
}

#[test]
fn a_picture_drawn_in_parts_is_the_same() {
    let Some(mut offscreen) = offscreen() else { return };
    // Six pages of short paths, so that there is something to divide.
    let bit = |i: usize| {
        let [x, y] = [i % 160, i / 160].map(|n| 5.0 * n as f32 - 400.0);
        [[x, y, 0.0], [x + 9.0, y + 3.0, 40.0], [x - 5.0, y + 20.0, 0.0]]
    };
    let bits: Vec<_> = (0..24_000).map(bit).collect();
    let paths: Vec<&[[f32; 3]]> = bits.iter().map(<[_; 3]>::as_slice).collect();
    let limit = |offscreen: &mut OffscreenWindow, points| {
        let mut renderer = offscreen.gpu.renderer.write();
        renderer.callback_resources.get_mut::<Renderer>().expect("a renderer").limit(points);
    };
    // Old paths stay as opaque as new ones: upper ones fill pixels, and lower ones are left out there.
    let dense = ["cloud shown 1000000", "cloud dots 2", "cloud color luminance", "cloud opacity 1"];
    // Where thousands of faint ends meet, half floats round otherwise in another order, and most so
    // where they add up.
    for (look, steps) in [
        ("cloud fade 1000000", 3),
        ("cloud color age", 3),
        ("scene opacity 0.4", 3),
        ("scene shading off", 3),
        ("cloud blend add", 12),
    ] {
        let look = [&dense[..], &[look]].concat();
        let few = picture(&mut offscreen, &paths, &[&["cloud shown 2000"], &look[1..]].concat());
        limit(&mut offscreen, 1 << 24);
        let at_once = picture(&mut offscreen, &paths, &look);
        limit(&mut offscreen, 20_000);
        let in_parts = picture(&mut offscreen, &paths, &look);
        let off = pixels_that_differ(&at_once, &in_parts, steps);
        assert!(off < 60, "{look:?}: the parts make the whole but for {off} pixels");
        assert!(pixels_that_differ(&at_once, &few, 50) > 1000, "and show more than the newest");
    }
}

#[test]
fn a_plane_cuts_paths_away() {
    let Some(mut offscreen) = offscreen() else { return };
    let wide = ["cloud width 8", "cloud opacity 1"];
    let half = |side: &str| {
        let empty = picture(&mut offscreen, &[FAR], &["cloud shown 0", side, "scene cut 0.5"]);
        let cut = picture(&mut offscreen, &[FAR], &[wide[0], wide[1], side, "scene cut 0.5"]);
        !rows_that_differ(&empty, &cut).is_empty()
    };
    let seen = ["scene clip off", "scene clip -x", "scene clip x"].map(half);
    assert_eq!(seen, [true, true, false], "the column lies left of the middle");
}

#[test]
fn surfaces_hide_what_lies_behind_them() {
    let Some(mut offscreen) = offscreen() else { return };
    let behind: &[[f32; 3]] = &[[-400.0, 150.0, -600.0], [400.0, 150.0, -600.0]];
    let look = ["cloud width 8", "cloud opacity 1", "cloud hidden 0.02"];
    let empty = picture(&mut offscreen, &[behind], &["cloud shown 0"]);
    let hidden = picture(&mut offscreen, &[behind], &look);
    assert!(rows_that_differ(&empty, &hidden).is_empty(), "the wall hides the path");
    let [width, opacity, _] = look;
    let shown = picture(&mut offscreen, &[behind], &[width, opacity, "cloud hidden 1"]);
    assert!(!rows_that_differ(&empty, &shown).is_empty(), "unless hidden parts are wanted");
    let x_ray = picture(&mut offscreen, &[behind], &[width, opacity, "scene shading off"]);
    assert!(!rows_that_differ(&empty, &x_ray).is_empty(), "or there are no surfaces");
}

#[test]
fn the_whole_window_is_drawn_and_drawn_alike() {
    let Some(mut offscreen) = offscreen() else { return };
    let first = picture(&mut offscreen, &[FAR, NEAR], &[]);
    let second = picture(&mut offscreen, &[FAR, NEAR], &[]);
    assert!(first == second, "the same state gives the same picture");
    // The film is 0.1, 0.3, 0.6 everywhere: 89, 149, 203 in sRGB.
    let film = first.pixels().filter(|p| p.0 == [89, 149, 203, 255]).count();
    assert!(film > 10_000, "the image panel shows the film: {film} pixels");
    let light = picture(&mut offscreen, &[FAR, NEAR], &["theme light"]);
    let mean = |image: &RgbaImage| {
        let sum: u64 = image.pixels().map(|p| u64::from(p[1])).sum();
        sum / u64::from(SIZE[0] * SIZE[1])
    };
    assert!(mean(&light) > mean(&first) + 60, "the light theme is light");
}
