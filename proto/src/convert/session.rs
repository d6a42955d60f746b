//! The two directions of a session.

use std::sync::Arc;

use common::{Appearance, Gap, Notice, PathId, Role, TracerEvent, Welcome};

use super::filter::WantedFilter;
use super::role::role;
use super::steering::NumberedOrder;
use super::{WireError, check};
use crate::{ProtocolVersion, v1};

/// A viewer's introduction, of a compatible version.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Hello {
    /// The viewer's version.
    pub version: ProtocolVersion,
    /// A name for the log, without control characters.
    pub viewer_name: String,
    /// The role it would like.
    pub wanted_role: Role,
    /// Most bytes of data a second; 0 for the default.
    pub data_budget: u64,
    /// Which paths it would like from the beginning.
    pub filter: Option<WantedFilter>,
    /// It would like every step of the explorer from the beginning.
    pub focus: bool,
    /// What an earlier session's welcome gave it to come back with; blank for none.
    pub resume: String,
}

/// What a viewer says.
#[derive(Clone, Debug, PartialEq)]
pub enum ViewerEvent {
    /// Introduces the viewer.
    Hello(Hello),
    /// Changes the most bytes of data a second; 0 for the default.
    SetBudget(u64),
    /// Changes which paths are sent.
    SetFilter(WantedFilter),
    /// Asks for every step of the explorer, or for no more of them.
    SetFocus(bool),
    /// Steers.
    Order(NumberedOrder),
    /// Shows something of itself.
    Appearance(Appearance),
    /// Asks for the numbers behind a path.
    Inspect(PathId),
    /// Leaves, with a reason.
    Goodbye(String),
    /// Something of a later version, to be ignored.
    Unknown,
}

impl From<ViewerEvent> for v1::ViewerMessage {
    fn from(event: ViewerEvent) -> Self {
        use v1::viewer_message::Kind;
        let kind = match event {
            ViewerEvent::Hello(hello) => Some(Kind::Hello(hello.into())),
            ViewerEvent::SetBudget(data_budget) => {
                Some(Kind::SetBudget(v1::SetBudget { data_budget }))
            }
            ViewerEvent::SetFilter(filter) => Some(Kind::SetFilter(filter.into())),
            ViewerEvent::SetFocus(on) => Some(Kind::SetFocus(v1::SetFocus { on })),
            ViewerEvent::Order(order) => Some(Kind::Order(order.into())),
            ViewerEvent::Appearance(appearance) => Some(Kind::Appearance((&appearance).into())),
            ViewerEvent::Inspect(path) => {
                Some(Kind::InspectPath(v1::InspectPath { path: Some(path.into()) }))
            }
            ViewerEvent::Goodbye(reason) => Some(Kind::Goodbye(v1::Goodbye { reason })),
            ViewerEvent::Unknown => None,
        };
        Self { kind }
    }
}

impl TryFrom<v1::ViewerMessage> for ViewerEvent {
    type Error = WireError;

    fn try_from(wire: v1::ViewerMessage) -> Result<Self, WireError> {
        use v1::viewer_message::Kind;
        Ok(match wire.kind {
            Some(Kind::Hello(hello)) => Self::Hello(hello.try_into()?),
            Some(Kind::SetBudget(budget)) => Self::SetBudget(budget.data_budget),
            Some(Kind::SetFilter(filter)) => Self::SetFilter(filter.try_into()?),
            Some(Kind::SetFocus(focus)) => Self::SetFocus(focus.on),
            Some(Kind::Order(order)) => Self::Order(order.try_into()?),
            Some(Kind::Appearance(appearance)) => Self::Appearance(appearance.try_into()?),
            Some(Kind::InspectPath(inspect)) => {
                Self::Inspect(check::required("inspect_path.path", inspect.path)?.into())
            }
            Some(Kind::Goodbye(goodbye)) => Self::Goodbye(reason(goodbye)?),
            None => Self::Unknown,
        })
    }
}

impl From<&TracerEvent> for v1::TracerMessage {
    fn from(event: &TracerEvent) -> Self {
        use v1::tracer_message::Kind;
        let kind = match event {
            TracerEvent::Welcome(welcome) => Some(Kind::Welcome((&**welcome).into())),
            TracerEvent::Paths(batch) => Some(Kind::PathBatch((&**batch).into())),
            TracerEvent::Film(tile) => Some(Kind::FilmTile(tile.into())),
            TracerEvent::Statistics(statistics) => Some(Kind::Statistics((&**statistics).into())),
            TracerEvent::Gap(gap) => Some(Kind::Gap((*gap).into())),
            TracerEvent::SnapshotEnd => Some(Kind::SnapshotEnd(v1::SnapshotEnd {})),
            TracerEvent::FilterReply(reply) => Some(Kind::FilterReply(reply.into())),
            TracerEvent::FocusPath(path) => Some(Kind::FocusPath((&**path).into())),
            TracerEvent::FocusStep(step) => Some(Kind::FocusStep((&**step).into())),
            TracerEvent::FocusGap(steps) => Some(Kind::FocusGap(v1::FocusGap { steps: *steps })),
            TracerEvent::ExplorerFilm(tile) => Some(Kind::ExplorerFilm(tile.into())),
            TracerEvent::Notice(notice) => Some(notice.into()),
            TracerEvent::Goodbye(reason) => {
                Some(Kind::Goodbye(v1::Goodbye { reason: check::cut(reason, check::MAX_REASON) }))
            }
            TracerEvent::Unknown => None,
        };
        Self { kind }
    }
}

impl From<&Notice> for v1::tracer_message::Kind {
    fn from(notice: &Notice) -> Self {
        match notice {
            Notice::Presence(presence) => Self::Presence(presence.into()),
            Notice::Explorer(state) => Self::ExplorerState(state.into()),
            Notice::Chains(state) => Self::ChainState(state.into()),
            Notice::Lease(notice) => Self::LeaseNotice(notice.into()),
            Notice::Reply(reply) => Self::OrderReply(reply.into()),
            Notice::Detail(reply) => Self::PathDetail((&**reply).into()),
        }
    }
}

impl TryFrom<v1::TracerMessage> for TracerEvent {
    type Error = WireError;

    fn try_from(wire: v1::TracerMessage) -> Result<Self, WireError> {
        use v1::tracer_message::Kind;
        Ok(match wire.kind {
            Some(Kind::Welcome(welcome)) => Self::Welcome(Box::new(welcome.try_into()?)),
            Some(Kind::PathBatch(batch)) => Self::Paths(Arc::new(batch.try_into()?)),
            Some(Kind::FilmTile(tile)) => Self::Film(tile.try_into()?),
            Some(Kind::Statistics(statistics)) => {
                Self::Statistics(Arc::new(statistics.try_into()?))
            }
            Some(Kind::Gap(gap)) => Self::Gap(gap.into()),
            Some(Kind::SnapshotEnd(_)) => Self::SnapshotEnd,
            Some(Kind::FilterReply(reply)) => Self::FilterReply(reply.try_into()?),
            Some(Kind::FocusPath(path)) => Self::FocusPath(Arc::new(path.try_into()?)),
            Some(Kind::FocusStep(step)) => Self::FocusStep(Arc::new(step.try_into()?)),
            Some(Kind::FocusGap(gap)) => Self::FocusGap(gap.steps),
            Some(Kind::ExplorerFilm(tile)) => Self::ExplorerFilm(tile.try_into()?),
            Some(Kind::Presence(presence)) => Self::Notice(Notice::Presence(presence.try_into()?)),
            Some(Kind::ExplorerState(state)) => Self::Notice(Notice::Explorer(state.try_into()?)),
            Some(Kind::ChainState(state)) => Self::Notice(Notice::Chains(state.try_into()?)),
            Some(Kind::LeaseNotice(notice)) => Self::Notice(Notice::Lease(notice.try_into()?)),
            Some(Kind::OrderReply(reply)) => Self::Notice(Notice::Reply(reply.try_into()?)),
            Some(Kind::PathDetail(reply)) => {
                Self::Notice(Notice::Detail(Box::new(reply.try_into()?)))
            }
            Some(Kind::Goodbye(goodbye)) => Self::Goodbye(reason(goodbye)?),
            None => Self::Unknown,
        })
    }
}

fn reason(goodbye: v1::Goodbye) -> Result<String, WireError> {
    check::text("goodbye.reason", goodbye.reason, check::MAX_REASON)
}

impl From<ProtocolVersion> for v1::ProtocolVersion {
    fn from(version: ProtocolVersion) -> Self {
        Self { major: version.major, minor: version.minor }
    }
}

/// The peer's version, if this program can talk to it.
fn compatible(wire: Option<v1::ProtocolVersion>) -> Result<ProtocolVersion, WireError> {
    let v1::ProtocolVersion { major, minor } = check::required("version", wire)?;
    let (ours, theirs) = (ProtocolVersion::CURRENT, ProtocolVersion { major, minor });
    if theirs.major == ours.major { Ok(theirs) } else { Err(WireError::Version { ours, theirs }) }
}

impl From<Hello> for v1::Hello {
    fn from(hello: Hello) -> Self {
        Self {
            version: Some(hello.version.into()),
            viewer_name: hello.viewer_name,
            wanted_role: v1::Role::from(hello.wanted_role).into(),
            data_budget: hello.data_budget,
            filter: hello.filter.map(Into::into),
            focus: hello.focus,
            resume: hello.resume,
        }
    }
}

impl TryFrom<v1::Hello> for Hello {
    type Error = WireError;

    fn try_from(wire: v1::Hello) -> Result<Self, WireError> {
        // The version first: what follows may mean something else in another one.
        let version = compatible(wire.version)?;
        let mut viewer_name = check::text("hello.viewer_name", wire.viewer_name, check::MAX_NAME)?;
        viewer_name.retain(|c| !c.is_control());
        Ok(Self {
            version,
            viewer_name,
            wanted_role: role(wire.wanted_role),
            data_budget: wire.data_budget,
            filter: wire.filter.map(TryInto::try_into).transpose()?,
            focus: wire.focus,
            resume: check::text("hello.resume", wire.resume, check::MAX_NAME)?,
        })
    }
}

impl From<&Welcome> for v1::Welcome {
    fn from(welcome: &Welcome) -> Self {
        Self {
            version: Some(ProtocolVersion::CURRENT.into()),
            session: welcome.session,
            server_version: welcome.server_version.clone(),
            scene_name: check::cut(&welcome.scene_name, check::MAX_NAME),
            scene_hash: welcome.scene_hash.clone(),
            frame: Some(welcome.frame.into()),
            camera: Some(welcome.camera.into()),
            strategies: welcome.strategies.clone(),
            failure_reasons: welcome.failure_reasons.clone(),
            chains: welcome.chains,
            max_edges: welcome.max_edges,
            role: v1::Role::from(welcome.role).into(),
            resume: welcome.resume.clone(),
        }
    }
}

impl TryFrom<v1::Welcome> for Welcome {
    type Error = WireError;

    fn try_from(wire: v1::Welcome) -> Result<Self, WireError> {
        compatible(wire.version)?;
        let name = |field, text| check::text(field, text, check::MAX_NAME);
        Ok(Self {
            session: wire.session,
            server_version: name("welcome.server_version", wire.server_version)?,
            scene_name: name("welcome.scene_name", wire.scene_name)?,
            scene_hash: name("welcome.scene_hash", wire.scene_hash)?,
            frame: check::required("welcome.frame", wire.frame)?.try_into()?,
            camera: check::required("welcome.camera", wire.camera)?.try_into()?,
            strategies: check::names("welcome.strategies", wire.strategies)?,
            failure_reasons: check::names("welcome.failure_reasons", wire.failure_reasons)?,
            chains: wire.chains,
            max_edges: wire.max_edges,
            role: role(wire.role),
            resume: name("welcome.resume", wire.resume)?,
        })
    }
}

impl From<Gap> for v1::Gap {
    fn from(Gap { batches, paths, bytes }: Gap) -> Self {
        Self { batches, paths, bytes }
    }
}

impl From<v1::Gap> for Gap {
    fn from(v1::Gap { batches, paths, bytes }: v1::Gap) -> Self {
        Self { batches, paths, bytes }
    }
}
