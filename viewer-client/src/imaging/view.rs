//! The progressive image, what it is compared with, and its ways out of the viewer.

use std::path::PathBuf;

use crate::command::{ImageCommand, Layer};
use crate::imaging::background::{Errand, Errands, Outcome};
use crate::imaging::film::Film;
use crate::imaging::{self, FlipMap, Reference, Sources};
use crate::settings::ImageSettings;
use crate::source::status::Status;

/// The image and everything about it that is no setting.
#[derive(Debug, Default)]
pub struct Darkroom {
    /// The progressive image.
    pub film: Film,
    /// What it is compared with.
    pub reference: Option<Reference>,
    /// How different it looks from that, where that was asked for.
    pub flip: Option<FlipMap>,
    errands: Errands,
}

impl Darkroom {
    /// True while a file is read or written, or another program is spoken to.
    pub fn is_busy(&self) -> bool {
        self.errands.is_busy()
    }

    /// Does what is more than a setting.
    pub fn apply(&mut self, command: &ImageCommand, look: &ImageSettings, status: &mut Status) {
        let started = match command {
            ImageCommand::Reference(file) => self.load(file),
            ImageCommand::Forget => {
                (self.reference, self.flip) = (None, None);
                return;
            }
            ImageCommand::Save(file) => self.save(file, look, status),
            ImageCommand::Tev(address) => self.send(address, status),
            ImageCommand::Show(Layer::Flip) => self.compare_looks(),
            _ => return,
        };
        if let Err(problem) = started {
            status.say(Err(problem));
        }
    }

    /// Does something else that takes long; the answer tells why it cannot begin now.
    pub fn run(&mut self, work: impl FnOnce() -> Outcome + Send + 'static) -> Result<(), String> {
        self.errands.start(work)
    }

    fn load(&mut self, file: &str) -> Result<(), String> {
        let file = PathBuf::from(file);
        self.errands.start(move || {
            let read = imaging::read_exr(&file);
            read.map(Errand::Reference)
                .map_err(|error| format!("The reference cannot be read: {error}"))
        })
    }

    /// Finds out how different image and reference look, on another thread.
    fn compare_looks(&mut self) -> Result<(), String> {
        let reference = self.reference.clone().filter(|r| r.fits(&self.film));
        let reference = reference.ok_or("Load a reference of the image's size first.")?;
        let film = self.film.clone();
        self.errands.start(move || {
            let map = FlipMap::of(&film, &reference);
            Ok(Errand::Flip(map.map_err(|error| format!("FLIP cannot compare them: {error}"))))
        })
    }

    fn save(&mut self, file: &str, look: &ImageSettings, status: &Status) -> Result<(), String> {
        if self.film.size() == [0, 0] {
            return Err("There is no image to save yet.".to_owned());
        }
        let diagnostics = status.statistics.as_ref().and_then(|s| s.diagnostics.as_deref());
        let reference = self.reference.as_ref();
        let flip = self.flip.as_ref();
        let sources = Sources { film: &self.film, reference, flip, diagnostics };
        let shown = imaging::develop(sources, look).unwrap_or_default();
        let metadata = metadata(&self.film, status);
        let (film, file) = (self.film.clone(), PathBuf::from(file));
        self.errands.start(move || {
            let saved = imaging::save(&file, &film, shown, &metadata);
            saved
                .map(|()| Errand::saved(&file))
                .map_err(|error| format!("The image cannot be saved: {error}"))
        })
    }

    fn send(&mut self, address: &str, status: &Status) -> Result<(), String> {
        let (film, address) = (self.film.clone(), address.to_owned());
        let scene = status.welcome.as_ref().map_or("image", |w| w.scene_name.as_str());
        let name = format!("Lvis {scene}");
        self.errands.start(move || {
            let sent = imaging::send_to_tev(&address, &name, &film);
            sent.map(|()| Errand::Done(format!("Sent to tev at {address}"))).map_err(|error| {
                format!("tev does not answer at {address} ({error}); start it, then try again")
            })
        })
    }

    /// Takes in what errands have brought back. True when there was anything.
    pub fn collect(&mut self, look: &mut ImageSettings, status: &mut Status) -> bool {
        let outcomes = self.errands.take();
        let any = !outcomes.is_empty();
        let is_old = self.flip.as_ref().is_some_and(|map| map.is_old(&self.film));
        if look.layer == Layer::Flip
            && is_old
            && !self.is_busy()
            && let Err(problem) = self.compare_looks()
        {
            look.layer = Layer::Difference;
            status.say(Err(problem));
        }
        for outcome in outcomes {
            let said = match outcome {
                Ok(Errand::Done(text)) => Ok(text),
                Ok(Errand::Reference(reference)) => self.compare_with(reference, look),
                Ok(Errand::Flip(Ok(map))) => {
                    self.flip = Some(map);
                    continue;
                }
                Ok(Errand::Flip(Err(problem))) => {
                    look.layer = Layer::Difference;
                    Err(problem)
                }
                Err(problem) => Err(problem),
            };
            status.say(said);
        }
        any
    }

    fn compare_with(
        &mut self,
        reference: Reference,
        look: &mut ImageSettings,
    ) -> Result<String, String> {
        let Reference { name, width, height, .. } = &reference;
        let [film_width, film_height] = self.film.size();
        if [film_width, film_height] != [0, 0] && !reference.fits(&self.film) {
            return Err(format!(
                "{name} has {width} × {height} pixels and the image {film_width} × {film_height}; \
                 render the reference in the image's size"
            ));
        }
        let said = format!("Compared with {name}");
        (self.reference, self.flip) = (Some(reference), None);
        if !look.layer.compares() {
            look.layer = Layer::Difference;
        }
        Ok(said)
    }
}

/// What an EXR file tells of where it came from.
fn metadata(film: &Film, status: &Status) -> Vec<(&'static str, String)> {
    let mut entries = vec![("lvis.mutations", film.steps().to_string())];
    if let Some(welcome) = &status.welcome {
        entries.push(("lvis.scene", welcome.scene_name.clone()));
        entries.push(("lvis.scene_hash", welcome.scene_hash.clone()));
        entries.push(("lvis.version", welcome.server_version.clone()));
    }
    if let Some(statistics) = &status.statistics {
        entries.push(("lvis.b", statistics.normalization.to_string()));
        entries.push(("lvis.b_standard_error", statistics.normalization_error.to_string()));
    }
    entries
}

#[cfg(test)]
mod tests {
    use common::{FilmTile, Rgb};

    use super::*;

    fn darkroom() -> (Darkroom, ImageSettings, Status) {
        let mut darkroom = Darkroom::default();
        let rgb = vec![0.5; 12];
        let tile = FilmTile { sequence: 1, width: 2, height: 2, first_row: 0, steps: 7, rgb };
        assert!(darkroom.film.accept(&tile), "a whole image");
        let status = Status::new("127.0.0.1:50061".to_owned(), false);
        (darkroom, ImageSettings::default(), status)
    }

    fn wait(darkroom: &mut Darkroom, look: &mut ImageSettings, status: &mut Status) {
        while !darkroom.collect(look, status) {
            std::thread::yield_now();
        }
    }

    #[test]
    fn a_saved_image_can_be_compared_with() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let file = folder.path().join("image one.exr").display().to_string();
        let (mut darkroom, mut look, mut status) = darkroom();
        darkroom.apply(&ImageCommand::Save(file.clone()), &look, &mut status);
        wait(&mut darkroom, &mut look, &mut status);
        let notice = status.notice.clone().expect("a word");
        assert!(!notice.is_bad && notice.text.contains("image one.exr"), "{notice:?}");
        darkroom.apply(&ImageCommand::Reference(file), &look, &mut status);
        wait(&mut darkroom, &mut look, &mut status);
        assert_eq!(darkroom.reference.as_ref().map(|r| r.pixels[3]), Some(Rgb::grey(0.5)), "read");
        assert_eq!(look.layer, Layer::Difference, "and shown");
        darkroom.apply(&ImageCommand::Forget, &look, &mut status);
        assert_eq!(darkroom.reference, None, "forgotten");
    }

    #[test]
    fn what_goes_wrong_is_said() {
        let (mut darkroom, mut look, mut status) = darkroom();
        let wrong = [
            (ImageCommand::Reference("no such file.exr".to_owned()), "no such file.exr"),
            (ImageCommand::Save("image.bmp".to_owned()), "end the name in .exr or .png"),
            (ImageCommand::Tev("127.0.0.1:1".to_owned()), "start it"),
        ];
        for (command, remedy) in wrong {
            darkroom.apply(&command, &look, &mut status);
            wait(&mut darkroom, &mut look, &mut status);
            let notice = status.notice.take().expect("a word");
            assert!(notice.is_bad && notice.text.contains(remedy), "{command:?}: {notice:?}");
        }
        let name = "r".to_owned();
        let other = Reference { name, width: 1, height: 1, pixels: vec![Rgb::BLACK] };
        let refused = darkroom.compare_with(other, &mut look).expect_err("another size");
        assert!(refused.contains("2 × 2"), "{refused}");
    }
}
