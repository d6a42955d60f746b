//! `cloud ...`: which paths are on screen, and how they are drawn.

use std::fmt;

use super::Form;
use super::words::{CommandError, Switch, Words};

/// What may be done to the cloud of paths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CloudCommand {
    /// Takes no new paths, so that the cloud stands still.
    Freeze(Switch),
    /// Forgets every path.
    Clear,
    /// Width of the lines in pixels.
    Width(f32),
    /// Opacity of the newest, brightest path.
    Opacity(f32),
    /// Opacity, relative to the visible part, of what lies behind a surface.
    Hidden(f32),
    /// After how many newer paths a path has faded.
    Fade(f32),
    /// How many of the newest paths are drawn.
    Shown(u32),
    /// How many paths may wait to be taken in.
    Limit(u32),
    /// How many must wait before any is taken in.
    Threshold(u32),
    /// Memory for paths, in MiB.
    Budget(u32),
    /// What the colour says.
    Color(ColorMode),
    /// Tints the light end and the camera end.
    Ends(Switch),
    /// Radius of the dots at inner vertices, in pixels; 0 for none.
    Dots(f32),
    /// What is drawn of a path.
    Marks(Marks),
    /// How values become places on the ramp of colours.
    Scale(ColorScale),
    /// What becomes of paths that cross on the screen.
    Blend(Blend),
    /// How much distance dims paths.
    Cue(f32),
    /// Relative opacity of paths that the filter leaves out; 0 hides them.
    Dim(f32),
}

/// What is drawn of a path.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Marks {
    /// Its edges, and dots as wanted.
    #[default]
    Lines,
    /// Its vertices only.
    Vertices,
    /// The vertex on the light and the one that the camera sees.
    Ends,
}

impl Marks {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Lines, Self::Vertices, Self::Ends];
}

impl fmt::Display for Marks {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Lines => "lines",
            Self::Vertices => "vertices",
            Self::Ends => "ends",
        })
    }
}

/// What becomes of paths that cross on the screen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Blend {
    /// The newest lies on top, and on dark ground glows.
    #[default]
    Newest,
    /// All count by their opacity, near ones more, in whatever order they came.
    Weighted,
    /// They add up like light, in whatever order they came.
    Add,
}

impl Blend {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Newest, Self::Weighted, Self::Add];
}

impl fmt::Display for Blend {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Newest => "newest",
            Self::Weighted => "weighted",
            Self::Add => "add",
        })
    }
}

/// How values become places on the ramp of colours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColorScale {
    /// Equal factors are equal steps.
    #[default]
    Log,
    /// Equal differences are equal steps.
    Linear,
}

impl ColorScale {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Log, Self::Linear];
}

impl fmt::Display for ColorScale {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Log => "log",
            Self::Linear => "linear",
        })
    }
}

/// What the colour of a path says.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColorMode {
    /// The light that the path carries.
    #[default]
    Radiance,
    /// The strategy whose proposal it was.
    Strategy,
    /// Its number of edges, on a ramp.
    Length,
    /// Its luminance, on a ramp.
    Luminance,
    /// How many paths have come since, on a ramp.
    Age,
    /// The kind of each vertex.
    Kind,
    /// Its chain.
    Chain,
    /// Its class, such as `LSDE`.
    Class,
    /// Nothing: all paths alike.
    Constant,
    /// The throughput at each vertex, on a ramp: what is left of the light on its way from there to
    /// the lens.
    Throughput,
    /// How many steps its chain stayed, on a ramp.
    Dwell,
    /// The probability with which it was accepted, on a ramp.
    Acceptance,
}

impl ColorMode {
    /// All, in the order of the shader's codes.
    pub const ALL: [Self; 12] = [
        Self::Radiance,
        Self::Strategy,
        Self::Length,
        Self::Luminance,
        Self::Age,
        Self::Kind,
        Self::Chain,
        Self::Class,
        Self::Constant,
        Self::Throughput,
        Self::Dwell,
        Self::Acceptance,
    ];

    /// True when the colours come from the ramp, and the scale says how.
    pub fn has_scale(self) -> bool {
        matches!(self, Self::Length | Self::Luminance | Self::Throughput)
    }
}

impl fmt::Display for ColorMode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Radiance => "radiance",
            Self::Strategy => "strategy",
            Self::Length => "length",
            Self::Luminance => "luminance",
            Self::Age => "age",
            Self::Kind => "kind",
            Self::Chain => "chain",
            Self::Class => "class",
            Self::Constant => "constant",
            Self::Throughput => "throughput",
            Self::Dwell => "dwell",
            Self::Acceptance => "acceptance",
        })
    }
}

pub(super) const FORMS: &[Form] = &[
    ("cloud freeze on|off|toggle", "hold the cloud still"),
    ("cloud clear", "forget every path"),
    ("cloud width PIXELS", "width of the lines"),
    ("cloud opacity X", "opacity of the newest paths (0 to 1)"),
    ("cloud hidden X", "relative opacity behind surfaces (0 to 1)"),
    ("cloud fade PATHS", "after how many newer paths a path has faded"),
    ("cloud shown PATHS", "how many of the newest paths are drawn"),
    ("cloud limit PATHS", "how many paths may wait; when more do, the oldest go"),
    ("cloud threshold PATHS", "how many paths must wait before they are taken in and filtered"),
    ("cloud budget MIB", "memory for paths"),
    (
        "cloud color radiance|strategy|length|luminance|age|kind|chain|class|constant|\
         throughput|dwell|acceptance",
        "what the colour says",
    ),
    ("cloud ends on|off|toggle", "tint the light end and the camera end"),
    ("cloud dots PIXELS", "radius of the dots at inner vertices, 0 for none"),
    ("cloud marks lines|vertices|ends", "what is drawn of a path"),
    ("cloud scale log|linear", "how lengths, luminances and throughputs become colours"),
    ("cloud blend newest|weighted|add", "what becomes of paths that cross on the screen"),
    ("cloud cue X", "how much distance dims paths (0 to 1)"),
    ("cloud dim X", "relative opacity of what the filter leaves out; 0 hides it"),
];

impl fmt::Display for CloudCommand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Freeze(switch) => write!(f, "freeze {switch}"),
            Self::Clear => write!(f, "clear"),
            Self::Width(pixels) => write!(f, "width {pixels}"),
            Self::Opacity(x) => write!(f, "opacity {x}"),
            Self::Hidden(x) => write!(f, "hidden {x}"),
            Self::Fade(paths) => write!(f, "fade {paths}"),
            Self::Shown(paths) => write!(f, "shown {paths}"),
            Self::Limit(paths) => write!(f, "limit {paths}"),
            Self::Threshold(paths) => write!(f, "threshold {paths}"),
            Self::Budget(mebibytes) => write!(f, "budget {mebibytes}"),
            Self::Color(mode) => write!(f, "color {mode}"),
            Self::Ends(switch) => write!(f, "ends {switch}"),
            Self::Dots(pixels) => write!(f, "dots {pixels}"),
            Self::Marks(marks) => write!(f, "marks {marks}"),
            Self::Scale(scale) => write!(f, "scale {scale}"),
            Self::Blend(blend) => write!(f, "blend {blend}"),
            Self::Cue(x) => write!(f, "cue {x}"),
            Self::Dim(x) => write!(f, "dim {x}"),
        }
    }
}

pub(super) fn parse(words: &mut Words<'_>) -> Result<CloudCommand, CommandError> {
    Ok(match words.next("cloud command")? {
        "freeze" => CloudCommand::Freeze(words.switch()?),
        "clear" => CloudCommand::Clear,
        "width" => CloudCommand::Width(words.number("PIXELS", 0.25..=20.0)?),
        "opacity" => CloudCommand::Opacity(words.number("X", 0.0..=1.0)?),
        "hidden" => CloudCommand::Hidden(words.number("X", 0.0..=1.0)?),
        "fade" => CloudCommand::Fade(words.number("PATHS", 1.0..=1e7)?),
        "shown" => CloudCommand::Shown(words.count("PATHS", 0..=10_000_000)?),
        "limit" => CloudCommand::Limit(words.count("PATHS", 10..=10_000_000)?),
        "threshold" => CloudCommand::Threshold(words.count("PATHS", 0..=10_000_000)?),
        "budget" => CloudCommand::Budget(words.count("MIB", 8..=65_536)?),
        "color" => CloudCommand::Color(words.choice("MODE", &ColorMode::ALL)?),
        "ends" => CloudCommand::Ends(words.switch()?),
        "marks" => CloudCommand::Marks(words.choice("MARKS", &Marks::ALL)?),
        "scale" => CloudCommand::Scale(words.choice("SCALE", &ColorScale::ALL)?),
        "blend" => CloudCommand::Blend(words.choice("BLEND", &Blend::ALL)?),
        "cue" => CloudCommand::Cue(words.number("X", 0.0..=1.0)?),
        "dim" => CloudCommand::Dim(words.number("X", 0.0..=1.0)?),
        "dots" => CloudCommand::Dots(words.number("PIXELS", 0.0..=20.0)?),
        other => return Err(CommandError::Unknown(format!("cloud {other}"))),
    })
}
