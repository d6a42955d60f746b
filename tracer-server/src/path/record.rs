//! A path as it travels.

use common::{VertexRecord, encode_normal};

use super::{Path, Vertex};

impl Vertex {
    /// The vertex rounded to what travels.
    pub fn record(&self) -> VertexRecord {
        VertexRecord {
            position: self.position.as_vec3().to_array(),
            normal: encode_normal(self.normal.as_vec3()),
            kind: self.kind,
            event: self.event,
            material: self.material,
            primitive: self.primitive,
        }
    }
}

impl Path {
    /// Replaces the contents of `out` by all vertices, the light first.
    pub fn record_into(&self, out: &mut Vec<VertexRecord>) {
        out.clear();
        out.extend(self.vertices().iter().map(Vertex::record));
    }
}
