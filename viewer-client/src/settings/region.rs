//! The part of the image whose paths are wanted: one condition of the filter, found and replaced
//! without touching the others.

use common::{FilmCondition, Filter, FilterText, Leaf};

/// Left, top, right and bottom on the film, from 0 to 1.
pub type Region = [f64; 4];

/// The rectangle that a filter asks for, alone or along with other conditions.
pub fn region_of(text: &FilterText) -> Option<Region> {
    fn rectangle(filter: &Filter) -> Option<Region> {
        match filter {
            Filter::Leaf(Leaf::Film(FilmCondition { min: [u0, v0], max: [u1, v1] })) => {
                Some([*u0, *v0, *u1, *v1])
            }
            Filter::And(parts) => parts.iter().find_map(rectangle),
            Filter::Leaf(_) | Filter::Constant(_) | Filter::Not(_) | Filter::Or(_) => None,
        }
    }
    rectangle(text.tree().ok()?)
}

/// The filter with its rectangle replaced; without one, it wants paths from all of the film.
pub fn with_region(text: &FilterText, region: Option<Region>) -> FilterText {
    let mut parts = match text.tree().cloned().map(without_region) {
        Ok(Filter::And(parts)) => parts,
        Ok(rest) => vec![rest],
        Err(_) => Vec::new(),
    };
    parts.extend(region.map(|[u0, v0, u1, v1]| {
        Filter::Leaf(Leaf::Film(FilmCondition { min: [u0, v0], max: [u1, v1] }))
    }));
    FilterText::from(&Filter::all_of(parts))
}

/// What is left of a filter without its rectangle.
fn without_region(filter: Filter) -> Filter {
    match filter {
        Filter::Leaf(Leaf::Film(_)) => Filter::default(),
        Filter::And(parts) => Filter::all_of(parts.into_iter().map(without_region).collect()),
        other => other,
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
        let alone = with_region(&FilterText::default(), Some(region));
        assert_eq!(alone.text(), "film in rect(0.25, 0, 0.75, 0.5)", "alone");
        assert_eq!(region_of(&alone), Some(region), "and found");
        let before = FilterText::read("edges >= 4 and any is specular");
        let beside = with_region(&before, Some(region));
        assert_eq!(region_of(&beside), Some(region), "{beside}");
        let moved = with_region(&beside, Some([0.0, 0.0, 0.5, 0.5]));
        assert_eq!(region_of(&moved), Some([0.0, 0.0, 0.5, 0.5]), "{moved}");
        assert_eq!(moved.text().matches("rect").count(), 1, "one at a time: {moved}");
        assert_eq!(with_region(&moved, None), before, "and back");
        assert!(with_region(&alone, None).wants_all(), "every path again");
    }

    #[test]
    fn a_condition_under_not_or_or_is_not_the_region() {
        let text = FilterText::read("not film in rect(0, 0, 0.5, 0.5)");
        assert_eq!(region_of(&text), None, "the outside of a rectangle is none");
        let both = with_region(&text, Some([0.0, 0.0, 1.0, 1.0]));
        assert_eq!(both.text().matches("rect").count(), 2, "it stays: {both}");
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
