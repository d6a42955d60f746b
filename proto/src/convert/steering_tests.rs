//! Round trips of orders, notices and the focus lane, and what hostile peers may send instead.

use std::sync::Arc;

use common::{
    Appearance, Attendee, Author, ChainCommand, ChainId, ChainState, Event, ExplorerCommand,
    ExplorerState, FocusOutcome, FocusPath, FocusStep, Gaze, LeaseEvent, LeaseNotice, LeaseRequest,
    Notice, Order, OrderReply, Pace, PathHeader, PathId, Presence, RatioFactors, Role, Seed,
    SkipTo, StrategyId, StrategySet, TracerEvent, VertexKind, VertexRecord,
};
use proptest::prelude::*;
use prost::Message as _;
use prost::bytes::Bytes;

use super::*;
use crate::v1;

fn travel(event: &TracerEvent) -> Result<TracerEvent, WireError> {
    let bytes = v1::TracerMessage::from(event).encode_to_vec();
    v1::TracerMessage::decode(bytes.as_slice()).expect("our own bytes").try_into()
}

fn vertices(count: u32) -> Vec<VertexRecord> {
    let vertex = |i| VertexRecord {
        position: [i as f32, 0.5, -1.0],
        normal: [i as i16, -7],
        kind: VertexKind::Diffuse,
        event: Event::Glossy,
        material: 3,
        primitive: i,
    };
    (0..count).map(vertex).collect()
}

fn id() -> PathId {
    PathId { chain: ChainId::EXPLORER, epoch: 3, step: 1 << 40 }
}

fn step() -> FocusStep {
    FocusStep {
        number: 99,
        id: id(),
        fan: true,
        strategy: StrategyId(4),
        outcome: FocusOutcome::Failed(3),
        acceptance: 0.25,
        factors: RatioFactors {
            forward: 2.0,
            backward: f64::INFINITY,
            mixture_current: 0.5,
            mixture_proposed: 0.0,
            target_current: 0.75,
            target_proposed: 0.125,
        },
        length: 6,
        kept_light: 2,
        kept_eye: 1,
        inserted: vertices(2),
        eye_side: vertices(1),
        blocker: Some([1.0, 2.0, 3.0]),
        film: [0.25, 0.75],
        luminance: 8.0,
        rgb: [1.0, 0.5, 0.0],
        rays: 5,
    }
}

fn author() -> Author {
    Author { session: 8, name: "anna".to_owned() }
}

#[test]
fn the_focus_lane_survives_the_wire() {
    let header =
        PathHeader { id: id(), strategy: StrategyId(255), dwell: 4, ..PathHeader::default() };
    let path = FocusPath { header, vertices: vertices(5), next: 100 };
    let complete = FocusStep { outcome: FocusOutcome::Accepted, blocker: None, ..step() };
    for event in [
        TracerEvent::FocusPath(Arc::new(path)),
        TracerEvent::FocusStep(Arc::new(step())),
        TracerEvent::FocusStep(Arc::new(FocusStep { eye_side: Vec::new(), ..complete.clone() })),
        TracerEvent::FocusStep(Arc::new(FocusStep { outcome: FocusOutcome::Rejected, ..complete })),
        TracerEvent::FocusGap(7),
    ] {
        assert_eq!(travel(&event), Ok(event));
    }
}

#[test]
fn notices_survive_the_wire() {
    let gaze = Gaze { eye: [1.0, 2.0, 3.0], target: [0.0; 3] };
    let appearance = Appearance { gaze: Some(gaze), filter: "edges > 2".to_owned() };
    let attendee = Attendee { author: author(), role: Role::Driver, asks: true, appearance };
    let explorer = ExplorerState {
        pace: Pace::Playing,
        rate: 2.5,
        allowed: StrategySet(5),
        current: Some(id()),
        origin: Some(PathId::default()),
        steps: 10,
        accepted: 3,
        next: 11,
        by: Some(author()),
    };
    let chains = ChainState {
        epoch: 2,
        running: true,
        weights: vec![0.5, 0.0],
        seed: u64::MAX,
        precision: 0.003,
        change: "restarted".to_owned(),
        by: None,
    };
    let lease = LeaseNotice { event: LeaseEvent::Asked, by: Some(author()) };
    for notice in [
        Notice::Presence(Presence { viewers: vec![attendee, Attendee::default()] }),
        Notice::Explorer(explorer),
        Notice::Explorer(ExplorerState::default()),
        Notice::Chains(chains),
        Notice::Lease(lease),
        Notice::Reply(OrderReply { request: 4, error: None }),
        Notice::Reply(OrderReply { request: 5, error: Some("it is gone".to_owned()) }),
    ] {
        let event = TracerEvent::Notice(notice);
        assert_eq!(travel(&event), Ok(event));
    }
}

#[test]
fn orders_survive_the_wire() {
    let strategy = StrategyId(5);
    let orders = [
        Order::Explorer(ExplorerCommand::Seed(Seed::Path(id()))),
        Order::Explorer(ExplorerCommand::Seed(Seed::Newest)),
        Order::Explorer(ExplorerCommand::Play(2.5)),
        Order::Explorer(ExplorerCommand::Pause),
        Order::Explorer(ExplorerCommand::Step(10)),
        Order::Explorer(ExplorerCommand::Skip(SkipTo::Acceptance)),
        Order::Explorer(ExplorerCommand::Skip(SkipTo::Strategy(strategy))),
        Order::Explorer(ExplorerCommand::Allow(StrategySet(9))),
        Order::Explorer(ExplorerCommand::Fan { strategy, count: 1000 }),
        Order::Chains(ChainCommand::Pause),
        Order::Chains(ChainCommand::Resume),
        Order::Chains(ChainCommand::SetWeight { strategy, weight: 0.0 }),
        Order::Chains(ChainCommand::SetPrecision(0.001)),
        Order::Chains(ChainCommand::Restart { seed: 7 }),
        Order::Lease(LeaseRequest::Ask),
        Order::Lease(LeaseRequest::Release),
        Order::Lease(LeaseRequest::HandOver(12)),
    ];
    for (request, order) in (0..).zip(orders.map(Some).into_iter().chain([None])) {
        let event = ViewerEvent::Order(NumberedOrder { request, order });
        assert_eq!(ViewerEvent::try_from(v1::ViewerMessage::from(event.clone())), Ok(event));
    }
    for event in [ViewerEvent::SetFocus(true), ViewerEvent::Appearance(Appearance::default())] {
        assert_eq!(ViewerEvent::try_from(v1::ViewerMessage::from(event.clone())), Ok(event));
    }
}

#[test]
fn hostile_orders_are_refused() {
    use v1::order::What;
    let refused = |what| {
        let wire = v1::Order { request: 1, what: Some(what) };
        NumberedOrder::try_from(wire).is_err()
    };
    for rate in [0.0, -1.0, 2001.0, f32::NAN, f32::INFINITY] {
        assert!(refused(What::ExplorerPlay(rate)), "{rate} steps a second");
    }
    assert!(refused(What::ExplorerStep(0)), "no step");
    assert!(refused(What::ExplorerStep(u32::MAX)), "steps without end");
    assert!(refused(What::ExplorerFan(v1::ExplorerFan { strategy: 0, count: 1001 })), "a jungle");
    assert!(refused(What::ExplorerFan(v1::ExplorerFan { strategy: 64, count: 1 })), "no strategy");
    for weight in [-1.0, 1e7, f64::NAN] {
        assert!(
            refused(What::ChainsWeight(v1::StrategyWeight { strategy: 0, weight })),
            "{weight}"
        );
    }
    for precision in [0.0, 1.0, f64::NAN] {
        assert!(refused(What::ChainsPrecision(precision)), "precision {precision}");
    }
}

#[test]
fn hostile_steps_are_refused() {
    let refused = |edit: fn(&mut v1::FocusStep)| {
        let mut wire = v1::FocusStep::from(&step());
        edit(&mut wire);
        FocusStep::try_from(wire).is_err()
    };
    assert!(!refused(|_| {}), "the step itself is good");
    assert!(refused(|s| s.kept_light = 7), "keeps more than there is");
    assert!(refused(|s| s.kept_eye = 5), "keeps one vertex twice");
    assert!(refused(|s| s.length = 66), "too long a path");
    assert!(refused(|s| s.outcome = 0), "nothing came of it");
    assert!(refused(|s| s.strategy = 256), "no strategy");
    assert!(refused(|s| s.acceptance = f64::NAN), "NaN");
    assert!(refused(|s| s.forward = f64::NAN), "NaN among the factors");
    assert!(refused(|s| s.id = None), "nameless");
    assert!(refused(|s| s.film_u = f32::NAN), "NaN on the film");
    assert!(refused(|s| s.blocker = Some(v1::Vector { x: f64::NAN, y: 0.0, z: 0.0 })), "nowhere");
    let short = |s: &mut v1::FocusStep| {
        if let Some(inserted) = &mut s.inserted {
            inserted.position = Bytes::from_static(&[0; 11]);
        }
    };
    assert!(refused(short), "columns of different length");
    let unknown = |s: &mut v1::FocusStep| {
        if let Some(inserted) = &mut s.inserted {
            inserted.kind = Bytes::from_static(&[99, 99]);
        }
    };
    assert!(refused(unknown), "a kind that does not exist");
    let long = |s: &mut v1::FocusStep| {
        s.inserted =
            v1::FocusPath::from(&FocusPath { vertices: vertices(65), ..FocusPath::default() })
                .vertices;
        s.outcome = v1::FocusOutcome::Accepted.into();
    };
    assert!(refused(long), "makes a path that is too long");
    let path = FocusPath { vertices: vertices(1), ..FocusPath::default() };
    assert!(FocusPath::try_from(v1::FocusPath::from(&path)).is_err(), "a path of one vertex");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// Bytes of good messages, some of them changed, cut off or repeated: refused or understood, and
    /// what is understood holds together.
    #[test]
    fn damaged_steps_and_notices_never_panic(
        which in 0..4_usize,
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..6),
        cut in any::<prop::sample::Index>(),
        repeats in any::<bool>(),
    ) {
        let state = ExplorerState { by: Some(author()), current: Some(id()), ..ExplorerState::default() };
        let chains = ChainState { weights: vec![1.0; 7], by: Some(author()), ..ChainState::default() };
        let event = match which {
            0 => TracerEvent::FocusStep(Arc::new(step())),
            1 => TracerEvent::FocusPath(Arc::new(FocusPath { vertices: vertices(4), ..FocusPath::default() })),
            2 => TracerEvent::Notice(Notice::Explorer(state)),
            _ => TracerEvent::Notice(Notice::Chains(chains)),
        };
        let mut bytes = v1::TracerMessage::from(&event).encode_to_vec();
        for (place, value) in damage {
            let place = place.index(bytes.len());
            bytes[place] = value;
        }
        if repeats {
            bytes.extend_from_within(..);
        }
        bytes.truncate(cut.index(2 * bytes.len()).max(bytes.len() / 2));
        let read = v1::TracerMessage::decode(bytes.as_slice()).map(TracerEvent::try_from);
        if let Ok(Ok(TracerEvent::FocusStep(step))) = read {
            prop_assert!(step.kept_light + step.kept_eye <= step.length);
            if let Some(path) = step.proposal(&vertices(step.length as u32)) {
                prop_assert!((2..=65).contains(&path.len()), "a path of {}", path.len());
            }
        }
    }

    #[test]
    fn damaged_orders_never_panic(
        which in 0..4_usize,
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..6),
    ) {
        let order = match which {
            0 => Order::Explorer(ExplorerCommand::Seed(Seed::Path(id()))),
            1 => Order::Explorer(ExplorerCommand::Play(2.5)),
            2 => Order::Chains(ChainCommand::SetWeight { strategy: StrategyId(2), weight: 0.5 }),
            _ => Order::Lease(LeaseRequest::HandOver(3)),
        };
        let order = ViewerEvent::Order(NumberedOrder { request: 1, order: Some(order) });
        let mut bytes = v1::ViewerMessage::from(order).encode_to_vec();
        for (place, value) in damage {
            let place = place.index(bytes.len());
            bytes[place] = value;
        }
        let read = v1::ViewerMessage::decode(bytes.as_slice()).map(ViewerEvent::try_from);
        if let Ok(Ok(ViewerEvent::Order(NumberedOrder { order: Some(order), .. }))) = read {
            let sound = match order {
                Order::Explorer(ExplorerCommand::Play(rate)) => (0.05..=2000.0).contains(&rate),
                Order::Explorer(ExplorerCommand::Step(count)) => (1..=10_000).contains(&count),
                Order::Explorer(ExplorerCommand::Fan { count, .. }) => (1..=1000).contains(&count),
                Order::Chains(ChainCommand::SetWeight { weight, .. }) => weight.is_finite(),
                Order::Chains(ChainCommand::SetPrecision(precision)) => precision > 0.0,
                _ => true,
            };
            prop_assert!(sound, "{order:?}");
        }
    }
}
