//! Voronoi cells.

use bn_core::{DVec2, Moments};

use crate::{Circle, Face, Triangulation};

/// Measures of the Voronoi cell of a point: the places nearer to it than to any other.
///
/// For a point set the areas sum to 1, up to rounding. Points that coincide share a cell: it belongs
/// to their representative, and the others have [`VoronoiCell::EMPTY`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct VoronoiCell {
    /// Its area.
    pub area: f64,
    /// The vector from the point to the cell's centroid.
    pub to_centroid: DVec2,
    /// ∫ |x − p|² over the cell, about its point p: the cell's part of the CVT energy.
    pub second_moment: f64,
}

impl VoronoiCell {
    /// The cell of no area.
    pub const EMPTY: Self = Self { area: 0.0, to_centroid: DVec2::ZERO, second_moment: 0.0 };

    /// The cell by the moments of a density about its point: [`VoronoiCell::EMPTY`] where there is no mass,
    /// or no more than rounding.
    pub fn of_moments(moments: &Moments) -> Self {
        let Moments { mass, first, second } = *moments;
        if mass <= MASSLESS {
            return Self::EMPTY;
        }
        Self { area: mass, to_centroid: first / mass, second_moment: second }
    }
}

/// Masses below this are the rounding of sums.
const MASSLESS: f64 = 1e-14;

/// The cells of all points, by index up to the largest one; empty where there is no point.
///
/// Absolute errors below 1e-13, and some 1e-16 times the number of corners where no triangle is a
/// needle; O(n).
///
/// ```
/// use bn_core::{DVec2, PointSet};
/// use bn_geometry::{Triangulation, voronoi_cells};
///
/// let set = PointSet::new(vec![DVec2::ZERO, DVec2::new(0.5, 0.0), DVec2::new(0.5, 0.5)])?;
/// let cells = voronoi_cells(&Triangulation::new(&set));
/// assert!((cells.iter().map(|cell| cell.area).sum::<f64>() - 1.0).abs() < 1e-15);
/// # Ok::<(), bn_core::PointSetError>(())
/// ```
pub fn voronoi_cells(triangulation: &Triangulation) -> Vec<VoronoiCell> {
    let mut cells = Vec::new();
    voronoi_cells_into(triangulation, &mut cells);
    cells
}

/// As [`voronoi_cells`], into a list whose memory is used again.
pub fn voronoi_cells_into(triangulation: &Triangulation, cells: &mut Vec<VoronoiCell>) {
    cells.clear();
    cells.resize(triangulation.index_bound(), VoronoiCell::EMPTY);
    for (face, circle) in triangulation.circumcircles() {
        add_face(cells, &face, circle);
    }
    for cell in cells.iter_mut().filter(|cell| cell.area > 0.0) {
        // Summed up so far: the first moment.
        cell.to_centroid /= cell.area;
    }
}

/// Adds the parts of the cells of a face's corners that lie towards its circle's centre.
///
/// A side's perpendicular bisector cuts two right triangles from the face, mirror images of each
/// other: corner, middle of the side, centre. Where the centre lies beyond the side they count
/// negatively, and take back what other faces add too much.
fn add_face(cells: &mut [VoronoiCell], face: &Face, circle: Circle) {
    for i in 0..3 {
        let j = (i + 1) % 3;
        let (p, q) = (face.corners[i], face.corners[j]);
        let half = (q - p) * 0.5;
        let (from_p, from_q) = (circle.center - p, circle.center - q);
        let area = 0.5 * half.perp_dot(from_p);
        cells[face.vertices[i]].add_triangle(area, half, from_p);
        cells[face.vertices[j]].add_triangle(area, -half, from_q);
    }
}

impl VoronoiCell {
    /// Adds the triangle with the corners 0, a and b relative to the point, and the given area.
    #[inline]
    pub(crate) fn add_triangle(&mut self, area: f64, a: DVec2, b: DVec2) {
        self.area += area;
        self.to_centroid += (a + b) * (area / 3.0);
        self.second_moment += area / 6.0 * (a.length_squared() + a.dot(b) + b.length_squared());
    }
}

impl Triangulation {
    /// The corners of the Voronoi cell of point `index`, counter-clockwise, relative to the point:
    /// the centres of the circles of the faces around it. Where circles coincide, so do corners.
    ///
    /// # Panics
    /// If there is no such point.
    pub fn cell_corners(&self, index: usize) -> impl Iterator<Item = DVec2> {
        self.corners_around(index).map(|(corner, circle)| circle.center - corner)
    }
}
