//! The wire: schema, generated types, and checked conversions to and from the vocabulary.
//!
//! Wire types stop here. A program reads a [`v1::TracerMessage`] or [`v1::ViewerMessage`] and at once
//! makes a [`common::TracerEvent`] or [`ViewerEvent`] of it; in those, sizes, counts, numbers and texts have
//! been checked. This crate knows no socket and neither program.

// A new variant must be looked at wherever variants are told apart; tests may leave out what they do
// not mean.
#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]

mod convert;
mod fingerprint;

pub use convert::{
    Hello, MAX_MESSAGE_BYTES, NumberedOrder, ReceivedScene, SceneAssembler, ViewerEvent,
    WantedFilter, WireError, scene_chunks, unchanged_scene,
};

pub use fingerprint::Fingerprint;

/// The generated types, clients and servers of package `lvis.v1`.
#[allow(
    clippy::all,
    clippy::allow_attributes,
    clippy::nursery,
    clippy::pedantic,
    clippy::restriction,
    missing_docs,
    unnameable_types,
    unreachable_pub,
    unused_qualifications,
    reason = "generated code"
)]
pub mod v1 {
    tonic::include_proto!("lvis.v1");
}

/// The schema as an encoded `google.protobuf.FileDescriptorSet`, for the reflection service.
pub const FILE_DESCRIPTOR_SET: &[u8] =
    include_bytes!(concat!(env!("OUT_DIR"), "/lvis.v1.descriptors.bin"));

/// A version of the protocol.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ProtocolVersion {
    /// Peers of different majors do not understand each other.
    pub major: u32,
    /// Minors of one major only add.
    pub minor: u32,
}

impl ProtocolVersion {
    /// What this crate speaks.
    pub const CURRENT: Self = Self { major: 1, minor: 4 };
}

impl std::fmt::Display for ProtocolVersion {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}.{}", self.major, self.minor)
    }
}
