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
        let reach = self.reach(radius);
        self.columns(p.y, reach).any(|row| {
            self.columns(p.x, reach)
                .any(|column| self.least_squared_in(row * self.side + column, p) < limit)
        })
    }

    /// The cells to either side that a search of this radius has to look at.
    fn reach(&self, radius: f64) -> usize {
        (radius * self.side as f64).ceil() as usize
    }

    /// The squared distance to the nearest point of a cell, infinite if it is empty.
    fn least_squared_in(&self, cell: usize, p: DVec2) -> f64 {
        let mut least = f64::INFINITY;
        let mut at = self.heads[cell];
        while at != END {
            least = least.min(torus::distance_squared(p, self.points[at as usize]));
            at = self.previous[at as usize];
        }
        least
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
                let nearest = nearest.fold(f64::INFINITY, f64::min).sqrt();
                for radius in [0.9 * nearest, 1.1 * nearest, 0.01, 0.3, 0.8] {
                    assert_eq!(grid.any_within(q, radius), nearest < radius);
                }
            }
        }
    }
}
