//! Ctrl-C and its kin, for work whose result so far is worth keeping.

use std::process;
use std::sync::{Arc, OnceLock};
use std::thread;

use anyhow::Context as _;
use host::signal::{Ending, Endings};

use crate::parallel::Stop;

/// Listens for signals that end a program: the first one tells the work to stop, the second one
/// ends everything at once.
#[derive(Clone, Debug, Default)]
pub(super) struct Stopper {
    stop: Stop,
    ending: Arc<OnceLock<Ending>>,
}

impl Stopper {
    /// From now on signals do not end the program by themselves. `remedy` says what the first one
    /// causes.
    pub(super) fn listen(remedy: String) -> anyhow::Result<Self> {
        let stopper = Self::default();
        let told = stopper.clone();
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_all()
            .build()
            .context("cannot wait for signals")?;
        let mut endings = {
            let _context = runtime.enter();
            Endings::listen().context("cannot wait for signals")?
        };
        let hear = move || {
            let first = runtime.block_on(endings.next());
            told.ending.get_or_init(|| first);
            told.stop.set();
            tracing::info!("{}: {remedy}; a second signal ends the program at once", first.name());
            let second = runtime.block_on(endings.next());
            process::exit(i32::from(second.exit_code()));
        };
        let thread = thread::Builder::new().name("lvis-signals".to_owned()).spawn(hear);
        // It waits for signals as long as the program lasts.
        drop(thread.context("cannot wait for signals")?);
        Ok(stopper)
    }

    /// What the work looks at.
    pub(super) fn stop(&self) -> &Stop {
        &self.stop
    }

    /// The signal that came first, if one has come.
    pub(super) fn ending(&self) -> Option<Ending> {
        self.ending.get().copied()
    }
}
