//! What came of one scene.

use std::sync::Arc;

use common::{FilterCounts, FilterScene, PathBatch, SceneFrame, SceneMesh, Welcome};
use glam::DVec3;

use super::model::Model;
use super::selection::Selection;
use super::store::{Drawn, Store};
use crate::camera::ViewCamera;
use crate::imaging::ImageView;
use crate::settings::CloudSettings;
use crate::value::{Pointer, fresh};

/// What came of one scene, and where the user looks in it. Another scene gets another.
#[derive(Debug)]
pub struct Shown {
    serial: u64,
    surfaces_revision: u64,
    /// Identifies the scene; blank before one is known.
    pub scene_hash: String,
    /// The user's eye.
    pub camera: ViewCamera,
    /// The scene has come, though it may have no surface.
    pub(super) scene_came: bool,
    /// What filters may ask for, as far as it is known.
    pub filter_scene: Arc<FilterScene>,
    /// Its surfaces.
    pub model: Option<Model>,
    /// The paths.
    pub store: Store,
    /// The picture.
    pub image: ImageView,
    /// The path that is looked at.
    pub selection: Option<Selection>,
    /// Where the user pointed to select it.
    pub pointed: Option<Pointer>,
    /// What the filter wants of a file of paths, all of which is here.
    pub counted: Option<FilterCounts>,
}

impl Shown {
    /// Nothing of a scene yet.
    pub fn new(scene_hash: String, cloud: &CloudSettings) -> Self {
        let mut shown = Self {
            serial: fresh(),
            surfaces_revision: fresh(),
            scene_hash,
            camera: ViewCamera::default(),
            scene_came: false,
            filter_scene: Arc::new(filter_scene(None, None)),
            model: None,
            store: Store::new(0),
            image: ImageView::default(),
            selection: None,
            pointed: None,
            counted: None,
        };
        shown.configure(cloud);
        shown
    }

    /// A number that no other has.
    pub fn serial(&self) -> u64 {
        self.serial
    }

    /// Another one after every change of the surfaces.
    pub fn surfaces_revision(&self) -> u64 {
        self.surfaces_revision
    }

    /// Keeps as much as the user allows, and draws what the user wants.
    pub fn configure(&mut self, cloud: &CloudSettings) {
        self.store.set_budget((cloud.budget_mib as usize) << 20);
        self.store.set_drawn(if cloud.dim > 0.0 { Drawn::All } else { Drawn::Matched });
    }

    /// Takes in a batch, or counts it only, where the user wants paths to stand still.
    pub(super) fn take_in(&mut self, batch: &PathBatch, frozen: bool) {
        if frozen {
            self.store.skip(batch);
        } else {
            self.store.append(batch);
        }
    }

    /// Takes in the surfaces, and looks at them.
    pub(super) fn set_model(&mut self, model: Option<Model>, welcome: Option<&Welcome>) {
        if let Some(model) = &model {
            let render = welcome.map(|welcome| welcome.camera).or(model.mesh.camera);
            self.camera.set_scene(model.bounds, render);
        }
        self.model = model;
        self.surfaces_revision = fresh();
        self.scene_came = true;
        self.rename_for_filters(welcome);
    }

    /// Brings what filters may ask for up to date with a session's names.
    pub(super) fn rename_for_filters(&mut self, welcome: Option<&Welcome>) {
        let mesh = self.model.as_ref().map(|model| &model.mesh);
        self.filter_scene = Arc::new(filter_scene(welcome, mesh));
    }
}

/// What filters may ask for, as far as it is known.
pub fn filter_scene(welcome: Option<&Welcome>, mesh: Option<&SceneMesh>) -> FilterScene {
    let unknown = SceneFrame { centre: DVec3::ZERO, scale: 1.0, light: 1.0 };
    let frame = welcome.map_or(unknown, |welcome| welcome.frame);
    let strategies = welcome.map(|welcome| welcome.strategies.clone()).unwrap_or_default();
    let none = SceneMesh::default();
    FilterScene::new(frame, mesh.unwrap_or(&none), strategies)
}
