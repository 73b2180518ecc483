//! Point sets whose statistics an independent program computed; see data/README.md.

use bn_core::{PointSet, io};
use bn_geometry::{Coverage, Spacing, Triangulation, bond_orientational_order};

const VALUES: &str = include_str!("../data/values.csv");

fn read(name: &str) -> PointSet {
    let path = format!("{}/tests/data/{name}", env!("CARGO_MANIFEST_DIR"));
    let read = io::read_path(path.as_ref(), None, io::ReadOptions { wrap: true });
    let [set] = <[PointSet; 1]>::try_from(read.expect("valid").into_sets()).expect("one set");
    set
}

#[test]
fn statistics_agree_with_an_independent_program() {
    let mut compared = 0;
    for line in VALUES.lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let set = read(fields[0]);
        assert_eq!(set.len().to_string(), fields[1]);
        let unit = set.density().hexagonal_spacing();
        let triangulation = Triangulation::new(&set);
        triangulation.sanity_check();
        let spacing = Spacing::new(&set);
        let coverage = Coverage::of(&triangulation).expect("not empty");
        let order = bond_orientational_order(&triangulation, 6).expect("not empty");
        // Printed with four decimals.
        let ours = [spacing.min() / unit, spacing.mean() / unit, coverage.radius / unit, order];
        for (ours, theirs) in ours.into_iter().zip(&fields[2..6]) {
            if let Ok(theirs) = theirs.parse::<f64>() {
                assert!((ours - theirs).abs() < 0.6e-4, "{}: {ours}, not {theirs}", fields[0]);
                compared += 1;
            }
        }
    }
    assert_eq!(compared, 23);
}

#[test]
fn the_square_lattice_has_the_order_of_the_thesis() {
    let triangulation = Triangulation::new(&read("grid_0.rps"));
    let order = bond_orientational_order(&triangulation, 6).expect("not empty");
    assert!((order - 1.0 / 3.0).abs() < 1e-12, "{order}");
}
