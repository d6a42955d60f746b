//! The program itself: what scripts rely on.

use std::io::{BufRead as _, BufReader};
use std::process::{Child, ChildStdout, Command, Output, Stdio};
use std::time::Duration;

use common::{Role, TracerEvent};
use proto::v1::tracer_client::TracerClient;
use proto::{Hello, ProtocolVersion, ViewerEvent, v1};

/// Nothing here takes that long; what does hangs.
const PATIENCE: Duration = Duration::from_mins(1);

/// A running `serve`, killed when the test is over.
struct Served {
    child: Child,
    address: String,
    _stdout: BufReader<ChildStdout>,
}

impl Served {
    /// Starts the program and waits until it listens.
    fn start() -> Self {
        let mut child = program()
            .args(["serve", "--listen", "127.0.0.1:0", "--chains", "2", "--threads", "1"])
            .args(["--width", "32", "--height", "24", "--log", "warn"])
            .stdout(Stdio::piped())
            .spawn()
            .expect("the program runs");
        let mut stdout = BufReader::new(child.stdout.take().expect("it is piped"));
        let mut line = String::new();
        stdout.read_line(&mut line).expect("text");
        let address = line.trim_end().strip_prefix("listening on ").expect("the address");
        Self { address: address.to_owned(), child, _stdout: stdout }
    }

    #[cfg(unix)]
    fn signal(&self, name: &str) {
        let id = self.child.id().to_string();
        let sent = Command::new("kill").args(["-s", name, &id]).status().expect("kill runs");
        assert!(sent.success(), "the program is there to be told");
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        drop(self.child.kill());
        drop(self.child.wait());
    }
}

fn program() -> Command {
    Command::new(env!("CARGO_BIN_EXE_tracer-server"))
}

fn run(arguments: &[&str]) -> Output {
    program().args(arguments).output().expect("the program runs")
}

/// Watches until the daemon says goodbye, and returns why it did; `told` runs once the viewer is
/// welcome.
async fn watch_to_the_end(address: &str, told: impl FnOnce()) -> String {
    let mut client = TracerClient::connect(format!("http://{address}")).await.expect("it listens");
    let hello = Hello {
        version: ProtocolVersion::CURRENT,
        viewer_name: "test".to_owned(),
        wanted_role: Role::Observer,
        data_budget: 0,
        filter: None,
        focus: false,
        resume: String::new(),
    };
    let messages = tokio_stream::once(v1::ViewerMessage::from(ViewerEvent::Hello(hello)));
    let mut stream = client.watch(messages).await.expect("welcome").into_inner();
    let mut told = Some(told);
    while let Some(message) = stream.message().await.expect("no error") {
        match TracerEvent::try_from(message).expect("well-formed") {
            TracerEvent::SnapshotEnd => told.take().expect("one snapshot")(),
            TracerEvent::Goodbye(reason) => return reason,
            _ => {}
        }
    }
    panic!("the stream ended without a goodbye");
}

#[cfg(unix)]
#[tokio::test]
async fn signals_end_the_daemon_and_viewers_are_told() {
    for signal in ["INT", "TERM"] {
        let mut served = Served::start();
        let watching = watch_to_the_end(&served.address, || served.signal(signal));
        let reason = tokio::time::timeout(PATIENCE, watching).await.expect("a goodbye in time");
        assert!(reason.contains("shutting down"), "{signal}: {reason}");
        let status = tokio::task::spawn_blocking(move || served.child.wait().unwrap());
        let status = tokio::time::timeout(PATIENCE, status).await.expect("an end in time");
        assert_eq!(status.expect("no panic").code(), Some(0), "{signal} is no failure");
    }
}

#[test]
fn bad_usage_is_told_and_exits_with_two() {
    for (arguments, named) in [
        (&["serve", "--listen", "0.0.0.0:0"][..], "--insecure"),
        (&["serve", "no-such-scene"], "no-such-scene"),
        (&["serve", "--chains", "0"], "--chains"),
        (&["serve", "--width", "64"], "--height"),
        (&["serve", "--log", "=="], "--log"),
        (&["dance"], "dance"),
    ] {
        let output = run(arguments);
        let message = String::from_utf8(output.stderr).expect("text");
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
        assert!(message.contains(named), "{arguments:?} must name {named}: {message}");
        assert!(output.stdout.is_empty(), "{arguments:?}: results go to stdout, errors do not");
    }
}

#[test]
fn a_taken_port_is_told() {
    let taken = std::net::TcpListener::bind("127.0.0.1:0").expect("a free port");
    let address = taken.local_addr().expect("it has one").to_string();
    let output = run(&["serve", "--listen", &address]);
    let message = String::from_utf8(output.stderr).expect("text");
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(message.contains(&address), "{message}");
}

#[test]
fn help_shows_examples() {
    for arguments in [&["--help"][..], &["serve", "--help"]] {
        let output = run(arguments);
        let text = String::from_utf8(output.stdout).expect("text");
        assert!(output.status.success() && text.contains("Examples:"), "{arguments:?}: {text}");
    }
}
