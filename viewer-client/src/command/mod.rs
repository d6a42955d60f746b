//! Everything that a user may ask of the viewer, with one text form each.
//!
//! Keys, menus, panels and scripts all end here. To add a command: a variant in its group's file,
//! its line in that group's `FORMS`, and an arm in each of the two conversions; the tests below
//! then hold it against its text.

mod camera;
mod cloud;
mod desk;
mod filter;
mod image;
mod layout;
mod path;
mod play;
mod scene;
mod steer;
mod words;

pub use camera::{CameraCommand, Place, Side};
pub use cloud::{Blend, CloudCommand, ColorMode, ColorScale, Marks};
pub use desk::{DeskCommand, HOME, Source};
pub use filter::{FilterCommand, MOST_KEPT, MOST_SELECTORS, Sphere, kept_name, kind_name};
pub use image::{Channel, ImageCommand, Layer, ToneCurve};
pub use layout::{LayoutCommand, Move, PanelName, ThemeName, WindowSide};
pub use path::{PathCommand, VertexStep};
pub use play::PlayCommand;
pub use scene::{ClipSide, Handles, Light, Lighting, SceneCommand, Shading};
pub use words::{CommandError, Switch};

use std::fmt;
use std::str::FromStr;

use common::Order;
use words::Words;

/// One action.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Moves the eye.
    Camera(CameraCommand),
    /// Concerns the paths on screen.
    Cloud(CloudCommand),
    /// Concerns the surfaces and drawing aids.
    Scene(SceneCommand),
    /// Says which paths to show.
    Filter(FilterCommand),
    /// Concerns the progressive image.
    Image(ImageCommand),
    /// Concerns the window's panels.
    Layout(LayoutCommand),
    /// Goes beyond the window.
    Desk(DeskCommand),
    /// Steers explorer and chains, or concerns who may.
    Order(Order),
    /// Concerns the path that is looked at.
    Path(PathCommand),
    /// Plays a file of paths.
    Play(PlayCommand),
    /// Shows a step of the explorer by its number, or the newest from now on.
    Scrub(Option<u64>),
    /// Takes back what was done last.
    Undo,
    /// Does it again.
    Redo,
    /// Tries to connect at once rather than when the next attempt is due.
    Reconnect,
    /// Closes the viewer.
    Quit,
}

/// A command's text form with its parameters in capitals, and what it does.
pub type Form = (&'static str, &'static str);

const OWN_FORMS: [Form; 4] = [
    ("undo", "take back what was done last"),
    ("redo", "do it again"),
    ("reconnect", "connect now instead of waiting for the next attempt"),
    ("quit", "close the viewer"),
];

/// Every text form, for help and documentation.
pub fn forms() -> impl Iterator<Item = Form> {
    [camera::FORMS, cloud::FORMS, scene::FORMS, filter::FORMS, image::FORMS]
        .into_iter()
        .chain([layout::FORMS, path::FORMS, play::FORMS, desk::FORMS, steer::FORMS, &OWN_FORMS])
        .flatten()
        .copied()
}

impl fmt::Display for Command {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Camera(command) => write!(f, "camera {command}"),
            Self::Cloud(command) => write!(f, "cloud {command}"),
            Self::Scene(command) => write!(f, "scene {command}"),
            Self::Filter(command) => write!(f, "filter {command}"),
            Self::Image(command) => write!(f, "image {command}"),
            Self::Layout(command) => write!(f, "{command}"),
            Self::Desk(command) => write!(f, "{command}"),
            Self::Order(order) => write!(f, "{}", steer::Text(*order)),
            Self::Path(command) => write!(f, "path {command}"),
            Self::Play(command) => write!(f, "play {command}"),
            Self::Scrub(Some(number)) => write!(f, "explorer show {number}"),
            Self::Scrub(None) => write!(f, "explorer show live"),
            Self::Undo => write!(f, "undo"),
            Self::Redo => write!(f, "redo"),
            Self::Reconnect => write!(f, "reconnect"),
            Self::Quit => write!(f, "quit"),
        }
    }
}

impl FromStr for Command {
    type Err = CommandError;

    fn from_str(text: &str) -> Result<Self, CommandError> {
        let mut words = Words::new(text);
        let command = match words.next("command")? {
            "camera" => Self::Camera(camera::parse(&mut words)?),
            "cloud" => Self::Cloud(cloud::parse(&mut words)?),
            "scene" => Self::Scene(scene::parse(&mut words)?),
            "filter" => Self::Filter(filter::parse(&mut words)?),
            "image" => Self::Image(image::parse(&mut words)?),
            "explorer" if words.peek() == Some("show") => {
                Self::Scrub(steer::parse_show(&mut words)?)
            }
            verb @ ("connect" | "share" | "screenshot" | "copy") => {
                Self::Desk(desk::parse(verb, &mut words)?)
            }
            group @ ("explorer" | "chains" | "lease") => {
                Self::Order(steer::parse(group, &mut words)?)
            }
            "path" => Self::Path(path::parse(&mut words)?),
            "play" => Self::Play(play::parse(&mut words)?),
            "undo" => Self::Undo,
            "redo" => Self::Redo,
            "reconnect" => Self::Reconnect,
            "quit" => Self::Quit,
            word => Self::Layout(layout::parse(word, &mut words)?),
        };
        words.end()?;
        Ok(command)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One example of every form, in the order of [`forms`].
    const EXAMPLES: &str = "camera orbit 12.5 -3\ncamera pan 0.1 -0.25\ncamera zoom 1.5 0.25 -0.5\n\
        camera look 3 4\ncamera move 0.1 0 -0.2\ncamera fly toggle\ncamera through on\n\
        camera focus 1 2 -3 40\ncamera frame\ncamera place 1 2 -3 40 -12.5 8\ncamera view front\n\
        cloud freeze toggle\ncloud clear\ncloud width 2.5\ncloud opacity 0.5\ncloud hidden 0.1\n\
        cloud fade 500\ncloud shown 2000\ncloud limit 5000\ncloud threshold 10\ncloud budget 64\ncloud color strategy\ncloud ends off\n\
        cloud dots 1.5\ncloud marks ends\ncloud scale log\ncloud blend add\ncloud cue 0.5\ncloud dim 0.25\n\
        scene shading wireframe\nscene opacity 0.25\nscene cutaway off\nscene camera on\n\
        scene grid toggle\nscene light at 1 -2.5 3\nscene lighting phong\nscene handles scale\nscene clip -x\nscene cut 0.25\n\
        filter set film in rect(0.25, 0, 1, 0.5)\nfilter clear\nfilter enable off\nfilter invert toggle\n\
        filter add start 1 2.5 -3 0.25\nfilter move 1 0 0 1 2\nfilter choose 0\nfilter delete 2\n\
        filter bare\nfilter keep my caustics\nfilter use on my caustics\nfilter reverse toggle my caustics\n\
        filter load my caustics\nfilter forget my caustics\n\
        image exposure -1.5\nimage auto\nimage zoom 2\nimage look 0.25 0.75\nimage fit\n\
        image show difference\nimage channel luminance\nimage tone gamma\nimage gamma 1.8\nimage reference a b.exr\n\
        image forget\nimage save out.png\nimage tev 127.0.0.1:14158\n\
        panel statistics off\nfold image on\narrange filter before image\nwidth left 300\nusual\n\
        mouse blender\ntheme light\nhelp toggle\nkeys classic\nseen on\npalette on\nhint off\nscale 125\n\
        path pick 0.1 -0.2 0.01\npath stay 2\npath explored\n\
        path show 3.0.1024 1 7 32 0.5 0.25 0.75 1.5 1 0.5 0 1 2.5 -3 0 32767 0 0 1 4 4 5 6 0 -32768 6 0 0 4294967295\n\
        path none\npath vertex 3\nplay toggle\nplay rate 0.5\nplay to 7\n\
        play by -2\nplay accepted\n\
        connect 127.0.0.1:50061\nshare\nscreenshot a b.png\ncopy statistics\n\
        explorer seed 3.0.1024\nexplorer play 2.5\nexplorer pause\nexplorer step 10\n\
        explorer skip accepted\nexplorer allow 0,2,5\nexplorer fan 2 100\nexplorer show live\n\
        chains pause\nchains resume\nchains weight 1 0.25\nchains precision 0.001\n\
        chains restart 7\nlease ask\nlease release\nlease give 12\n\
        undo\nredo\nreconnect\nquit";

    #[test]
    fn every_command_survives_its_text() {
        let examples: Vec<&str> = EXAMPLES.lines().map(str::trim).collect();
        let forms: Vec<Form> = forms().collect();
        assert_eq!(examples.len(), forms.len(), "one example a form");
        for (example, (form, _)) in examples.into_iter().zip(forms) {
            let command = Command::from_str(example).expect(example);
            assert_eq!(command.to_string(), example, "text of {command:?}");
            let verb = |text: &str| -> String {
                let lower = |w: &&str| w.chars().all(|c| c.is_ascii_lowercase());
                text.split(' ').take_while(lower).collect::<Vec<_>>().join(" ")
            };
            assert!(example.starts_with(&verb(form)), "`{example}` is no example of `{form}`");
        }
    }

    #[test]
    fn every_choice_survives_its_text() {
        let texts = Side::ALL.iter().map(|s| format!("camera view {s}"));
        let texts = texts.chain(ColorMode::ALL.iter().map(|c| format!("cloud color {c}")));
        let texts = texts.chain(Marks::ALL.iter().map(|m| format!("cloud marks {m}")));
        let texts = texts.chain(ColorScale::ALL.iter().map(|s| format!("cloud scale {s}")));
        let texts = texts.chain(Blend::ALL.iter().map(|b| format!("cloud blend {b}")));
        let texts = texts.chain(["scene light camera".into(), "scene lighting soft".into()]);
        let texts = texts.chain(["scene handles move".into()]);
        let texts = texts.chain(ClipSide::ALL.iter().map(|s| format!("scene clip {s}")));
        let texts = texts.chain(Shading::ALL.iter().map(|s| format!("scene shading {s}")));
        let texts = texts.chain(Layer::ALL.iter().map(|l| format!("image show {l}")));
        let texts = texts.chain(ToneCurve::ALL.iter().map(|t| format!("image tone {t}")));
        let texts = texts.chain(PanelName::ALL.iter().map(|p| format!("panel {p} toggle")));
        let texts = texts.chain(["theme dark".into(), "theme light".into(), "theme toggle".into()]);
        let orders = ["explorer seed newest", "explorer skip 3", "explorer allow all"];
        for text in texts.chain(orders.map(str::to_owned)) {
            let command = Command::from_str(&text).expect(&text);
            assert_eq!(command.to_string(), text, "text of {command:?}");
        }
    }

    #[test]
    fn mistakes_are_explained() {
        let complaint = |text: &str| Command::from_str(text).expect_err(text).to_string();
        assert_eq!(complaint(""), "a command is missing");
        assert!(complaint("fly").contains("unknown command `fly`"), "names the word");
        assert!(complaint("cloud width").contains("PIXELS is missing"), "names the parameter");
        assert!(complaint("cloud width thin").contains("`thin` is not a number"), "names the word");
        assert!(complaint("cloud width NaN").contains("`NaN` is not a number"), "no NaN");
        assert!(complaint("cloud width 900").contains("between 0.25 and 20"), "names the limits");
        assert!(complaint("chains weight 1 inf").contains("`inf` is not"), "no infinity");
        assert!(complaint("explorer seed 3.4").contains("CHAIN.EPOCH.STEP"), "shows the form");
        assert!(complaint("explorer allow 1,64").contains("numbers"), "no such strategy");
        assert!(complaint("scene grid maybe").contains("on, off, toggle"), "lists the choices");
        assert!(complaint("filter set edges >").contains("cannot be read"), "says what is wrong");
        assert!(complaint("image save").contains("FILE is missing"), "names the parameter");
        assert!(complaint("scale 1000").contains("between 50 and 300"), "names the limits");
        assert!(complaint("quit now").contains("`now` is too much"), "names the rest");
    }
}
