//! Classes of paths, such as `LSSDE`, in the order in which they first came.

use common::VertexRecord;

/// Classes that have a number of their own; all later ones share the next.
const MOST: usize = 15;

/// The classes seen so far.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Classes {
    names: Vec<String>,
}

impl Classes {
    /// The number of the class of a path; classes that came too late share one.
    pub fn number(&mut self, vertices: &[VertexRecord]) -> u8 {
        let same = |name: &String| name.chars().eq(vertices.iter().map(|v| v.kind.letter()));
        let found = self.names.iter().position(same);
        let number = found.unwrap_or_else(|| {
            if self.names.len() < MOST {
                self.names.push(class_name(vertices));
                self.names.len() - 1
            } else {
                MOST
            }
        });
        number as u8
    }

    /// The classes, each at the place of its number.
    pub fn names(&self) -> &[String] {
        &self.names
    }
}

/// The class of a path in Heckbert's letters, from the light to the lens [Heckbert 1990].
pub fn class_name(vertices: &[VertexRecord]) -> String {
    vertices.iter().map(|v| v.kind.letter()).collect()
}
