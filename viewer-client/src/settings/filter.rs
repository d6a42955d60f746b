//! Which paths are shown.

use std::sync::Arc;

use common::{Filter, FilterError, FilterScene, FilterText, SelectorKind};

use crate::command::{FilterCommand, MOST_KEPT};
use crate::value::{MOST_SELECTORS, Sphere};

/// Which paths are shown: text, spheres and kept filters, and the one filter that they make together.
///
/// Only commands and scenes change it, so that the whole is put together then and not in every frame.
#[derive(Clone, Debug, Default)]
pub struct FilterSettings {
    text: Part,
    selectors: Vec<Sphere>,
    chosen: Option<usize>,
    off: bool,
    inverted: bool,
    kept: Vec<KeptFilter>,
    /// What paths are asked for; all that is known of the scene, and nothing before it has come.
    scene: Option<Arc<FilterScene>>,
    whole: FilterText,
}

/// A filter as somebody wrote it, and what this scene makes of it.
#[derive(Clone, Debug, Default)]
struct Part {
    text: FilterText,
    misfit: Option<FilterError>,
}

/// A filter that has a name.
#[derive(Clone, Debug)]
pub struct KeptFilter {
    /// Its name.
    pub name: String,
    part: Part,
    /// It holds.
    pub on: bool,
    /// Its opposite does.
    pub inverted: bool,
}

/// Where a condition of the whole filter was written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilterSource {
    /// A spherical selector, by its number.
    Sphere(usize),
    /// The text; which of its conditions.
    Text(usize),
    /// A kept filter, by its number.
    Kept(usize),
}

impl Part {
    fn new(text: FilterText, scene: Option<&FilterScene>) -> Self {
        let mut part = Self { text, misfit: None };
        part.fit(scene);
        part
    }

    /// Finds out whether a scene has what the filter names.
    fn fit(&mut self, scene: Option<&FilterScene>) {
        self.misfit = match (self.text.tree(), scene) {
            (Ok(tree), Some(scene)) => tree.compile(scene).err(),
            _ => None,
        };
    }

    /// Why it asks for nothing: it cannot be read, or not on this scene.
    fn complaint(&self) -> Option<&FilterError> {
        self.text.error().or(self.misfit.as_ref())
    }

    /// What it asks for; `None` where that makes no sense here.
    fn tree(&self) -> Option<&Filter> {
        if self.misfit.is_some() { None } else { self.text.tree().ok() }
    }
}

impl KeptFilter {
    /// A filter that is kept and does not hold yet.
    pub fn new(name: String, text: FilterText, inverted: bool) -> Self {
        Self { name, part: Part { text, misfit: None }, on: false, inverted }
    }

    /// Its text.
    pub fn text(&self) -> &FilterText {
        &self.part.text
    }

    /// Why it is left out even where it is on: it cannot be read, or not on this scene.
    pub fn complaint(&self) -> Option<&FilterError> {
        self.part.complaint()
    }
}

/// What a scene makes of them says nothing of the filters.
impl PartialEq for KeptFilter {
    fn eq(&self, other: &Self) -> bool {
        let own = |kept: &Self| (kept.on, kept.inverted);
        self.name == other.name && self.text() == other.text() && own(self) == own(other)
    }
}

impl Eq for KeptFilter {}

/// What a scene makes of them says nothing of the choices.
impl PartialEq for FilterSettings {
    fn eq(&self, other: &Self) -> bool {
        let own = |s: &Self| (s.chosen, s.off, s.inverted);
        self.text.text == other.text.text
            && self.selectors == other.selectors
            && self.kept == other.kept
            && own(self) == own(other)
    }
}

impl FilterSettings {
    /// The text that the user wrote; blank for all paths.
    pub fn text(&self) -> &FilterText {
        &self.text.text
    }

    /// Why the text is left out: it cannot be read, or not on this scene.
    pub fn complaint(&self) -> Option<&FilterError> {
        self.text.complaint()
    }

    /// Spheres that paths are selected by, too.
    pub fn selectors(&self) -> &[Sphere] {
        &self.selectors
    }

    /// The selector whose handles are shown.
    pub fn chosen(&self) -> Option<usize> {
        self.chosen
    }

    /// All paths are wanted in spite of the rest.
    pub fn is_off(&self) -> bool {
        self.off
    }

    /// What text and selectors leave out is wanted instead.
    pub fn is_inverted(&self) -> bool {
        self.inverted
    }

    /// Filters that have names; each of those that are on must hold, too.
    pub fn kept(&self) -> &[KeptFilter] {
        &self.kept
    }

    /// Everything together, as the daemon gets it, without what cannot be asked of this scene.
    pub fn whole(&self) -> &FilterText {
        &self.whole
    }

    /// Takes over filters that were kept before; those of the same names are replaced.
    pub fn keep_all(&mut self, kept: &[KeptFilter]) {
        self.kept = kept.to_vec();
        self.refit();
    }

    /// Leaves out, from now on, what cannot be asked of this scene, and nothing where none is known.
    /// What is left out stays as it was written, and holds again on a scene that has what it names.
    pub fn fit(&mut self, scene: Option<Arc<FilterScene>>) {
        self.scene = scene;
        self.refit();
    }

    fn refit(&mut self) {
        let scene = self.scene.as_deref();
        self.text.fit(scene);
        self.kept.iter_mut().for_each(|kept| kept.part.fit(scene));
        self.put_together();
    }

    /// Follows a command.
    pub fn apply(&mut self, command: &FilterCommand) {
        match command {
            FilterCommand::Set(text) => self.set(text.clone()),
            FilterCommand::Clear => self.clear(),
            FilterCommand::Enable(switch) => {
                let mut on = !self.off;
                switch.apply(&mut on);
                self.off = !on;
            }
            FilterCommand::Invert(switch) => switch.apply(&mut self.inverted),
            FilterCommand::Add(sphere) => {
                if self.selectors.len() < MOST_SELECTORS as usize {
                    self.selectors.push(*sphere);
                    self.chosen = Some(self.selectors.len() - 1);
                }
            }
            FilterCommand::Move(number, place) => {
                if let Some(sphere) = self.selectors.get_mut(*number as usize) {
                    sphere.place = *place;
                }
            }
            FilterCommand::Choose(number) => {
                let number = *number as usize;
                self.chosen = (number < self.selectors.len()).then_some(number);
            }
            FilterCommand::Delete(number) => {
                if (*number as usize) < self.selectors.len() {
                    self.selectors.remove(*number as usize);
                    self.chosen = None;
                }
            }
            FilterCommand::DeleteAll => {
                self.selectors.clear();
                self.chosen = None;
            }
            FilterCommand::Keep(name) => self.keep(name),
            FilterCommand::Use(switch, name) => {
                self.named(name).into_iter().for_each(|kept| switch.apply(&mut kept.on));
            }
            FilterCommand::Reverse(switch, name) => {
                self.named(name).into_iter().for_each(|kept| switch.apply(&mut kept.inverted));
            }
            FilterCommand::Load(name) => self.load(name),
            FilterCommand::Forget(name) => self.kept.retain(|kept| kept.name != *name),
        }
        self.put_together();
    }

    fn set(&mut self, text: FilterText) {
        self.text = Part::new(text, self.scene.as_deref());
    }

    /// Asks for all paths; kept filters stay, switched off.
    fn clear(&mut self) {
        let (mut kept, scene) = (std::mem::take(&mut self.kept), self.scene.take());
        for kept in &mut kept {
            kept.on = false;
        }
        *self = Self { kept, scene, ..Self::default() };
    }

    /// The kept filter of this name.
    fn named(&mut self, name: &str) -> Option<&mut KeptFilter> {
        self.kept.iter_mut().find(|kept| kept.name == name)
    }

    /// Keeps text and selectors under a name, in the place of what had it before.
    fn keep(&mut self, name: &str) {
        let text = match self.own(&self.text.text) {
            Some(own) => FilterText::from(&own),
            None => self.text.text.clone(),
        };
        let mut kept = KeptFilter::new(name.to_owned(), text, self.inverted);
        kept.part.fit(self.scene.as_deref());
        let has_room = self.kept.len() < MOST_KEPT;
        match self.named(name) {
            Some(known) => *known = kept,
            None if has_room => self.kept.push(kept),
            None => {}
        }
    }

    /// Loads a kept filter into the text, replacing text and selectors.
    fn load(&mut self, name: &str) {
        let Some(kept) = self.named(name) else { return };
        // It would hold twice.
        kept.on = false;
        let KeptFilter { part, inverted, .. } = kept.clone();
        let (kept, scene) = (std::mem::take(&mut self.kept), self.scene.take());
        *self = Self { text: part, inverted, kept, scene, ..Self::default() };
    }

    /// The selectors together with a text; `None` where that cannot be read.
    fn own(&self, text: &FilterText) -> Option<Filter> {
        let selectors: Vec<_> = self.selectors.iter().map(|sphere| sphere.selector()).collect();
        let text = text.tree().ok()?.clone();
        Some(Filter::all_of(vec![Filter::from_selectors(&selectors), text]))
    }

    /// Reassembles the whole filter.
    fn put_together(&mut self) {
        self.whole = if self.off {
            FilterText::default()
        } else {
            let own = self.own_here().map(|own| opposite_if(self.inverted, own));
            let kept =
                self.kept_here().map(|(_, kept, tree)| opposite_if(kept.inverted, tree.clone()));
            FilterText::from(&Filter::all_of(own.into_iter().chain(kept).collect()))
        };
    }

    /// Text and selectors as far as they can be asked of this scene. Where only the selectors can, their
    /// opposite would be another filter than was meant.
    fn own_here(&self) -> Option<Filter> {
        match (self.text.tree(), self.inverted) {
            (Some(_), _) => self.own(&self.text.text),
            (None, true) => None,
            (None, false) => self.own(&FilterText::default()),
        }
    }

    /// The kept filters that are on and can be asked of this scene, with their numbers.
    fn kept_here(&self) -> impl Iterator<Item = (usize, &KeptFilter, &Filter)> {
        let on = self.kept.iter().enumerate().filter(|(_, kept)| kept.on);
        on.filter_map(|(number, kept)| Some((number, kept, kept.part.tree()?)))
    }

    /// Where the condition of this number, as the daemon counts them, was written.
    pub fn source(&self, condition: usize) -> Option<FilterSource> {
        let mut left = condition;
        let own = self.own_here().is_some();
        for kind in SelectorKind::ALL.into_iter().filter(|_| own) {
            let of_kind = self.selectors.iter().enumerate().filter(|(_, s)| s.kind == kind);
            for (number, _) in of_kind {
                match left.checked_sub(1) {
                    Some(fewer) => left = fewer,
                    None => return Some(FilterSource::Sphere(number)),
                }
            }
        }
        let count = |filter: &Filter| filter.leaves().len();
        let own = self.text.tree().filter(|_| own).map_or(0, count);
        if left < own {
            return Some(FilterSource::Text(left));
        }
        left -= own;
        for (number, _, tree) in self.kept_here() {
            let conditions = count(tree);
            if left < conditions {
                return Some(FilterSource::Kept(number));
            }
            left -= conditions;
        }
        None
    }
}

/// The filter or, where `inverted` and it leaves out something, its opposite.
fn opposite_if(inverted: bool, filter: Filter) -> Filter {
    if inverted && filter != Filter::Constant(true) {
        Filter::Not(Box::new(filter))
    } else {
        filter
    }
}

#[cfg(test)]
mod tests {
    use common::{FilterMaterial, SceneFrame};
    use glam::DVec3;

    use super::*;
    use crate::value::Switch;

    fn set(text: &str) -> FilterCommand {
        FilterCommand::Set(FilterText::read(text))
    }

    fn sphere(kind: SelectorKind) -> FilterCommand {
        FilterCommand::Add(Sphere { kind, place: [0.0, 0.0, 0.0, 1.0] })
    }

    /// A scene whose materials have these names.
    fn scene(materials: &[&str]) -> Arc<FilterScene> {
        Arc::new(FilterScene {
            frame: SceneFrame { centre: DVec3::ZERO, scale: 1.0, light: 1.0 },
            materials: materials.iter().copied().map(FilterMaterial::from).collect(),
            strategies: Vec::new(),
            objects: Vec::new(),
        })
    }

    #[test]
    fn the_source_of_every_condition_is_known() {
        let mut settings = FilterSettings::default();
        for command in [
            sphere(SelectorKind::Any),
            sphere(SelectorKind::Start),
            set("edges == 2 or dwell > 3"),
            FilterCommand::Keep("mine".to_owned()),
            set("chain == 1"),
            FilterCommand::Use(Switch::On, "mine".to_owned()),
        ] {
            settings.apply(&command);
        }
        let whole = settings.whole().tree().expect("our own");
        let sources: Vec<_> = (0..whole.leaves().len()).map(|i| settings.source(i)).collect();
        use FilterSource::{Kept, Sphere as Ball, Text};
        let kept = [Kept(0); 4].map(Some);
        let expected = [[Some(Ball(1)), Some(Ball(0)), Some(Text(0))].as_slice(), &kept].concat();
        assert_eq!(sources, expected, "starts come before others: {whole}");
        assert_eq!(settings.source(7), None, "there are no more");
    }

    #[test]
    fn a_filter_that_another_scene_cannot_read_is_kept_marked_and_left_out() {
        let mut settings = FilterSettings::default();
        settings.fit(Some(scene(&["glass", "wall"])));
        let kept = FilterCommand::Keep("walls".to_owned());
        let used = FilterCommand::Use(Switch::On, "walls".to_owned());
        for command in [set("any on material wall"), kept, used, set("any on material glass")] {
            settings.apply(&command);
        }
        let both = "any on material \"glass\" and any on material \"wall\"";
        assert_eq!(settings.whole().text(), both, "on the first scene");
        assert!(settings.complaint().is_none(), "which has all of it");
        let before = settings.clone();
        settings.fit(Some(scene(&["wood", "wall"])));
        assert_eq!(settings, before, "nothing is forgotten");
        assert_eq!(settings.whole().text(), "any on material \"wall\"", "the other one holds");
        let complaint = settings.complaint().expect("a mark");
        assert!(complaint.message.contains("no material \"glass\""), "{complaint}");
        assert_eq!(
            settings.source(0),
            Some(FilterSource::Kept(0)),
            "what is left out is not counted"
        );
        settings.fit(Some(scene(&["wood"])));
        assert!(settings.whole().wants_all(), "nothing can be asked here");
        assert!(settings.kept()[0].complaint().is_some(), "both are marked");
        settings.apply(&sphere(SelectorKind::Any));
        assert_eq!(settings.whole().text(), "any in sphere(0, 0, 0, 1)", "spheres hold anywhere");
        settings.apply(&FilterCommand::Invert(Switch::On));
        assert!(settings.whole().wants_all(), "half of it has no opposite");
        settings.apply(&FilterCommand::Invert(Switch::Off));
        settings.apply(&FilterCommand::DeleteAll);
        settings.fit(Some(scene(&["wall", "glass"])));
        assert_eq!(settings.whole().text(), both, "and it holds again");
        settings.fit(None);
        assert_eq!(settings.whole().text(), both, "as long as no scene is known, too");
    }

    #[test]
    fn a_kept_filter_that_nobody_can_read_is_kept_as_it_is() {
        let mut settings = FilterSettings::default();
        let text = FilterText::read("any near sphere(0, 0, 0, 1)");
        settings.keep_all(&[KeptFilter::new("newer".to_owned(), text.clone(), false)]);
        settings.apply(&FilterCommand::Use(Switch::On, "newer".to_owned()));
        assert!(settings.whole().wants_all(), "it asks for nothing");
        assert!(settings.kept()[0].complaint().is_some(), "and is marked");
        settings.apply(&FilterCommand::Load("newer".to_owned()));
        assert_eq!(settings.text(), &text, "it can be mended");
        assert!(
            settings.complaint().is_some() && settings.whole().wants_all(),
            "until then: marked"
        );
        settings.apply(&FilterCommand::Keep("again".to_owned()));
        assert_eq!(settings.kept()[1].text(), &text, "as it was written");
    }
}
