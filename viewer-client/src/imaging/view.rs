//! The progressive image, what it is compared with, and its ways out of the viewer.
//!
//! What takes longer than a frame is a [`Job`]: whoever has threads does it, and hands what it brings
//! back to [`ImageView::finish`].

use std::path::{Path, PathBuf};

use common::Diagnostics;

use super::film::Film;
use super::{FlipMap, Reference, Sources};
use crate::command::ImageCommand;
use crate::settings::ImageSettings;
use crate::value::Layer;

/// The image and everything about it that is no setting.
#[derive(Debug, Default)]
pub struct ImageView {
    /// The progressive image.
    pub film: Film,
    /// What it is compared with.
    pub reference: Option<Reference>,
    /// How different it looks from that, where that was asked for.
    pub flip: Option<FlipMap>,
}

/// Work on files, with other programs, or on every pixel.
pub type Job = Box<dyn FnOnce() -> Outcome + Send>;

/// What went well, or why not and what to do.
pub type Outcome = Result<Finding, String>;

/// What a job brings back.
#[derive(Clone, Debug, PartialEq)]
pub enum Finding {
    /// It is done, says this.
    Done(String),
    /// An image to compare with.
    Reference(Reference),
    /// How different the image looks from it.
    Flip(Result<FlipMap, String>),
}

/// What is known about an image in addition to its pixels.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Provenance<'a> {
    /// The scene's name.
    pub scene: Option<&'a str>,
    /// What an EXR file says about its origin.
    pub metadata: Vec<(&'static str, String)>,
    /// How well its chains explore.
    pub diagnostics: Option<&'a Diagnostics>,
}

impl ImageView {
    /// The work that a command asks for; `None` for one that only sets something, and for one that
    /// is done already.
    pub fn job(
        &mut self,
        command: &ImageCommand,
        look: &ImageSettings,
        from: Provenance<'_>,
    ) -> Result<Option<Job>, String> {
        match command {
            ImageCommand::Reference(file) => Ok(Some(load(PathBuf::from(file)))),
            ImageCommand::Forget => {
                (self.reference, self.flip) = (None, None);
                Ok(None)
            }
            ImageCommand::Save(file) => self.save(PathBuf::from(file), look, from).map(Some),
            ImageCommand::Tev(address) => Ok(Some(self.send(address, &from))),
            ImageCommand::Show(Layer::Flip) => self.compare_looks().map(Some),
            _ => Ok(None),
        }
    }

    /// The comparison that the shown layer needs, where the image has changed much since the last.
    pub fn next_comparison(&self, look: &ImageSettings) -> Result<Option<Job>, String> {
        let is_old = self.flip.as_ref().is_some_and(|map| map.is_old(&self.film));
        if look.layer == Layer::Flip && is_old { self.compare_looks().map(Some) } else { Ok(None) }
    }

    /// Finds out how different image and reference look.
    fn compare_looks(&self) -> Result<Job, String> {
        let reference = self.reference.clone().filter(|r| r.fits(&self.film));
        let reference = reference.ok_or("Load a reference of the image's size first.")?;
        let film = self.film.clone();
        Ok(Box::new(move || {
            let map = FlipMap::of(&film, &reference);
            Ok(Finding::Flip(map.map_err(|error| format!("FLIP cannot compare them: {error}"))))
        }))
    }

    fn save(
        &self,
        file: PathBuf,
        look: &ImageSettings,
        from: Provenance<'_>,
    ) -> Result<Job, String> {
        if self.film.size() == [0, 0] {
            return Err("There is no image to save yet.".to_owned());
        }
        let Self { film, reference, flip } = self;
        let (reference, flip) = (reference.as_ref(), flip.as_ref());
        let sources = Sources { film, reference, flip, diagnostics: from.diagnostics };
        let shown = super::develop(sources, look).unwrap_or_default();
        let mut metadata = vec![("lvis.mutations", film.steps().to_string())];
        metadata.extend(from.metadata);
        let film = film.clone();
        Ok(Box::new(move || {
            let saved = super::save(&file, &film, shown, &metadata);
            saved
                .map(|()| Finding::Done(saved_text(&file)))
                .map_err(|error| format!("The image cannot be saved: {error}"))
        }))
    }

    fn send(&self, address: &str, from: &Provenance<'_>) -> Job {
        let (film, address) = (self.film.clone(), address.to_owned());
        let name = format!("Lvis {}", from.scene.unwrap_or("image"));
        Box::new(move || {
            let sent = super::send_to_tev(&address, &name, &film);
            sent.map(|()| Finding::Done(format!("Sent to tev at {address}"))).map_err(|error| {
                format!("tev does not answer at {address} ({error}); start it, then try again")
            })
        })
    }

    /// Takes in what a job has brought back; the answer is for the user.
    pub fn finish(
        &mut self,
        finding: Finding,
        look: &mut ImageSettings,
    ) -> Option<Result<String, String>> {
        match finding {
            Finding::Done(text) => Some(Ok(text)),
            Finding::Reference(reference) => Some(self.compare_with(reference, look)),
            Finding::Flip(Ok(map)) => {
                self.flip = Some(map);
                None
            }
            Finding::Flip(Err(problem)) => {
                look.layer = Layer::Difference;
                Some(Err(problem))
            }
        }
    }

    /// Forgets a reference that does not fit the image, which may come after it; the answer is for the
    /// user.
    pub fn drop_misfit(&mut self, look: &mut ImageSettings) -> Option<String> {
        let is_there = self.film.size() != [0, 0];
        let misfit = self.reference.take_if(|reference| is_there && !reference.fits(&self.film))?;
        self.flip = None;
        if look.layer.compares() {
            look.layer = Layer::Image;
        }
        self.compare_with(misfit, look).err()
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
        let said = match reference.missing() {
            0 => format!("Compared with {name}"),
            missing => format!("Compared with {name}, which has no value for {missing} pixels"),
        };
        (self.reference, self.flip) = (Some(reference), None);
        if !look.layer.compares() {
            look.layer = Layer::Difference;
        }
        Ok(said)
    }
}

/// Where a file was written, since a name alone may lie in any folder.
pub fn saved_text(file: &Path) -> String {
    let place = std::path::absolute(file).unwrap_or_else(|_| file.to_owned());
    format!("Saved {}", place.display())
}

fn load(file: PathBuf) -> Job {
    Box::new(move || {
        let read = super::read_exr(&file);
        read.map(Finding::Reference)
            .map_err(|error| format!("The reference cannot be read: {error}"))
    })
}

#[cfg(test)]
mod tests {
    use common::{FilmTile, Rgb};

    use super::*;

    fn view() -> ImageView {
        let mut view = ImageView::default();
        let rgb = vec![0.5; 12];
        let tile = FilmTile { sequence: 1, width: 2, height: 2, first_row: 0, steps: 7, rgb };
        assert!(view.film.accept(&tile), "a whole image");
        view
    }

    /// What is said when a command has been followed.
    fn said(
        view: &mut ImageView,
        look: &mut ImageSettings,
        command: &ImageCommand,
    ) -> Option<Result<String, String>> {
        match view.job(command, look, Provenance::default()) {
            Ok(Some(job)) => match job() {
                Ok(finding) => view.finish(finding, look),
                Err(problem) => Some(Err(problem)),
            },
            Ok(None) => None,
            Err(problem) => Some(Err(problem)),
        }
    }

    #[test]
    fn a_saved_image_can_be_compared_with() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let file = folder.path().join("image one.exr").display().to_string();
        let (mut view, mut look) = (view(), ImageSettings::default());
        let saved = said(&mut view, &mut look, &ImageCommand::Save(file.clone()));
        assert!(saved.expect("a word").is_ok_and(|text| text.contains("image one.exr")), "saved");
        said(&mut view, &mut look, &ImageCommand::Reference(file)).expect("a word").expect("read");
        assert_eq!(view.reference.as_ref().map(|r| r.pixels[3]), Some(Rgb::grey(0.5)), "read");
        assert_eq!(look.layer, Layer::Difference, "and shown");
        assert_eq!(said(&mut view, &mut look, &ImageCommand::Show(Layer::Flip)), None, "no news");
        assert!(view.flip.is_some(), "their looks are compared");
        said(&mut view, &mut look, &ImageCommand::Forget);
        assert_eq!((view.reference, view.flip), (None, None), "forgotten");
    }

    #[test]
    fn what_goes_wrong_is_said() {
        let (mut view, mut look) = (view(), ImageSettings::default());
        let wrong = [
            (ImageCommand::Reference("no such file.exr".to_owned()), "no such file.exr"),
            (ImageCommand::Save("image.bmp".to_owned()), "use a name that ends in .exr or .png"),
            (ImageCommand::Tev("127.0.0.1:1".to_owned()), "start it"),
            (ImageCommand::Show(Layer::Flip), "Load a reference"),
        ];
        for (command, remedy) in wrong {
            let problem = said(&mut view, &mut look, &command).expect("a word").expect_err("wrong");
            assert!(problem.contains(remedy), "{command:?}: {problem}");
        }
        let name = "r".to_owned();
        let other = Reference { name, width: 1, height: 1, pixels: vec![Rgb::BLACK] };
        let refused = view.compare_with(other.clone(), &mut look).expect_err("another size");
        assert!(refused.contains("2 × 2"), "{refused}");
        let mut early = ImageView::default();
        early.compare_with(other, &mut look).expect("there is no image yet");
        assert_eq!(early.drop_misfit(&mut look), None, "nor is there now");
        early.film = view.film;
        let refused = early.drop_misfit(&mut look).expect("it does not fit");
        assert!(refused.contains("2 × 2"), "{refused}");
        assert_eq!((early.reference, look.layer), (None, Layer::Image), "nothing to compare with");
    }
}
