//! Where the panels of the window are.

use serde::{Deserialize, Deserializer, Serialize};

use crate::command::LayoutCommand;
use crate::value::{Move, PanelName, WIDTHS, WindowSide};

/// Where the panels of the window are, and which are open.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(default)]
pub struct Layout {
    /// All panels from the top of the left side on; where the left side ends, see [`Self::left`].
    #[serde(deserialize_with = "known")]
    order: Vec<PanelName>,
    /// Those on the left side.
    #[serde(deserialize_with = "known")]
    left: Vec<PanelName>,
    /// Those that are not open.
    #[serde(deserialize_with = "known")]
    closed: Vec<PanelName>,
    /// Those that are nothing but their heading.
    #[serde(deserialize_with = "known")]
    folded: Vec<PanelName>,
    /// Widths of the left and of the right side in points, within [`WIDTHS`].
    widths: [u16; 2],
}

/// Usual widths of the sides: what their widest rows need.
const USUAL_WIDTHS: [u16; 2] = [276, 380];
/// What the view keeps of the window's width, in points; in a small window, [`VIEW_SHARE`] of it.
const VIEW: f32 = 240.0;
const VIEW_SHARE: f32 = 0.4;

impl Default for Layout {
    fn default() -> Self {
        let left = PanelName::ALL.into_iter().filter(|name| name.is_usually_left());
        Self {
            order: PanelName::ALL.to_vec(),
            left: left.collect(),
            closed: Vec::new(),
            folded: Vec::new(),
            widths: USUAL_WIDTHS,
        }
    }
}

/// The panels of a list that there are; a file may be of a newer version.
fn known<'de, D: Deserializer<'de>>(reader: D) -> Result<Vec<PanelName>, D::Error> {
    let words = Vec::<String>::deserialize(reader)?;
    Ok(words.iter().filter_map(|word| word.parse().ok()).collect())
}

/// Makes a panel one of a set, or not.
fn change(set: &mut Vec<PanelName>, name: PanelName, is_in: bool) {
    set.retain(|known| *known != name);
    if is_in {
        set.push(name);
        // The same set is the same list, whatever was done in which order.
        set.sort();
    }
}

impl Layout {
    /// This one with every panel in its place once, and widths within their limits: what was written
    /// by an older version, or by hand, may lack some.
    #[must_use]
    pub fn completed(mut self) -> Self {
        let missing: Vec<PanelName> =
            PanelName::ALL.into_iter().filter(|name| !self.order.contains(name)).collect();
        let is_left = |name: &PanelName| name.is_usually_left();
        self.left.extend(missing.iter().copied().filter(is_left));
        self.order.extend(missing);
        let mut order = Vec::new();
        for name in self.order {
            if !order.contains(&name) {
                order.push(name);
            }
        }
        self.order = order;
        for set in [&mut self.left, &mut self.closed, &mut self.folded] {
            set.sort();
            set.dedup();
        }
        for (width, usual) in self.widths.iter_mut().zip(USUAL_WIDTHS) {
            if !WIDTHS.contains(*width) {
                *width = usual;
            }
        }
        self
    }

    /// True when the panel is open.
    pub fn is_open(&self, panel: PanelName) -> bool {
        !self.closed.contains(&panel)
    }

    /// True when nothing of the panel is shown but its heading.
    pub fn is_folded(&self, panel: PanelName) -> bool {
        self.folded.contains(&panel)
    }

    /// True when the panel belongs to the left side.
    pub fn is_left(&self, panel: PanelName) -> bool {
        self.left.contains(&panel)
    }

    /// The panels of a side from the top on, open or not.
    pub fn side(&self, side: WindowSide) -> impl Iterator<Item = PanelName> + '_ {
        let left = side == WindowSide::Left;
        self.order.iter().copied().filter(move |name| self.is_left(*name) == left)
    }

    /// The width of a side in points.
    pub fn width(&self, side: WindowSide) -> u16 {
        self.widths[side as usize]
    }

    /// Points that a side keeps beside another one, unless it is to be narrower anyway.
    pub const NARROW: f32 = 240.0;
    /// Width of a side that is folded because there is no room for both, in points.
    pub const STRIP: f32 = 26.0;

    /// Points for the sides in a window that is `window` points wide; the view has the rest.
    pub fn room(window: f32) -> f32 {
        window - VIEW.min(VIEW_SHARE * window)
    }

    /// How wide the sides are that want to be as wide as `wished`, if they have anything to show.
    ///
    /// Where both together are too wide, each gives of what it has above [`Self::NARROW`]. `None` is a
    /// side that has nothing to show, or one to fold to a strip: where there is no room for both, only
    /// the one that is `in_use` stays. What is remembered does not change.
    pub fn fit(wished: [Option<f32>; 2], window: f32, in_use: WindowSide) -> [Option<f32>; 2] {
        let room = Self::room(window);
        let [Some(left), Some(right)] = wished else {
            return wished.map(|wish| wish.map(|width| width.min(room)));
        };
        let over = left + right - room;
        if over <= 0.0 {
            return wished;
        }
        let spare = [left, right].map(|wish| (wish - Self::NARROW).max(0.0));
        let both = spare[0] + spare[1];
        if over <= both {
            let share = over / both;
            let give = |wish: f32, spare: f32| Some((wish - share * spare).floor());
            return [give(left, spare[0]), give(right, spare[1])];
        }
        let alone = room - Self::STRIP;
        match in_use {
            WindowSide::Left => [Some(left.min(alone)), None],
            WindowSide::Right => [None, Some(right.min(alone))],
        }
    }

    /// Moves a panel.
    fn arrange(&mut self, name: PanelName, place: Move) {
        let side = if self.is_left(name) { WindowSide::Left } else { WindowSide::Right };
        let near: Vec<PanelName> = self.side(side).filter(|near| self.is_open(*near)).collect();
        let at = near.iter().position(|near| *near == name);
        let neighbour = |step: isize| near.get(at?.checked_add_signed(step)?).copied();
        let before = match place {
            Move::Left | Move::Right => {
                change(&mut self.left, name, place == Move::Left);
                None
            }
            Move::Before(other) => {
                let is_left = self.is_left(other);
                change(&mut self.left, name, is_left);
                Some(other)
            }
            Move::Up => match neighbour(-1) {
                Some(above) => Some(above),
                None => return,
            },
            Move::Down if neighbour(1).is_none() => return,
            Move::Down => neighbour(2),
        };
        if before == Some(name) {
            return;
        }
        self.order.retain(|other| *other != name);
        let index = before.and_then(|before| self.order.iter().position(|other| *other == before));
        self.order.insert(index.unwrap_or(self.order.len()), name);
    }

    /// Follows a command.
    pub fn apply(&mut self, command: LayoutCommand) {
        match command {
            LayoutCommand::Fold(name, switch) => {
                let mut is_folded = self.is_folded(name);
                switch.apply(&mut is_folded);
                change(&mut self.folded, name, is_folded);
            }
            LayoutCommand::Arrange(name, place) => self.arrange(name, place),
            LayoutCommand::Width(side, points) => self.widths[side as usize] = points,
            LayoutCommand::Usual => {
                *self = Self { closed: std::mem::take(&mut self.closed), ..Self::default() };
            }
            LayoutCommand::Panel(name, switch) => {
                let mut is_open = self.is_open(name);
                switch.apply(&mut is_open);
                change(&mut self.closed, name, !is_open);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sides_leave_room_for_the_view() {
        use WindowSide::{Left, Right};
        let usual = USUAL_WIDTHS.map(|width| Some(f32::from(width)));
        assert_eq!(Layout::fit(usual, 1280.0, Left), usual, "as they are remembered");
        for in_use in WindowSide::ALL {
            for tens in 30..200 {
                let window = 10.0 * tens as f32;
                for wished in [usual, [Some(900.0), Some(900.0)], [Some(900.0), None]] {
                    let fitted = Layout::fit(wished, window, in_use);
                    let sum: f32 = fitted.into_iter().flatten().sum();
                    let view = window - sum;
                    assert!(view >= (0.4 * window).min(240.0) - 1e-3, "{window}: {fitted:?}");
                    assert!(fitted.into_iter().flatten().all(|w| w > 0.0), "{window}: {fitted:?}");
                }
            }
        }
        // A window of 1280 pixels at 150 and at 200 per cent.
        let [Some(left), Some(right)] = Layout::fit(usual, 1280.0 / 1.5, Left) else {
            panic!("there is room for both")
        };
        assert!(left >= Layout::NARROW && right >= Layout::NARROW, "both serve: {left}, {right}");
        assert_eq!(Layout::fit(usual, 640.0, Left), [Some(276.0), None], "the one in use");
        let [None, Some(right)] = Layout::fit(usual, 640.0, Right) else { panic!("the other one") };
        assert!(right > 350.0, "all the room there is, not {right}");
        assert_eq!(Layout::fit([None, None], 640.0, Right), [None, None], "nothing to show");
    }

    #[test]
    fn panels_are_put_elsewhere_and_back() {
        let mut layout = Layout::default();
        let side = |layout: &Layout, side| layout.side(side).collect::<Vec<_>>();
        use PanelName::{Cloud, Filter, Image, Path, Scene, Statistics};
        use WindowSide::{Left, Right};
        let usual = layout.clone();
        let mut run = |command: &str| {
            let command = command.parse().expect(command);
            if let crate::command::Command::Layout(command) = command {
                layout.apply(command);
            }
            layout.clone()
        };
        assert_eq!(side(&run("arrange scene up"), Left), [Cloud, Scene, Filter], "up");
        assert_eq!(run("arrange cloud up"), run("arrange cloud up"), "it is the first");
        assert_eq!(side(&run("arrange cloud down"), Left), [Scene, Cloud, Filter], "down");
        assert_eq!(run("arrange filter down").order, run("arrange filter down").order, "the last");
        let moved = run("arrange statistics before cloud");
        assert_eq!(side(&moved, Left), [Scene, Statistics, Cloud, Filter], "to the other side");
        assert_eq!(side(&moved, Right)[..2], [Image, Path], "the others stay");
        // What is closed is passed over.
        run("panel statistics off");
        assert_eq!(side(&run("arrange scene down"), Left)[..3], [Statistics, Cloud, Scene], "down");
        run("panel statistics on");
        run("width right 500");
        assert!(run("fold image on").is_folded(Image), "folded");
        assert_eq!(run("usual"), usual, "as it was");
    }
}
