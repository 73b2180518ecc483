//! How farthest-point optimisation moves points, drawn: figures 4.1, 4.3, 4.5 and the lattices that
//! stay put.

use bn_cli::Outcome;
use bn_cli::plot::{Page, Panel, Row, Style};
use bn_core::{DVec2, PointSet, torus};
use bn_geometry::{Coverage, EmptyCircles, Triangulation};

use super::FigureSpec;
use super::drawing::{circles, distance_map, edges, markers, square, triangles};
use super::studio::Studio;

pub(super) const FIGURES: &[FigureSpec] = &[
    FigureSpec { id: "4.1", title: "the coverage radius", draw: coverage },
    FigureSpec { id: "4.3", title: "one iteration on five points", draw: iteration },
    FigureSpec { id: "4.5", title: "a local move", draw: local_move },
    FigureSpec { id: "lattices", title: "lattices that stay put", draw: lattices },
];

/// Pixels of a map of distances.
const PIXELS: u32 = 256;
/// Sides of panels in points.
const LARGE: f64 = 200.0;
const SMALL: f64 = 105.0;

/// Disks of the coverage radius cover the square; smaller ones would not reach the farthest point.
fn coverage(studio: &Studio) -> Outcome {
    let set = studio.sets("best-candidate", &[], 14, 1)?.remove(0);
    let Some(Coverage { radius, farthest_point }) = Coverage::of(&Triangulation::new(&set)) else {
        return Ok(());
    };
    let panel = square("*R*_{c} and the farthest point")
        .line(circles(set.points().iter().copied(), radius).styled(Style::Cycle(4)))
        .line(markers(set.points().iter().copied()))
        .line(circles([farthest_point], radius).styled(Style::Contrast))
        .line(markers([farthest_point]).styled(Style::Contrast));
    studio.page("", &Page::new().row(Row::new(LARGE, vec![panel])))
}

/// Each of five points goes to the farthest place from the four others.
fn iteration(studio: &Studio) -> Outcome {
    let set = studio.sets("stochastic", &[], 5, 1)?.remove(0);
    let mut triangulation = Triangulation::new(&set);
    let mut points = set.into_points();
    let (mut searches, mut results) = (Vec::new(), Vec::new());
    for i in 0..points.len() {
        let home = points[i];
        triangulation.remove(i);
        let others: Vec<DVec2> = (0..points.len()).filter(|&j| j != i).map(|j| points[j]).collect();
        let clearance = others.iter().map(|&p| torus::distance(p, home)).fold(2.0, f64::min);
        let mut panel = field(&others, &format!("{}a", i + 1)).line(edges(&triangulation));
        let hole = EmptyCircles::new(&triangulation).largest();
        if let Some(face) = hole {
            let circle = triangulation.circumcircle(face);
            let center = torus::wrap_point(circle.center);
            panel = panel
                .line(triangles([triangulation.face(face).corners]).styled(Style::Contrast))
                .line(circles([center], circle.radius()).styled(Style::Cycle(2)))
                .line(markers([center]).styled(Style::Cycle(2)));
            if circle.radius() > clearance {
                points[i] = center;
            }
        }
        let panel = panel.line(markers(others)).line(markers([home]).styled(Style::Cycle(5)));
        searches.push(panel);
        triangulation.insert(i, points[i]);
        let panel = field(&points, &format!("{}b", i + 1)).line(edges(&triangulation));
        let rest = points.iter().enumerate().filter(|&(j, _)| j != i).map(|(_, &p)| p);
        results.push(panel.line(markers(rest)).line(markers([points[i]]).styled(Style::Cycle(2))));
    }
    let page = Page::new().row(Row::new(SMALL, searches)).row(Row::new(SMALL, results));
    studio.page("", &page)
}

/// A panel over the map of distances from these points.
fn field(points: &[DVec2], title: &str) -> Panel {
    match PointSet::new(points.to_vec()) {
        Ok(set) => square(title).picture(distance_map(&set, PIXELS)),
        Err(_) => square(title),
    }
}

/// Where a point looks in the local variant: the faces at its neighbours.
fn local_move(studio: &Studio) -> Outcome {
    let set = studio.sets("jittered", &[], 64, 1)?.remove(0);
    let triangulation = Triangulation::new(&set);
    let middle = DVec2::splat(0.5);
    let order = |a: &usize, b: &usize| {
        let distance = |i: usize| torus::distance_squared(set.points()[i], middle);
        distance(*a).total_cmp(&distance(*b))
    };
    let point = (0..set.len()).min_by(order).unwrap_or(0);
    let home = set.points()[point];
    let around = triangulation.neighbors(point).flat_map(|(i, _)| triangulation.star(i));
    let mut faces: Vec<_> = around.collect();
    faces.sort_unstable();
    faces.dedup();
    let corners = faces.iter().map(|&face| triangulation.face(face).corners);
    let mut panel =
        square("").line(edges(&triangulation).styled(Style::Cycle(5))).line(triangles(corners));
    let radius = |face: &&_| triangulation.circumcircle(**face).radius_squared;
    let largest = faces.iter().max_by(|a, b| radius(a).total_cmp(&radius(b)));
    if let Some(&face) = largest {
        let circle = triangulation.circumcircle(face);
        let center = torus::wrap_point(circle.center);
        panel = panel
            .line(circles([center], circle.radius()).styled(Style::Contrast))
            .line(markers([center]).styled(Style::Contrast));
    }
    let panel = panel
        .line(markers(set.points().iter().copied()).styled(Style::Cycle(5)))
        .line(markers([home]));
    studio.page("", &Page::new().row(Row::new(LARGE, vec![panel])))
}

/// In each of them a point is in the middle of the largest hole that it would leave.
fn lattices(studio: &Studio) -> Outcome {
    let upright = (0..64).map(|i| DVec2::new(f64::from(i % 8) + 0.5, f64::from(i / 8) + 0.5) / 8.0);
    // 8² + 1: a square lattice, turned.
    let turned = (0..65).map(|i| DVec2::new(f64::from(i), f64::from(i * 8 % 65)) / 65.0);
    let staggered = |i: i32| f64::from(i % 7) + 0.25 + 0.5 * f64::from(i / 7 % 2);
    let hexagonal = (0..56).map(|i| DVec2::new(staggered(i) / 7.0, (f64::from(i / 7) + 0.5) / 8.0));
    let panels = [
        lattice("square", upright.collect()),
        lattice("square, turned", turned.collect()),
        lattice("hexagonal", hexagonal.collect()),
    ];
    studio.page("", &Page::new().row(Row::new(LARGE, panels.into_iter().flatten().collect())))
}

/// A lattice without the point nearest to the middle, and the hole that it leaves.
fn lattice(title: &str, mut points: Vec<DVec2>) -> Option<Panel> {
    let middle = DVec2::splat(0.5);
    let distance = |p: &DVec2| torus::distance_squared(*p, middle);
    let order = |a: &usize, b: &usize| distance(&points[*a]).total_cmp(&distance(&points[*b]));
    let removed = points.remove((0..points.len()).min_by(order)?);
    let set = PointSet::new(points).ok()?;
    let Coverage { radius, farthest_point } = Coverage::of(&Triangulation::new(&set))?;
    let panel = square(title)
        .line(circles([farthest_point], radius).styled(Style::Contrast))
        .line(markers(set.points().iter().copied()))
        .line(markers([removed]).styled(Style::Contrast));
    Some(panel)
}
