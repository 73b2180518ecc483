//! Pieces of pictures: triangulations, circles, maps of distances.

use std::f64::consts::TAU;

use bn_cli::plot::{Axis, Panel, Picture, Series, Text};
use bn_core::{CellGrid, DVec2, PointSet};
use bn_geometry::Triangulation;

/// Ends a line.
const GAP: [f64; 2] = [f64::NAN; 2];

/// An empty panel that shows the unit square.
pub(super) fn square(title: &str) -> Panel {
    Panel::new(Axis::blank(), Axis::blank()).titled(Text::math(title))
}

/// Points as markers.
pub(super) fn markers(points: impl IntoIterator<Item = DVec2>) -> Series {
    Series::new(points.into_iter().map(|p| [p.x, p.y])).without_line()
}

/// All edges of a triangulation.
pub(super) fn edges(triangulation: &Triangulation) -> Series {
    let sides = triangulation.faces().flat_map(|face| {
        [(0, 1), (1, 2), (2, 0)].map(|(i, j)| {
            // Of an edge's two sides one: dashes drawn twice would look broken.
            let is_first = face.vertices[i] <= face.vertices[j];
            is_first.then(|| copies(&[face.corners[i], face.corners[j]]))
        })
    });
    Series::new(sides.flatten().flatten())
}

/// The sides of some faces.
pub(super) fn triangles(corners: impl IntoIterator<Item = [DVec2; 3]>) -> Series {
    Series::new(corners.into_iter().flat_map(outline))
}

fn outline([a, b, c]: [DVec2; 3]) -> Vec<[f64; 2]> {
    copies(&[a, b, c, a])
}

/// Circles of one radius.
pub(super) fn circles(centres: impl IntoIterator<Item = DVec2>, radius: f64) -> Series {
    let shape = move |centre: DVec2| {
        let at = |i: i32| {
            let (sin, cos) = libm::sincos(TAU * f64::from(i) / 96.0);
            centre + radius * DVec2::new(cos, sin)
        };
        copies(&(0..=96).map(at).collect::<Vec<_>>())
    };
    Series::new(centres.into_iter().flat_map(shape))
}

/// A line and its copies on the eight squares around.
fn copies(line: &[DVec2]) -> Vec<[f64; 2]> {
    let mut points = Vec::new();
    for (dx, dy) in (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (dx, dy))) {
        let shift = DVec2::new(f64::from(dx), f64::from(dy));
        let moved: Vec<DVec2> = line.iter().map(|&p| p + shift).collect();
        let low = moved.iter().fold(DVec2::INFINITY, |low, p| low.min(*p));
        let high = moved.iter().fold(DVec2::NEG_INFINITY, |high, p| high.max(*p));
        if low.max_element() <= 1.0 && high.min_element() >= 0.0 {
            points.extend(moved.iter().map(|p| [p.x, p.y]));
            points.push(GAP);
        }
    }
    points
}

/// The distance of every place from the nearest point: the farther, the lighter.
pub(super) fn distance_map(set: &PointSet, pixels: u32) -> Picture {
    let grid = CellGrid::new(set);
    let place = |i: u32| (f64::from(i) + 0.5) / f64::from(pixels);
    let distance = |pixel: u32| {
        // Rows from the top.
        let p = DVec2::new(place(pixel % pixels), 1.0 - place(pixel / pixels));
        grid.nearest(p, None).map_or(0.0, |(_, distance)| distance)
    };
    let distances: Vec<f64> = (0..pixels * pixels).map(distance).collect();
    let most = distances.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let grey = |d: &f64| (120.0 + 135.0 * d / most) as u8;
    Picture::grey(pixels, pixels, distances.iter().map(grey).collect())
}
