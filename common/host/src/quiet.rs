//! What libraries in other languages print to standard error, kept from it for a while.

use std::io;
#[cfg(unix)]
use std::sync::atomic::{AtomicBool, Ordering};

/// Holds back what is printed to standard error past the log, until it ends or is dropped.
///
/// Graphics drivers complain of displays that they pass over. Nobody needs to read that where all
/// goes well; where it does not, it may tell why.
#[derive(Debug)]
pub struct Quiet(Option<Diversion>);

impl Quiet {
    /// From now on. Does nothing where standard error cannot be diverted. A [`crate::log`] that has
    /// started before is not concerned.
    pub fn begin() -> Self {
        Self(Diversion::begin().ok())
    }

    /// What was printed since.
    pub fn end(mut self) -> String {
        self.0.take().and_then(|diversion| diversion.end().ok()).unwrap_or_default()
    }
}

impl Drop for Quiet {
    fn drop(&mut self) {
        // Nobody wants to know; standard error is back, or is beyond help.
        drop(self.0.take().map(Diversion::end));
    }
}

#[cfg(unix)]
#[derive(Debug)]
struct Diversion {
    usual: std::os::fd::OwnedFd,
    kept: std::fs::File,
}

/// Of two diversions at a time, the first to end would bring standard error to nobody's place.
#[cfg(unix)]
static DIVERTED: AtomicBool = AtomicBool::new(false);

#[cfg(unix)]
impl Diversion {
    fn begin() -> io::Result<Self> {
        if DIVERTED.swap(true, Ordering::AcqRel) {
            return Err(io::ErrorKind::ResourceBusy.into());
        }
        Self::divert().inspect_err(|_| DIVERTED.store(false, Ordering::Release))
    }

    fn divert() -> io::Result<Self> {
        use std::os::fd::AsFd as _;

        let usual = io::stderr().as_fd().try_clone_to_owned()?;
        let kept = tempfile::tempfile()?;
        rustix::stdio::dup2_stderr(&kept)?;
        Ok(Self { usual, kept })
    }

    fn end(mut self) -> io::Result<String> {
        use std::io::{Read as _, Seek as _, SeekFrom};

        /// Nobody reads more.
        const MOST: u64 = 64 << 10;
        rustix::stdio::dup2_stderr(&self.usual)?;
        DIVERTED.store(false, Ordering::Release);
        self.kept.seek(SeekFrom::Start(0))?;
        let mut text = Vec::new();
        self.kept.take(MOST).read_to_end(&mut text)?;
        Ok(String::from_utf8_lossy(&text).trim_end().to_owned())
    }
}

#[cfg(not(unix))]
#[derive(Debug)]
struct Diversion;

#[cfg(not(unix))]
impl Diversion {
    fn begin() -> io::Result<Self> {
        Ok(Self)
    }

    fn end(self) -> io::Result<String> {
        Ok(String::new())
    }
}

#[cfg(all(test, unix))]
mod tests {
    use std::process::{Command, Stdio};

    use super::*;

    fn print(text: &str) {
        let printed = Command::new("sh").args(["-c", &format!("echo {text} >&2")]).status();
        assert!(printed.expect("a shell").success(), "`{text}` is printed");
    }

    /// Half of the test below: standard error belongs to a whole process.
    #[test]
    #[ignore = "the other half of `what_is_printed_meanwhile_is_kept`"]
    fn the_other_half() {
        print("before");
        let quiet = Quiet::begin();
        print("meanwhile");
        let kept = quiet.end();
        print("after");
        drop(Quiet::begin());
        print("again");
        assert_eq!(kept, "meanwhile");
    }

    #[test]
    fn what_is_printed_meanwhile_is_kept() {
        let output = Command::new(std::env::current_exe().expect("this program"))
            .args(["--exact", "quiet::tests::the_other_half", "--ignored", "--nocapture"])
            .stderr(Stdio::piped())
            .output()
            .expect("a process");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stdout));
        let told = String::from_utf8_lossy(&output.stderr);
        let lines: Vec<&str> = told.lines().filter(|line| !line.is_empty()).collect();
        assert_eq!(lines, ["before", "after", "again"], "{told}");
    }
}
