//! Signals that ask a program to end.

use std::io;

/// What a program is asked to end by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// Ctrl-C.
    Interrupt,
    /// What `kill` sends.
    Terminate,
    /// The terminal is gone.
    Hangup,
}

impl Ending {
    /// The exit code of a program that ends before its work is done: 128 and the signal's number, as
    /// shells have it.
    pub fn exit_code(self) -> u8 {
        match self {
            Self::Hangup => 128 + 1,
            Self::Interrupt => 128 + 2,
            Self::Terminate => 128 + 15,
        }
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Interrupt => "Ctrl-C",
            Self::Terminate => "SIGTERM",
            Self::Hangup => "SIGHUP",
        }
    }
}

/// Hears signals from the moment that it is made; they then end nothing by themselves.
#[derive(Debug)]
pub struct Endings {
    #[cfg(unix)]
    interrupt: tokio::signal::unix::Signal,
    #[cfg(unix)]
    terminate: tokio::signal::unix::Signal,
    /// None if the program was started with the loss of its terminal ignored, as `nohup` does.
    #[cfg(unix)]
    hangup: Option<tokio::signal::unix::Signal>,
}

#[cfg(unix)]
impl Endings {
    /// Begins to hear.
    ///
    /// # Panics
    ///
    /// Outside of a tokio runtime with signals.
    pub fn listen() -> io::Result<Self> {
        use tokio::signal::unix::{SignalKind, signal};

        let hangup = (!hangup_is_ignored()).then(|| signal(SignalKind::hangup()));
        Ok(Self {
            interrupt: signal(SignalKind::interrupt())?,
            terminate: signal(SignalKind::terminate())?,
            hangup: hangup.transpose()?,
        })
    }

    /// The next one.
    pub async fn next(&mut self) -> Ending {
        let hangup = async {
            match &mut self.hangup {
                Some(hangup) => hangup.recv().await,
                None => std::future::pending().await,
            }
        };
        tokio::select! {
            _ = self.interrupt.recv() => Ending::Interrupt,
            _ = self.terminate.recv() => Ending::Terminate,
            _ = hangup => Ending::Hangup,
        }
    }
}

#[cfg(not(unix))]
impl Endings {
    /// Begins to hear.
    pub fn listen() -> io::Result<Self> {
        Ok(Self {})
    }

    /// The next one.
    pub async fn next(&mut self) -> Ending {
        if tokio::signal::ctrl_c().await.is_err() {
            // Without signals only the program itself can end.
            std::future::pending::<()>().await;
        }
        Ending::Interrupt
    }
}

/// True when the program was started with SIGHUP ignored, which must be asked before it is caught.
#[cfg(unix)]
fn hangup_is_ignored() -> bool {
    match std::fs::read_to_string("/proc/self/status") {
        Ok(status) => ignores_hangup(&status),
        Err(_) => shell_ignores_hangup(),
    }
}

/// From what Linux reports about a process: a mask of the signals that it ignores, lowest bit
/// first.
#[cfg(unix)]
fn ignores_hangup(status: &str) -> bool {
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|digits| u64::from_str_radix(digits.trim(), 16).ok());
    mask.is_some_and(|mask| mask & 1 == 1)
}

/// By a child, which inherits what is ignored, that tries it on itself.
#[cfg(unix)]
fn shell_ignores_hangup() -> bool {
    let tried = std::process::Command::new("sh").args(["-c", "kill -s HUP $$"]).status();
    tried.is_ok_and(|status| status.success())
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn what_is_ignored_is_known_in_two_ways() {
        assert_eq!(hangup_is_ignored(), shell_ignores_hangup());
        let status = |mask| format!("Name:\tx\nSigBlk:\t0000000000000001\nSigIgn:\t{mask}\n");
        assert!(ignores_hangup(&status("0000000000001001")), "nohup");
        assert!(!ignores_hangup(&status("0000000000001000")), "only SIGPIPE");
        assert!(!ignores_hangup("Name:\tx\n"), "nothing is said");
    }
}
