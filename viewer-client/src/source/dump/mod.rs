//! Light paths written to a text file by Mitsuba 0.6's path space MLT, as its `Path` prints itself.
//!
//! [`read`] makes a [`Dump`] of such a file: the records in the order of the file, and the steps
//! of the chains, which the `#` lines of an annotated file tell, rejected ones included.
//! [`PlayableDump`] brings them into the units and the vocabulary of the viewer.

mod annotation;
mod parse;
mod playable;
mod record;
#[cfg(test)]
pub(crate) mod tests;
mod text;

use std::path::{Path, PathBuf};

use glam::DVec3;
use thiserror::Error;

use common::{Event, Rgb, VertexKind};

pub use playable::{DumpPath, PlayableDump};

/// No file is larger.
const LARGEST: u64 = 1 << 31;

/// Why a file is no dump of paths.
#[derive(Debug, Error)]
pub enum DumpError {
    /// The file cannot be read.
    #[error("cannot read {0}: {1}")]
    Unreadable(PathBuf, std::io::Error),
    /// The file is too large.
    #[error("{0} is larger than 2 GiB; split it between two records")]
    TooLarge(PathBuf),
    /// Something in a line is wrong, and no record is left without it.
    #[error("{file}, line {line}: {problem}")]
    BadLine {
        /// The file.
        file: PathBuf,
        /// Its line, counted from one.
        line: usize,
        /// What is wrong, and what should stand there.
        problem: String,
    },
    /// There is no path in it.
    #[error(
        "{0} holds no path: a record begins with a line `Path[` and ends with a line `]`, as \
         Mitsuba 0.6 prints paths; a scene is opened with `--scene`"
    )]
    Empty(PathBuf),
}

/// What is wrong in a line; the line is counted from one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Fault {
    pub(crate) line: usize,
    pub(crate) problem: String,
}

/// A vertex of a record, in the units of the file.
#[derive(Clone, Debug, PartialEq)]
pub struct DumpVertex {
    /// Where it is.
    pub position: DVec3,
    /// The geometric normal; zero where the file tells none.
    pub normal: DVec3,
    /// Heckbert's letter.
    pub kind: VertexKind,
    /// The lobe that scattered here.
    pub event: Event,
    /// The shape that it lies on, or the text in its place.
    pub shape: String,
    /// How it was made.
    pub numbers: Numbers,
}

/// What the file says about generating a vertex from either side.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Numbers {
    /// By a step from the light side.
    pub from_light: Option<Walked>,
    /// By a step from the eye side.
    pub from_eye: Option<Walked>,
}

/// The step that makes a vertex, as Mitsuba has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Walked {
    /// Its density, per area at the vertex that it makes in the units of the file; a probability
    /// where it is discrete.
    pub pdf: f64,
    /// Value over density.
    pub weight: Rgb,
    /// A mirror, glass or the lens leaves no choice of direction.
    pub is_discrete: bool,
}

/// One path, from the light to the lens.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// The line where it begins.
    pub line: usize,
    /// Its vertices, without the formal ones at the ends.
    pub vertices: Vec<DumpVertex>,
    /// Where it meets the film, in pixels to the right and downwards.
    pub pixel: [f64; 2],
}

/// What became of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// The chain begins with this path.
    Seed,
    /// The proposal is the current path now. Its acceptance probability.
    Accepted(f64),
    /// The proposal lost against this acceptance probability.
    Rejected(f64),
    /// The strategy made no proposal.
    Failed,
    /// The file has the path, and does not tell how it came about: neither chain, step nor mutation.
    Recorded,
}

impl Outcome {
    /// A word for lists.
    pub fn name(self) -> &'static str {
        match self {
            Self::Seed => "seed",
            Self::Accepted(_) => "accepted",
            Self::Rejected(_) => "rejected",
            Self::Failed => "failed",
            Self::Recorded => "recorded",
        }
    }

    /// True where the step has a record.
    pub fn has_path(self) -> bool {
        matches!(self, Self::Seed | Self::Accepted(_) | Self::Recorded)
    }
}

/// One step of a chain.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// The line that describes it.
    pub line: usize,
    /// The chain; 0 where nobody tells it, see [`Outcome::Recorded`].
    pub chain: u32,
    /// Its number in the chain; the seed is 0. Without a chain, its number in the file.
    pub number: u64,
    /// What became of it.
    pub outcome: Outcome,
    /// The name of the mutation; blank where the file tells none.
    pub mutation: String,
    /// Film point of the proposal in pixels, where there is one.
    pub pixel: Option<[f64; 2]>,
    /// The proposal's vertices as Mitsuba abbreviates them; blank where there is none.
    pub configuration: String,
    /// Index of the record that is current after the step.
    pub record: usize,
}

/// What the sensor's description says about the camera, if anything.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sensor {
    /// Full fields of view in degrees, horizontal and vertical.
    pub fov: Option<[f64; 2]>,
    /// Size of the film in pixels.
    pub film: Option<[f64; 2]>,
}

/// A file of paths.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Dump {
    /// The paths.
    pub records: Vec<Record>,
    /// The steps that made them, rejected ones included where the file is annotated.
    pub steps: Vec<Step>,
    /// The file tells what became of every step.
    pub annotated: bool,
    /// The camera.
    pub sensor: Sensor,
    /// What was left out, for people.
    pub warnings: Vec<String>,
}

/// Reads a file of paths. A record in which something is wrong is left out, and told.
pub fn read(file: &Path) -> Result<Dump, DumpError> {
    let unreadable = |error| DumpError::Unreadable(file.to_owned(), error);
    let opened = std::fs::File::open(file).map_err(unreadable)?;
    if opened.metadata().map_err(unreadable)?.len() > LARGEST {
        return Err(DumpError::TooLarge(file.to_owned()));
    }
    let mut parser = parse::Parser::default();
    let mut lines = text::Lines::new(opened).map_err(unreadable)?;
    while let Some(line) = lines.next().map_err(unreadable)? {
        parser.line(&line);
    }
    let (dump, fault) = parser.finish();
    let file = file.to_owned();
    match fault {
        _ if !dump.records.is_empty() => Ok(dump),
        Some(Fault { line, problem }) => Err(DumpError::BadLine { file, line, problem }),
        None => Err(DumpError::Empty(file)),
    }
}
