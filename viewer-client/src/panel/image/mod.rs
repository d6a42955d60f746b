//! The progressive image: seen, measured, compared and given away.

mod file;
mod frame;
mod legend;
mod marks;
mod readout;

use egui::{Button, ColorImage, RichText, TextureHandle, TextureOptions, Ui};

use super::Panel;
use super::widgets::{Scale, capitalised, empty_state, slider};
use crate::command::{Channel, Command, FilterCommand, ImageCommand, Layer, ToneCurve};
use crate::imaging::{self, Sources};
use crate::settings::ImageSettings;
use crate::settings::region;
use crate::value::format;
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
                "It appears once the daemon has found where the light is and its chains have begun.",
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
        exposure(ui, world, commands);
        tone(ui, world, commands);
        zoom(ui, world, commands);
        let text = format!(
            "{width} × {height}, {} mutations a pixel",
            format::count(world.film.steps() as f64 / (width * height) as f64)
        );
        ui.label(RichText::new(text).small().weak());
        self.files.show(ui, world, commands);
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
            .on_hover_text("The filter wants paths that reached this part of the image only");
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
        "The daemon has not told yet how the chains do"
    } else {
        "Load a reference first: see Compare below"
    };
    let chosen = world.settings.image.layer == layer;
    let label = match layer {
        Layer::Disagreement => "R-hat".to_owned(),
        Layer::Flip => "FLIP".to_owned(),
        other => capitalised(&other.to_string()),
    };
    let button = Button::selectable(chosen, label);
    let button = ui
        .add_enabled(!missing, button)
        .on_hover_text(meaning(layer))
        .on_disabled_hover_text(remedy);
    if button.clicked() {
        commands.push(Command::Image(ImageCommand::Show(layer)));
    }
}

/// What a layer shows.
fn meaning(layer: Layer) -> &'static str {
    match layer {
        Layer::Image => "The progressive image",
        Layer::Reference => "The image to compare with",
        Layer::Difference => "Orange is brighter than the reference, blue darker",
        Layer::Error => "Where the image is still wrong, relative to the reference",
        Layer::Flip => {
            "FLIP: how different a person sees image and reference who flips between them"
        }
        Layer::Acceptance => "Mean acceptance probability of proposals made from paths to here",
        Layer::Dwell => "How long chains stay at a path to here, in steps",
        Layer::Visits => "How often chains come here",
        Layer::Spread => "Relative standard error of the light here, from how chains differ",
        Layer::Disagreement => "R-hat: whether chains agree how much light comes here",
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
        for (channel, label, tip) in [
            (Channel::Rgb, "RGB", "All of the light"),
            (Channel::Red, "R", "Red alone, as grey"),
            (Channel::Green, "G", "Green alone, as grey"),
            (Channel::Blue, "B", "Blue alone, as grey"),
            (Channel::Luminance, "Y", "Luminance, as grey"),
        ] {
            let button = ui.selectable_label(look.channel == channel, label).on_hover_text(tip);
            if button.clicked() {
                commands.push(Command::Image(ImageCommand::Channel(channel)));
            }
        }
    });
}

fn exposure(ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
    let tip = "Brightness of the image on screen; each stop doubles it ( , and . )";
    let scale = Scale::linear(-10.0..=10.0, 1).suffix(" EV");
    let stops = world.settings.image.exposure;
    if let Some(stops) = slider(ui, "Exposure", tip, stops, scale) {
        commands.push(Command::Image(ImageCommand::Exposure(stops)));
    }
}

fn tone(ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
    let look = &world.settings.image;
    if !matches!(look.layer, Layer::Image | Layer::Reference) {
        return;
    }
    ui.horizontal(|ui| {
        for (curve, label, tip) in [
            (ToneCurve::Srgb, "sRGB", "As screens expect light"),
            (ToneCurve::Gamma, "Gamma", "A power of the light"),
            (ToneCurve::False, "False colour", "Luminance as a colour, over four decades"),
        ] {
            let button = ui.selectable_label(look.tone == curve, label).on_hover_text(tip);
            if button.clicked() {
                commands.push(Command::Image(ImageCommand::Tone(curve)));
            }
        }
    });
    if look.tone == ToneCurve::Gamma {
        let scale = Scale::linear(0.5..=4.0, 2);
        if let Some(gamma) = slider(ui, "Gamma", "Larger is flatter", look.gamma, scale) {
            commands.push(Command::Image(ImageCommand::Gamma(gamma)));
        }
    }
}

fn zoom(ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
    let zoom = world.settings.image.zoom;
    ui.horizontal(|ui| {
        let fit = ui.selectable_label(zoom.is_none(), "Fit").on_hover_text("As wide as the panel");
        if fit.clicked() {
            commands.push(Command::Image(ImageCommand::Fit));
        }
        for factor in [1.0, 2.0, 4.0] {
            let label = format!("{factor:.0}:1");
            let chosen = ui
                .selectable_label(zoom == Some(factor), label)
                .on_hover_text("Screen points a pixel of the film; the wheel does it, too");
            if chosen.clicked() {
                commands.push(Command::Image(ImageCommand::Zoom(factor)));
            }
        }
        let auto = ui
            .selectable_label(!world.settings.image.chosen, "Auto exposure")
            .on_hover_text("Brightness that suits the scene");
        if auto.clicked() {
            commands.push(Command::Image(ImageCommand::Auto));
        }
    });
}
