//! Text on its way to a terminal, pipe or file that may be slow, full or gone.

use std::collections::VecDeque;
use std::io::{self, ErrorKind, Write};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// Text that may wait, in bytes. It holds some ten thousand lines of a log.
const ROOM: usize = 1 << 20;
/// How long to wait before trying again where a device is busy.
const BUSY: Duration = Duration::from_millis(10);

/// Takes whole texts, each a line as a rule, and writes them from a thread of its own.
///
/// Nobody who writes ever waits, and no failure ever comes back: what finds no room, or cannot be
/// written, is counted, and the reader is told how many there were as soon as something can be
/// written again. Clones write to the same place; the thread ends when the last of them has gone and all
/// is written.
#[derive(Clone, Debug)]
pub struct Writer(Arc<Handle>);

/// What all clones hold.
#[derive(Debug)]
struct Handle(Arc<Shared>);

impl Drop for Handle {
    fn drop(&mut self) {
        self.0.lock().closed = true;
        self.0.filled.notify_one();
    }
}

#[derive(Debug, Default)]
struct Shared {
    queue: Mutex<Queue>,
    /// Something has come.
    filled: Condvar,
    /// Everything has been written, or given up.
    emptied: Condvar,
}

#[derive(Debug, Default)]
struct Queue {
    texts: VecDeque<Vec<u8>>,
    bytes: usize,
    /// Texts for which there was no room since the thread took the last ones.
    refused: u64,
    /// All texts that never came to their place.
    lost: u64,
    /// The thread is at work on what it took.
    busy: bool,
    /// Nothing more will come, or there is no thread.
    closed: bool,
}

impl Writer {
    /// Writes to `sink`, which may block for as long as it likes.
    pub fn new(sink: impl Write + Send + 'static) -> Self {
        let shared = Arc::new(Shared::default());
        let of_thread = Arc::clone(&shared);
        let thread = thread::Builder::new().name("lvis-writer".to_owned());
        // It is never joined: it may be stuck in a write, which must not keep the program from ending.
        if thread.spawn(move || of_thread.serve(sink)).is_err() {
            shared.lock().closed = true;
        }
        Self(Arc::new(Handle(shared)))
    }

    /// Writes to standard error.
    pub fn stderr() -> Self {
        Self::standard(io::stderr())
    }

    /// Writes to standard output.
    pub fn stdout() -> Self {
        Self::standard(io::stdout())
    }

    /// By a handle of its own, where there is such a thing: a write that is stuck then holds no lock
    /// that others could want.
    #[cfg(unix)]
    fn standard(stream: impl std::os::fd::AsFd + Write + Send + 'static) -> Self {
        match stream.as_fd().try_clone_to_owned() {
            Ok(own) => Self::new(std::fs::File::from(own)),
            Err(_) => Self::new(stream),
        }
    }

    #[cfg(not(unix))]
    fn standard(stream: impl Write + Send + 'static) -> Self {
        Self::new(stream)
    }

    fn shared(&self) -> &Shared {
        &self.0.0
    }

    /// Has `text` written, or counts it as lost.
    pub fn say(&self, text: impl Into<Vec<u8>>) {
        let text = text.into();
        let mut queue = self.shared().lock();
        if queue.closed || queue.bytes + text.len() > ROOM {
            queue.refused += 1;
            queue.lost += 1;
            return;
        }
        queue.bytes += text.len();
        queue.texts.push_back(text);
        drop(queue);
        self.shared().filled.notify_one();
    }

    /// Texts that never came to their place so far.
    pub fn lost(&self) -> u64 {
        self.shared().lock().lost
    }

    /// Waits until everything is written, but no longer than `patience`; true when it is.
    pub fn settle(&self, patience: Duration) -> bool {
        let end = Instant::now() + patience;
        let mut queue = self.shared().lock();
        while queue.busy || !queue.texts.is_empty() || (queue.refused > 0 && !queue.closed) {
            let left = end.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return false;
            }
            let woken = self.shared().emptied.wait_timeout(queue, left);
            queue = woken.unwrap_or_else(PoisonError::into_inner).0;
        }
        true
    }
}

/// Each write is a text; for use by formatters.
impl Write for Writer {
    fn write(&mut self, text: &[u8]) -> io::Result<usize> {
        self.say(text);
        Ok(text.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, Queue> {
        self.queue.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Writes whatever comes, until nothing more can come.
    fn serve(&self, mut sink: impl Write) {
        // What the reader has not been told about.
        let mut untold = 0;
        let mut queue = self.lock();
        loop {
            while queue.texts.is_empty() && queue.refused == 0 {
                queue.busy = false;
                self.emptied.notify_all();
                if queue.closed {
                    return;
                }
                queue = self.filled.wait(queue).unwrap_or_else(PoisonError::into_inner);
            }
            queue.busy = true;
            queue.bytes = 0;
            let texts = std::mem::take(&mut queue.texts);
            let refused = std::mem::take(&mut queue.refused);
            drop(queue);
            let mut failed = 0;
            for text in texts {
                failed += u64::from(write(&mut sink, &text).is_err());
            }
            untold += refused + failed;
            if untold > 0 && write(&mut sink, notice(untold).as_bytes()).is_ok() {
                untold = 0;
            }
            queue = self.lock();
            queue.lost += failed;
        }
    }
}

fn notice(lost: u64) -> String {
    let lines = if lost == 1 {
        "1 line was dropped here".to_owned()
    } else {
        format!("{lost} lines were dropped here")
    };
    format!("({lines}: they were not read in time)\n")
}

/// The whole of `text`. A device that is busy, as terminals may be, is tried again.
fn write(sink: &mut impl Write, mut text: &[u8]) -> io::Result<()> {
    while !text.is_empty() {
        match sink.write(text) {
            Ok(0) => return Err(ErrorKind::WriteZero.into()),
            Ok(written) => text = &text[written..],
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) if error.kind() == ErrorKind::WouldBlock => thread::sleep(BUSY),
            Err(error) => return Err(error),
        }
    }
    sink.flush()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::mpsc::{Receiver, SyncSender, sync_channel};

    const PATIENCE: Duration = Duration::from_mins(1);

    /// A reader that reads when the test says so, and may hang up.
    struct Pipe {
        written: SyncSender<String>,
        broken: Arc<Mutex<bool>>,
    }

    impl Write for Pipe {
        fn write(&mut self, text: &[u8]) -> io::Result<usize> {
            if *self.broken.lock().expect("no panic") {
                return Err(ErrorKind::BrokenPipe.into());
            }
            let line = String::from_utf8_lossy(text).into_owned();
            self.written.send(line).map_err(|_gone| ErrorKind::BrokenPipe)?;
            Ok(text.len())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    fn pipe() -> (Writer, Receiver<String>, Arc<Mutex<bool>>) {
        let broken = Arc::new(Mutex::new(false));
        // Without room: each write waits until it is read.
        let (written, reader) = sync_channel(0);
        (Writer::new(Pipe { written, broken: Arc::clone(&broken) }), reader, broken)
    }

    fn read(reader: &Receiver<String>) -> String {
        reader.recv_timeout(PATIENCE).expect("a line in time")
    }

    #[test]
    fn who_writes_never_waits_and_the_reader_is_told_what_is_missing() {
        let (writer, reader, _) = pipe();
        writer.say("first\n");
        assert_eq!(read(&reader), "first\n");
        let line = format!("{}\n", "x".repeat(1023));
        // The thread holds what it took; at most as much again waits.
        let said = 5 * ROOM / line.len();
        for _ in 0..said {
            writer.say(line.as_bytes());
        }
        let lost = writer.lost();
        assert!(lost as usize >= said - 2 * ROOM / line.len(), "{lost} of {said}");
        assert!(!writer.settle(Duration::from_millis(10)), "nobody reads");
        let mut told = 0;
        for _ in 0..said - lost as usize {
            let text = read(&reader);
            if text != line {
                told += number(&text);
                assert_eq!(read(&reader), line);
            }
        }
        if told < lost {
            told += number(&read(&reader));
        }
        assert_eq!(told, lost, "every loss is told");
        assert!(writer.settle(PATIENCE));
        writer.say("last\n");
        assert_eq!(read(&reader), "last\n");
    }

    /// The number of lines that a notice reports.
    fn number(text: &str) -> u64 {
        let digits = text.trim_start_matches('(').split(' ').next();
        digits.and_then(|digits| digits.parse().ok()).unwrap_or_else(|| panic!("a notice: {text}"))
    }

    #[test]
    fn a_reader_that_goes_away_and_comes_back_is_told() {
        let (writer, reader, broken) = pipe();
        *broken.lock().expect("no panic") = true;
        for _ in 0..7 {
            writer.say("into the void\n");
        }
        assert!(writer.settle(PATIENCE), "failures are over at once");
        assert_eq!(writer.lost(), 7);
        *broken.lock().expect("no panic") = false;
        writer.say("back\n");
        assert_eq!(read(&reader), "back\n");
        assert_eq!(number(&read(&reader)), 7);
        drop(reader);
        writer.say("gone for good\n");
        assert!(writer.settle(PATIENCE));
        assert_eq!(writer.lost(), 8);
    }

    /// A terminal that others have set not to block.
    struct Busy(u32, SyncSender<Vec<u8>>);

    impl Write for Busy {
        fn write(&mut self, text: &[u8]) -> io::Result<usize> {
            self.0 += 1;
            match self.0 % 3 {
                0 => Err(ErrorKind::WouldBlock.into()),
                1 => Err(ErrorKind::Interrupted.into()),
                _ => {
                    let part = text.len().div_ceil(2);
                    self.1.send(text[..part].to_vec()).map_err(|_gone| ErrorKind::BrokenPipe)?;
                    Ok(part)
                }
            }
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn what_is_taken_in_parts_arrives_whole() {
        let (sender, parts) = sync_channel(64);
        let writer = Writer::new(Busy(0, sender));
        writer.say("a line in parts\n");
        assert!(writer.settle(PATIENCE));
        assert_eq!(parts.try_iter().flatten().collect::<Vec<_>>(), b"a line in parts\n");
        assert_eq!(writer.lost(), 0);
    }
}
