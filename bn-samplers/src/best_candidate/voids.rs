//! Where a new point would be farther than a given distance from all others.

use bn_core::{DVec2, StreamRng, torus};
use rand::{Rng, RngExt};

use crate::bucket_grid::{BucketGrid, disk_covers};

/// Squares that cover all places at least `radius` away from every point, and little else.
#[derive(Debug)]
pub(super) struct Voids {
    radius: f64,
    half_side: f64,
    centres: Vec<DVec2>,
}

/// The squares' side is at most the radius over this: finer ones leave out more of what is near
/// the points but are more to look at.
const FINENESS: f64 = 16.0;

impl Voids {
    /// The voids of a pattern; `radius` below ¼.
    pub(super) fn new(points: &BucketGrid, radius: f64) -> Self {
        // Squares as large as the radius first; those that no disk alone covers are quartered.
        let side = (1.0 / radius).ceil() as usize;
        let mut half_side = 0.5 / side as f64;
        let along = |i: usize| (2 * i + 1) as f64 * half_side;
        let all = (0..side * side).map(|i| DVec2::new(along(i % side), along(i / side)));
        let open = |&centre: &DVec2, half_side| !points.any_covers(centre, half_side, radius);
        let mut centres: Vec<DVec2> = all.filter(|centre| open(centre, half_side)).collect();
        while 2.0 * half_side > radius / FINENESS {
            half_side *= 0.5;
            let h = half_side;
            let quarters = |centre: DVec2| {
                [(-h, -h), (h, -h), (-h, h), (h, h)].map(|(x, y)| centre + DVec2::new(x, y))
            };
            let all = centres.into_iter().flat_map(quarters);
            centres = all.filter(|centre| open(centre, half_side)).collect();
        }
        Self { radius, half_side, centres }
    }

    /// The distance that all voids have from the points.
    pub(super) fn radius(&self) -> f64 {
        self.radius
    }

    /// The squares' share of the torus.
    pub(super) fn area(&self) -> f64 {
        (2.0 * self.half_side).powi(2) * self.centres.len() as f64
    }

    /// A uniform random place in the squares, and the number of its square.
    ///
    /// # Panics
    /// If there is no square.
    pub(super) fn draw(&self, rng: &mut StreamRng) -> (DVec2, usize) {
        let index = ((u128::from(rng.next_u64()) * self.centres.len() as u128) >> 64) as usize;
        let place = |random: f64| (2.0 * random - 1.0) * self.half_side;
        let p = self.centres[index] + DVec2::new(place(rng.random()), place(rng.random()));
        (torus::wrap_point(p), index)
    }

    /// Whether the disk around `point` covers the square, which then holds no void.
    pub(super) fn is_covered(&self, index: usize, point: DVec2) -> bool {
        disk_covers(point, self.radius, self.centres[index], self.half_side)
    }

    /// Leaves out the squares of these numbers.
    pub(super) fn remove(&mut self, indices: &mut Vec<usize>) {
        indices.sort_unstable();
        indices.dedup();
        // From the last on, so that what fills a gap isn't to be removed itself.
        for index in indices.drain(..).rev() {
            self.centres.swap_remove(index);
        }
    }
}
