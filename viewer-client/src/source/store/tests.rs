//! The budget holds, the order holds, and nothing is lost unseen.

use common::{
    BatchBuilder, BatchLimits, ChainId, Event, Kept, PathHeader, PathId, THROUGHPUT_UNKNOWN,
    VertexKind, VertexRecord, encode_throughput,
};
use shaders::role;

use super::*;

fn vertex(tag: f32) -> VertexRecord {
    VertexRecord {
        position: [tag, 1.0, 2.0],
        normal: [0, 0],
        kind: VertexKind::Diffuse,
        event: Event::Diffuse,
        material: 0,
        primitive: 0,
    }
}

/// `paths` paths of `vertices` vertices, numbered from `first`.
fn batch(first: u64, paths: u64, vertices: usize) -> PathBatch {
    let mut builder = BatchBuilder::new(BatchLimits { bytes: usize::MAX });
    for step in first..first + paths {
        let id = PathId { chain: ChainId(0), epoch: 0, step };
        let header =
            PathHeader { id, luminance: 2.0, rgb: [0.5, 0.25, 0.0], ..PathHeader::default() };
        let path: Vec<_> = (0..vertices).map(|i| vertex(step as f32 + i as f32 / 64.0)).collect();
        assert!(builder.push(&header, &path, None).is_none(), "the batch has no limit");
    }
    builder.finish().expect("a batch with paths")
}

#[test]
fn the_budget_holds_and_the_oldest_go_first() {
    let mut store = Store::new(3 * Page::BYTES + 5);
    for i in 0..100 {
        store.append(&batch(1000 * i, 1000, 5));
        assert!(store.byte_len() <= store.budget(), "over the budget after batch {i}");
    }
    let held: Vec<u64> =
        store.pages().flat_map(|p| p.paths().iter().map(|p| p.header.id.step)).collect();
    assert_eq!(held.len(), store.len(), "the count is right");
    assert_eq!(held.last(), Some(&99_999), "the newest is there");
    assert!(held.windows(2).all(|w| w[1] == w[0] + 1), "no hole, in order");
    assert!(held.len() > 2 * PAGE_POINTS / 5, "the budget is used: {}", held.len());
    assert_eq!(store.counts().paths, 100_000, "all were counted");

    store.set_budget(Page::BYTES);
    assert!(store.byte_len() <= Page::BYTES, "a smaller budget takes effect at once");
    assert!(store.page(0).is_none(), "dropped pages are gone");
    assert!(store.page(store.first_serial()).is_some(), "kept pages are found");
}

#[test]
fn a_budget_below_a_page_still_holds_one() {
    let mut store = Store::new(1);
    store.append(&batch(0, 10, 4));
    assert_eq!(store.len(), 10, "something to look at");
}

#[test]
fn points_are_the_vertices_in_order_with_their_roles() {
    let mut store = Store::new(usize::MAX);
    store.append(&batch(0, 3, 4));
    let page = store.pages().next().expect("a page");
    let points: Vec<_> = page.points(1, Drawn::All).collect();
    assert_eq!(points.len(), 8, "the last two paths");
    assert_eq!(points[0].position[0], 1.0, "the second path comes first");
    let info: Vec<_> = points[4..].iter().map(|p| p.info[0]).collect();
    let kind = (VertexKind::Diffuse as u8) << role::KIND_SHIFT;
    assert_eq!(info, [role::START, 0, 0, role::LAST].map(|r| r | kind), "roles and kinds");
    assert_eq!(points[7].info[1] >> 4, 3, "edges");
    assert_eq!(points[7].info[3], THROUGHPUT_UNKNOWN, "nobody told the throughput");
    assert_eq!(points[7].ordinal & 0xff_ffff, 2, "the third path");
    assert_eq!(points[0].color[..3], [255, 180, 0], "hue at full scale");
}

#[test]
fn what_batches_tell_of_throughputs_is_kept() {
    let mut builder = BatchBuilder::new(BatchLimits { bytes: usize::MAX });
    let path = [vertex(0.0), vertex(1.0), vertex(2.0)];
    let header = PathHeader { acceptance: 0.2, dwell: 9, ..PathHeader::default() };
    let codes = [0.125, 0.5, 1.0].map(encode_throughput);
    assert!(builder.push_with(&header, &path, &codes, None).is_none(), "room enough");
    assert!(
        builder.push_with(&header, &path, &[], Some(Kept { light: 1, eye: 1 })).is_none(),
        "room enough"
    );
    let mut store = Store::new(usize::MAX);
    store.append(&builder.finish().expect("two paths"));
    let page = store.pages().next().expect("a page");
    let points: Vec<_> = page.points(0, Drawn::All).collect();
    let of = |range: std::ops::Range<usize>| points[range].iter().map(|p| p.info[3]);
    assert!(of(0..3).eq(codes), "one a vertex");
    assert!(of(3..6).eq([THROUGHPUT_UNKNOWN; 3]), "also where a path keeps vertices");
    assert_eq!(points[0].ordinal >> 24, 3 << 4 | 3, "eight to fifteen steps, three fifteenths");
    let [codes_per_stop, lowest] = shaders::THROUGHPUT_CODE;
    let read = (f32::from(codes[0]) - 1.0) / codes_per_stop + lowest;
    assert_eq!(common::decode_throughput(codes[0]), Some(read), "shaders read it alike");
}

#[test]
fn the_newest_paths_are_found_across_pages() {
    let mut store = Store::new(usize::MAX);
    let a_page = (PAGE_POINTS / 4) as u64;
    store.append(&batch(0, a_page + 10, 4));
    assert_eq!(store.newest(4), [(1, 24)], "within the newest page");
    assert_eq!(store.newest(10), [(1, 0)], "exactly the newest page");
    assert_eq!(store.newest(12), [(1, 0), (0, (a_page as usize - 2) * 4)], "over two pages");
    assert_eq!(store.newest(usize::MAX), [(1, 0), (0, 0)], "all");
    assert_eq!(store.newest(0), [], "none");
}

#[test]
fn gaps_and_skips_are_counted() {
    let mut store = Store::new(usize::MAX);
    store.count_gap(17);
    store.count_gap(3);
    store.skip(&batch(0, 5, 2));
    let counts = store.counts();
    assert_eq!((counts.gaps, counts.dropped), (2, 20), "gaps");
    assert_eq!((counts.paths, counts.skipped), (5, 5), "skips");
    assert!(store.is_empty(), "nothing was kept");
}

#[test]
fn tone_follows_the_radiance() {
    let mut tone = Tone::default();
    for i in 0..20_000_u32 {
        tone.include(if i % 2 == 0 { 1.0 } else { 256.0 });
    }
    let (low, high) = tone.range();
    assert!((-5.0..-2.0).contains(&low), "low end {low}");
    assert!((10.0..13.0).contains(&high), "high end {high}");
}
