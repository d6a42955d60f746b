//! A file of paths in the place of a daemon.

use common::{Role, Welcome};

use super::Viewer;
use crate::command::{CloudCommand, ColorMode, Command, PlayCommand};
use crate::source::connection::Delivery;
use crate::source::dump::Stage;
use crate::source::model::Model;
use crate::source::playback::Playback;
use crate::source::status::LinkState;

/// The longest pause between two frames that counts, in seconds.
const LONGEST_FRAME: f32 = 0.1;

impl Viewer {
    /// Shows a file of paths instead of what a daemon sends.
    pub fn open_dump(&mut self, name: &str, stage: Stage) {
        let chains = stage.steps.iter().map(|step| step.chain).max().map_or(0, |last| last + 1);
        let longest = stage.acts.iter().map(|act| act.vertices.len()).max().unwrap_or(2);
        let welcome = Welcome {
            session: 0,
            server_version: String::new(),
            scene_name: name.to_owned(),
            scene_hash: name.to_owned(),
            frame: stage.frame,
            camera: stage.camera,
            strategies: stage.strategies.clone(),
            failure_reasons: Vec::new(),
            chains,
            max_edges: longest.saturating_sub(1) as u32,
            role: Role::Observer,
            resume: String::new(),
        };
        self.take(Delivery {
            state: Some(LinkState::Connected),
            welcome: Some(welcome),
            ..Delivery::default()
        });
        let model = Model::new(stage.mesh.clone());
        self.set_model(
            model.map(|model| Model { bounds: stage.bounds().unwrap_or(model.bounds), ..model }),
        );
        // A file tells no radiance.
        self.apply(Command::Cloud(CloudCommand::Color(ColorMode::Class)));
        if let Some(warning) = stage.warnings.first() {
            let more = match stage.warnings.len() - 1 {
                0 => String::new(),
                more => format!(" ({more} more in the Playback panel)"),
            };
            self.status.say(Err(format!("in {name}, {warning}{more}")));
        }
        self.playback = Some(Playback::new(stage));
        self.show_playback();
    }

    /// Says why nothing can be steered in a file of paths; false where a daemon is.
    pub(super) fn refuse_to_steer(&mut self) -> bool {
        if self.playback.is_none() {
            return false;
        }
        let problem = "A file of paths has no daemon whose chains could be steered or explored; open \
                       the scene itself with `viewer-client --scene SCENE`.";
        self.status.say(Err(problem.to_owned()));
        true
    }

    /// Follows a command about the file of paths.
    pub(super) fn play(&mut self, command: PlayCommand) {
        if let Some(playback) = &mut self.playback {
            playback.apply(command);
            self.show_playback();
        } else {
            let problem = "There is no file of paths to play; open one with `viewer-client FILE`.";
            self.status.say(Err(problem.to_owned()));
        }
    }

    /// Plays on, as far as the time since the last frame allows.
    pub(super) fn play_on(&mut self, ctx: &egui::Context) {
        let Some(playback) = &mut self.playback else { return };
        let seconds = ctx.input(|input| input.stable_dt).min(LONGEST_FRAME);
        if playback.advance(seconds) {
            self.show_playback();
        }
        if self.playback.as_ref().is_some_and(Playback::is_playing) {
            ctx.request_repaint();
        }
    }

    fn show_playback(&mut self) {
        let Some(playback) = &mut self.playback else { return };
        let scene = playback.scene();
        if scene.anew {
            self.store.clear();
        }
        if let Some(batch) = &scene.paths {
            self.store.append(batch);
        }
        self.tally();
        if let Some(path) = scene.current {
            self.status.steering.focus.take_path(path);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Viewer;
    use crate::source::dump::tests::{STEPS, stage};
    use crate::source::playback::Playback;
    use crate::source::status::Status;

    #[test]
    fn what_was_left_out_and_cannot_be_done_is_said() {
        let mut viewer = Viewer::new(Status::new("paths.txt".to_owned(), false));
        assert!(!viewer.refuse_to_steer(), "a daemon may be asked");
        let warnings = ["the last record has no end", "two more"].map(str::to_owned).into();
        viewer.open_dump("paths.txt", crate::source::dump::Stage { warnings, ..stage() });
        let said = |viewer: &Viewer| viewer.status.notice.clone().map(|notice| notice.text);
        let expected = "In paths.txt, the last record has no end (1 more in the Playback panel)";
        assert_eq!(said(&viewer).as_deref(), Some(expected), "in the window");
        assert!(viewer.refuse_to_steer(), "there is nobody to steer");
        assert!(said(&viewer).is_some_and(|text| text.contains("--scene")), "what to do");
    }

    #[test]
    fn all_of_a_file_is_in_the_picture() {
        let mut viewer = Viewer::new(Status::new("paths.txt".to_owned(), false));
        let stage = stage();
        let lens = glam::Vec3::from(stage.acts[0].vertices[2].position);
        viewer.open_dump("paths.txt", stage);
        let bounds = viewer.bounds().expect("a scene");
        let is_within = lens.cmpge(bounds.min).all() && lens.cmple(bounds.max).all();
        assert!(is_within, "the lens at {lens} lies outside of {bounds:?}");
    }

    #[test]
    fn a_file_is_shown_played_and_picked() {
        let mut viewer = Viewer::new(Status::new("paths.txt".to_owned(), false));
        viewer.open_dump("paths.txt", stage());
        let mut run = |command: &str| {
            viewer.apply(command.parse().expect("a command"));
            (viewer.store.len(), viewer.playback.as_ref().map(Playback::place))
        };
        assert_eq!(run("play rate 5"), (2, Some((STEPS - 1, STEPS))), "all of it");
        assert_eq!(run("play to 0"), (1, Some((0, STEPS))), "the seed");
        assert_eq!(run("play by 2"), (1, Some((2, STEPS))), "rejected: the same path");
        assert_eq!(run("play accepted"), (2, Some((3, STEPS))), "one more");
        assert!(viewer.model.is_some(), "the places that paths touch");
        let shown = viewer.status.steering.focus.current().map(|path| path.header.id.step);
        assert_eq!(shown, Some(3), "the current path is drawn");
    }
}
