//! `tracer-server info SCENE`: what a scene holds, and what the tracer makes of it.

use std::fmt::Display;
use std::io::{self, Write};
use std::process::ExitCode;
use std::time::Instant;

use clap::Args;
use comfy_table::Table;
use comfy_table::presets::{NOTHING, UTF8_FULL_CONDENSED};
use common::Rgb;
use glam::DVec3;

use crate::bsdf::{MODELS, ModelKind, Parameter};
use crate::cli::inventory::{Inventory, LightRow, MaterialRow};
use crate::scene::Scene;
use crate::scene::load::load;

/// Describes a scene: shapes, materials, lights, camera, what is not modelled, and what the
/// tracer may therefore leave out.
#[derive(Args, Clone, Debug)]
#[command(after_help = examples_and_models())]
pub struct InfoArgs {
    /// A built-in scene, a .toml, .obj or Mitsuba .xml file, or a directory that holds one.
    pub scene: String,
    /// Print JSON instead of tables.
    #[arg(long)]
    pub json: bool,
}

/// Examples, and what a material of a .toml scene may say.
fn examples_and_models() -> String {
    let examples = "\
Examples:
  tracer-server info cornell
  tracer-server info models/CornellBox-Water.obj
  tracer-server info scenes/veach-ajar --json

Material models in .toml scenes, with their parameters:";
    let lines = |kind: &ModelKind| {
        let parameter = |p: &Parameter| format!("\n      {:14} {}", p.name, p.about);
        let parameters: String = kind.parameters.iter().map(parameter).collect();
        format!("\n  {}: {}{parameters}", kind.name, kind.about)
    };
    let models: String = MODELS.iter().map(lines).collect();
    format!("{examples}{models}")
}

/// Loads the scene and prints what it holds.
pub fn run(args: &InfoArgs) -> anyhow::Result<ExitCode> {
    let start = Instant::now();
    let loaded = load(&args.scene)?;
    let load_seconds = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let scene = Scene::new(&loaded.description)?;
    let build_seconds = start.elapsed().as_secs_f64();
    let mut inventory = Inventory::new(&loaded, &scene);
    inventory.load_seconds = load_seconds;
    inventory.build_seconds = build_seconds;

    let mut out = io::stdout().lock();
    if args.json {
        writeln!(out, "{}", serde_json::to_string_pretty(&inventory)?)?;
    } else {
        print(&mut out, &inventory)?;
    }
    Ok(ExitCode::SUCCESS)
}

fn print(out: &mut impl Write, inventory: &Inventory) -> io::Result<()> {
    let low = DVec3::from_array(inventory.bounds[0]);
    let high = DVec3::from_array(inventory.bounds[1]);
    let camera = &inventory.camera;
    let seconds =
        format!("{:.3} s, built in {:.3} s", inventory.load_seconds, inventory.build_seconds);
    let mut table = table(&[]);
    let mut row = |name: &str, value: &dyn Display| {
        table.add_row(vec![name.to_owned(), value.to_string()]);
    };
    row("scene", &inventory.name);
    row("triangles", &inventory.triangles);
    row("spheres", &inventory.spheres);
    row("bounding box", &format!("{} to {}", point(low), point(high)));
    row("size", &point(high - low));
    row("camera", &format!("{} towards {}", point(camera.origin), point(camera.target)));
    row("vertical field of view", &format!("{} degrees", short(camera.vertical_fov)));
    row("film", &format!("{} x {} pixels", inventory.film[0], inventory.film[1]));
    row("longest path", &format!("{} edges", inventory.max_edges));
    row("loaded in", &seconds);
    row("content hash", &inventory.hash);
    writeln!(out, "{}\n", table.trim_fmt())?;
    writeln!(out, "Materials\n{}\n", materials(&inventory.materials).trim_fmt())?;
    writeln!(out, "Lights\n{}\n", lights(&inventory.lights).trim_fmt())?;
    list(out, "Features", &inventory.features, "none")?;
    list(out, "Switched off", &inventory.switched_off, "nothing")?;
    list(out, "Warnings", &inventory.warnings, "none")
}

fn materials(rows: &[MaterialRow]) -> Table {
    let mut table =
        table(&["material", "model", "colour", "index", "roughness", "emission", "shapes"]);
    for row in rows {
        table.add_row(vec![
            row.name.clone(),
            row.model.to_owned(),
            color(row.color),
            row.eta.map_or_else(String::new, short),
            row.roughness.map_or_else(String::new, short),
            if row.emission.is_black() { String::new() } else { color(row.emission) },
            row.shapes.to_string(),
        ]);
    }
    table
}

fn lights(rows: &[LightRow]) -> Table {
    let mut table = table(&["light", "kind", "shapes", "area", "colour", "power", "share"]);
    let total: f64 = rows.iter().map(|row| row.power).sum();
    for row in rows {
        table.add_row(vec![
            row.material.clone(),
            row.kind.to_owned(),
            if row.shapes == 0 { String::new() } else { row.shapes.to_string() },
            if row.shapes == 0 { String::new() } else { short(row.area) },
            color(row.radiance),
            short(row.power),
            format!("{:.1} %", 100.0 * row.power / total),
        ]);
    }
    table
}

/// An empty table with this head, or without one.
fn table(head: &[&str]) -> Table {
    let mut table = Table::new();
    if head.is_empty() {
        table.load_style(NOTHING);
    } else {
        table.load_style(UTF8_FULL_CONDENSED).set_header(head.iter().copied());
    }
    table
}

fn list(
    out: &mut impl Write,
    title: &str,
    items: &[impl Display],
    otherwise: &str,
) -> io::Result<()> {
    if items.is_empty() {
        return writeln!(out, "{title}: {otherwise}");
    }
    writeln!(out, "{title}:")?;
    for item in items {
        writeln!(out, "  - {item}")?;
    }
    Ok(())
}

fn point(p: DVec3) -> String {
    format!("({}, {}, {})", short(p.x), short(p.y), short(p.z))
}

fn color(c: Rgb) -> String {
    if c.r == c.g && c.g == c.b {
        return short(c.r);
    }
    format!("{} {} {}", short(c.r), short(c.g), short(c.b))
}

/// Four significant digits, without trailing zeros.
fn short(value: f64) -> String {
    let magnitude = value.abs();
    if value != 0.0 && !(1e-3..1e7).contains(&magnitude) {
        return format!("{value:.3e}");
    }
    let decimals = (3.0 - magnitude.max(1e-3).log10().floor()).clamp(0.0, 6.0) as usize;
    let text = format!("{value:.decimals$}");
    let text = if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.')
    } else {
        text.as_str()
    };
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn printed(spec: &str) -> String {
        let loaded = load(spec).expect("a built-in scene");
        let scene = Scene::new(&loaded.description).expect("a sound scene");
        let mut out = Vec::new();
        print(&mut out, &Inventory::new(&loaded, &scene)).expect("written to memory");
        String::from_utf8(out).expect("UTF-8")
    }

    #[test]
    fn numbers_are_short() {
        let cases = [
            (0.0, "0"),
            (1.0, "1"),
            (0.7646, "0.7646"),
            (12.5, "12.5"),
            (1234.56, "1235"),
            (1e9, "1.000e9"),
            (2e-7, "2.000e-7"),
            (-1e-9, "-1.000e-9"),
            (100.0, "100"),
        ];
        for (value, text) in cases {
            assert_eq!(short(value), text);
        }
    }

    #[test]
    fn the_tables_tell_what_matters() {
        let text = printed("caustic");
        for words in ["dielectric", "1.5", "Lights", "Features:", "exact sphere", "100.0 %"] {
            assert!(text.contains(words), "`{words}` is missing from\n{text}");
        }
        let text = printed("cornell");
        assert!(text.contains("36") && text.contains("Switched off:"), "{text}");
    }
}
