//! What the viewer asks of the desktop: the clipboard, pictures of the window, and connections.

use std::fmt;
use std::io;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, sync_channel};

use egui::{Color32, ColorImage};
use host::file::Place;

use super::background::{BackgroundTasks, Outcome, TaskResult};
use super::preferences::Preferences;
use crate::imaging::saved_text;
use crate::source::connection::{Link, Peer};

/// Makes connections that wake the window.
pub type Connect = Box<dyn Fn(Peer) -> io::Result<Link>>;

/// What is asked of the desktop, and what it remembers.
#[derive(Default)]
pub struct Desktop {
    /// What the viewer remembers from one day to the next.
    pub preferences: Preferences,
    /// How to connect elsewhere; absent without a window.
    pub connect: Option<Connect>,
    /// HOST:PORT of the daemon inside this program, if there is one.
    pub home: Option<String>,
    copied: Option<String>,
    /// Where the next picture of the window goes.
    wanted: Option<PathBuf>,
    /// A picture that the window was asked for, and where it goes.
    awaited: Option<(Receiver<Arc<ColorImage>>, PathBuf)>,
}

impl fmt::Debug for Desktop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Desktop").field("preferences", &self.preferences).finish_non_exhaustive()
    }
}

impl Desktop {
    /// Of a program with a daemon inside at `home`, HOST:PORT, or of one without.
    pub fn new(home: Option<String>) -> Self {
        Self { home, ..Self::default() }
    }

    /// Puts a text into the clipboard with the next frame.
    pub fn copy(&mut self, text: String) {
        self.copied = Some(text);
    }

    /// Takes a picture of the window as it is in the next frame.
    pub fn photograph(&mut self, file: &str) {
        self.wanted = Some(PathBuf::from(file));
    }

    /// True while something that was asked for is still to be done.
    pub fn is_waiting(&self) -> bool {
        self.copied.is_some() || self.wanted.is_some() || self.awaited.is_some()
    }

    /// Does what was asked for; once a frame. The answer tells why something cannot begin.
    pub fn work(&mut self, ctx: &egui::Context, tasks: &mut BackgroundTasks) -> Result<(), String> {
        if let Some(text) = self.copied.take() {
            ctx.copy_text(text);
        }
        if let Some(file) = self.wanted.take() {
            let (sender, receiver) = sync_channel(1);
            let wake = ctx.clone();
            ctx.request_screenshot(move |image| {
                // Whoever asks for another picture meanwhile does not wait for this one.
                drop(sender.try_send(image));
                wake.request_repaint();
            });
            self.awaited = Some((receiver, file));
        }
        let arrived = self.awaited.as_ref().and_then(|(receiver, _)| receiver.try_recv().ok());
        match arrived.and_then(|image| Some((image, self.awaited.take()?))) {
            Some((image, (_, file))) => tasks.start(move || write(&image, &file)),
            None => Ok(()),
        }
    }
}

fn write(image: &ColorImage, file: &std::path::Path) -> Outcome {
    let [width, height] = image.size.map(|side| side as u32);
    let bytes: Vec<u8> = image.pixels.iter().flat_map(Color32::to_array).collect();
    let png = image::RgbaImage::from_raw(width, height, bytes)
        .ok_or_else(|| "The window is too large or too small to be saved.".to_owned())?;
    let write = || -> anyhow::Result<()> {
        Place::find(file)?.write(|output| Ok(png.write_to(output, image::ImageFormat::Png)?))
    };
    write()
        .map(|()| TaskResult::Done(saved_text(file)))
        .map_err(|error| format!("The screenshot cannot be saved: {error:#}"))
}
