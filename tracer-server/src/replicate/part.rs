//! Parts of a picture as files: sums over some of its replicates, which add up to the very bits of one
//! run.
//!
//! A file is a line of magic, the length of a header and the header as JSON, then the columns of the
//! sums in little endian, and a digest of all before it.

use std::io::{self, Read, Write};

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::ledger::Columns;
use super::{Ledger, Row};

const MAGIC: &[u8; 8] = b"LVISFLM1";
/// Headers longer than this are none.
const LONGEST_HEADER: u32 = 1 << 20;
/// Pixels of the largest picture.
const MOST_PIXELS: u64 = 1 << 28;

/// What a part is of: parts add up where all of this is the same.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Origin {
    /// Version of the program.
    pub version: String,
    /// The scene's name.
    pub scene: String,
    /// Digest of the scene's content.
    pub scene_hash: String,
    /// Digest of all settings that a replicate depends on.
    pub settings_hash: String,
    /// The settings in words.
    pub settings: String,
    /// Size of the picture in pixels.
    pub size: [u32; 2],
    /// Radiance of the file's units for one film unit of the scene, as the bits of a double.
    pub radiance_scale: u64,
}

/// The header of a file.
#[derive(Debug, Serialize, Deserialize)]
struct Head {
    origin: Origin,
    /// The quantum of the sums, as the bits of a double.
    quantum: u64,
    replicates: u64,
}

/// A part of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// What it is of.
    pub origin: Origin,
    /// Its sums.
    pub ledger: Ledger,
}

/// Why a file is no part, or parts do not add up.
#[derive(Debug, Error)]
pub enum PartError {
    /// The file cannot be read or written.
    #[error(transparent)]
    File(#[from] io::Error),
    /// It cannot be written.
    #[error(transparent)]
    Place(#[from] host::file::FileError),
    /// It is something else.
    #[error("this is not a film of replicates as written by `render --film-out`")]
    Foreign,
    /// It is cut short or was changed.
    #[error("the film is damaged, because its digest does not match its content; render it again")]
    Damaged,
    /// Two parts are of different pictures.
    #[error("the parts do not belong together: {what} is {a} in one and {b} in the other")]
    Differs {
        /// What differs.
        what: &'static str,
        /// In the first.
        a: String,
        /// In the other.
        b: String,
    },
    /// A replicate is in two parts.
    #[error("replicate {0} is in two of the parts; omit one of them")]
    Twice(u64),
}

impl Origin {
    /// Nothing, where parts of both add up.
    fn differs(&self, other: &Self) -> Result<(), PartError> {
        let size = |origin: &Self| format!("{} x {}", origin.size[0], origin.size[1]);
        let pairs = [
            ("the version", self.version.clone(), other.version.clone()),
            ("the scene", self.scene.clone(), other.scene.clone()),
            ("the scene's content", self.scene_hash.clone(), other.scene_hash.clone()),
            ("the size", size(self), size(other)),
            ("the settings", self.settings.clone(), other.settings.clone()),
            ("the digest of the settings", self.settings_hash.clone(), other.settings_hash.clone()),
        ];
        match pairs.into_iter().find(|(_, a, b)| a != b) {
            Some((what, a, b)) => Err(PartError::Differs { what, a, b }),
            None => Ok(()),
        }
    }

    /// Whether a part is of this; why not otherwise.
    pub fn check(&self, part: &Part) -> Result<(), PartError> {
        self.differs(&part.origin)
    }
}

impl Part {
    /// Adds the replicates of another part.
    pub fn merge(&mut self, other: &Self) -> Result<(), PartError> {
        self.origin.check(other)?;
        if let Some(row) = other.ledger.rows().iter().find(|row| self.ledger.has(row.number)) {
            return Err(PartError::Twice(row.number));
        }
        self.ledger.merge(&other.ledger);
        Ok(())
    }

    /// Writes the file.
    pub fn write(&self, out: impl Write) -> Result<(), PartError> {
        let mut out = Digested { inner: io::BufWriter::new(out), hasher: blake3::Hasher::new() };
        let head = Head {
            origin: self.origin.clone(),
            quantum: self.ledger.quantum().to_bits(),
            replicates: self.ledger.count(),
        };
        let text = serde_json::to_vec(&head).map_err(io::Error::from)?;
        out.write_all(MAGIC)?;
        out.write_all(&(text.len() as u32).to_le_bytes())?;
        out.write_all(&text)?;
        for row in self.ledger.rows() {
            for word in row.words() {
                out.write_all(&word.to_le_bytes())?;
            }
        }
        self.ledger.write(&mut out)?;
        let digest = out.hasher.finalize();
        out.inner.write_all(digest.as_bytes())?;
        out.inner.flush()?;
        Ok(())
    }

    /// Reads a file.
    pub fn read(file: impl Read) -> Result<Self, PartError> {
        let mut file = Digested { inner: io::BufReader::new(file), hasher: blake3::Hasher::new() };
        let mut magic = [0; 8];
        file.take_exact(&mut magic)?;
        if &magic != MAGIC {
            return Err(PartError::Foreign);
        }
        let mut length = [0; 4];
        file.take_exact(&mut length)?;
        let length = u32::from_le_bytes(length);
        if length > LONGEST_HEADER {
            return Err(PartError::Damaged);
        }
        let mut text = vec![0; length as usize];
        file.take_exact(&mut text)?;
        let head: Head = serde_json::from_slice(&text).map_err(|_error| PartError::Damaged)?;
        let [width, height] = head.origin.size;
        let quantum = f64::from_bits(head.quantum);
        let pixels = u64::from(width) * u64::from(height);
        let sound = pixels <= MOST_PIXELS && head.replicates < 1 << 32 && quantum > 0.0;
        if !sound {
            return Err(PartError::Damaged);
        }
        let mut rows = Vec::new();
        for _ in 0..head.replicates {
            let mut words = [0_u64; Row::WORDS];
            for word in &mut words {
                let mut bytes = [0; 8];
                file.take_exact(&mut bytes)?;
                *word = u64::from_le_bytes(bytes);
            }
            rows.push(Row::of(words));
        }
        let columns = Columns::read(&mut file, width, height).map_err(cut_short)?;
        let expected = file.hasher.finalize();
        let mut digest = [0; 32];
        file.inner.read_exact(&mut digest).map_err(|_error| PartError::Damaged)?;
        if expected.as_bytes() != &digest || !rows.is_sorted_by(|a, b| a.number < b.number) {
            return Err(PartError::Damaged);
        }
        let ledger = Ledger::from_parts([width, height], quantum, rows, columns);
        Ok(Self { origin: head.origin, ledger })
    }
}

/// A file that ends before it should is damaged.
fn cut_short(error: io::Error) -> PartError {
    if error.kind() == io::ErrorKind::UnexpectedEof {
        PartError::Damaged
    } else {
        PartError::File(error)
    }
}

/// A file with the digest of what went through it.
struct Digested<T> {
    inner: T,
    hasher: blake3::Hasher,
}

impl<T: Write> Write for Digested<T> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.inner.write(bytes)?;
        self.hasher.update(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush()
    }
}

impl<T: Read> Digested<T> {
    /// Fills `bytes`; a file that ends before is damaged.
    fn take_exact(&mut self, bytes: &mut [u8]) -> Result<(), PartError> {
        self.inner.read_exact(bytes).map_err(cut_short)?;
        self.hasher.update(bytes);
        Ok(())
    }
}

impl<T: Read> Read for Digested<T> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let read = self.inner.read(bytes)?;
        self.hasher.update(&bytes[..read]);
        Ok(read)
    }
}
