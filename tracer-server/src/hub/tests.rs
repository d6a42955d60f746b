//! The promises of the hub, kept on a clock that the tests turn.

use std::time::Duration;

use common::{BatchBuilder, Event, PathHeader, Rgb, VertexKind, VertexRecord};
use tokio_util::sync::CancellationToken;

use super::*;

/// A batch of `paths` two-vertex paths.
pub(super) fn batch(paths: usize) -> PathBatch {
    let vertex = |kind| VertexRecord {
        position: [1.0, 2.0, 3.0],
        normal: [0, 0],
        kind,
        event: Event::End,
        material: 0,
        primitive: 1,
    };
    let mut builder = BatchBuilder::default();
    for _ in 0..paths {
        let ends = [vertex(VertexKind::Light), vertex(VertexKind::Eye)];
        let completed = builder.push(&PathHeader::default(), &ends, None);
        assert!(completed.is_none(), "the batch is not full");
    }
    builder.finish().expect("there are paths")
}

fn film(width: u32, height: u32, value: f64) -> Arc<FilmFrame> {
    let pixels = vec![Rgb::grey(value); (width * height) as usize];
    Arc::new(FilmFrame { width, height, steps: 1, pixels })
}

/// A hub whose pump runs until the test ends, on a paused clock.
pub(super) fn running_hub(limits: HubLimits) -> (Hub, tokio::task::JoinSet<()>) {
    let (hub, pump) = Hub::new(limits);
    let mut tasks = tokio::task::JoinSet::new();
    tasks.spawn(pump.run(CancellationToken::new()));
    (hub, tasks)
}

/// Lets the pump empty its queues.
async fn settle() {
    tokio::time::sleep(Duration::from_millis(1)).await;
}

/// What is there to be sent within a millisecond.
pub(super) async fn delivered(subscription: &Subscription) -> Vec<TracerEvent> {
    let mut all = Vec::new();
    while let Ok(delivery) =
        tokio::time::timeout(Duration::from_millis(1), subscription.next()).await
    {
        all.push(delivery);
        if matches!(all.last(), Some(TracerEvent::Goodbye(_))) {
            break;
        }
    }
    all
}

#[tokio::test(start_paused = true)]
async fn a_late_viewer_gets_the_newest_snapshot() {
    let (hub, _tasks) = running_hub(HubLimits::default());
    hub.publish_film(film(4, 3, 1.0));
    hub.publish_film(film(4, 3, 2.0));
    hub.publish_statistics(Arc::new(Statistics { epoch: 9, ..Statistics::default() }));
    settle().await;
    let viewer = hub.subscribe(0).expect("the first viewer");
    let deliveries = delivered(&viewer).await;
    let [TracerEvent::Statistics(statistics), TracerEvent::Film(tile), TracerEvent::SnapshotEnd] =
        deliveries.as_slice()
    else {
        panic!("not a snapshot: {deliveries:?}");
    };
    assert_eq!((statistics.epoch, statistics.viewers), (9, 1));
    assert_eq!((tile.first_row, tile.rgb.as_slice()), (0, [2.0; 36].as_slice()));
}

#[tokio::test(start_paused = true)]
async fn nobody_watching_costs_nothing() {
    let (hub, _tasks) = running_hub(HubLimits::default());
    assert!(!hub.wants_paths(), "no viewer wants any");
    hub.publish_paths(batch(1));
    let viewer = hub.subscribe(0).expect("the first viewer");
    assert!(hub.wants_paths(), "now one does");
    assert_eq!(delivered(&viewer).await, [TracerEvent::SnapshotEnd]);
    drop(viewer);
    assert!(!hub.wants_paths(), "it left");
}

#[tokio::test(start_paused = true)]
async fn a_stalled_viewer_loses_the_oldest_and_is_told() {
    let one = batch(100);
    let limits = HubLimits { lane_bytes: 3 * one.byte_len(), ..HubLimits::default() };
    let (hub, _tasks) = running_hub(limits);
    let stalled = hub.subscribe(0).expect("a viewer");
    let reading = hub.subscribe(0).expect("another viewer");
    assert_eq!(delivered(&stalled).await, [TracerEvent::SnapshotEnd]);
    assert_eq!(delivered(&reading).await, [TracerEvent::SnapshotEnd]);
    for sequence in 0..10 {
        hub.publish_paths(one.clone());
        let got = delivered(&reading).await;
        let expected =
            TracerEvent::Paths(Arc::new(one.clone().into_source().with_sequence(sequence)));
        assert_eq!(got, [expected], "a reading viewer gets every batch");
    }
    let got = delivered(&stalled).await;
    let gap = Gap { batches: 7, paths: 700, bytes: 7 * one.byte_len() as u64 };
    assert_eq!(got[0], TracerEvent::Gap(gap), "the gap stands where the batches are missing");
    let sequences: Vec<_> = got[1..]
        .iter()
        .map(|delivery| match delivery {
            TracerEvent::Paths(batch) => batch.sequence(),
            other => panic!("not paths: {other:?}"),
        })
        .collect();
    assert_eq!(sequences, [7, 8, 9], "the newest are kept");
}

#[tokio::test(start_paused = true)]
async fn a_viewer_that_never_reads_is_disconnected() {
    let (hub, _tasks) = running_hub(HubLimits::default());
    let viewer = hub.subscribe(0).expect("a viewer");
    hub.publish_statistics(Arc::new(Statistics::default()));
    tokio::time::sleep(Duration::from_secs(40)).await;
    let got = delivered(&viewer).await;
    assert!(matches!(got.as_slice(), [TracerEvent::Goodbye(_)]), "closed with a reason: {got:?}");
}

#[tokio::test(start_paused = true)]
async fn films_coalesce_but_finish() {
    let (hub, _tasks) = running_hub(HubLimits::default());
    let viewer = hub.subscribe(1 << 30).expect("a viewer");
    assert_eq!(delivered(&viewer).await, [TracerEvent::SnapshotEnd]);
    for value in 1..=5 {
        hub.publish_film(film(512, 512, f64::from(value)));
    }
    let tiles: Vec<_> = delivered(&viewer)
        .await
        .into_iter()
        .map(|delivery| match delivery {
            TracerEvent::Film(tile) => tile,
            other => panic!("not film: {other:?}"),
        })
        .collect();
    assert!(tiles.iter().all(|tile| tile.rgb.len() * 4 < 256 << 10), "tiles stay small");
    for sequence in [1, 5] {
        let rows: usize = tiles
            .iter()
            .filter(|tile| tile.sequence == sequence)
            .map(|tile| tile.rgb.len() / (3 * 512))
            .sum();
        assert_eq!(rows, 512, "snapshot {sequence} is whole");
    }
    assert!(tiles.iter().all(|tile| [1, 5].contains(&tile.sequence)), "the others were skipped");
}

#[tokio::test(start_paused = true)]
async fn one_viewer_too_many_is_refused() {
    let (hub, _tasks) = running_hub(HubLimits { viewers: 2, ..HubLimits::default() });
    let first = hub.subscribe(0).expect("the first");
    let _second = hub.subscribe(0).expect("the second");
    assert_eq!(hub.subscribe(0).map(|s| s.session()), Err(HubFull { limit: 2 }));
    drop(first);
    assert!(hub.subscribe(0).is_ok(), "there is room again");
}

#[test]
fn without_a_pump_producers_lose_but_never_wait() {
    let (hub, _pump) = Hub::new(HubLimits::default());
    let _viewer = hub.subscribe(0).expect("a viewer");
    for _ in 0..10_000 {
        hub.publish_paths(batch(10));
        hub.publish_film(film(1, 1, 0.0));
    }
    let lost = hub.shared.lost.drain();
    assert_eq!(lost.batches, 10_000 - INGRESS_BATCHES as u64);
    let waiting = hub.shared.waiting_bytes.load(Ordering::Relaxed);
    assert_eq!(waiting, INGRESS_BATCHES * batch(10).byte_len(), "what waits is counted");
}
