//! The paths that a file of Rust names.
//!
//! Files are read as tokens, so that grouped imports, paths in the middle of an expression and paths
//! inside macros count, while comments, strings and `#[cfg(test)]` items do not.

use std::str::FromStr as _;

use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};

use crate::workspace::Source;

/// A path that a file names, with `self` and `super` resolved, and the line where it does.
pub(crate) type Reference = (String, usize);

/// True when `path` is `prefix`, `prefix.rs` or a file in the folder `prefix`.
pub(crate) fn lies_under(path: &str, prefix: &str) -> bool {
    let rest = path.strip_prefix(prefix);
    rest.is_some_and(|rest| rest.is_empty() || rest == ".rs" || rest.starts_with('/'))
}

/// Where the modules lie that `files` declare as `#[cfg(test)] mod name;`, without `.rs`.
pub(crate) fn test_modules(files: &[Source]) -> Vec<String> {
    let mut found = Vec::new();
    for file in files {
        let folder = match file.path.rsplit_once('/') {
            Some((folder, "lib.rs" | "main.rs" | "mod.rs")) => folder,
            _ => file.path.trim_end_matches(".rs"),
        };
        for window in tokens(file).windows(5) {
            if let [
                TokenTree::Punct(_),
                TokenTree::Group(attribute),
                TokenTree::Ident(keyword),
                TokenTree::Ident(name),
                TokenTree::Punct(_),
            ] = window
                && is_cfg_test(attribute)
                && keyword == "mod"
            {
                found.push(format!("{folder}/{name}"));
            }
        }
    }
    found
}

fn tokens(file: &Source) -> Vec<TokenTree> {
    let stream = TokenStream::from_str(&file.text);
    let stream = stream.unwrap_or_else(|error| panic!("{} is not Rust: {error}", file.path));
    stream.into_iter().collect()
}

/// Every path of at least two segments that the file names outside its tests.
pub(crate) fn references(file: &Source) -> Vec<Reference> {
    let (_, local) = file.path.split_once("src/").unwrap_or(("", &file.path));
    let mut module: Vec<String> =
        local.trim_end_matches(".rs").split('/').map(str::to_owned).collect();
    if module.last().is_some_and(|last| ["lib", "main", "mod"].contains(&last.as_str())) {
        module.pop();
    }
    let mut found = Vec::new();
    walk(&tokens(file), &mut module, &mut found);
    found
}

/// The functions outside tests that take a tuple apart among their parameters, and the line of each.
pub(crate) fn tuple_parameters(file: &Source) -> Vec<(String, usize)> {
    let mut found = Vec::new();
    look_for_tuples(&tokens(file), &mut found);
    found
}

fn look_for_tuples(trees: &[TokenTree], found: &mut Vec<(String, usize)>) {
    let mut i = 0;
    while i < trees.len() {
        match (&trees[i], trees.get(i + 1)) {
            (TokenTree::Punct(_), Some(TokenTree::Group(attribute))) if is_cfg_test(attribute) => {
                i = after_item(trees, i + 2);
                continue;
            }
            (TokenTree::Ident(keyword), Some(TokenTree::Ident(name))) if keyword == "fn" => {
                let list = parameter_list(&trees[i + 2..]);
                if list.is_some_and(takes_a_tuple_apart) {
                    found.push((name.to_string(), keyword.span().start().line));
                }
            }
            (TokenTree::Group(group), _) => look_for_tuples(&inside(group), found),
            _ => {}
        }
        i += 1;
    }
}

/// The list of parameters, behind the generic ones between angles.
fn parameter_list(trees: &[TokenTree]) -> Option<&Group> {
    let (mut depth, mut is_arrow) = (0, false);
    for tree in trees {
        match tree {
            TokenTree::Punct(punct) => {
                match punct.as_char() {
                    '<' => depth += 1,
                    '>' if !is_arrow => depth -= 1,
                    _ => {}
                }
                is_arrow = punct.as_char() == '-';
            }
            TokenTree::Group(group) if depth == 0 => return Some(group),
            _ => {}
        }
    }
    None
}

/// True of a list with a parameter such as `(a, b): (A, B)`.
fn takes_a_tuple_apart(list: &Group) -> bool {
    inside(list).windows(2).any(|two| {
        matches!(two, [TokenTree::Group(group), TokenTree::Punct(colon)]
            if colon.as_char() == ':'
                && group.delimiter() == Delimiter::Parenthesis
                && !group.stream().is_empty())
    })
}

fn walk(trees: &[TokenTree], module: &mut Vec<String>, found: &mut Vec<Reference>) {
    let mut i = 0;
    while i < trees.len() {
        i = match (&trees[i], trees.get(i + 1), trees.get(i + 2)) {
            (TokenTree::Punct(hash), Some(TokenTree::Group(attribute)), _)
                if hash.as_char() == '#' && is_cfg_test(attribute) =>
            {
                after_item(trees, i + 2)
            }
            (
                TokenTree::Ident(keyword),
                Some(TokenTree::Ident(name)),
                Some(TokenTree::Group(body)),
            ) if keyword == "mod" => {
                module.push(name.to_string());
                walk(&inside(body), module, found);
                module.pop();
                i + 3
            }
            (TokenTree::Ident(_), ..) => read_path(trees, i, Vec::new(), module, found),
            (TokenTree::Group(group), ..) => {
                walk(&inside(group), module, found);
                i + 1
            }
            _ => i + 1,
        };
    }
}

/// Reads the path that starts at `trees[i]` after `prefix`, expands braces of a `use`, and returns
/// the index behind it.
fn read_path(
    trees: &[TokenTree],
    mut i: usize,
    prefix: Vec<String>,
    module: &[String],
    found: &mut Vec<Reference>,
) -> usize {
    let mut segments = prefix;
    let line = trees[i].span().start().line;
    while let Some(TokenTree::Ident(segment)) = trees.get(i) {
        segments.push(segment.to_string());
        i += 1;
        if !is_path_separator(trees, i) {
            break;
        }
        i += 2;
    }
    if let Some(TokenTree::Group(group)) = trees.get(i)
        && group.delimiter() == Delimiter::Brace
        && is_path_separator(trees, i.wrapping_sub(2))
    {
        for branch in branches(group) {
            read_path(&branch, 0, segments.clone(), module, found);
        }
        return i + 1;
    }
    if segments.len() > 1 {
        found.push((resolve(&segments, module), line));
    }
    i
}

/// The parts of a brace group between its commas, without empty ones.
fn branches(group: &Group) -> Vec<Vec<TokenTree>> {
    let trees = inside(group);
    let is_comma = |tree: &TokenTree| matches!(tree, TokenTree::Punct(p) if p.as_char() == ',');
    let parts = trees.split(is_comma).map(<[TokenTree]>::to_vec);
    parts.filter(|part| !part.is_empty()).collect()
}

fn inside(group: &Group) -> Vec<TokenTree> {
    group.stream().into_iter().collect()
}

fn is_path_separator(trees: &[TokenTree], i: usize) -> bool {
    let is_colon = |tree: Option<&TokenTree>| matches!(tree, Some(TokenTree::Punct(punct)) if punct.as_char() == ':');
    is_colon(trees.get(i)) && is_colon(trees.get(i.wrapping_add(1)))
}

fn is_cfg_test(attribute: &Group) -> bool {
    let text: String = attribute.stream().to_string().split_whitespace().collect();
    text == "cfg(test)" || text.starts_with("cfg(all(test")
}

/// The index behind the item that starts at `i`: behind its first braces or semicolon.
fn after_item(trees: &[TokenTree], i: usize) -> usize {
    let ends = |tree: &TokenTree| match tree {
        TokenTree::Group(group) => group.delimiter() == Delimiter::Brace,
        TokenTree::Punct(punct) => punct.as_char() == ';',
        _ => false,
    };
    let length = trees[i.min(trees.len())..].iter().position(ends);
    length.map_or(trees.len(), |length| i + length + 1)
}

/// Turns `self::` and `super::` into `crate::`, seen from `module`.
fn resolve(segments: &[String], module: &[String]) -> String {
    let ups = segments.iter().take_while(|segment| *segment == "super").count();
    let here = usize::from(segments[0] == "self");
    if ups + here == 0 {
        return segments.join("::");
    }
    let kept = module.len().saturating_sub(ups);
    let absolute = module[..kept].iter().chain(&segments[ups + here..]);
    std::iter::once("crate").chain(absolute.map(String::as_str)).collect::<Vec<_>>().join("::")
}
