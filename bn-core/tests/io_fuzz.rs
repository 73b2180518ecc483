//! The readers under 10⁵ damaged and nonsensical files each: no panic, no hang, no allocation
//! beyond 16 times the input and 1 MiB, and whatever is read survives being written.

mod fuzz;

use bn_core::io::{self, Format, ReadOptions};
use bn_core::{Ensemble, PointSet, Seed};

use fuzz::allocation::{Counting, peak_of};
use fuzz::cases::Cases;

#[global_allocator]
static ALLOCATOR: Counting = Counting;

const CASES: u32 = 100_000;

fn allowed(input: usize) -> usize {
    16 * input + (1 << 20)
}

fn read(format: Format, bytes: &[u8], wrap: bool) -> Option<Ensemble> {
    let (outcome, peak) = peak_of(|| io::read(format, "fuzz", bytes, ReadOptions { wrap }));
    assert!(peak <= allowed(bytes.len()), "{peak} bytes for {}: {:?}", bytes.len(), bytes);
    outcome.map_err(|error| assert!(error.to_string().len() < 600, "{error}")).ok()
}

fn check_round_trip(format: Format, ensemble: &Ensemble) {
    let mut bytes = Vec::new();
    io::write(format, ensemble.sets(), &mut bytes).expect("what was read can be written");
    let back = read(format, &bytes, false).expect("what was written can be read");
    assert_eq!(&back, ensemble, "{format}");
    let signs = |ensemble: &Ensemble| -> Vec<bool> {
        let points = ensemble.sets().iter().flat_map(PointSet::points);
        points.flat_map(|p| [p.x.is_sign_negative(), p.y.is_sign_negative()]).collect()
    };
    assert_eq!(signs(&back), signs(ensemble), "{format}");
}

fn fuzz(format: Format) {
    let mut cases = Cases::new(format, Seed::new(2013).stream(format as u32));
    let mut readable = 0;
    for case in 0..CASES {
        // Three of four are mutations of valid files.
        let bytes = if case % 4 == 0 { cases.nonsense() } else { cases.mutation() };
        assert!(bytes.len() <= 4096);
        let wrap = case % 8 == 1;
        if let Some(ensemble) = read(format, &bytes, wrap) {
            readable += 1;
            // Wrapped numbers need more than the 32 bits of .rps.
            if !(wrap && format == Format::Rps) {
                check_round_trip(format, &ensemble);
            }
        }
    }
    // The test would say nothing if all files were good or all hopeless.
    assert!((CASES / 50..CASES * 3 / 4).contains(&readable), "{readable} readable {format} files");
}

#[test]
fn txt() {
    fuzz(Format::Txt);
}

#[test]
fn rps() {
    fuzz(Format::Rps);
}

#[test]
fn dat() {
    fuzz(Format::Dat);
}

#[test]
fn csv() {
    fuzz(Format::Csv);
}

#[test]
fn npy() {
    fuzz(Format::Npy);
}

#[test]
fn json() {
    fuzz(Format::Json);
}

#[test]
fn eps() {
    fuzz(Format::Eps);
}

/// The files that need the most memory for their size: the shortest points, and the shortest sets.
#[test]
fn the_densest_files_stay_within_the_bound() {
    let many = |before: &str, each: &str, after: &str| {
        [before, &each.repeat(3_000_000 / each.len()), after].concat().into_bytes()
    };
    let npy = |shape: &str, bytes: usize| {
        let text = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': {shape}, }}\n");
        let start = [b"\x93NUMPY\x01\0", &(text.len() as u16).to_le_bytes()[..], text.as_bytes()];
        [start.concat(), vec![0; bytes]].concat()
    };
    let files = [
        (Format::Txt, many("", "0 0\n", "")),
        (Format::Csv, many("", "0,0\n", "")),
        (Format::Eps, many("", "0 0 p\n", "")),
        (Format::Dat, many("", "0 0\n", "")),
        (Format::Dat, many("", "0 0\n#\n", "")),
        (Format::Json, many("{\"points\":[", "[0,0],", "[0,0]]}")),
        (Format::Json, many("{\"sets\":[", "[[0,0]],", "[[0,0]]]}")),
        (Format::Json, many("{\"", "a", "\":0,\"points\":[[0,0]]}")),
        (Format::Rps, vec![0; 3_000_000]),
        (Format::Npy, npy("(375000, 2)", 3_000_000)),
        (Format::Npy, npy("(375000, 1, 2)", 3_000_000)),
    ];
    for (format, bytes) in files {
        // Sizes at which growing vectors have just doubled need the most.
        for size in [bytes.len() * 3 / 4, bytes.len() * 11 / 20] {
            read(format, &bytes[..size], false);
        }
        assert!(read(format, &bytes, false).is_some(), "{format}");
    }
}

/// Headers that promise more than any memory holds.
#[test]
fn promises_are_not_believed() {
    for shape in ["(1000000000000, 2)", "(4000000000, 1000000, 2)", "(1, 576460752303423487, 2)"] {
        let text = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}\n");
        for version in 1..=2_u8 {
            let mut bytes = b"\x93NUMPY".to_vec();
            bytes.extend([version, 0]);
            let length = (text.len() as u32).to_le_bytes();
            bytes.extend(&length[..2 * usize::from(version)]);
            bytes.extend(text.as_bytes());
            assert!(read(Format::Npy, &bytes, false).is_none());
            bytes.truncate(8);
            bytes.extend([0xFF; 4]);
            assert!(read(Format::Npy, &bytes, false).is_none());
        }
    }
    assert!(read(Format::Txt, b"4000000000000\n0 0\n", false).is_none());
    assert!(read(Format::Eps, b"%points 4000000000000\n0 0 p\n", false).is_none());
}
