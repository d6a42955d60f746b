//! The command line.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use anyhow::{Context as _, anyhow};
use clap::{Args, Parser, Subcommand};
use common::{FilterText, Order, PathId};

use crate::app::share;
use crate::command::{self, Command};
use crate::source::connection::{Bearer, Fingerprint, Peer, Trust};

const EXAMPLES: &str = "\
Examples:
  viewer-client                          a built-in scene, with a daemon of its own
  viewer-client --scene caustic          another one, or a scene file
  viewer-client 127.0.0.1:50061          a running `tracer-server serve`
  viewer-client render-box:50061 --token-file token --fingerprint 3F:A2:...
  viewer-client --headless --screenshot-to view.png --wait-paths 20000
  viewer-client paths.txt                plays light paths printed by Mitsuba 0.6
  viewer-client watch 127.0.0.1:50061 --count 10
  viewer-client watch 127.0.0.1:50061 --focus --order 'explorer seed newest' \
      --order 'explorer step 20' --order 'explorer fan 2 8'
  viewer-client bench --paths 10000,100000";

/// Shows a scene, its light paths, and the image they form.
#[derive(Debug, Parser)]
#[command(
    name = "viewer-client",
    version,
    subcommand_negates_reqs = true,
    args_conflicts_with_subcommands = true,
    after_help = EXAMPLES,
    after_long_help = long_help()
)]
pub struct Cli {
    /// What to do instead of opening a window.
    #[command(subcommand)]
    pub action: Option<Action>,
    /// The window.
    #[command(flatten)]
    pub view: ViewArgs,
}

/// What else there is.
#[derive(Debug, Subcommand)]
pub enum Action {
    /// Prints what a daemon sends, one line per batch of paths.
    Watch(Box<WatchArgs>),
    /// Measures how fast random paths are drawn, without a window or a daemon.
    Bench(BenchArgs),
}

/// How to view.
#[derive(Clone, Debug, Args)]
pub struct ViewArgs {
    /// HOST:PORT of a running daemon, a link to a view of one (lvis://...), or a file of paths as
    /// Mitsuba 0.6 prints them; without any, a daemon is started inside this program.
    #[arg(value_name = "ADDR|FILE", value_parser = source)]
    pub source: Option<Target>,
    /// How a remote daemon is trusted.
    #[command(flatten)]
    pub trust: TrustArgs,
    /// Built-in scene or scene file for the daemon inside this program.
    #[arg(long, value_name = "SCENE", conflicts_with = "source")]
    pub scene: Option<String>,
    /// Built-in scene or scene file whose surfaces are shown with a file of paths.
    #[arg(long, value_name = "SCENE", requires = "source")]
    pub surfaces: Option<String>,
    /// Draws without a window.
    #[arg(long, requires = "screenshot_to")]
    pub headless: bool,
    /// Where to write the picture of the whole window, as PNG.
    #[arg(long, value_name = "OUT.png", requires = "headless")]
    pub screenshot_to: Option<PathBuf>,
    /// Size of the headless window in pixels.
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = size)]
    pub size: [u32; 2],
    /// Waits for this many paths before the picture is taken.
    #[arg(long, value_name = "N", conflicts_with = "wait", requires = "headless")]
    pub wait_paths: Option<u64>,
    /// Waits this many seconds before the picture is taken.
    #[arg(long, value_name = "S", value_parser = seconds, requires = "headless")]
    pub wait: Option<Duration>,
    /// A file of commands to run at the start, one per line; `--help` lists them.
    #[arg(long, value_name = "SCRIPT")]
    pub run: Option<PathBuf>,
}

/// Where paths come from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Target {
    /// HOST:PORT of a daemon, or a link to a view of one.
    Daemon(String),
    /// A file of paths.
    File(PathBuf),
}

/// What to print.
#[derive(Clone, Debug, Args)]
pub struct WatchArgs {
    /// HOST:PORT of a running daemon.
    #[arg(value_name = "ADDR", value_parser = address)]
    pub address: String,
    /// How the daemon is trusted.
    #[command(flatten)]
    pub trust: TrustArgs,
    /// Which paths to show, such as `lpe "CDS+L"` or `any in sphere(0, 1, 0, 0.5)`; see
    /// docs/FILTERS.md.
    #[arg(long, value_name = "TEXT", value_parser = filter)]
    pub filter: Option<FilterText>,
    /// Prints one JSON object per line.
    #[arg(long)]
    pub json: bool,
    /// Prints the steps of the explorer, and who steers, instead of batches.
    #[arg(long)]
    pub focus: bool,
    /// Gives an order as the driver, such as `explorer step 20`; may be repeated. Each order is
    /// sent when the previous one is done, and the program ends after the last one unless the
    /// explorer is playing.
    #[arg(long, value_name = "ORDER", value_parser = order, requires = "focus")]
    pub order: Vec<Order>,
    /// Prints the numbers behind a recently shown path, such as `3.0.1520`, and ends: densities,
    /// throughputs, geometry terms and the weight of every split, in the daemon's units (see
    /// docs/NOTATION.md).
    #[arg(long, value_name = "CHAIN.EPOCH.STEP", conflicts_with_all = ["filter", "focus", "count"])]
    pub inspect: Option<PathId>,
    /// Ends after this many batches, or steps of the explorer.
    #[arg(long, value_name = "N")]
    pub count: Option<u64>,
}

/// What to measure.
#[derive(Clone, Debug, Args)]
pub struct BenchArgs {
    /// Numbers of paths, one measurement each.
    #[arg(
        long,
        value_name = "N,...",
        default_value = "10000,100000,1000000",
        value_delimiter = ',',
        value_parser = clap::value_parser!(u32).range(1..=10_000_000)
    )]
    pub paths: Vec<u32>,
    /// Vertices per path.
    #[arg(long, value_name = "K", default_value = "6", value_parser = clap::value_parser!(u8).range(2..=64))]
    pub vertices: u8,
    /// Size of the picture in pixels.
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = size)]
    pub size: [u32; 2],
    /// Prints one JSON object per line.
    #[arg(long)]
    pub json: bool,
}

/// How a daemon is trusted, and which token it is shown.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Connection")]
pub struct TrustArgs {
    /// File with the token that the daemon asks for.
    #[arg(long, value_name = "FILE")]
    pub token_file: Option<PathBuf>,
    /// Encrypts, and trusts certificates signed by this one (PEM).
    #[arg(long, value_name = "FILE", conflicts_with = "fingerprint")]
    pub ca_cert: Option<PathBuf>,
    /// Encrypts, and trusts the one certificate whose fingerprint the daemon has printed.
    #[arg(long, value_name = "SHA256")]
    pub fingerprint: Option<Fingerprint>,
}

impl TrustArgs {
    /// The daemon at `address`; reads the files.
    pub fn peer(&self, address: String) -> anyhow::Result<Peer> {
        let read = |file: &PathBuf| {
            fs::read_to_string(file).with_context(|| format!("cannot read {}", file.display()))
        };
        let token = match &self.token_file {
            Some(file) => {
                let problem = |problem| anyhow!("{}: {problem}", file.display());
                Bearer::new(&read(file)?).map_err(problem)?
            }
            None => Bearer::default(),
        };
        let trust = match (self.fingerprint, &self.ca_cert) {
            (Some(fingerprint), _) => Trust::Pinned(fingerprint),
            (None, Some(file)) => Trust::Authority(read(file)?),
            (None, None) => Trust::Plain,
        };
        Ok(Peer { address, trust, token })
    }
}

fn long_help() -> String {
    let comment = ("# ...".to_owned(), "A comment, up to the end of the line".to_owned());
    let lines = command::forms().map(|form| (form.text(), form.help())).chain([comment]);
    let lines: Vec<String> = lines.map(|(form, help)| format!("  {form:<50} {help}")).collect();
    let commands = lines.join("\n");
    format!(
        "{EXAMPLES}\n\nCommands for --run (keys and menus use the same ones; --order takes those \
        that give orders):\n{commands}"
    )
}

/// Endings of scene files.
const SCENES: [&str; 3] = ["toml", "xml", "obj"];

fn source(text: &str) -> Result<Target, String> {
    if text.starts_with(share::SCHEME) {
        return address_or_link(text).map(Target::Daemon);
    }
    let path = Path::new(text);
    if path.is_dir() {
        return Err(format!(
            "this is a folder; give a file of paths in it, or open the scene in it with `--scene \
            {text}`"
        ));
    }
    if path.is_file() {
        let ending = path.extension().unwrap_or_default();
        return if SCENES.iter().any(|scene| ending.eq_ignore_ascii_case(scene)) {
            Err(format!("this is a scene, not a file of paths; open it with `--scene {text}`"))
        } else {
            Ok(Target::File(path.to_owned()))
        };
    }
    // Addresses have a colon, and names of scenes have none.
    let scene = if text.contains(':') {
        String::new()
    } else {
        format!("; to open a scene, built in or a file, use `--scene {text}`")
    };
    let no_file = |complaint| format!("there is no such file; for a daemon, {complaint}{scene}");
    address(text).map(Target::Daemon).map_err(no_file)
}

fn address(text: &str) -> Result<String, String> {
    let text = text.trim_start_matches("http://");
    let port = text.rsplit_once(':').map(|(host, port)| (host.is_empty(), port.parse::<u16>()));
    match port {
        Some((false, Ok(_))) => Ok(text.to_owned()),
        _ => Err("write HOST:PORT, such as 127.0.0.1:50061".to_owned()),
    }
}

fn address_or_link(text: &str) -> Result<String, String> {
    if !text.starts_with(share::SCHEME) {
        return address(text);
    }
    let shared = share::read(text).map_err(|error| error.to_string())?;
    let no_link =
        |complaint| format!("the link has no daemon: after {}, {complaint}", share::SCHEME);
    address(&shared.address).map(|_| text.to_owned()).map_err(no_link)
}

/// A filter whose grammar is right; whether its names are is for the daemon to say.
fn filter(text: &str) -> Result<FilterText, String> {
    let filter = FilterText::read(text);
    let complaint = filter.error().map(|error| format!("\n{}", error.pointed(text)));
    complaint.map_or(Ok(filter), Err)
}

/// One of the commands that steer.
fn order(text: &str) -> Result<Order, String> {
    match text.parse() {
        Ok(Command::Order(order)) => Ok(order),
        Ok(_) => Err("orders begin with `explorer`, `chains` or `lease`".to_owned()),
        Err(error) => Err(error.to_string()),
    }
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let complaint = || "write WxH, such as 1280x720; each side from 64 to 8192".to_owned();
    let (width, height) = text.split_once(['x', 'X', '×']).ok_or_else(complaint)?;
    let side = |text: &str| text.parse().ok().filter(|side| (64..=8192).contains(side));
    match (side(width), side(height)) {
        (Some(width), Some(height)) => Ok([width, height]),
        _ => Err(complaint()),
    }
}

fn seconds(text: &str) -> Result<Duration, String> {
    let seconds: f32 = text.parse().map_err(|error| format!("`{text}`: {error}"))?;
    let range = Duration::ZERO..=Duration::from_hours(24);
    let duration = Duration::try_from_secs_f32(seconds).ok().filter(|d| range.contains(d));
    duration.ok_or_else(|| "write seconds, from 0 to 86400".to_owned())
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory as _;

    use super::*;

    #[test]
    fn the_definition_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn the_contract_parses() {
        let parse = |line: &str| Cli::try_parse_from(line.split(' '));
        let cli = parse("viewer-client").expect("no arguments");
        assert!(cli.view.source.is_none() && cli.action.is_none(), "the embedded daemon");
        let cli = parse(
            "viewer-client 127.0.0.1:5 --headless --screenshot-to a.png --size 640x360 --wait 2.5",
        );
        let view = cli.expect("a screenshot").view;
        assert_eq!(view.size, [640, 360], "size");
        assert_eq!(view.wait, Some(Duration::from_millis(2500)), "seconds");
        let cli = parse("viewer-client watch [::1]:50061 --json --count 3 --filter edges>3")
            .expect("watch");
        assert!(
            matches!(cli.action, Some(Action::Watch(w)) if w.json && w.count == Some(3) && w.filter == Some(FilterText::read("edges>3"))),
            "w"
        );
    }

    #[test]
    fn who_is_mistaken_is_told_what_to_do() {
        let folder = tempfile::tempdir().expect("a folder");
        let scene = folder.path().join("room.TOML");
        fs::write(&scene, "").expect("a scene");
        let (scene, folder) = (scene.display().to_string(), folder.path().display().to_string());
        for (text, part, other) in [
            ("caustic", "`--scene caustic`", "folder"),
            ("nowhere.toml", "`--scene nowhere.toml`", "folder"),
            (scene.as_str(), "this is a scene", "no such file"),
            (folder.as_str(), "this is a folder", "no such file"),
            ("lvis://abc", "the link has no daemon", "no such file"),
            ("render-box:99999", "no such file; for a daemon, write HOST:PORT", "--scene"),
        ] {
            let said = source(text).expect_err(text);
            assert!(said.contains(part) && !said.contains(other), "`{text}`: {said}");
        }
        let link = source("lvis://127.0.0.1:5#camera%20frame");
        assert!(matches!(link, Ok(Target::Daemon(_))), "{link:?}");
    }

    #[test]
    fn nonsense_is_refused() {
        for line in [
            "viewer-client nowhere",
            "viewer-client lvis://nowhere#camera%20frame",
            "viewer-client lvis://127.0.0.1:5#quit",
            "viewer-client watch 127.0.0.1:5 --filter edges",
            "viewer-client watch 127.0.0.1:5 --order explorer",
            "viewer-client :50061",
            "viewer-client 127.0.0.1:99999",
            "viewer-client 127.0.0.1:5 --scene cornell",
            "viewer-client --surfaces cornell",
            "viewer-client --headless",
            "viewer-client --headless --screenshot-to a.png --size 10x10",
            "viewer-client --headless --screenshot-to a.png --size 640",
            "viewer-client --headless --screenshot-to a.png --wait -1",
            "viewer-client --headless --screenshot-to a.png --wait nan",
            "viewer-client --headless --screenshot-to a.png --wait 1 --wait-paths 1",
        ] {
            assert!(Cli::try_parse_from(line.split(' ')).is_err(), "`{line}` was accepted");
        }
    }
}
