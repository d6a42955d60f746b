//! The vocabulary that every room of Lvis shares: what a path, a step, a batch and a film tile are.
//!
//! This crate knows nothing of the network, the GPU or any file format. Conversions to and from
//! those live with the library that needs them.

mod batch;
mod camera;
mod color;
mod detail;
mod diagnostics;
mod event;
mod filter;
mod id;
mod mesh;
mod message;
mod metric;
mod session;
mod steering;

pub use batch::{
    BatchBuilder, BatchError, BatchLimits, BatchOrigin, Completed, Kept, MAX_VERTICES,
    NORMAL_SCALE, PathBatch, PathColumns, PathHeader, PathReader, PathView, THROUGHPUT_UNKNOWN,
    VertexColumns, VertexRecord, decode_normal, decode_throughput, encode_normal,
    encode_throughput,
};
pub use camera::{Camera, CameraError, CameraPose};
pub use color::Rgb;
pub use detail::{DetailReply, PathDetail, VertexDetail};
pub use diagnostics::{Diagnostics, TileGrid, TileMaps, UNKNOWN};
pub use event::{Event, VertexKind};
pub use filter::condition;
pub use filter::{
    Choice, CompiledFilter, Completion, Described, FilmCondition, Filter, FilterCounts,
    FilterError, FilterMaterial, FilterObject, FilterScene, FilterTally, FilterText, Form, Leaf,
    LightPathExpression, MAX_FILTER_BYTES, MAX_LEAVES, Name, NameList, NearestMiss, NumberPart,
    Place, Proposal, Selector, SelectorKind, Shortfall, Spot, Stop, Tree, Unit, VertexCheck,
    VertexTest, Volume, Walk, Word, Worded, complete, is_same_strategy,
};
pub use id::{ChainId, MaterialId, NoPathId, PathId, StrategyId};
pub use mesh::{MaterialInfo, SceneFrame, SceneMesh, TexturePreview};
pub use message::TracerEvent;
pub use metric::{Floor, known, mean_of_smallest, mean_ratio, relative_errors, relative_mse};
pub use session::{
    ChainTotals, FailureCount, FilmFrame, FilmTile, FilterReply, Gap, Queue, Role, Statistics,
    StrategyStatistics, Welcome,
};
pub use steering::{
    Appearance, Attendee, Author, ChainCommand, ChainState, ExplorerCommand, ExplorerState,
    FocusOutcome, FocusPath, FocusStep, Gaze, LEAST_PRECISION, LeaseEvent, LeaseNotice,
    LeaseRequest, MAX_FAN, MAX_RATE, MAX_STEPS, MAX_WEIGHT, MIN_RATE, MOST_PRECISION, Notice,
    Order, OrderReply, Pace, Presence, RatioFactors, Seed, SkipTo, StrategySet,
};
