//! What was shown of the chains lately: enough to make every path of it again, exactly.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use common::{ChainId, PathId};
use thiserror::Error;

use super::{Chain, Checkpoint, Kernel, LongestStay};
use crate::film::Film;
use crate::path::Path;
use crate::scene::Tracer;

/// The chains as they were when a window on them was opened.
#[derive(Debug)]
pub struct Round {
    /// The strategies and the target of that time.
    pub kernel: Arc<Kernel>,
    /// Mean luminance of the image, in the file's units.
    pub normalization: f64,
    /// Steps that were shown of every chain.
    pub window: u64,
    /// Their states, in the order of their ids.
    checkpoints: Vec<Checkpoint>,
}

/// Why a path cannot be made again.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum Gone {
    /// The chains have not started, or nobody watched them.
    #[error("no path has been shown yet; watch the chains for a moment and try again")]
    Empty,
    /// It was shown too long ago, or never.
    #[error(
        "the path {0} is no longer stored: the daemon keeps recently shown paths, from step {1} \
        of epoch {2} on; pick a newer one"
    )]
    TooOld(PathId, u64, u32),
    /// Its time is kept, but it was not shown then.
    #[error("there is no path {0}: that step was not shown, or not accepted")]
    Unknown(PathId),
}

/// Stays that are kept: many times as many as are told of at once.
const MOST_STAYS: usize = 64;

/// Rounds within a budget of bytes, oldest first.
///
/// The thread of the chains puts rounds in, and readers hold the lock for one look-up only.
#[derive(Debug)]
pub struct Archive {
    limit: usize,
    shelf: Mutex<Shelf>,
}

#[derive(Debug, Default)]
struct Shelf {
    rounds: VecDeque<Arc<Round>>,
    bytes: usize,
    /// The longest stays that were told of, the newest last, whether or not they were shown.
    stays: VecDeque<LongestStay>,
}

impl Round {
    /// A round of chains that are shown for `window` steps from these `checkpoints` on.
    pub fn new(
        kernel: Arc<Kernel>,
        normalization: f64,
        window: u64,
        mut checkpoints: Vec<Checkpoint>,
    ) -> Self {
        checkpoints.sort_by_key(|checkpoint| checkpoint.id().chain);
        Self { kernel, normalization, window, checkpoints }
    }

    fn of(&self, chain: ChainId) -> Option<&Checkpoint> {
        let found = self.checkpoints.binary_search_by_key(&chain, |c| c.id().chain);
        self.checkpoints.get(found.ok()?)
    }

    fn byte_len(&self) -> usize {
        self.checkpoints.iter().map(Checkpoint::byte_len).sum()
    }

    /// The path of that name, where the chain had it in this round. The steps are splatted on `film`.
    fn replay(&self, scene: &Tracer<'_>, id: PathId, film: &mut Film) -> Option<Path> {
        let checkpoint = self.of(id.chain)?;
        let mut chain = Chain::resume(scene, checkpoint, &self.kernel).ok()?;
        let (epoch, steps) = checkpoint.time();
        if id.step > steps && epoch == id.epoch {
            for _ in 0..(id.step - steps).min(self.window) {
                chain.step(scene, &self.kernel, film);
            }
        }
        (chain.header().id == id).then(|| chain.current().clone())
    }
}

impl Archive {
    /// An empty archive of at most about `limit` bytes.
    pub fn new(limit: usize) -> Self {
        Self { limit, shelf: Mutex::default() }
    }

    /// Puts in a round; the oldest ones make room.
    pub fn put(&self, round: Round) {
        if round.checkpoints.is_empty() {
            return;
        }
        let mut shelf = self.shelf();
        shelf.bytes += round.byte_len();
        shelf.rounds.push_back(Arc::new(round));
        while shelf.bytes > self.limit && shelf.rounds.len() > 1 {
            let Some(oldest) = shelf.rounds.pop_front() else { break };
            shelf.bytes -= oldest.byte_len();
        }
    }

    /// Keeps the paths at which chains stayed longest, which may never have been shown.
    pub fn keep(&self, stays: Vec<LongestStay>) {
        let mut shelf = self.shelf();
        for stay in stays {
            shelf.stays.retain(|kept| kept.header.id != stay.header.id);
            shelf.stays.push_back(stay);
        }
        let surplus = shelf.stays.len().saturating_sub(MOST_STAYS);
        shelf.stays.drain(..surplus);
    }

    /// The newest round.
    pub fn newest(&self) -> Option<Arc<Round>> {
        self.shelf().rounds.back().cloned()
    }

    /// The name of a path that was shown in the newest round.
    pub fn newest_path(&self) -> Option<PathId> {
        Some(self.newest()?.checkpoints.first()?.id())
    }

    /// Makes the path of that name again: the very same, bit by bit. `film` is scratch.
    pub fn path(
        &self,
        scene: &Tracer<'_>,
        id: PathId,
        film: &mut Film,
    ) -> Result<(Path, Arc<Round>), Gone> {
        if let Some((stay, round)) = self.shelf().stay(id)
            && let Ok(path) = Path::rebuild(scene, &stay.vertices, stay.film)
        {
            return Ok((path, round));
        }
        let rounds = self.shelf().around(id)?;
        let found = rounds.into_iter().find_map(|round| {
            let path = round.replay(scene, id, film)?;
            Some((path, round))
        });
        found.ok_or(Gone::Unknown(id))
    }

    fn shelf(&self) -> MutexGuard<'_, Shelf> {
        self.shelf.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Shelf {
    /// The long stay at a path, with the newest round.
    fn stay(&self, id: PathId) -> Option<(LongestStay, Arc<Round>)> {
        let stay = self.stays.iter().find(|stay| stay.header.id == id)?;
        Some((stay.clone(), Arc::clone(self.rounds.back()?)))
    }

    /// The rounds in which the path may have been shown: the last one that began before its step, in
    /// whose window it may have come, and the next one, which may have found the chain there.
    fn around(&self, id: PathId) -> Result<Vec<Arc<Round>>, Gone> {
        let oldest = self.rounds.front().ok_or(Gone::Empty)?;
        let first = oldest.of(id.chain).ok_or(Gone::Unknown(id))?;
        let (epoch, steps) = first.time();
        if (id.epoch, id.step) < (epoch, first.id().step) {
            return Err(Gone::TooOld(id, steps, epoch));
        }
        let wanted = (id.epoch, id.step);
        let began = |round: &Arc<Round>| round.of(id.chain).is_some_and(|c| c.time() < wanted);
        let next = self.rounds.partition_point(began);
        let range = next.saturating_sub(1)..(next + 1).min(self.rounds.len());
        Ok(self.rounds.range(range).cloned().collect())
    }
}
