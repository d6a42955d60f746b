//! `any on material "glass"`: something holds at vertices. To add a test at a vertex: a variant of
//! [`VertexCheck`] with its word, and what the compiler asks for then, all in this file.

use std::ops::Range;

use super::attribute::{is_diffuse, is_glossy, is_light, is_specular};
use super::place::{Place, least, most};
use super::volume::{Volume, point};
use super::{Condition, Described, Form, Gap, Leaves, Predicate, Proposal, Spot, choose};
use crate::filter::word::{NameList, Walk, Worded as _, words};
use crate::filter::{FilterError, FilterScene, Name, Tree};
use crate::{Event, PathHeader, VertexKind, VertexRecord};

/// Most parts of one condition about a vertex.
const MAX_CHECKS: usize = 256;

/// Something holds at vertices.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VertexCondition {
    /// At which.
    pub place: Place,
    /// What. All of it is about the same vertex.
    pub test: VertexTest,
}

/// What may hold at one vertex.
pub type VertexTest = Tree<VertexCheck>;

/// A single test of one vertex.
#[derive(Clone, Debug, PartialEq)]
pub enum VertexCheck {
    /// It lies in a region.
    Inside(Volume),
    /// It lies on something that has a name.
    On(On, Name),
    /// This is what happens there.
    Is(VertexClass),
}

words! {
    /// What is tested of a vertex.
    enum Check: "What is asked of the vertex" {
        Inside = "in", "lies in a region";
        On = "on", "lies on an object, a material or a light";
        Is = "is", "scatters in some way, or is an end";
    }
}

words! {
    /// What a vertex lies on.
    pub enum On: "What kind of thing it lies on" {
        Object = "object", "an object of the scene, by its name";
        Material = "material", "a material, by its name";
        Light = "light", "a light, by its name or that of its material; the path starts there";
    }
}

words! {
    /// What can happen at a vertex.
    pub enum VertexClass: "How light scatters there, or which end it is" {
        Diffuse = "diffuse", "diffuse scattering";
        Glossy = "glossy", "glossy scattering";
        Specular = "specular", "a mirror or a smooth refraction";
        Reflect = "reflect", "mirror reflection";
        Refract = "refract", "smooth refraction";
        Light = "light", "the start on a light";
        Camera = "camera", "the end on the lens";
    }
}

impl From<On> for NameList {
    fn from(on: On) -> Self {
        match on {
            On::Object => Self::Objects,
            On::Material => Self::Materials,
            On::Light => Self::Lights,
        }
    }
}

impl Default for VertexCheck {
    fn default() -> Self {
        Self::Inside(Volume::default())
    }
}

impl VertexCheck {
    fn kind(&self) -> Check {
        match self {
            Self::Inside(_) => Check::Inside,
            Self::On(..) => Check::On,
            Self::Is(_) => Check::Is,
        }
    }

    /// What a check of a kind is before more is known.
    fn of_kind(kind: Check, spot: Spot) -> Self {
        match kind {
            Check::Inside => Self::Inside(Volume::ball(spot)),
            Check::On => Self::On(On::Material, Name::default()),
            Check::Is => Self::Is(VertexClass::Specular),
        }
    }

    /// What a menu offers to ask of a vertex; regions lie at `spot`.
    pub fn proposals(scene: &FilterScene, spot: Spot) -> Vec<Proposal<Self>> {
        let region = |label: &str, volume| Proposal {
            menu: None,
            label: label.to_owned(),
            meaning: "A vertex lies in it",
            made: Some(Self::Inside(volume)),
        };
        let named = |on: On| {
            let menu = match on {
                On::Object => "Object",
                On::Material => "Material",
                On::Light => "Light",
            };
            let line = move |label: &str, made| Proposal {
                menu: Some(menu),
                label: label.to_owned(),
                meaning: on.word().meaning,
                made,
            };
            let names = scene.names(on.into());
            let empty = names.is_empty().then(|| line("The scene has none that is named", None));
            let named = move |name: &str| line(name, Some(Self::On(on, Name::from(name))));
            names.into_iter().map(named).chain(empty)
        };
        let class = |class: VertexClass| Proposal {
            menu: Some("Scattering"),
            label: class.word().text.to_owned(),
            meaning: class.word().meaning,
            made: Some(Self::Is(class)),
        };
        [region("Sphere", Volume::ball(spot)), region("Box", Volume::cube(spot))]
            .into_iter()
            .chain(On::all().flat_map(named))
            .chain(VertexClass::all().map(class))
            .collect()
    }
}

impl Described for VertexCheck {
    fn describe(&mut self, form: &mut dyn Form) -> Walk {
        let mut kind = self.kind();
        choose(form, &mut kind)?;
        if kind != self.kind() {
            *self = Self::of_kind(kind, form.spot());
        }
        match self {
            Self::Inside(volume) => volume.describe(form),
            Self::On(on, name) => {
                let before = *on;
                choose(form, on)?;
                if *on != before {
                    *name = Name::default();
                }
                form.name((*on).into(), name)
            }
            Self::Is(class) => choose(form, class),
        }
    }
}

impl Leaves for VertexCheck {
    fn kinds() -> impl Iterator<Item = (Self, &'static str)> {
        std::iter::once((Self::default(), VertexCondition::EXAMPLE))
    }
}

impl Described for VertexCondition {
    fn describe(&mut self, form: &mut dyn Form) -> Walk {
        choose(form, &mut self.place)?;
        form.vertex(&mut self.test)
    }
}

impl From<VertexCheck> for VertexCondition {
    /// A light is where a path starts; anything else may be at any vertex.
    fn from(check: VertexCheck) -> Self {
        let place = match check {
            VertexCheck::On(On::Light, _) => Place::Start,
            VertexCheck::Inside(_) | VertexCheck::On(..) | VertexCheck::Is(_) => Place::Any,
        };
        Self { place, test: Tree::Leaf(check) }
    }
}

impl Condition for VertexCondition {
    type Predicate = VertexPredicate;
    const EXAMPLE: &'static str = "any in sphere(0, 1, 0, 0.5)";

    fn bind(&self, scene: &FilterScene) -> Result<VertexPredicate, FilterError> {
        let mut count = 0;
        let test = self.test.try_map(&mut |check: &VertexCheck| {
            count += 1;
            if count > MAX_CHECKS {
                return Err(FilterError::of_tree(
                    "a condition about a vertex is too large; split it",
                ));
            }
            check.bind(scene)
        })?;
        Ok(VertexPredicate { place: self.place, test, scale: scene.frame.scale })
    }

    fn proposals(scene: &FilterScene, spot: Spot) -> Vec<Proposal<Self>> {
        let own = VertexCheck::proposals(scene, spot).into_iter();
        own.map(|proposal| proposal.map(Self::from)).collect()
    }

    fn widened(&self, by: f64) -> Option<(&'static str, Self)> {
        let Tree::Leaf(VertexCheck::Inside(volume)) = self.test else { return None };
        let (label, volume) = volume.widened(by);
        Some((label, Self { test: Tree::Leaf(VertexCheck::Inside(volume)), ..*self }))
    }
}

impl VertexCheck {
    fn bind(&self, scene: &FilterScene) -> Result<BoundCheck, FilterError> {
        Ok(match self {
            Self::Inside(volume) => BoundCheck::Inside(volume.bind(scene.frame)?),
            Self::On(On::Object, name) => BoundCheck::Object(scene.objects_named(name)?),
            Self::On(On::Material, name) => {
                BoundCheck::Material(scene.materials_named(NameList::Materials, name)?)
            }
            Self::On(On::Light, name) => {
                BoundCheck::Light(scene.materials_named(NameList::Lights, name)?)
            }
            Self::Is(class) => BoundCheck::Is(*class),
        })
    }
}

/// A test of one vertex, bound to a scene, `scale` of whose units make one of the file.
#[derive(Clone, Debug)]
pub(in crate::filter) struct VertexPredicate {
    place: Place,
    test: Tree<BoundCheck>,
    scale: f64,
}

#[derive(Clone, Debug)]
enum BoundCheck {
    Inside(Volume),
    Object(Vec<Range<u32>>),
    /// One flag a material.
    Material(Vec<bool>),
    /// Like [`Self::Material`], for the start of a path only.
    Light(Vec<bool>),
    Is(VertexClass),
}

impl Predicate for VertexPredicate {
    #[inline]
    fn holds(&self, _: &PathHeader, path: &[VertexRecord]) -> bool {
        let holds = |vertex: &VertexRecord| self.test.holds(&|check| check.holds(vertex));
        match self.place {
            Place::Start => path.first().is_some_and(holds),
            Place::End => path.last().is_some_and(holds),
            Place::Any => path.iter().any(holds),
            Place::All => inner(path).iter().all(holds),
        }
    }

    fn gap(&self, _: &PathHeader, path: &[VertexRecord]) -> Option<Gap> {
        let gap = |vertex: &VertexRecord| distance(&self.test, vertex);
        let gap = match self.place {
            Place::Start => path.first().and_then(gap),
            Place::End => path.last().and_then(gap),
            Place::Any => least(path.iter().map(gap)),
            Place::All => most(inner(path).iter().map(gap)),
        }?;
        let reach = self.test.leaves().into_iter().find_map(BoundCheck::reach);
        Some(Gap { by: gap / self.scale, relative: gap / reach.unwrap_or(1.0) })
    }
}

/// The vertices between the ends.
fn inner(path: &[VertexRecord]) -> &[VertexRecord] {
    path.get(1..path.len().saturating_sub(1)).unwrap_or_default()
}

/// How far a vertex is from where a test holds, in scene units; `None` without a measure.
fn distance(test: &Tree<BoundCheck>, vertex: &VertexRecord) -> Option<f64> {
    if test.holds(&|check| check.holds(vertex)) {
        return Some(0.0);
    }
    match test {
        Tree::Leaf(BoundCheck::Inside(volume)) => Some(volume.distance(point(vertex))),
        Tree::And(parts) => most(parts.iter().map(|part| distance(part, vertex))),
        Tree::Or(parts) => least(parts.iter().map(|part| distance(part, vertex))),
        Tree::Leaf(
            BoundCheck::Object(_)
            | BoundCheck::Material(_)
            | BoundCheck::Light(_)
            | BoundCheck::Is(_),
        )
        | Tree::Constant(_)
        | Tree::Not(_) => None,
    }
}

impl BoundCheck {
    #[inline]
    fn holds(&self, vertex: &VertexRecord) -> bool {
        let on = |flags: &[bool]| flags.get(usize::from(vertex.material)).copied().unwrap_or(false);
        match self {
            Self::Inside(volume) => volume.contains(point(vertex)),
            Self::Object(ranges) => ranges.iter().any(|range| range.contains(&vertex.primitive)),
            // The lens is on no material; its index there is of no meaning.
            Self::Material(flags) => vertex.kind != VertexKind::Eye && on(flags),
            Self::Light(flags) => is_light(vertex) && on(flags),
            Self::Is(class) => class.holds(vertex),
        }
    }

    /// The size of its region.
    fn reach(&self) -> Option<f64> {
        match self {
            Self::Inside(volume) => Some(volume.reach()),
            Self::Object(_) | Self::Material(_) | Self::Light(_) | Self::Is(_) => None,
        }
    }
}

impl VertexClass {
    fn holds(self, vertex: &VertexRecord) -> bool {
        match self {
            Self::Diffuse => is_diffuse(vertex),
            Self::Glossy => is_glossy(vertex),
            Self::Specular => is_specular(vertex),
            Self::Reflect => vertex.event == Event::Reflect,
            Self::Refract => vertex.event == Event::Transmit,
            Self::Light => is_light(vertex),
            Self::Camera => vertex.kind == VertexKind::Eye,
        }
    }
}
