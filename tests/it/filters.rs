//! Filters in the daemon as it ships: exact paths, exact counts, changed while the paths stream.

use std::collections::BTreeMap;
use std::sync::Arc;

use common::{
    CompiledFilter, Filter, FilterReply, FilterScene, FilterText, Gap, PathBatch, Role, Statistics,
    TracerEvent,
};
use proto::v1::tracer_client::TracerClient;
use proto::{Hello, ProtocolVersion, SceneAssembler, ViewerEvent, WantedFilter, v1};
use tokio::sync::mpsc;
use tokio_stream::wrappers::ReceiverStream;
use tonic::transport::Channel;
use tonic::{Code, Status, Streaming};
use tracer_server::daemon::Daemon;

use crate::daemon::{PATIENCE, next, start};

/// A viewer with its own thread of thought about what it must be sent.
struct Viewer {
    client: TracerClient<Channel>,
    outgoing: mpsc::Sender<v1::ViewerMessage>,
    stream: Streaming<v1::TracerMessage>,
    /// The number of the next batch of the daemon that nothing was heard of.
    next_source: Option<u64>,
}

impl Viewer {
    async fn join(daemon: &Daemon, filter: Option<WantedFilter>) -> Result<Self, Status> {
        let address = format!("http://{}", daemon.address());
        let mut client = TracerClient::connect(address).await.expect("the daemon listens");
        let hello = Hello {
            version: ProtocolVersion::CURRENT,
            viewer_name: "test".to_owned(),
            wanted_role: Role::Observer,
            data_budget: 1 << 28,
            filter,
            focus: false,
            resume: String::new(),
        };
        let (outgoing, outbox) = mpsc::channel(8);
        outgoing.try_send(ViewerEvent::Hello(hello).into()).expect("an empty outbox");
        let stream = client.watch(ReceiverStream::new(outbox)).await?.into_inner();
        Ok(Self { client, outgoing, stream, next_source: None })
    }

    async fn set_filter(&self, revision: u32, text: &str) {
        let filter = WantedFilter { revision, filter: FilterText::read(text) };
        self.outgoing.send(ViewerEvent::SetFilter(filter).into()).await.expect("connected");
    }

    /// The next event, after a check that no batch of the daemon is missing or comes twice.
    async fn next(&mut self) -> TracerEvent {
        let event = next(&mut self.stream).await.expect("open");
        match &event {
            TracerEvent::Paths(batch) => {
                let sources = u64::from(batch.origin().source_batches);
                let first = self.next_source.unwrap_or_else(|| batch.sequence() + 1 - sources);
                assert_eq!(
                    batch.sequence() + 1,
                    first + sources,
                    "contiguous: {:?}",
                    batch.origin()
                );
                self.next_source = Some(first + sources);
            }
            TracerEvent::Gap(Gap { batches, .. }) => {
                self.next_source = self.next_source.map(|next| next + batches);
            }
            _ => {}
        }
        event
    }

    /// Lets `batch` see paths of filter `revision` until it is content; returns the last statistics
    /// of that filter.
    async fn watch(
        &mut self,
        revision: u32,
        mut content: impl FnMut(&PathBatch) -> bool,
    ) -> Arc<Statistics> {
        let mut statistics = Arc::<Statistics>::default();
        let mut is_content = false;
        // Batches that were ready when the filter changed come first.
        while !(is_content && statistics.filter.seen > 0) {
            match self.next().await {
                TracerEvent::Paths(batch) if batch.origin().revision == revision => {
                    is_content = content(&batch);
                }
                TracerEvent::Statistics(news) if news.filter.revision == revision => {
                    statistics = news;
                }
                _ => {}
            }
        }
        statistics
    }

    async fn reply(&mut self) -> FilterReply {
        loop {
            if let TracerEvent::FilterReply(reply) = self.next().await {
                return reply;
            }
        }
    }
}

/// What a filter may name, as a viewer can put it together from what it was sent.
async fn filter_scene(viewer: &mut Viewer) -> FilterScene {
    let TracerEvent::Welcome(welcome) = viewer.next().await else { panic!("no welcome") };
    let request = v1::SceneRequest { known_hash: String::new() };
    let mut chunks = viewer.client.get_scene(request).await.expect("a scene").into_inner();
    let mut assembler = SceneAssembler::default();
    while let Some(chunk) = chunks.message().await.expect("no error") {
        assembler.push(chunk).expect("well-formed");
    }
    let scene = assembler.finish().expect("whole").expect("new to us");
    FilterScene::new(scene.frame, &scene.mesh, welcome.strategies)
}

fn compiled(text: &str, scene: &FilterScene) -> CompiledFilter {
    let filter = Filter::parse(text).and_then(|filter| filter.compile(scene));
    filter.unwrap_or_else(|error| panic!("{}", error.pointed(text)))
}

fn wanted(filter: &CompiledFilter, batch: &PathBatch) -> (u64, usize) {
    let (mut matched, mut reader) = (0, batch.reader());
    while let Some(path) = reader.next() {
        matched += u64::from(filter.matches(&path.header, path.vertices));
    }
    (matched, batch.len())
}

async fn stop(daemon: Daemon) {
    let stopping = tokio::task::spawn_blocking(move || daemon.stop());
    tokio::time::timeout(PATIENCE, stopping).await.expect("stops in time").expect("no panic");
}

#[tokio::test]
async fn a_filter_changes_while_paths_stream_and_counts_stay_exact() {
    let daemon = start();
    let mut viewer = Viewer::join(&daemon, None).await.expect("welcome");
    let scene = filter_scene(&mut viewer).await;
    viewer.watch(0, |batch| wanted(&compiled("true", &scene), batch).1 > 0).await;
    for (revision, text) in (1..).zip([
        "edges >= 3 and any on material terracotta",
        "lpe \"CDL\"",
        "not (edges >= 3 and any on material terracotta)",
    ]) {
        viewer.set_filter(revision, text).await;
        let reply = viewer.reply().await;
        assert_eq!((reply.revision, reply.error), (revision, None), "accepted");
        let filter = compiled(text, &scene);
        assert_eq!(reply.text, filter.text(), "both understand the same");
        assert_eq!(reply.conditions, filter.condition_texts(), "the same conditions");
        let (mut paths, mut seen, mut matched) = (0, 0, 0);
        let statistics = viewer
            .watch(revision, |batch| {
                let (all, here) = wanted(&filter, batch);
                assert_eq!(all, here as u64, "only wanted paths are sent");
                let origin = batch.origin();
                assert!(
                    origin.decimation > 0.0 || origin.matched == all,
                    "all of them: {origin:?}"
                );
                paths += here;
                (seen, matched) = (seen + origin.seen, matched + origin.matched);
                // The first few batches may hold nothing but what is wanted.
                paths > 100 && seen > matched
            })
            .await;
        let counts = statistics.filter.clone();
        assert!(seen > matched && matched > 100, "some match, some do not: {matched} of {seen}");
        let share = counts.matched_steps / counts.seen_steps;
        assert!((counts.energy_share - share).abs() < 1e-12, "{counts:?}");
        // The first count may come when all paths so far match, or none: nothing varies then.
        let varies = counts.energy_error > 0.0 || [0, counts.seen].contains(&counts.matched);
        assert!(varies && counts.energy_error < 0.5, "{counts:?}");
        let all = counts.conditions.iter().all(|&count| count <= counts.seen);
        assert!(all && counts.matched <= counts.seen, "{counts:?}");
    }
    stop(daemon).await;
}

/// A viewer without a filter counts by itself what the daemon counts for the other one.
#[tokio::test]
async fn the_daemon_counts_what_a_viewer_would_count() {
    let daemon = start();
    let mut everything = Viewer::join(&daemon, None).await.expect("welcome");
    let scene = filter_scene(&mut everything).await;
    let text = "any on material fern or start through box(-100, -100, -100, 100, 100, 0)";
    let first = WantedFilter { revision: 5, filter: FilterText::read(text) };
    let mut selected = Viewer::join(&daemon, Some(first)).await.expect("welcome");
    let filter = compiled(text, &scene);
    let (mut by_hand, mut ranges) = (BTreeMap::new(), Vec::new());
    let mut compared = 0;
    while compared < 20 {
        let (one, other) = tokio::join!(everything.next(), selected.next());
        if let TracerEvent::Paths(batch) = one
            && batch.origin().decimation == 0.0
        {
            by_hand
                .insert(batch.sequence(), (wanted(&filter, &batch), batch.paths().weight.clone()));
        }
        if let TracerEvent::Paths(batch) = other {
            assert_eq!(batch.origin().revision, 5, "no path comes before the filter");
            ranges.push((batch.sequence(), *batch.origin()));
        }
        ranges.retain(|(last, origin)| {
            let range = last + 1 - u64::from(origin.source_batches)..=*last;
            if !range.clone().all(|source| by_hand.contains_key(&source)) {
                return true;
            }
            let counted: Vec<_> = by_hand.range(range).collect();
            let matched: u64 = counted.iter().map(|(_, ((matched, _), _))| matched).sum();
            let seen: usize = counted.iter().map(|(_, ((_, seen), _))| seen).sum();
            let weights = counted.iter().flat_map(|(_, (_, weights))| weights);
            let steps: f64 = weights.map(|&weight| f64::from(weight)).sum();
            assert_eq!((origin.matched, origin.seen), (matched, seen as u64), "batches to {last}");
            assert_eq!(origin.seen_steps, steps, "steps of the batches to {last}");
            compared += 1;
            false
        });
    }
    stop(daemon).await;
}

#[tokio::test]
async fn what_is_no_filter_is_refused_with_its_place_and_harms_nothing() {
    let daemon = start();
    let filter = |text: &str| Some(WantedFilter { revision: 1, filter: FilterText::read(text) });
    let status = Viewer::join(&daemon, filter("any on material ferm")).await.map(|_| ());
    let status = status.expect_err("there is no such material");
    assert_eq!(status.code(), Code::InvalidArgument);
    assert!(status.message().contains("did you mean \"fern\""), "{status}");

    let mut viewer = Viewer::join(&daemon, filter("any on object \"tall block\"")).await;
    let viewer = viewer.as_mut().expect("there is such an object");
    assert_eq!(viewer.reply().await.revision, 1, "accepted in the hello");
    viewer.set_filter(2, "edges >= three").await;
    let reply = viewer.reply().await;
    let error = reply.error.expect("no number");
    assert_eq!((reply.revision, error.span), (2, 9..14), "{}", error.message);
    let statistics = viewer.watch(1, |batch| !batch.is_empty()).await;
    let counts = statistics.filter.clone();
    assert!(
        0 < counts.matched && counts.matched < counts.seen,
        "the first is in force: {counts:?}"
    );
    stop(daemon).await;
}
