//! Neighbour search among points that are still being added.

use bn_core::{DVec2, torus};

/// Points on the torus in square cells, each cell a linked list: insertion in O(1), and a search
/// looks at the cells that its radius reaches.
#[derive(Debug)]
pub(crate) struct BucketGrid {
    side: usize,
    /// The last point of each cell; `END` if there is none.
    heads: Vec<u32>,
    /// The point before each point in its cell; `END` if it is the first.
    previous: Vec<u32>,
    points: Vec<DVec2>,
}

const END: u32 = u32::MAX;

impl BucketGrid {
    /// An empty grid of `side`² cells.
    pub(crate) fn new(side: usize) -> Self {
        let side = side.max(1);
        Self { side, heads: vec![END; side * side], previous: Vec::new(), points: Vec::new() }
    }

    /// An empty grid for about `n` points: one to a cell.
    pub(crate) fn for_points(n: usize) -> Self {
        Self::new(n.isqrt())
    }

    /// Makes the cells hold about one point each, if they hold more than two or less than half of
    /// one.
    pub(crate) fn fit(&mut self) {
        let cells = self.heads.len();
        if (cells / 2..=2 * cells).contains(&self.points.len()) {
            return;
        }
        let mut grid = Self::for_points(self.points.len());
        self.points.drain(..).for_each(|p| grid.insert(p));
        *self = grid;
    }

    /// The points, in the order of insertion.
    pub(crate) fn points(&self) -> &[DVec2] {
        &self.points
    }

    /// The points, in the order of insertion, by value.
    pub(crate) fn into_points(self) -> Vec<DVec2> {
        self.points
    }

    /// Adds a point of [0, 1)².
    pub(crate) fn insert(&mut self, p: DVec2) {
        let cell = self.index(p.y) * self.side + self.index(p.x);
        self.previous.push(std::mem::replace(&mut self.heads[cell], self.points.len() as u32));
        self.points.push(p);
    }

    /// Whether a point lies nearer to `p` than `radius`.
    pub(crate) fn any_within(&self, p: DVec2, radius: f64) -> bool {
        let limit = radius * radius;
        self.any_near(p, radius, |q| torus::distance_squared(p, q) < limit)
    }

    /// Whether the disk of this radius around one of the points covers the whole square.
    pub(crate) fn any_covers(&self, centre: DVec2, half_side: f64, radius: f64) -> bool {
        self.any_near(centre, radius, |q| disk_covers(q, radius, centre, half_side))
    }

    /// The point nearest to `p` and its squared distance; none in an empty grid.
    pub(crate) fn nearest(&self, p: DVec2) -> Option<(DVec2, f64)> {
        let mut best: Option<(DVec2, f64)> = None;
        // Cells whose nearest corner is farther than what was found need not be looked at.
        for reach in 0..=self.side / 2 {
            let cleared = reach.saturating_sub(1) as f64 / self.side as f64;
            if best.is_some_and(|(_, squared)| squared <= cleared * cleared) {
                break;
            }
            self.for_ring(p, reach, |q| {
                let squared = torus::distance_squared(p, q);
                if best.is_none_or(|(_, least)| squared < least) {
                    best = Some((q, squared));
                }
            });
        }
        best
    }

    /// Whether `test` holds for any of the points in the cells that the radius reaches from `p`.
    fn any_near(&self, p: DVec2, radius: f64, test: impl Fn(DVec2) -> bool) -> bool {
        let reach = (radius * self.side as f64).ceil() as usize;
        self.columns(p.y, reach)
            .any(|row| self.columns(p.x, reach).any(|column| self.cell(column, row).any(&test)))
    }

    /// Visits the points in the cells at most, and in one axis exactly, `reach` cells away; in all
    /// cells once the ring closes around the torus.
    fn for_ring(&self, p: DVec2, reach: usize, mut visit: impl FnMut(DVec2)) {
        let everything = 2 * reach + 1 >= self.side;
        let is_end = |i: usize| everything || i == 0 || i == 2 * reach;
        for (i, row) in self.columns(p.y, reach).enumerate() {
            for (j, column) in self.columns(p.x, reach).enumerate() {
                if is_end(i) || is_end(j) {
                    self.cell(column, row).for_each(&mut visit);
                }
            }
        }
    }

    /// The points of a cell.
    fn cell(&self, column: usize, row: usize) -> impl Iterator<Item = DVec2> {
        let exists = |index: u32| (index != END).then_some(index);
        let first = exists(self.heads[row * self.side + column]);
        std::iter::successors(first, move |&index| exists(self.previous[index as usize]))
            .map(|index| self.points[index as usize])
    }

    fn index(&self, coordinate: f64) -> usize {
        // Below 1 times a whole number may round up to it.
        ((coordinate * self.side as f64) as usize).min(self.side - 1)
    }

    /// The columns (or rows) up to `reach` from that of the coordinate, each once.
    fn columns(&self, coordinate: f64, reach: usize) -> impl Iterator<Item = usize> + use<> {
        let side = self.side;
        let count = (2 * reach + 1).min(side);
        let first = if count == side { 0 } else { (self.index(coordinate) + side - reach) % side };
        (first..first + count).map(move |column| if column < side { column } else { column - side })
    }
}

/// Whether the disk around `p` covers the whole square, which lies nearer than ½ to it.
pub(crate) fn disk_covers(p: DVec2, radius: f64, centre: DVec2, half_side: f64) -> bool {
    let farthest = torus::delta(centre, p).abs() + DVec2::splat(half_side);
    farthest.length_squared() < radius * radius
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stochastic::uniform_points;
    use bn_core::Seed;

    #[test]
    fn finds_what_brute_force_finds() {
        for n in [1, 2, 7, 60] {
            let points = uniform_points(n, Seed::new(9), 0).expect("few points");
            let mut grid = BucketGrid::for_points(n);
            for &p in &points {
                grid.insert(p);
            }
            assert_eq!(grid.points(), points);
            for q in uniform_points(200, Seed::new(10), 0).expect("few points") {
                let nearest = points.iter().map(|&p| torus::distance_squared(p, q));
                let nearest = nearest.fold(f64::INFINITY, f64::min);
                assert_eq!(grid.nearest(q).expect("points").1, nearest);
                let nearest = nearest.sqrt();
                for radius in [0.9 * nearest, 1.1 * nearest, 0.01, 0.3, 0.8] {
                    assert_eq!(grid.any_within(q, radius), nearest < radius);
                }
            }
        }
    }
}
