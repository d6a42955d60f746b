//! No two modules lean on each other, but for parent and child: what lies below can be read, tested
//! and changed without what lies above.
//!
//! Modules with the same parent are looked at together, each with all that lies in it. A name that a
//! parent hands on belongs to the child that it comes from.

use std::collections::{BTreeMap, BTreeSet};

use crate::names::{references, test_modules};
use crate::workspace::{Source, sources};

/// Below these folders there is no circle.
const FREE: &[&str] = &["tracer-server/src", "viewer-client/src"];

/// A module's path from its crate's root.
type Module = Vec<String>;

/// The modules of one crate, and which of them name which.
#[derive(Debug, Default)]
struct Crate {
    modules: BTreeSet<Module>,
    /// What a module calls by a name of its own, with the path that the name stands for.
    handed_on: BTreeMap<(Module, String), Vec<String>>,
    arrows: BTreeSet<(Module, Module)>,
}

impl Crate {
    /// Reads the files below `src`, but those of tests.
    fn read(src: &str, files: &[Source]) -> Self {
        let tests = test_modules(files);
        let is_test = |file: &Source| {
            let path = file.path.trim_end_matches(".rs");
            tests.iter().any(|test| path == test || path.starts_with(&format!("{test}/")))
        };
        let files: Vec<_> =
            files.iter().filter(|file| file.path.starts_with(src) && !is_test(file)).collect();
        let mut read = Self::default();
        read.modules.extend(files.iter().map(|file| module_of(src, file)));
        let mut named = Vec::new();
        for file in files {
            let module = module_of(src, file);
            for (path, _) in references(file) {
                let path: Vec<String> = path.split("::").map(str::to_owned).collect();
                let Some(path) = read.absolute(&module, &path) else { continue };
                if let Some(name) = path.last() {
                    read.handed_on.insert((module.clone(), name.clone()), path.clone());
                }
                named.push((module.clone(), path));
            }
        }
        for (module, path) in named {
            let target = read.home(path);
            if target != module && !target.is_empty() {
                read.arrows.insert((module, target));
            }
        }
        read
    }

    /// The path from the crate's root; `None` for other crates and for plain names.
    fn absolute(&self, module: &Module, path: &[String]) -> Option<Vec<String>> {
        if path[0] == "crate" {
            return Some(path[1..].to_vec());
        }
        let child = [module.as_slice(), &path[..1]].concat();
        self.modules.contains(&child).then(|| [module.as_slice(), path].concat())
    }

    /// The module that what a path names is written in.
    fn home(&self, mut path: Vec<String>) -> Module {
        // A name may be handed on from child to parent to grandparent.
        for _ in 0..8 {
            let depth = (0..=path.len()).rev().find(|&n| self.modules.contains(&path[..n]));
            let depth = depth.unwrap_or(0);
            let Some(name) = path.get(depth) else { break };
            let key = (path[..depth].to_vec(), name.clone());
            match self.handed_on.get(&key) {
                Some(origin) if !path.starts_with(origin) => {
                    path = [origin.as_slice(), &path[depth + 1..]].concat();
                }
                _ => {
                    path.truncate(depth);
                    break;
                }
            }
        }
        path
    }

    /// The circles among modules with the same parent, below `room`.
    fn circles(&self, room: &[String]) -> Vec<String> {
        let ancestors = |module: &Module| -> Vec<Module> {
            (0..module.len()).map(|n| module[..n].to_vec()).collect()
        };
        let parents: BTreeSet<Module> = self.modules.iter().flat_map(ancestors).collect();
        let parents = parents.into_iter().filter(|parent| parent.starts_with(room));
        parents.flat_map(|parent| self.circles_among(&parent)).collect()
    }

    fn circles_among(&self, parent: &[String]) -> Vec<String> {
        let child = |module: &Module| {
            module.starts_with(parent).then(|| module.get(parent.len()).cloned()).flatten()
        };
        let mut next: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
        for (from, to) in &self.arrows {
            if let (Some(from), Some(to)) = (child(from), child(to)) {
                next.entry(from).or_default().insert(to);
            }
        }
        let mut found = BTreeSet::new();
        for start in next.keys() {
            let ahead = reachable(&next, start);
            let behind = |other: &&String| reachable(&next, other).contains(start);
            let circle: Vec<String> = ahead.iter().filter(behind).cloned().collect();
            if circle.len() > 1 {
                let parent = parent.join("::");
                let circle = circle.join(", ");
                found.insert(format!("in `{parent}` these lean on each other: {circle}"));
            }
        }
        found.into_iter().collect()
    }
}

/// All that a walk along the arrows comes to.
fn reachable(next: &BTreeMap<String, BTreeSet<String>>, start: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    let mut open = vec![start.to_owned()];
    while let Some(here) = open.pop() {
        for there in next.get(&here).into_iter().flatten() {
            if found.insert(there.clone()) {
                open.push(there.clone());
            }
        }
    }
    found
}

fn module_of(src: &str, file: &Source) -> Module {
    let local = file.path.trim_start_matches(src).trim_end_matches(".rs");
    let mut module: Module = local.split('/').map(str::to_owned).collect();
    if module.last().is_some_and(|last| ["lib", "main", "mod"].contains(&last.as_str())) {
        module.pop();
    }
    module
}

/// The circles below a folder.
fn circles_below(folder: &str, files: &[Source]) -> Vec<String> {
    let (package, room) = folder.split_once("/src").expect("a folder of a crate's source");
    let room: Module = room.split('/').filter(|part| !part.is_empty()).map(str::to_owned).collect();
    Crate::read(&format!("{package}/src/"), files).circles(&room)
}

#[test]
fn no_circle_but_of_parent_and_child() {
    let files = sources(&["rs"]);
    for folder in FREE {
        let lies_there = |file: &&Source| file.path.starts_with(&format!("{folder}/"));
        assert!(files.iter().filter(lies_there).count() > 1, "{folder} holds no modules");
        let found = circles_below(folder, &files);
        assert!(found.is_empty(), "{folder}:\n{}", found.join("\n"));
    }
}

#[test]
fn a_planted_circle_is_found_however_it_is_closed() {
    let file = |path: &str, text: &str| Source::made_up(&format!("common/src/{path}"), text);
    let planted = |files: &[Source]| circles_below("common/src", files);
    let a_to_b = file("a.rs", "use crate::b::B;");
    assert_eq!(planted(&[a_to_b.clone(), file("b.rs", "")]), [""; 0], "one arrow is no circle");
    let found = planted(&[a_to_b.clone(), file("b.rs", "fn f() { crate::a::g() }")]);
    assert_eq!(found, ["in `` these lean on each other: a, b"], "named in an expression");
    let parent = file("lib.rs", "mod a; mod b; pub use a::A;");
    let by_parent = [parent.clone(), a_to_b.clone(), file("b.rs", "use super::A;")];
    assert_eq!(planted(&by_parent).len(), 1, "by what the parent hands on");
    let by_rooms = [
        file("a/one.rs", "use crate::b::two::T;"),
        file("a/two.rs", ""),
        file("b/one.rs", "use crate::a::two::T;"),
        file("b/two.rs", ""),
    ];
    assert_eq!(planted(&by_rooms).len(), 1, "by different modules of two rooms");
    let test = file("lib.rs", "mod a; mod b; #[cfg(test)] mod laws;");
    let of_tests = [
        test,
        a_to_b,
        file("b.rs", "#[cfg(test)]\nuse crate::a::A;"),
        file("laws.rs", "use crate::a::A;"),
    ];
    assert_eq!(planted(&of_tests), [""; 0], "tests may name what they like");
    let family = [parent, file("a.rs", "use super::Shared;"), file("b.rs", "")];
    assert_eq!(planted(&family), [""; 0], "parent and child may name each other");
}
