//! The condition that `docs/EXTEND.md` walks through, which is `returns.rs` beside this file.

use super::super::print::text_of;
use super::super::reader::Reader;
use super::returns::ReturnsCondition;
use super::*;

fn read(text: &str) -> Result<ReturnsCondition, FilterError> {
    Reader::new(text).whole("the end", |reader| {
        let mut condition = ReturnsCondition::default();
        condition.describe(reader).map(|()| condition)
    })
}

#[test]
fn the_example_of_the_manual_is_a_condition() {
    let manual = include_str!("../../../../docs/EXTEND.md");
    assert!(manual.contains(include_str!("returns.rs")), "docs/EXTEND.md shows another file");
    let example = ReturnsCondition::EXAMPLE;
    let condition = read(example).expect(example);
    assert_eq!(text_of(&condition), example, "printed as it was read");
    assert!(manual.contains(&format!("```filter\n{example}\n```")), "the line for docs/FILTERS.md");
    let wrong = read("returns withim 1").expect_err("no such word");
    assert!(wrong.span.start == 8 && wrong.message.contains("did you mean `within`"), "{wrong}");
    assert!(read("returns within -1").is_err(), "what `check` is for");
    // The vertices lie at (i, 0, 0) in the file.
    let bound = |reach| ReturnsCondition { reach }.bind(&scene()).expect("no names");
    let (header, path) = (PathHeader::default(), path("LDDE"));
    assert!(bound(3.0).holds(&header, &path) && !bound(2.5).holds(&header, &path), "at 3");
    assert_eq!(bound(2.0).gap(&header, &path), Some(Gap { by: 1.0, relative: 0.5 }), "by one");
    let made = ReturnsCondition::proposals(&scene(), Spot::default());
    assert_eq!(made[0].made, Some(ReturnsCondition { reach: 1.0 }), "what a menu offers");
}
