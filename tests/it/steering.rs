//! Who may steer, and what everyone is told about it.

use std::sync::Arc;
use std::time::Duration;

use common::{
    ChainCommand, FilterText, Gaze, LeaseEvent, LeaseNotice, LeaseRequest, Notice, Order,
    OrderReply, Presence, Role, TracerEvent,
};
use proto::{NumberedOrder, ViewerEvent, WantedFilter};
use tokio::net::{TcpListener, TcpStream};
use tokio::task::JoinSet;
use tokio_util::sync::CancellationToken;
use tracer_server::hub::HubLimits;
use tracer_server::service::{Access, Security, Server, Token};
use tracer_server::steering::Orders;
use viewer_client::source::connection::{Bearer, Greeting, Peer, Session, Trust};

use crate::stream::fixture::{self, soon};

const DRIVER: &str = "a-token-for-the-driver";
const OBSERVER: &str = "a-token-for-observers";

/// A viewer with what it was told.
struct Member {
    session: Session,
    number: u64,
    role: Role,
    resume: String,
    presence: Presence,
    requests: u32,
}

impl Member {
    async fn join(server: &Server, greeting: Greeting) -> Self {
        Self::join_with(server, greeting, Bearer::default()).await
    }

    async fn join_with(server: &Server, greeting: Greeting, token: Bearer) -> Self {
        Self::join_at(server.address().to_string(), greeting, token).await
    }

    async fn join_at(address: String, greeting: Greeting, token: Bearer) -> Self {
        let peer = Peer { address, trust: Trust::Plain, token };
        let mut session = soon("a welcome", Session::open(&peer, greeting)).await.expect("welcome");
        let first = soon("a welcome", session.next()).await.expect("a welcome");
        let TracerEvent::Welcome(welcome) = first else { panic!("not a welcome: {first:?}") };
        let (number, role, resume) = (welcome.session, welcome.role, welcome.resume);
        Self { session, number, role, resume, presence: Presence::default(), requests: 0 }
    }

    /// Waits for the first event that `wanted` makes something of.
    async fn until<T>(&mut self, wanted: impl Fn(&TracerEvent) -> Option<T>) -> T {
        let looking = async {
            loop {
                let event = self.session.next().await.expect("still connected");
                if let TracerEvent::Notice(Notice::Presence(presence)) = &event {
                    self.presence = presence.clone();
                }
                if let Some(found) = wanted(&event) {
                    return found;
                }
            }
        };
        soon("an event", looking).await
    }

    async fn ask(&mut self, order: Order) -> Option<String> {
        self.requests += 1;
        let request = self.requests;
        let order = ViewerEvent::Order(NumberedOrder { request, order: Some(order) });
        assert!(self.session.say(order), "there is room for an order");
        self.until(|event| match event {
            TracerEvent::Notice(Notice::Reply(OrderReply { request: r, error })) => {
                assert_eq!(*r, request, "replies come in order");
                Some(error.clone())
            }
            _ => None,
        })
        .await
    }

    async fn lease_event(&mut self) -> LeaseEvent {
        self.until(|event| match event {
            TracerEvent::Notice(Notice::Lease(LeaseNotice { event, .. })) => Some(*event),
            _ => None,
        })
        .await
    }

    /// Waits until the others' roles are these, by session.
    async fn roles(&mut self, expected: &[(u64, Role, bool)]) {
        let is_so = |presence: &Presence| {
            let found = presence.viewers.iter().map(|v| (v.author.session, v.role, v.asks));
            found.eq(expected.iter().copied())
        };
        if !is_so(&self.presence) {
            self.until(|event| match event {
                TracerEvent::Notice(Notice::Presence(presence)) => is_so(presence).then_some(()),
                _ => None,
            })
            .await;
        }
    }
}

fn named(name: &str, role: Role) -> Greeting {
    Greeting { name: name.to_owned(), role, ..Greeting::default() }
}

fn start(access: Access) -> (Server, Orders) {
    let security = Security { access, ..Security::default() };
    fixture::start_steered(HubLimits::default(), security)
}

#[tokio::test]
async fn the_lease_is_granted_asked_for_handed_over_and_lost() {
    let (server, orders) = start(Access::default());
    let mut anna = Member::join(&server, named("anna", Role::Driver)).await;
    let mut ben = Member::join(&server, named("ben", Role::Driver)).await;
    assert_eq!((anna.role, ben.role), (Role::Driver, Role::Observer), "the first one drives");
    let (a, b) = (anna.number, ben.number);

    let pause = Order::Chains(ChainCommand::Pause);
    let refusal = ben.ask(pause).await.expect("an observer steers nothing");
    assert!(refusal.contains("anna"), "says who does: {refusal}");
    assert!(orders.chains.try_recv().is_err(), "and nothing was ordered");

    assert_eq!(ben.ask(Order::Lease(LeaseRequest::Ask)).await, None, "anyone may ask");
    assert_eq!(anna.lease_event().await, LeaseEvent::Asked);
    anna.roles(&[(a, Role::Driver, false), (b, Role::Observer, true)]).await;
    assert!(ben.ask(Order::Lease(LeaseRequest::HandOver(b))).await.is_some(), "not his to give");
    assert_eq!(anna.ask(Order::Lease(LeaseRequest::HandOver(b))).await, None, "hers to give");
    assert_eq!(ben.lease_event().await, LeaseEvent::Granted);
    ben.roles(&[(a, Role::Observer, false), (b, Role::Driver, false)]).await;

    assert!(ben.session.say(ViewerEvent::Order(NumberedOrder { request: 9, order: Some(pause) })));
    let order = tokio::task::spawn_blocking(move || {
        let order = orders.chains.recv_timeout(Duration::from_secs(10)).expect("an order");
        (order, orders)
    });
    let (order, orders) = soon("the order", order).await.expect("no panic");
    assert_eq!((order.author.name.as_str(), order.request), ("ben", 9), "says who and which");
    assert_eq!(order.command, ChainCommand::Pause);

    assert_eq!(anna.ask(Order::Lease(LeaseRequest::Ask)).await, None, "she waits");
    drop(ben);
    assert_eq!(anna.lease_event().await, LeaseEvent::Granted, "lost with the connection");
    anna.roles(&[(a, Role::Driver, false)]).await;
    assert_eq!(anna.ask(Order::Lease(LeaseRequest::Release)).await, None);
    assert!(anna.ask(pause).await.is_some(), "she has given it back");
    drop(orders);
    fixture::stop(server).await;
}

#[tokio::test]
async fn the_observers_token_opens_no_steering() {
    let token = |text| Some(Token::new(text).expect("long enough"));
    let (server, _orders) = start(Access { driver: token(DRIVER), observer: token(OBSERVER) });
    let bearer = |text| Bearer::new(text).expect("a token");
    let wish = named("eve", Role::Driver);
    let mut eve = Member::join_with(&server, wish, bearer(OBSERVER)).await;
    assert_eq!(eve.role, Role::Observer, "though nobody drives");
    let refusal = eve.ask(Order::Lease(LeaseRequest::Ask)).await.expect("refused");
    assert!(refusal.contains("driver's token"), "says what is needed: {refusal}");
    assert!(eve.ask(Order::Chains(ChainCommand::Pause)).await.is_some(), "refused");
    let anna = Member::join_with(&server, named("anna", Role::Driver), bearer(DRIVER)).await;
    assert_eq!(anna.role, Role::Driver);
    // Somebody else's secret gives no more than one's own token allows.
    let stolen = Greeting { resume: anna.resume.clone(), ..named("eve", Role::Driver) };
    drop(anna);
    let eve = Member::join_with(&server, stolen, bearer(OBSERVER)).await;
    assert_eq!(eve.role, Role::Observer);
    fixture::stop(server).await;
}

#[tokio::test]
async fn a_viewer_comes_back_to_its_filter_and_its_role() {
    let (server, _orders) = start(Access::default());
    let filter = WantedFilter { revision: 5, filter: FilterText::read("edges >= 3") };
    let greeting = Greeting { filter: Some(filter), focus: true, ..named("anna", Role::Driver) };
    let anna = Member::join(&server, greeting).await;
    let mut ben = Member::join(&server, named("ben", Role::Observer)).await;
    // Once while the daemon still believes in the old connection, and once after it has ended.
    let mut resume = anna.resume.clone();
    let mut held = Some(anna);
    for round in 0..2 {
        let greeting = Greeting { resume: resume.clone(), ..named("anna", Role::Observer) };
        if round == 1 {
            drop(held.take());
            ben.roles(&[(ben.number, Role::Observer, false)]).await;
        }
        let mut back = Member::join(&server, greeting).await;
        assert_eq!(back.role, Role::Driver, "round {round}: the lease waited");
        let revision = back
            .until(|event| match event {
                TracerEvent::FilterReply(reply) => Some((reply.revision, reply.text.clone())),
                _ => None,
            })
            .await;
        assert_eq!(revision, (5, "edges >= 3".to_owned()), "round {round}: its filter");
        resume.clone_from(&back.resume);
        ben.roles(&[(ben.number, Role::Observer, false), (back.number, Role::Driver, false)]).await;
        held = Some(back);
    }
    let unknown = Greeting { resume: "f".repeat(64), ..named("eve", Role::Driver) };
    let eve = Member::join(&server, unknown).await;
    assert_eq!(eve.role, Role::Observer, "a secret that was never given opens nothing");
    fixture::stop(server).await;
}

/// Passes bytes on between whoever connects and `server` until `cut`, and then nothing at all, while the
/// connections stay open: as a cable does that is pulled out.
async fn cable(server: std::net::SocketAddr, cut: CancellationToken, ends: TcpListener) {
    let mut held = Vec::new();
    let mut passing = JoinSet::new();
    while let Some(Ok((near, _))) = cut.run_until_cancelled(ends.accept()).await {
        let far = TcpStream::connect(server).await.expect("the server listens");
        let (near, far) = (Arc::new(near), Arc::new(far));
        for (from, to) in [(&near, &far), (&far, &near)] {
            passing.spawn(pass(Arc::clone(from), Arc::clone(to), cut.clone()));
        }
        held.push((near, far));
    }
    passing.join_all().await;
    std::future::pending::<()>().await;
    drop(held);
}

async fn pass(from: Arc<TcpStream>, to: Arc<TcpStream>, cut: CancellationToken) {
    let mut buffer = vec![0; 1 << 16];
    let passing = async {
        loop {
            from.readable().await.expect("an open connection");
            let Ok(count) = from.try_read(&mut buffer) else { continue };
            let mut sent = 0;
            while sent < count {
                to.writable().await.expect("an open connection");
                sent += to.try_write(&buffer[sent..count]).unwrap_or(0);
            }
            if count == 0 {
                return;
            }
        }
    };
    cut.run_until_cancelled(passing).await;
}

#[tokio::test]
async fn a_driver_whose_cable_is_cut_loses_the_lease_and_comes_back_to_it() {
    let (server, _orders) = start(Access::default());
    let ends = TcpListener::bind("127.0.0.1:0").await.expect("a free port");
    let address = ends.local_addr().expect("an address").to_string();
    let cut = CancellationToken::new();
    let mut tasks = JoinSet::new();
    tasks.spawn(cable(server.address(), cut.clone(), ends));

    let anna = Member::join_at(address, named("anna", Role::Driver), Bearer::default()).await;
    assert_eq!(anna.role, Role::Driver);
    let mut ben = Member::join(&server, named("ben", Role::Observer)).await;
    ben.roles(&[(anna.number, Role::Driver, false), (ben.number, Role::Observer, false)]).await;
    cut.cancel();
    // No end of the stream ever comes: the daemon has to find out.
    ben.roles(&[(ben.number, Role::Observer, false)]).await;
    let greeting = Greeting { resume: anna.resume.clone(), ..named("anna", Role::Observer) };
    let back = Member::join(&server, greeting).await;
    assert_eq!(back.role, Role::Driver, "nobody took it");
    tasks.abort_all();
    fixture::stop(server).await;
}

#[tokio::test]
async fn everyone_sees_who_is_there_and_what_they_show() {
    let (server, _orders) = start(Access::default());
    let mut anna = Member::join(&server, named("anna", Role::Driver)).await;
    let ben = Member::join(&server, named("ben", Role::Observer)).await;
    let gaze = Gaze { eye: [1.0, 2.0, 3.0], target: [0.0; 3] };
    let appearance = common::Appearance { gaze: Some(gaze), filter: "edges > 2".to_owned() };
    assert!(ben.session.say(ViewerEvent::Appearance(appearance.clone())), "there is room");
    let number = ben.number;
    anna.until(|event| match event {
        TracerEvent::Notice(Notice::Presence(presence)) => {
            (presence.get(number)?.appearance == appearance).then_some(())
        }
        _ => None,
    })
    .await;
    drop(ben);
    anna.roles(&[(anna.number, Role::Driver, false)]).await;
    fixture::stop(server).await;
}
