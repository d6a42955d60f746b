//! A file of paths, looked at like a daemon's session.

use std::path::Path;

use common::{Role, Welcome};

use super::dump::PlayableDump;
use super::model::Model;
use super::playback::Playback;
use super::status::{LinkState, Status};
use super::{Origin, Source};
use crate::command::PlayCommand;

impl Source {
    /// The file of this name, all of whose paths are shown.
    pub fn file(name: &str, playable: PlayableDump) -> Self {
        let mut status = Status::new(name.to_owned(), false);
        status.link = LinkState::Connected;
        status.welcome(welcome(name, &playable));
        if let Some(warning) = playable.warnings.first() {
            let more = match playable.warnings.len() - 1 {
                0 => String::new(),
                more => format!(" ({more} more in the Playback panel)"),
            };
            status.warn(&format!("in {name}, {warning}{more}"));
        }
        let model = Model::new(playable.mesh.clone());
        let bounds = playable.bounds();
        let mut source = Self::of(Origin::File(Box::new(Playback::new(playable))), status);
        name.clone_into(&mut source.shown.scene_hash);
        let model = model.map(|model| Model { bounds: bounds.unwrap_or(model.bounds), ..model });
        source.shown.set_model(model, source.status.welcome.as_ref());
        source.show_playback();
        source
    }

    /// Follows a command about the file of paths. False where there is none.
    pub fn play(&mut self, command: PlayCommand) -> bool {
        let Origin::File(playback) = &mut self.origin else { return false };
        playback.apply(command);
        self.show_playback();
        true
    }

    /// Plays on by `seconds`.
    pub fn play_on(&mut self, seconds: f32) {
        if let Origin::File(playback) = &mut self.origin
            && playback.advance(seconds)
        {
            self.show_playback();
        }
    }

    fn show_playback(&mut self) {
        let Origin::File(playback) = &mut self.origin else { return };
        let scene = playback.scene();
        if scene.anew {
            self.shown.store.clear();
        }
        if let Some(batch) = &scene.paths {
            self.shown.store.append(batch);
        }
        self.tally();
        if let Some(path) = scene.current {
            self.status.steering.focus.set_path(path);
        }
    }
}

/// What a file is called on screen.
pub fn name_of(file: &Path) -> String {
    file.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned())
}

/// What a daemon would say that showed such a file.
fn welcome(name: &str, playable: &PlayableDump) -> Welcome {
    let chains = playable.steps.iter().map(|step| step.chain).max().map_or(0, |last| last + 1);
    let longest = playable.paths.iter().map(|path| path.vertices.len()).max().unwrap_or(2);
    Welcome {
        session: 0,
        server_version: String::new(),
        scene_name: name.to_owned(),
        scene_hash: name.to_owned(),
        frame: playable.frame,
        camera: playable.camera,
        strategies: playable.strategies.clone(),
        failure_reasons: Vec::new(),
        chains,
        max_edges: longest.saturating_sub(1) as u32,
        role: Role::Observer,
        resume: String::new(),
    }
}
