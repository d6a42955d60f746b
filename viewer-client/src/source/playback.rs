//! A dump of paths that is played: which step is shown, and how fast it goes on.

use std::sync::Arc;

use common::{
    BatchBuilder, BatchLimits, FocusOutcome, FocusPath, FocusStep, PathBatch, VertexRecord,
};

use crate::command::PlayCommand;
use crate::source::dump::{DumpPath, Outcome, PlayableDump, Step};
use crate::source::steering::Moment;

/// Steps a second to begin with.
const USUAL_RATE: f32 = 10.0;

/// A dump and the place in it.
#[derive(Debug)]
pub struct Playback {
    playable: PlayableDump,
    /// Index of the step that is shown.
    position: usize,
    playing: bool,
    rate: f32,
    /// Part of a step that has gone by.
    part: f32,
    /// Records that were handed out.
    shown: usize,
    moment: Option<Moment>,
}

/// Which paths to show now.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// The paths shown so far are void.
    pub anew: bool,
    /// More paths.
    pub paths: Option<PathBatch>,
    /// The current path.
    pub current: Option<FocusPath>,
}

impl Playback {
    /// A dump that stands at its end, so that all of its paths are shown.
    pub fn new(playable: PlayableDump) -> Self {
        let position = playable.steps.len().saturating_sub(1);
        let (rate, part) = (USUAL_RATE, 0.0);
        Self { playable, position, playing: false, rate, part, shown: 0, moment: None }
    }

    /// What is played.
    pub fn dump(&self) -> &PlayableDump {
        &self.playable
    }

    /// Index of the step that is shown, and how many there are.
    pub fn place(&self) -> (usize, usize) {
        (self.position, self.playable.steps.len())
    }

    /// The step that is shown.
    pub fn step(&self) -> Option<&Step> {
        self.playable.steps.get(self.position)
    }

    /// True while it goes on by itself.
    pub fn is_playing(&self) -> bool {
        self.playing
    }

    /// What it does, in a word.
    pub fn word(&self) -> &'static str {
        if self.playing { "Playing" } else { "Paused" }
    }

    /// Steps a second.
    pub fn rate(&self) -> f32 {
        self.rate
    }

    /// What the step changed; `None` for a seed, and for a proposal without a known path.
    pub fn moment(&self) -> Option<&Moment> {
        self.moment.as_ref()
    }

    /// Follows a command.
    pub fn apply(&mut self, command: PlayCommand) {
        let last = self.playable.steps.len().saturating_sub(1);
        match command {
            PlayCommand::Run(switch) => {
                switch.apply(&mut self.playing);
                // At the end there is nothing left to play.
                if self.playing && self.position == last {
                    self.position = 0;
                }
            }
            PlayCommand::Rate(rate) => self.rate = rate,
            PlayCommand::To(index) => self.position = (index as usize).min(last),
            PlayCommand::By(steps) => {
                let far = steps.unsigned_abs() as usize;
                self.position = if steps < 0 {
                    self.position.saturating_sub(far)
                } else {
                    self.position.saturating_add(far).min(last)
                };
                self.playing = false;
            }
            PlayCommand::Accepted => {
                let later = self.playable.steps.iter().enumerate().skip(self.position + 1);
                let next = later.into_iter().find(|(_, step)| step.outcome.has_path());
                self.position = next.map_or(last, |(index, _)| index);
                self.playing = false;
            }
        }
        self.part = 0.0;
    }

    /// Goes on by `seconds`. True when another step is shown.
    pub fn advance(&mut self, seconds: f32) -> bool {
        if !self.playing {
            return false;
        }
        self.part += seconds * self.rate;
        let steps = self.part.floor();
        self.part -= steps;
        let last = self.playable.steps.len().saturating_sub(1);
        self.position = (self.position + steps as usize).min(last);
        self.playing = self.position < last;
        steps > 0.0
    }

    /// What is to be shown at this place, given what was shown before.
    pub fn scene(&mut self) -> Scene {
        let record = self.step().map_or(0, |step| step.record);
        let wanted = (record + 1).min(self.playable.paths.len());
        let anew = wanted < self.shown;
        let from = if anew { 0 } else { self.shown };
        self.shown = wanted;
        self.moment = self.find_moment();
        let paths = self.playable.paths.get(from..wanted).unwrap_or_default();
        Scene {
            anew,
            paths: batch(paths),
            current: self.playable.paths.get(record).map(focus_path),
        }
    }

    fn find_moment(&self) -> Option<Moment> {
        let step = self.step()?;
        let after = self.playable.paths.get(step.record)?;
        let before = self.playable.paths.get(step.record.checked_sub(1)?)?;
        let (kept_light, kept_eye) = kept(&before.vertices, &after.vertices);
        match step.outcome {
            Outcome::Accepted(_) => {}
            // Records without a word may be of other chains. All paths share a pinhole.
            Outcome::Recorded if kept_light + kept_eye > 1 => {}
            _ => return None,
        }
        let inner = kept_light..after.vertices.len() - kept_eye;
        let step = FocusStep {
            number: self.position as u64,
            id: after.header.id,
            strategy: after.header.strategy,
            outcome: FocusOutcome::Accepted,
            acceptance: f64::from(after.header.acceptance),
            length: before.vertices.len(),
            kept_light,
            kept_eye,
            inserted: after.vertices.get(inner)?.to_vec(),
            film: after.header.film,
            luminance: after.header.luminance,
            rgb: after.header.rgb,
            ..FocusStep::default()
        };
        Some(Moment { before: Arc::new(focus_path(before)), step: Arc::new(step) })
    }
}

fn focus_path(path: &DumpPath) -> FocusPath {
    FocusPath { header: path.header, vertices: path.vertices.clone(), next: 0 }
}

/// How many vertices two paths share at the light end and at the lens end.
fn kept(before: &[VertexRecord], after: &[VertexRecord]) -> (usize, usize) {
    let same = |(a, b): &(&VertexRecord, &VertexRecord)| a == b;
    let light = before.iter().zip(after).take_while(same).count();
    let most = before.len().min(after.len()) - light;
    let eye = before.iter().rev().zip(after.iter().rev()).take(most).take_while(same).count();
    (light, eye)
}

fn batch(paths: &[DumpPath]) -> Option<PathBatch> {
    let mut builder = BatchBuilder::new(BatchLimits { bytes: usize::MAX });
    for path in paths {
        // Without a limit, no push completes a batch.
        drop(builder.push(&path.header, &path.vertices, None));
    }
    builder.finish()
}

#[cfg(test)]
mod tests {
    use common::{ChainId, Event, PathHeader, PathId, SceneFrame, SceneMesh, VertexKind};
    use glam::DVec3;

    use super::*;
    use crate::value::Switch;

    fn path(step: u64, tags: &[f32]) -> DumpPath {
        let vertex = |x: &f32| VertexRecord {
            position: [*x, 0.0, 0.0],
            normal: [0; 2],
            kind: VertexKind::Diffuse,
            event: Event::Diffuse,
            material: 0,
            primitive: 0,
        };
        let id = PathId { chain: ChainId(0), epoch: 0, step };
        let vertices = tags.iter().map(vertex).collect();
        let header = PathHeader { id, ..PathHeader::default() };
        let outcome = Outcome::Recorded;
        DumpPath { header, vertices, numbers: Vec::new(), outcome, line: 1 }
    }

    fn playback() -> Playback {
        let step = |number, outcome, record| Step {
            line: 1,
            chain: 0,
            number,
            outcome,
            mutation: String::new(),
            pixel: None,
            configuration: String::new(),
            record,
        };
        let accepted = Outcome::Accepted(0.5);
        Playback::new(PlayableDump {
            frame: SceneFrame { centre: DVec3::ZERO, scale: 1.0, light: 1.0 },
            camera: crate::synthetic::camera(),
            strategies: Vec::new(),
            mesh: SceneMesh::default(),
            paths: vec![path(0, &[1.0, 2.0, 3.0, 9.0]), path(2, &[1.0, 5.0, 6.0, 3.0, 9.0])],
            steps: vec![
                step(0, Outcome::Seed, 0),
                step(1, Outcome::Rejected(0.1), 0),
                step(2, accepted, 1),
            ],
            annotated: true,
            warnings: Vec::new(),
        })
    }

    #[test]
    fn it_goes_back_and_forth() {
        let mut playback = playback();
        let paths = |scene: Scene| (scene.anew, scene.paths.map_or(0, |batch| batch.len()));
        assert_eq!(paths(playback.scene()), (false, 2), "all of it to begin with");
        playback.apply(PlayCommand::To(1));
        assert_eq!(paths(playback.scene()), (true, 1), "back to what was known then");
        assert_eq!(playback.moment(), None, "of the rejected proposal no path is known");
        playback.apply(PlayCommand::Accepted);
        assert_eq!(paths(playback.scene()), (false, 1), "one more");
        let moment = playback.moment().expect("an accepted step");
        assert_eq!((moment.step.kept_light, moment.step.kept_eye), (1, 2), "the ends are kept");
        let tags: Vec<_> = moment.step.inserted.iter().map(|v| v.position[0]).collect();
        assert_eq!(tags, [5.0, 6.0], "what is new");
        let proposal = moment.proposal().expect("a path");
        assert_eq!(proposal, playback.dump().paths[1].vertices, "together the path after");
    }

    #[test]
    fn records_without_a_word_follow_each_other_where_they_share_vertices() {
        let mut playback = playback();
        playback.playable.steps[2].outcome = Outcome::Recorded;
        playback.scene();
        assert!(playback.moment().is_some(), "three vertices are the same");
        playback.playable.paths[1] = path(2, &[7.0, 5.0, 6.0, 9.0]);
        playback.scene();
        assert_eq!(playback.moment(), None, "the lens alone is");
    }

    #[test]
    fn it_plays_to_the_end_and_stops() {
        let mut playback = playback();
        playback.apply(PlayCommand::Rate(10.0));
        playback.apply(PlayCommand::Run(Switch::On));
        assert_eq!(playback.place(), (0, 3), "from the beginning");
        assert!(!playback.advance(0.05), "half a step");
        assert!(playback.advance(0.06), "a step");
        assert_eq!(playback.place().0, 1, "the second");
        assert!(playback.advance(9.0) && !playback.is_playing(), "the end");
        playback.apply(PlayCommand::By(-5));
        assert_eq!(playback.place().0, 0, "never before the beginning");
    }
}
