//! What is written is read back, bit for bit.

use bn_core::io::{self, Format, ReadOptions, WriteError};
use bn_core::{DVec2, PointSet, torus};
use proptest::prelude::*;

const EXACT: [Format; 6] =
    [Format::Txt, Format::Dat, Format::Csv, Format::Npy, Format::Json, Format::Eps];

fn written(format: Format, sets: &[PointSet]) -> Vec<u8> {
    let mut bytes = Vec::new();
    io::write(format, sets, &mut bytes).expect("writable");
    bytes
}

fn read(format: Format, bytes: &[u8]) -> Vec<PointSet> {
    let ensemble = io::read(format, "memory", bytes, ReadOptions::default());
    ensemble.unwrap_or_else(|error| panic!("{error}")).into_sets()
}

/// The coordinates' bits: `==` would take −0 for 0.
fn bits(sets: &[PointSet]) -> Vec<Vec<[u64; 2]>> {
    let of_set =
        |set: &PointSet| set.points().iter().map(|p| p.to_array().map(f64::to_bits)).collect();
    sets.iter().map(of_set).collect()
}

fn set(points: &[(f64, f64)]) -> PointSet {
    PointSet::new(points.iter().map(|&p| p.into()).collect()).expect("valid")
}

/// Numbers in [0, 1) with short, long and extreme decimals.
fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        0.0..1.0_f64,
        (0..1000_u16).prop_map(|i| f64::from(i) / 1000.0),
        // Any exponent, subnormal numbers included.
        (0..0x3FF0_0000_0000_0000_u64).prop_map(f64::from_bits),
        prop::sample::select(vec![
            0.0,
            -0.0,
            5e-324,
            2.225e-308,
            1e-300,
            1e-17,
            1e-5,
            9.999e-5,
            0.1,
            torus::ONE_MINUS_EPSILON,
            torus::ONE_MINUS_EPSILON - 1e-16,
            1.0 - 3e-8,
        ]),
    ]
}

fn some_set() -> impl Strategy<Value = PointSet> {
    prop::collection::vec((coordinate(), coordinate()), 1..20).prop_map(|points| set(&points))
}

proptest! {
    #[test]
    fn one_set_survives_every_exact_format(set in some_set()) {
        let sets = [set];
        for format in EXACT {
            let back = read(format, &written(format, &sets));
            prop_assert_eq!(bits(&back), bits(&sets), "{}", format);
        }
    }

    #[test]
    fn several_sets_survive_every_format_of_ensembles(
        sets in prop::collection::vec(some_set(), 2..5),
        n in 1..20_usize,
    ) {
        for format in [Format::Dat, Format::Json] {
            prop_assert_eq!(bits(&read(format, &written(format, &sets))), bits(&sets), "{}", format);
        }
        let equal: Vec<_> = sets
            .iter()
            .map(|set| {
                let endless = set.points().iter().copied().cycle();
                PointSet::new(endless.take(n).collect()).expect("valid")
            })
            .collect();
        prop_assert_eq!(bits(&read(Format::Npy, &written(Format::Npy, &equal))), bits(&equal));
    }

    #[test]
    fn an_rps_file_survives_any_conversion_and_back(
        // The bits of all 32-bit floats in [0, 1), and −0.
        floats in prop::collection::vec(
            prop_oneof![8 => 0..0x3F80_0000_u32, 1 => Just(0x8000_0000), 1 => Just(0x3F7F_FFFF)],
            1..40,
        ),
    ) {
        let file: Vec<u8> = floats.iter().flat_map(|f| [f.to_le_bytes(), f.to_le_bytes()].concat()).collect();
        let sets = read(Format::Rps, &file);
        for format in Format::ALL {
            let converted = read(format, &written(format, &sets));
            prop_assert_eq!(&written(Format::Rps, &converted), &file, "through {}", format);
        }
    }

    #[test]
    fn rps_keeps_half_a_unit_of_32_bit_floats(set in some_set()) {
        let back = read(Format::Rps, &written(Format::Rps, std::slice::from_ref(&set)));
        for (p, q) in set.points().iter().zip(back[0].points()) {
            // Coordinates below 1 have 24 bits; subnormal ones steps of 2⁻¹⁴⁹.
            prop_assert!(torus::distance(*p, *q) <= 2.0_f64.powi(-25) * 2.0_f64.sqrt());
        }
    }
}

#[test]
fn rounding_to_one_in_rps_becomes_zero() {
    let sets = [set(&[(torus::ONE_MINUS_EPSILON, 1.0 - 2.0_f64.powi(-24)), (1.0 - 2e-8, 0.5)])];
    let below_one = 1.0 - 2.0_f64.powi(-24);
    let want = set(&[(0.0, below_one), (0.0, 0.5)]);
    assert_eq!(read(Format::Rps, &written(Format::Rps, &sets)), [want]);
}

#[test]
fn files_look_like_this() {
    let one = [set(&[(0.5, 0.1), (1e-5, -0.0)])];
    let two = [one[0].clone(), set(&[(0.0, 0.25)])];
    let text = |format, sets: &[PointSet]| String::from_utf8(written(format, sets)).expect("text");
    assert_eq!(text(Format::Txt, &one), "2\n0.5 0.1\n1e-5 -0.0\n");
    assert_eq!(text(Format::Csv, &one), "x,y\n0.5,0.1\n1e-5,-0.0\n");
    assert_eq!(text(Format::Dat, &one), "0.5 0.1\n1e-5 -0.0\n");
    assert_eq!(text(Format::Dat, &two), "0.5 0.1\n1e-5 -0.0\n#\n0.0 0.25\n");
    assert_eq!(text(Format::Json, &one), "{\"points\": [[0.5, 0.1],\n[1e-5, -0.0]]}\n");
    assert_eq!(
        text(Format::Json, &two),
        "{\"sets\": [\n[[0.5, 0.1],\n[1e-5, -0.0]],\n[[0.0, 0.25]]]}\n"
    );
    assert_eq!(
        text(Format::Eps, &one),
        "%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: -3 -3 515 515\n%%EndComments\n%points 2\n\
         /radius { 0.00585938 } def\n/p { newpath radius 0 360 arc fill } def\ngsave\n\
         512 512 scale\n0 setgray\n0.5 0.1 p\n1e-5 -0.0 p\ngrestore\nshowpage\n%%EOF\n"
    );
    assert_eq!(written(Format::Rps, &one).len(), 16);
    let npy = written(Format::Npy, &one);
    assert_eq!(npy.len(), 128 + 32);
    assert!(npy.starts_with(b"\x93NUMPY\x01\x00\x76\x00{'descr': '<f8', 'fortran_order': False,"));
}

#[test]
fn what_a_format_cannot_hold_is_refused_before_anything_is_written() {
    let (one, two) = (set(&[(0.0, 0.0)]), set(&[(0.0, 0.0), (0.5, 0.5)]));
    let refused = |format, sets: &[PointSet]| {
        let mut bytes = Vec::new();
        let error = io::write(format, sets, &mut bytes).expect_err("not to be held");
        assert!(bytes.is_empty(), "{format}");
        error
    };
    for format in Format::ALL {
        assert!(matches!(refused(format, &[]), WriteError::Empty));
        if !format.holds_ensembles() {
            let error = refused(format, &[one.clone(), one.clone()]);
            assert!(matches!(error, WriteError::OneSetOnly { sets: 2, .. }), "{error}");
        }
    }
    let error = refused(Format::Npy, &[one.clone(), one, two]);
    assert!(matches!(error, WriteError::UnequalSets { first: 1, set: 2, points: 2 }), "{error}");
}

/// A target that is full after a while.
struct Full(usize);

impl std::io::Write for Full {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        if self.0 < bytes.len() {
            return Err(std::io::ErrorKind::StorageFull.into());
        }
        self.0 -= bytes.len();
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

#[test]
fn a_full_disk_is_an_error_even_at_the_last_byte() {
    let large = PointSet::new(vec![DVec2::new(0.123, 0.456); 20_000]).expect("valid");
    for set in [large, set(&[(0.25, 0.75)])] {
        for format in Format::ALL {
            let size = written(format, std::slice::from_ref(&set)).len();
            for room in [0, size / 2, size - 1] {
                let outcome = io::write(format, std::slice::from_ref(&set), Full(room));
                assert!(matches!(outcome, Err(WriteError::Io(_))), "{format}, {room} of {size}");
            }
            assert!(io::write(format, std::slice::from_ref(&set), Full(size)).is_ok());
        }
    }
}
