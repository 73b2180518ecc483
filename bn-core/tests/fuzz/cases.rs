//! Files to feed to a reader: damaged ones and nonsense in the format's own words.

use bn_core::io::{self, Format};
use bn_core::{DVec2, PointSet, StreamRng, torus};
use rand::RngExt;

const LONGEST: usize = 4096;

/// Pieces that readers have an opinion on.
const WORDS: &[&[u8]] = &[
    b"0",
    b"1",
    b"2",
    b"-0",
    b"0.5",
    b"1e-300",
    b"1e999",
    b"nan",
    b"inf",
    b"-1",
    b"0x1",
    b"1_0",
    b" ",
    b"\t",
    b"\n",
    b"\r\n",
    b",",
    b"#",
    b"#\n",
    b"\"",
    b"'",
    b"\0",
    b"\xEF\xBB\xBF",
    b"\xFF",
    b"x,y\n",
    b"p",
    b"p\n",
    b"%",
    b"%points 2\n",
    b"0 0 p\n",
    b"0.5 0.5\n",
    b"0.5,0.5\n",
    b"[",
    b"]",
    b"[[",
    b"]]",
    b"{",
    b"}",
    b":",
    b"[0,0]",
    b"[0.5,0.5],",
    b"{\"points\":[",
    b"{\"sets\":[[",
    b"\"points\"",
    b"\"sets\"",
    b"null",
    b"true",
    b"\x93NUMPY",
    b"\x93NUMPY\x01\0",
    b"'descr'",
    b"'<f4'",
    b"'<f8'",
    b"'>f8'",
    b"'fortran_order'",
    b"True",
    b"False",
    b"'shape'",
    b"(2, 2)",
    b"(1, 2, 2)",
    b"(",
    b")",
    b"18446744073709551615",
    b"4294967296",
    b"99999999999999999999999999",
];

pub struct Cases {
    rng: StreamRng,
    valid: Vec<Vec<u8>>,
}

impl Cases {
    pub fn new(format: Format, mut rng: StreamRng) -> Self {
        let valid = (0..400).map(|_| valid(format, &mut rng)).collect();
        Self { rng, valid }
    }

    /// A valid file with one to four damages.
    pub fn mutation(&mut self) -> Vec<u8> {
        let mut bytes = self.any_valid().to_vec();
        for _ in 0..self.rng.random_range(1..=4_u32) {
            self.damage(&mut bytes);
        }
        bytes.truncate(LONGEST);
        bytes
    }

    /// Random bytes, or random words.
    pub fn nonsense(&mut self) -> Vec<u8> {
        let length = self.rng.random_range(0..200_u32);
        if self.rng.random_bool(0.3) {
            return (0..length).map(|_| self.rng.random()).collect();
        }
        let mut bytes: Vec<u8> = (0..length).flat_map(|_| self.word()).copied().collect();
        bytes.truncate(LONGEST);
        bytes
    }

    fn any_valid(&mut self) -> &[u8] {
        let i = self.below(self.valid.len());
        &self.valid[i]
    }

    fn word(&mut self) -> &'static [u8] {
        WORDS[self.below(WORDS.len())]
    }

    /// An index below `end`, or 0.
    fn below(&mut self, end: usize) -> usize {
        self.rng.random_range(0..end.max(1) as u32) as usize
    }

    /// A short range within `length`.
    fn range(&mut self, length: usize) -> std::ops::Range<usize> {
        let start = self.below(length + 1);
        let end = start + self.below(32.min(length - start) + 1);
        start..end
    }

    fn damage(&mut self, bytes: &mut Vec<u8>) {
        let at = self.below(bytes.len());
        match self.rng.random_range(0..9_u32) {
            0 if !bytes.is_empty() => bytes[at] ^= 1 << self.rng.random_range(0..8_u32),
            1 if !bytes.is_empty() => bytes[at] = self.rng.random(),
            2 => bytes.truncate(at),
            3 => {
                let range = self.range(bytes.len());
                bytes.drain(range);
            }
            4 => {
                let piece = bytes[self.range(bytes.len())].to_vec();
                bytes.splice(at..at, piece);
            }
            5 => {
                let other = self.any_valid().to_vec();
                let piece = other[self.below(other.len())..].to_vec();
                bytes.truncate(at);
                bytes.extend(piece);
            }
            6 => {
                let word = self.word();
                bytes.splice(at..at, word.iter().copied());
            }
            _ => self.edit_a_number(bytes, at),
        }
    }

    /// Replaces the next run of digits, which may be a count or a shape.
    fn edit_a_number(&mut self, bytes: &mut Vec<u8>, from: usize) {
        let from = if self.rng.random_bool(0.3) { 0 } else { from };
        let Some(start) = (from..bytes.len()).find(|&i| bytes[i].is_ascii_digit()) else { return };
        let end = (start..bytes.len()).find(|&i| !bytes[i].is_ascii_digit()).unwrap_or(bytes.len());
        let number = match self.rng.random_range(0..4_u32) {
            0 => self.rng.random_range(0..50_u32).to_string(),
            1 => self.rng.random::<u32>().to_string(),
            2 => self.rng.random::<u64>().to_string(),
            _ => String::new(),
        };
        bytes.splice(start..end, number.into_bytes());
    }
}

/// A file that can be read.
fn valid(format: Format, rng: &mut StreamRng) -> Vec<u8> {
    let sets = if format.holds_ensembles() { rng.random_range(1..4_u32) } else { 1 };
    let n = rng.random_range(1..20_u32);
    let sets: Vec<_> = (0..sets)
        .map(|_| {
            let points = (0..n).map(|_| DVec2::new(coordinate(rng), coordinate(rng))).collect();
            PointSet::new(points).expect("in the domain")
        })
        .collect();
    let mut bytes = Vec::new();
    io::write(format, &sets, &mut bytes).expect("in memory");
    if rng.random_bool(0.5) { bytes } else { in_other_words(format, bytes, &sets[0]) }
}

fn coordinate(rng: &mut StreamRng) -> f64 {
    match rng.random_range(0..5_u32) {
        0 => {
            [0.0, -0.0, 1e-300, 0.25, torus::ONE_MINUS_EPSILON][rng.random_range(0..5_u32) as usize]
        }
        1 => f64::from(rng.random_range(0..100_u32)) / 100.0,
        _ => rng.random(),
    }
}

/// A file as other programs may write it.
fn in_other_words(format: Format, bytes: Vec<u8>, set: &PointSet) -> Vec<u8> {
    let text = String::from_utf8_lossy(&bytes);
    match format {
        // Without count or header, with CR LF and a byte order mark.
        Format::Txt | Format::Csv => {
            let rows = text.split_once('\n').map_or("", |(_, rows)| rows);
            format!("\u{FEFF}{}", rows.replace('\n', "\r\n")).into_bytes()
        }
        Format::Dat => format!("# a comment\n{}#\n", text.replace(' ', " ,\t")).into_bytes(),
        Format::Json => {
            let rest = text.strip_prefix('{').unwrap_or_default();
            format!("{{\"seed\": [1, {{\"a\": \"b\\n\"}}], {rest}").into_bytes()
        }
        // As PSA writes it: no number of points, other operators.
        Format::Eps => text.replace("%points", "%").replace(" p\n", " pt\n").into_bytes(),
        // Version 2, 32 bits.
        Format::Npy => {
            let shape = format!("({}L, 2L)", set.len());
            let header = format!("{{'shape': {shape}, 'fortran_order': False, 'descr': '<f4'}}");
            let mut bytes = b"\x93NUMPY\x02\0".to_vec();
            bytes.extend((header.len() as u32).to_le_bytes());
            bytes.extend(header.bytes());
            io::write(Format::Rps, std::slice::from_ref(set), &mut bytes).expect("in memory");
            bytes
        }
        _ => bytes,
    }
}
