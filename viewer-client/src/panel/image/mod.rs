//! The progressive image: seen, measured, compared and given away.

mod file;
mod frame;
mod legend;
mod marks;
mod readout;

use egui::{Button, ColorImage, RichText, TextureHandle, TextureOptions, Ui};

use super::lines::Lines;
use super::widgets::{empty_state, setting};
use super::{Panel, Section};
use crate::command::{Command, FilterCommand, ImageCommand};
use crate::imaging::Comparison;
use crate::imaging::{self, Sources};
use crate::settings::ImageSettings;
use crate::settings::region;
use crate::value::PanelName;
use crate::value::format;
use crate::value::{Channel, Choice as _, Layer, ToneCurve};
use crate::world::World;

/// The image as a texture, and what the user is about to do with it.
#[derive(Default)]
pub(super) struct ImagePanel {
    texture: Option<TextureHandle>,
    /// What the texture shows.
    shown: Option<Shown>,
    frame: frame::FrameState,
    files: file::Files,
}

/// What a texture was made from.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Shown {
    revision: u64,
    look: ImageSettings,
    /// Where the reference's pixels lie; another one lies elsewhere.
    reference: usize,
    /// Where the diagnostics lie, if they are shown.
    diagnostics: usize,
    /// Where the visible differences lie, if they are shown.
    flip: usize,
}

impl std::fmt::Debug for ImagePanel {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ImagePanel").field("shown", &self.shown).finish_non_exhaustive()
    }
}

impl Panel for ImagePanel {
    fn ui(&mut self, ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
        let [width, height] = world.film.size();
        if width == 0 || height == 0 {
            self.texture = None;
            self.shown = None;
            empty_state(
                ui,
                "No image yet",
                "It appears once the daemon has found the light and its chains have started.",
            );
            return;
        }
        self.refresh(ui, world);
        if let Some(texture) = &self.texture {
            let hovered = self.frame.show(ui, world, texture.id(), commands);
            readout::show(ui, world, hovered);
            copy_by_key(ui, world, hovered);
        }
        region_line(ui, world, commands);
        layers(ui, world, commands);
        if let Some(legend) = imaging::legend(&world.settings.image) {
            legend::show(ui, &legend);
        }
        channels(ui, world, commands);
        setting(ui, world, &ImageSettings::exposure(), commands);
        tone(ui, world, commands);
        zoom(ui, world, commands);
        let text = format!(
            "{width} × {height}, {} mutations per pixel",
            format::count(world.film.steps() as f64 / (width * height) as f64)
        );
        ui.label(RichText::new(text).small().weak());
        self.files.show(ui, world, commands);
    }
}

impl Section for ImagePanel {
    const NAME: PanelName = PanelName::Image;
    const TITLE: &'static str = "Image";
    const HELP: &'static [&'static str] = &[
        "The image that the chains have rendered so far. The wheel zooms, the right button pans.",
        "Click a pixel, or drag a rectangle, to see only the paths that end there. Ctrl+C copies \
        the raw values of the pixel under the cursor.",
    ];

    fn applies(world: &World<'_>) -> bool {
        world.has_chains()
    }

    fn text(world: &World<'_>) -> String {
        let mut lines = Lines::default();
        let [width, height] = world.film.size();
        lines.put(format_args!("pixels\t{width} × {height}"));
        let effort = world.film.steps() as f64 / (width * height).max(1) as f64;
        lines.put(format_args!("mutations per pixel\t{effort:.1}"));
        lines.put(format_args!("exposure\t{} EV", world.settings.image.exposure.stops()));
        let Some(reference) = world.reference else { return lines.text() };
        lines.put(format_args!("reference\t{}", reference.name));
        if let Some(comparison) = Comparison::of(world.film, reference) {
            lines.put(format_args!("relMSE\t{:.6e}", comparison.relative_mse));
            lines.put(format_args!("relMSE, best 99 %\t{:.6e}", comparison.trimmed));
            lines.put(format_args!("energy\t{:.3} %", 100.0 * comparison.mean_ratio));
        }
        if let Some(flip) = world.flip {
            lines.put(format_args!("FLIP\t{:.5}", flip.mean));
        }
        lines.text()
    }
}

/// Ctrl+C over a pixel copies its raw values.
fn copy_by_key(ui: &Ui, world: &World<'_>, hovered: Option<[usize; 2]>) {
    let is_copy = |event: &egui::Event| matches!(event, egui::Event::Copy);
    let asked = ui.input(|input| input.events.iter().any(is_copy));
    let writes = ui.ctx().egui_wants_keyboard_input();
    if let Some(text) = hovered.filter(|_| asked && !writes).and_then(|at| readout::text(world, at))
    {
        // The panel has no more to say.
        ui.input_mut(|input| input.events.retain(|event| !is_copy(event)));
        ui.ctx().copy_text(text);
    }
}

impl ImagePanel {
    fn refresh(&mut self, ui: &Ui, world: &World<'_>) {
        let look = world.settings.image;
        let diagnostics = world.diagnostics().filter(|_| look.layer.is_map());
        let flip = world.flip.filter(|_| look.layer == Layer::Flip);
        let wanted = Shown {
            revision: world.film.revision(),
            // Where one looks does not change what there is to see.
            look: ImageSettings { zoom: None, centre: [0.5; 2], ..look },
            reference: world.reference.map_or(0, |r| r.pixels.as_ptr().addr()),
            diagnostics: diagnostics.map_or(0, |d| d.maps.r_hat.as_ptr().addr()),
            flip: flip.map_or(0, |map| map.errors.as_ptr().addr()),
        };
        if self.shown == Some(wanted) && self.texture.is_some() {
            return;
        }
        let (film, reference) = (world.film, world.reference);
        let sources = Sources { film, reference, flip, diagnostics };
        let plain = ImageSettings { layer: Layer::Image, ..look };
        let bytes = imaging::develop(sources, &look).or_else(|| imaging::develop(sources, &plain));
        let image = ColorImage::from_rgb(world.film.size(), &bytes.unwrap_or_default());
        let options = TextureOptions {
            magnification: egui::TextureFilter::Nearest,
            ..TextureOptions::LINEAR
        };
        match &mut self.texture {
            Some(texture) => texture.set(image, options),
            None => self.texture = Some(ui.ctx().load_texture("film", image, options)),
        }
        self.shown = Some(wanted);
    }
}

/// Which part of the image the paths come from, and the way back to all of it.
fn region_line(ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
    let Some([u0, v0, u1, v1]) = region::region_of(world.settings.filter.text()) else { return };
    let [width, height] = world.film.size().map(|side| side as f64);
    ui.horizontal(|ui| {
        let columns = ((u1 - u0) * width).round().max(1.0);
        let rows = ((v1 - v0) * height).round().max(1.0);
        ui.label(format!("Paths to {columns:.0} × {rows:.0} pixels"))
            .on_hover_text("The filter only shows paths that end in this part of the image");
        if ui.button("All").on_hover_text("Paths to the whole image").clicked() {
            let text = region::with_region(world.settings.filter.text(), None);
            commands.push(Command::Filter(FilterCommand::Set(text)));
        }
    });
}

fn layers(ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
    let (maps, pictures): (Vec<Layer>, Vec<Layer>) =
        Layer::ALL.into_iter().partition(|layer| layer.is_map());
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        for layer in pictures {
            layer_button(ui, world, layer, commands);
        }
    });
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        for layer in maps {
            layer_button(ui, world, layer, commands);
        }
    });
}

/// A button that shows a layer.
pub(super) fn layer_button(
    ui: &mut Ui,
    world: &World<'_>,
    layer: Layer,
    commands: &mut Vec<Command>,
) {
    let missing = (layer.compares() && world.reference.is_none())
        || (layer.is_map() && world.diagnostics().is_none());
    let remedy = if layer.is_map() {
        "The daemon has not reported on the chains yet"
    } else {
        "Load a reference first: see Compare below"
    };
    let chosen = world.settings.image.layer == layer;
    let button = Button::selectable(chosen, layer.label());
    let button = ui
        .add_enabled(!missing, button)
        .on_hover_text(layer.meaning())
        .on_disabled_hover_text(remedy);
    if button.clicked() {
        commands.push(Command::Image(ImageCommand::Show(layer)));
    }
}

/// Which part of the light is shown, where it is light that is shown.
fn channels(ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
    let look = &world.settings.image;
    if !matches!(look.layer, Layer::Image | Layer::Reference) {
        return;
    }
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        for channel in Channel::ALL {
            let button = ui.selectable_label(look.channel == channel, channel.label());
            if button.on_hover_text(channel.meaning()).clicked() {
                commands.push(Command::Image(ImageCommand::Channel(channel)));
            }
        }
    });
}

fn tone(ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
    let look = &world.settings.image;
    if !matches!(look.layer, Layer::Image | Layer::Reference) {
        return;
    }
    ui.horizontal(|ui| {
        for curve in ToneCurve::ALL {
            let button = ui.selectable_label(look.tone == curve, curve.label());
            if button.on_hover_text(curve.meaning()).clicked() {
                commands.push(Command::Image(ImageCommand::Tone(curve)));
            }
        }
    });
    if look.tone == ToneCurve::Gamma {
        setting(ui, world, &ImageSettings::gamma(), commands);
    }
}

fn zoom(ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
    let zoom = world.settings.image.zoom;
    ui.horizontal(|ui| {
        let fit =
            ui.selectable_label(zoom.is_none(), "Fit").on_hover_text("Fit the image to the panel");
        if fit.clicked() {
            commands.push(Command::Image(ImageCommand::Fit));
        }
        for factor in [1.0, 2.0, 4.0] {
            let label = format!("{factor:.0}:1");
            let chosen = ui
                .selectable_label(zoom == Some(factor), label)
                .on_hover_text("Screen points per pixel of the film; the wheel changes it, too");
            if chosen.clicked() {
                commands.push(Command::Image(ImageCommand::Zoom(factor)));
            }
        }
        let auto = ui
            .selectable_label(!world.settings.image.exposure.is_chosen(), "Auto exposure")
            .on_hover_text("Choose a brightness that suits the scene");
        if auto.clicked() {
            commands.push(Command::Image(ImageCommand::Auto));
        }
    });
}
