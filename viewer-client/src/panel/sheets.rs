//! What each section is for, for those who ask.

use crate::keys::Group;
use crate::value::PanelName;

/// What there is to know of a section.
pub(super) fn lines(name: PanelName) -> &'static [&'static str] {
    match name {
        PanelName::Cloud => &[
            "The lines are paths of light, each from the light to the camera, as the chains found \
             them.",
            "Colour says one thing at a time; the legend in the corner tells which. The budget bounds \
             the memory for paths; older ones go first.",
        ],
        PanelName::Filter => &[
            "Only the paths that the filter wants are sent. Take a preset, write the text, put \
             conditions together below it, or make spheres in the view: all of it is one filter.",
            "What holds can be kept under a name. Matched and seen are exact; the energy is the share \
             of the image's light that matching paths carry.",
        ],
        PanelName::Scene => &[
            "How surfaces are drawn. Make them transparent, cut the scene open, or leave edges alone \
             to see the paths behind them.",
        ],
        PanelName::Image => &[
            "The image that the chains have made so far. The wheel comes closer, the right button \
             shifts.",
            "Click a pixel, or drag a rectangle: then only paths to there are sent. Ctrl+C copies the \
             raw values of the pixel under the cursor.",
        ],
        PanelName::Path => &[
            "Everything that is known of the path that was clicked in the view. Click again there for \
             the next one under the cursor.",
        ],
        PanelName::Explorer => &[
            "A chain of your own, which never touches the image: seed it with a path and step it to \
             see what each mutation does.",
            "Only the driver may; the others watch.",
        ],
        PanelName::Playback => &["Plays the file of paths; drag the line to go to any step."],
        PanelName::Statistics => &[
            "Counts of all chains since the epoch began. For each strategy: how often it was chosen, \
             how often it made a whole path, and how often the chain moved there.",
        ],
        PanelName::Diagnostics => &[
            "Whether the image can be believed, from every step of every chain. R-hat above 1.1 means \
             that chains disagree; the maps show where.",
        ],
    }
}

/// Whose keys belong to a section.
pub(super) fn groups(name: PanelName) -> &'static [Group] {
    match name {
        PanelName::Cloud | PanelName::Path => &[Group::Paths],
        PanelName::Explorer | PanelName::Playback => &[Group::Explorer],
        PanelName::Scene => &[Group::Camera],
        PanelName::Filter | PanelName::Image | PanelName::Statistics | PanelName::Diagnostics => {
            &[]
        }
    }
}
