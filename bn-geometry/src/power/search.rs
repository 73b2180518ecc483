//! Finding the points whose bisectors can cut a cell.

use bn_core::{CellGrid, DVec2, torus};

use super::polygon::Polygon;
use super::{PowerEdge, PowerNeighbor};

/// Bounds on distances to points of other cells of the grid, in cells, are loosened by this; the
/// grid's own rounding is below 4e-12.
const SLACK_CELLS: f64 = 1e-9;

/// Points and weights, ready to be searched.
pub struct Sites<'a> {
    points: &'a [DVec2],
    weights: &'a [f64],
    grid: &'a CellGrid,
    heaviest: f64,
}

/// The point whose cell is cut, and where it is in the grid.
struct Site {
    index: u32,
    place: DVec2,
    weight: f64,
    /// Its cell of the grid, and the place in it in units of cells.
    column: i64,
    row: i64,
    x: f64,
    y: f64,
}

impl<'a> Sites<'a> {
    pub fn new(points: &'a [DVec2], weights: &'a [f64], grid: &'a CellGrid) -> Self {
        let heaviest = weights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        Self { points, weights, grid, heaviest }
    }

    /// Where point `index` is.
    pub fn place(&self, index: usize) -> DVec2 {
        self.points[index]
    }

    /// Cuts the cell of point `index`, first by its `former` neighbours, which are likely to be its
    /// neighbours still.
    pub fn cut_cell(&self, index: usize, former: &[PowerEdge], polygon: &mut Polygon) {
        let site = self.site(index);
        polygon.reset(site.index);
        for edge in former {
            let other = edge.neighbor.index;
            if other != site.index {
                let displacement = torus::delta(site.place, self.points[other as usize]);
                self.offer(&site, other, displacement, polygon);
            }
        }
        // The unit square around the site meets the Voronoi cell of any other only within that
        // one's copies at most a unit away.
        for ring in 0..=self.grid.cells_per_side() as i64 {
            if polygon.is_empty() || !self.search_ring(&site, ring, polygon) {
                break;
            }
        }
    }

    fn site(&self, index: usize) -> Site {
        let (place, m) = (self.points[index], self.grid.cells_per_side() as f64);
        let (column, row) = self.grid.cell_of(place);
        Site {
            index: index as u32,
            place,
            weight: self.weights[index],
            column: column as i64,
            row: row as i64,
            x: place.x * m - column as f64,
            y: place.y * m - row as f64,
        }
    }

    #[inline]
    fn offer(&self, site: &Site, other: u32, displacement: DVec2, polygon: &mut Polygon) {
        let weight = self.weights[other as usize];
        if displacement == DVec2::ZERO {
            let is_hidden = weight > site.weight || (weight == site.weight && other < site.index);
            if is_hidden {
                polygon.clear();
            }
        } else {
            let neighbor = PowerNeighbor { index: other, displacement };
            polygon.offer(neighbor, site.weight - weight);
        }
    }

    /// How far away, in cells, a point can be and still cut the polygon: the bisector of a point at
    /// distance d is at distance (d² + w − w')/2d, which must be below the polygon's radius R, so
    /// d < R + √(R² + w' − w).
    fn reach(&self, site: &Site, polygon: &Polygon) -> f64 {
        let radius = polygon.radius();
        let square = radius * radius + (self.heaviest - site.weight);
        if square < 0.0 {
            return 0.0;
        }
        (radius + square.sqrt()) * self.grid.cells_per_side() as f64 + SLACK_CELLS
    }

    /// Offers the points in the cells of the grid that are `ring` columns or rows away, as far as
    /// they may be within reach; false if none is.
    fn search_ring(&self, site: &Site, ring: i64, polygon: &mut Polygon) -> bool {
        if ring == 0 {
            self.search_row(site, 0, [0, 0], polygon);
            return true;
        }
        let mut any = false;
        let (far, near) = (ring as f64, (ring - 1) as f64);
        for (row, gap) in [(ring, far - site.y), (-ring, near + site.y)] {
            let reach = self.reach(site, polygon);
            if gap < reach {
                any = true;
                let columns = chord(site.x, gap, reach, ring);
                self.search_row(site, row, columns, polygon);
            }
        }
        for (column, gap) in [(ring, far - site.x), (-ring, near + site.x)] {
            let reach = self.reach(site, polygon);
            if gap < reach {
                any = true;
                let [first, last] = chord(site.y, gap, reach, ring - 1);
                for row in first..=last {
                    self.search_row(site, row, [column, column], polygon);
                }
            }
        }
        any
    }

    /// Offers the points in columns `first` to `last` of a row, all relative to the site's cell.
    fn search_row(&self, site: &Site, row: i64, [first, last]: [i64; 2], polygon: &mut Polygon) {
        let m = self.grid.cells_per_side() as i64;
        let row = site.row + row;
        let (mut column, last) = (site.column + first, site.column + last);
        while column <= last {
            let (home_column, home_row) = (column.rem_euclid(m), row.rem_euclid(m));
            let shift =
                DVec2::new(((column - home_column) / m) as f64, ((row - home_row) / m) as f64);
            let end = (home_column + last - column + 1).min(m);
            let cells = self.grid.row_cells(home_row as usize, home_column as usize..end as usize);
            for (&q, &other) in cells.points.iter().zip(cells.indices) {
                if other != site.index {
                    self.offer(site, other, (q - site.place) + shift, polygon);
                }
            }
            column += end - home_column;
        }
    }
}

/// The cells, at most `most` away, that a disk of radius `reach` around `at` in cell 0 covers on a
/// line at distance `gap`.
fn chord(at: f64, gap: f64, reach: f64, most: i64) -> [i64; 2] {
    let gap = gap.max(0.0);
    let half = (reach * reach - gap * gap).sqrt();
    let bound = most as f64;
    let first = (at - half - SLACK_CELLS).floor().max(-bound);
    let last = (at + half + SLACK_CELLS).floor().min(bound);
    [first as i64, last as i64]
}
