//! What filters are made of: spheres that paths are selected by, and names.

use common::{Selector, SelectorKind, Volume};
use glam::DVec3;

use super::{Axes, CommandError, Range, Value, Words, range};

/// Most selectors at a time; the text of a filter has its own limits.
pub const MOST_SELECTORS: u32 = 32;
/// Coordinates and radii that a selector may have, in the file's units.
const FAR: Range<f64> = range(-1e12, 1e12);

/// A spherical selector: its kind, and its centre and radius in the file's units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// How it combines with others.
    pub kind: SelectorKind,
    /// Centre and radius.
    pub place: [f64; 4],
}

impl Sphere {
    /// The selector that it stands for.
    pub fn selector(self) -> Selector {
        let [x, y, z, radius] = self.place;
        let volume = Volume::Sphere { centre: DVec3::new(x, y, z), radius };
        Selector { kind: self.kind, volume, by_segment: false }
    }

    /// What centre and radius may be.
    pub const PLACE: Axes<f64, 4> = Axes {
        names: ["X", "Y", "Z", "RADIUS"],
        ranges: [FAR, FAR, FAR, range(f64::MIN_POSITIVE, FAR.high)],
    };
}

impl Value for Sphere {
    type Limits = ();

    fn form(_: &str, (): &()) -> String {
        format!("start|end|any|all {}", <[f64; 4]>::form("", &Self::PLACE))
    }

    fn read(words: &mut Words<'_>, name: &str, (): &()) -> Result<Self, CommandError> {
        let word = words.parameter("KIND")?;
        let kind = KINDS.into_iter().find(|kind| kind_name(*kind) == word);
        let names = || KINDS.map(kind_name).join(", ");
        let kind = kind.ok_or_else(|| CommandError::no_choice(word, &names()))?;
        Ok(Self { kind, place: Value::read(words, name, &Self::PLACE)? })
    }

    fn text(&self) -> String {
        format!("{} {}", kind_name(self.kind), self.place.text())
    }

    fn examples((): &()) -> Vec<Self> {
        KINDS.into_iter().map(|kind| Self { kind, place: [1.0, 2.5, -3.0, 0.25] }).collect()
    }
}

/// Every kind of selectors, in the order of help texts.
const KINDS: [SelectorKind; 4] =
    [SelectorKind::Start, SelectorKind::End, SelectorKind::Any, SelectorKind::All];

/// The word for a kind of selectors.
pub fn kind_name(kind: SelectorKind) -> &'static str {
    match kind {
        SelectorKind::Start => "start",
        SelectorKind::End => "end",
        SelectorKind::Any => "any",
        SelectorKind::All => "all",
    }
}
