//! `tracer-server render`: one image, and the story of how it was made.

mod replicates;
mod report;

use std::io::{self, Write as _};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

use anyhow::ensure;
use clap::builder::RangedU64ValueParser;
use clap::{Args, ValueEnum};
use common::{mean_ratio, relative_mse};
use host::Writer;
use host::file::Place;

use super::chains::ChainArgs;
use super::input::{self, FilmSize};
use super::integrator::IntegratorName;
use super::meter::Meter;
use super::stopper::Stopper;
use crate::film::Film;
use crate::image_file::{self, Destination};
use crate::integrator::pssmlt::{PrimarySampler, PrimarySettings};
use crate::parallel::Stop;
use crate::render::{
    Budget, Integrator, Progress, RenderSettings, Rendering, Report, Wish, auto, render_until,
};
use crate::replicate::Part;
use crate::scene::{MAX_EDGES, Scene};

pub use replicates::{BaseName, DialArgs, ReplicateArgs};

use report::{metadata, print, work};

/// Mutations, or samples, for each pixel unless the user says otherwise.
const DEFAULT_PER_PIXEL: u64 = 256;
/// How long the end of the program waits for the reader of the report.
const PATIENCE: Duration = Duration::from_secs(1);

/// Renders one image, and prints a table of what the chains did.
///
/// The same scene, seed and options give the same image, whatever the number of threads. Ctrl-C, SIGTERM
/// and the end of the terminal write the image so far; exit codes are then 130, 143 and 129. An image
/// comes to its place whole: until then, what was there before stays.
#[derive(Args, Clone, Debug)]
#[command(after_help = "\
Examples:
  tracer-server render door -o door.png
  tracer-server render door -o door.exr --until 1% --film-out door.lvf
  tracer-server render door -o door.exr --time 60 --film-out door.lvf --resume
  tracer-server render door -o a.exr --replicates 0..8 --film-out a.lvf
  tracer-server render cornell -o cornell.exr --integrator bdpt --mutations-per-pixel 64
  tracer-server render caustic -o caustic.exr --time 30 --reference reference.exr
  tracer-server render caustic -o plain.exr --without caustic,multi-chain --tune lens.radius=0.5..8
  tracer-server render door -o pss.exr --integrator pssmlt --primary-sampler path --large-step 0.2
  tracer-server render scenes/room.toml -o room.exr --width 640 --height 480 --stats-json room.json")]
pub struct RenderArgs {
    /// A built-in scene, a .toml, .obj or Mitsuba .xml file, or a directory that holds one.
    pub scene: String,
    /// Where to write the image: .exr keeps linear radiance, .png is exposed for viewing; a pipe
    /// without a name gets EXR.
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// How to render.
    #[arg(long, value_enum, default_value = "auto")]
    pub integrator: IntegratorName,
    /// Mutations, or samples, for each pixel [default: 256].
    #[arg(long, value_name = "N", conflicts_with = "time")]
    #[arg(value_parser = RangedU64ValueParser::<u64>::new().range(1..=1 << 32))]
    pub mutations_per_pixel: Option<u64>,
    /// Render for this many seconds, seeding included.
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub time: Option<Duration>,
    /// The chains.
    #[command(flatten)]
    pub chains: ChainArgs,
    /// What `--integrator pssmlt` needs besides.
    #[command(flatten)]
    pub primary: PrimaryArgs,
    /// Which replicates `--integrator auto` makes.
    #[command(flatten)]
    pub replicates: ReplicateArgs,
    /// The film.
    #[command(flatten)]
    pub film: FilmSize,
    /// Longest path in edges from light to camera (1: a lamp seen directly); the scene's own
    /// without.
    #[arg(long, value_name = "EDGES")]
    #[arg(value_parser = RangedU64ValueParser::<usize>::new().range(1..=MAX_EDGES as u64))]
    pub max_depth: Option<usize>,
    /// An image to measure the error against.
    #[arg(long, value_name = "REF.exr")]
    pub reference: Option<PathBuf>,
    /// Where to write the report as JSON.
    #[arg(long, value_name = "FILE")]
    pub stats_json: Option<PathBuf>,
}

/// How chains move in primary-sample space.
#[derive(Args, Clone, Debug, Default)]
pub struct PrimaryArgs {
    /// The renderer whose random numbers `--integrator pssmlt` moves [default: bdpt].
    #[arg(long, value_enum, value_name = "RENDERER")]
    pub primary_sampler: Option<PrimarySamplerName>,
    /// Share of the steps of `--integrator pssmlt` that draw all numbers afresh [default: 0.3].
    #[arg(long, value_name = "SHARE", value_parser = share)]
    pub large_step: Option<f64>,
}

/// The renderers behind primary-sample space.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum PrimarySamplerName {
    /// Bidirectional path tracing.
    Bdpt,
    /// Path tracing with light sampling; cannot find caustics of lights that nothing can hit.
    Path,
}

impl PrimaryArgs {
    /// The settings, refused where `integrator` needs none.
    pub(super) fn settings(&self, integrator: IntegratorName) -> anyhow::Result<PrimarySettings> {
        let usual = PrimarySettings::default();
        let silent = self.primary_sampler.is_none() && self.large_step.is_none();
        ensure!(
            silent || integrator == IntegratorName::Pssmlt,
            "--primary-sampler and --large-step only apply to --integrator pssmlt"
        );
        let sampler = self.primary_sampler.map_or(usual.sampler, |name| match name {
            PrimarySamplerName::Bdpt => PrimarySampler::Bdpt,
            PrimarySamplerName::Path => PrimarySampler::Path,
        });
        Ok(PrimarySettings { sampler, large_step: self.large_step.unwrap_or(usual.large_step) })
    }
}

fn share(text: &str) -> Result<f64, String> {
    let share = text.parse().ok().filter(|share| (0.0..=1.0).contains(share));
    share.ok_or_else(|| "give a number from 0 to 1".to_owned())
}

/// A positive number of seconds.
pub(super) fn seconds(text: &str) -> Result<Duration, String> {
    let time = text.parse().ok().and_then(|seconds| Duration::try_from_secs_f64(seconds).ok());
    time.filter(|time| !time.is_zero()).ok_or_else(|| "give a positive number".to_owned())
}

/// Renders, writes the image and prints the report.
pub fn run(args: &RenderArgs) -> anyhow::Result<ExitCode> {
    let job = Job::new(args)?;
    let file = args.output.display();
    let stopper = Stopper::listen(format!("saving the image so far in `{file}`"))?;
    job.run(&stopper)
}

/// A render whose scene is loaded and whose files have a place: what would only fail after the work
/// has been looked at before it.
struct Job {
    scene: Scene,
    settings: RenderSettings,
    reference: Option<Film>,
    image: Destination,
    stats: Option<Place>,
    film_out: Option<Place>,
    replicates: ReplicateArgs,
}

impl Job {
    fn new(args: &RenderArgs) -> anyhow::Result<Self> {
        args.chains.check(args.integrator)?;
        let primary = args.primary.settings(args.integrator)?;
        let dial = args.replicates.dial(args.integrator)?;
        let image = Destination::find(&args.output)?;
        let stats = args.stats_json.as_deref().map(Place::find).transpose()?;
        let film_out = args.replicates.film_out.as_deref().map(Place::find).transpose()?;
        ensure!(
            args.stats_json.as_ref() != Some(&args.output),
            "--stats-json and --output name the same file"
        );
        let (scene, wishes) = input::scene_with_depth(&args.scene, args.film, args.max_depth)?;
        let reference = args.reference.as_deref().map(image_file::read_exr).transpose()?;
        if let Some(reference) = &reference {
            check_reference(reference, &scene)?;
        }
        let settings = RenderSettings {
            integrator: args.integrator.into(),
            budget: match (args.time, args.mutations_per_pixel) {
                (Some(time), _) => Budget::Time(time),
                (None, mutations) => Budget::PerPixel(mutations.unwrap_or(DEFAULT_PER_PIXEL)),
            },
            ensemble: args.chains.for_a_picture(&scene, &wishes)?,
            primary,
            dial,
        };
        let replicates = args.replicates.clone();
        Ok(Self { scene, settings, reference, image, stats, film_out, replicates })
    }

    fn run(&self, stopper: &Stopper) -> anyhow::Result<ExitCode> {
        let Self { scene, settings, .. } = self;
        let begun = self.replicates.begun()?;
        let what = format!("{}, {}", scene.name(), settings.integrator.name());
        let meter = Meter::new(what, "rendered");
        let (rendering, kept) = self.make(begun, stopper.stop(), &meter)?;
        let Rendering { image, mut report, errors } = rendering;
        meter.finish();
        let stopped = if report.stopped { stopper.ending() } else { None };
        let code = stopped.map_or(ExitCode::SUCCESS, |ending| ending.exit_code().into());
        let file = self.image.path().display();
        if report.stopped && report.mutations == 0 {
            tracing::warn!("stopped before there was an image: `{file}` is unchanged");
            return Ok(code);
        }
        if let Some(reference) = &self.reference {
            report.relative_mse = Some(relative_mse(image.pixels(), reference.pixels()));
            report.mean_ratio = Some(mean_ratio(image.pixels(), reference.pixels()));
            report.reference_missing = missing(reference);
        }
        let planes = errors.map(|ledger| auto::planes(&ledger, scene.radiance_scale()));
        self.image.write(&image, &planes.unwrap_or_default(), &metadata(&report))?;
        if let Some(stats) = &self.stats {
            stats.write_bytes(serde_json::to_string_pretty(&report)?.as_bytes())?;
        }
        if report.stopped {
            let (done, work) = (report.mutations, work(&report));
            tracing::warn!("stopped: `{file}` holds the image of the {done} {work} so far");
        }
        self.tell(&report)?;
        // The picture is safe; that its film is not must still be no success.
        kept?;
        Ok(code)
    }

    /// Makes the picture, and keeps its replicates where that is wanted; with what came of the last time
    /// that they were kept.
    fn make(
        &self,
        begun: Option<Part>,
        stop: &Stop,
        meter: &Meter,
    ) -> anyhow::Result<(Rendering, anyhow::Result<()>)> {
        let Self { scene, settings, replicates, .. } = self;
        if settings.integrator != Integrator::Auto {
            return Ok((render_until(stop, scene, settings, |at| show(meter, at)), Ok(())));
        }
        let mut kept = Ok(());
        let mut save = |part: &Part| {
            kept = self.film_out.as_ref().map_or(Ok(()), |place| super::merge::write(place, part));
            if let Err(error) = &kept {
                tracing::warn!("{error:#}");
            }
        };
        let wish = Wish {
            selection: replicates.replicates.clone(),
            begun,
            until: replicates.until,
            stop: stop.clone(),
            save: self.film_out.is_some().then_some(&mut save),
        };
        let rendering = auto::render(scene, settings, wish, &mut |at| show(meter, at))?;
        Ok((rendering, kept))
    }

    /// Prints the report, on standard error where the image itself went to standard output.
    fn tell(&self, report: &Report) -> io::Result<()> {
        let mut text = Vec::new();
        print(&mut text, report, &self.image)?;
        if self.image.is_stdout() {
            let error = Writer::stderr();
            error.say(text);
            error.settle(PATIENCE);
            return Ok(());
        }
        match io::stdout().write_all(&text) {
            // The image is safe, whether or not anybody reads on.
            Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
            told => told,
        }
    }
}

/// Refuses a reference of another size than the scene's film.
pub(super) fn check_reference(reference: &Film, scene: &Scene) -> anyhow::Result<()> {
    let camera = scene.camera();
    ensure!(
        (reference.width(), reference.height()) == (camera.width, camera.height),
        "the reference has {} x {} pixels and the film {} x {}; set the film's size with --width \
        and --height",
        reference.width(),
        reference.height(),
        camera.width,
        camera.height,
    );
    Ok(())
}

/// Pixels for which a reference has no value.
pub(super) fn missing(reference: &Film) -> usize {
    reference.pixels().iter().filter(|pixel| !pixel.is_finite()).count()
}

fn show(meter: &Meter, progress: Progress) {
    match progress {
        Progress::Seeding(samples) => meter.tell(format!("seeding: {samples} samples")),
        Progress::Rendering(share) => {
            tracing::debug!("{:.2} % rendered", 100.0 * share);
            meter.show(share, "");
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser as _;

    use super::*;
    use crate::cli::{Cli, Command};

    fn parse(line: &str) -> Result<RenderArgs, String> {
        let cli = Cli::try_parse_from(line.split(' ')).map_err(|error| error.to_string())?;
        match cli.command {
            Command::Render(args) => Ok(args),
            _ => Err("another subcommand".to_owned()),
        }
    }

    #[test]
    fn budgets_exclude_each_other() {
        let line = "tracer-server render cornell -o a.exr --time 3 --mutations-per-pixel 4";
        assert!(parse(line).expect_err("both budgets").contains("cannot be used with"));
        for bad in ["0", "-1", "nan", "inf", "soon"] {
            let line = format!("tracer-server render cornell -o a.exr --time={bad}");
            assert!(parse(&line).is_err(), "--time {bad} must be refused");
        }
        let args = parse("tracer-server render cornell -o a.exr --time 0.5").expect("a budget");
        assert_eq!(args.time, Some(Duration::from_millis(500)));
    }

    #[test]
    fn a_render_leaves_an_image_and_a_report() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let image = folder.path().join("a.exr");
        let json = folder.path().join("a.json");
        for (integrator, options) in
            [("mlt", "--chains 16"), ("pssmlt", "--chains 16"), ("bdpt", ""), ("path", "")]
        {
            let line = format!(
                "tracer-server render cornell --width 16 --height 16 --mutations-per-pixel 4 \
                 --integrator {integrator} {options} -o {} --stats-json {}",
                image.display(),
                json.display(),
            );
            let line = line.split_whitespace().collect::<Vec<_>>().join(" ");
            let job = Job::new(&parse(&line).expect("valid arguments")).expect("sound");
            job.run(&Stopper::default()).expect("a render");
            let film = image_file::read_exr(&image).expect("an image");
            assert!(film.mean().luminance() > 0.0, "{integrator}: the image is black");
            let text = std::fs::read_to_string(&json).expect("a report");
            let report: serde_json::Value = serde_json::from_str(&text).expect("JSON");
            assert_eq!(report["integrator"], integrator);
            assert!(report["mutations"].as_u64() >= Some(1024), "{integrator}: {text}");
        }
        let line =
            format!("tracer-server render cornell -o {}/no/such/a.png", folder.path().display());
        let error = complaint(&line);
        assert!(error.contains("there is no such folder"), "{error}");
    }

    /// Why a render does not even start.
    fn complaint(line: &str) -> String {
        let job = Job::new(&parse(line).expect("valid arguments"));
        job.err().map_or_else(|| panic!("{line} is done"), |error| format!("{error:#}"))
    }

    #[test]
    fn options_that_would_change_nothing_are_refused() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let file = folder.path().join("a.exr");
        let line = |integrator: &str, option: &str| {
            let file = file.display();
            format!("tracer-server render cornell --integrator {integrator} {option} -o {file}")
        };
        let strategies = ["--strategies lens", "--without lens", "--tune lens.radius=1..2"];
        for option in [&strategies[..], &["--adapt off"]].concat() {
            for integrator in ["pssmlt", "bdpt", "path"] {
                let complaint = complaint(&line(integrator, option));
                let name = option.split(' ').next().expect("a name");
                assert!(complaint.starts_with(name), "{integrator} {option}: {complaint}");
            }
            Job::new(&parse(&line("mlt", option)).expect("valid")).expect(option);
        }
        for integrator in ["bdpt", "path"] {
            let complaint = complaint(&line(integrator, "--chains 8"));
            assert!(complaint.starts_with("--chains would have no effect"), "{complaint}");
        }
        Job::new(&parse(&line("pssmlt", "--chains 8")).expect("valid")).expect("it has chains");
        let same = format!("--stats-json {}", file.display());
        assert!(complaint(&line("path", &same)).contains("the same file"));
    }

    #[test]
    fn a_render_that_is_stopped_at_once_leaves_the_old_image() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let file = folder.path().join("a.exr");
        std::fs::write(&file, b"old").expect("writable");
        let line = format!("tracer-server render cornell -o {}", file.display());
        let job = Job::new(&parse(&line).expect("valid arguments")).expect("sound");
        let stopper = Stopper::default();
        stopper.stop().set();
        job.run(&stopper).expect("no failure");
        assert_eq!(std::fs::read(&file).expect("readable"), b"old");
    }
}
