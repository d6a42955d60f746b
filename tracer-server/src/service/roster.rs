//! Who is connected, who holds the lease, and who may get it back.

use std::collections::{BTreeMap, VecDeque};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use common::{
    Appearance, Attendee, Author, LeaseEvent, LeaseNotice, LeaseRequest, Notice, Presence, Role,
};
use proto::{Hello, WantedFilter};
use ring::rand::{SecureRandom as _, SystemRandom};

use crate::hub::Hub;

/// How long a viewer whose connection broke may come back to its filter and its role.
const ABSENCE: Duration = Duration::from_mins(5);
/// Viewers that may come back.
const ABSENT: usize = 64;
/// Random bytes of what a viewer shows to come back.
const RESUME_BYTES: usize = 32;

/// Everyone who is there. Every change is announced.
#[derive(Debug)]
pub(super) struct Roster {
    hub: Hub,
    state: Mutex<State>,
}

#[derive(Debug, Default)]
struct State {
    members: BTreeMap<u64, Member>,
    /// Sessions that ask for the lease, the longest first.
    asking: VecDeque<u64>,
    absent: VecDeque<Absent>,
}

#[derive(Debug)]
struct Member {
    attendee: Attendee,
    /// Its token allows it to drive.
    may_drive: bool,
    /// What it may come back to.
    memory: Memory,
}

/// What a viewer comes back to. Only the hash of its secret is kept.
#[derive(Clone, Debug)]
struct Memory {
    secret: blake3::Hash,
    drove: bool,
    filter: Option<WantedFilter>,
    focus: bool,
}

#[derive(Debug)]
struct Absent {
    memory: Memory,
    since: Instant,
}

/// How a viewer's session begins.
#[derive(Debug)]
pub(super) struct Entry {
    /// The role that it got.
    pub(super) role: Role,
    /// What it shows to come back.
    pub(super) resume: String,
    /// The filter that it comes back to.
    pub(super) filter: Option<WantedFilter>,
    /// It comes back to the focus lane.
    pub(super) focus: bool,
}

impl Roster {
    /// An empty one.
    pub(super) fn new(hub: Hub) -> Self {
        Self { hub, state: Mutex::default() }
    }

    /// Lets a viewer in, which may become at most `most`.
    pub(super) fn enter(&self, session: u64, hello: &Hello, most: Role) -> Entry {
        let mut state = self.state();
        let known = self.recall(&mut state, &hello.resume);
        let resume = secret();
        let may_drive = most == Role::Driver;
        let wants = hello.wanted_role == Role::Driver || known.as_ref().is_some_and(|k| k.drove);
        let drives = wants && may_drive && state.driver().is_none() && state.asking.is_empty();
        let role = if drives { Role::Driver } else { Role::Observer };
        let filter = hello.filter.clone().or_else(|| known.as_ref()?.filter.clone());
        let focus = hello.focus || known.is_some_and(|known| known.focus);
        let memory = Memory {
            secret: blake3::hash(resume.as_bytes()),
            drove: drives,
            filter: filter.clone(),
            focus,
        };
        let author = Author { session, name: hello.viewer_name.clone() };
        let attendee = Attendee { author, role, ..Attendee::default() };
        state.members.insert(session, Member { attendee, may_drive, memory });
        if state.driver().is_none() {
            self.pass_on(&mut state);
        }
        self.announce(&state);
        let filter = filter.filter(|_| hello.filter.is_none());
        Entry { role, resume, filter, focus }
    }

    /// Removes a viewer. Its lease goes to the viewer that asked first.
    pub(super) fn leave(&self, session: u64) {
        let mut state = self.state();
        state.asking.retain(|&asking| asking != session);
        let Some(member) = state.members.remove(&session) else { return };
        let now = Instant::now();
        state.absent.retain(|absent| now.duration_since(absent.since) < ABSENCE);
        if state.absent.len() >= ABSENT {
            state.absent.pop_front();
        }
        state.absent.push_back(Absent { memory: member.memory, since: now });
        if member.attendee.role == Role::Driver {
            self.pass_on(&mut state);
        }
        self.announce(&state);
    }

    /// The name of a viewer that may give orders, or why it may not.
    pub(super) fn driver(&self, session: u64) -> Result<Author, String> {
        let state = self.state();
        let Some(member) = state.members.get(&session) else {
            return Err("the session is over".to_owned());
        };
        if member.attendee.role == Role::Driver {
            return Ok(member.attendee.author.clone());
        }
        Err(match state.driver() {
            _ if !member.may_drive => OBSERVERS_TOKEN.to_owned(),
            Some(driver) => format!(
                "only the driver can give orders, and that is {} (session {}): ask for the lease",
                driver.author.name, driver.author.session
            ),
            None => "only the driver can give orders, and nobody is driving: ask for the lease"
                .to_owned(),
        })
    }

    /// Does what a viewer asks of the lease, or says why not.
    pub(super) fn lease(&self, session: u64, request: LeaseRequest) -> Result<(), String> {
        let mut state = self.state();
        let Some(member) = state.members.get(&session) else {
            return Err("the session is over".to_owned());
        };
        let (author, role) = (member.attendee.author.clone(), member.attendee.role);
        match request {
            LeaseRequest::Ask if role == Role::Driver => {}
            LeaseRequest::Ask if !member.may_drive => return Err(OBSERVERS_TOKEN.to_owned()),
            LeaseRequest::Ask => {
                let driver = state.driver().map(|driver| driver.author.session);
                if let Some(driver) = driver {
                    if !state.asking.contains(&session) {
                        state.asking.push_back(session);
                        self.notify(driver, LeaseEvent::Asked, Some(author));
                    }
                } else {
                    self.grant(&mut state, session, None);
                }
            }
            LeaseRequest::Release if role == Role::Driver => {
                self.take_away(&mut state, session, None);
                self.pass_on(&mut state);
            }
            LeaseRequest::Release => state.asking.retain(|&asking| asking != session),
            LeaseRequest::HandOver(_) if role != Role::Driver => {
                return Err("only the driver can hand over the lease".to_owned());
            }
            LeaseRequest::HandOver(to) => {
                let Some(heir) = state.members.get(&to) else {
                    return Err(format!("no viewer has session {to}"));
                };
                if !heir.may_drive {
                    return Err(format!("{}: {OBSERVERS_TOKEN}", heir.attendee.author.name));
                }
                if to != session {
                    let heir = heir.attendee.author.clone();
                    self.take_away(&mut state, session, Some(heir));
                    self.grant(&mut state, to, Some(author));
                }
            }
        }
        self.announce(&state);
        Ok(())
    }

    /// Shows the others something of a viewer.
    pub(super) fn show(&self, session: u64, appearance: Appearance) {
        let mut state = self.state();
        if let Some(member) = state.members.get_mut(&session)
            && member.attendee.appearance != appearance
        {
            member.attendee.appearance = appearance;
            self.announce(&state);
        }
    }

    /// Keeps the filter that a viewer comes back to.
    pub(super) fn keep_filter(&self, session: u64, filter: WantedFilter) {
        if let Some(member) = self.state().members.get_mut(&session) {
            member.memory.filter = Some(filter);
        }
    }

    /// Keeps whether a viewer comes back to the focus lane.
    pub(super) fn keep_focus(&self, session: u64, on: bool) {
        if let Some(member) = self.state().members.get_mut(&session) {
            member.memory.focus = on;
        }
    }

    /// What the bearer of `resume` may come back to. A session that it still seems to have is dead:
    /// its end was not heard of yet.
    fn recall(&self, state: &mut State, resume: &str) -> Option<Memory> {
        if resume.is_empty() {
            return None;
        }
        let secret = blake3::hash(resume.as_bytes());
        let is_it = |memory: &Memory| memory.secret == secret;
        let ghost = state.members.iter().find(|(_, member)| is_it(&member.memory));
        if let Some((&session, _)) = ghost {
            state.asking.retain(|&asking| asking != session);
            let memory = state.members.remove(&session).map(|member| member.memory);
            self.hub.dismiss(session, "the viewer reconnected on another connection");
            return memory;
        }
        let fresh = |absent: &Absent| absent.since.elapsed() < ABSENCE;
        let found = state.absent.iter().position(|a| is_it(&a.memory) && fresh(a))?;
        state.absent.remove(found).map(|absent| absent.memory)
    }

    /// Gives a free lease to the viewer that asked first.
    fn pass_on(&self, state: &mut State) {
        if let Some(next) = state.asking.front().copied() {
            self.grant(state, next, None);
        }
    }

    fn grant(&self, state: &mut State, session: u64, by: Option<Author>) {
        state.asking.retain(|&asking| asking != session);
        if let Some(member) = state.members.get_mut(&session) {
            member.attendee.role = Role::Driver;
            member.memory.drove = true;
            self.notify(session, LeaseEvent::Granted, by);
        }
    }

    fn take_away(&self, state: &mut State, session: u64, by: Option<Author>) {
        if let Some(member) = state.members.get_mut(&session) {
            member.attendee.role = Role::Observer;
            member.memory.drove = false;
            self.notify(session, LeaseEvent::Lost, by);
        }
    }

    fn notify(&self, session: u64, event: LeaseEvent, by: Option<Author>) {
        self.hub.tell(session, Notice::Lease(LeaseNotice { event, by }));
    }

    /// Under the lock, so that announcements come in the order of the changes.
    fn announce(&self, state: &State) {
        let attendee = |(session, member): (&u64, &Member)| Attendee {
            asks: state.asking.contains(session),
            ..member.attendee.clone()
        };
        let viewers = state.members.iter().map(attendee).collect();
        self.hub.announce(&Notice::Presence(Presence { viewers }));
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Why some never drive.
const OBSERVERS_TOKEN: &str =
    "the observers' token does not allow steering; connect with the driver's token";

impl State {
    fn driver(&self) -> Option<&Attendee> {
        let attendees = self.members.values().map(|member| &member.attendee);
        attendees.into_iter().find(|attendee| attendee.role == Role::Driver)
    }
}

/// A secret in hexadecimal digits; blank, which opens nothing, where the system has no random numbers.
fn secret() -> String {
    let mut bytes = [0; RESUME_BYTES];
    if SystemRandom::new().fill(&mut bytes).is_err() {
        tracing::warn!(
            "the system provides no random numbers: viewers cannot resume their sessions"
        );
        return String::new();
    }
    blake3::Hash::from_bytes(bytes).to_hex().to_string()
}
