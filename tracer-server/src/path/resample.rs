//! Replacing a range of a path by two random walks and one connection.

use glam::{DVec2, DVec3};

use super::walk::{CameraSample, emit, light_vertex, scatter, walk};
use super::{Cut, Failure, Numbers, Path, Splice, Strand, Vertex, Vertices};
use crate::scene::Tracer;

/// Which vertices are deleted and how many are made from each side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Range {
    /// What is kept.
    pub cut: Cut,
    /// Vertices to make by a walk from the light side.
    pub from_light: usize,
    /// Vertices to make by a walk from the eye side, a new lens point included.
    pub from_eye: usize,
}

impl Range {
    /// Everything of a path of `edges` edges is replaced, by one with `light` vertices made from the
    /// light and `eye` made from the eye; a lens that has an area gets a new point too.
    pub fn whole(edges: usize, light: usize, eye: usize, aperture: bool) -> Self {
        let lens = usize::from(aperture);
        let cut = Cut { light: 0, eye_from: edges + lens };
        Self { cut, from_light: light, from_eye: eye + lens }
    }
}

/// Room for the vertices of a proposal, so that a step allocates nothing.
#[derive(Clone, Debug, Default)]
pub struct Draft {
    /// Vertices of a walk from the light side.
    pub light: Vertices,
    /// Vertices of a walk from the eye side.
    pub eye: Vertices,
    /// What is kept, once it is chosen: a failed proposal meant to replace the rest.
    pub cut: Option<Cut>,
    /// Film displacements used so far by strategies that spread them evenly: a chain's own count.
    pub displacements: u64,
}

impl Draft {
    /// Empties both sides for vertices that will replace what lies between; the count goes on.
    pub fn open(&mut self, cut: Cut) {
        self.cut = Some(cut);
        self.light.clear();
        self.eye.clear();
    }
}

/// Makes `y` of `x` with `range` replaced by two fresh walks of exactly the wanted lengths, joined
/// by an explicit connection; or by one walk from the eye that must end on a light.
pub fn resample(
    scene: &Tracer<'_>,
    x: &Path,
    range: Range,
    numbers: &mut impl Numbers,
    draft: &mut Draft,
    y: &mut Path,
) -> Result<(), Failure> {
    draft.open(range.cut);
    let Draft { light, eye, .. } = draft;
    walk_from_light(scene, x, range, numbers, light)?;
    let film = walk_from_eye(scene, x, range, numbers, eye)?;
    join(scene, x, range, film, draft, y)
}

/// Makes `y` of what is kept of `x` and of the two walks in `draft`.
fn join(
    scene: &Tracer<'_>,
    x: &Path,
    range: Range,
    film: Option<DVec2>,
    draft: &mut Draft,
    y: &mut Path,
) -> Result<(), Failure> {
    let connected = range.cut.light + range.from_light > 0;
    if connected {
        let starts_on_light = range.cut.light == 0 && draft.light.len() == 1;
        if let Some(end) = draft.light.last_mut().filter(|_| !starts_on_light) {
            open_for_connection(scene, end)?;
        }
        if let Some(end) = draft.eye.last_mut().filter(|v| !v.is_lens()) {
            open_for_connection(scene, end)?;
        }
    } else {
        let end = draft.eye.last_mut().ok_or(Failure::NoSubpath)?;
        end_on_light(scene, end)?;
    }
    let splice = Splice { base: x, cut: range.cut, light: &draft.light, eye: &draft.eye, film };
    y.connect(scene, &splice)
}

/// Lets the end of a walk take part in an explicit connection.
#[inline]
pub fn open_for_connection(scene: &Tracer<'_>, end: &mut Vertex) -> Result<(), Failure> {
    if end.is_lamp() {
        return Err(Failure::LeftScene);
    }
    let event = scene.bsdf(end.material).connectable().ok_or(Failure::SpecularConnection)?;
    end.set_event(event);
    Ok(())
}

/// Declares that a path from the eye ends on the light it has hit.
#[inline]
pub fn end_on_light(scene: &Tracer<'_>, end: &mut Vertex) -> Result<(), Failure> {
    if end.is_lamp() {
        return Ok(());
    }
    if end.is_lens() || !scene.is_light(end.primitive) {
        return Err(Failure::NoLightHit);
    }
    end.set_light();
    Ok(())
}

/// Draws a direction away from a kept vertex, which must do what it did: a coat that mirrors where it
/// scattered before would make another path of what is kept.
#[inline]
fn leave(
    scene: &Tracer<'_>,
    kept: &mut Vertex,
    back: DVec3,
    u: [f64; 3],
) -> Result<DVec3, Failure> {
    let event = kept.event;
    let onward = scatter(scene, kept, back, u)?;
    if kept.event == event { Ok(onward) } else { Err(Failure::KindChanged) }
}

fn walk_from_light(
    scene: &Tracer<'_>,
    x: &Path,
    range: Range,
    numbers: &mut impl Numbers,
    out: &mut Vertices,
) -> Result<(), Failure> {
    if range.from_light == 0 {
        return Ok(());
    }
    let mut count = range.from_light;
    let (start, direction) = match range.cut.light {
        0 => {
            let start = light_vertex(scene, numbers.row(Strand::Light, 0));
            out.push(start);
            count -= 1;
            if count == 0 {
                return Ok(());
            }
            emit(scene, &start, numbers.row(Strand::Light, 1))
        }
        1 => emit(scene, &x.vertices()[0], numbers.row(Strand::Light, 1)),
        kept => {
            let mut start = x.vertices()[kept - 1];
            let back = -x.edges()[kept - 2].direction;
            let row = numbers.row(Strand::Light, kept);
            let direction = leave(scene, &mut start, back, row)?;
            (start, direction)
        }
    };
    let kept = range.cut.light.max(1) - 1;
    let scattering = |j| numbers.row(Strand::Light, Strand::Light.scattering_row(kept + j));
    walk(scene, &start, direction, count, scattering, out)
}

/// Returns the film point, if the walk starts at the lens and draws one.
fn walk_from_eye(
    scene: &Tracer<'_>,
    x: &Path,
    range: Range,
    numbers: &mut impl Numbers,
    out: &mut Vertices,
) -> Result<Option<DVec2>, Failure> {
    if range.from_eye == 0 {
        return Ok(None);
    }
    let mut count = range.from_eye;
    let aim = if range.cut.eye_from > x.edge_count() {
        // Without a walk the film point is not used: the connection tells it.
        let aim = CameraSample::from_numbers(scene, numbers);
        out.push(aim.lens);
        count -= 1;
        if count == 0 {
            return Ok(None);
        }
        Some(aim)
    } else if x.vertices()[range.cut.eye_from].is_lens() {
        let film = DVec2::from(numbers.row(Strand::Eye, 0));
        Some(CameraSample { film, lens: x.vertices()[range.cut.eye_from] })
    } else {
        None
    };
    // Vertices kept behind the lens, which is number zero of the walk.
    let kept = x.edge_count().saturating_sub(range.cut.eye_from);
    let (start, direction) = if let Some(aim) = &aim {
        (aim.lens, aim.direction(scene))
    } else {
        let mut start = x.vertices()[range.cut.eye_from];
        let back = x.edges()[range.cut.eye_from].direction;
        let onward = leave(scene, &mut start, back, numbers.row(Strand::Eye, kept))?;
        (start, onward)
    };
    let scattering = |j| numbers.row(Strand::Eye, Strand::Eye.scattering_row(kept + j));
    walk(scene, &start, direction, count, scattering, out)?;
    Ok(aim.map(|aim| aim.film))
}
