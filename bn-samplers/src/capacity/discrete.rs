//! The capacity constraint by swaps of samples: the original method.

use bn_core::{CellGrid, DVec2, Density, NormalizedDistance, PointSet, torus};

use super::samples::{Place, Samples};
use crate::SampleError;

/// Sites with as many samples of the plane each, improved by swaps.
pub(super) struct Assignment {
    sites: Vec<DVec2>,
    samples: Samples,
    /// Samples that each site has.
    capacity: usize,
    /// The largest distance of a site's samples from it, or more, in units of 2⁻³².
    reaches: Vec<f64>,
    /// Whether a site moved or swapped samples in this sweep, and in the one before.
    restless: Vec<bool>,
    was_restless: Vec<bool>,
    /// Samples of two sites that may change places, with their excess; scratch memory.
    candidates: [Vec<(f64, usize)>; 2],
}

/// 2³²: the torus's side in units of samples' places.
const SIDE: f64 = 4_294_967_296.0;

impl Assignment {
    /// The sites with `capacity` samples each, assigned so that nearby samples are together.
    pub(super) fn new(sites: &PointSet, capacity: usize) -> Result<Self, SampleError> {
        let n = sites.len();
        let samples = Samples::new(sites.points(), capacity)?;
        let mut assignment = Self {
            sites: sites.points().to_vec(),
            samples,
            capacity,
            reaches: vec![0.0; n],
            restless: vec![true; n],
            was_restless: vec![true; n],
            candidates: Default::default(),
        };
        for i in 0..n {
            assignment.measure_reach(i);
        }
        Ok(assignment)
    }

    /// Looks at all pairs of sites whose samples could be swapped to the advantage of both, and
    /// swaps them. Returns the number of samples that changed their site.
    ///
    /// Pairs are in reach of each other if the disks around their samples meet, for only then is
    /// there a sample of each nearer to the other; pairs of which neither has changed since
    /// they were last looked at are passed over.
    pub(super) fn sweep(&mut self) -> u64 {
        let set = PointSet::new(self.sites.clone()).expect("sites are on the torus");
        let grid = CellGrid::new(&set);
        std::mem::swap(&mut self.restless, &mut self.was_restless);
        self.restless.fill(false);
        let farthest = self.reaches.iter().copied().fold(0.0, f64::max);
        let mut swapped = 0;
        let mut partners = Vec::new();
        for i in 0..self.sites.len() {
            partners.clear();
            let reach = ((self.reaches[i] + farthest) / SIDE).min(torus::DIAMETER);
            grid.for_each_within(self.sites[i], reach, |j, distance_squared| {
                partners.push((j as usize, distance_squared.sqrt() * SIDE));
            });
            // In no particular order so far.
            partners.sort_unstable_by_key(|&(j, _)| j);
            for &(j, distance) in &partners {
                let is_new = self.was_restless[i] || self.was_restless[j];
                let is_new = is_new || self.restless[i] || self.restless[j];
                if j > i && is_new && distance <= self.reaches[i] + self.reaches[j] {
                    swapped += self.swap(i, j);
                }
            }
        }
        swapped
    }

    /// Gives the samples of sites i and j, as many to each as before, to the nearer one: those
    /// with the least |x − i|² − |x − j|² to i. Returns how many pairs changed places.
    ///
    /// Balzer's heaps hold all samples; here only those that may change are sorted, which are few
    /// after the first sweeps (Li et al. find the median instead).
    fn swap(&mut self, i: usize, j: usize) -> u64 {
        let pairs = [Pair::new(self, i, j), Pair::new(self, j, i)];
        let capacity = self.capacity;
        let most = [0, 1].map(|own| pairs[own].most(self.samples.of([i, j][own], capacity)));
        // A swap gains the sum of the two excesses.
        if most[0] + most[1] <= 0.0 {
            return 0;
        }
        for own in 0..2 {
            let bound = -most[1 - own];
            let candidates = &mut self.candidates[own];
            candidates.clear();
            let samples = self.samples.of([i, j][own], capacity).iter();
            let excess = samples.map(|&x| pairs[own].excess(x)).zip(0..);
            candidates.extend(excess.filter(|&(excess, _)| excess > bound));
            candidates.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        }
        let mut swapped = 0;
        let [mine, theirs] = &self.candidates;
        for (a, b) in mine.iter().zip(theirs) {
            if a.0 + b.0 <= 0.0 {
                break;
            }
            self.samples.exchange(i * capacity + a.1, j * capacity + b.1);
            swapped += 1;
        }
        if swapped > 0 {
            self.restless[i] = true;
            self.restless[j] = true;
            self.measure_reach(i);
            self.measure_reach(j);
        }
        swapped
    }

    fn measure_reach(&mut self, site: usize) {
        let place = Place::of(self.sites[site]);
        let samples = self.samples.of(site, self.capacity).iter();
        let squares = samples.map(|x| x.distance_squared(place));
        self.reaches[site] = squares.fold(0.0, f64::max).sqrt();
    }

    /// Splits each sample into four, so that each site has four times as many.
    pub(super) fn refine(&mut self) -> Result<(), SampleError> {
        self.samples.refine()?;
        self.capacity *= 4;
        for site in 0..self.sites.len() {
            self.restless[site] = true;
            self.measure_reach(site);
        }
        Ok(())
    }

    /// Moves each site to the mean of its samples, or `stretch` times as far: the energy of the samples as they
    /// are falls up to twice as far.
    pub(super) fn centre(&mut self, stretch: f64) {
        for site in 0..self.sites.len() {
            let to_centroid = self.to_centroid(site) * stretch;
            if to_centroid != DVec2::ZERO {
                self.sites[site] = torus::wrap_point(self.sites[site] + to_centroid);
                self.restless[site] = true;
                self.measure_reach(site);
            }
        }
    }

    fn to_centroid(&self, site: usize) -> DVec2 {
        let place = Place::of(self.sites[site]);
        let samples = self.samples.of(site, self.capacity).iter();
        let sum: DVec2 = samples.map(|x| x.minus(place)).sum();
        sum / (self.capacity as f64 * SIDE)
    }

    /// The root mean square of the sites' distances to the means of their samples.
    pub(super) fn unrest(&self) -> NormalizedDistance {
        let n = self.sites.len();
        let squares: f64 = (0..n).map(|site| self.to_centroid(site).length_squared()).sum();
        Density::new(n).normalize_distance((squares / n as f64).sqrt())
    }

    /// n times the mean squared distance of samples to their sites: the discrete cost of transport, in
    /// units that do not depend on n.
    pub(super) fn energy(&self) -> f64 {
        let n = self.sites.len();
        let of_site = |site: usize| {
            let place = Place::of(self.sites[site]);
            let samples = self.samples.of(site, self.capacity).iter();
            samples.map(|x| x.distance_squared(place)).sum::<f64>()
        };
        let sum: f64 = (0..n).map(of_site).sum();
        sum / (SIDE * SIDE * self.capacity as f64)
    }

    /// The sites, in the order given.
    pub(super) fn sites(&self) -> &[DVec2] {
        &self.sites
    }
}

/// Two sites, seen from the samples of one.
#[derive(Clone, Copy)]
struct Pair {
    here: Place,
    there: Place,
    /// Where all samples are nearer than half around the torus to both sites, with room to spare:
    /// 2(there − here) and |there − here|².
    near: Option<(DVec2, f64)>,
}

impl Pair {
    fn new(assignment: &Assignment, own: usize, other: usize) -> Self {
        let [here, there] = [own, other].map(|site| Place::of(assignment.sites[site]));
        let apart = there.minus(here);
        let reach = assignment.reaches[own] + apart.length();
        let near = (reach < 0.4 * SIDE).then(|| (2.0 * apart, apart.length_squared()));
        Self { here, there, near }
    }

    /// How much farther a sample is from its own site than from the other, in squares of distances.
    #[inline]
    fn excess(&self, x: Place) -> f64 {
        match self.near {
            // |x|² − |x − d|² = 2 x·d − |d|²
            Some((twice, square)) => x.minus(self.here).dot(twice) - square,
            None => x.distance_squared(self.here) - x.distance_squared(self.there),
        }
    }

    /// The largest excess of these samples.
    fn most(&self, samples: &[Place]) -> f64 {
        const LANES: usize = 4;
        let Some((twice, square)) = self.near else {
            return samples.iter().map(|&x| self.excess(x)).fold(f64::NEG_INFINITY, f64::max);
        };
        // Maxima of every fourth, so that they are found at the same time.
        let mut most = [f64::NEG_INFINITY; LANES];
        let (chunks, rest) = samples.as_chunks::<LANES>();
        for chunk in chunks {
            for (most, x) in most.iter_mut().zip(chunk) {
                let along = x.minus(self.here).dot(twice);
                *most = if along > *most { along } else { *most };
            }
        }
        let along = rest.iter().map(|x| x.minus(self.here).dot(twice)).chain(most);
        along.fold(f64::NEG_INFINITY, f64::max) - square
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Sampler, Stochastic};
    use bn_core::{Seed, Unobserved};

    fn random(n: usize) -> PointSet {
        Stochastic::default().sample(n, Seed::new(1), &Unobserved).expect("valid").points
    }

    #[test]
    fn swaps_lower_the_energy_until_no_pair_gains() {
        for n in [1, 2, 3, 10, 100] {
            let mut assignment = Assignment::new(&random(n), 64).expect("memory");
            let mut before = assignment.energy();
            let mut sweeps = 0;
            while assignment.sweep() > 0 {
                let energy = assignment.energy();
                assert!(energy < before * (1.0 + 1e-12), "{energy} after {before}");
                before = energy;
                sweeps += 1;
                assert!(sweeps < 200, "{n} sites don't come to rest");
            }
            // At rest no two samples of any two sites gain by a swap, reach or not.
            for i in 0..n {
                for j in 0..i {
                    let most = [(i, j), (j, i)].map(|(own, other)| {
                        let places = [own, other].map(|site| Place::of(assignment.sites[site]));
                        let samples = assignment.samples.of(own, 64).iter();
                        let excess = samples
                            .map(|x| x.distance_squared(places[0]) - x.distance_squared(places[1]));
                        excess.fold(f64::NEG_INFINITY, f64::max)
                    });
                    // Rounding of squares of 2³².
                    assert!(most[0] + most[1] <= 1e4, "{i} and {j} of {n}");
                }
            }
        }
    }

    #[test]
    fn sites_find_the_means_of_their_samples() {
        let mut assignment = Assignment::new(&random(20), 256).expect("memory");
        while assignment.sweep() > 0 {}
        let before = assignment.energy();
        assignment.centre(1.0);
        assert!(assignment.unrest().value() < 1e-6 && assignment.energy() < before);
        assert!(assignment.sites().iter().all(|p| torus::contains(*p)));
    }

    #[test]
    fn the_short_way_to_excesses_is_the_long_one() {
        let assignment = Assignment::new(&random(50), 30).expect("memory");
        for (i, j) in [(0, 1), (5, 30), (17, 40), (49, 2)] {
            let pair = Pair::new(&assignment, i, j);
            let samples = assignment.samples.of(i, 30);
            let long = |x: &Place| x.distance_squared(pair.here) - x.distance_squared(pair.there);
            for x in samples {
                assert!((pair.excess(*x) - long(x)).abs() <= 1e4);
            }
            let most = samples.iter().map(long).fold(f64::NEG_INFINITY, f64::max);
            assert!((pair.most(samples) - most).abs() <= 1e4);
        }
    }

    #[test]
    fn finer_samples_hardly_change_the_energy() {
        let mut assignment = Assignment::new(&random(40), 64).expect("memory");
        while assignment.sweep() > 0 {}
        let before = assignment.energy();
        assignment.refine().expect("memory");
        // The samples' own second moment: 1/6 of a cell's area, less a quarter of that.
        let gain = 1.0 / (6.0 * 64.0) * 0.75;
        let refined = assignment.energy();
        assert!((refined - before - gain).abs() < 1e-3);
        while assignment.sweep() > 0 {}
        assert!(assignment.energy() < refined);
    }

    #[test]
    fn coincident_sites_part() {
        let set = PointSet::new(vec![DVec2::splat(0.5); 9]).expect("valid");
        let mut assignment = Assignment::new(&set, 64).expect("memory");
        for _ in 0..100 {
            assignment.sweep();
            assignment.centre(1.0);
        }
        let sites = PointSet::new(assignment.sites).expect("on the torus");
        assert!(bn_geometry::Spacing::new(&sites).min() > 0.2);
    }
}
