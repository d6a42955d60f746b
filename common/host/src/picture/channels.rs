//! Which channels of an EXR file are the picture.

use exr::meta::MetaData;
use exr::meta::header::Header;
use exr::prelude::{IntegerBounds, Text, Vec2};

/// How the channels of a colour are called, after the layer's name and a dot.
const COLOURS: [[&str; 3]; 4] =
    [["R", "G", "B"], ["r", "g", "b"], ["red", "green", "blue"], ["Red", "Green", "Blue"]];
/// How programs call the layer or part that holds the picture, in lower case: Blender, V-Ray, Arnold,
/// `RenderMan`, Nuke and others.
const PICTURES: [&str; 9] =
    ["", "combined", "beauty", "rgba", "rgb", "color", "colour", "effectsresult", "image"];
/// Channels that a message names at most.
const MOST_NAMED: usize = 24;

/// The channels of the picture.
#[derive(Clone, Debug)]
pub(super) struct Choice {
    /// The name of the part that they are in.
    pub(super) part: Option<Text>,
    /// The picture's bounds, which the part may exceed or not fill.
    pub(super) window: IntegerBounds,
    /// Their names.
    pub(super) names: Names,
}

/// Names of channels.
#[derive(Clone, Debug)]
pub(super) enum Names {
    /// Red, green and blue.
    Rgb([Text; 3]),
    /// Luminance alone.
    Grey(Text),
}

/// Finds the picture among the channels of a file; what is the matter where that cannot be told.
pub(super) fn choose(meta: &MetaData) -> Result<Choice, &'static str> {
    let flat = || meta.headers.iter().filter(|header| !header.deep);
    let mut colours: Vec<(bool, Choice)> = flat().flat_map(colours).collect();
    if let Some(at) = colours.iter().position(|(is_picture, _)| *is_picture) {
        return Ok(colours.swap_remove(at).1);
    }
    match colours.len() {
        0 => flat().find_map(grey).ok_or("no picture"),
        1 => Ok(colours.swap_remove(0).1),
        _ => Err("more than one colour and no picture"),
    }
}

/// The colours of a part, and whether each is the picture by its name.
fn colours(header: &Header) -> Vec<(bool, Choice)> {
    let names = names(header);
    let find = |name: String| names.iter().find(|known| known.to_string() == name).cloned();
    let part = header.own_attributes.layer_name.clone();
    let mut found = Vec::new();
    for name in names.iter().map(ToString::to_string) {
        for [red, green, blue] in COLOURS {
            let Some(layer) = name.strip_suffix(red).filter(|layer| is_layer(layer)) else {
                continue;
            };
            let trio = [red, green, blue].map(|end| find(format!("{layer}{end}")));
            if let [Some(r), Some(g), Some(b)] = trio {
                let within = part.as_ref().map(ToString::to_string).unwrap_or_default();
                let is_picture = if is_bare(layer) { is_usual(&within) } else { is_usual(layer) };
                found.push((is_picture, choice(header, Names::Rgb([r, g, b]))));
            }
        }
    }
    found
}

/// The luminance of a part that has no colour.
fn grey(header: &Header) -> Option<Choice> {
    let names = names(header);
    let is_chroma = |name: &Text| matches!(name.to_string().as_str(), "RY" | "BY");
    if header.channels.list.iter().any(|channel| is_chroma(&channel.name)) {
        return None;
    }
    let y = names.into_iter().find(|name| {
        let name = name.to_string();
        name.strip_suffix('Y').is_some_and(|layer| is_layer(layer) && is_usual(layer))
    })?;
    Some(choice(header, Names::Grey(y)))
}

fn choice(header: &Header, names: Names) -> Choice {
    let part = header.own_attributes.layer_name.clone();
    Choice { part, window: header.shared_attributes.display_window, names }
}

/// Names of the channels that have a value for each pixel.
fn names(header: &Header) -> Vec<Text> {
    let whole = header.channels.list.iter().filter(|channel| channel.sampling == Vec2(1, 1));
    whole.map(|channel| channel.name.clone()).collect()
}

/// True where the end of a name stands alone, or behind the dot of a layer.
fn is_layer(layer: &str) -> bool {
    layer.is_empty() || layer.ends_with('.')
}

fn is_bare(layer: &str) -> bool {
    layer.trim_end_matches('.').is_empty()
}

/// True where the last word of a layer's name is what programs call the picture.
fn is_usual(layer: &str) -> bool {
    let layer = layer.trim_end_matches('.');
    let last = layer.rsplit('.').next().unwrap_or_default().to_lowercase();
    PICTURES.contains(&last.as_str())
}

/// The channels of all parts, for people.
pub(super) fn list(meta: &MetaData) -> String {
    let of_part = |header: &Header| -> Vec<String> {
        let part = header.own_attributes.layer_name.as_ref();
        let part = part.map(|name| format!("{name}: ")).unwrap_or_default();
        header.channels.list.iter().map(|channel| format!("`{part}{}`", channel.name)).collect()
    };
    let all: Vec<String> = meta.headers.iter().flat_map(of_part).collect();
    let named = all[..all.len().min(MOST_NAMED)].join(", ");
    if all.len() > MOST_NAMED {
        return format!("{named} and {} more", all.len() - MOST_NAMED);
    }
    named
}
