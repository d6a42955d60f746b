//! Reads the text of an OBJ file once before the parser does, so that every complaint names its line.
//!
//! The parser keeps no line numbers. What remains is a plain OBJ text of positions, texture
//! coordinates, normals, faces, names and material changes.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use glam::DVec3;

use crate::scene::description::check::{MAX_TRIANGLES, check_point};
use crate::scene::reading::diagnostic::{LoadError, Place, Warning};
use crate::scene::reading::text::{Statement, number, statements};

/// A checked OBJ text.
#[derive(Debug, Default)]
pub(crate) struct ObjText {
    /// Statements `v`, `vt`, `vn`, `f`, `o` and `usemtl` only, all of them valid. The first `vt` and
    /// `vn` are zeros for corners that name none.
    pub(crate) text: String,
    /// Material libraries, each with the line that names it.
    pub(crate) libraries: Vec<(String, usize)>,
    /// The line where each material is first used.
    pub(crate) used: BTreeMap<String, usize>,
    /// What in the file is not supported.
    pub(crate) warnings: Vec<Warning>,
}

/// Checks and cleans an OBJ text.
pub(crate) fn scan(text: &str, file: &Path) -> Result<ObjText, LoadError> {
    let mut scan = Scan { file, out: ObjText::default(), ..Scan::default() };
    scan.out.text.reserve(text.len());
    for statement in statements(text) {
        scan.statement(&statement)
            .map_err(|message| Place::line(file, statement.line).error(message))?;
    }
    if scan.texcoords > 0 {
        scan.out.text.insert_str(0, "vt 0 0\n");
    }
    if scan.normals > 0 {
        scan.out.text.insert_str(0, "vn 0 0 0\n");
    }
    scan.tell_ignored();
    Ok(scan.out)
}

#[derive(Debug)]
struct Scan<'a> {
    file: &'a Path,
    out: ObjText,
    positions: usize,
    triangles: usize,
    texcoords: usize,
    normals: usize,
    /// Statements that are not modelled: first line and count.
    ignored: BTreeMap<String, (usize, usize)>,
}

impl Default for Scan<'_> {
    fn default() -> Self {
        Self {
            file: Path::new(""),
            out: ObjText::default(),
            positions: 0,
            triangles: 0,
            texcoords: 0,
            normals: 0,
            ignored: BTreeMap::new(),
        }
    }
}

impl Scan<'_> {
    fn statement(&mut self, statement: &Statement<'_>) -> Result<(), String> {
        let Statement { line, keyword, rest } = statement;
        match keyword.as_ref() {
            "v" => self.position(rest),
            "f" => self.face(rest),
            "o" | "g" => {
                self.emit("o", rest);
                Ok(())
            }
            "usemtl" if rest.is_empty() => Err("usemtl without the name of a material".to_owned()),
            "usemtl" => {
                self.out.used.entry(rest.to_string()).or_insert(*line);
                self.emit("usemtl", rest);
                Ok(())
            }
            "mtllib" if rest.is_empty() => Err("mtllib without the name of a file".to_owned()),
            "mtllib" => {
                self.out.libraries.push((rest.to_string(), *line));
                Ok(())
            }
            "vn" => {
                self.normals += 1;
                self.numbers("vn", rest, 3)
            }
            "vt" => {
                self.texcoords += 1;
                // A third coordinate belongs to textures of volumes.
                self.numbers("vt", rest, 2)
            }
            // Smooth shading is asked for by normals.
            "s" => Ok(()),
            _ => {
                // A file that is no OBJ at all may hold any number of "keywords".
                if self.ignored.len() < 8 || self.ignored.contains_key(keyword.as_ref()) {
                    let entry = self.ignored.entry(keyword.to_string()).or_insert((*line, 0));
                    entry.1 += 1;
                }
                Ok(())
            }
        }
    }

    fn emit(&mut self, keyword: &str, rest: &str) {
        for part in [keyword, " ", rest, "\n"] {
            self.out.text.push_str(part);
        }
    }

    /// `vn x y z` or `vt u v`: so many numbers, or a single texture coordinate.
    fn numbers(&mut self, keyword: &str, rest: &str, wanted: usize) -> Result<(), String> {
        let mut count = 0;
        for word in rest.split_whitespace() {
            number(word)?;
            count += 1;
        }
        if count == 1 && keyword == "vt" {
            self.emit(keyword, &format!("{} 0", rest.trim()));
            return Ok(());
        }
        if count < wanted {
            return Err(format!("{keyword} needs {wanted} numbers; found {count}"));
        }
        let end = words_end(rest, wanted);
        self.emit(keyword, rest.get(..end).unwrap_or(rest));
        Ok(())
    }

    /// `v x y z`, optionally followed by a weight, or by a colour that is not modelled.
    fn position(&mut self, rest: &str) -> Result<(), String> {
        let mut values = [0.0; 7];
        let mut count = 0;
        for word in rest.split_whitespace() {
            let slot = values.get_mut(count).ok_or("a vertex has at most six numbers")?;
            *slot = number(word)?;
            count += 1;
        }
        let [x, y, z, w, ..] = values;
        let mut point = DVec3::new(x, y, z);
        match count {
            3 | 6 => {}
            4 if w == 0.0 => return Err("a vertex whose weight w is 0 lies at infinity".to_owned()),
            4 => point /= w,
            _ => {
                return Err(format!(
                    "a vertex needs x, y and z, then nothing, a weight or a colour; found {count} \
                    numbers"
                ));
            }
        }
        check_point(point).map_err(|message| format!("vertex {message}"))?;
        self.positions += 1;
        if count == 4 {
            // Rust prints the shortest digits that read back as the same bits.
            writeln!(self.out.text, "v {} {} {}", point.x, point.y, point.z)
                .map_err(|error| error.to_string())?;
        } else {
            let end = words_end(rest, 3);
            self.emit("v", rest.get(..end).unwrap_or(rest));
        }
        Ok(())
    }

    /// `f v1 v2 v3 ...`, each `v`, `v/t`, `v//n` or `v/t/n`; negative ones count from the end.
    fn face(&mut self, rest: &str) -> Result<(), String> {
        self.out.text.push('f');
        let mut corners = 0;
        for word in rest.split_whitespace() {
            let [v, t, n] = self.corner(word)?;
            match (self.texcoords > 0, self.normals > 0) {
                (false, false) => write!(self.out.text, " {v}"),
                (true, false) => write!(self.out.text, " {v}/{t}"),
                (false, true) => write!(self.out.text, " {v}//{n}"),
                (true, true) => write!(self.out.text, " {v}/{t}/{n}"),
            }
            .map_err(|error| error.to_string())?;
            corners += 1;
        }
        self.out.text.push('\n');
        if corners < 3 {
            return Err(format!("a face needs at least three corners; found {corners}"));
        }
        self.triangles += corners - 2;
        if self.triangles > MAX_TRIANGLES {
            return Err(format!("more than {MAX_TRIANGLES} triangles; use a coarser mesh"));
        }
        Ok(())
    }

    /// What a face corner refers to, counted from 1: position, texture coordinates and normal. Of
    /// the last two the first is the one that stands for none.
    fn corner(&self, word: &str) -> Result<[usize; 3], String> {
        let malformed = || format!("face corner `{word}` is not of the form v, v/t, v//n or v/t/n");
        let mut parts = word.split('/');
        let mut next = || match parts.next() {
            None | Some("") => Ok(None),
            Some(part) => part.parse::<i64>().map(Some).map_err(|_error| malformed()),
        };
        let (position, texcoord, normal) = (next()?, next()?, next()?);
        if parts.next().is_some() {
            return Err(malformed());
        }
        let v = resolve("vertex", position.ok_or_else(malformed)?, self.positions)?;
        let t = texcoord.map_or(Ok(0), |t| resolve("texture coordinate", t, self.texcoords))?;
        let n = normal.map_or(Ok(0), |n| resolve("normal", n, self.normals))?;
        Ok([v, t + 1, n + 1])
    }

    fn tell_ignored(&mut self) {
        for (keyword, (line, count)) in &self.ignored {
            let what = match keyword.as_str() {
                "l" | "p" => "lines and points have no area",
                _ => "this statement is not supported",
            };
            self.out.warnings.push(
                Place::line(self.file, *line)
                    .warning(format!("`{}` was ignored ({count} times): {what}", shorten(keyword))),
            );
        }
    }
}

/// An index counted from 1, given one that may count from the end.
fn resolve(what: &str, index: i64, count: usize) -> Result<usize, String> {
    let given = i64::try_from(count).unwrap_or(i64::MAX);
    let resolved = match index {
        0 => return Err("face index 0: indices start at 1, or at -1 from the end".to_owned()),
        i if i < 0 => given.saturating_add(i).saturating_add(1),
        i => i,
    };
    if (1..=given).contains(&resolved) {
        return Ok(resolved as usize);
    }
    Err(format!(
        "face index {index} refers to a {what} that does not exist: {count} are given above this \
         line"
    ))
}

/// The first characters of a word that may be anything.
fn shorten(word: &str) -> String {
    word.chars().filter(|c| !c.is_control()).take(24).collect()
}

/// The byte offset at which the first `count` words end.
fn words_end(text: &str, count: usize) -> usize {
    let mut end = 0;
    for word in text.split_whitespace().take(count) {
        let start = text.get(end..).and_then(|tail| tail.find(word)).unwrap_or(0);
        end += start + word.len();
    }
    end
}

#[cfg(test)]
mod tests {
    use super::*;

    fn complaint(text: &str) -> String {
        scan(text, Path::new("x.obj")).expect_err("must be refused").to_string()
    }

    #[test]
    fn faces_are_resolved_and_comments_dropped() {
        let text = "v 0 0 0\nv 1 0 0 # b\nv 0 1 0 .5 .5 .5\nf -3 -2 -1\nv 2 4 6 2\n";
        let scanned = scan(text, Path::new("x.obj")).expect("valid");
        assert_eq!(scanned.text, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nv 1 2 3\n");
        let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1 2//-1 3\nvt .5\nf 1/1 2//1 3\n";
        let scanned = scan(text, Path::new("x.obj")).expect("valid");
        let faces: Vec<&str> = scanned.text.lines().filter(|l| l.starts_with('f')).collect();
        assert_eq!(faces, ["f 1//1 2//2 3//1", "f 1/2/1 2/1/2 3/1/1"], "1 stands for none");
        assert!(scanned.text.starts_with("vn 0 0 0\nvt 0 0\nv "), "{}", scanned.text);
    }

    #[test]
    fn each_mistake_names_its_line() {
        let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
        let cases = [
            ("f 1 2 4", "face index 4"),
            ("f 1 2 -4", "face index -4"),
            ("f 0 1 2", "indices start at 1"),
            ("f 1 2", "three corners"),
            ("f 1 2 x", "`x`"),
            ("f 1//1 2 3", "a normal that does not exist"),
            ("f 1/1 2 3", "a texture coordinate that does not exist"),
            ("vn 0 1", "vn needs 3 numbers"),
            ("vn 0 1 nan", "not a finite number"),
            ("vt", "vt needs 2 numbers"),
            ("f 1/a 2 3", "`1/a`"),
            ("f 1/1/1/1 2 3", "`1/1/1/1`"),
            ("f 1 2 99999999999999999999", "99999999999999999999"),
            ("f 1 2 -9223372036854775808", "does not exist"),
            ("v 1 2", "2 numbers"),
            ("v 1 2 nan", "not a finite number"),
            ("v 1 2 inf", "not a finite number"),
            ("v 1 2 1e300", "too far away"),
            ("v 1 2 3 0", "weight"),
            ("v 1 2 3 1e-300", "too far away"),
            ("v 1 2 3 4 5", "5 numbers"),
            ("v 1 2 3 4 5 6 7 8", "at most six"),
            ("v 1 2 three", "`three` is not a number"),
            ("usemtl", "usemtl without"),
            ("mtllib  ", "mtllib without"),
        ];
        for (line, expected) in cases {
            let message = complaint(&format!("{triangle}{line}\n"));
            assert!(message.starts_with("x.obj:4: "), "{line}: {message}");
            assert!(message.contains(expected), "{line}: {message}");
        }
    }

    #[test]
    fn what_is_not_modelled_is_told_once() {
        let text = "vn 0 0 1\nvt 0 0\nl 1 2\nl 1 2\ncurv 0 1\n";
        let scan = scan(text, Path::new("x.obj")).expect("valid");
        let told: Vec<String> = scan.warnings.iter().map(ToString::to_string).collect();
        assert_eq!(told.len(), 2, "{told:?}");
        assert!(told[0].starts_with("x.obj:5"), "{told:?}");
        assert!(told[1].starts_with("x.obj:3") && told[1].contains("2 times"), "{told:?}");
    }
}
