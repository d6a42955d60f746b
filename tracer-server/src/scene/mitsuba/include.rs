//! The text of a scene file with the files that it includes, and where each part of it stands.

use std::path::{Path, PathBuf};

use roxmltree::{Document, ParsingOptions};

use crate::scene::reading::diagnostic::{LoadError, Place};
use crate::scene::reading::encoding::read_xml;

/// The most bytes of a scene file that are read, and of all that it includes.
const MAX_BYTES: u64 = 64 << 20;
/// The most nodes of a document that are read.
const MAX_NODES: u32 = 4_000_000;
/// The deepest that files may include one another.
const MAX_DEPTH: usize = 16;
/// The most files of one scene.
const MAX_FILES: usize = 1000;

/// A scene file's text with every `<include>` replaced by what is in that file's `<scene>`.
#[derive(Debug)]
pub(super) struct Text {
    /// All of it.
    pub(super) whole: String,
    files: Vec<TextFile>,
    /// In the order in which they stand.
    pieces: Vec<Piece>,
    /// Where files are looked for, the first place first.
    pub(super) folders: Vec<PathBuf>,
}

#[derive(Debug)]
struct TextFile {
    path: PathBuf,
    text: String,
    /// Byte offsets at which its lines begin.
    lines: Vec<usize>,
}

/// A part of the text that is one part of a file.
#[derive(Debug)]
struct Piece {
    /// Where it begins in the whole.
    start: usize,
    /// Index of the file.
    file: usize,
    /// Where it begins in the file.
    offset: usize,
}

/// Parses a document. Its document type may define entities of its own, and nothing outside is read
/// for it.
pub(super) fn parse(text: &str) -> Result<Document<'_>, roxmltree::Error> {
    let options =
        ParsingOptions { nodes_limit: MAX_NODES, allow_dtd: true, ..ParsingOptions::default() };
    Document::parse_with_options(text, options)
}

impl Text {
    /// Reads a scene file and all that it includes.
    pub(super) fn read(path: &Path) -> Result<Self, LoadError> {
        let folder = path.parent().unwrap_or_else(|| Path::new("")).to_owned();
        let (files, pieces) = (Vec::new(), Vec::new());
        let mut text = Self { whole: String::new(), files, pieces, folders: vec![folder] };
        text.add(path, 0)?;
        Ok(text)
    }

    /// Adds a file; of one that another includes, what is in its outermost element.
    fn add(&mut self, path: &Path, depth: usize) -> Result<(), LoadError> {
        let text = read_xml(path, MAX_BYTES)?;
        let newlines = text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n');
        let lines = std::iter::once(0).chain(newlines.map(|(at, _)| at + 1)).collect();
        let file = self.files.len();
        if depth == 0 && !text.contains("<include") {
            self.copy(file, &text, 0..text.len());
            self.files.push(TextFile { path: path.to_owned(), text, lines });
            self.add_folders()?;
            return Ok(());
        }
        self.files.push(TextFile { path: path.to_owned(), text: text.clone(), lines });
        let document = parse(&text).map_err(|error| self.malformed(file, &error))?;
        let root = document.root_element();
        let body = match (depth, root.first_child(), root.last_child()) {
            (0, ..) => 0..text.len(),
            (_, Some(first), Some(last)) if root.has_tag_name("scene") => {
                first.range().start..last.range().end
            }
            (_, None, None) if root.has_tag_name("scene") => 0..0,
            _ => root.range(),
        };
        let mut done = body.start;
        for node in document.descendants().filter(roxmltree::Node::is_element) {
            let place = self.place_in(file, node.range().start);
            match (node.tag_name().name(), node.attribute("value"), node.attribute("filename")) {
                ("path", Some(folder), _) => self.add_folder(folder),
                ("include", _, Some(name)) if !name.contains('$') => {
                    self.copy(file, &text, done..node.range().start);
                    self.include(name, place, depth + 1)?;
                    done = node.range().end;
                }
                ("include", ..) => {
                    let message = "`<include>` needs a filename, without `$`";
                    return Err(place.error(message));
                }
                _ => {}
            }
        }
        self.copy(file, &text, done..body.end);
        if self.whole.len() as u64 > MAX_BYTES {
            let place = Place::file(path);
            return Err(place.error(format!("all files together have more than {MAX_BYTES} bytes")));
        }
        Ok(())
    }

    /// Adds the file that an `<include>` at `place` names.
    fn include(&mut self, name: &str, place: Place, depth: usize) -> Result<(), LoadError> {
        if depth > MAX_DEPTH || self.files.len() == MAX_FILES {
            return Err(place.error(format!(
                "`<include>`: files include one another more than {MAX_DEPTH} deep, or there are \
                 more than {MAX_FILES}"
            )));
        }
        let path = self.find(name);
        if !path.is_file() {
            let message = format!("`<include>`: there is no file `{}`", path.display());
            return Err(place.error(message));
        }
        self.add(&path, depth)
    }

    fn copy(&mut self, file: usize, text: &str, range: std::ops::Range<usize>) {
        let offset = range.start;
        self.pieces.push(Piece { start: self.whole.len(), file, offset });
        self.whole.push_str(text.get(range).unwrap_or_default());
    }

    /// Takes in the `<path>`s of a scene of one file.
    fn add_folders(&mut self) -> Result<(), LoadError> {
        if !self.whole.contains("<path") {
            return Ok(());
        }
        let whole = std::mem::take(&mut self.whole);
        let document = parse(&whole).map_err(|error| self.malformed(0, &error))?;
        for node in document.root_element().children().filter(|node| node.has_tag_name("path")) {
            node.attribute("value").into_iter().for_each(|folder| self.add_folder(folder));
        }
        self.whole = whole;
        Ok(())
    }

    /// Looks for files there first, from now on.
    fn add_folder(&mut self, name: &str) {
        let scene = self.folders.last().cloned().unwrap_or_default();
        self.folders.insert(0, scene.join(name.replace('\\', "/")));
    }

    /// The file that a scene calls `name`: where there is such a file, or else beside the scene.
    pub(super) fn find(&self, name: &str) -> PathBuf {
        let name = name.replace('\\', "/");
        let mut places = self.folders.iter().map(|folder| folder.join(&name));
        places.find(|path| path.is_file()).unwrap_or_else(|| {
            self.folders.last().map_or_else(PathBuf::new, |folder| folder.join(&name))
        })
    }

    /// Where a byte of the whole stands.
    pub(super) fn place(&self, offset: usize) -> Place {
        let next = self.pieces.partition_point(|piece| piece.start <= offset);
        match self.pieces.get(next.saturating_sub(1)) {
            Some(piece) => self.place_in(piece.file, piece.offset + (offset - piece.start)),
            None => Place::file(Path::new("")),
        }
    }

    fn place_in(&self, file: usize, offset: usize) -> Place {
        let Some(TextFile { path, text, lines }) = self.files.get(file) else {
            return Place::file(Path::new(""));
        };
        let line = lines.partition_point(|&begin| begin <= offset);
        let begin = lines.get(line.saturating_sub(1)).copied().unwrap_or(0);
        let before = text.get(begin..offset).unwrap_or_default();
        Place { column: Some(before.chars().count() + 1), ..Place::line(path, line) }
    }

    /// The error of a file that is no XML.
    fn malformed(&self, file: usize, error: &roxmltree::Error) -> LoadError {
        let position = error.pos();
        let path = self.files.get(file).map_or_else(|| Path::new(""), |file| &file.path);
        let place = Place {
            column: Some(position.col as usize),
            ..Place::line(path, position.row as usize)
        };
        place.error(format!("this is not well-formed XML: {error}"))
    }

    /// The document of the whole.
    pub(super) fn document(&self) -> Result<Document<'_>, LoadError> {
        parse(&self.whole).map_err(|error| self.malformed(0, &error))
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use crate::scene::description::{LightKind, SceneDescription};
    use crate::scene::load::load;

    /// A scene of a constant light and these parts, beside which files lie.
    fn read(parts: &str, files: &[(&str, &str)]) -> Result<SceneDescription, String> {
        let directory = tempfile::tempdir().expect("a directory");
        for (name, text) in files {
            let path = directory.path().join(name);
            fs::create_dir_all(path.parent().expect("a folder")).expect("made");
            fs::write(path, text).expect("written");
        }
        let path = directory.path().join("s.xml");
        let text = format!(
            "<scene version='3.0.0'>\n<emitter type='constant'/><sensor type='perspective'/>\n\
             {parts}\n</scene>"
        );
        fs::write(&path, text).expect("written");
        let loaded = load(path.to_str().expect("UTF-8")).map_err(|error| error.to_string())?;
        Ok(loaded.description)
    }

    const PART: &str = "<?xml version='1.0'?>\n<!-- a part -->\n<scene version='3.0.0'>\n\
                        <shape type='sphere'><float name='radius' value='2'/></shape>\n</scene>";

    #[test]
    fn what_is_included_stands_there() {
        let parts = "<shape type='sphere'/><include filename='part.xml'/><shape type='sphere'/>";
        let scene = read(parts, &[("part.xml", PART)]).expect("a scene");
        let radii: Vec<f64> = scene.spheres.iter().map(|sphere| sphere.radius).collect();
        assert_eq!(radii, [1.0, 2.0, 1.0], "in its order");
        let bad = PART.replace("'2'", "'-2'");
        let error = read(parts, &[("part.xml", &bad)]).expect_err("a negative radius");
        assert!(error.contains("part.xml:4:1: "), "{error}");
        let after = parts.replace("/><shape type='sphere'/>", "/>\n<shape type='blob'/>");
        let error = read(&after, &[("part.xml", PART)]).expect_err("no such shape");
        assert!(error.contains("s.xml:4:1: "), "behind it: {error}");
        let error = read("<include filename='s.xml'/>", &[]).expect_err("within itself");
        assert!(error.contains("include one another more than"), "{error}");
    }

    #[test]
    fn files_lie_where_paths_lead() {
        let parts =
            "<path value='parts'/><path value='more\\parts'/><include filename='part.xml'/>";
        let far = PART.replace("'2'", "'3'");
        let files = [("parts/part.xml", PART), ("more/parts/part.xml", &far)];
        let scene = read(parts, &files).expect("a scene");
        assert_eq!(scene.spheres[0].radius, 3.0, "the last one is looked into first");
    }

    #[test]
    fn defaults_use_those_before_them() {
        let entity = "<!DOCTYPE scene [<!ENTITY two \"2\">]>";
        let part = format!("{entity}<scene version='3.0.0'>{DEFAULTS}</scene>");
        const DEFAULTS: &str = "<default name='a' value='2'/><default name='b' value='$a.5'/>\
                                <shape type='sphere'><float name='radius' value='$b'/></shape>";
        let scene = read("<include filename='a.xml'/>", &[("a.xml", &part)]).expect("a scene");
        assert_eq!(scene.spheres[0].radius, 2.5);
        let unknown = DEFAULTS.replace("'a'", "'c'");
        let error = read(&unknown, &[]).expect_err("a is not there yet");
        assert!(error.contains("`$a` has no value"), "{error}");
    }

    #[test]
    fn direct_light_and_skies_are_as_their_renderer_has_them() {
        let sphere = "<shape type='sphere'/>";
        let direct = format!("<integrator type='direct'/>{sphere}");
        assert_eq!(read(&direct, &[]).expect("a scene").max_edges, 2);
        // Two grey texels.
        let sky = "Pf\n2 1\n-1\n\0\0\0?\0\0\0?";
        let turned = |step: &str| {
            let parts = format!(
                "{sphere}<emitter type='envmap'><string name='filename' value='sky.pfm'/>\
                 <transform name='to_world'>{step}</transform></emitter>"
            );
            let directory = [("sky.pfm", sky)];
            let text = parts.replace("<emitter type='constant'/>", "");
            read(&text, &directory)
        };
        let error = turned("<scale x='2'/>").expect_err("two skies, or a scale by axis");
        assert!(error.contains("keep all angles"), "{error}");
        let error = turned("<scale value='2'/>").expect_err("two skies");
        assert!(!error.contains("angles"), "scaled alike: {error}");
        let plain = read(sphere, &[]).expect("a scene");
        assert!(matches!(plain.lights[0].kind, LightKind::Environment { .. }));
    }
}
