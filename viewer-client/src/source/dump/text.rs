//! The lines of a text file, whatever program wrote it: UTF-8 with or without a mark, UTF-16 of either
//! order, and lines that end in LF, CR LF or CR.

use std::io::{self, BufRead, BufReader, Read};

/// No line is longer, in bytes; what is longer goes on as another line.
const LONGEST_LINE: usize = 1 << 20;
/// Units of UTF-16 that are decoded at a time.
const UNITS: usize = 1 << 15;

/// How a file begins that says so itself: its first bytes, and what it is.
const MARKS: [(&[u8], Encoding); 5] = [
    (b"\xef\xbb\xbf", Encoding::Utf8),
    (b"\xff\xfe", Encoding::Utf16(u16::from_le_bytes)),
    (b"\xfe\xff", Encoding::Utf16(u16::from_be_bytes)),
    // Without a mark, the zeros among plain letters tell.
    (b"P\0a\0", Encoding::Utf16(u16::from_le_bytes)),
    (b"\0P\0a", Encoding::Utf16(u16::from_be_bytes)),
];

#[derive(Clone, Copy, Debug)]
enum Encoding {
    Utf8,
    /// With the order of a unit's bytes.
    Utf16(fn([u8; 2]) -> u16),
}

/// One line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Line {
    /// Without its end.
    pub(super) text: String,
    /// It has an end, so that nothing of it is missing.
    pub(super) is_whole: bool,
}

/// The lines of a file.
pub(super) struct Lines {
    source: Box<dyn BufRead>,
    /// The last line ended in CR, of which LF may be the second half.
    after_return: bool,
}

impl Lines {
    /// Those of `source`, whose encoding its first bytes tell.
    pub(super) fn new(source: impl Read + 'static) -> io::Result<Self> {
        let mut source = BufReader::new(source);
        let start = source.fill_buf()?;
        let found = MARKS.iter().find(|(mark, _)| start.starts_with(mark));
        let is_mark = |mark: &[u8]| !mark.contains(&b'P');
        let encoding = found.map_or(Encoding::Utf8, |(mark, encoding)| {
            source.consume(if is_mark(mark) { mark.len() } else { 0 });
            *encoding
        });
        let source: Box<dyn BufRead> = match encoding {
            Encoding::Utf8 => Box::new(source),
            Encoding::Utf16(order) => {
                Box::new(BufReader::new(Utf16 { source, order, ready: Vec::new(), high: None }))
            }
        };
        Ok(Self { source, after_return: false })
    }

    /// The next line; `None` at the end. What is no text is replaced by the sign for that.
    pub(super) fn next(&mut self) -> io::Result<Option<Line>> {
        let mut bytes = Vec::new();
        loop {
            let buffer = self.source.fill_buf()?;
            if buffer.is_empty() {
                let text = String::from_utf8_lossy(&bytes).into_owned();
                return Ok((!bytes.is_empty()).then_some(Line { text, is_whole: false }));
            }
            if std::mem::take(&mut self.after_return) && buffer[0] == b'\n' {
                self.source.consume(1);
                continue;
            }
            let end = buffer.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
            let room = LONGEST_LINE - bytes.len();
            let taken = end.unwrap_or(buffer.len()).min(room);
            bytes.extend_from_slice(&buffer[..taken]);
            let ended = buffer.get(taken).copied().filter(|_| end == Some(taken));
            self.after_return = ended == Some(b'\r');
            self.source.consume(taken + usize::from(ended.is_some()));
            if ended.is_some() || bytes.len() == LONGEST_LINE {
                let text = String::from_utf8_lossy(&bytes).into_owned();
                return Ok(Some(Line { text, is_whole: true }));
            }
        }
    }
}

/// Turns UTF-16 into UTF-8.
struct Utf16<R> {
    source: R,
    order: fn([u8; 2]) -> u16,
    /// Decoded and not read yet, the last byte first.
    ready: Vec<u8>,
    /// The first half of a character whose second half is still to come.
    high: Option<u16>,
}

impl<R: Read> Utf16<R> {
    fn decode_more(&mut self) -> io::Result<()> {
        let mut bytes = Vec::with_capacity(2 * UNITS);
        self.source.by_ref().take(2 * UNITS as u64).read_to_end(&mut bytes)?;
        let is_last = bytes.len() < 2 * UNITS;
        let pairs = bytes.chunks_exact(2).map(|pair| (self.order)([pair[0], pair[1]]));
        let mut units: Vec<u16> = self.high.take().into_iter().chain(pairs).collect();
        if !is_last {
            self.high = units.pop_if(|unit| (0xd800..0xdc00).contains(unit));
        }
        self.ready = String::from_utf16_lossy(&units).into_bytes();
        self.ready.reverse();
        Ok(())
    }
}

impl<R: Read> Read for Utf16<R> {
    fn read(&mut self, target: &mut [u8]) -> io::Result<usize> {
        if self.ready.is_empty() {
            self.decode_more()?;
        }
        let count = target.len().min(self.ready.len());
        let taken = self.ready.drain(self.ready.len() - count..).rev();
        target.iter_mut().zip(taken).for_each(|(target, byte)| *target = byte);
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(bytes: Vec<u8>) -> Vec<(String, bool)> {
        let mut lines = Lines::new(io::Cursor::new(bytes)).expect("memory");
        let next = || lines.next().expect("memory");
        std::iter::from_fn(next).map(|line| (line.text, line.is_whole)).collect()
    }

    fn utf16(text: &str, order: fn(u16) -> [u8; 2]) -> Vec<u8> {
        text.encode_utf16().flat_map(order).collect()
    }

    #[test]
    fn a_text_is_the_same_in_every_encoding() {
        let text = "Path[\n  стекло 🂡\n]\n";
        let expected = lines(text.into());
        assert_eq!(expected.len(), 3, "{expected:?}");
        let marked = format!("\u{feff}{text}");
        for (name, bytes) in [
            ("a mark", marked.clone().into_bytes()),
            ("UTF-16 with the low byte first", utf16(&marked, u16::to_le_bytes)),
            ("UTF-16 with the high byte first", utf16(&marked, u16::to_be_bytes)),
            ("without a mark", utf16(text, u16::to_le_bytes)),
            ("without a mark", utf16(text, u16::to_be_bytes)),
            ("Windows", text.replace('\n', "\r\n").into_bytes()),
            ("the Macintosh of old", text.replace('\n', "\r").into_bytes()),
        ] {
            assert_eq!(lines(bytes), expected, "{name}");
        }
    }

    #[test]
    fn characters_are_not_cut_between_two_reads() {
        let long = format!("\u{feff}{}🂡{}\n", "a".repeat(UNITS - 2), "b".repeat(2 * UNITS));
        let found = lines(utf16(&long, u16::to_le_bytes));
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].0, long.trim_start_matches('\u{feff}').trim_end());
    }

    #[test]
    fn ends_of_lines_are_counted_once() {
        let found = lines(b"a\r\n\r\nb\rc\n\nd".to_vec());
        let texts: Vec<&str> = found.iter().map(|(text, _)| text.as_str()).collect();
        assert_eq!(texts, ["a", "", "b", "c", "", "d"]);
        assert!(!found[5].1 && found[4].1, "the last one has no end");
        let endless = lines(vec![b'x'; 2 * LONGEST_LINE + 5]);
        let lengths: Vec<usize> = endless.iter().map(|(text, _)| text.len()).collect();
        assert_eq!(lengths, [LONGEST_LINE, LONGEST_LINE, 5]);
        assert!(lines(Vec::new()).is_empty());
    }
}
