//! The plane as a finite number of samples, each of which belongs to a site.

use bn_core::DVec2;

use crate::SampleError;
use crate::error::reserve;

/// A place on the torus in units of 2⁻³² of its side: differences modulo 2³² are differences on the
/// torus, and the representative in [−2³¹, 2³¹) is the shortest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Place {
    x: u32,
    y: u32,
}

impl Place {
    /// The place of p in [0, 1)², rounded down.
    pub(super) fn of(p: DVec2) -> Self {
        let coordinate = |x: f64| (x * 4_294_967_296.0) as u32;
        Self { x: coordinate(p.x), y: coordinate(p.y) }
    }

    /// The shortest displacement from `origin` to here.
    #[inline]
    pub(super) fn minus(self, origin: Self) -> DVec2 {
        let shortest = |a: u32, b: u32| f64::from(a.wrapping_sub(b) as i32);
        DVec2::new(shortest(self.x, origin.x), shortest(self.y, origin.y))
    }

    #[inline]
    pub(super) fn distance_squared(self, origin: Self) -> f64 {
        self.minus(origin).length_squared()
    }
}

/// Samples spread evenly over the torus, in the order of their sites.
pub(super) struct Samples {
    places: Vec<Place>,
    /// A quarter of a sample's cell.
    quarter: u32,
}

impl Samples {
    /// `capacity` samples for each site, nearby ones together: the plane is halved over and over
    /// between halves of the sites, along the longer side, where the samples of each half fit.
    pub(super) fn new(sites: &[DVec2], capacity: usize) -> Result<Self, SampleError> {
        let n = sites.len();
        let mut cut = grid(n, capacity)?;
        let mut order: Vec<u32> = (0..n as u32).collect();
        let size = DVec2::ONE;
        halve(sites, &mut order, &mut cut, capacity, size);
        let mut places = reserve(n * capacity)?;
        places.resize(n * capacity, Place { x: 0, y: 0 });
        for (&site, group) in order.iter().zip(cut.chunks_exact(capacity)) {
            let first = site as usize * capacity;
            places[first..first + capacity].copy_from_slice(group);
        }
        let quarter = (1_073_741_824.0 / ((n * capacity) as f64).sqrt()) as u32;
        Ok(Self { places, quarter })
    }

    /// Puts four samples, at the middles of the quarters of its cell, in the place of each.
    pub(super) fn refine(&mut self) -> Result<(), SampleError> {
        let mut finer = reserve(4 * self.places.len())?;
        let (add, subtract): (Step, Step) = (u32::wrapping_add, u32::wrapping_sub);
        for place in &self.places {
            for (right, up) in [(subtract, subtract), (add, subtract), (subtract, add), (add, add)]
            {
                let (x, y) = (right(place.x, self.quarter), up(place.y, self.quarter));
                finer.push(Place { x, y });
            }
        }
        self.places = finer;
        self.quarter /= 2;
        Ok(())
    }

    /// The samples of a site.
    #[inline]
    pub(super) fn of(&self, site: usize, capacity: usize) -> &[Place] {
        &self.places[site * capacity..(site + 1) * capacity]
    }

    /// Exchanges two samples, each numbered by its site and then by its place in the site's list.
    pub(super) fn exchange(&mut self, a: usize, b: usize) {
        self.places.swap(a, b);
    }
}

/// A step along a coordinate, around the torus.
type Step = fn(u32, u32) -> u32;

/// n·capacity samples in about square cells: in rows, as many to each as to the others or one less.
fn grid(n: usize, capacity: usize) -> Result<Vec<Place>, SampleError> {
    let count = n * capacity;
    let rows = count.isqrt().max(1);
    let mut places = reserve(count)?;
    for row in 0..rows {
        let columns = (row + 1) * count / rows - row * count / rows;
        let y = (row as f64 + 0.5) / rows as f64;
        let place = |column: usize| (column as f64 + 0.5) / columns as f64;
        places.extend((0..columns).map(|column| Place::of(DVec2::new(place(column), y))));
    }
    Ok(places)
}

/// Orders sites and samples so that those that belong together have the same rank; their part of
/// the plane is about as large as `size` says. The depth is log₂ of the number of sites.
fn halve(sites: &[DVec2], order: &mut [u32], samples: &mut [Place], capacity: usize, size: DVec2) {
    if order.len() < 2 {
        return;
    }
    let middle = order.len() / 2;
    let share = middle as f64 / order.len() as f64;
    let is_wide = size.x >= size.y;
    let at = |p: DVec2| if is_wide { p.x } else { p.y };
    order.select_nth_unstable_by(middle, |&a, &b| {
        at(sites[a as usize]).total_cmp(&at(sites[b as usize])).then(a.cmp(&b))
    });
    let key = |p: &Place| if is_wide { (p.x, p.y) } else { (p.y, p.x) };
    samples.select_nth_unstable_by_key(middle * capacity, key);
    let (low, high) = order.split_at_mut(middle);
    let (low_samples, high_samples) = samples.split_at_mut(middle * capacity);
    let parts = [share, 1.0 - share].map(|part| {
        if is_wide { DVec2::new(size.x * part, size.y) } else { DVec2::new(size.x, size.y * part) }
    });
    halve(sites, low, low_samples, capacity, parts[0]);
    halve(sites, high, high_samples, capacity, parts[1]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use bn_core::torus;

    #[test]
    fn differences_are_those_of_the_torus() {
        for (a, b) in
            [((0.1, 0.9), (0.9, 0.2)), ((0.0, 0.5), (0.99, 0.25)), ((0.3, 0.3), (0.3, 0.3))]
        {
            let (a, b) = (DVec2::new(a.0, a.1), DVec2::new(b.0, b.1));
            let got = Place::of(b).minus(Place::of(a)) / 4_294_967_296.0;
            assert!((got - torus::delta(a, b)).abs().max_element() < 1e-9);
        }
    }

    #[test]
    fn every_sample_has_one_site() {
        for (n, capacity) in [(1, 1), (1, 10), (3, 7), (10, 100), (17, 1)] {
            let sites: Vec<DVec2> = (0..n).map(|i| DVec2::new(i as f64 / n as f64, 0.5)).collect();
            let samples = Samples::new(&sites, capacity).expect("memory");
            let mut found: Vec<_> = samples.places.iter().map(|p| (p.y, p.x)).collect();
            let mut all: Vec<_> =
                grid(n, capacity).expect("memory").iter().map(|p| (p.y, p.x)).collect();
            found.sort_unstable();
            all.sort_unstable();
            assert_eq!(found, all);
            all.dedup();
            assert_eq!(all.len(), n * capacity, "samples coincide");
        }
    }

    #[test]
    fn a_finer_grid_is_the_grid_of_more_samples() {
        let sites = [DVec2::splat(0.1), DVec2::splat(0.6), DVec2::splat(0.8), DVec2::splat(0.9)];
        let mut samples = Samples::new(&sites, 16).expect("memory");
        samples.refine().expect("memory");
        let mut found: Vec<_> = samples.places.iter().map(|p| (p.y, p.x)).collect();
        let mut all: Vec<_> = grid(4, 64).expect("memory").iter().map(|p| (p.y, p.x)).collect();
        found.sort_unstable();
        all.sort_unstable();
        assert_eq!(found, all);
    }

    #[test]
    fn sites_of_a_lattice_get_their_cells() {
        let sites: Vec<DVec2> =
            (0..16).map(|i| (DVec2::new(f64::from(i % 4), f64::from(i / 4)) + 0.5) / 4.0).collect();
        let samples = Samples::new(&sites, 100).expect("memory");
        for (i, site) in sites.iter().enumerate() {
            let place = Place::of(*site);
            let offsets = samples.of(i, 100).iter().map(|p| p.minus(place).abs().max_element());
            assert!(offsets.fold(0.0, f64::max) / 4_294_967_296.0 < 0.125);
        }
    }
}
