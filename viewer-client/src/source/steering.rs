//! Who steers, what the explorer did, and what the daemon said about it.

use std::collections::VecDeque;
use std::sync::Arc;

use common::{
    ChainState, ExplorerState, FocusPath, FocusStep, LeaseEvent, LeaseNotice, Notice, OrderReply,
    Presence, Role, VertexRecord,
};

use crate::imaging::film::Film;

/// Steps of the explorer that are kept: at the fastest pace, several seconds of them.
const KEPT_STEPS: usize = 10_000;

/// What is known of who steers, and of what is steered.
#[derive(Debug, Default)]
pub struct Steering {
    /// Everyone who is there.
    pub presence: Presence,
    /// What the explorer is at.
    pub explorer: ExplorerState,
    /// What the chains are at; `None` until the daemon has told.
    pub chains: Option<ChainState>,
    /// The explorer's steps.
    pub focus: Focus,
    /// The explorer's film: no part of the image.
    pub film: Film,
    /// What the daemon announced or refused last, for people.
    pub remark: Option<Result<String, String>>,
    /// Remarks that ever came: changes when there is a new one.
    pub remark_count: u64,
}

impl Steering {
    /// What this viewer may do, as far as it was told.
    pub fn role(&self, session: u64) -> Role {
        self.presence.get(session).map_or(Role::Observer, |viewer| viewer.role)
    }

    /// Takes in a notice.
    pub fn accept(&mut self, notice: Notice) {
        match notice {
            Notice::Presence(presence) => self.presence = presence,
            Notice::Explorer(state) => self.explorer = state,
            Notice::Chains(state) => {
                let news = self.chains.as_ref().is_none_or(|old| old.change != state.change);
                if news && let Some(by) = state.by.as_ref().filter(|_| !state.change.is_empty()) {
                    self.remark(Ok(format!("{}: {}", by.name, state.change)));
                }
                self.chains = Some(state);
            }
            Notice::Lease(LeaseNotice { event, by }) => {
                let by = by.map_or_else(|| "the daemon".to_owned(), |author| author.name);
                self.remark(Ok(match event {
                    LeaseEvent::Granted => "you are the driver now".to_owned(),
                    LeaseEvent::Lost => format!("{by} is the driver now"),
                    LeaseEvent::Asked => format!("{by} asks for the lease"),
                }));
            }
            Notice::Reply(OrderReply { error: Some(error), .. }) => self.remark(Err(error)),
            // What was refused before is no news any more.
            Notice::Reply(OrderReply { error: None, .. }) => {
                self.remark.take_if(|remark| remark.is_err());
            }
            // The viewer keeps these with the path that they are about.
            Notice::Detail(_) => {}
        }
    }

    /// Keeps something that people should read.
    pub fn remark(&mut self, said: Result<String, String>) {
        self.remark_count += 1;
        self.remark = Some(said);
    }
}

/// One step of the explorer with the path that it started from.
#[derive(Clone, Debug, PartialEq)]
pub struct Moment {
    /// The current path before the step.
    pub before: Arc<FocusPath>,
    /// The step.
    pub step: Arc<FocusStep>,
}

impl Moment {
    /// The proposed path; `None` for a failure.
    pub fn proposal(&self) -> Option<Vec<VertexRecord>> {
        self.step.proposal(&self.before.vertices)
    }
}

/// The last steps of the explorer.
#[derive(Debug, Default)]
pub struct Focus {
    current: Option<Arc<FocusPath>>,
    moments: VecDeque<Moment>,
    /// Number of the step that is shown; the newest without.
    pub scrub: Option<u64>,
    /// Steps that came.
    pub steps: u64,
    /// Steps that never came.
    pub missed: u64,
}

impl Focus {
    /// The explorer's current path.
    pub fn current(&self) -> Option<&Arc<FocusPath>> {
        self.current.as_ref()
    }

    /// The steps that are kept, oldest first.
    pub fn moments(&self) -> &VecDeque<Moment> {
        &self.moments
    }

    /// The step that is shown; `None` where it is not kept.
    pub fn moment(&self) -> Option<&Moment> {
        match self.scrub {
            Some(number) => self.step(number),
            None => self.moments.back(),
        }
    }

    /// The step of this number; `None` where it is not kept.
    pub fn step(&self, number: u64) -> Option<&Moment> {
        let index = self.moments.partition_point(|moment| moment.step.number < number);
        self.moments.get(index).filter(|moment| moment.step.number == number)
    }

    /// Takes in a whole path. Where it is not the one that the explorer stood at, a walk begins, and the
    /// steps of the one before are forgotten; after missed steps, it may be the same walk.
    pub fn set_path(&mut self, path: impl Into<Arc<FocusPath>>) {
        let path = path.into();
        let goes_on = match (&self.current, self.moments.back()) {
            (Some(current), _) => current.vertices == path.vertices,
            (None, Some(last)) => last.step.id.epoch == path.header.id.epoch,
            (None, None) => true,
        };
        if !goes_on {
            self.moments.clear();
        }
        if self.moments.is_empty() {
            // The timeline of another walk is at its end.
            self.scrub = None;
        }
        self.current = Some(path);
    }

    /// Takes in a step. One that does not follow what is known is left out and counted as missed.
    pub fn add_step(&mut self, step: impl Into<Arc<FocusStep>>) {
        let step = step.into();
        let next = self.current.as_ref().and_then(|path| path.after(&step));
        let Some((before, next)) = self.current.take().zip(next) else {
            self.missed += 1;
            return;
        };
        self.steps += 1;
        self.current = Some(Arc::new(next));
        self.moments.push_back(Moment { before, step });
        if self.moments.len() > KEPT_STEPS {
            self.moments.pop_front();
        }
    }

    /// Notes that steps are missing; a whole path comes next.
    pub fn miss(&mut self, steps: u64) {
        self.missed = self.missed.saturating_add(steps);
        self.current = None;
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use common::{ChainId, Event, FocusOutcome, PathId, RatioFactors, StrategyId, VertexKind};

    use super::*;

    pub(crate) fn vertex(tag: u32) -> VertexRecord {
        VertexRecord {
            position: [tag as f32, 0.0, 0.0],
            normal: [0; 2],
            kind: VertexKind::Diffuse,
            event: Event::Diffuse,
            material: 0,
            primitive: tag,
        }
    }

    pub(crate) fn step(number: u64, outcome: FocusOutcome, length: usize) -> FocusStep {
        FocusStep {
            number,
            id: PathId { chain: ChainId::EXPLORER, epoch: 1, step: number },
            fan: false,
            strategy: StrategyId(0),
            outcome,
            acceptance: 0.5,
            factors: RatioFactors::default(),
            length,
            kept_light: 1,
            kept_eye: 1,
            inserted: vec![vertex(100 + number as u32)],
            eye_side: Vec::new(),
            blocker: None,
            film: [0.25; 2],
            luminance: 1.0,
            rgb: [1.0; 3],
            rays: 2,
        }
    }

    #[test]
    fn accepted_steps_move_and_others_do_not() {
        let mut focus = Focus::default();
        focus.add_step(step(0, FocusOutcome::Accepted, 4));
        assert_eq!((focus.steps, focus.missed), (0, 1), "nothing to start from");
        let vertices = (0..4).map(vertex).collect();
        focus.set_path(FocusPath { vertices, next: 1, ..FocusPath::default() });
        focus.add_step(step(1, FocusOutcome::Rejected, 4));
        focus.add_step(FocusStep { fan: true, ..step(2, FocusOutcome::Accepted, 4) });
        let current = focus.current().expect("a path");
        assert_eq!((current.vertices.len(), current.header.dwell, current.next), (4, 1, 3));
        focus.add_step(step(3, FocusOutcome::Accepted, 4));
        let tags = |path: &FocusPath| path.vertices.iter().map(|v| v.primitive).collect::<Vec<_>>();
        assert_eq!(tags(focus.current().expect("a path")), [0, 103, 3], "it moved");
        assert_eq!(focus.moments().len(), 3, "all steps are kept");
        assert_eq!(focus.moments()[0].proposal().map(|p| p.len()), Some(3), "a ghost");
        focus.add_step(step(9, FocusOutcome::Accepted, 3));
        assert_eq!(focus.missed, 2, "a step out of turn is left out");
        assert!(focus.current().is_none(), "a whole path is waited for");
        assert_eq!(focus.moment().map(|m| m.step.number), Some(3), "the newest");
        assert_eq!(focus.step(2).map(|m| m.step.fan), Some(true), "by its number");
        focus.scrub = Some(7);
        assert_eq!(focus.moment(), None, "never came");
        focus.miss(5);
        assert_eq!(focus.missed, 7, "what is missing is counted");
    }

    #[test]
    fn another_path_begins_another_walk() {
        let path = |tag, epoch, next| FocusPath {
            header: common::PathHeader {
                id: PathId { chain: ChainId::EXPLORER, epoch, step: 0 },
                ..common::PathHeader::default()
            },
            vertices: (tag..tag + 4).map(vertex).collect(),
            next,
        };
        let mut focus = Focus::default();
        focus.set_path(path(0, 1, 1));
        focus.add_step(step(1, FocusOutcome::Rejected, 4));
        focus.set_path(path(0, 2, 2));
        assert_eq!(focus.moments().len(), 1, "other strategies, the same path");
        focus.set_path(path(50, 3, 2));
        assert!(focus.moments().is_empty(), "another seed");
        focus.add_step(FocusStep { number: 2, ..step(1, FocusOutcome::Rejected, 4) });
        focus.miss(3);
        focus.set_path(path(60, 1, 6));
        assert_eq!(focus.moments().len(), 1, "the same walk, some steps later");
        focus.miss(3);
        focus.set_path(path(70, 2, 9));
        assert!(focus.moments().is_empty(), "another walk began meanwhile");
    }

    #[test]
    fn a_step_after_which_no_number_is_left_is_refused() {
        let mut focus = Focus::default();
        let vertices = (0..4).map(vertex).collect();
        focus.set_path(FocusPath { vertices, next: u64::MAX, ..FocusPath::default() });
        let last = FocusStep { number: u64::MAX, ..step(0, FocusOutcome::Rejected, 4) };
        focus.add_step(last);
        assert_eq!((focus.steps, focus.missed), (0, 1), "left out, and counted");
    }
}
