//! Links that restore what somebody saw: `lvis://HOST:PORT#COMMAND;COMMAND`, percent-encoded.
//!
//! A link holds nothing but the address and commands, so whatever a script can restore, a link can.
//! Only commands that look are followed: a link never writes a file, speaks to another program,
//! steers a daemon or closes the viewer.

use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, percent_decode_str, utf8_percent_encode};
use thiserror::Error;

use crate::camera::ViewCamera;
use crate::command::{CameraCommand, Command, FilterCommand, ImageCommand, PathCommand, Trait};
use crate::settings::Settings;
use crate::source::selection::Selection;
use crate::value::{CommandError, ShownPath, Switch};

/// How links begin.
pub const SCHEME: &str = "lvis://";
/// Longest link that is read, in bytes.
const LONGEST: usize = 16 << 10;
/// What need not be encoded in the part with the commands.
const PLAIN: &AsciiSet = &NON_ALPHANUMERIC.remove(b'-').remove(b'_').remove(b'.').remove(b',');

/// Why a link leads nowhere.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum LinkError {
    /// It is none.
    #[error("a link begins with {SCHEME}HOST:PORT")]
    NoLink,
    /// Its commands are no text.
    #[error("the commands in the link cannot be decoded: {0}")]
    NoText(#[from] std::str::Utf8Error),
    /// It is too long.
    #[error("the link is longer than 16 KiB")]
    TooLong,
    /// A part of it is no command.
    #[error("`{0}` in the link: {1}")]
    BadCommand(String, CommandError),
    /// A part of it does more than to look.
    #[error("a link may not contain `{0}`")]
    Forbidden(String),
}

/// A link that has been read.
#[derive(Clone, Debug, PartialEq)]
pub struct Shared {
    /// HOST:PORT of the daemon.
    pub address: String,
    /// What restores the view.
    pub commands: Vec<Command>,
}

/// The link that restores what is seen now.
pub fn link(
    address: &str,
    camera: &ViewCamera,
    settings: &Settings,
    selection: Option<&Selection>,
) -> String {
    let commands = view(camera, settings, selection);
    // Each by itself: names may hold what divides commands.
    let encode = |command: &Command| utf8_percent_encode(&command.to_string(), PLAIN).to_string();
    let texts: Vec<String> = commands.iter().map(encode).collect();
    format!("{SCHEME}{address}#{}", texts.join(";"))
}

/// The commands that restore what is seen now.
fn view(camera: &ViewCamera, settings: &Settings, selection: Option<&Selection>) -> Vec<Command> {
    let Settings { filter, .. } = settings;
    let mut commands = vec![
        Command::Camera(CameraCommand::Place(camera.place())),
        Command::Camera(CameraCommand::Through(Switch::to(camera.is_through()))),
    ];
    // The image that others are compared with is a file of the user's.
    let can_see = |command: &Command| !matches!(command, Command::Image(ImageCommand::Show(layer)) if layer.compares());
    let looks = settings.commands().into_iter();
    commands.extend(looks.filter(|command| command.form().is(Trait::Linked) && can_see(command)));
    let mut wanted = vec![FilterCommand::Clear];
    if filter.kept().iter().any(|kept| kept.on) && !filter.is_off() {
        // Names are the user's own; what they stand for is not.
        wanted.push(FilterCommand::Set(filter.whole().clone()));
    } else {
        if !filter.text().wants_all() {
            wanted.push(FilterCommand::Set(filter.text().clone()));
        }
        wanted.extend(filter.selectors().iter().map(|sphere| FilterCommand::Add(*sphere)));
        wanted.extend(filter.is_inverted().then_some(FilterCommand::Invert(Switch::On)));
        wanted.extend(filter.is_off().then_some(FilterCommand::Enable(Switch::Off)));
    }
    commands.extend(wanted.into_iter().map(Command::Filter));
    let shown = selection.map(|selection| {
        let Selection { header, vertices, .. } = selection;
        PathCommand::Show(ShownPath { header: *header, vertices: vertices.clone() })
    });
    // The vertex that is looked at is where the camera is already.
    commands.extend(shown.map(Command::Path));
    commands
}

/// Reads a link.
pub fn read(link: &str) -> Result<Shared, LinkError> {
    if link.len() > LONGEST {
        return Err(LinkError::TooLong);
    }
    let rest = link.trim().strip_prefix(SCHEME).ok_or(LinkError::NoLink)?;
    let (address, encoded) = rest.split_once('#').unwrap_or((rest, ""));
    let address = address.trim_end_matches('/').to_owned();
    if address.is_empty() {
        return Err(LinkError::NoLink);
    }
    let parts = encoded.split(';').filter(|part| !part.is_empty());
    let commands = parts.map(|part| {
        let part = percent_decode_str(part).decode_utf8()?;
        let problem = |error| LinkError::BadCommand(part.clone().into_owned(), error);
        let command: Command = part.parse().map_err(problem)?;
        if command.form().is(Trait::Linked) {
            Ok(command)
        } else {
            Err(LinkError::Forbidden(part.into_owned()))
        }
    });
    Ok(Shared { address, commands: commands.collect::<Result<_, LinkError>>()? })
}

#[cfg(test)]
mod tests {
    use common::FilterText;

    use super::*;
    use crate::value::{Layer, Sphere};

    #[test]
    fn a_link_restores_the_view() {
        let mut settings = Settings::default();
        let text = r#"any on material "a; b 100% #1 \"стекло\"" and film in rect(0.25, 0, 1, 0.5)"#;
        settings.filter.apply(&FilterCommand::Set(FilterText::read(text)));
        settings.image.layer = Layer::Dwell;
        settings.scene.opacity = 0.25;
        let sphere = Sphere { kind: common::SelectorKind::End, place: [0.5, 1.0, -2.0, 0.25] };
        settings.filter.apply(&FilterCommand::Add(sphere));
        settings.filter.apply(&FilterCommand::Invert(Switch::On));
        let mut camera = ViewCamera::default();
        camera.apply(CameraCommand::Orbit(33.5, -12.25));
        let path = crate::synthetic::batch(&[&[[1.0, 2.5, -3.0], [4.0, 6.0, 1e-7]]]);
        let mut reader = path.reader();
        let path = reader.next().expect("a path");
        let selection = Selection::new(path.header, path.vertices.to_vec());
        let text = link("127.0.0.1:50061", &camera, &settings, Some(&selection));
        assert!(text.is_ascii() && !text.contains(' '), "fit for a chat: {text}");
        let shared = read(&text).expect("our own link");
        assert_eq!(shared.address, "127.0.0.1:50061", "the daemon");
        let (mut other, mut restored) = (ViewCamera::default(), Settings::default());
        let mut selected = None;
        for command in shared.commands {
            match command {
                Command::Camera(command) => other.apply(command),
                Command::Path(PathCommand::Show(path)) => {
                    selected = Some(Selection::new(path.header, path.vertices));
                }
                command => restored.apply(&command),
            }
        }
        assert_eq!(other, camera, "the eye, to the last bit");
        assert_eq!(restored, settings, "what it sees");
        assert_eq!(selected, Some(selection), "and the path that is selected, to the last bit");
        settings.filter.apply(&FilterCommand::Keep("mine".to_owned()));
        settings.filter.apply(&FilterCommand::Use(Switch::On, "mine".to_owned()));
        let shared = read(&link("a:1", &camera, &settings, None)).expect("our own link");
        let wanted = Command::Filter(FilterCommand::Set(settings.filter.whole().clone()));
        assert!(shared.commands.contains(&wanted), "kept filters travel as text");
    }

    #[test]
    fn links_of_strangers_do_no_harm() {
        for text in [
            "http://127.0.0.1:1#quit",
            "lvis://#camera%20frame",
            "lvis://a:1#%ff",
            "lvis://a:1#quit",
            "lvis://a:1#image%20save%20x.exr",
            "lvis://a:1#chains%20pause",
            "lvis://a:1#filter%20forget%20mine",
            "lvis://a:1#cloud%20budget%2065536",
            "lvis://a:1#nonsense",
        ] {
            assert!(read(text).is_err(), "`{text}` was followed");
        }
        assert_eq!(read(&"x".repeat(LONGEST + 1)), Err(LinkError::TooLong), "an endless one");
        let plain = read("lvis://render-box:50061").expect("an address alone");
        assert!(plain.commands.is_empty(), "{plain:?}");
    }
}
