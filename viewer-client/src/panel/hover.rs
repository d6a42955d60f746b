//! What the user points at, so that the same thing is marked wherever it is shown.
//!
//! It lives for one frame: whoever is pointed at says so anew in every frame, and all others may ask. It
//! is no setting, so it needs no command.

use egui::{Context, Id};

use crate::source::steering::Moment;
use crate::world::World;

/// Something that more than one panel shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Pointed {
    /// A vertex of the selected path.
    Vertex(usize),
    /// The edge of the selected path from this vertex to its successor.
    Edge(usize),
    /// A path in the view, by its film point.
    Path([f32; 2]),
    /// A path at which a chain stayed long; the longest stay is 0.
    Stay(usize),
    /// The step of the explorer of this number.
    Step(u64),
    /// A strategy.
    Strategy(usize),
    /// A point of the film; u to the right and v downwards, both in [0, 1).
    Film([f32; 2]),
}

/// What was pointed at in the frame before, and in this one so far.
#[derive(Clone, Copy, Debug, Default)]
struct Frames {
    before: Option<Pointed>,
    now: Option<Pointed>,
}

fn id() -> Id {
    Id::unique("pointed at")
}

/// Begins a frame.
pub(super) fn begin(ctx: &Context) {
    ctx.data_mut(|data| {
        let frames: &mut Frames = data.get_temp_mut_or_default(id());
        *frames = Frames { before: frames.now, now: None };
    });
}

/// Ends a frame. Where something else is pointed at than before, the panels that were shown first do not
/// know it yet, and another frame follows.
pub(super) fn end(ctx: &Context) {
    let frames: Frames = ctx.data(|data| data.get_temp(id())).unwrap_or_default();
    if frames.before != frames.now {
        ctx.request_repaint();
    }
}

/// Says what is pointed at.
pub(super) fn point(ctx: &Context, pointed: Pointed) {
    ctx.data_mut(|data| data.get_temp_mut_or_default::<Frames>(id()).now = Some(pointed));
}

/// What is pointed at.
pub(super) fn pointed(ctx: &Context) -> Option<Pointed> {
    let frames: Frames = ctx.data(|data| data.get_temp(id()))?;
    frames.now.or(frames.before)
}

/// True when that strategy is pointed at.
pub(super) fn is_strategy(ctx: &Context, index: usize) -> bool {
    pointed(ctx) == Some(Pointed::Strategy(index))
}

/// The step of the explorer to show: the one that is pointed at, or else the one that was chosen.
pub(super) fn moment<'a>(ctx: &Context, world: &World<'a>) -> Option<&'a Moment> {
    let by_hand = match pointed(ctx) {
        Some(Pointed::Step(number)) => world.status.steering.focus.step(number),
        _ => None,
    };
    by_hand.or(world.moment)
}
