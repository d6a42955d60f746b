//! The contents of the table of a path's vertices, before it is drawn.

use common::Rgb;

use crate::source::dump::DumpPath;
use crate::source::selection::{Names, Selection};
use crate::value::format;

/// A path with what its vertices are called.
#[derive(Clone, Copy, Debug)]
pub(super) struct Described<'a> {
    pub(super) selection: &'a Selection,
    pub(super) names: &'a Names<'a>,
    /// Its record, where it is one of a file of paths.
    pub(super) record: Option<&'a DumpPath>,
}

/// A label, its value, and what that is.
pub(super) type Line = (&'static str, String, &'static str);

/// Numbers of all vertices.
#[derive(Debug)]
pub(super) struct Table {
    /// Tells it from other tables.
    pub(super) name: &'static str,
    pub(super) columns: Vec<Column>,
}

/// A number of every vertex.
#[derive(Debug)]
pub(super) struct Column {
    pub(super) title: &'static str,
    /// What it means.
    pub(super) tip: String,
    /// From the light on.
    pub(super) values: Vec<String>,
}

impl Column {
    pub(super) fn new(
        title: &'static str,
        tip: impl Into<String>,
        values: impl Iterator<Item = String>,
    ) -> Self {
        Self { title, tip: tip.into(), values: values.collect() }
    }
}

/// Red, green, blue.
pub(super) fn color(rgb: Rgb) -> String {
    [rgb.r, rgb.g, rgb.b].map(format::exact).join("  ")
}
