//! The XML document: elements with their places, `$name` defaults, references, and a record of
//! what was read, so that all the rest can be told. The only file that names roxmltree, beside
//! `include`.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use roxmltree::{Document, Node, NodeId};

use super::include::Text;
use crate::scene::reading::diagnostic::{LoadError, Place, Warning};

/// How many unread elements are reported one by one.
const MAX_TOLD: usize = 50;
/// The most names that a message lists.
const MAX_NAMES: usize = 30;

/// Elements that bear on how long a picture takes or how its file looks, and on nothing else.
const HARMLESS_TAGS: &[&str] = &["default", "alias", "sampler", "mode", "path"];
/// Parameters of that kind, in snake case.
const HARMLESS_NAMES: &[&str] = &[
    "attach_log",
    "banner",
    "component_format",
    "exposure",
    "file_format",
    "filename",
    "gamma",
    "high_quality_edges",
    "key",
    "label",
    "pixel_format",
    "sample_border",
    "sampling_weight",
    "shutter_close",
    "shutter_open",
    "tonemap_method",
];

/// A parsed scene file.
#[derive(Debug)]
pub(super) struct Source<'a> {
    text: &'a Text,
    document: Document<'a>,
    defaults: BTreeMap<String, String>,
    /// Elements with an `id`, by node index.
    ids: BTreeMap<String, u32>,
    /// Indices of the nodes that were read.
    used: RefCell<BTreeSet<u32>>,
}

/// An element of a scene file.
#[derive(Clone, Copy, Debug)]
pub(super) struct Element<'a> {
    source: &'a Source<'a>,
    node: Node<'a, 'a>,
}

impl<'a> Source<'a> {
    /// Parses a document.
    pub(super) fn parse(text: &'a Text) -> Result<Self, LoadError> {
        let source = Self {
            text,
            document: text.document()?,
            defaults: BTreeMap::new(),
            ids: BTreeMap::new(),
            used: RefCell::default(),
        };
        source.with_names()
    }

    /// Gathers what `$name` and `ref` may mean.
    fn with_names(mut self) -> Result<Self, LoadError> {
        let (mut defaults, mut ids) = (BTreeMap::new(), BTreeMap::new());
        for node in self.document.root_element().descendants().filter(Node::is_element) {
            let place = || self.place(&node);
            let attribute = |name| node.attribute(name);
            match node.tag_name().name() {
                "default" => {
                    let (Some(name), Some(value)) = (attribute("name"), attribute("value")) else {
                        return Err(place().error("`<default>` needs a name and a value"));
                    };
                    // It may use those before it.
                    let value = substitute(&defaults, value).map_err(|m| place().error(m))?;
                    defaults.entry(name.to_owned()).or_insert(value);
                }
                "ref" => {}
                _ => {
                    let Some(id) = attribute("id") else { continue };
                    if let Some(before) = ids.insert(id.to_owned(), node.id().get()) {
                        let line = self.at(before).map(|node| self.place(&node).to_string());
                        let line = line.unwrap_or_default();
                        let message = format!(
                            "the id `{id}` is already used by the element at {line}; \
                                rename one of them"
                        );
                        return Err(place().error(message));
                    }
                }
            }
        }
        for node in self.document.root_element().children().filter(|n| n.has_tag_name("alias")) {
            if let (Some(id), Some(name)) = (node.attribute("id"), node.attribute("as"))
                && let Some(&target) = ids.get(id)
            {
                ids.insert(name.to_owned(), target);
            }
        }
        (self.defaults, self.ids) = (defaults, ids);
        Ok(self)
    }

    /// The outermost element.
    pub(super) fn root(&'a self) -> Element<'a> {
        Element { source: self, node: self.document.root_element() }
    }

    fn at(&self, index: u32) -> Option<Node<'_, '_>> {
        self.document.get_node(NodeId::new(index))
    }

    fn place(&self, node: &Node<'_, '_>) -> Place {
        self.text.place(node.range().start)
    }

    /// One warning for each element that nobody read though its parent was.
    pub(super) fn unread(&self) -> Vec<Warning> {
        let used = self.used.borrow();
        let is_used = |node: &Node<'_, '_>| used.contains(&node.id().get());
        let mut warnings = Vec::new();
        let mut more = 0;
        for node in self.document.root_element().descendants().filter(Node::is_element) {
            let orphan = node.parent_element().is_some_and(|parent| is_used(&parent));
            if !orphan || is_used(&node) || is_harmless(&node) {
                continue;
            }
            if warnings.len() == MAX_TOLD {
                more += 1;
                continue;
            }
            let parent = node.parent_element().map_or_else(String::new, |p| name_of(&p));
            let message = format!("{} in {parent} is ignored", name_of(&node));
            warnings.push(self.place(&node).warning(message));
        }
        if more > 0 {
            let message = format!("{more} more elements are ignored");
            warnings.push(self.text.place(0).warning(message));
        }
        warnings
    }
}

/// Puts the values of defaults in the place of `$name`.
fn substitute(defaults: &BTreeMap<String, String>, text: &str) -> Result<String, String> {
    let mut out = String::new();
    let mut pieces = text.split('$');
    out.push_str(pieces.next().unwrap_or_default());
    for piece in pieces {
        let ends = |c: char| !(c.is_ascii_alphanumeric() || c == '_');
        let (name, rest) = piece.split_at(piece.find(ends).unwrap_or(piece.len()));
        let Some(value) = defaults.get(name) else {
            let known = listed(defaults.keys());
            return Err(format!(
                "`${name}` has no value: add `<default name=\"{name}\" value=\"...\"/>` before it; \
                 defined names: {known}"
            ));
        };
        out.push_str(value);
        out.push_str(rest);
    }
    Ok(out)
}

/// True where not to model an element leaves the picture as it is.
fn is_harmless(node: &Node<'_, '_>) -> bool {
    let tag = node.tag_name().name();
    let name = node.attribute("name").map(snake_case);
    let parent = node.parent_element();
    let within = |tag: &str| parent.is_some_and(|parent| parent.has_tag_name(tag));
    // A definition that nothing refers to, and what only tells how an integrator samples.
    let unused = within("scene") && matches!(tag, "bsdf" | "texture");
    let how = within("integrator") && name.as_deref() != Some("hide_emitters");
    let of_film = tag == "string" || tag == "boolean" || tag == "float";
    HARMLESS_TAGS.contains(&tag)
        || unused
        || how
        || of_film && name.is_some_and(|name| HARMLESS_NAMES.contains(&name.as_str()))
}

/// `<float name="fov">`, for people.
fn name_of(node: &Node<'_, '_>) -> String {
    let tag = node.tag_name().name();
    for key in ["name", "type", "id"] {
        if let Some(value) = node.attribute(key) {
            return format!("`<{tag} {key}=\"{}\">`", shorten(value));
        }
    }
    format!("`<{tag}>`")
}

/// The first characters of a value that may be anything.
pub(super) fn shorten(value: &str) -> String {
    value.chars().filter(|c| !c.is_control()).take(40).collect()
}

/// Names for a message.
pub(super) fn listed<T: AsRef<str>>(names: impl IntoIterator<Item = T>) -> String {
    let mut names = names.into_iter();
    let mut list: Vec<String> =
        names.by_ref().take(MAX_NAMES).map(|name| shorten(name.as_ref())).collect();
    if names.next().is_some() {
        list.push("...".to_owned());
    }
    if list.is_empty() { "none".to_owned() } else { list.join(", ") }
}

/// `toWorld` and `to_world` are one name in two versions of the format, and so are `intIOR` and
/// `int_ior`.
fn snake_case(name: &str) -> String {
    let mut out = String::new();
    let mut lower = false;
    for c in name.chars() {
        if c.is_uppercase() && lower {
            out.push('_');
        }
        lower = c.is_lowercase() || c.is_ascii_digit();
        out.extend(c.to_lowercase());
    }
    out
}

impl<'a> Element<'a> {
    /// Its tag.
    pub(super) fn tag(&self) -> &'a str {
        self.node.tag_name().name()
    }

    /// A number that tells it from all others of its document.
    pub(super) fn index(&self) -> u32 {
        self.node.id().get()
    }

    /// Where it begins.
    pub(super) fn place(&self) -> Place {
        self.source.place(&self.node)
    }

    /// A file that it names, beside the scene file or where its `<path>`s lead.
    pub(super) fn file(&self, name: &str) -> PathBuf {
        self.source.text.find(name)
    }

    /// An error at this element, which the message names.
    pub(super) fn error(&self, message: impl AsRef<str>) -> LoadError {
        self.place().error(format!("{}: {}", name_of(&self.node), message.as_ref()))
    }

    /// A warning at this element, which the message names.
    pub(super) fn warning(&self, message: impl AsRef<str>) -> Warning {
        self.place().warning(format!("{}: {}", name_of(&self.node), message.as_ref()))
    }

    /// True in a scene of version 0, in which some elements mean something else.
    pub(super) fn is_of_old(&self) -> bool {
        let version = self.source.document.root_element().attribute("version");
        version.is_some_and(|version| version.starts_with("0."))
    }

    /// Remembers that it was read.
    pub(super) fn read(self) -> Self {
        self.source.used.borrow_mut().insert(self.index());
        self
    }

    /// An attribute with its `$name`s replaced.
    pub(super) fn attribute(&self, name: &str) -> Result<Option<String>, LoadError> {
        let value = self.node.attribute(name).map(|text| substitute(&self.source.defaults, text));
        value.transpose().map_err(|message| self.error(message))
    }

    /// An attribute that must be there.
    pub(super) fn needed(&self, name: &str) -> Result<String, LoadError> {
        self.attribute(name)?
            .ok_or_else(|| self.error(format!("the attribute `{name}` is missing")))
    }

    /// The plugin that it asks for, such as `diffuse`.
    pub(super) fn plugin(&self) -> Result<String, LoadError> {
        self.needed("type")
    }

    /// Its id, or else what it is and where.
    pub(super) fn label(&self) -> String {
        let kind = self.node.attribute("type").unwrap_or_else(|| self.tag());
        let line = self.place().line.unwrap_or(0);
        self.node.attribute("id").map_or_else(|| format!("{kind}:{line}"), str::to_owned)
    }

    /// True when it has an id.
    pub(super) fn is_named(&self) -> bool {
        self.node.attribute("id").is_some()
    }

    /// The first element within it that has this tag.
    pub(super) fn find(&self, tag: &str) -> Option<Self> {
        let found = self.node.descendants().find(|node| node.has_tag_name(tag));
        found.map(|node| Self { source: self.source, node })
    }

    /// Its children.
    pub(super) fn children(&self) -> impl Iterator<Item = Self> + use<'a> {
        let source = self.source;
        self.node.children().filter(Node::is_element).map(move |node| Self { source, node })
    }

    /// The first child with this name in snake case, marked as read; a reference is followed.
    pub(super) fn property(&self, name: &str) -> Result<Option<Self>, LoadError> {
        let named = |child: &Self| child.node.attribute("name").map(snake_case);
        let found = self.children().find(|child| named(child).as_deref() == Some(name));
        found.map(Self::resolve).transpose()
    }

    /// The children with this tag, and what references point to such elements, marked as read.
    pub(super) fn objects(&self, tag: &str) -> Result<Vec<Self>, LoadError> {
        let mut objects = Vec::new();
        for child in self.children() {
            let is_ref = child.tag() == "ref";
            if !is_ref && child.tag() != tag {
                continue;
            }
            if !is_ref || child.target()?.tag() == tag {
                objects.push(child.resolve()?);
            }
        }
        Ok(objects)
    }

    /// What a reference points to, marked as read like itself; any other element is its own target.
    fn resolve(self) -> Result<Self, LoadError> {
        Ok(self.read().target()?.read())
    }

    fn target(self) -> Result<Self, LoadError> {
        if self.tag() != "ref" {
            return Ok(self);
        }
        let id = self.needed("id")?;
        let found = self.source.ids.get(&id).and_then(|&index| self.source.at(index));
        let node = found.ok_or_else(|| {
            let known = listed(self.source.ids.keys());
            self.error(format!("no element has the id `{id}`; the ids are {known}"))
        })?;
        Ok(Self { source: self.source, node })
    }
}
