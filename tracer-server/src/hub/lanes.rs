//! What the focus lane and the control lane promise.

use common::{
    ChainId, Event, ExplorerState, FocusOutcome, FocusStep, PathId, Presence, VertexKind,
    VertexRecord,
};
use proptest::prelude::*;

use super::tests::{delivered, running_hub};
use super::*;

/// A walk of the explorer by splices that a seed chooses.
struct Walk {
    random: u64,
    path: Arc<FocusPath>,
}

impl Walk {
    fn new(seed: u64) -> Self {
        let mut walk = Self { random: seed | 1, path: Arc::default() };
        walk.path = walk.seed();
        walk
    }

    fn below(&mut self, limit: usize) -> usize {
        self.random ^= self.random << 13;
        self.random ^= self.random >> 7;
        self.random ^= self.random << 17;
        (self.random >> 33) as usize % limit
    }

    fn vertices(&mut self, count: usize) -> Vec<VertexRecord> {
        let vertex = |primitive| VertexRecord {
            position: [primitive as f32, 0.0, 1.0],
            normal: [0; 2],
            kind: VertexKind::Diffuse,
            event: Event::Diffuse,
            material: 0,
            primitive,
        };
        (0..count).map(|_| vertex(self.below(1 << 20) as u32)).collect()
    }

    fn seed(&mut self) -> Arc<FocusPath> {
        let count = 2 + self.below(9);
        let (vertices, next) = (self.vertices(count), self.path.next);
        Arc::new(FocusPath { vertices, next, ..FocusPath::default() })
    }

    fn arrived(&self) -> FocusNews {
        FocusNews { step: None, after: Arc::clone(&self.path) }
    }

    fn go(&mut self) -> FocusNews {
        if self.below(20) == 0 {
            self.path = self.seed();
            return self.arrived();
        }
        let length = self.path.vertices.len();
        let kept_light = self.below(length.min(4));
        let kept_eye = self.below(length - kept_light);
        let made = 2 + self.below(4);
        let step = FocusStep {
            number: self.path.next,
            id: PathId { chain: ChainId::EXPLORER, epoch: 1, step: self.path.next },
            fan: self.below(5) == 0,
            outcome: [FocusOutcome::Accepted, FocusOutcome::Rejected, FocusOutcome::Failed(1)]
                [self.below(3)],
            length,
            kept_light,
            kept_eye,
            inserted: self.vertices(made),
            ..FocusStep::default()
        };
        self.path = Arc::new(self.path.after(&step).expect("it follows"));
        FocusNews { step: Some(Arc::new(step)), after: Arc::clone(&self.path) }
    }
}

/// What a viewer makes of what it is sent.
#[derive(Default)]
struct Seen {
    path: Option<FocusPath>,
    steps: u64,
    missed: u64,
}

impl Seen {
    fn receive(&mut self, deliveries: Vec<TracerEvent>) {
        for delivery in deliveries {
            match delivery {
                TracerEvent::FocusPath(path) => self.path = Some(FocusPath::clone(&path)),
                TracerEvent::FocusStep(step) => {
                    let path = self.path.take().expect("a whole path comes first");
                    self.path = Some(path.after(&step).expect("no step is missing"));
                    self.steps += 1;
                }
                TracerEvent::FocusGap(steps) => {
                    assert!(steps > 0, "a gap is a loss");
                    self.missed += steps;
                    self.path = None;
                }
                _ => {}
            }
        }
    }
}

fn block_on<F: Future>(future: F) -> F::Output {
    let mut builder = tokio::runtime::Builder::new_current_thread();
    builder.enable_time().start_paused(true).build().expect("a runtime").block_on(future)
}

/// Publishes as the explorer does, which may wait for the pump: here the pump gets its turn.
async fn publish(hub: &Hub, news: FocusNews, count: usize) {
    hub.publish_focus(news);
    if count.is_multiple_of(64) {
        tokio::task::yield_now().await;
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// A viewer that reads now and then, whatever the explorer does: each step is seen or told to be
    /// missing, and after all of it the viewer has the explorer's very path.
    #[test]
    fn steps_arrive_in_order_or_are_told_to_be_missing(
        seed in any::<u64>(),
        bursts in prop::collection::vec(1..12_000_usize, 1..5),
        joins in 0..500_usize,
    ) {
        block_on(async {
            let (hub, _tasks) = running_hub(HubLimits::default());
            let viewer = hub.subscribe(1 << 30).expect("a viewer");
            prop_assert!(!hub.wants_focus(), "nobody has asked");
            let mut walk = Walk::new(seed);
            publish(&hub, walk.arrived(), 0).await;
            for count in 0..joins {
                publish(&hub, walk.go(), count).await;
            }
            tokio::time::sleep(std::time::Duration::from_millis(1)).await;
            viewer.set_focus(true);
            prop_assert!(hub.wants_focus(), "now somebody has");
            let first = walk.path.next;
            let mut seen = Seen::default();
            for burst in bursts {
                for count in 0..burst {
                    publish(&hub, walk.go(), count).await;
                }
                seen.receive(delivered(&viewer).await);
            }
            prop_assert_eq!(seen.steps + seen.missed, walk.path.next - first, "every step");
            if walk.path.next > first {
                prop_assert_eq!(seen.path.as_ref(), Some(&*walk.path), "the very path");
            }
            viewer.set_focus(false);
            publish(&hub, walk.go(), 0).await;
            let before = seen.steps;
            seen.receive(delivered(&viewer).await);
            prop_assert_eq!(seen.steps, before, "nothing more");
            Ok(())
        })?;
    }
}

#[tokio::test(start_paused = true)]
async fn a_viewer_that_keeps_up_misses_nothing_and_another_is_told() {
    let (hub, _tasks) = running_hub(HubLimits::default());
    let (reading, stalled) = (hub.subscribe(0).expect("room"), hub.subscribe(0).expect("room"));
    reading.set_focus(true);
    stalled.set_focus(true);
    let mut walk = Walk::new(5);
    publish(&hub, walk.arrived(), 0).await;
    let (mut seen, mut late) = (Seen::default(), Seen::default());
    for count in 0..40_000 {
        publish(&hub, walk.go(), count).await;
        if count % 500 == 0 {
            seen.receive(delivered(&reading).await);
        }
    }
    seen.receive(delivered(&reading).await);
    assert_eq!((seen.missed, seen.path.as_ref()), (0, Some(&*walk.path)), "nothing is missing");
    late.receive(delivered(&stalled).await);
    assert!(late.missed > 10_000, "{} steps do not fit", late.missed);
    assert_eq!(late.steps + late.missed, seen.steps, "each is told of");
    assert_eq!(late.path.as_ref(), Some(&*walk.path), "it is where the explorer is");
}

#[tokio::test(start_paused = true)]
async fn states_replace_each_other_and_replies_do_not() {
    let limits = HubLimits { control_messages: 8, ..HubLimits::default() };
    let (hub, _tasks) = running_hub(limits);
    let viewer = hub.subscribe(0).expect("a viewer");
    for steps in 0..100 {
        hub.announce(&Notice::Explorer(ExplorerState { steps, ..ExplorerState::default() }));
        hub.announce(&Notice::Presence(Presence::default()));
    }
    for request in 0..4 {
        hub.tell(viewer.session(), Notice::Reply(OrderReply { request, error: None }));
    }
    let heard: Vec<Notice> = delivered(&viewer)
        .await
        .into_iter()
        .filter_map(|delivery| match delivery {
            TracerEvent::Notice(notice) => Some(notice),
            TracerEvent::Goodbye(reason) => panic!("states alone fill no lane: {reason}"),
            _ => None,
        })
        .collect();
    assert!(matches!(&heard[0], Notice::Explorer(state) if state.steps == 99), "{heard:?}");
    assert_eq!(heard.len(), 6, "the newest states, and every reply: {heard:?}");
    let late = hub.subscribe(0).expect("a viewer");
    let states = delivered(&late).await;
    let is_state = |d: &&TracerEvent| {
        matches!(d, TracerEvent::Notice(Notice::Explorer(_) | Notice::Presence(_)))
    };
    assert_eq!(states.iter().filter(is_state).count(), 2, "who comes late hears both: {states:?}");
    for request in 0..20 {
        hub.tell(viewer.session(), Notice::Reply(OrderReply { request, error: None }));
    }
    let last = delivered(&viewer).await.pop();
    assert!(
        matches!(last, Some(TracerEvent::Goodbye(_))),
        "a viewer must read its replies: {last:?}"
    );
}
