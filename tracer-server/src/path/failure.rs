//! Why a proposal is no path.

/// The reason a walk, a connection or a proposal failed. A failed proposal is a full step of its
/// chain: the current path is counted once more.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Failure {
    /// The current path has no part that the strategy could change.
    NoSubpath,
    /// The new film point lies outside the film.
    OffFilm,
    /// A ray met no surface.
    LeftScene,
    /// A connection is blocked, or shorter than the rays at its ends can resolve.
    Occluded,
    /// A perturbed ray met a surface of another kind.
    KindChanged,
    /// A walk was absorbed, or the path carries no light.
    ZeroContribution,
    /// No light where the path had to end.
    NoLightHit,
    /// An end of the connection is specular.
    SpecularConnection,
    /// No admissible number of edges.
    LengthOutOfRange,
    /// A number was NaN, infinite or negative.
    NotFinite,
}

impl Failure {
    /// Every reason, in the order of their codes.
    pub const ALL: [Self; 10] = [
        Self::NoSubpath,
        Self::OffFilm,
        Self::LeftScene,
        Self::Occluded,
        Self::KindChanged,
        Self::ZeroContribution,
        Self::NoLightHit,
        Self::SpecularConnection,
        Self::LengthOutOfRange,
        Self::NotFinite,
    ];

    /// A few words for tables and viewers.
    pub fn name(self) -> &'static str {
        match self {
            Self::NoSubpath => "no suitable subpath",
            Self::OffFilm => "off film",
            Self::LeftScene => "left scene",
            Self::Occluded => "occluded",
            Self::KindChanged => "kind changed",
            Self::ZeroContribution => "zero contribution",
            Self::NoLightHit => "no light hit",
            Self::SpecularConnection => "specular connection",
            Self::LengthOutOfRange => "length out of range",
            Self::NotFinite => "not finite",
        }
    }
}
