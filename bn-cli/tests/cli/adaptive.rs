//! `bn render --adaptive` as scripts call it.

use serde_json::Value;

use crate::folder::Folder;

/// Renders a board whose upper half is sky; `words` are further options.
fn board(folder: &Folder, words: &str) -> Value {
    let words = format!(
        "render checkerboard --horizon 0.5 --size 96x80 --pattern jittered -n 1024 --json {words}"
    );
    folder.bn(&words).done().json()
}

fn number(account: &Value, key: &str) -> f64 {
    account[key].as_f64().unwrap_or_else(|| panic!("no {key} in {account}"))
}

#[test]
fn the_error_asked_for_is_reached_and_told() {
    let folder = Folder::new();
    let account = board(&folder, "--adaptive 0.03 --reference exact -o a.pfm");
    assert_eq!(number(&account, "error_target"), 0.03);
    let (stated, truth) = (number(&account, "error_estimated"), number(&account, "error_true"));
    assert!(stated <= 0.03 && number(&account, "error_worst") <= 0.03);
    assert!((0.4..1.5).contains(&(truth / stated)), "{truth} {stated}");
    assert!((truth * truth - number(&account, "mse")).abs() < 1e-12);
    assert_eq!((&account["spp"], &account["max_spp"]), (&4.0.into(), &1100.0.into()));
    assert_eq!((&account["blocks"], &account["blocks_unresolved"]), (&(24 * 20).into(), &0.into()));
    let refined = account["blocks_refined"].as_u64().unwrap();
    assert!((60..300).contains(&refined), "{refined}");
    let (all, pilot) = (number(&account, "samples"), number(&account, "pilot_samples"));
    assert!(pilot >= 4.0 * 96.0 * 80.0 && all > pilot);
    assert!((number(&account, "spp_mean") - all / (96.0 * 80.0)).abs() < 1e-9);
    assert!(account["samples_skipped"].as_u64() > Some(0), "the sky is known");
    // Without a reference nothing is known of the true error; without --adaptive there are no such keys.
    assert!(board(&folder, "--adaptive 0.02")["error_true"].is_null());
    assert!(board(&folder, "-o b.pfm").get("error_target").is_none());
}

#[test]
fn threads_and_windows_give_the_same_bytes() {
    let folder = Folder::new();
    let words = "render sphere --size 150x140 --pattern fpo -n 256 --spp 3 --adaptive 0.03 -q";
    folder.bn(&format!("{words} --threads 1 -o one.pfm")).done();
    folder.bn(&format!("{words} --threads 3 -o three.pfm")).done();
    assert_eq!(folder.read("one.pfm"), folder.read("three.pfm"));
    folder.bn(&format!("{words} --crop 120,100,20,40 -o part.pfm")).done();
    let read = |name: &str| bn_render::read_pfm(&folder.read(name)[..]).unwrap();
    let (whole, part) = (read("one.pfm"), read("part.pfm"));
    for (x, y) in [(0, 0), (19, 0), (7, 28), (19, 39)] {
        assert_eq!(part.pixel(x, y), whole.pixel(x + 120, y + 100));
    }
}

#[test]
fn budgets_end_and_are_told() {
    let folder = Folder::new();
    let account = board(&folder, "--adaptive 0.0001 --max-spp 8");
    assert!(account["blocks_unresolved"].as_u64() > Some(100), "{account}");
    assert!(number(&account, "error_estimated") > 0.0001);
    let told = folder.bn(
        "render checkerboard --size 40x40 --pattern jittered -n 64 --adaptive 0.0001 --max-spp 8 -o a.png",
    );
    let told = told.done().stderr;
    assert!(told.contains("estimated error") && told.contains("--max-spp 8"), "{told}");
}

#[test]
fn senseless_requests_are_refused() {
    let folder = Folder::new();
    let refused = |words: &str, parts: &[&str]| {
        let words = format!("render sphere --size 20x20 {words} -o a.png");
        folder.bn(&words).refused(2, parts);
    };
    for error in ["0", "-1", "nan", "inf"] {
        refused(&format!("--pattern r2 -n 16 --adaptive {error}"), &["--adaptive", "positive"]);
    }
    refused("--pattern r2 -n 16 --adaptive 0.1 --max-spp 2", &["--max-spp 2", "4"]);
    refused("--pattern r2 -n 16 --adaptive 0.1 --max-spp nan", &["--max-spp"]);
    refused("--pattern r2 -n 16 --adaptive 0.1 --max-spp 1e9", &["samples per pixel"]);
    refused("--pattern r2 -n 16 --max-spp 9", &["--adaptive"]);
    refused("--supersampling quincunx --adaptive 0.1", &["--adaptive", "--supersampling"]);
    assert!(folder.names().is_empty());
}
