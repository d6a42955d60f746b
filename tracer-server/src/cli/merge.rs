//! `tracer-server merge`: one picture of films that were made apart.

use std::fs::File;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context as _, anyhow};
use clap::Args;
use comfy_table::Table;
use comfy_table::presets::UTF8_FULL_CONDENSED;
use host::file::Place;

use crate::image_file::Destination;
use crate::render::auto::{of_part, planes};
use crate::replicate::{Part, PartError, Selection};

/// Adds up films of replicates: bit for bit the picture of a single run.
///
/// The films are those of `render --film-out`, of the same scene, version and settings, and no replicate
/// may be in two of them. Their order makes no difference.
#[derive(Args, Clone, Debug)]
#[command(after_help = "\
Examples:
  tracer-server render door -o a.exr --replicates 0..4 --film-out a.lvf
  tracer-server render door -o b.exr --replicates 4..8 --film-out b.lvf
  tracer-server merge a.lvf b.lvf -o door.exr")]
pub struct MergeArgs {
    /// The films.
    #[arg(required = true, value_name = "PART.lvf")]
    pub parts: Vec<PathBuf>,
    /// Where to write the image: .exr keeps linear radiance, .png is exposed for viewing.
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// Where to write the sum as a film, to which more can be added.
    #[arg(long, value_name = "FILE.lvf")]
    pub film_out: Option<PathBuf>,
}

/// Reads a film of replicates.
pub(super) fn read(file: &Path) -> anyhow::Result<Part> {
    let name = || format!("`{}`", file.display());
    let opened = File::open(file).with_context(name)?;
    Part::read(opened).with_context(name)
}

/// Writes a film of replicates: beside its place, and then there, so that there is always a whole one.
pub(super) fn write(place: &Place, part: &Part) -> anyhow::Result<()> {
    place.write(|out| part.write(out)).map_err(|error| {
        if let PartError::File(problem) = error {
            anyhow!("cannot write `{}`: {problem}", place.path().display())
        } else {
            error.into()
        }
    })
}

/// Adds up, writes the picture and tells how far the parts disagree.
pub fn run(args: &MergeArgs) -> anyhow::Result<ExitCode> {
    let output = Destination::find(&args.output)?;
    let film_out = args.film_out.as_deref().map(Place::find).transpose()?;
    let mut table = Table::new();
    table.load_style(UTF8_FULL_CONDENSED).set_header([
        "film",
        "replicates",
        "mean",
        "+-",
        "off by",
    ]);
    let parts: Vec<Part> = args.parts.iter().map(|file| read(file)).collect::<Result<_, _>>()?;
    let (first, others) = parts.split_first().context("give at least one film")?;
    let mut sum = first.clone();
    for (part, file) in others.iter().zip(&args.parts[1..]) {
        sum.merge(part).with_context(|| format!("`{}`", file.display()))?;
    }
    let scale = f64::from_bits(sum.origin.radiance_scale);
    let all = sum.ledger.mean();
    for (part, file) in parts.iter().zip(&args.parts) {
        let mean = part.ledger.mean();
        let selection = Selection::of(part.ledger.rows().iter().map(|row| row.number));
        table.add_row([
            file.display().to_string(),
            selection.to_string(),
            format!("{:.6}", mean.mean * scale),
            format!("{:.6}", mean.error * scale),
            format!("{:+.2} standard errors", (mean.mean - all.mean) / mean.error),
        ]);
    }
    let (image, ledger) = of_part(&sum);
    let selection = Selection::of(ledger.rows().iter().map(|row| row.number));
    let metadata = [
        ("version", sum.origin.version.clone()),
        ("scene", sum.origin.scene.clone()),
        ("scene_hash", sum.origin.scene_hash.clone()),
        ("settings", sum.origin.settings.clone()),
        ("replicates", selection.to_string()),
    ];
    let metadata: Vec<_> =
        metadata.into_iter().map(|(key, value)| (format!("lvis.{key}"), value)).collect();
    output.write(&image, &planes(&ledger, scale), &metadata)?;
    if let Some(place) = &film_out {
        write(place, &sum)?;
    }
    let mut out = io::stdout().lock();
    writeln!(out, "{}", table.trim_fmt())?;
    writeln!(
        out,
        "{} replicates; noise {:.2} %; written to {}",
        ledger.count(),
        100.0 * ledger.noise(),
        args.output.display()
    )?;
    Ok(ExitCode::SUCCESS)
}
