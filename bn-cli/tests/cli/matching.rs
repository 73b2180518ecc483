//! `bn match` and `bn realize` as scripts call them.

use serde_json::Value;

use crate::folder::Folder;

fn number(object: &Value, key: &str) -> f64 {
    object[key].as_f64().unwrap_or_else(|| panic!("{key} in {object}"))
}

/// A curve file of `count` samples `step` apart.
fn curve(header: &str, count: u32, step: f64, value: impl Fn(f64) -> f64) -> String {
    let line = |i: u32| {
        let x = f64::from(i) * step;
        format!("{x},{}\n", value(x))
    };
    header.to_owned() + "\n" + &(0..count).map(line).collect::<String>()
}

/// A step at 12 cycles per unit; 256 points can have one up to 9.03.
fn too_high() -> String {
    curve("nu,power", 200, 0.25, |nu| f64::from(u8::from(nu >= 12.0)))
}

#[test]
fn the_account_of_a_match_says_what_was_done() {
    let folder = Folder::new();
    let words = "match --target step -n 256 --seed 5 --sets 2 -o s.rps --json";
    let account = folder.bn(words).done().json();
    assert_eq!(account["target"], "step");
    assert_eq!(
        (&account["n"], &account["seed"], &account["sets"]),
        (&256.into(), &5.into(), &2.into())
    );
    assert_eq!(account["options"]["algorithm"], "spectral");
    assert_eq!(account["options"]["best_effort"], false);
    assert_eq!(account["converged"], true);
    assert!(account["iterations"].as_u64().unwrap() > 10);
    assert!(number(&account, "residual") < 0.01 && number(&account, "empty_power") < 1e-4);
    assert_eq!(account["residuals"].as_array().unwrap().len(), 2);
    assert!(number(&account, "seconds") > 0.0);
    assert_eq!(folder.names(), ["s_0.rps", "s_1.rps"]);
    let low = folder.bn("analyze s_0.rps s_1.rps --average --json --power-below 8.5").done().json();
    assert!(number(&low, "power_below") < 1e-4, "{low}");
    folder.bn("match --target step -n 64 --json").refused(2, &["-o"]);
}

#[test]
fn a_match_is_the_method_of_the_registry_on_any_number_of_threads() {
    let folder = Folder::new();
    let one = folder.bn("match --target step -n 128 --seed 3 --threads 1").done();
    let two = folder.bn("match --target step -n 128 --seed 3 --threads 2").done();
    let method = folder.bn("generate step -n 128 --seed 3").done();
    assert!(one.stdout == two.stdout && one.stdout == method.stdout);
    assert!(one.stderr.contains("residual"), "{}", one.stderr);
}

#[test]
fn every_algorithm_can_be_asked_for() {
    let folder = Folder::new();
    for name in ["spectral", "force", "gradient", "annealing"] {
        let words =
            format!("match --target step -n 64 --algorithm {name} --iterations 8 -o a.txt --json");
        let account = folder.bn(&words).done().json();
        assert_eq!(account["options"]["algorithm"], name);
        assert_eq!(account["options"]["iterations"], 8);
        assert!(account["iterations"].as_u64().unwrap() <= 9, "{account}");
    }
    folder.bn("match --target step --algorithm nosuch").refused(2, &["spectral", "annealing"]);
}

#[test]
fn curves_come_by_pipe_too() {
    let folder = Folder::new();
    folder.bn("generate jittered -n 400 -o points.txt").done();
    let piped = folder.bn("analyze points.txt --curve radial-power -o -").done().stdout;
    folder.file("power.csv", &piped);
    let verdict = |words: &str, stdin: &[u8]| {
        let mut verdict = folder.bn_with(words, stdin, &[]).done().json();
        verdict.as_object_mut().expect("an object").remove("target");
        verdict
    };
    let from_file = verdict("realize power.csv -n 400 --json", b"");
    assert_eq!(verdict("realize - -n 400 --json", &piped), from_file);
    assert_eq!(verdict("realize --target - -n 400 --json", &piped), from_file);
    // Points on standard input are judged by their spectrum.
    let points = verdict("realize points.txt --json", b"");
    assert_eq!(verdict("realize - --json", &folder.read("points.txt")), points);
    // What can be read but once and has a name all the same, as in `bn realize <(bn analyze …)`.
    if cfg!(unix) {
        assert_eq!(verdict("realize /dev/stdin -n 400 --json", &piped), from_file);
        assert_eq!(verdict("realize --target /dev/stdin -n 400 --json", &piped), from_file);
        assert_eq!(verdict("realize /dev/stdin --json", &folder.read("points.txt")), points);
        assert_eq!(verdict("realize --like /dev/stdin --json", &folder.read("points.txt")), points);
    }
    let words = "match --target - -n 100 --iterations 2 --best-effort";
    assert_eq!(folder.bn_with(words, &piped, &[]).done().text().lines().count(), 101);
    // What has a header that no curve has is no list of points either.
    folder.file("k.csv", "k,P\n0,1\n1,1\n");
    folder.bn("realize k.csv").refused(2, &["k.csv", "nu_rel,power", "\"k,P\""]);
    folder.bn_with("realize -", b"k,P\n0,1\n", &[]).refused(2, &["standard input", "r,g"]);
    folder.bn_with("match --target -", b"", &[]).refused(2, &["standard input"]);
}

/// The options of an algorithm are those of the method in the registry, and are accounted for.
#[test]
fn algorithms_are_tuned_by_options() {
    let folder = Folder::new();
    let tuned = "-n 128 --range 3 --stages 3 --evaluations 20 --weight-exponent 1";
    let matched = folder.bn(&format!("match --target step {tuned}")).done();
    assert!(matched.stdout == folder.bn(&format!("generate step {tuned}")).done().stdout);
    assert!(matched.stdout != folder.bn("match --target step -n 128").done().stdout);
    assert!(matched.stderr.contains("ended by"), "{}", matched.stderr);
    let account = folder.bn(&format!("match --target step {tuned} -o a.txt --json")).done().json();
    let options = &account["options"];
    assert_eq!((number(options, "range"), number(options, "stages")), (3.0, 3.0));
    assert_eq!((number(options, "evaluations"), number(options, "weight_exponent")), (20.0, 1.0));
    assert!(options["tolerance"].is_null() && options["smoothing"].is_null());

    let words = "match --target step -n 128 --tolerance 0.02 --sets 2 -o a.npy --json";
    let account = folder.bn(words).done().json();
    assert!(number(&account, "residual") <= 0.02, "{account}");
    assert_eq!(account["ended_by"], serde_json::json!(["tolerance", "tolerance"]));
    assert_eq!(account["converged"], true);

    let words = "match --target step -n 64 --algorithm force --patience 3 --iterations 9 -o f.txt";
    let account = folder.bn(&format!("{words} --json")).done().json();
    assert_eq!(
        (&account["options"]["patience"], &account["options"]["range"]),
        (&3.into(), &Value::Null)
    );
    assert_eq!(account["ended_by"], serde_json::json!(["iterations"]));

    for (words, reason) in [
        ("--algorithm force --range 3", "--range: it belongs to --algorithm spectral"),
        ("--algorithm annealing --tolerance 0.1", "--tolerance: it belongs to"),
        ("--cooling 0.5", "--cooling: it belongs to --algorithm force, not to spectral"),
        ("--range 0", "--range is \"0\", but must be a number from 0.1 to 16"),
        ("--stages 2.5", "--stages"),
        ("--tolerance nan", "--tolerance"),
    ] {
        folder.bn(&format!("match --target step -n 64 {words} -o never.txt")).refused(2, &[reason]);
        folder.bn(&format!("generate step -n 64 {words} -o never.txt")).refused(2, &[reason]);
    }
}

/// Named targets with default parameters are made however near they can be; what a user asks for
/// is refused if it can't be had.
#[test]
fn unrealizable_targets_are_refused_with_the_reason() {
    let folder = Folder::new();
    folder.file("high.csv", too_high());
    folder
        .file("negative.csv", curve("nu,power", 100, 0.5, |nu| if nu < 3.0 { -0.5 } else { 1.0 }));
    folder.file("nan.csv", "nu,power\n0,0\n5,nan\n9,1\n");
    folder.file("unsorted.csv", "nu,power\n5,0\n1,1\n");
    folder.file("close.csv", curve("r,g", 100, 1e-3, |r| if r < 0.01 { -1.0 } else { 1.0 }));
    let cases: [(&str, &[&str]); 12] = [
        ("--target high.csv -n 256", &["high.csv", "the RDF would be -", "--best-effort"]),
        ("--target negative.csv -n 256", &["the power would be -0.5", "--best-effort"]),
        ("--target close.csv -n 256", &["--best-effort"]),
        ("--target nan.csv -n 256", &["nan.csv", "value 1 is NaN"]),
        ("--target unsorted.csv -n 256", &["abscissa 1"]),
        ("--target step --nu0 20 -n 256", &["hexagonal", "17.19"]),
        ("--target step --nu0 9.2 -n 256", &["the RDF would be -0.0"]),
        ("--target step --nu0 nan -n 256", &["nu0"]),
        ("--target step --nu0 1 -n 2", &["the RDF would be -0.5708"]),
        ("--target step --nu0 1 -n 4096", &["below 1.000 cycles", "about 3 modes"]),
        ("--target step --nu0 9.02704 -n 256", &["the RDF would be -1.48e-6"]),
        ("--target single-peak --sigma -1 -n 256", &["sigma"]),
    ];
    for (words, reason) in cases {
        folder.bn(&format!("match {words} -o never.txt")).refused(2, reason);
    }
    folder.bn("match --target absent.csv -o never.txt").refused(2, &["absent.csv"]);
    folder.bn("match -o never.txt").refused(2, &["which spectrum"]);
    folder.bn("match --target step --peak 3 -o never.txt").refused(2, &["--peak"]);
    assert!(!folder.names().contains(&"never.txt".to_owned()));
}

#[test]
fn best_effort_comes_near_and_says_how_near() {
    let folder = Folder::new();
    folder.file("high.csv", too_high());
    let words = "match --target high.csv --best-effort -n 256 -o near.txt --json";
    let finished = folder.bn(words).done();
    assert!(finished.stderr.contains("as near as possible"), "{}", finished.stderr);
    let account = finished.json();
    assert_eq!(
        (&account["converged"], &account["options"]["best_effort"]),
        (&false.into(), &true.into())
    );
    let residual = number(&account, "residual");
    assert!((0.01..0.5).contains(&residual), "{residual}");
    // Far beyond every lattice: nothing is near, and nothing goes wrong.
    let words = "match --target step --nu0 20 --best-effort -n 256 -o far.txt --json";
    assert!(number(&folder.bn(words).done().json(), "residual") > residual);
    // The named targets go as near as they can unasked.
    let finished = folder.bn("match --target single-peak -n 256 -o p.txt").done();
    assert!(finished.stderr.contains("as near as possible"), "{}", finished.stderr);
}

/// What a curve says is judged and matched as it is, and 1 beyond its end; that is told.
#[test]
fn curves_that_end_early_are_told_of() {
    let folder = Folder::new();
    // Steps at 0.99 and 1.01 of √(256/π) = 9.027, of which the curves have only the lower side.
    folder.file("low.csv", "nu,power\n0,0\n8.937,0\n");
    folder.file("high.csv", "nu,power\n0,0\n9.117,0\n");
    let account = folder.bn("match --target low.csv -n 256 -o a.txt --json").done();
    assert!(
        account.stderr.contains("warning: the power is still 1.0000 away"),
        "{}",
        account.stderr
    );
    let account = account.json();
    assert!(account["warnings"][0].as_str().unwrap().contains("at 8.937 cycles"), "{account}");
    assert!(number(&account, "residual") < 0.01 && number(&account, "empty_power") < 1e-4);
    let reason = ["the RDF would be -0.0", "the power is still", "counts as 1 beyond"];
    folder.bn("match --target high.csv -n 256 -o b.txt").refused(2, &reason);
    for (file, want) in [("low.csv", true), ("high.csv", false)] {
        let verdict = folder.bn(&format!("realize {file} -n 256 --json")).done().json();
        assert_eq!(verdict["realizable"], want, "{verdict}");
        let warning = verdict["warnings"][0].as_str().unwrap();
        assert!(warning.contains("counts as 1 beyond"), "{warning}");
    }
    folder.file("settled.csv", "nu,power\n0,0\n8.9,0\n8.91,1\n9,1\n");
    let account = folder.bn("match --target settled.csv -n 256 -o a.txt --json").done().json();
    assert_eq!(account["warnings"], serde_json::json!([]));
}

/// The curves that `analyze` writes are targets, and lead back to themselves.
#[test]
fn curves_that_were_written_can_be_read() {
    let folder = Folder::new();
    folder.bn("generate jittered -n 400 --sets 20 -o j.npy").done();
    folder.bn("analyze j.npy --average --curve radial-power -o p.csv").done();
    let account =
        folder.bn("match --target p.csv -n 400 -o a.txt --json --best-effort").done().json();
    let like = folder.bn("match --like j.npy -o b.txt --json").done().json();
    for account in [&account, &like] {
        assert_eq!(account["n"], 400);
        // The model's own rings are known to about 0.02.
        assert!(number(account, "residual") < 0.02, "{account}");
    }
    // Relative frequencies fit any number of points.
    folder.file("step.csv", curve("nu_rel,power", 400, 0.01, |nu| f64::from(u8::from(nu >= 1.0))));
    for n in [144, 400] {
        let words = format!("match --target step.csv -n {n} -o r.txt --json");
        assert!(number(&folder.bn(&words).done().json(), "residual") < 0.02, "{n}");
    }
    // What another number of points has, scaled.
    assert_eq!(folder.bn("match --like j.npy -n 200 -o c.txt --json").done().json()["n"], 200);
    folder.bn("generate stochastic -n 10 -o few.txt").done();
    folder.bn("match --like j.npy few.txt -o d.txt").refused(2, &["one size"]);
    folder.bn("match --like j.npy --target step").refused(2, &["--target"]);
}

#[test]
fn more_points_than_a_run_can_hold_are_refused() {
    let folder = Folder::new();
    for words in ["match --target step", "generate step"] {
        let words = format!("{words} -n 10000 --sets 20001 --iterations 0 -o never.npy");
        folder.bn(&words).refused(2, &["20001 sets of 10000 points", "200000000", "several runs"]);
    }
    // As many as the models have.
    folder.bn("generate stochastic -n 3000 -o model.rps").done();
    folder.bn("match --like model.rps --sets 70000 -o never.npy").refused(2, &["3000 points"]);
}

#[test]
fn a_match_goes_on_from_a_file() {
    let folder = Folder::new();
    folder.bn("generate jittered -n 100 -o start.npy").done();
    folder.bn("match --target step -n 100 --start start.npy --iterations 0 -o same.npy").done();
    let text = |name: &str| -> Vec<f64> {
        let text = folder.bn(&format!("convert {name} -")).done().text();
        text.split_whitespace().skip(1).map(|word| word.parse().unwrap()).collect()
    };
    let (before, after) = (text("start.npy"), text("same.npy"));
    assert_eq!(before.len(), 200);
    assert!(before.iter().zip(&after).all(|(a, b)| (a - b).abs() < 1e-12));
    folder.bn("match --target step -n 99 --start start.npy -o x.txt").refused(2, &["99"]);
}

#[test]
fn a_start_is_one_set_and_makes_several_only_with_random_numbers() {
    let folder = Folder::new();
    folder.bn("generate jittered -n 64 --sets 2 -o two.npy").done();
    folder.bn("generate jittered -n 64 -o one.npy").done();
    let words = "match --target step -n 64 --iterations 4 -o x.npy";
    folder.bn(&format!("{words} --start two.npy")).refused(2, &["two.npy", "2 sets"]);
    for name in ["spectral", "force", "gradient"] {
        let several = format!("{words} --start one.npy --algorithm {name}");
        folder.bn(&format!("{several} --sets 2")).refused(2, &["--start", "equal", "annealing"]);
        folder.bn(&several).done();
    }
    folder.bn(&format!("{words} --start one.npy --algorithm annealing --sets 2")).done();
    folder.bn("convert x.npy set-{i}.rps").done();
    assert_ne!(folder.read("set-0.rps"), folder.read("set-1.rps"));
}

#[test]
fn realizability_has_its_contract_keys() {
    let folder = Folder::new();
    // ν_max = √(400/π) = 11.284.
    for (nu0, want) in [(11.17, true), (11.28, true), (11.40, false)] {
        let verdict =
            folder.bn(&format!("realize --target step -n 400 --nu0 {nu0} --json")).done().json();
        assert_eq!(verdict["realizable"], want, "{verdict}");
        assert_eq!(number(&verdict, "min_power"), 0.0);
        assert!(
            (number(&verdict, "min_g") - (1.0 - nu0 * nu0 * std::f64::consts::PI / 400.0)).abs()
                < 1e-9
        );
        assert_eq!(number(&verdict, "at_r"), 0.0);
        assert!(verdict["at_nu"].is_number() && verdict["warnings"].is_array());
        assert_eq!(verdict["reason"].is_null(), want);
    }
    let far = folder.bn("realize --target step -n 400 --nu0 30 --json").done().json();
    assert!(
        far["warnings"]
            .as_array()
            .unwrap()
            .iter()
            .any(|w| w.as_str().unwrap().contains("hexagonal"))
    );
    let text = folder.bn("realize --target single-peak").done().text();
    assert!(
        text.starts_with("not realizable: the RDF would be -0.") && text.contains("36.108"),
        "{text}"
    );
}

#[test]
fn files_are_judged_as_curves_or_as_points() {
    let folder = Folder::new();
    folder.file("high.csv", too_high());
    let verdict = folder.bn("realize high.csv -n 256 --json").done().json();
    assert_eq!(verdict["realizable"], false);
    // Points exist: their spectrum is realizable, whatever their number.
    for method in ["stochastic", "regular"] {
        folder.bn(&format!("generate {method} -n 256 -o {method}.rps")).done();
        let verdict = folder.bn(&format!("realize {method}.rps --json")).done().json();
        assert_eq!(
            (&verdict["realizable"], &verdict["n"]),
            (&true.into(), &256.into()),
            "{verdict}"
        );
    }
    folder.bn("realize absent.csv").refused(2, &["absent.csv"]);
    folder.bn("realize high.csv --target step").refused(2, &["--target"]);
    folder.bn("realize").refused(2, &["which spectrum"]);
}
