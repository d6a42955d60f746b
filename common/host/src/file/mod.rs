//! Files that come to their place whole, or not at all.
//!
//! A file is written beside its place and renamed when all of it is on the disk, so that a full disk,
//! a failure or a kill leaves what was there before byte for byte. Where a link stands, what it
//! points to is replaced. Pipes and devices are written directly.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Cursor, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use tempfile::{NamedTempFile, TempPath};
use thiserror::Error;

/// What the name of an unfinished file begins with.
const PREFIX: &str = ".lvis-";
/// What it ends with.
const SUFFIX: &str = ".part";
/// Links that lead to links, at most.
const MOST_LINKS: usize = 40;

/// Why a file cannot be written; what was there before is as it was.
#[derive(Debug, Error)]
#[error("cannot write `{}`: {problem}", path.display())]
pub struct FileError {
    path: PathBuf,
    problem: io::Error,
}

/// The destination of a file, tested before the work starts whose result it will hold.
#[derive(Clone, Debug)]
pub struct Place {
    named: PathBuf,
    kind: Kind,
}

#[derive(Clone, Debug)]
enum Kind {
    /// A file, or nothing yet; behind all links.
    File(PathBuf),
    /// A pipe, a device or the like.
    Stream,
}

impl Place {
    /// Fails where a file cannot be written at `path`.
    pub fn find(path: &Path) -> Result<Self, FileError> {
        let kind =
            destination(path).map_err(|problem| FileError { path: path.to_owned(), problem })?;
        Ok(Self { named: path.to_owned(), kind })
    }

    /// As the user named it.
    pub fn path(&self) -> &Path {
        &self.named
    }

    /// True for what has no end and cannot be looked at again, such as a pipe.
    pub fn is_stream(&self) -> bool {
        matches!(self.kind, Kind::Stream)
    }

    /// True for a pipe or device that is this program's standard output as well.
    pub fn is_stdout(&self) -> bool {
        self.is_stream() && is_same(&self.named, Path::new("/dev/stdout"))
    }

    /// Puts there what `make` writes. When `make` fails, what was there stays.
    pub fn write<E: From<FileError>>(
        &self,
        make: impl FnOnce(&mut Output) -> Result<(), E>,
    ) -> Result<(), E> {
        let told = |problem| E::from(FileError { path: self.named.clone(), problem });
        let mut output = self.open().map_err(told)?;
        make(&mut output)?;
        self.close(output).map_err(told)
    }

    /// Puts `bytes` there.
    pub fn write_bytes(&self, bytes: &[u8]) -> Result<(), FileError> {
        self.write(|output| {
            let written = output.write_all(bytes);
            written.map_err(|problem| FileError { path: self.named.clone(), problem })
        })
    }

    fn open(&self) -> io::Result<Output> {
        Ok(Output(match &self.kind {
            Kind::File(target) => {
                let (file, unfinished) = beside(target)?.into_parts();
                Sink::Beside(BufWriter::new(file), unfinished, target.clone())
            }
            Kind::Stream => Sink::Memory(Cursor::default()),
        }))
    }

    fn close(&self, output: Output) -> io::Result<()> {
        match output.0 {
            Sink::Beside(buffer, unfinished, target) => {
                let file = buffer.into_inner().map_err(io::IntoInnerError::into_error)?;
                if let Ok(before) = fs::metadata(&target) {
                    file.set_permissions(before.permissions())?;
                }
                file.sync_all()?;
                unfinished.persist(&target).map_err(|failure| failure.error)?;
                // The content is safe by now; not every system can make the name safe, too.
                drop(File::open(folder(&target)).and_then(|folder| folder.sync_all()));
                Ok(())
            }
            Sink::Memory(bytes) => {
                let mut stream = OpenOptions::new().write(true).open(&self.named)?;
                stream.write_all(bytes.get_ref())?;
                stream.flush()
            }
        }
    }
}

/// Puts `bytes` at `path`.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    Place::find(path)?.write_bytes(bytes)
}

/// Puts `bytes` at `path`, where there must be nothing yet; only its owner may read them.
pub fn write_private(path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    let told = |problem| FileError { path: path.to_owned(), problem };
    // Such is the nature of temporary files.
    let make = || -> io::Result<()> {
        let mut file =
            tempfile::Builder::new().prefix(PREFIX).suffix(SUFFIX).tempfile_in(folder(path))?;
        file.write_all(bytes)?;
        file.as_file().sync_all()?;
        file.persist_noclobber(path)?;
        Ok(())
    };
    make().map_err(told)
}

/// A file that grows for as long as there is more to come: beside its place and in plain sight, so that
/// what there is by then is not lost whatever becomes of the rest.
#[derive(Debug)]
pub struct Growing {
    place: Place,
    unfinished: PathBuf,
    file: File,
}

impl Growing {
    /// Begins the file, called as its place and `.part`.
    pub fn begin(place: Place) -> Result<Self, FileError> {
        let mut unfinished = place.named.clone().into_os_string();
        unfinished.push(SUFFIX);
        let unfinished = PathBuf::from(unfinished);
        let file = File::create(&unfinished)
            .map_err(|problem| FileError { path: unfinished.clone(), problem })?;
        Ok(Self { place, unfinished, file })
    }

    /// Brings the file to its place: nothing more is to come.
    pub fn finish(self) -> Result<(), FileError> {
        let told = |problem| FileError { path: self.place.named.clone(), problem };
        let bytes = fs::read(&self.unfinished).map_err(told)?;
        self.place.write_bytes(&bytes)?;
        fs::remove_file(&self.unfinished).map_err(told)
    }
}

impl Write for Growing {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

/// A file that is being written.
#[derive(Debug)]
pub struct Output(Sink);

#[derive(Debug)]
enum Sink {
    /// The unfinished file, which goes when it is not renamed, and what it shall replace.
    Beside(BufWriter<File>, TempPath, PathBuf),
    /// For what cannot go back to fill in what it left out.
    Memory(Cursor<Vec<u8>>),
}

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.0 {
            Sink::Beside(file, ..) => file.write(bytes),
            Sink::Memory(memory) => memory.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match &mut self.0 {
            Sink::Beside(file, ..) => file.flush(),
            Sink::Memory(memory) => memory.flush(),
        }
    }
}

impl Seek for Output {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        match &mut self.0 {
            Sink::Beside(file, ..) => file.seek(to),
            Sink::Memory(memory) => memory.seek(to),
        }
    }
}

/// What is at `path`, after testing whether it can be written.
fn destination(path: &Path) -> io::Result<Kind> {
    match fs::metadata(path) {
        Ok(found) if found.is_dir() => Err(io::ErrorKind::IsADirectory.into()),
        Ok(found) if !found.is_file() => may_write(path).map(|()| Kind::Stream),
        found => {
            if found.is_ok() {
                // A write-protected file is respected, although a rename only depends on its folder.
                OpenOptions::new().write(true).open(path)?;
            }
            let file = behind_links(path)?;
            drop(beside(&file)?);
            Ok(Kind::File(file))
        }
    }
}

/// Opening would wait for a reader of a pipe.
#[cfg(unix)]
fn may_write(path: &Path) -> io::Result<()> {
    Ok(rustix::fs::access(path, rustix::fs::Access::WRITE_OK)?)
}

#[cfg(not(unix))]
fn may_write(_path: &Path) -> io::Result<()> {
    Ok(())
}

#[cfg(unix)]
fn is_same(a: &Path, b: &Path) -> bool {
    use std::os::unix::fs::MetadataExt as _;
    let identity = |path| fs::metadata(path).map(|found| (found.dev(), found.ino()));
    matches!((identity(a), identity(b)), (Ok(a), Ok(b)) if a == b)
}

#[cfg(not(unix))]
fn is_same(_a: &Path, _b: &Path) -> bool {
    false
}

/// What `path` leads to, whether or not it exists.
fn behind_links(path: &Path) -> io::Result<PathBuf> {
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        match fs::symlink_metadata(&path) {
            Ok(found) if found.is_symlink() => path = folder(&path).join(fs::read_link(&path)?),
            _ => return Ok(path),
        }
    }
    Err(io::Error::other("its symbolic links form a cycle"))
}

/// A new file in the folder of `file`, which goes when it is dropped.
fn beside(file: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX).suffix(SUFFIX);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        // As any file: the user's mask takes away what others shall not.
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    let folder = folder(file);
    builder.tempfile_in(folder).map_err(|error| {
        // The system's own words would name the unfinished file, which is of no use to anyone.
        let what = match error.kind() {
            io::ErrorKind::NotFound => "there is no such folder".to_owned(),
            kind => kind.to_string(),
        };
        io::Error::new(error.kind(), format!("in folder `{}`: {what}", folder.display()))
    })
}

fn folder(file: &Path) -> &Path {
    match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

#[cfg(test)]
mod tests;
