//! The program in the hands of people who close terminals, fill disks and press Ctrl-C.
#![cfg(unix)]

use std::fs;
use std::io::{BufRead as _, BufReader, Read as _};
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::{Child, ChildStderr, Command, Output, Stdio};
use std::sync::mpsc::sync_channel;
use std::time::{Duration, Instant};

use common::{Role, TracerEvent};
use proto::v1::tracer_client::TracerClient;
use proto::{Hello, ProtocolVersion, ViewerEvent, v1};
use tracer_server::film::Film;
use tracer_server::image_file::read_exr;

/// Nothing here takes that long; what does hangs.
const PATIENCE: Duration = Duration::from_mins(1);

/// A shell that becomes the program after `preparation`.
fn program(preparation: &str, arguments: &[&str]) -> Command {
    let mut shell = Command::new("sh");
    shell.args(["-c", &format!("{preparation} exec \"$@\""), "sh"]);
    shell.arg(env!("CARGO_BIN_EXE_tracer-server")).args(arguments);
    shell
}

/// A running program, killed when the test is over.
struct Running(Child);

impl Running {
    fn signal(&self, name: &str) {
        let id = self.0.id().to_string();
        let sent = Command::new("kill").args(["-s", name, &id]).status().expect("kill runs");
        assert!(sent.success(), "the program is there to be told");
    }

    /// Its exit code.
    fn ends(&mut self) -> Option<i32> {
        let end = Instant::now() + PATIENCE;
        while Instant::now() < end {
            if let Some(status) = self.0.try_wait().expect("a child") {
                return status.code();
            }
            std::thread::sleep(Duration::from_millis(10));
        }
        panic!("the program hangs");
    }

    fn stderr(&mut self) -> BufReader<ChildStderr> {
        BufReader::new(self.0.stderr.take().expect("it is piped"))
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // It may have ended already.
        drop(self.0.kill().and_then(|()| self.0.wait()));
    }
}

/// A daemon on a small film, with its address; `preparation` is for the shell that starts it.
fn serve(preparation: &str, log: &str) -> (Running, String) {
    let arguments =
        ["serve", "--listen", "localhost:0", "--chains", "2", "--threads", "1", "--log", log];
    let mut child = program(preparation, &arguments)
        .args(["--width", "32", "--height", "24"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program runs");
    let mut line = String::new();
    let mut stdout = BufReader::new(child.stdout.take().expect("it is piped"));
    stdout.read_line(&mut line).expect("text");
    let address = line.trim_end().strip_prefix("listening on ").expect("the address");
    (Running(child), address.to_owned())
}

/// Watches until something of the chains has come.
async fn is_served(address: &str) {
    let watching = async {
        let mut client = TracerClient::connect(format!("http://{address}")).await.expect("listens");
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
        while let Some(message) = stream.message().await.expect("no error") {
            if let Ok(TracerEvent::Paths(_)) = TracerEvent::try_from(message) {
                return;
            }
        }
        panic!("the stream ended");
    };
    tokio::time::timeout(PATIENCE, watching).await.expect("paths come");
}

#[tokio::test]
async fn a_reader_of_the_log_that_goes_away_stops_nothing() {
    let (mut daemon, address) = serve("", "trace");
    drop(daemon.stderr());
    for _ in 0..3 {
        is_served(&address).await;
    }
    daemon.signal("TERM");
    assert_eq!(daemon.ends(), Some(0));
}

#[tokio::test]
async fn a_reader_of_the_log_that_does_not_read_stops_nothing() {
    let (mut daemon, address) = serve("", "trace");
    // So much is said at this level that any pipe is full after one viewer.
    for _ in 0..3 {
        is_served(&address).await;
    }
    daemon.signal("TERM");
    assert_eq!(daemon.ends(), Some(0), "the end waits for nobody");
    let mut pipe = String::new();
    daemon.stderr().read_to_string(&mut pipe).expect("text");
    // A pipe holds 64 KiB, but no part of a line that does not fit.
    assert!(pipe.len() > 60_000, "the pipe was full: {} bytes", pipe.len());
}

#[tokio::test]
async fn a_daemon_ends_with_its_terminal_unless_it_was_told_not_to() {
    let (mut daemon, _) = serve("", "warn");
    daemon.signal("HUP");
    assert_eq!(daemon.ends(), Some(0), "as SIGTERM does");
    let (mut daemon, address) = serve("trap '' HUP;", "warn");
    daemon.signal("HUP");
    is_served(&address).await;
    daemon.signal("TERM");
    assert_eq!(daemon.ends(), Some(0));
}

/// Seconds of processor time that a process has taken, as Linux tells.
fn cpu_seconds(process: u32) -> Option<f64> {
    let text = fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    let (_, fields) = text.rsplit_once(')')?;
    let ticks: Vec<f64> = fields.split(' ').skip(12).take(2).flat_map(str::parse).collect();
    // A hundred ticks a second, everywhere.
    Some(ticks.iter().sum::<f64>() / 100.0)
}

#[tokio::test]
async fn a_daemon_without_file_handles_waits_and_says_so_once() {
    let (mut daemon, address) = serve("ulimit -n 40;", "warn");
    let mut log = daemon.stderr();
    let mut idle = Vec::new();
    for _ in 0..60 {
        idle.push(tokio::net::TcpStream::connect(&address).await.expect("the system queues it"));
    }
    let (sender, lines) = sync_channel(100);
    let listen = move || {
        let mut line = String::new();
        while log.read_line(&mut line).is_ok_and(|read| read > 0) {
            if sender.send(std::mem::take(&mut line)).is_err() {
                return;
            }
        }
    };
    let thread = std::thread::Builder::new().name("log".to_owned()).spawn(listen);
    let first = lines.recv_timeout(PATIENCE).expect("it says so");
    assert!(first.contains("no connection can be accepted"), "{first}");
    // One thread draws paths all the time; a second one that spins would show.
    if let Some(before) = cpu_seconds(daemon.0.id()) {
        let began = Instant::now();
        tokio::time::sleep(Duration::from_secs(2)).await;
        let share =
            (cpu_seconds(daemon.0.id()).expect("Linux") - before) / began.elapsed().as_secs_f64();
        assert!(share < 1.5, "{share} cores are busy");
    } else {
        tests::skip("the system tells no processor time: whether the daemon spins is not seen");
    }
    drop(idle);
    is_served(&address).await;
    daemon.signal("TERM");
    assert_eq!(daemon.ends(), Some(0));
    drop(thread.expect("a thread").join());
    let again: Vec<String> = lines.try_iter().filter(|line| line.contains("accepted")).collect();
    assert!(again.is_empty(), "it says so once: {again:?}");
}

/// A render that goes on for longer than anybody waits, and is told to stop when it has an image.
fn stopped_by(signal: &str, file: &Path, report: &Path) -> (Option<i32>, String) {
    let size = ["--width", "16", "--height", "16", "--integrator", "mlt", "--chains", "8"];
    let child = program("", &["render", "cornell", "--time", "3600", "--log", "debug"])
        .args(size)
        .args([Path::new("-o"), file, Path::new("--stats-json"), report])
        .stderr(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("the program runs");
    let mut render = Running(child);
    let mut log = render.stderr();
    let mut told = String::new();
    while !told.contains("rendered") || told.contains(" 0.00 % rendered") {
        told.clear();
        assert!(log.read_line(&mut told).expect("text") > 0, "it ended early");
    }
    render.signal(signal);
    let mut rest = String::new();
    log.read_to_string(&mut rest).expect("text");
    (render.ends(), rest)
}

fn light(film: &Film) -> f64 {
    film.mean().luminance()
}

#[test]
fn a_stopped_render_keeps_its_image_and_says_so() {
    for (signal, code) in [("INT", 130), ("TERM", 143), ("HUP", 129)] {
        let folder = tempfile::tempdir().expect("a folder");
        let (file, report) = (folder.path().join("a.exr"), folder.path().join("a.json"));
        fs::write(&file, "old").expect("writable");
        let (ended, log) = stopped_by(signal, &file, &report);
        assert_eq!(ended, Some(code), "{signal}: {log}");
        assert!(light(&read_exr(&file).expect("an image")) > 0.0, "{signal}");
        let report: serde_json::Value =
            serde_json::from_str(&fs::read_to_string(&report).expect("a report")).expect("JSON");
        assert_eq!(report["stopped"], true, "{signal}");
        let so_far = format!("holds the image of the {} mutations so far", report["mutations"]);
        assert!(log.contains(&so_far), "{signal}: {log}");
    }
}

fn render(arguments: &[&str]) -> Output {
    let small = ["render", "--width", "8", "--height", "8", "--mutations-per-pixel", "4"];
    program("", &[&small[..], arguments].concat()).output().expect("the program runs")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn a_place_that_cannot_be_written_is_told_at_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let missing = folder.path().join("no/such/folder/a.exr").display().to_string();
    let image = folder.path().join("a.exr").display().to_string();
    for arguments in [
        ["-o", &missing, "--seed", "1"],
        ["-o", "/proc/self/a.exr", "--seed", "1"],
        ["-o", &image, "--film-out", &missing],
        ["-o", &image, "--stats-json", &missing],
    ] {
        // It would go on for an hour.
        let mut render = program("", &["render", "cornell", "--time", "3600"]);
        let mut child =
            Running(render.args(arguments).stderr(Stdio::piped()).spawn().expect("runs"));
        assert_eq!(child.ends(), Some(2), "{arguments:?}");
        let mut complaint = String::new();
        child.stderr().read_to_string(&mut complaint).expect("text");
        let named = arguments.iter().any(|place| complaint.contains(&format!("`{place}`")));
        assert!(named, "{arguments:?}: {complaint}");
    }
    assert!(fs::read_dir(folder.path()).expect("a folder").next().is_none(), "nothing is left");
}

/// No file may be larger than 4 blocks of 512 bytes, as on a disk that has room for no more.
const FULL: &str = "ulimit -f 4; trap '' XFSZ;";

#[test]
fn a_write_that_fails_half_way_leaves_what_was_there() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("a.exr");
    fs::write(&file, "old").expect("writable");
    let image = file.display().to_string();
    let arguments = ["render", "cornell", "--width", "64", "--height", "48", "-o", &image];
    let arguments = [&arguments[..], &["--mutations-per-pixel", "1"]].concat();
    // The limit fails the write, or kills the program in the midst of it.
    for (limit, code) in [(FULL, Some(2)), ("ulimit -f 4;", None)] {
        let output = program(limit, &arguments).output().expect("the program runs");
        assert_eq!(output.status.code(), code, "{}", text(&output.stderr));
        assert_eq!(fs::read(&file).expect("readable"), b"old", "{limit}");
        let told = code.is_none() || text(&output.stderr).contains("a.exr");
        assert!(told, "it names the file: {}", text(&output.stderr));
    }
}

#[test]
fn a_film_that_cannot_be_kept_costs_no_picture() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    let (image, film) = (path("a.png").display().to_string(), path("a.lvf").display().to_string());
    let small = ["render", "cornell", "--width", "32", "--height", "24", "-o", &image];
    let arguments = [&small[..], &["--mutations-per-pixel", "4", "--film-out", &film]].concat();
    let output = program(FULL, &arguments).output().expect("the program runs");
    let log = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{log}");
    assert!(log.contains("error: cannot write") && log.contains("a.lvf"), "{log}");
    assert!(fs::read(path("a.png")).expect("the picture").starts_with(b"\x89PNG"), "whole");
    assert!(!path("a.lvf").exists(), "no half of a film");
}

#[test]
fn a_full_device_is_told() {
    if !Path::new("/dev/full").exists() {
        tests::skip("there is no /dev/full");
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    symlink("/dev/full", path("full.exr")).expect("a link");
    let full = path("full.exr").display().to_string();
    let output = render(&["cornell", "-o", &full]);
    assert_eq!(output.status.code(), Some(2), "{}", text(&output.stderr));
    assert!(text(&output.stderr).contains("space"), "{}", text(&output.stderr));
    assert!(path("full.exr").is_symlink(), "the link stays");
}

#[test]
fn links_pipes_and_standard_output_take_an_image() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    let name = |name: &str| path(name).display().to_string();
    fs::write(path("target.exr"), "old").expect("writable");
    symlink("target.exr", path("link.exr")).expect("a link");
    assert!(render(&["cornell", "-o", &name("link.exr")]).status.success());
    assert!(path("link.exr").is_symlink(), "the link stays");
    let expected = read_exr(&path("target.exr")).expect("the target is replaced");

    let made = Command::new("mkfifo").arg(path("pipe.exr")).status();
    assert!(made.expect("mkfifo runs").success());
    let bytes = std::thread::scope(|scope| {
        let reader = scope.spawn(|| fs::read(path("pipe.exr")));
        assert!(render(&["cornell", "-o", &name("pipe.exr")]).status.success());
        reader.join().expect("no panic").expect("readable")
    });
    fs::write(path("from_pipe.exr"), bytes).expect("writable");

    let output = render(&["cornell", "-o", "/dev/stdout"]);
    assert!(text(&output.stderr).contains("written to"), "the report goes elsewhere");
    fs::write(path("from_stdout.exr"), output.stdout).expect("writable");
    for file in ["from_pipe.exr", "from_stdout.exr"] {
        let image = read_exr(&path(file)).expect("an image");
        assert_eq!(image.pixels(), expected.pixels(), "{file}");
    }
}

#[test]
fn a_name_in_any_script_is_no_end() {
    let folder = tempfile::tempdir().expect("a folder");
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes");
    for name in ["сцена", "l’été", "Küche", "場面 \"1\"; #2"] {
        let scene = folder.path().join(format!("{name}.toml"));
        fs::copy(scenes.join("cornell.toml"), &scene).expect("writable");
        let image = folder.path().join(format!("{name}.exr"));
        let (scene, image) = (scene.display().to_string(), image.display().to_string());
        let output = render(&[&scene, "-o", &image]);
        assert!(output.status.success(), "{name}: {}", text(&output.stderr));
        assert!(light(&read_exr(Path::new(&image)).expect("an image")) > 0.0, "{name}");
    }
}
