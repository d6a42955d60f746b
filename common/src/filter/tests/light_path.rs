//! Light path expressions against examples, and against a matcher that is obviously right.

use proptest::prelude::*;

use super::*;

/// Expression, paths from the light that it matches, and paths that it does not.
const EXAMPLES: &[(&str, &[&str], &[&str])] = &[
    ("C.*L", &["LE", "LDE", "LDSTDE"], &[]),
    ("E.*L", &["LE", "LDE"], &[]),
    ("CL", &["LE"], &["LDE"]),
    ("CD*L", &["LE", "LDE", "LDDE"], &["LDSE", "LTE"]),
    ("CD+L", &["LDE", "LDDE"], &["LE", "LSDE"]),
    ("CS+DL", &["LDSE", "LDTSE"], &["LSDE", "LDE"]),
    ("LS+DC", &["LSDE", "LTSDE"], &["LDSE", "LDE"]),
    ("CDS+L", &["LSDE", "LTTDE"], &["LDSE"]),
    ("C<TS><TS>DL", &["LDTTE"], &["LDSSE", "LDTSE"]),
    ("C<RS>.*L", &["LDSE", "LSE"], &["LDTE", "LSDE"]),
    ("CT{2}DL", &["LDTTE"], &["LDTE", "LDTTTE"]),
    ("CT{2,}DL", &["LDTTE", "LDTTTE"], &["LDTE"]),
    ("CT{,2}DL", &["LDE", "LDTTE"], &["LDTTTE"]),
    ("CD{1,2}L", &["LDE", "LDDE"], &["LE", "LDDDE"]),
    ("C[^D]*L", &["LE", "LSTE"], &["LDE", "LSDE"]),
    ("C(DS|SD)L", &["LSDE", "LDSE"], &["LDDE", "LE"]),
    ("C.*'glass'.*L", &["LDTE", "LTDE"], &["LDSE", "LDE"]),
    ("C[^'glass']*L", &["LDSE", "LE"], &["LDTE"]),
    ("C<.S'glass'>.*L", &["LDTE"], &["LDSE", "LDE"]),
    ("C.*<L.'lamp'>", &["LE", "LDE"], &[]),
    ("C.*<L.'glass'>", &[], &["LE", "LDE"]),
    ("CDO", &["LDE"], &["LE", "PDE", "BDE"]),
    ("CDB", &["BDE"], &["LDE", "PDE"]),
    ("CDL", &["LDE", "PDE", "BDE"], &["LE"]),
    ("CD[^OB]", &["PDE"], &["LDE", "BDE"]),
    ("CD'spot'", &["PDE"], &["LDE"]),
    ("C.*V.*L", &[], &["LDE", "LE"]),
    (" C D * L ", &["LDDE"], &["LSE"]),
    ("CGD*L", &["LDGE", "LGE"], &["LDE", "LSE"]),
    ("C[DG]*L", &["LDGE", "LE"], &["LSE", "LDTE"]),
    (".*D.*", &["LDE", "LSDE"], &["LE", "LSE"]),
];

#[test]
fn expressions_mean_what_the_table_says() {
    for &(expression, matching, others) in EXAMPLES {
        let filter = compiled(&format!("lpe \"{expression}\""));
        for (letters, expected) in
            matching.iter().map(|p| (p, true)).chain(others.iter().map(|p| (p, false)))
        {
            let found = filter.matches(&PathHeader::default(), &path(letters));
            assert_eq!(found, expected, "{expression} on {letters}");
        }
    }
}

#[test]
fn a_rough_boundary_reflects_or_refracts_as_its_points_say() {
    // The surface faces up; light comes from above.
    let mut path = path("LGE");
    path[1].normal = crate::encode_normal(glam::Vec3::Z);
    path[0].position = [0.0, 0.0, 5.0];
    path[1].position = [0.0, 0.0, 0.0];
    for (height, refracts) in [(3.0, false), (-3.0, true)] {
        path[2].position = [1.0, 0.0, height];
        let matches = |text| compiled(text).matches(&PathHeader::default(), &path);
        assert_eq!(matches("lpe \"C<TG>L\""), refracts, "the camera at height {height}");
        assert_eq!(matches("lpe \"C<RG>L\""), !refracts, "the camera at height {height}");
    }
}

#[test]
fn two_vertices_that_were_meant_to_be_one_are_pointed_out() {
    for (text, mistaken) in [
        ("lpe \"CRDL\"", true),
        ("lpe \"C(D|T S)*L\"", true),
        ("lpe \"C<RD>L\"", false),
        ("lpe \"C<TS'TDX'>.*L\"", false),
        ("lpe \"CDS+L\" and any on material \"TD\"", false),
        ("edges == 2", false),
    ] {
        let filter = Filter::parse(text).expect(text);
        let remark = filter.leaves().into_iter().find_map(Leaf::remark);
        assert_eq!(remark.is_some(), mistaken, "{text}");
    }
}

/// A random expression over letters, as a tree that both sides are made from.
#[derive(Clone, Debug)]
enum Tree {
    Letter(char),
    Not(char),
    Sequence(Vec<Self>),
    Either(Vec<Self>),
    Repeat(Box<Self>, usize, Option<usize>),
}

impl Tree {
    fn text(&self) -> String {
        let all = |parts: &[Self]| parts.iter().map(Self::text).collect::<Vec<_>>();
        match self {
            Self::Letter('T') => "<TS>".to_owned(),
            Self::Letter('S') => "<RS>".to_owned(),
            Self::Letter(letter) => letter.to_string(),
            Self::Not(letter) => format!("[^{}]", Self::Letter(*letter).text()),
            Self::Sequence(parts) => all(parts).concat(),
            Self::Either(parts) => format!("({})", all(parts).join("|")),
            Self::Repeat(part, least, None) => format!("({}){{{least},}}", part.text()),
            Self::Repeat(part, least, Some(most)) => format!("({}){{{least},{most}}}", part.text()),
        }
    }

    /// Every length of a beginning of `letters` that fits.
    fn ends(&self, letters: &[char]) -> Vec<usize> {
        let after = |starts: Vec<usize>, part: &Self| {
            let mut ends: Vec<usize> = starts
                .into_iter()
                .flat_map(|at| part.ends(&letters[at..]).into_iter().map(move |n| at + n))
                .collect();
            ends.sort_unstable();
            ends.dedup();
            ends
        };
        match self {
            Self::Letter(letter) => {
                letters.first().filter(|l| *l == letter).map(|_| 1).into_iter().collect()
            }
            Self::Not(letter) => {
                letters.first().filter(|l| *l != letter).map(|_| 1).into_iter().collect()
            }
            Self::Sequence(parts) => parts.iter().fold(vec![0], after),
            Self::Either(parts) => parts.iter().flat_map(|part| part.ends(letters)).collect(),
            Self::Repeat(part, least, most) => {
                let mut ends = vec![0];
                let mut all = if *least == 0 { vec![0] } else { Vec::new() };
                for count in 1..=most.unwrap_or(letters.len() + least) {
                    ends = after(ends, part);
                    if count >= *least {
                        all.extend(&ends);
                    }
                }
                all
            }
        }
    }
}

fn tree() -> impl Strategy<Value = Tree> {
    let letter = || prop::sample::select(vec!['D', 'S', 'T']);
    let leaf = prop_oneof![3 => letter().prop_map(Tree::Letter), 1 => letter().prop_map(Tree::Not)];
    leaf.prop_recursive(3, 10, 3, |inner| {
        prop_oneof![
            prop::collection::vec(inner.clone(), 1..4).prop_map(Tree::Sequence),
            prop::collection::vec(inner.clone(), 1..3).prop_map(Tree::Either),
            (inner, 0..3_usize, prop::option::of(0..3_usize)).prop_map(|(part, least, more)| {
                Tree::Repeat(Box::new(part), least, more.map(|more| least + more))
            }),
        ]
    })
}

proptest! {
    #[test]
    fn the_automaton_agrees_with_trying_everything(tree in tree(), inner in "[DST]{0,6}") {
        let whole = Tree::Sequence(vec![Tree::Letter('C'), tree, Tree::Letter('L')]);
        let seen: Vec<char> = format!("C{inner}L").chars().collect();
        let expected = whole.ends(&seen).contains(&seen.len());
        let from_light: String = format!("L{}E", inner.chars().rev().collect::<String>());
        let found = compiled(&format!("lpe \"{}\"", whole.text()))
            .matches(&PathHeader::default(), &path(&from_light));
        prop_assert_eq!(found, expected, "{} on {}", whole.text(), from_light);
    }

    /// Whatever is put into the quotes: an answer, never a panic, and a complaint that points into it.
    #[test]
    fn anything_for_an_expression_is_answered(
        text in "[CELOBRTVDGSs.*+?|()<>'^0-9,{} \\[\\]-]{0,40}|\\PC{0,20}",
    ) {
        let filter = format!("lpe \"{}\"", text.replace(['"', '\\'], ""));
        match Filter::parse(&filter).and_then(|filter| filter.compile(&scene())) {
            Ok(compiled) => {
                let header = PathHeader::default();
                let found = compiled.matches(&header, &path("LDSTE"));
                prop_assert_eq!(found, compiled.matches(&header, &path("LDSTE")));
            }
            Err(error) => {
                prop_assert!(error.span.start <= filter.len(), "{error:?} on {filter}");
                prop_assert!(!error.pointed(&filter).is_empty());
            }
        }
    }
}
