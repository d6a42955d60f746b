//! What a viewer is sent of what its filter wants: exact paths, exact counts, fair weights.

use std::time::Duration;

use common::{
    BatchBuilder, BatchLimits, ChainId, Event, Filter, FilterMaterial, FilterScene, Kept,
    PathHeader, PathId, SceneFrame, VertexKind, VertexRecord,
};
use proptest::prelude::*;

use super::tests::{delivered, running_hub};
use super::*;

/// One path as it was published: its header and its vertices.
type Published = (PathHeader, Vec<VertexRecord>);

/// A chain's random walk over paths of two to seven vertices, each step keeping a part at both ends.
struct Walk {
    random: u64,
    paths: Vec<Vec<VertexRecord>>,
    step: u64,
}

impl Walk {
    fn new(chains: usize, seed: u64) -> Self {
        Self { random: seed | 1, paths: vec![Vec::new(); chains], step: 0 }
    }

    fn below(&mut self, limit: usize) -> usize {
        self.random ^= self.random << 13;
        self.random ^= self.random >> 7;
        self.random ^= self.random << 17;
        (self.random >> 33) as usize % limit
    }

    fn vertex(&mut self) -> VertexRecord {
        let primitive = self.below(1 << 30) as u32;
        VertexRecord {
            position: [primitive as f32, 0.0, 1.0],
            normal: [0, 0],
            kind: VertexKind::Diffuse,
            event: Event::Diffuse,
            material: (primitive % 2) as u16,
            primitive,
        }
    }

    /// A batch of `count` paths, with what is in it.
    fn batch(&mut self, count: usize) -> (PathBatch, Vec<Published>) {
        let mut builder = BatchBuilder::new(BatchLimits { bytes: usize::MAX });
        let mut published = Vec::new();
        let mut begun = vec![false; self.paths.len()];
        for _ in 0..count {
            let chain = self.below(self.paths.len());
            let length = self.paths[chain].len();
            let light = self.below(length.min(3) + 1);
            let eye = self.below((length - light).min(3) + 1);
            let inserted = (self.below(3) + 1).max(2_usize.saturating_sub(light + eye));
            let fresh: Vec<_> = (0..inserted).map(|_| self.vertex()).collect();
            self.paths[chain].splice(light..length - eye, fresh);
            self.step += 1;
            let id = PathId { chain: ChainId(chain as u32), epoch: 0, step: self.step };
            let weight = [0.0, 1.0, 1.0, 3.0, 40.0][self.below(5)];
            let header = PathHeader { id, weight, ..PathHeader::default() };
            let kept = begun[chain].then_some(Kept { light, eye });
            begun[chain] = true;
            drop(builder.push(&header, &self.paths[chain], kept));
            published.push((header, self.paths[chain].clone()));
        }
        (builder.finish().expect("there are paths"), published)
    }
}

fn compiled(text: &str) -> Arc<CompiledFilter> {
    let scene = FilterScene {
        frame: SceneFrame { centre: glam::DVec3::ZERO, scale: 1.0, light: 1.0 },
        materials: ["even", "odd"].map(FilterMaterial::from).to_vec(),
        strategies: Vec::new(),
        objects: Vec::new(),
    };
    Arc::new(Filter::parse(text).and_then(|filter| filter.compile(&scene)).expect("a filter"))
}

/// What a viewer got, put together.
#[derive(Debug, Default)]
struct Received {
    paths: Vec<(PathHeader, Vec<VertexRecord>)>,
    origins: Vec<common::BatchOrigin>,
    gap: Gap,
    /// The number of the next batch of the hub that nothing was heard of.
    next: u64,
}

impl Received {
    fn receive(&mut self, deliveries: Vec<TracerEvent>) {
        for delivery in deliveries {
            match delivery {
                TracerEvent::Paths(batch) => self.take_batch(&batch),
                TracerEvent::Gap(gap) => {
                    self.next += gap.batches;
                    self.gap.batches += gap.batches;
                    self.gap.paths += gap.paths;
                }
                _ => {}
            }
        }
    }

    fn take_batch(&mut self, batch: &PathBatch) {
        let origin = *batch.origin();
        assert!(origin.source_batches > 0, "a batch is behind it: {origin:?}");
        self.next += u64::from(origin.source_batches);
        assert_eq!(batch.sequence() + 1, self.next, "no batch is lost or repeated: {origin:?}");
        self.origins.push(origin);
        // As a receiver reads it: alone, and from columns that it checks.
        let (paths, vertices) = (batch.paths().clone(), batch.vertices().clone());
        let read = PathBatch::from_columns(0, paths, vertices).expect("sound columns");
        let mut reader = read.reader();
        while let Some(path) = reader.next() {
            self.paths.push((path.header, path.vertices.to_vec()));
        }
    }

    fn sum(&self, of: impl Fn(&common::BatchOrigin) -> f64) -> f64 {
        self.origins.iter().map(of).sum()
    }
}

fn block_on<F: Future>(future: F) -> F::Output {
    let mut builder = tokio::runtime::Builder::new_current_thread();
    let runtime = builder.enable_time().start_paused(true).build().expect("a runtime");
    runtime.block_on(future)
}

/// Longer than a batch waits to become full.
const LONG: Duration = Duration::from_millis(200);

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Filters that change between any batches: every path that the filter of its time wants
    /// arrives, whole and once, and the counts are those of a count by hand.
    #[test]
    fn wanted_paths_arrive_exactly_whatever_the_filter_does(
        seed in any::<u64>(),
        sizes in prop::collection::vec((1..60_usize, any::<bool>(), any::<bool>()), 1..12),
    ) {
        block_on(async {
            let (hub, _tasks) = running_hub(HubLimits::default());
            let viewer = hub.subscribe(1 << 30).expect("a viewer");
            let texts = ["edges >= 3", "any on material even", "not all on material odd", "true"];
            let mut walk = Walk::new(3, seed);
            let (mut received, mut expected) = (Received::default(), Vec::new());
            let (mut filter, mut revision) = (compiled("true"), 0);
            let (mut seen, mut matched) = (0_u64, 0_u64);
            for (count, changes, reads) in sizes {
                if changes {
                    // What was published is looked at before the filter changes.
                    received.receive(delivered(&viewer).await);
                    revision += 1;
                    filter = compiled(texts[revision as usize % texts.len()]);
                    viewer.set_filter(revision, Arc::clone(&filter));
                    (seen, matched) = (0, 0);
                }
                let (batch, published) = walk.batch(count);
                hub.publish_paths(batch);
                for (header, path) in published {
                    seen += 1;
                    if filter.matches(&header, &path) {
                        matched += 1;
                        expected.push((header, path));
                    }
                }
                if reads {
                    tokio::time::sleep(LONG).await;
                    received.receive(delivered(&viewer).await);
                }
            }
            received.receive(delivered(&viewer).await);
            tokio::time::sleep(LONG).await;
            received.receive(delivered(&viewer).await);
            assert_eq!(received.paths, expected, "every wanted path, whole and once");
            assert_eq!(received.gap, Gap::default(), "nothing is missing");
            let last: Vec<_> = received.origins.iter().filter(|o| o.revision == revision).collect();
            assert_eq!(last.iter().map(|o| o.seen).sum::<u64>(), seen, "paths seen");
            assert_eq!(last.iter().map(|o| o.matched).sum::<u64>(), matched, "paths wanted");
            let counts = viewer.lane.population().counts();
            assert_eq!((counts.seen, counts.matched), (seen, matched), "the tally agrees");
        });
    }
}

/// A tenth of the budget that would be needed: every path is accounted for, what arrives is exact,
/// and the weights stand for all that was wanted.
#[tokio::test(start_paused = true)]
async fn a_budget_decimates_and_accounts_for_every_path() {
    let (hub, _tasks) = running_hub(HubLimits::default());
    let budget = 100_000;
    let viewer = hub.subscribe(budget).expect("a viewer");
    viewer.set_filter(1, compiled("any on material even"));
    let mut walk = Walk::new(5, 99);
    let mut received = Received::default();
    let mut published = std::collections::BTreeMap::new();
    let start = Instant::now();
    for _ in 0..2000 {
        let (batch, paths) = walk.batch(100);
        published.extend(paths.into_iter().map(|(header, path)| (header.id, path)));
        hub.publish_paths(batch);
        tokio::time::sleep(Duration::from_millis(9)).await;
        received.receive(delivered(&viewer).await);
    }
    let seconds = start.elapsed().as_secs_f64();
    for _ in 0..20 {
        tokio::time::sleep(LONG).await;
        received.receive(delivered(&viewer).await);
    }
    let seen = received.origins.iter().map(|origin| origin.seen).sum::<u64>();
    assert_eq!(seen + received.gap.paths, 200_000, "every path was seen or reported");
    assert!(received.gap.paths < 20_000, "few are dropped once it decimates: {:?}", received.gap);
    for (header, path) in &received.paths {
        assert_eq!(published.get(&header.id), Some(path), "thinned paths are exact");
    }
    let bytes: usize = received.paths.iter().map(|(_, path)| 60 + 24 * path.len()).sum();
    let budgeted = budget as f64 * seconds;
    assert!(bytes as f64 > 0.5 * budgeted, "{bytes} bytes where {budgeted} are allowed");
    let wanted = received.sum(|origin| origin.matched_steps);
    let weights: f64 = received.paths.iter().map(|(header, _)| f64::from(header.weight)).sum();
    assert!((weights / wanted - 1.0).abs() < 0.02, "{weights} steps stand for {wanted}");
    assert!(received.origins.iter().any(|origin| origin.decimation > 1.0), "it was decimated");
    let counts = viewer.lane.population().counts();
    assert_eq!(counts.seen, 200_000, "the tally saw even what was dropped afterwards");
    assert!(counts.matched_steps >= wanted, "{counts:?}");
}

/// A filter that wants nothing is heard of nevertheless.
#[tokio::test(start_paused = true)]
async fn an_empty_selection_still_counts() {
    let (hub, _tasks) = running_hub(HubLimits::default());
    let viewer = hub.subscribe(0).expect("a viewer");
    viewer.set_filter(7, compiled("edges > 64"));
    let mut walk = Walk::new(2, 5);
    for _ in 0..3 {
        hub.publish_paths(walk.batch(50).0);
    }
    let early = delivered(&viewer).await;
    assert!(
        matches!(early.as_slice(), [TracerEvent::FilterReply(reply), TracerEvent::SnapshotEnd]
            if reply.revision == 7 && reply.conditions == ["edges > 64"]),
        "the reply comes first: {early:?}"
    );
    tokio::time::sleep(LONG).await;
    let mut received = Received::default();
    received.receive(delivered(&viewer).await);
    let [origin] = received.origins[..] else { panic!("not one batch: {received:?}") };
    assert_eq!((origin.revision, origin.source_batches), (7, 3));
    assert_eq!((origin.seen, origin.matched, origin.matched_steps), (150, 0, 0.0));
    assert!(received.paths.is_empty(), "none is wanted");
}
