//! `bn render --reconstruct` and `--weights`.

use crate::folder::Folder;

/// An image with a band, from 1024 points.
fn wave(folder: &Folder, words: &str) -> serde_json::Value {
    let words =
        format!("render plane-wave --frequency 0.3 --angle 35 --size 64x64 -n 1024 --json {words}");
    folder.bn(&words).done().json()
}

/// Whatever the pixels can show, up to near their Nyquist frequency along both axes.
#[test]
fn act_reaches_80_db_over_the_pixels_whole_band() {
    let folder = Folder::new();
    for scene in ["plane-wave --frequency 0.48", "plane-wave --frequency 0.65 --angle 45"] {
        for pattern in ["fpo", "jittered"] {
            let words = format!(
                "render {scene} --size 64x64 -n 1024 --pattern {pattern} --spp 4 --reconstruct act \
                 --reference exact --json -o a.pfm"
            );
            let account = folder.bn(&words).done().json();
            assert!(account["psnr"].as_f64() > Some(80.0), "{account}");
            assert!(account["iterations"].as_u64() <= Some(30), "{account}");
        }
    }
}

#[test]
fn band_limited_images_reach_80_db_from_farthest_points_at_4_spp() {
    let folder = Folder::new();
    for pattern in ["fpo", "jittered"] {
        let words = format!("--pattern {pattern} --spp 4 --reference exact -o {pattern}.pfm");
        let account = wave(&folder, &format!("{words} --reconstruct act"));
        assert!(account["psnr"].as_f64() > Some(80.0), "{account}");
        assert!(account["iterations"].as_u64() <= Some(30), "{account}");
        assert_eq!((&account["converged"], &account["reconstruct"]), (&true.into(), &"act".into()));
        assert!(
            account["residual"].as_f64() < Some(1e-6) && account["condition"].as_f64() > Some(1.0)
        );
        assert_eq!(account["weights"], "voronoi");
        assert!((account["band"].as_f64().unwrap() - 7.0 / 12.0).abs() < 1e-12);
        assert!(account["normalize"].is_null());
        let slow =
            wave(&folder, &format!("{words} --reconstruct pocs --iterations 5 --tolerance 0"));
        assert_eq!((&slow["iterations"], &slow["converged"]), (&5.into(), &false.into()));
        assert_eq!(slow["residuals"][0].as_array().map(Vec::len), Some(5));
        assert!(slow["psnr"].as_f64() < account["psnr"].as_f64());
        let plain = wave(&folder, &words);
        assert!(plain["psnr"].as_f64() < Some(60.0) && plain["reconstruct"] == "convolution");
        assert!(plain.get("iterations").is_none(), "{plain}");
    }
}

#[test]
fn periodic_scenes_are_exact_up_to_their_border() {
    let folder = Folder::new();
    // 29 periods over 64 pixels: near the end of the band, where fading would leave its traces.
    let words = "render plane-wave --frequency 0.453125 --size 64x64 --pattern jittered -n 4096 \
                 --reconstruct act --reference exact --json";
    let psnr =
        |more: &str| folder.bn(&format!("{words} {more}")).done().json()["psnr"].as_f64().unwrap();
    let (periodic, faded) = (psnr("--border periodic"), psnr("--border fade --band 0.5"));
    assert!(periodic > 90.0 && faded < periodic - 20.0, "{periodic} {faded}");
    // By default the band has room for what fading spreads.
    let usual = psnr("--border fade");
    assert!(usual > 90.0, "{usual}");
}

#[test]
fn areas_weigh_samples() {
    let folder = Folder::new();
    let words = "render constant --level 0.5 --size 40x40 --pattern stochastic -n 900 --spp 4 \
                 --normalize none --kernel gaussian --reference exact --json";
    let account = |more: &str| folder.bn(&format!("{words} {more}")).done().json();
    let (equal, weighted) = (account("--weights equal"), account("--weights voronoi"));
    assert_eq!((&equal["weights"], &weighted["weights"]), (&"equal".into(), &"voronoi".into()));
    let psnr = |account: &serde_json::Value| account["psnr"].as_f64().unwrap();
    assert!(psnr(&weighted) > psnr(&equal) + 6.0, "{equal} {weighted}");
    assert_eq!(psnr(&equal), psnr(&account("")));
}

#[test]
fn shortfalls_are_told() {
    let folder = Folder::new();
    let words = "render sphere --size 30x30 --pattern stochastic -n 256 --reconstruct act -o a.pfm";
    let few = folder.bn(&format!("{words} --spp 1 --band 0.7 --iterations 3")).done();
    assert!(few.stderr.contains("fewer samples") && few.stderr.contains("after 3 iterations"));
    let quiet = folder.bn(&format!("{words} --spp 4 --iterations 200")).done();
    assert!(quiet.stderr.is_empty(), "{}", quiet.stderr);
}

#[test]
fn windows_are_cut_from_the_whole() {
    let folder = Folder::new();
    let words = "render sphere --size 48x40 --pattern jittered -n 256 --reconstruct act";
    folder.bn(&format!("{words} -o whole.pfm")).done();
    folder.bn(&format!("{words} --crop 9,11,20,8 -o part.pfm")).done();
    let read = |name: &str| bn_render::read_pfm(&folder.read(name)[..]).unwrap();
    let (whole, part) = (read("whole.pfm"), read("part.pfm"));
    for (y, x) in (0..8).flat_map(|y| (0..20).map(move |x| (y, x))) {
        assert_eq!(part.pixel(x, y), whole.pixel(x + 9, y + 11));
    }
}

#[test]
fn senseless_combinations_are_refused() {
    let folder = Folder::new();
    for (words, said) in [
        ("--pattern halton --reconstruct nosuch", "act"),
        ("--pattern halton --iterations 3", "--reconstruct"),
        ("--pattern halton --band 0.4", "--reconstruct"),
        ("--pattern halton --border periodic", "--reconstruct"),
        ("--pattern halton --tolerance 0.4 --reconstruct convolution", "--reconstruct"),
        ("--pattern halton --reconstruct act --tolerance nan", "--tolerance"),
        ("--pattern halton --reconstruct act --tolerance -1", "--tolerance"),
        ("--pattern halton --reconstruct act --band 0", "band"),
        ("--pattern halton --reconstruct act --band inf", "band"),
        ("--pattern halton --reconstruct act --normalize none", "--normalize"),
        ("--pattern halton --reconstruct pocs --size 9000x9000", "smaller image"),
        ("--pattern halton --reconstruct act --spp 30000", "fewer samples"),
        ("--pattern halton --reconstruct act --vary-tiles turn", "--weights equal"),
        ("--pattern halton --weights voronoi --vary-tiles shift", "--weights equal"),
        ("--supersampling quincunx --reconstruct act", "--supersampling"),
        ("--supersampling quincunx --weights voronoi", "--weights"),
    ] {
        let n = if words.contains("halton") { "-n 64" } else { "" };
        folder.bn(&format!("render zone-plate {words} {n} -o a.png")).refused(2, &[said]);
    }
    // Sizes are looked at before patterns are read.
    let long = "render zone-plate --size 20000x64 --pattern nosuch.txt --reconstruct act -o a.png";
    folder.bn(long).refused(2, &["smaller image"]);
    assert!(folder.names().is_empty());
    folder
        .bn("render zone-plate --size 20x20 --pattern halton -n 64 --reconstruct act \
             --vary-tiles turn --weights equal -o a.png")
        .done();
}
