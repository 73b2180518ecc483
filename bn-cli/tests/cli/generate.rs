//! `bn generate`, `bn list` and `bn convert` as scripts call them.

use crate::folder::Folder;

#[test]
fn one_set_goes_to_standard_output_as_psa_reads_it() {
    let text = Folder::new().bn("generate stochastic -n 5 --seed 3").done().text();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), 6, "{text}");
    assert_eq!(lines[0], "5");
    assert!(lines[1..].iter().all(|line| line.split(' ').count() == 2), "{text}");
}

#[test]
fn several_sets_split_where_the_format_holds_one() {
    let folder = Folder::new();
    folder.bn("generate stochastic -n 64 --sets 3 -o s.rps").done();
    assert_eq!(folder.names(), ["s_0.rps", "s_1.rps", "s_2.rps"]);
    assert_eq!(folder.read("s_2.rps").len(), 512);
    folder.bn("generate stochastic -n 64 --sets 3 -o all.npy").done();
    folder.bn("generate stochastic -n 64 --sets 2 -o set-{i}.txt").done();
    folder.bn("generate stochastic -n 64 -o alone.rps").done();
    assert_eq!(
        folder.names(),
        ["all.npy", "alone.rps", "s_0.rps", "s_1.rps", "s_2.rps", "set-0.txt", "set-1.txt"]
    );
    // Set 0 is what one set alone is, and the sets differ.
    assert_eq!(folder.read("alone.rps"), folder.read("s_0.rps"));
    assert_ne!(folder.read("s_0.rps"), folder.read("s_1.rps"));
    folder.bn("convert all.npy back.rps").done();
    assert_eq!(folder.read("back_1.rps"), folder.read("s_1.rps"));
}

#[test]
fn several_sets_can_be_piped() {
    let folder = Folder::new();
    let sets = folder.bn("generate stochastic -n 16 --sets 2").done().stdout;
    let analyses = folder.bn_with("analyze - --json --only d_avg", &sets, &[]).done().json();
    assert_eq!(analyses[0]["sets"], 2);
    assert_eq!(analyses[0]["points"], 16);
}

#[test]
fn the_account_says_what_was_done() {
    let folder = Folder::new();
    let account = folder.bn("generate jittered -n 100 --seed 7 -o j.txt --json").done().json();
    assert_eq!(account["method"], "jittered");
    assert_eq!(account["seed"], 7);
    assert!(account["seconds"].as_f64().unwrap() >= 0.0);
    assert!(account["options"].is_object());
    folder.bn("generate jittered -n 100 --json").refused(2, &["-o"]);
}

#[test]
fn every_method_gives_the_same_bytes_on_any_number_of_threads() {
    let folder = Folder::new();
    let list = folder.bn("list --json").done().json();
    for method in list.as_array().unwrap() {
        let name = method["name"].as_str().unwrap();
        let words = format!("generate {name} -n 256 --seed 3");
        let one = folder.bn_with(&words, &[], &[("RAYON_NUM_THREADS", "1")]).done();
        let two = folder.bn(&format!("{words} --threads 2")).done();
        assert_eq!(one.stdout, two.stdout, "{name}");
    }
}

#[test]
fn kernels_scenes_and_supersampling_sets_are_listed() {
    let folder = Folder::new();
    let kernels = folder.bn("list kernels --json").done().json();
    let tent = kernels.as_array().unwrap().iter().find(|k| k["name"] == "tent").unwrap();
    assert_eq!((&tent["radius"], &tent["integral"]), (&1.0.into(), &1.0.into()));
    // Bilinear interpolation: 1 − cos²(π/4), from one sample a pixel.
    let error = tent["errors"][1]["error"].as_f64().unwrap();
    assert!((error - 0.5).abs() < 1e-8, "{error}");
    assert!(
        folder
            .bn("list kernels")
            .done()
            .text()
            .contains("\ntent           1  1.000000     0.0955     0.5000")
    );
    let scenes = folder.bn("list scenes").done().text();
    assert!(scenes.contains("zone-plate ") && scenes.contains("a ray-traced sphere"));
    let sets = folder.bn("list supersampling --json").done().json();
    let lanczos = sets.as_array().unwrap().iter().find(|k| k["name"] == "lanczos2").unwrap();
    // Thesis section 3.1: 289 weights, shared so that a pixel costs 16 samples.
    assert_eq!(
        (&lanczos["samples_per_pixel"], &lanczos["weights_per_pixel"]),
        (&16.into(), &289.into())
    );
    assert!(
        folder.bn("list supersampling").done().text().contains("\nquincunx            2    5\n")
    );
    folder.bn("list colours").refused(2, &["colours", "kernels"]);
}

#[test]
fn help_tells_options_and_sources() {
    let help = Folder::new().bn("generate jittered --help").done().text();
    for word in ["--width", "Heck 2013", "Example", "--seed"] {
        assert!(help.contains(word), "no {word} in {help}");
    }
}

#[test]
fn bad_use_is_said_in_one_line() {
    let folder = Folder::new();
    folder.bn("generate nosuch").refused(2, &["nosuch"]);
    folder.bn("generate stochastik -n 4").refused(2, &["stochastic"]);
    folder.bn("generate stochastic -n 0").refused(2, &["-n"]);
    folder.bn("generate stochastic -n 99999999999999999").refused(2, &["100000000"]);
    folder
        .bn("generate stochastic -n 100000000 --sets 1000 -o a.npy")
        .refused(2, &["several runs"]);
    folder.bn("generate regular -n 5").refused(2, &["-n 4"]);
    folder.bn("generate jittered --width -1").refused(2, &["--width"]);
    folder.bn("generate jittered --width nan").refused(2, &["--width"]);
    folder.bn("generate stochastic -o points.xyz").refused(2, &["points.xyz", "txt"]);
    folder.bn("generate stochastic -o absent/points.txt").refused(1, &["absent/points.txt"]);
    folder.bn("generate stochastic --density x+").refused(2, &["x+", "numbers such as 0.001"]);
    folder.bn("--threads 0 list").refused(2, &["--threads"]);
    folder.bn("convert absent.txt out.npy").refused(2, &["absent.txt"]);
    assert!(folder.names().is_empty(), "{:?}", folder.names());
}

#[cfg(unix)]
#[test]
fn a_full_disk_is_a_failure() {
    Folder::new()
        .bn("generate stochastic -n 64 -o /dev/full --format txt")
        .refused(1, &["/dev/full"]);
}

#[cfg(unix)]
#[test]
fn remarks_that_nobody_can_read_stop_nothing() {
    use std::process::Command;
    let folder = Folder::new();
    let full = std::fs::File::options().write(true).open("/dev/full").unwrap();
    let status = Command::new(env!("CARGO_BIN_EXE_bn"))
        .args(["generate", "maximal-poisson-disk", "-n", "64", "-o", "a.txt"])
        .current_dir(folder.path())
        .stderr(full)
        .status()
        .unwrap();
    assert_eq!(status.code(), Some(0));
    assert_eq!(folder.names(), ["a.txt"]);
}

#[cfg(target_os = "linux")]
#[test]
fn signals_leave_no_temporary_file() {
    use std::process::{Command, Stdio};
    use std::time::{Duration, Instant};
    for signal in ["INT", "TERM", "HUP"] {
        let folder = Folder::new();
        let mut child = Command::new(env!("CARGO_BIN_EXE_bn"))
            .args(["generate", "r2", "-n", "20000000", "-o", "a.txt"])
            .current_dir(folder.path())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        // Until it writes; some seconds of writing follow.
        let start = Instant::now();
        while folder.names().is_empty() && start.elapsed() < Duration::from_secs(60) {
            std::thread::sleep(Duration::from_millis(2));
        }
        assert!(folder.names()[0].starts_with(".bn-"), "{:?}", folder.names());
        let kill = ["-s", signal, "--", &child.id().to_string()].map(str::to_owned);
        assert!(Command::new("kill").args(kill).status().unwrap().success());
        assert_eq!(child.wait().unwrap().code(), Some(130), "{signal}");
        assert!(folder.names().is_empty(), "{signal}: {:?}", folder.names());
    }
}

#[test]
fn what_ends_early_or_repeats_itself_is_told() {
    let folder = Folder::new();
    let early = folder.bn("generate lloyd -n 64 --iterations 2 -o l.txt").done();
    assert!(early.stderr.contains("2 iterations without having converged"), "{}", early.stderr);
    let early = folder.bn("generate lloyd -n 64 --iterations 2 --sets 3 -o l.npy").done();
    assert!(early.stderr.contains("3 of 3 sets"), "{}", early.stderr);
    let equal = folder.bn("generate regular -n 64 --sets 2 -o r.npy").done();
    assert!(equal.stderr.contains("all sets are equal"), "{}", equal.stderr);
    assert_eq!(folder.bn("generate stochastic -n 9 --sets 2 -o s.npy").done().stderr, "");
}

#[test]
fn a_closed_pipe_is_quiet() {
    use std::process::{Command, Stdio};
    let mut child = Command::new(env!("CARGO_BIN_EXE_bn"))
        .args(["generate", "stochastic", "-n", "100000"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert!(output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn conversions_keep_every_bit() {
    let folder = Folder::new();
    folder.bn("generate jittered -n 100 --seed 9 -o a.npy").done();
    folder.bn("generate jittered -n 100 --seed 9 -o f.rps").done();
    for extension in ["txt", "dat", "csv", "json", "eps"] {
        folder.bn(&format!("convert a.npy b.{extension}")).done();
        folder.bn(&format!("convert b.{extension} c.npy")).done();
        assert_eq!(folder.read("c.npy"), folder.read("a.npy"), "{extension}");
        folder.bn(&format!("convert f.rps g.{extension}")).done();
        folder.bn(&format!("convert g.{extension} g.rps")).done();
        assert_eq!(folder.read("g.rps"), folder.read("f.rps"), "{extension}");
    }
}
