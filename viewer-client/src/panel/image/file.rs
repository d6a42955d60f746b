//! Comparing with a file, saving to one, and sending to tev.

use egui::{Align2, CollapsingHeader, Grid, RichText, TextEdit, Ui};

use crate::command::{Command, ImageCommand};
use crate::imaging::{Comparison, TEV_ADDRESS};
use crate::value::Layer;
use crate::value::format;
use crate::world::World;

/// What the user has typed, and the newest comparison.
#[derive(Debug)]
pub(super) struct Files {
    reference: String,
    target: String,
    tev: String,
    /// The comparison of an image of this revision with the reference whose pixels lie there.
    compared: Option<(u64, usize, Option<Comparison>)>,
}

impl Default for Files {
    fn default() -> Self {
        Self {
            reference: String::new(),
            target: "lvis.exr".to_owned(),
            tev: TEV_ADDRESS.to_owned(),
            compared: None,
        }
    }
}

impl Files {
    pub(super) fn show(&mut self, ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
        let dropped = ui.input(|i| i.raw.dropped_files.first().map(|f| f.path().to_path_buf()));
        if let Some(file) = dropped.filter(|f| f.extension().is_some_and(|e| e == "exr")) {
            let file = file.display().to_string();
            commands.push(Command::Image(ImageCommand::Reference(file)));
        }
        CollapsingHeader::new("Compare")
            .default_open(world.reference.is_some())
            .show(ui, |ui| self.compare(ui, world, commands));
        CollapsingHeader::new("Save and send").show(ui, |ui| {
            let line = Line { hint: "image.exr or .png", button: "Save" };
            let tip = ".exr saves the radiance with metadata, .png the image as displayed";
            if line.show(ui, &mut self.target, tip) {
                commands.push(Command::Image(ImageCommand::Save(self.target.clone())));
            }
            let line = Line { hint: "HOST:PORT", button: "To tev" };
            if line.show(ui, &mut self.tev, "Send the image to a running tev") {
                commands.push(Command::Image(ImageCommand::Tev(self.tev.clone())));
            }
        });
    }

    fn compare(&mut self, ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
        let line = Line { hint: "reference.exr; or drop one here", button: "Load" };
        let tip = "An image of the same scene and size, such as one made by `tracer-server render`";
        if line.show(ui, &mut self.reference, tip) {
            commands.push(Command::Image(ImageCommand::Reference(self.reference.clone())));
        }
        let Some(reference) = world.reference else { return };
        let key = (world.film.revision(), reference.pixels.as_ptr().addr());
        let known = self.compared.as_ref().filter(|(r, p, _)| (*r, *p) == key);
        let comparison = match known {
            Some((.., comparison)) => *comparison,
            None => Comparison::of(world.film, reference),
        };
        self.compared = Some((key.0, key.1, comparison));
        ui.horizontal(|ui| {
            ui.add(egui::Label::new(RichText::new(&reference.name).small()).truncate())
                .on_hover_text(&reference.name);
            if ui.small_button("Forget").on_hover_text("Remove the reference").clicked() {
                commands.push(Command::Image(ImageCommand::Forget));
            }
        });
        if let Some(comparison) = comparison {
            numbers(ui, &comparison);
            looks(ui, world, commands);
        } else {
            let size = format!("{} × {}", reference.width, reference.height);
            ui.label(format!(
                "It has {size} pixels, unlike the image; render it at the size of the image."
            ));
        }
    }
}

/// How different image and reference look, once somebody wants to know.
fn looks(ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
    let tip = "FLIP: the mean difference that a person perceives when flipping between the two \
        images, from 0 to 1";
    ui.horizontal(|ui| {
        ui.label(RichText::new("FLIP").weak()).on_hover_text(tip);
        let shown = world.settings.image.layer == Layer::Flip;
        match world.flip {
            Some(map) => {
                let pixels = map.errors.len().max(1) as f64;
                let effort = format::count(map.steps as f64 / pixels);
                let text = RichText::new(format!("{:.4}", map.mean)).monospace();
                ui.label(text).on_hover_text(format!("At {effort} mutations per pixel"));
            }
            None if shown => {
                ui.spinner();
                ui.label(RichText::new("This takes a few seconds").small().weak());
            }
            None => {
                if ui.small_button("Measure").on_hover_text(tip).clicked() {
                    commands.push(Command::Image(ImageCommand::Show(Layer::Flip)));
                }
            }
        }
    });
}

fn numbers(ui: &mut Ui, comparison: &Comparison) {
    let Comparison { relative_mse, trimmed, mean_ratio } = *comparison;
    Grid::new("comparison").num_columns(2).spacing([18.0, 2.0]).show(ui, |ui| {
        let mut line = |name: &str, value: String, tip: &str| {
            ui.label(RichText::new(name).weak()).on_hover_text(tip);
            ui.label(RichText::new(value).monospace());
            ui.end_row();
        };
        let tip = "Mean of (x - r)² / (r² + 0.01) over pixels and channels";
        line("relMSE", format::value(relative_mse as f32), tip);
        let tip = "The same without the worst 1 % of pixels: noise without fireflies";
        line("relMSE, best 99 %", format::value(trimmed as f32), tip);
        let tip = "Sum of the image over that of the reference; far from 100 %, something is wrong";
        line("energy", format!("{:.2} %", 100.0 * mean_ratio), tip);
    });
}

/// A text and the button that uses it.
struct Line {
    hint: &'static str,
    button: &'static str,
}

impl Line {
    /// True when the text is to be used.
    fn show(&self, ui: &mut Ui, text: &mut String, tip: &str) -> bool {
        ui.horizontal(|ui| {
            let width = (ui.available_width() - 74.0).max(60.0);
            let edit = TextEdit::singleline(text).align(Align2::LEFT_CENTER);
            let edit = ui.add(edit.hint_text(self.hint).desired_width(width));
            let entered = edit.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
            let enabled = !text.trim().is_empty();
            let button = ui.add_enabled(enabled, egui::Button::new(self.button));
            enabled && (button.on_hover_text(tip).clicked() || entered)
        })
        .inner
    }
}
