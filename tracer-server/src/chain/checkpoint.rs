//! The state of a chain, small enough to keep many of them, from which it goes on exactly.

use common::{ChainId, PathId, StrategyId};
use glam::DVec2;

use super::{Chain, Kernel};
use crate::math::Rng;
use crate::path::{Failure, Path, Vertex};
use crate::scene::Tracer;

/// A chain as it was after some step: its path by the vertices alone, since all else follows from
/// them, and its random stream.
#[derive(Clone, Debug)]
pub struct Checkpoint {
    chain: ChainId,
    epoch: u32,
    steps: u64,
    arrival: (u64, f64, StrategyId),
    vertices: Box<[Vertex]>,
    film: DVec2,
    rng: Rng,
    displacements: u64,
}

impl Checkpoint {
    /// The name of the chain's path.
    pub fn id(&self) -> PathId {
        PathId { chain: self.chain, epoch: self.epoch, step: self.arrival.0 }
    }

    /// Epoch and steps taken in it: grows along a chain.
    pub fn time(&self) -> (u32, u64) {
        (self.epoch, self.steps)
    }

    /// Bytes that it holds.
    pub fn byte_len(&self) -> usize {
        size_of::<Self>() + size_of_val(&*self.vertices)
    }
}

impl Chain {
    /// The state after the last step.
    pub fn checkpoint(&self) -> Checkpoint {
        Checkpoint {
            chain: self.id,
            epoch: self.epoch,
            steps: self.steps,
            arrival: self.arrival,
            vertices: self.current.vertices().into(),
            film: self.current.film(),
            rng: self.rng.clone(),
            displacements: self.draft.displacements,
        }
    }

    /// The chain that goes on from `checkpoint` as the first one did, given the same `kernel`. Its
    /// counts begin anew.
    pub fn resume(
        scene: &Tracer<'_>,
        checkpoint: &Checkpoint,
        kernel: &Kernel,
    ) -> Result<Self, Failure> {
        let path = Path::rebuild(scene, &checkpoint.vertices, checkpoint.film)?;
        let mut chain = Self::with_stream(checkpoint.chain, checkpoint.rng.clone(), path, kernel);
        chain.epoch = checkpoint.epoch;
        chain.steps = checkpoint.steps;
        chain.arrival = checkpoint.arrival;
        chain.draft.displacements = checkpoint.displacements;
        Ok(chain)
    }
}
