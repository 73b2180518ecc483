//! Every statistic of a point set or an ensemble, each computed at most once and only if asked for.

mod direct;
mod page;
mod statistic;
mod summary;
mod thinning;
mod windowed;

use std::sync::OnceLock;

use bn_core::{Curve, Density, PointSet};
use bn_geometry::{Coverage, Spacing, Triangulation, bond_orientational_order};
use bn_spectral::{PairHistogram, RadialPower, RdfToPower};
use rayon::prelude::*;

pub use self::direct::Direct;
pub use self::statistic::{Estimate, Statistic};
pub use self::summary::Summary;
pub use self::windowed::Windowed;

/// More points than this in a set make the windowed estimator, which compares all pairs, take over
/// ten seconds a set and core.
pub const WINDOWED_LIMIT: usize = 200_000;

/// More points than this in a set ask for a periodogram beyond what can be planned.
pub const SPECTRAL_LIMIT: usize = 100_000_000;

/// The largest frequency, in cycles per unit, of [`Statistic::PowerBelow`]: 2·10⁸ modes.
pub const POWER_BELOW_LIMIT: f64 = 8192.0;

/// The statistics of sets of equally many points, computed when first asked for and then kept.
///
/// The sets of an ensemble are worked on in parallel; no value depends on the number of threads.
#[derive(Debug)]
pub struct Analysis<'a> {
    sets: &'a [PointSet],
    density: Density,
    power_below: Option<f64>,
    spacings: OnceLock<Vec<[f64; 2]>>,
    shapes: OnceLock<Vec<[f64; 2]>>,
    windowed: OnceLock<Windowed>,
    direct: OnceLock<Direct>,
    powers_below: OnceLock<Vec<f64>>,
}

impl<'a> Analysis<'a> {
    /// The analysis of an ensemble of `sets`, of which nothing is computed yet.
    ///
    /// # Panics
    /// If there is no set, or if the sets differ in size.
    pub fn of(sets: &'a [PointSet]) -> Self {
        assert!(!sets.is_empty(), "an analysis needs a set");
        let n = sets[0].len();
        assert!(sets.iter().all(|set| set.len() == n), "the sets differ in size");
        Self {
            sets,
            density: Density::new(n),
            power_below: None,
            spacings: OnceLock::new(),
            shapes: OnceLock::new(),
            windowed: OnceLock::new(),
            direct: OnceLock::new(),
            powers_below: OnceLock::new(),
        }
    }

    /// The same with the frequency, in cycles per unit, that [`Statistic::PowerBelow`] refers to.
    ///
    /// # Panics
    /// If the frequency is not positive or beyond [`POWER_BELOW_LIMIT`].
    #[must_use]
    pub fn with_power_below(self, frequency: f64) -> Self {
        assert!(frequency > 0.0 && frequency <= POWER_BELOW_LIMIT, "{frequency} is out of range");
        Self { power_below: Some(frequency), powers_below: OnceLock::new(), ..self }
    }

    /// The sets.
    pub fn sets(&self) -> &'a [PointSet] {
        self.sets
    }

    /// The density of each set.
    pub fn density(&self) -> Density {
        self.density
    }

    /// The statistic with its standard error over the sets; none where it is not defined: where a
    /// spectrum never reaches the thresholds of ν_eff or Ω, where no mode lies below the frequency of
    /// [`Statistic::PowerBelow`], or where that frequency was not given.
    pub fn estimate(&self, statistic: Statistic) -> Option<Estimate> {
        let mean = |rows: &[[f64; 2]], column: usize| {
            Estimate::mean(&rows.iter().map(|row| row[column]).collect::<Vec<_>>())
        };
        match statistic {
            Statistic::MinDistance => mean(self.spacings(), 0),
            Statistic::MeanDistance => mean(self.spacings(), 1),
            Statistic::CoverageRadius => mean(self.shapes(), 0),
            Statistic::BondOrder => mean(self.shapes(), 1),
            Statistic::NuEff => self.windowed().effective_nyquist(),
            Statistic::Omega => self.windowed().oscillation(),
            Statistic::NuEffDirect => self.direct().effective_nyquist(),
            Statistic::OmegaDirect => self.direct().oscillation(),
            Statistic::PowerBelow => Estimate::mean(self.powers_below()),
        }
    }

    /// The RDF in 100·√n bins over [0, ½), mean over the sets; lower edges of the bins.
    ///
    /// Counts all pairs: O(n²) a set.
    pub fn rdf(&self) -> Curve {
        self.rdf_within(0.5, RdfToPower::default_bins(self.sets[0].len()))
    }

    /// The RDF in `bins` bins over [0, `range`), mean over the sets; lower edges of the bins.
    ///
    /// # Panics
    /// If `range` is not in (0, ½] or there is no bin.
    pub fn rdf_within(&self, range: f64, bins: usize) -> Curve {
        let rdfs = self.each(|set| PairHistogram::within(set, range, bins).rdf());
        let mut sum = vec![0.0; bins];
        for rdf in &rdfs {
            for (sum, g) in sum.iter_mut().zip(rdf.values()) {
                *sum += g;
            }
        }
        let mean = sum.iter().map(|g| g / rdfs.len() as f64).collect();
        Curve::new(0.0, rdfs[0].step(), mean)
    }

    /// The radial power spectrum that the thesis's window takes from the RDF.
    ///
    /// Counts all pairs: O(n²) a set.
    pub fn windowed(&self) -> &Windowed {
        self.windowed.get_or_init(|| Windowed::of(self.sets))
    }

    /// The ring means of the periodogram up to where Ω ends.
    ///
    /// # Panics
    /// Like everything spectral, if a set has more than [`SPECTRAL_LIMIT`] points.
    pub fn direct(&self) -> &Direct {
        self.direct.get_or_init(|| Direct::of(self.sets))
    }

    /// The ring means of the sets' mean periodogram up to `max_frequency` cycles per unit, whose
    /// anisotropy is that of the ensemble.
    pub fn radial_power(&self, max_frequency: usize) -> RadialPower {
        direct::radial_power(self.sets, max_frequency)
    }

    /// The largest frequency, in cycles per unit, up to which figures show a spectrum by default:
    /// 10·√n/2, as the thesis does.
    pub fn shown_frequency(&self) -> usize {
        direct::shown_frequency(self.density)
    }

    /// `d_min` and `d_avg` of each set, over `d_hex`.
    fn spacings(&self) -> &[[f64; 2]] {
        self.spacings.get_or_init(|| {
            self.each(|set| {
                let spacing = Spacing::new(set);
                [spacing.min(), spacing.mean()].map(|d| self.density.normalize_distance(d).value())
            })
        })
    }

    /// Coverage radius over `d_hex` and Q⁶ of each set, which share the triangulation.
    fn shapes(&self) -> &[[f64; 2]] {
        self.shapes.get_or_init(|| {
            self.each(|set| {
                let triangulation = Triangulation::new(set);
                let radius = Coverage::of(&triangulation).map_or(f64::NAN, |c| c.radius);
                let order = bond_orientational_order(&triangulation, 6).unwrap_or(f64::NAN);
                [self.density.normalize_distance(radius).value(), order]
            })
        })
    }

    fn powers_below(&self) -> &[f64] {
        self.powers_below.get_or_init(|| match self.power_below {
            Some(frequency) => direct::powers_below(self.sets, frequency),
            None => Vec::new(),
        })
    }

    fn each<T: Send>(&self, f: impl Fn(&PointSet) -> T + Sync + Send) -> Vec<T> {
        self.sets.par_iter().map(f).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bn_core::DVec2;

    fn sets() -> Vec<PointSet> {
        let points = |shift: f64| {
            let at = |i: u32| DVec2::new(f64::from(i * 7 % 100) / 100.0, f64::from(i) / 100.0);
            (0..100).map(|i| (at(i) + DVec2::new(shift, 0.0)).fract()).collect()
        };
        [0.0, 0.3].map(|shift| PointSet::new(points(shift)).expect("valid")).into()
    }

    #[test]
    fn a_statistic_computes_nothing_else() {
        let sets = sets();
        let analysis = Analysis::of(&sets);
        let made = |a: &Analysis<'_>| {
            [
                a.spacings.get().is_some(),
                a.shapes.get().is_some(),
                a.windowed.get().is_some(),
                a.direct.get().is_some(),
            ]
        };
        assert_eq!(made(&analysis), [false; 4]);
        assert!(analysis.estimate(Statistic::MeanDistance).is_some());
        assert_eq!(made(&analysis), [true, false, false, false]);
        assert!(analysis.estimate(Statistic::BondOrder).is_some());
        assert_eq!(made(&analysis), [true, true, false, false]);
        assert!(analysis.estimate(Statistic::NuEffDirect).is_some());
        assert_eq!(made(&analysis), [true, true, false, true]);
        assert!(analysis.estimate(Statistic::NuEff).is_some());
        assert_eq!(made(&analysis), [true; 4]);
    }
}
