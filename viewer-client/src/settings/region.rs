//! The part of the image whose paths are wanted: one condition of the filter, found and replaced
//! without touching the others.

use common::{Filter, Leaf};

/// Left, top, right and bottom on the film, from 0 to 1.
pub type Region = [f64; 4];

/// The rectangle that a filter asks for, alone or along with other conditions.
pub fn region_of(text: &str) -> Option<Region> {
    fn rectangle(filter: &Filter) -> Option<Region> {
        match filter {
            Filter::Leaf(Leaf::Film { min: [u0, v0], max: [u1, v1] }) => Some([*u0, *v0, *u1, *v1]),
            Filter::And(parts) => parts.iter().find_map(rectangle),
            _ => None,
        }
    }
    rectangle(&Filter::parse(text).ok()?)
}

/// The filter `text` with its rectangle replaced; without one, it wants paths from all of the film.
pub fn with_region(text: &str, region: Option<Region>) -> String {
    let rest = Filter::parse(text).ok().and_then(without_region);
    let [u0, v0, u1, v1] = region.unwrap_or_default();
    let leaf = region.map(|_| Filter::Leaf(Leaf::Film { min: [u0, v0], max: [u1, v1] }));
    match (rest, leaf) {
        (None, None) => String::new(),
        (Some(filter), None) | (None, Some(filter)) => filter.to_string(),
        (Some(Filter::And(mut parts)), Some(leaf)) => {
            parts.push(leaf);
            Filter::And(parts).to_string()
        }
        (Some(rest), Some(leaf)) => Filter::And(vec![rest, leaf]).to_string(),
    }
}

/// What is left of a filter without its rectangle; `None` where that is every path.
fn without_region(filter: Filter) -> Option<Filter> {
    match filter {
        Filter::Constant(true) | Filter::Leaf(Leaf::Film { .. }) => None,
        Filter::And(parts) => {
            let mut rest: Vec<_> = parts.into_iter().filter_map(without_region).collect();
            match rest.len() {
                0 | 1 => rest.pop(),
                _ => Some(Filter::And(rest)),
            }
        }
        other => Some(other),
    }
}

/// The rectangle that holds the pixels from one to another, both included.
pub fn pixels(size: [usize; 2], from: [usize; 2], to: [usize; 2]) -> Region {
    let low = |i: usize| short(from[i].min(to[i]) as f32 / size[i] as f32);
    // The paths of the next pixel begin at its edge, which a rectangle includes.
    let high = |i: usize| {
        let edge = (from[i].max(to[i]) + 1) as f32 / size[i] as f32;
        short(edge.next_down())
    };
    [low(0), low(1), high(0), high(1)]
}

/// A number with no more digits than its f32 needs, for people to read.
fn short(number: f32) -> f64 {
    number.to_string().parse().unwrap_or_else(|_| f64::from(number))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_region_is_added_replaced_and_taken_away() {
        let region = [0.25, 0.0, 0.75, 0.5];
        let alone = with_region("", Some(region));
        assert_eq!(alone, "film in rect(0.25, 0, 0.75, 0.5)", "alone");
        assert_eq!(region_of(&alone), Some(region), "and found");
        let beside = with_region("edges >= 4 and any is specular", Some(region));
        assert_eq!(region_of(&beside), Some(region), "{beside}");
        let moved = with_region(&beside, Some([0.0, 0.0, 0.5, 0.5]));
        assert_eq!(region_of(&moved), Some([0.0, 0.0, 0.5, 0.5]), "{moved}");
        assert_eq!(moved.matches("rect").count(), 1, "one at a time: {moved}");
        let back = with_region(&moved, None);
        assert_eq!(Filter::parse(&back), Filter::parse("edges >= 4 and any is specular"), "{back}");
        assert_eq!(with_region(&alone, None), "", "every path again");
    }

    #[test]
    fn a_condition_under_not_or_or_is_not_the_region() {
        let text = "not film in rect(0, 0, 0.5, 0.5)";
        assert_eq!(region_of(text), None, "the outside of a rectangle is none");
        let both = with_region(text, Some([0.0, 0.0, 1.0, 1.0]));
        assert_eq!(both.matches("rect").count(), 2, "it stays: {both}");
    }

    #[test]
    fn neighbouring_pixels_share_no_path() {
        let size = [160, 120];
        let [.., right, _] = pixels(size, [3, 5], [3, 5]);
        let [left, ..] = pixels(size, [4, 5], [4, 5]);
        assert!(right.to_string().len() <= 12, "{right} is short");
        assert!(right < left, "{right} and {left}");
        assert_eq!(pixels(size, [9, 8], [4, 5]), pixels(size, [4, 5], [9, 8]), "either way");
    }
}
