//! `bn report`.

use crate::folder::Folder;

#[cfg(feature = "report")]
#[test]
fn pages_are_drawn_for_few_points_and_many() {
    let folder = Folder::new();
    for n in [1, 16, 300] {
        folder.bn(&format!("generate stochastic -n {n} --sets 2 -o s.npy")).done();
        folder.bn("report s.npy -o page.png --width 600").done();
        folder.bn("report s.npy -o page.svg --title A&B").done();
        assert!(folder.read("page.png").starts_with(b"\x89PNG"), "{n}");
        assert!(folder.read("page.svg").starts_with(b"<svg"), "{n}");
    }
    let first = folder.read("page.png");
    folder.bn("report s.npy -o page.png --width 600").done();
    assert_eq!(folder.read("page.png"), first);
}

#[cfg(feature = "report")]
#[test]
fn pages_of_other_kinds_are_refused() {
    let folder = Folder::new();
    folder.bn("generate stochastic -n 16 -o s.txt").done();
    folder.bn("report s.txt -o page.pdf").refused(2, &["page.pdf", ".png"]);
    folder.bn("report s.txt -o page.png --range 0").refused(2, &["--range"]);
    folder.bn("report s.txt -o page.svg --width 500").refused(2, &["--width"]);
    // Before any point is read.
    folder.bn("report nosuch.txt -o nosuch/page.png").refused(1, &["nosuch/page.png", "folder"]);
    assert_eq!(folder.names(), ["s.txt"]);
}
