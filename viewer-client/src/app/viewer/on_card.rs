//! The graphics card is brought up to date with what is shown.

use common::Camera;
use egui_wgpu::RenderState;
use glam::Vec3;

use crate::draw::gpu::{Renderer, Uploaded};
use crate::settings::{SceneSettings, Settings};
use crate::source::Shown;
use crate::source::model::{corners, drawing_aids};
use crate::source::store::{PAGE_POINTS, Store};
use crate::value::Bounds;

/// Points of paths that go to the graphics card in one frame at most: 6 MiB.
const UPLOAD_POINTS: usize = 16 * PAGE_POINTS;

/// What the graphics card holds, but for paths, of which the renderer knows.
#[derive(Debug, Default)]
pub(super) struct OnCard {
    /// The number of what is shown.
    shown: Option<u64>,
    /// The revision of its surfaces.
    surfaces: Option<u64>,
    aids: Option<Aids>,
}

/// What the drawing aids are made of.
#[derive(Clone, Debug, PartialEq)]
struct Aids {
    bounds: Option<Bounds>,
    /// Without it where the user looks through it: it would stand before the user's eyes.
    camera: Option<Camera>,
    up: Vec3,
    wanted: SceneSettings,
}

impl OnCard {
    /// Brings the graphics card up to date, as far as one frame allows. True when more is to come.
    pub(super) fn update(&mut self, gpu: &RenderState, shown: &Shown, settings: &Settings) -> bool {
        let mut egui_renderer = gpu.renderer.write();
        let Some(renderer) = egui_renderer.callback_resources.get_mut::<Renderer>() else {
            return false;
        };
        if self.shown.replace(shown.serial()) != Some(shown.serial()) {
            renderer.retain_from(u64::MAX);
            self.surfaces = None;
        }
        if self.surfaces.replace(shown.surfaces_revision()) != Some(shown.surfaces_revision()) {
            let mesh = shown.model.as_ref().map(|model| &model.mesh);
            let textures = mesh.map(|mesh| mesh.textures.as_slice()).unwrap_or_default();
            renderer.set_mesh(&mesh.map(corners).unwrap_or_default(), textures);
        }
        let aids = Aids::of(shown, settings);
        if self.aids.as_ref() != Some(&aids) {
            renderer.set_aids(&aids.points());
            self.aids = Some(aids);
        }
        renderer.retain_from(shown.store.first_serial());
        let more = upload_paths(&shown.store, renderer);
        renderer.set_uploading(more);
        more
    }
}

impl Aids {
    fn of(shown: &Shown, settings: &Settings) -> Self {
        let camera = shown.camera.render_camera().filter(|_| !shown.camera.is_through());
        Self {
            bounds: shown.model.as_ref().map(|model| model.bounds),
            camera: camera.copied(),
            up: shown.camera.up(),
            wanted: settings.scene.clone(),
        }
    }

    fn points(&self) -> Vec<shaders::LinePoint> {
        let Some(bounds) = self.bounds else { return Vec::new() };
        drawing_aids(bounds, self.camera.as_ref(), self.up, &self.wanted)
    }
}

/// Appends what is missing on the graphics card, newest pages first, since they are looked at.
fn upload_paths(store: &Store, renderer: &mut Renderer) -> bool {
    let mut room = UPLOAD_POINTS;
    let mut points = Vec::new();
    for page in store.pages().rev() {
        let whole = Uploaded { revision: page.revision(), paths: page.paths().len() };
        let there = renderer.uploaded(page.serial());
        if there == Some(whole) {
            continue;
        }
        if room == 0 {
            return true;
        }
        let skip = there.filter(|t| t.revision == whole.revision).map_or(0, |t| t.paths);
        points.clear();
        points.extend(page.points(skip, store.drawn()));
        renderer.append_points(page.serial(), whole, &points);
        room = room.saturating_sub(points.len());
    }
    false
}
