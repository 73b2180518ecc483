//! `bn analyze` as scripts call it.

use crate::folder::Folder;

const KEYS: [&str; 9] = [
    "d_min",
    "d_avg",
    "coverage_radius",
    "q6",
    "nu_eff",
    "omega",
    "nu_eff_direct",
    "omega_direct",
    "power_below",
];

/// A square grid of 16 × 16 points, whose statistics are known in closed form.
fn grid(folder: &Folder) {
    folder.bn("generate regular -n 256 -o grid.txt").done();
}

#[test]
fn a_square_grid_has_its_closed_forms() {
    let folder = Folder::new();
    grid(&folder);
    let a = folder.bn("analyze grid.txt --average --json --power-below 15.5").done().json();
    let value = |key: &str| a[key].as_f64().unwrap_or_else(|| panic!("{key} in {a}"));
    let spacing = (3.0_f64.sqrt() / 2.0).sqrt();
    assert!((value("d_min") - spacing).abs() < 1e-12);
    assert!((value("d_avg") - spacing).abs() < 1e-12);
    assert!((value("coverage_radius") - spacing / 2.0_f64.sqrt()).abs() < 1e-12);
    // The modes of the first ring are all at |k| = 16; the crossing lies in their ring.
    assert!((value("nu_eff_direct") - 1.0).abs() <= 0.5 / 16.0, "{a}");
    assert!(value("power_below") < 1e-9);
    assert_eq!(a["points"], 256);
    assert_eq!(a["sets"], 1);
    assert_eq!(a["files"][0], "grid.txt");
}

#[test]
fn with_average_one_object_without_it_an_array() {
    let folder = Folder::new();
    folder.bn("generate stochastic -n 256 --sets 3 -o s.rps").done();
    let files = "s_0.rps s_1.rps s_2.rps";
    let each = folder.bn(&format!("analyze {files} --json --only d_avg,d_min")).done().json();
    let all = folder.bn(&format!("analyze {files} --json --only d_avg --average")).done().json();
    assert_eq!(each.as_array().unwrap().len(), 3);
    let mean: f64 = (0..3).map(|i| each[i]["d_avg"].as_f64().unwrap()).sum::<f64>() / 3.0;
    assert!((all["d_avg"].as_f64().unwrap() - mean).abs() < 1e-14);
    assert!(all["std_error"]["d_avg"].as_f64().unwrap() > 0.0);
    assert!(each[0]["std_error"]["d_avg"].is_null());
    assert_eq!(all["sets"], 3);
    let one = folder.bn("analyze s_0.rps --json --only d_min").done().json();
    assert!(one.is_array());
    assert_eq!(one[0]["d_min"], each[0]["d_min"]);
}

#[test]
fn only_what_is_asked_for_is_computed() {
    let folder = Folder::new();
    grid(&folder);
    for key in &KEYS[..8] {
        let a = folder.bn(&format!("analyze grid.txt --average --json --only {key}")).done().json();
        for other in KEYS {
            assert_eq!(a[other].is_null(), other != *key, "{other} with --only {key}: {a}");
        }
    }
    folder.bn("analyze grid.txt --only power_below").refused(2, &["--power-below"]);
    folder.bn("analyze grid.txt --only d_mean").refused(2, &["d_mean", "d_avg"]);
}

#[test]
fn estimators_can_be_chosen() {
    let folder = Folder::new();
    grid(&folder);
    let direct = folder.bn("analyze grid.txt --average --json --method direct").done().json();
    assert!(direct["omega"].is_null() && direct["omega_direct"].is_number());
    let windowed = folder.bn("analyze grid.txt --average --json --method windowed").done().json();
    assert!(windowed["omega"].is_number() && windowed["omega_direct"].is_null());
}

#[test]
fn curves_are_csv_with_a_header() {
    let folder = Folder::new();
    grid(&folder);
    for (curve, header) in
        [("rdf", "r,g"), ("radial-power", "nu,power"), ("anisotropy", "nu,anisotropy_db")]
    {
        folder.bn(&format!("analyze grid.txt --curve {curve} -o c.csv")).done();
        let text = String::from_utf8(folder.read("c.csv")).unwrap();
        assert_eq!(text.lines().next(), Some(header));
        assert!(text.lines().count() > 20, "{curve}: {text}");
    }
}

#[test]
fn sets_of_different_size_are_not_averaged() {
    let folder = Folder::new();
    folder.file("a.txt", "0.1 0.2\n0.3 0.4\n");
    folder.file("b.txt", "0.1 0.2\n0.3 0.4\n0.5 0.6\n");
    folder.bn("analyze a.txt b.txt --average").refused(2, &["a.txt", "b.txt"]);
    let each = folder.bn("analyze a.txt b.txt --json").done().json();
    assert_eq!((&each[0]["points"], &each[1]["points"]), (&2.into(), &3.into()));
}

#[test]
fn bad_files_are_named_with_the_mend() {
    let folder = Folder::new();
    let cases: [(&str, &[u8]); 10] = [
        ("empty.txt", b""),
        ("nan.txt", b"2\n0.1 nan\n0.2 0.3\n"),
        ("short.txt", b"5\n0.1 0.2\n0.3 0.4\n"),
        ("odd.rps", &[0; 13]),
        ("words.txt", b"hello\n"),
        ("huge.txt", b"99999999999999999999\n0.1 0.2\n"),
        ("bad.npy", b"\x93NUMPY\x01\x00\xff\xff"),
        ("bad.json", b"{\"points\": [[0.1]]}"),
        ("outside.txt", b"0.1 0.2\n1.5 0.2\n"),
        ("unknown.xyz", b"0.1 0.2\n"),
    ];
    for (name, contents) in cases {
        folder.file(name, contents);
        let words = folder.bn(&format!("analyze {name} --json")).refused(2, &[name]);
        assert!(words.stdout.is_empty(), "{name}");
        assert_eq!(words.stderr.trim().lines().count(), 1, "{}", words.stderr);
    }
    let npy = folder.bn("analyze bad.npy").stderr;
    assert_eq!(npy.matches("NumPy").count(), 1, "{npy}");
    folder.bn("analyze outside.txt").refused(2, &["line 2", "--wrap"]);
    folder.bn("analyze unknown.xyz").refused(2, &["--format"]);
    folder.bn("analyze outside.txt --wrap --curve rdf -o outside.txt").refused(2, &["replace"]);
    folder.bn("analyze outside.txt --wrap --curve rdf -o no/c.csv").refused(1, &["no folder no"]);
    folder.bn("analyze absent.txt").refused(2, &["absent.txt"]);
    folder.bn("analyze").refused(2, &["FILE"]);
    folder.bn("analyze .").refused(2, &["."]);
}

#[test]
fn degenerate_sets_have_statistics() {
    let folder = Folder::new();
    let repeated = "0.25 0.75\n".repeat(50);
    let collinear =
        (0..40).fold(String::new(), |text, i| text + &format!("{} 0.5\n", f64::from(i) / 40.0));
    let cases = [
        ("one.txt", "0.5 0.5\n"),
        ("two.txt", "0.5 0.5\n0.5 0.5\n"),
        ("three.txt", "0 0\n0.5 0\n0.99999999999999989 0.5\n"),
        ("equal.txt", &repeated),
        ("collinear.txt", &collinear),
        ("near.txt", "0.5 0.5\n0.50000000000000011 0.5\n1e-300 0\n2e-300 0\n"),
    ];
    for (name, contents) in cases {
        folder.file(name, contents);
        let a = folder.bn(&format!("analyze {name} --average --json")).done().json();
        assert!(a["d_min"].is_number() && a["coverage_radius"].is_number(), "{name}: {a}");
        folder.bn(&format!("analyze {name}")).done();
    }
}

/// The windowed spectrum is the one whose crossing `nu_eff` is; the estimators differ.
#[test]
fn the_method_chooses_the_radial_power() {
    let folder = Folder::new();
    folder.bn("generate jittered -n 1024 -o j.txt").done();
    let rows = |name: &str| {
        let csv = String::from_utf8(folder.read(name)).expect("text");
        let mut lines = csv.lines();
        assert_eq!(lines.next(), Some("nu,power"));
        lines.map(|line| line.split_once(',').expect("a pair").0.parse().unwrap()).collect()
    };
    folder.bn("analyze j.txt --curve radial-power --method windowed -o w.csv").done();
    folder.bn("analyze j.txt --curve radial-power -o d.csv").done();
    let (windowed, direct): (Vec<f64>, Vec<f64>) = (rows("w.csv"), rows("d.csv"));
    // Steps of √n/200 against rings of width 1.
    assert!((windowed[1] - windowed[0] - 0.16).abs() < 1e-12);
    assert!(direct[1] - direct[0] > 0.5);
}

#[test]
fn options_that_contradict_each_other_are_refused() {
    let folder = Folder::new();
    grid(&folder);
    for arguments in [
        "--curve rdf --method direct -o c.csv",
        "--curve anisotropy --method windowed -o c.csv",
        "--curve rdf --power-below 3 -o c.csv",
        "--only nu_eff --method direct",
        "--only omega_direct --method windowed",
        "--only d_min --power-below 3",
        "--power-below 1e5",
    ] {
        folder.bn(&format!("analyze grid.txt {arguments}")).refused(2, &["--"]);
    }
}
