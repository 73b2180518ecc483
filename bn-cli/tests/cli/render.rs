//! `bn render` as scripts call it.

use std::path::Path;

use bn_render::{Channels, Image, PngOptions};

use crate::folder::Folder;

/// Renders a small plate; `words` are further options.
fn plate(folder: &Folder, words: &str) -> serde_json::Value {
    let words = format!("render zone-plate --size 60x40 --pattern jittered -n 256 --json {words}");
    folder.bn(&words).done().json()
}

fn pfm(path: &Path) -> Image {
    let bytes = std::fs::read(path).unwrap();
    bn_render::read_pfm(&bytes[..]).unwrap()
}

#[test]
fn the_account_has_its_keys() {
    let folder = Folder::new();
    let account = plate(&folder, "--spp 6 --reference exact -o plate.png");
    assert_eq!((&account["width"], &account["height"]), (&60.into(), &40.into()));
    assert_eq!(account["spp"], 6.0);
    let samples = account["samples"].as_u64().unwrap();
    // 63 × 43 cells of 6 samples.
    assert!((15_000..17_500).contains(&samples), "{samples}");
    assert_eq!(account["samples_skipped"], 0);
    let (mse, psnr) = (account["mse"].as_f64().unwrap(), account["psnr"].as_f64().unwrap());
    assert!((psnr + 10.0 * mse.log10()).abs() < 1e-9 && psnr > 15.0, "{psnr}");
    assert!(account["seconds"].as_f64().unwrap() >= 0.0);
    assert!(folder.read("plate.png").starts_with(b"\x89PNG"));
    assert!(plate(&folder, "-o plain.png")["psnr"].is_null());
}

#[test]
fn formats_hold_the_same_image() {
    let folder = Folder::new();
    for name in ["a.pfm", "a.exr", "a.png --depth 16", "linear.png --depth 16 --encoding linear"] {
        plate(&folder, &format!("-o {name}"));
    }
    let exact = pfm(&folder.path().join("a.pfm"));
    for (name, tolerance) in [("a.exr", 0.0), ("a.png", 2e-5), ("linear.png", 1e-5)] {
        let read = bn_cli::image_file::read(&folder.path().join(name), None).unwrap();
        for (got, want) in read.values().iter().zip(exact.values()) {
            assert!((got - want.clamp(0.0, 1.0)).abs() <= tolerance || name == "a.exr", "{name}");
            assert!(name != "a.exr" || got == want);
        }
    }
    // The same bytes to standard output, on any number of threads.
    let words = "render zone-plate --size 60x40 --pattern jittered -n 256 -o - --format pfm";
    let one = folder.bn_with(words, &[], &[("RAYON_NUM_THREADS", "1")]).done().stdout;
    let three = folder.bn(&format!("{words} --threads 3")).done().stdout;
    assert_eq!(one, folder.read("a.pfm"));
    assert_eq!(one, three);
}

#[test]
fn a_window_is_cut_from_the_whole() {
    let folder = Folder::new();
    let whole = plate(&folder, "-o whole.pfm");
    let part = plate(&folder, "--crop 33,7,20,25 -o part.pfm");
    assert_eq!((&part["width"], &part["height"]), (&20.into(), &25.into()));
    assert!(part["samples"].as_u64() < whole["samples"].as_u64());
    let (whole, part) =
        (pfm(&folder.path().join("whole.pfm")), pfm(&folder.path().join("part.pfm")));
    for y in 0..25 {
        for x in 0..20 {
            assert_eq!(part.pixel(x, y), whole.pixel(x + 33, y + 7));
        }
    }
}

#[test]
fn references_come_in_three_kinds() {
    let folder = Folder::new();
    let psnr = |words: &str| plate(&folder, words)["psnr"].as_f64();
    let exact = psnr("--frequency 0.3 --spp 16 --reference exact -o a.pfm").unwrap();
    let dense = psnr("--frequency 0.3 --spp 16 --reference 400").unwrap();
    assert!((exact - dense).abs() < 0.1, "{exact} {dense}");
    // An image held against itself: no error, no finite PSNR.
    let same = plate(&folder, "--frequency 0.3 --spp 16 --reference a.pfm --error e.pfm");
    assert_eq!(same["mse"], 0.0);
    assert!(same["psnr"].is_null());
    assert!(pfm(&folder.path().join("e.pfm")).values().iter().all(|&e| e == 0.0));
    let told = folder
        .bn("render zone-plate --size 60x40 --pattern hexagonal --reference a.pfm --error e.png")
        .done();
    assert!(told.text().starts_with("psnr "), "{}", told.text());
    assert!(folder.read("e.png").starts_with(b"\x89PNG"));
    folder
        .bn("render zone-plate --size 30x40 --pattern hexagonal --reference a.pfm")
        .refused(2, &["60×40", "30×40"]);
}

#[test]
fn scenes_are_named_or_read_as_linear_light() {
    let folder = Folder::new();
    // Two halves whose light is 0.2 and 0.8, stored by the sRGB curve.
    let values = (0..64 * 64).map(|i| if i % 64 < 32 { 0.2 } else { 0.8 }).collect();
    let image = Image::new(64, 64, Channels::Grey, values).unwrap();
    let mut bytes = Vec::new();
    bn_render::write_png(&image, &mut bytes, &PngOptions::default()).unwrap();
    folder.file("halves.png", bytes);
    for kind in ["box", "bilinear", "bicubic", "lanczos"] {
        let words = format!(
            "render halves.png --interpolation {kind} --size 128x128 --pattern jittered -n 1024 \
             --spp 16 --kernel box -o small.pfm --json"
        );
        let account = folder.bn(&words).done().json();
        assert!(account["samples_skipped"].as_u64() > Some(0), "{kind}: {account}");
        let small = pfm(&folder.path().join("small.pfm"));
        // Light as it was before it was stored; 8 bits round.
        assert!((small.pixel(16, 64)[0] - 0.2).abs() < 0.003, "{kind}: {:?}", small.pixel(16, 64));
        assert!((small.pixel(96, 64)[0] - 0.8).abs() < 0.003, "{kind}");
    }
    let own_size = folder.bn("render halves.png --pattern halton --json").done().json();
    assert_eq!((&own_size["width"], &own_size["height"]), (&64.into(), &64.into()));
    for scene in ["zone-plate-limited", "checkerboard", "plane-wave", "constant", "sphere"] {
        folder.bn(&format!("render {scene} --size 20x20 --pattern r2 -n 99 -o {scene}.png")).done();
    }
    let level = folder.bn("render constant --level 0.25 --size 9x9 --pattern r2 -n 9 -o c.pfm");
    level.done();
    assert!(pfm(&folder.path().join("c.pfm")).values().iter().all(|&v| v == 0.25));
}

#[test]
fn patterns_are_methods_files_or_supersampling_sets() {
    let folder = Folder::new();
    folder.bn("generate jittered -n 256 --seed 9 -o p.npy").done();
    folder.bn("render sphere --size 30x30 --pattern p.npy -o file.pfm").done();
    folder.bn("render sphere --size 30x30 --pattern jittered -n 256 --seed 9 -o made.pfm").done();
    assert_eq!(folder.read("file.pfm"), folder.read("made.pfm"));
    let words = "render sphere --size 30x30 --pattern dart-throwing -n 256";
    folder.bn(&format!("{words} -O radius=0.5 -o half.pfm")).done();
    folder.bn(&format!("{words} -o full.pfm")).done();
    assert_ne!(folder.read("half.pfm"), folder.read("full.pfm"));
    let mut seen = vec![folder.read("full.pfm")];
    for vary in ["turn", "shift", "both"] {
        folder.bn(&format!("{words} --vary-tiles {vary} -o varied.pfm")).done();
        let varied = folder.read("varied.pfm");
        assert!(!seen.contains(&varied), "{vary}");
        seen.push(varied);
    }
    let words = "render striped-cloth --size 64x64 --json --reference exact";
    let quincunx = folder.bn(&format!("{words} --supersampling quincunx -o q.pfm")).done().json();
    assert_eq!((&quincunx["spp"], &quincunx["kernel"]), (&2.0.into(), &serde_json::Value::Null));
    folder.file(
        "mine.txt",
        "0 0 0.5\n-.5 -.5 .125\n0.5 -0.5 .125 # a corner\n\n-0.5 0.5 0.125\n0.5 0.5 0.125\n",
    );
    folder.bn(&format!("{words} --supersampling mine.txt -o m.pfm")).done();
    assert_eq!(folder.read("q.pfm"), folder.read("m.pfm"));
}

#[test]
fn the_account_and_the_picture_say_how_it_was_made() {
    let folder = Folder::new();
    folder.bn("generate jittered -n 64 --seed 9 -o p.txt").done();
    let account = |words: &str| folder.bn(&format!("{words} --json")).done().json();
    let words = "render zone-plate --frequency 0.4 --size 20x10 --pattern p.txt";
    let varied = account(&format!("{words} --vary-tiles both --seed 7 --kernel box -o a.png"));
    assert_eq!((&varied["seed"], &varied["vary_tiles"]), (&7.into(), &"both".into()));
    assert_eq!(varied["scene_options"], serde_json::json!({"frequency": 0.4}));
    // The file holds what was asked for as well.
    let bytes = folder.read("a.png");
    let reader = png::Decoder::new(std::io::Cursor::new(&bytes[..])).read_info().unwrap();
    let texts = &reader.info().uncompressed_latin1_text;
    let note = texts.iter().find(|text| text.keyword == "Comment").expect("a comment");
    let noted: serde_json::Value = serde_json::from_str(&note.text).unwrap();
    for (key, value) in noted.as_object().unwrap() {
        assert_eq!(*value, varied[key], "{key}");
    }
    assert_eq!((&noted["seed"], &noted["kernel"]), (&7.into(), &"box".into()));
    // Nothing hangs on a seed here.
    let plain = account(words);
    assert_eq!((&plain["seed"], &plain["vary_tiles"]), (&serde_json::Value::Null, &"none".into()));
    assert_eq!(account("render sphere --size 9x9 --pattern jittered -n 9")["seed"], 1);
    // The reference's kernel, where the picture has none.
    let words = "render zone-plate --size 20x10 --supersampling quincunx --kernel gaussian";
    for (reference, key) in [("exact", "change"), ("64", "spp")] {
        let account = account(&format!("{words} --reference {reference}"));
        assert!(account["kernel"].is_null() && account["seed"].is_null(), "{account}");
        assert_eq!(account["reference"]["kernel"], "gaussian");
        assert!(account["reference"][key].is_number(), "{account}");
    }
    let words = "render zone-plate --size 20x10 --pattern p.txt --reconstruct act";
    let fitted = account(&format!("{words} --iterations 4 --border periodic"));
    assert_eq!((&fitted["most_iterations"], &fitted["border"]), (&4.into(), &"periodic".into()));
    assert!(fitted["band"].is_number() && fitted["tolerance"] == 1e-6, "{fitted}");
}

#[test]
fn what_a_scene_is_known_for_is_not_evaluated() {
    let folder = Folder::new();
    let words = "render checkerboard --horizon 0.5 --size 128x128 --pattern fpo -n 256 --json";
    let account = folder.bn(words).done().json();
    let count = |key: &str| account[key].as_u64().unwrap();
    assert!(5 * count("samples_skipped") > count("samples"), "{account}");
    assert_eq!(count("samples_evaluated") + count("samples_skipped"), count("samples"));
}

#[test]
fn bad_use_is_refused_with_a_reason() {
    let folder = Folder::new();
    folder.file("words.png", "no image");
    folder.file("two.dat", "2\n0.1 0.2\n0.3 0.4\n#\n2\n0.1 0.2\n0.3 0.4\n");
    folder.file("one.txt", "2\n0.1 0.2\n0.3 0.4\n");
    folder.file("light.pfm", [&b"Pf\n1 1\n-1\n"[..], &0.5_f32.to_le_bytes()].concat());
    let plate = "render zone-plate --pattern halton -n 64";
    for (words, said) in [
        ("render nosuch --pattern halton -o a.png", "zone-plate"),
        ("render absent.png --pattern halton -o a.png", "absent.png"),
        ("render words.png --pattern halton -o a.png", "words.png"),
        ("render photo.jpg --pattern halton -o a.png", ".png"),
        ("render zone-plate --pattern haltom -o a.png", "halton"),
        ("render zone-plate --pattern absent.txt -o a.png", "absent.txt"),
        ("render zone-plate --pattern two.dat -o a.png", "2 sets"),
        ("render zone-plate --pattern two.dat -n 5 -o a.png", "-n"),
        ("render zone-plate -o a.png", "--pattern"),
        ("render zone-plate --pattern halton -O nosuch=1 -o a.png", "nosuch"),
        ("render zone-plate --pattern halton -O nosuch -o a.png", "radius=0.7"),
        ("render zone-plate --pattern net -n 100 -o a.png", "128"),
        ("render zone-plate --supersampling nosuch -o a.png", "quincunx"),
        ("render zone-plate --supersampling words.png -o a.png", "line 1"),
        ("render zone-plate --supersampling quincunx --spp 4 -o a.png", "--spp"),
        ("render sphere --frequency 2 --pattern halton -o a.png", "--frequency"),
        ("render sphere --interpolation box --pattern halton -o a.png", "--interpolation"),
        // What nothing hangs on is no option.
        ("render zone-plate --pattern one.txt --seed 2 -o a.png", "--seed"),
        ("render zone-plate --supersampling quincunx --seed 2 -o a.png", "--seed"),
        ("render zone-plate --supersampling quincunx --kernel box -o a.png", "--kernel"),
        ("render zone-plate --supersampling quincunx --max-spp 0 -o a.png", "--max-spp"),
        ("render zone-plate --supersampling quincunx --reconstruct act -o a.png", "--reconstruct"),
        ("render light.pfm --scene-encoding linear --pattern one.txt -o a.png", ".png only"),
        // Numbers are looked at before patterns are made or read.
        ("render zone-plate --pattern absent.txt --spp 0 -o a.png", "samples per pixel"),
        (
            "render zone-plate --pattern absent.txt --adaptive 0.1 --max-spp 1e9 -o a.png",
            "samples per pixel",
        ),
        ("render zone-plate --pattern absent.txt --reconstruct act --band 0 -o a.png", "--band 0"),
        ("render zone-plate --pattern absent.txt --reference nan -o a.png", "samples per pixel"),
        ("render zone-plate --pattern absent.txt --reference light.pfm -o a.png", "512×512"),
        ("render zone-plate --pattern absent.txt --reference words -o a.png", "`exact`"),
        ("render zone-plate --pattern . -o a.png", "folder"),
        // What is read stays as it is.
        ("render light.pfm --pattern one.txt -o light.pfm", "replace"),
        ("render zone-plate --pattern one.txt -o ./one.txt --format png", "replace"),
        ("render zone-plate --pattern halton --reference light.pfm --error light.pfm", "replace"),
        #[cfg(unix)]
        ("render zone-plate --supersampling /dev/zero -o a.png", "too long"),
    ] {
        folder.bn(words).refused(2, &[said]);
    }
    for (words, said) in [
        ("", "-o"),
        ("-o a.jpg", ".png"),
        ("-o -", "--format"),
        ("-o - --format png --json", "--json"),
        ("-o a.png --format exr", "--format"),
        ("--reconstruct act --tolerance 1 -o a.png", "--tolerance 1"),
        ("--spp 0 -o a.png", "samples per pixel"),
        ("--spp nan -o a.png", "samples per pixel"),
        ("--spp -3 -o a.png", "samples per pixel"),
        ("--size 0x4 -o a.png", "--size: an image of 0×4"),
        ("--size 4 -o a.png", "640x480"),
        ("--size 99999999x2 -o a.png", "99999999"),
        ("--crop 500,500,100,1 -o a.png", "--crop: a window"),
        ("--kernel nosuch -o a.png", "lanczos2"),
        ("--frequency inf -o a.png", "frequency"),
        ("--error e.png -o a.png", "--reference"),
        ("--error - --reference exact -o a.png", "--error -"),
        ("--error a.png --reference exact -o a.png", "file of its own"),
        ("--error ./a.png --reference exact -o a.png", "file of its own"),
        ("--error e.png --error-gain nan --reference exact", "--error-gain"),
        ("--error e.png --error-gain inf --reference exact", "--error-gain"),
        ("--error e.png --error-gain -1 --reference exact", "--error-gain"),
        ("--error e.pfm --error-gain 2 --reference exact", ".png only"),
        ("--error-gain 2 --reference exact", "--error"),
        ("--depth 16 -o a.pfm", ".png only"),
        ("--encoding linear -o a.pfm", ".png only"),
        ("--depth 16 --json", "--output"),
        ("--encoding linear --json", "--output"),
        ("--format pfm --json", "--output"),
        ("--reference absent.png -o a.png", "absent.png"),
        ("--reference 0 -o a.png", "samples per pixel"),
        ("--size 1048576x1048576 --reference exact --json", "1048576"),
    ] {
        folder.bn(&format!("{plate} {words}")).refused(2, &[said]);
    }
    folder.bn(&format!("{plate} --size 8x8 -o absent/a.png")).refused(1, &["absent"]);
    std::fs::create_dir(folder.path().join("sub.png")).expect("made");
    folder
        .bn(&format!("{plate} --size 8x8 --reference 4 --error sub.png -o a.png"))
        .refused(1, &["folder"]);
    assert_eq!(folder.names(), ["light.pfm", "one.txt", "sub.png", "two.dat", "words.png"]);
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_is_a_failure() {
    let folder = Folder::new();
    for format in ["png", "exr"] {
        let words =
            format!("render zone-plate --pattern halton -n 64 -o /dev/full --format {format}");
        folder.bn(&words).refused(1, &["/dev/full"]);
    }
}
