//! Degenerate sets are ordinary: they can be made, searched, written and read.

use std::path::Path;

use bn_core::io::{self, Format, ReadOptions, ReadProblem};
use bn_core::{CellGrid, DVec2, Ensemble, EnsembleError, PointSet, PointSetError, Seed, torus};
use rand::RngExt;

fn at(x: f64, y: f64) -> DVec2 {
    DVec2::new(x, y)
}

/// Named sets that break careless programs.
fn degenerate_sets() -> Vec<(&'static str, Vec<DVec2>)> {
    let end = torus::ONE_MINUS_EPSILON;
    let lattice =
        |m: u32| (0..m * m).map(move |i| at(f64::from(i % m), f64::from(i / m)) / f64::from(m));
    let angle = |i: u32| f64::from(i) * std::f64::consts::TAU / 16.0;
    vec![
        ("one point", vec![at(0.3, 0.7)]),
        ("the origin", vec![DVec2::ZERO]),
        ("two points", vec![at(0.0, 0.0), at(0.5, 0.5)]),
        ("three in line", vec![at(0.1, 0.1), at(0.2, 0.2), at(0.3, 0.3)]),
        ("duplicates", vec![at(0.1, 0.2), at(0.5, 0.5), at(0.1, 0.2), at(0.1, 0.2)]),
        ("all equal", vec![at(0.25, 0.75); 1000]),
        ("both sides of the seam", vec![at(0.0, end), at(end, 0.0), at(0.0, 0.0), at(end, end)]),
        ("signed zeros", vec![at(0.0, -0.0), at(-0.0, 0.0)]),
        ("1e-17 apart", vec![at(0.0, 0.0), at(1e-17, 0.0), at(0.0, 1e-17)]),
        ("1e-300 apart", vec![at(0.0, 0.0), at(1e-300, 0.0), at(0.0, 2e-300), at(5e-324, 0.0)]),
        ("collinear", (0..50).map(|i| at(f64::from(i) / 50.0, 0.5)).collect()),
        (
            "cocircular",
            (0..16)
                .map(|i| at(0.5 + 0.25 * libm::cos(angle(i)), 0.5 + 0.25 * libm::sin(angle(i))))
                .collect(),
        ),
        ("square lattice", lattice(32).collect()),
    ]
}

#[test]
fn degenerate_sets_are_sets() {
    for (name, points) in degenerate_sets() {
        let set = PointSet::new(points.clone()).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(set.points(), points, "{name}");
        assert_eq!(PointSet::wrapped(points.clone()).expect("finite").points(), points, "{name}");
        let round = set.translated(at(0.5, 0.0)).translated(at(0.5, 1.0));
        for (p, q) in set.points().iter().zip(round.points()) {
            assert!(torus::distance(*p, *q) <= 2e-16, "{name}");
        }
    }
}

#[test]
fn degenerate_sets_are_searched() {
    for (name, points) in degenerate_sets() {
        let set = PointSet::new(points).expect("valid");
        let grid = CellGrid::new(&set);
        for (i, &p) in (0..).zip(set.points()) {
            let nearest = set
                .points()
                .iter()
                .zip(0_u32..)
                .filter(|&(_, j)| i != j)
                .map(|(&q, _)| torus::distance(p, q))
                .min_by(f64::total_cmp);
            assert_eq!(grid.nearest(p, Some(i)).map(|(_, d)| d), nearest, "{name}, point {i}");
        }
    }
}

#[test]
fn degenerate_sets_survive_every_format() {
    for (name, points) in degenerate_sets() {
        let set = PointSet::new(points).expect("valid");
        for format in Format::ALL {
            let mut bytes = Vec::new();
            io::write(format, std::slice::from_ref(&set), &mut bytes).expect("in memory");
            let back = io::read(format, name, &bytes[..], ReadOptions::default());
            let back = back.unwrap_or_else(|error| panic!("{format}: {error}")).into_sets();
            if format == Format::Rps {
                let errors = back[0].points().iter().zip(set.points());
                assert!(errors.into_iter().all(|(p, q)| torus::distance(*p, *q) < 5e-8), "{name}");
            } else {
                assert_eq!(back[0], set, "{name} in .{format}");
            }
        }
    }
}

#[test]
fn what_is_no_set_is_told_by_its_first_bad_point() {
    assert_eq!(PointSet::new(vec![]), Err(PointSetError::Empty));
    assert_eq!(PointSet::wrapped(vec![]), Err(PointSetError::Empty));
    assert_eq!(Ensemble::new(vec![]), Err(EnsembleError::Empty));
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for p in [at(bad, 0.5), at(0.5, bad)] {
            let points = vec![at(0.5, 0.5), p, at(bad, bad)];
            for error in [PointSet::new(points.clone()), PointSet::wrapped(points)] {
                assert!(matches!(error, Err(PointSetError::NotFinite { index: 1, .. })));
            }
        }
    }
    for bad in [1.0, -1e-300, -5e-324, 1.0 + f64::EPSILON, 1e300, -1e300] {
        let error = PointSet::new(vec![at(0.5, 0.5), at(0.5, bad)]);
        assert_eq!(error, Err(PointSetError::OutOfDomain { index: 1, x: 0.5, y: bad }));
        let message = error.expect_err("outside").to_string();
        assert!(message.len() < 150 && message.contains("scale or wrap"), "{message}");
        let wrapped = PointSet::wrapped(vec![at(0.5, bad)]).expect("finite");
        assert!(torus::contains(wrapped.points()[0]));
    }
}

/// Cutting a file can leave a file; it never leaves other points than the first ones, and where the
/// file states its size it is refused.
#[test]
fn truncated_files_give_an_error_or_the_first_points() {
    let mut rng = Seed::new(3).stream(0);
    let points: Vec<_> = (0..30).map(|_| at(rng.random(), rng.random())).collect();
    let set = PointSet::new(points.clone()).expect("valid");
    for format in Format::ALL {
        let mut bytes = Vec::new();
        io::write(format, std::slice::from_ref(&set), &mut bytes).expect("in memory");
        let states_its_size = !matches!(format, Format::Rps | Format::Dat | Format::Csv);
        let text_end = bytes.trim_ascii_end().len();
        for end in 0..bytes.len() {
            let read = io::read(format, "cut", &bytes[..end], ReadOptions::default());
            let Ok(ensemble) = read else { continue };
            let got = ensemble.sets()[0].points();
            if format == Format::Rps {
                assert_eq!(got.len() * 8, end);
            } else if states_its_size && got.len() < points.len() {
                panic!(".{format} cut at {end} of {text_end} gave {} points", got.len());
            } else {
                // The last number may have lost digits.
                let whole = got.len() - 1;
                assert_eq!(got[..whole], points[..whole], ".{format} cut at {end}");
            }
        }
    }
}

#[test]
fn a_million_points_go_through_every_format() {
    let n = 1_000_000;
    let mut rng = Seed::new(4).stream(0);
    let as_f32 = |x: f32| f64::from(x);
    let points = (0..n).map(|_| at(as_f32(rng.random()), as_f32(rng.random()))).collect();
    let set = PointSet::new(points).expect("valid");
    for format in Format::ALL {
        let mut bytes = Vec::new();
        io::write(format, std::slice::from_ref(&set), &mut bytes).expect("in memory");
        let back = io::read(format, "large", &bytes[..], ReadOptions::default()).expect("readable");
        assert!(back.sets() == std::slice::from_ref(&set), ".{format}");
    }
}

#[test]
fn directories_and_empty_files_are_errors() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data");
    for format in Format::ALL {
        let error =
            io::read_path(&here, Some(format), ReadOptions::default()).expect_err("a folder");
        assert!(matches!(error.problem(), ReadProblem::Io(_)), "{format}: {error}");
        assert!(io::read(format, "empty", &b""[..], ReadOptions::default()).is_err(), "{format}");
    }
}
