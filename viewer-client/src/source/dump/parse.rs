//! The file, line by line. Depth is told by blanks: records at 0, vertices and edges at 2.

use common::MAX_VERTICES;
use glam::DVec3;

use super::annotation::{self, Annotation};
use super::record::{OpenVertex, Way};
use super::text::Line;
use super::{Dump, Fault, Numbers, Outcome, Record, Step};

/// Formal vertices, one at each end.
const FORMAL: usize = 2;
/// Faults that are reported one by one; the others are counted.
const MOST_TOLD: usize = 10;

/// What the lines so far have made.
#[derive(Debug, Default)]
pub(super) struct Parser {
    line: usize,
    dump: Dump,
    open: Option<OpenRecord>,
    chain: u32,
    /// A step whose record is still to come, and its line.
    due: Option<(Annotation, usize)>,
    /// The lines that come belong to a record that is left out.
    skips: bool,
    /// The last path is not among the records: what the chain does there is left out, too.
    is_lost: bool,
    /// Steps that were left out with their paths.
    lost_steps: usize,
    /// Lines that belong to nothing.
    foreign: usize,
    /// The first thing that is wrong.
    fault: Option<Fault>,
    /// Faults beyond those that are reported.
    more_faults: usize,
}

#[derive(Debug, Default)]
struct OpenRecord {
    line: usize,
    vertices: Vec<(OpenVertex, usize)>,
    /// The keys that come belong to the last vertex, and to no edge.
    in_vertex: bool,
}

impl Parser {
    /// Reads the next line.
    pub(super) fn line(&mut self, Line { text, is_whole }: &Line) {
        self.line += 1;
        // A line without an end may have been cut off anywhere; its record then has no end either.
        let is_cut = !is_whole && self.open.is_some();
        let begun = self.open.as_ref().map(|record| record.line);
        if let Err(problem) = self.read(text)
            && !is_cut
        {
            self.leave_out(begun, problem);
        }
    }

    /// Leaves out the line that is wrong, and the record that it is in.
    fn leave_out(&mut self, begun: Option<usize>, problem: String) {
        let what = match begun {
            Some(line) => format!("the record that begins at line {line} was skipped"),
            None => "the line was skipped".to_owned(),
        };
        // Its end has been read when it was found wanting as a whole.
        self.skips = self.open.take().is_some();
        self.is_lost |= begun.is_some();
        self.due = None;
        if self.dump.warnings.len() < MOST_TOLD {
            self.dump.warnings.push(format!("line {}: {problem}; {what}", self.line));
        } else {
            self.more_faults += 1;
        }
        self.fault.get_or_insert(Fault { line: self.line, problem });
    }

    fn read(&mut self, text: &str) -> Result<(), String> {
        if text == "Path[" {
            // One that was not closed was written by a program that was stopped.
            self.drop_open();
            self.skips = false;
            self.open = Some(OpenRecord { line: self.line, ..OpenRecord::default() });
            return Ok(());
        }
        let Some(record) = &mut self.open else {
            if let Some(note) = text.strip_prefix('#') {
                self.skips = false;
                return self.annotation(note);
            }
            if self.skips {
                self.skips = text != "]";
                return Ok(());
            }
            self.foreign += usize::from(!text.trim().is_empty());
            return Ok(());
        };
        let inner = text.trim_start_matches(' ');
        match text.len() - inner.len() {
            0 if inner == "]" => {
                let Some(record) = self.open.take() else { return Ok(()) };
                return self.close(record);
            }
            2 if inner.starts_with("Vertex ") => {
                let expected = format!("Vertex {} => PathVertex[", record.vertices.len());
                if inner != expected {
                    return Err(format!("expected `{expected}` here"));
                }
                if record.vertices.len() == MAX_VERTICES + FORMAL {
                    return Err(format!("no path may have more than {MAX_VERTICES} vertices"));
                }
                record.in_vertex = true;
                record.vertices.push((OpenVertex::default(), self.line));
            }
            2 => record.in_vertex = false,
            depth if record.in_vertex => {
                if let Some((vertex, _)) = record.vertices.last_mut() {
                    vertex.line(depth, inner, &mut self.dump.sensor)?;
                }
            }
            _ => {}
        }
        Ok(())
    }

    fn annotation(&mut self, text: &str) -> Result<(), String> {
        let Some(note) = annotation::parse(text.trim())? else { return Ok(()) };
        self.dump.annotated = true;
        if let Some(chain) = note.chain {
            self.chain = chain;
        }
        if note.outcome.has_path() {
            self.due = Some((note, self.line));
        } else if self.is_lost {
            self.lost_steps += 1;
        } else if let Some(last) = self.dump.records.len().checked_sub(1) {
            self.push_step(note, self.line, last);
        } else {
            return Err("a chain begins with a seed: a line `# seed ...` and its record".to_owned());
        }
        Ok(())
    }

    fn push_step(&mut self, note: Annotation, line: usize, record: usize) {
        let Annotation { number, outcome, mutation, pixel, configuration, .. } = note;
        let chain = self.chain;
        let step = Step { line, chain, number, outcome, mutation, pixel, configuration, record };
        self.dump.steps.push(step);
    }

    fn close(&mut self, open: OpenRecord) -> Result<(), String> {
        let line = open.line;
        let record =
            open.close().map_err(|problem| format!("the record at line {line}: {problem}"))?;
        let index = self.dump.records.len();
        let (note, line) = self.due.take().unwrap_or_else(|| {
            let note = Annotation {
                chain: None,
                number: self.dump.steps.last().map_or(0, |step| step.number.saturating_add(1)),
                outcome: Outcome::Recorded,
                mutation: String::new(),
                pixel: Some(record.pixel),
                configuration: String::new(),
            };
            (note, line)
        });
        self.dump.records.push(record);
        self.is_lost = false;
        self.push_step(note, line, index);
        Ok(())
    }

    fn drop_open(&mut self) {
        if let Some(record) = self.open.take() {
            let text = format!("the record at line {} is incomplete and was skipped", record.line);
            self.dump.warnings.push(text);
            (self.due, self.is_lost) = (None, true);
        }
    }

    /// What was read, when no line is left, and the first thing that was wrong.
    pub(super) fn finish(mut self) -> (Dump, Option<Fault>) {
        self.drop_open();
        if self.more_faults > 0 {
            let text = format!("{} more lines have errors and were skipped, too", self.more_faults);
            self.dump.warnings.push(text);
        }
        if self.lost_steps > 0 {
            let text = format!("{} steps from skipped paths were skipped, too", self.lost_steps);
            self.dump.warnings.push(text);
        }
        if self.foreign > 0 {
            let text = format!("{} lines outside of records were skipped", self.foreign);
            self.dump.warnings.push(text);
        }
        (self.dump, self.fault)
    }
}

impl OpenRecord {
    fn close(self) -> Result<Record, String> {
        let pixel = self.vertices.iter().rev().find_map(|(vertex, _)| vertex.pixel);
        // A vertex is made by the step that leaves the one before it, which may be a formal one.
        let step = |i: Option<usize>, way| self.vertices.get(i?)?.0.step(way);
        let numbers: Vec<Numbers> = (0..self.vertices.len())
            .map(|i| Numbers {
                from_light: step(i.checked_sub(1), Way::Onward),
                from_eye: step(i.checked_add(1), Way::Back),
            })
            .collect();
        let all = self.vertices.into_iter().zip(numbers);
        let real: Vec<_> = all.filter(|((vertex, _), _)| !vertex.is_formal()).collect();
        let places: Vec<Option<DVec3>> =
            real.iter().map(|((vertex, _), _)| vertex.position()).collect();
        let place = |i: usize| places.get(i).copied().flatten();
        let mut vertices = Vec::with_capacity(real.len());
        for (i, ((vertex, line), numbers)) in real.into_iter().enumerate() {
            let before = i.checked_sub(1).and_then(place);
            let vertex = vertex.close(before, place(i + 1), numbers);
            vertices
                .push(vertex.map_err(|problem| format!("the vertex at line {line}: {problem}"))?);
        }
        let kind = |vertex: Option<&super::DumpVertex>| vertex.map(|v| v.kind);
        let light = kind(vertices.first()) == Some(common::VertexKind::Light);
        let eye = kind(vertices.last()) == Some(common::VertexKind::Eye);
        if vertices.len() < 2 || !light || !eye {
            return Err("a path leads from an emitterSample to a sensorSample".to_owned());
        }
        let pixel = pixel.ok_or("the sensorSample has no film point `uv = [x, y]`")?;
        Ok(Record { line: self.line, vertices, pixel })
    }
}
