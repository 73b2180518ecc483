//! What each reader takes and refuses, with the words it refuses it in.

use std::path::Path;

use bn_core::io::{self, Format, NpyProblem, Place, ReadError, ReadOptions, ReadProblem};
use bn_core::{DVec2, Ensemble};

const TEXT_OF_PAIRS: [Format; 3] = [Format::Txt, Format::Dat, Format::Csv];

fn read(format: Format, bytes: impl AsRef<[u8]>) -> Result<Ensemble, ReadError> {
    io::read(format, "f", bytes.as_ref(), ReadOptions::default())
}

/// The sets as pairs of numbers.
fn sets(format: Format, bytes: impl AsRef<[u8]>) -> Vec<Vec<(f64, f64)>> {
    let ensemble = read(format, bytes).expect("a readable file");
    ensemble.sets().iter().map(|set| set.points().iter().map(|p| (p.x, p.y)).collect()).collect()
}

/// Why the file is not read.
fn refusal(format: Format, bytes: impl AsRef<[u8]>) -> ReadError {
    match read(format, bytes) {
        Ok(ensemble) => panic!("{} sets were read", ensemble.len()),
        Err(error) => error,
    }
}

fn message(format: Format, bytes: impl AsRef<[u8]>) -> String {
    refusal(format, bytes).to_string()
}

fn problem(format: Format, bytes: impl AsRef<[u8]>) -> (Option<u64>, Option<usize>, ReadProblem) {
    let error = refusal(format, bytes);
    let Place { line, set, .. } = error.place();
    (line, set, error.into_problem())
}

#[test]
fn txt_has_an_optional_count() {
    for text in
        ["0.5 0.25\n0.75 0\n", "2\n0.5 0.25\n0.75 0\n", "# seed 1\n2\n# x y\n0.5 0.25\n0.75 0"]
    {
        assert_eq!(sets(Format::Txt, text), [[(0.5, 0.25), (0.75, 0.0)]], "{text}");
    }
    assert_eq!(
        message(Format::Txt, "# c\n3\n0.5 0.25\n0.75 0\n"),
        "f, line 2: 3 points are announced but 2 follow; the file is cut off, or the number needs \
         correcting"
    );
    for (count, found) in [("1", 2), ("0", 2), ("99999999999999999999999", 2)] {
        let (line, _, problem) = problem(Format::Txt, format!("{count}\n0.5 0.25\n0.75 0\n"));
        assert_eq!(line, Some(1));
        assert!(
            matches!(problem, ReadProblem::Count { stated, found: f } if stated == count && f == found)
        );
    }
    // Two whole numbers are a point, one that is no count is nothing.
    assert_eq!(sets(Format::Txt, "0 0\n"), [[(0.0, 0.0)]]);
    for text in ["0.5\n0.5 0.5\n", "-1\n0.5 0.5\n", "0.5 0.5\n1\n"] {
        assert!(matches!(problem(Format::Txt, text).2, ReadProblem::NotAPoint { .. }), "{text}");
    }
}

#[test]
fn rows_may_be_untidy() {
    for text in [
        "0.5 0.25\r\n0.75 0\r\n",
        "\u{FEFF}0.5 0.25\n0.75 0\n",
        "\n\n  0.5\t0.25  \n \t \n0.75 \t 0\n\n",
        "0.5, 0.25\n0.75,0",
        "5e-1 2.5E-1\n+.75 0.\n",
    ] {
        for format in [Format::Txt, Format::Dat] {
            assert_eq!(sets(format, text), [[(0.5, 0.25), (0.75, 0.0)]], "{text:?}");
        }
    }
    let crlf = "\u{FEFF}x,y\r\n 0.5 , 0.25 \r\n\r\n\"0.75\",\"0\"\r\n";
    assert_eq!(sets(Format::Csv, crlf), [[(0.5, 0.25), (0.75, 0.0)]]);
}

#[test]
fn minus_zero_is_kept() {
    let zero = |format, bytes: &[u8]| {
        let points = sets(format, bytes);
        assert!(points[0][0].0 == 0.0 && points[0][0].0.is_sign_negative(), "{format}");
    };
    zero(Format::Txt, b"-0 0.5");
    zero(Format::Csv, b"-0.0,0.5");
    zero(Format::Json, b"{\"points\":[[-0.0,0.5]]}");
    zero(Format::Json, b"{\"points\":[[-0,0.5]]}");
    zero(Format::Eps, b"-0 0.5 p");
    zero(Format::Rps, &[0, 0, 0, 0x80, 0, 0, 0, 0x3F]);
}

#[test]
fn what_is_not_finite_is_refused_with_its_line() {
    for format in TEXT_OF_PAIRS {
        for word in ["nan", "NaN", "-nan", "inf", "-Infinity", "1e999"] {
            let (line, _, problem) = problem(format, format!("0.5,0.5\n{word},0\n"));
            assert_eq!(line, Some(2));
            assert!(matches!(problem, ReadProblem::NotFinite { .. }), "{word} in .{format}");
        }
        for word in ["0x1p-1", "0.5d0", "1_0", "½", "0.5.5", "--1", "e5", "\0"] {
            let (line, _, problem) = problem(format, format!("0.5,0.5\n{word},0\n"));
            assert_eq!(line, Some(2));
            assert!(matches!(problem, ReadProblem::NotAPoint { .. }), "{word} in .{format}");
        }
    }
    let nan = [f32::NAN.to_le_bytes(), 0.5_f32.to_le_bytes()].concat();
    assert_eq!(
        message(Format::Rps, [&[0; 16][..], &nan].concat()),
        "f, byte 16: the point (NaN, 0.5) is nowhere; coordinates must be finite numbers"
    );
    for word in ["NaN", "Infinity", "null", "\"0.5\"", "1e999"] {
        let error = read(Format::Json, format!("{{\"points\":[\n[0.5,0.5],\n[{word},0]]}}"));
        let error = error.expect_err("not a number");
        assert_eq!(error.place().line, Some(3), "{error}");
    }
}

#[test]
fn what_is_outside_is_refused_with_the_mend_or_wrapped() {
    assert_eq!(
        message(Format::Txt, "0.5 0.5\n0.25 1.0\n"),
        "f, line 2: the point (0.25, 1.0) lies outside the unit square [0, 1)²; scale the points, or \
         ask for them to be wrapped round the torus"
    );
    let files: [(Format, &[u8]); 5] = [
        (Format::Txt, b"0.25 1\n-0.25 2.5"),
        (Format::Dat, b"0.25 1\n-0.25 2.5"),
        (Format::Csv, b"x,y\n0.25,1\n-0.25,2.5"),
        (Format::Json, b"{\"points\":[[0.25,1],[-0.25,2.5]]}"),
        (Format::Eps, b"%!PS\n0.25 1 p\n-0.25 2.5 p"),
    ];
    for (format, bytes) in files {
        assert!(matches!(problem(format, bytes).2, ReadProblem::OutOfDomain { x: 0.25, y: 1.0 }));
        let wrapped = io::read(format, "f", bytes, ReadOptions { wrap: true }).expect("wrapped");
        let want = [DVec2::new(0.25, 0.0), DVec2::new(0.75, 0.5)];
        assert_eq!(wrapped.sets()[0].points(), want, "{format}");
        // Wrapping does not make numbers of what is none.
        let nan = io::read(Format::Txt, "f", &b"nan 0"[..], ReadOptions { wrap: true });
        assert!(matches!(nan.expect_err("nan").problem(), ReadProblem::NotFinite { .. }));
    }
}

#[test]
fn number_signs_separate_the_sets_of_dat_alone() {
    let text = "# two sets\n#\n0.5 0.5\n\n# seed 2\n#\n0.25 0\n0 0.25\n#\n";
    assert_eq!(sets(Format::Dat, text), [vec![(0.5, 0.5)], vec![(0.25, 0.0), (0.0, 0.25)]]);
    let (line, _, refused) = problem(Format::Txt, text);
    assert_eq!(line, Some(7));
    assert!(matches!(refused, ReadProblem::SecondSet));
    assert_eq!(sets(Format::Txt, "0.5 0.5\n# the end\n"), [[(0.5, 0.5)]]);

    let counted = "1\n0.5 0.5\n#\n2\n0.25 0\n0 0.25\n";
    assert_eq!(sets(Format::Dat, counted), sets(Format::Dat, text));
    let (line, set, wrong) = problem(Format::Dat, "1\n0.5 0.5\n#\n3\n0.25 0\n0 0.25\n");
    assert_eq!((line, set), (Some(4), Some(1)));
    assert!(matches!(wrong, ReadProblem::Count { found: 2, .. }));
    let (line, set, outside) = problem(Format::Dat, "0 0\n#\n0 0\n#\n0 0\n2 0\n");
    assert_eq!((line, set), (Some(6), Some(2)));
    assert!(matches!(outside, ReadProblem::OutOfDomain { .. }));
}

#[test]
fn csv_has_two_columns_and_one_kind_of_header() {
    for text in ["0.5,0.25", "x,y\n0.5,0.25", "\"X\" , \"Y\"\n0.5,0.25\n"] {
        assert_eq!(sets(Format::Csv, text), [[(0.5, 0.25)]], "{text}");
    }
    for (text, bad_line) in [
        ("a,b\n0.5,0.5", 1),
        ("x,y,z\n0.5,0.5,0.5", 1),
        ("x,y\nx,y\n0.5,0.5", 2),
        ("0.5,0.5\nx,y", 2),
        ("x,y\n0.5 0.5", 2),
        ("x,y\n0.5;0.5", 2),
        ("x,y\n0,5,0,5", 2),
        ("x,y\n0.5,0.5,", 2),
        ("x,y\n0.5,\"0.5", 2),
        ("x,y\n# 2\n0.5,0.5", 2),
    ] {
        let (line, _, problem) = problem(Format::Csv, text);
        assert_eq!(line, Some(bad_line), "{text}");
        assert!(matches!(problem, ReadProblem::NotAPoint { .. }), "{text}");
    }
}

#[test]
fn json_has_one_of_two_keys() {
    assert_eq!(sets(Format::Json, "{\"points\":[[0.5,0.25],[0,0]]}"), [[(0.5, 0.25), (0.0, 0.0)]]);
    let with_more =
        "\u{FEFF}{\"method\":\"fpo\",\"seed\":{\"a\":[1,{}]},\"sets\":[[[0.5,0]],[[0,0]]]}\n";
    assert_eq!(sets(Format::Json, with_more), [[(0.5, 0.0)], [(0.0, 0.0)]]);
    for (text, want) in [
        ("{}", "neither of the keys points and sets (column 2)"),
        ("{\"point\":[[0,0]]}", "neither of the keys points and sets"),
        ("{\"points\":[[0,0]],\"sets\":[[[0,0]]]}", "more than one of the keys points and sets"),
        ("{\"points\":[[0,0]],\"points\":[[0,0]]}", "more than one of the keys points and sets"),
        ("[[0,0]]", "invalid type: sequence, expected an object"),
        ("{\"points\":[[0]]}", "invalid length 1, expected a point [x, y]"),
        ("{\"points\":[[0,0,0]]}", "invalid length 3, expected a point [x, y]"),
        ("{\"points\":[0,0]}", "expected a point [x, y]"),
        ("{\"points\":[[0,0]]} {}", "trailing characters"),
        ("{\"points\":[[0,0],]}", "trailing comma"),
        ("{\"points\":[[0,0]", "EOF while parsing"),
        ("{\"points\":[{\"x\":0,\"y\":0}]}", "invalid type: map"),
        ("", "EOF while parsing"),
    ] {
        let message = message(Format::Json, text);
        assert!(message.contains(want), "{text}: {message}");
        assert!(message.ends_with("{\"sets\": [[[x, y], …], …]}"), "{message}");
    }
    let (line, set, empty) = problem(Format::Json, "{\"sets\":[\n[[0,0]],\n[]]}");
    assert_eq!((line, set), (Some(3), Some(1)));
    assert!(matches!(empty, ReadProblem::Empty));
    let (line, set, outside) = problem(Format::Json, "{\"sets\":[\n[[0,0]],\n[[0,0],\n[3,0]]]}");
    assert_eq!((line, set), (Some(4), Some(1)));
    assert!(matches!(outside, ReadProblem::OutOfDomain { x: 3.0, .. }));
}

#[test]
fn json_numbers_are_rounded_correctly() {
    // Halfway cases and long decimals, where a quick conversion is off by one unit.
    for number in ["0.1234567890123456789", "0.30000000000000004", "8.5e-292", "0.9999999999999999"]
    {
        let text = format!("{{\"points\":[[{number},0]]}}");
        assert_eq!(sets(Format::Json, text)[0][0].0, number.parse::<f64>().expect("a number"));
    }
}

/// The kind of file that PSA 1.1 writes: its header's words, and numbers of 6 digits.
#[test]
fn eps_is_read_as_psa_reads_it() {
    let text = "%!PS-Adobe-3.1 EPSF-3.0\n%%BoundingBox: -3 -3 515 515\n/radius { 0.00585938 } def\n\
                /p { radius 0 360 arc closepath fill stroke } def\ngsave 512 512 scale\n0 setgray\n\
                0.600459 0.549315 p\n4.62451e-06 0.205448 p\n% 0.5 0.5 p\n0.5 0.5 lineto\n\
                1 index pop\n  0.25   0.75  plot\ngrestore\n";
    let want = [(0.600_459, 0.549_315), (4.624_51e-6, 0.205_448), (0.25, 0.75)];
    assert_eq!(sets(Format::Eps, text), [want]);
    let (line, _, broken) = problem(Format::Eps, "%!PS\n0.5 0.5 p\n0.5 0.x p\n");
    assert_eq!(line, Some(3));
    assert!(matches!(broken, ReadProblem::NotAPoint { text } if text == "0.5 0.x p"));
    for count in ["3", "1", "two", "", "2 2"] {
        let (line, _, wrong) = problem(Format::Eps, format!("%points {count}\n0 0 p\n.5 0 p\n"));
        assert_eq!(line, Some(1));
        assert!(matches!(wrong, ReadProblem::Count { stated, found: 2 } if stated == count));
    }
}

#[test]
fn npy_is_read_as_numpy_wrote_it() {
    let file = |name: &str| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name);
        std::fs::read(path).expect("a file of the repository")
    };
    let a = [(0.5, 0.25), (0.1, 0.999_999_999_999_999_9), (1e-300, 0.0)];
    let reversed = [a[2], a[1], a[0]];
    assert_eq!(sets(Format::Npy, file("set_f8.npy")), [a]);
    assert_eq!(sets(Format::Npy, file("set_f8_v2.npy")), [a]);
    assert_eq!(sets(Format::Npy, file("sets_f8.npy")), [a, reversed]);
    assert_eq!(
        sets(Format::Npy, file("set_f4.npy")),
        [[(0.25, 0.125), (f64::from(0.05_f32), 0.5)]]
    );

    // What we write is byte for byte what NumPy writes.
    let ensemble = read(Format::Npy, file("sets_f8.npy")).expect("readable");
    let mut written = Vec::new();
    io::write(Format::Npy, ensemble.sets(), &mut written).expect("in memory");
    assert_eq!(written, file("sets_f8.npy"));

    let refused = |name| match problem(Format::Npy, file(name)).2 {
        ReadProblem::Npy(problem) => problem,
        other => panic!("{other}"),
    };
    assert_eq!(refused("set_fortran.npy"), NpyProblem::FortranOrder);
    assert_eq!(refused("set_big_endian.npy"), NpyProblem::Type { descr: ">f8".into() });
    assert_eq!(refused("set_i8.npy"), NpyProblem::Type { descr: "<i8".into() });
}

#[test]
fn npy_of_the_wrong_length_or_version_is_refused() {
    let mut good = Vec::new();
    let ensemble = read(Format::Dat, "0 0\n.5 0\n#\n.5 .5\n0 .5").expect("two sets");
    io::write(Format::Npy, ensemble.sets(), &mut good).expect("in memory");
    let refused = |bytes: &[u8]| match problem(Format::Npy, bytes).2 {
        ReadProblem::Npy(problem) => problem,
        other => panic!("{other}"),
    };
    let length = |found| NpyProblem::Length { expected: 64, found };
    assert_eq!(refused(&good[..good.len() - 1]), length(Some(63)));
    assert_eq!(refused(&good[..good.len() - 32]), length(Some(32)));
    assert_eq!(refused(&[&good[..], b"\n"].concat()), length(None));
    assert_eq!(
        message(Format::Npy, &good[..good.len() - 1]),
        "f: the shape asks for 64 bytes of numbers, there are 63; the file is cut off or its \
         header is wrong"
    );
    let mut version_9 = good.clone();
    version_9[6] = 9;
    assert_eq!(refused(&version_9), NpyProblem::Version { major: 9, minor: 0 });
    for end in 0..10 {
        assert!(matches!(refused(&good[..end]), NpyProblem::Magic | NpyProblem::Header { .. }));
    }
    let mut outside = good.clone();
    let last = outside.len() - 8;
    outside[last..].copy_from_slice(&1.0_f64.to_le_bytes());
    let error = read(Format::Npy, &outside).expect_err("outside");
    assert_eq!(error.place().byte, Some(last as u64 - 8));
    assert_eq!(error.place().set, Some(1));
}

#[test]
fn rps_is_whole_points() {
    assert_eq!(sets(Format::Rps, [0; 16]), [[(0.0, 0.0), (0.0, 0.0)]]);
    assert_eq!(
        message(Format::Rps, [0; 20]),
        "f: 20 bytes are not a whole number of points of 8 bytes, two 32-bit floats; the file is \
         cut off or of another format"
    );
}

#[test]
fn what_holds_no_point_is_refused() {
    let npy = |shape: &str| {
        let text = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}\n");
        [b"\x93NUMPY\x01\0", &(text.len() as u16).to_le_bytes()[..], text.as_bytes()].concat()
    };
    let files: [(Format, Vec<u8>); 12] = [
        (Format::Txt, b"".into()),
        (Format::Txt, b"# nothing\n\n".into()),
        (Format::Txt, b"0\n".into()),
        (Format::Dat, b"#\n#\n".into()),
        (Format::Csv, b"x,y\n".into()),
        (Format::Json, b"{\"points\":[]}".into()),
        (Format::Json, b"{\"sets\":[]}".into()),
        (Format::Eps, b"%!PS\nshowpage\n".into()),
        (Format::Rps, b"".into()),
        (Format::Npy, npy("(0, 2)")),
        (Format::Npy, npy("(0, 5, 2)")),
        (Format::Npy, npy("(5, 0, 2)")),
    ];
    for (format, bytes) in files {
        assert!(matches!(problem(format, bytes).2, ReadProblem::Empty), ".{format}");
    }
}

#[test]
fn foreign_files_end_soon() {
    let png = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR".repeat(100);
    let long_line = b"0".repeat(100_000);
    // Any bytes that happen to be numbers in [0, 1) are an .rps file.
    for format in Format::ALL.into_iter().filter(|&format| format != Format::Rps) {
        for bytes in [&png, &long_line] {
            let message = message(format, bytes);
            assert!(message.len() < 300, "{message}");
        }
    }
    assert_eq!(
        message(Format::Txt, &long_line),
        "f, line 1: the line has more than 16384 bytes; a line holds one point"
    );
}

#[test]
fn files_are_named_and_told_by_their_extension() {
    let missing = Path::new("no/such/points.rps");
    let error = io::read_path(missing, None, ReadOptions::default()).expect_err("no file");
    assert_eq!(error.to_string(), format!("{}: cannot be read", missing.display()));
    assert!(std::error::Error::source(&error).is_some(), "the system's reason");
    let error = io::read_path(Path::new("points.xyz"), None, ReadOptions::default());
    assert_eq!(
        error.expect_err("no format").to_string(),
        "points.xyz: '.xyz' is no known format; known are txt, rps, dat, csv, npy, json, eps; \
         rename the file or give its format"
    );
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/set_f8.npy");
    assert_eq!(io::read_path(&data, None, ReadOptions::default()).expect("readable").len(), 1);
    let error = io::read_path(&data, Some(Format::Txt), ReadOptions::default());
    assert_eq!(error.expect_err("not text").place().line, Some(1));
}

/// A source that fails in the middle.
struct Failing(usize);

impl std::io::Read for Failing {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        if self.0 == 0 {
            return Err(std::io::Error::other("the disk is gone"));
        }
        let count = self.0.min(buffer.len());
        buffer[..count].fill(b' ');
        self.0 -= count;
        Ok(count)
    }
}

#[test]
fn failures_of_the_source_are_passed_on() {
    for format in Format::ALL {
        let error = io::read(format, "f", Failing(5), ReadOptions::default()).expect_err("failed");
        let reason = std::error::Error::source(&error).map(ToString::to_string);
        assert_eq!(reason.as_deref(), Some("the disk is gone"), "{format}: {error}");
    }
}
