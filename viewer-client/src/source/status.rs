//! What is known of the daemon and of the way to it.

use std::sync::Arc;
use std::time::{Duration, Instant};

use common::{FilterReply, Role, Statistics, Welcome};

use super::steering::Steering;
use crate::imaging::Provenance;
use crate::value::format;
use crate::value::rates::History;
use crate::value::trends::Trends;

/// How the connection is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LinkState {
    /// Nothing is looked at.
    Idle,
    /// There is none.
    Disconnected {
        /// What went wrong last.
        reason: String,
        /// When the next attempt is due.
        retry_at: Instant,
    },
    /// An attempt is under way.
    Connecting,
    /// The daemon has welcomed the viewer.
    Connected,
}

/// A word to the user, shown for some seconds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Notice {
    /// What happened, or what went wrong and what to do.
    pub text: String,
    /// It went wrong.
    pub is_bad: bool,
    /// When it was said.
    pub at: Instant,
}

/// What is known of the daemon and of the way to it.
#[derive(Debug)]
pub struct Status {
    /// Where the daemon is, HOST:PORT.
    pub address: String,
    /// The daemon is part of this program.
    pub embedded: bool,
    /// How the connection is.
    pub link: LinkState,
    /// What the daemon said of itself.
    pub welcome: Option<Welcome>,
    /// The newest counts.
    pub statistics: Option<Arc<Statistics>>,
    /// Mutations a second over the last minutes.
    pub mutation_history: History,
    /// How the chains do over time.
    pub trends: Trends,
    /// How often the viewer reconnected.
    pub reconnects: u32,
    /// The answer to the filter that was set last.
    pub filter: Option<FilterReply>,
    /// Who steers, and what the explorer is doing.
    pub steering: Steering,
    /// How long the daemon took to answer a question last, way and back.
    pub latency: Option<Duration>,
    /// When something came from the daemon last.
    heard: Option<Instant>,
    /// When somebody looked last whether something had come.
    listened: Option<Instant>,
    /// The newest word to the user.
    pub notice: Option<Notice>,
    /// What went wrong, the oldest first.
    failures: Vec<String>,
}

/// Failures that have not been collected yet.
const MOST_FAILURES: usize = 64;

/// A daemon that says nothing for so long does not answer.
pub const SILENCE: Duration = Duration::from_secs(3);

impl Status {
    /// Before the first attempt to reach `address`.
    pub fn new(address: String, embedded: bool) -> Self {
        Self {
            address,
            embedded,
            link: LinkState::Connecting,
            welcome: None,
            statistics: None,
            mutation_history: History::default(),
            trends: Trends::default(),
            reconnects: 0,
            filter: None,
            steering: Steering::default(),
            latency: None,
            heard: None,
            listened: None,
            notice: None,
            failures: Vec::new(),
        }
    }

    /// True while data may come.
    pub fn is_connected(&self) -> bool {
        self.link == LinkState::Connected
    }

    /// Notes that somebody looked whether something had come, and whether it had.
    pub fn listen(&mut self, heard: bool, now: Instant) {
        self.listened = Some(now);
        if heard {
            self.heard = Some(now);
        }
    }

    /// How long the daemon had said nothing when somebody looked last, although the connection stands,
    /// where that is longer than its figures, which come every second, ever take.
    pub fn silence(&self) -> Option<Duration> {
        // Figures come once the chains have begun; until then a daemon looks for light.
        let speaks = self.is_connected() && self.statistics.is_some();
        let (heard, listened) = self.heard.zip(self.listened).filter(|_| speaks)?;
        Some(listened.saturating_duration_since(heard)).filter(|silence| *silence >= SILENCE)
    }

    /// Mutations a second as they are made now: none while the chains rest or out of reach, whatever
    /// was counted before.
    pub fn mutation_rate(&self) -> f64 {
        let resting = self.steering.chains.as_ref().is_some_and(|chains| !chains.running);
        let statistics = self.statistics.as_ref().filter(|_| self.is_connected() && !resting);
        statistics.map_or(0.0, |statistics| statistics.mutations_per_second)
    }

    /// What this viewer may do now.
    pub fn role(&self) -> Role {
        self.welcome.as_ref().map_or(Role::Observer, |w| self.steering.role(w.session))
    }

    /// What is known about the image in addition to its pixels.
    pub fn provenance(&self) -> Provenance<'_> {
        let mut metadata = Vec::new();
        if let Some(welcome) = &self.welcome {
            metadata.push(("lvis.scene", welcome.scene_name.clone()));
            metadata.push(("lvis.scene_hash", welcome.scene_hash.clone()));
            metadata.push(("lvis.version", welcome.server_version.clone()));
        }
        if let Some(statistics) = &self.statistics {
            metadata.push(("lvis.b", statistics.normalization.to_string()));
            let error = statistics.normalization_error;
            metadata.push(("lvis.b_standard_error", error.to_string()));
        }
        Provenance {
            scene: self.welcome.as_ref().map(|welcome| welcome.scene_name.as_str()),
            metadata,
            diagnostics: self.statistics.as_ref().and_then(|s| s.diagnostics.as_deref()),
        }
    }

    /// Says something to the user.
    pub fn say(&mut self, said: Result<String, String>) {
        match said {
            Ok(text) => self.show(&text, false),
            Err(problem) => {
                if self.failures.len() < MOST_FAILURES {
                    self.failures.push(format::sentence(&problem));
                }
                self.show(&problem, true);
            }
        }
    }

    /// Tells the user of something that is not as it should be, although what was asked for is done.
    pub fn warn(&mut self, problem: &str) {
        self.show(problem, true);
    }

    fn show(&mut self, text: &str, is_bad: bool) {
        self.notice = Some(Notice { text: format::sentence(text), is_bad, at: Instant::now() });
    }

    /// What went wrong since the last call, for use without a window.
    pub fn take_failures(&mut self) -> Vec<String> {
        std::mem::take(&mut self.failures)
    }

    /// Another session begins. What was told in the one before is void; where the daemon is, how often
    /// it was reached and what was said to the user is not.
    pub fn welcome(&mut self, welcome: Welcome) {
        let fresh = Self::new(std::mem::take(&mut self.address), self.embedded);
        let reconnects = self.reconnects + u32::from(self.welcome.is_some());
        *self = Self {
            link: self.link.clone(),
            welcome: Some(welcome),
            reconnects,
            heard: self.heard,
            listened: self.listened,
            notice: self.notice.take(),
            failures: std::mem::take(&mut self.failures),
            ..fresh
        };
    }

    /// Takes new counts.
    pub fn statistics(&mut self, statistics: impl Into<Arc<Statistics>>) {
        let statistics = statistics.into();
        self.mutation_history.push(statistics.mutations_per_second as f32);
        self.trends.push(&statistics);
        self.statistics = Some(statistics);
    }
}
