//! Strategies with one error each, of the kinds that are easily made. The laws must find them all.

use glam::DVec2;

use super::caustic::chain_pdf;
use super::primary::Recorded;
use super::retrace::{LensWalk, displace, from_lens, walk_pdf};
use super::{
    Bidirectional, CausticPerturbation, Ends, Fresh, Independent, LensPerturbation, LensSubpath,
    MultiChain, Mutation, Primary, Proposal, Sizes, propose,
};
use crate::math::{Rng, TorusStep};
use crate::path::{Draft, Failure, Kept, Path, Strand, Tape};
use crate::scene::Tracer;
use crate::verify::invariance::Propose;

/// A strategy that is wrong in one place.
pub(super) struct Mutant<'a> {
    pub(super) name: &'static str,
    pub(super) propose: Box<Propose<'a>>,
    /// The error concerns paths that are seen through glass.
    pub(super) needs_glass: bool,
}

/// The arguments of a proposal, which every mutant passes on.
type Args<'a, 'b, 's> = (&'a Tracer<'s>, &'a Path, &'b mut Rng, &'b mut Draft, &'b mut Path);

fn mutant<'a>(
    name: &'static str,
    wrong: impl for<'x, 'y, 's> Fn(Args<'x, 'y, 's>) -> Result<Proposal, Failure> + Sync + 'a,
) -> Mutant<'a> {
    Mutant {
        name,
        propose: Box::new(move |scene, x, rng, draft, y| wrong((scene, x, rng, draft, y))),
        needs_glass: false,
    }
}

/// Draws a move rightly and judges it by another transition function.
fn misjudged<M: Mutation>(
    mutation: &M,
    (scene, x, rng, draft, y): Args<'_, '_, '_>,
    transition: impl Fn(&Path, &Path, M::Move) -> f64,
) -> Result<Proposal, Failure> {
    if !mutation.applicable(x) {
        return Err(Failure::NoSubpath);
    }
    let via = mutation.propose(scene, x, rng, draft, y)?;
    let ratio = transition(y, x, mutation.reverse(via)) / transition(x, y, via);
    Ok(Proposal { ratio, forward: 1.0, backward: ratio, kept: Kept { light: 0, eye: 1 } })
}

/// Draws again until a proposal comes about.
fn redrawn<M: Mutation>(
    mutation: &M,
    (scene, x, rng, draft, y): Args<'_, '_, '_>,
) -> Result<Proposal, Failure> {
    if !mutation.applicable(x) {
        return Err(Failure::NoSubpath);
    }
    let mut last = Err(Failure::NoSubpath);
    for _ in 0..1000 {
        last = propose(mutation, scene, x, rng, draft, y);
        if last.is_ok() {
            break;
        }
    }
    last
}

pub(super) fn of_bidirectional<'a>(right: Bidirectional) -> Vec<Mutant<'a>> {
    /// The product of the vertices' luminances instead of the luminance of their product.
    fn scalar_luminance(y: &Path) -> f64 {
        (1..y.edge_count()).map(|j| y.scattering(j).color.luminance()).product::<f64>()
    }
    vec![
        mutant("bidirectional: the choice of the range is not reversed", move |args| {
            misjudged(&right, args, |_, y, via: Ends| {
                y.reciprocal_sum(via.kept_light, via.to) / via.added() as f64
            })
        }),
        mutant("bidirectional: not summed over the sides", move |args| {
            misjudged(&right, args, |x, y, via: Ends| {
                let light = (via.kept_light + via.from_light).min(via.to);
                right.selection(x, via) * y.reciprocal(light)
            })
        }),
        mutant("bidirectional: luminance of factors", move |args| {
            misjudged(&right, args, |x, y, via: Ends| {
                right.transition(x, y, via) * y.luminance() / scalar_luminance(y)
            })
        }),
        mutant("bidirectional: drawn again after a failure", move |args| redrawn(&right, args)),
    ]
}

pub(super) fn of_independent(right: &Independent) -> Vec<Mutant<'_>> {
    vec![
        mutant("independent: the length's probability is missing", move |args| {
            misjudged(right, args, |_, y, ()| y.density_sum() / (y.edge_count() + 1) as f64)
        }),
        mutant("independent: only one split counted", move |args| {
            misjudged(right, args, |x, y, ()| {
                right.transition(x, y, ()) * y.reciprocal(1) / y.density_sum()
            })
        }),
        mutant("independent: the number of splits is missing", move |args| {
            misjudged(right, args, |x, y, ()| {
                right.transition(x, y, ()) * (y.edge_count() + 1) as f64
            })
        }),
    ]
}

pub(super) fn of_lens<'a>(right: LensPerturbation) -> Vec<Mutant<'a>> {
    /// Film area per unit area at the first diffuse vertex: the Jacobian that film measure has
    /// made superfluous.
    fn film_per_area(y: &Path, d: usize) -> f64 {
        let (k, v) = (y.edge_count(), y.vertices());
        let distance_squared =
            (d..k).map(|j| (v[j + 1].position - v[j].position).length()).sum::<f64>().powi(2);
        let cosine = v[k].normal.dot(-y.edges()[k - 1].direction);
        v[d].normal.dot(y.edges()[d].direction).abs() / (distance_squared * cosine.powi(3))
    }
    fn step(right: LensPerturbation, scene: &Tracer<'_>, x: &Path, rng: &mut Rng) -> DVec2 {
        displace(scene.camera(), x.film(), right.radius.draw(rng), rng)
    }
    fn through(
        film: DVec2,
        (scene, x, _, draft, y): Args<'_, '_, '_>,
        right: LensPerturbation,
    ) -> Result<Proposal, Failure> {
        if !right.applicable(x) {
            return Err(Failure::NoSubpath);
        }
        let d = x.first_diffuse_from_eye();
        from_lens(scene, x, LensWalk { film, end: d }, draft, y, |direction| direction)?;
        let ratio = right.transition(y, x, d) / right.transition(x, y, d);
        Ok(Proposal { ratio, forward: 1.0, backward: ratio, kept: Kept { light: d, eye: 1 } })
    }
    let mut events = mutant("lens: event probabilities divided out", move |args| {
        misjudged(&right, args, |x, y, d| right.transition(x, y, d) * walk_pdf(y, d))
    });
    events.needs_glass = true;
    vec![
        mutant("lens: ratio in area measure", move |args| {
            misjudged(&right, args, |x, y, d| right.transition(x, y, d) / film_per_area(y, d))
        }),
        mutant("lens: film point clamped to the border", move |(scene, x, rng, draft, y)| {
            let film = step(right, scene, x, rng);
            let inside = film.clamp(DVec2::ZERO, DVec2::splat(1.0 - 1e-9));
            through(inside, (scene, x, rng, draft, y), right)
        }),
        mutant("lens: drawn again off the film", move |(scene, x, rng, draft, y)| {
            let mut film = step(right, scene, x, rng);
            while film.min_element() < 0.0 || film.max_element() >= 1.0 {
                film = step(right, scene, x, rng);
            }
            through(film, (scene, x, rng, draft, y), right)
        }),
        mutant("lens: drawn again after a failure", move |args| redrawn(&right, args)),
        events,
    ]
}

pub(super) fn of_lens_subpath<'a>(right: LensSubpath) -> Vec<Mutant<'a>> {
    /// Solid angle per film area at the lens, up to a constant.
    fn solid_angle_per_film(y: &Path) -> f64 {
        let k = y.edge_count();
        (-y.vertices()[k].normal.dot(y.edges()[k - 1].direction)).powi(3)
    }
    vec![
        mutant("lens subpath: event probabilities not divided out", move |args| {
            misjudged(&right, args, |x, y, via: Fresh| {
                right.transition(x, y, via) / walk_pdf(y, via.diffuse)
            })
        }),
        mutant("lens subpath: in solid angle at the lens", move |args| {
            misjudged(&right, args, |x, y, d| right.transition(x, y, d) * solid_angle_per_film(y))
        }),
    ]
}

/// Concerns surfaces that may mirror or scatter.
pub(super) fn of_lens_subpath_on_coats<'a>(right: LensSubpath) -> Mutant<'a> {
    mutant("lens subpath: the probability of stopping is missing", move |args| {
        misjudged(&right, args, |_, y, via: Fresh| y.reciprocal(via.diffuse))
    })
}

pub(super) fn of_caustic<'a>(right: CausticPerturbation) -> Vec<Mutant<'a>> {
    /// Cosine at the vertex whose direction is turned.
    fn start_cosine(y: &Path, start: usize) -> f64 {
        y.vertices()[start].normal.dot(y.edges()[start].direction).abs()
    }
    let wide = CausticPerturbation { radius: Sizes { max: 60.0, ..right.radius }, ..right };
    vec![
        mutant("caustic: no test of the range", move |args| {
            misjudged(&right, args, |x, y, via| {
                let k = y.edge_count();
                y.reciprocal(k) / (chain_pdf(y, via.start) * right.angles(x, via.start).span())
            })
        }),
        mutant("caustic: projected solid angle", move |args| {
            misjudged(&wide, args, |x, y, via| {
                wide.transition(x, y, via) * start_cosine(y, via.start)
            })
        }),
        mutant("caustic: drawn again after a failure", move |args| redrawn(&right, args)),
    ]
}

pub(super) fn of_multi_chain<'a>(right: MultiChain) -> Vec<Mutant<'a>> {
    /// Product of the cosines at the starts of the chains after the first.
    fn inner_cosines(y: &Path, end: usize) -> f64 {
        let starts = (end + 1..y.edge_count()).filter(|&j| y.is_connectable(j));
        let cosine = |j: usize| y.vertices()[j].normal.dot(y.edges()[j - 1].direction).abs();
        starts.map(cosine).product()
    }
    /// Probability of the events along all chains.
    fn events(y: &Path, end: usize) -> f64 {
        let specular = (end + 1..y.edge_count()).filter(|&j| !y.is_connectable(j));
        specular.map(|j| y.scattering(j).eye_pdf).product()
    }
    let mut divided = mutant("multi-chain: event probabilities divided out", move |args| {
        misjudged(&right, args, |x, y, end| right.transition(x, y, end) * events(y, end))
    });
    divided.needs_glass = true;
    vec![
        divided,
        mutant("multi-chain: inner cosine missing", move |args| {
            misjudged(&right, args, |x, y, end| right.transition(x, y, end) * inner_cosines(y, end))
        }),
        mutant("multi-chain: drawn again after a failure", move |args| redrawn(&right, args)),
    ]
}

pub(super) fn of_primary<'a>(right: Primary) -> Vec<Mutant<'a>> {
    /// Proposes with a tape that was spoilt.
    fn spoilt(
        right: Primary,
        (scene, x, rng, draft, y): Args<'_, '_, '_>,
        spoil: impl Fn(&Path, &mut Tape),
    ) -> Result<Proposal, Failure> {
        let light = Primary::choose_split(x, rng);
        let mut tape = Tape::default();
        tape.record(scene, x, light, rng).ok_or(Failure::NoSubpath)?;
        spoil(x, &mut tape);
        let recorded = Recorded { path: x, light, tape: &tape };
        right.rebuild(scene, recorded, rng, draft, y)?;
        let (forward, backward) = (1.0 / x.density_sum(), 1.0 / y.density_sum());
        Ok(Proposal {
            ratio: backward / forward,
            forward,
            backward,
            kept: Kept { light: 0, eye: 1 },
        })
    }
    let mut event = mutant("primary: the choice of the event is not inverted", move |args| {
        spoilt(right, args, |x, tape| {
            for (strand, row, numbers) in tape.rows_mut() {
                let specular =
                    strand == Strand::Eye && row > 0 && !x.is_connectable(x.edge_count() - row);
                numbers[0] = if specular { 0.0 } else { numbers[0] };
            }
        })
    });
    event.needs_glass = true;
    // Long steps fail more often where the picture is busy.
    let long = Primary { step: TorusStep::new(0.02, 0.3), ..right };
    let mut again =
        mutant("primary: drawn again after a failure", move |args| redrawn(&long, args));
    again.needs_glass = true;
    vec![
        mutant("primary: ratio upside down", move |args| {
            misjudged(&right, args, |x, _, _| x.density_sum())
        }),
        mutant("primary: the ratio of one split", move |args| {
            misjudged(&right, args, |x, _, light| 1.0 / x.reciprocal(light))
        }),
        mutant("primary: every split as likely as any other", move |(scene, x, rng, draft, y)| {
            let splits = (0..=x.edge_count()).filter(|&light| x.reciprocal(light) > 0.0);
            let nth = rng.below(splits.clone().count());
            let light = splits.clone().nth(nth).ok_or(Failure::NoSubpath)?;
            let mut tape = Tape::default();
            tape.record(scene, x, light, rng).ok_or(Failure::NoSubpath)?;
            let recorded = Recorded { path: x, light, tape: &tape };
            right.rebuild(scene, recorded, rng, draft, y)?;
            let (forward, backward) = (1.0 / x.density_sum(), 1.0 / y.density_sum());
            Ok(Proposal {
                ratio: backward / forward,
                forward,
                backward,
                kept: Kept { light: 0, eye: 1 },
            })
        }),
        mutant("primary: a direction is not inverted", move |args| {
            spoilt(right, args, |_, tape| {
                tape.rows_mut().filter(|(_, row, _)| *row == 1).for_each(|(.., u)| u[1] = 0.5);
            })
        }),
        event,
        again,
    ]
}
