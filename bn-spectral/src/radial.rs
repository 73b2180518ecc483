//! Means and variances of a periodogram over rings of modes.

use bn_core::{Curve, Density, NormalizedFrequency, PointSet};
use rayon::prelude::*;

use crate::periodogram::PowerBlock;
use crate::{NufftError, PeriodogramOptions, QUIET_POWER, RingMeans};

/// Rings are one cycle per unit wide: each has modes.
const RING_WIDTH: f64 = 1.0;
/// The inner bound of the first.
const INNERMOST: f64 = 0.5;

/// Columns that are sorted into rings as one piece of work.
const COLUMNS: usize = 32;

/// Sums over the modes of rings; modes come from the half plane and count twice, for k and −k.
#[derive(Clone, Debug)]
struct RingSums {
    width: f64,
    modes: Vec<u64>,
    power: Vec<f64>,
    squares: Vec<f64>,
}

impl RingSums {
    fn new(rings: usize, width: f64) -> Self {
        let zeros = vec![0.0; rings];
        Self { width, modes: vec![0; rings], power: zeros.clone(), squares: zeros }
    }

    fn add_column(&mut self, kx: usize, limit: usize, power: &[f64]) {
        // Of the column kx = 0 the half ky > 0 stands for the other, and the mode 0 is left out.
        let first = if kx == 0 { limit + 1 } else { 0 };
        for (i, &p) in power.iter().enumerate().skip(first) {
            let ky = i as i64 - limit as i64;
            let square = (kx * kx) as f64 + (ky * ky) as f64;
            let ring = ((square.sqrt() - INNERMOST) / self.width) as usize;
            if ring < self.modes.len() {
                self.modes[ring] += 2;
                self.power[ring] += 2.0 * p;
                self.squares[ring] += 2.0 * p * p;
            }
        }
    }

    fn merge(&mut self, other: &Self) {
        for i in 0..self.modes.len() {
            self.modes[i] += other.modes[i];
            self.power[i] += other.power[i];
            self.squares[i] += other.squares[i];
        }
    }

    /// Adds a block's columns: pieces in parallel, joined in order.
    fn add(&mut self, block: &PowerBlock<'_>) {
        let columns: Vec<(usize, &[f64])> = block.iter().collect();
        let pieces: Vec<Self> = columns
            .par_chunks(COLUMNS)
            .map(|columns| {
                let mut sums = Self::new(self.modes.len(), self.width);
                for (kx, power) in columns {
                    sums.add_column(*kx, block.max_frequency, power);
                }
                sums
            })
            .collect();
        for piece in &pieces {
            self.merge(piece);
        }
    }
}

/// The radial power spectrum of a set or an ensemble: the mean and the variance of the periodogram
/// over rings i + ½ < |k| < i + 3⁄2 of modes, i = 0, 1, …, the mode 0 left out.
///
/// Ring i is centred at i + 1 cycles per unit. Of disordered points a ring of c modes has a mean
/// of variance about 2P²/(c·sets).
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct RadialPower {
    density: Density,
    bounds: Vec<f64>,
    modes: Vec<u64>,
    means: Vec<f64>,
    variances: Vec<f64>,
}

impl RadialPower {
    /// The ring means of the sets' mean periodogram, up to the ring at `options.max_frequency()`;
    /// without any ring for K = 0.
    ///
    /// Modes are streamed; memory is that of [`PeriodogramOptions`].
    ///
    /// # Errors
    /// If the periodogram can't be planned for.
    ///
    /// # Panics
    /// If there is no set.
    pub fn of(sets: &[PointSet], options: PeriodogramOptions) -> Result<Self, NufftError> {
        Self::in_rings(sets, options, RING_WIDTH)
    }

    /// The same in rings of another width, one cycle or an integer part of it. The innermost of
    /// narrower rings may have no mode: their means and variances are NaN.
    pub(crate) fn in_rings(
        sets: &[PointSet],
        options: PeriodogramOptions,
        width: f64,
    ) -> Result<Self, NufftError> {
        assert!(!sets.is_empty(), "a spectrum needs a set");
        let rings = (options.max_frequency() as f64 / width).round() as usize;
        let mut sums = RingSums::new(rings, width);
        // The outermost ring ends half a cycle beyond K, before the next integer.
        options.for_each_block(sets, |block| sums.add(block))?;
        let means: Vec<f64> = (0..rings).map(|i| sums.power[i] / sums.modes[i] as f64).collect();
        // Unbiased: k and −k are one observation.
        let variance = |i: usize| {
            let (count, pairs) = (sums.modes[i] as f64, sums.modes[i] as f64 / 2.0);
            (sums.squares[i] / count - means[i] * means[i]).max(0.0) * pairs / (pairs - 1.0)
        };
        Ok(Self {
            density: sets[0].density(),
            bounds: (0..=rings).map(|i| i as f64 * width + INNERMOST).collect(),
            variances: (0..rings).map(variance).collect(),
            modes: sums.modes,
            means,
        })
    }

    /// The mean of spectra of ensembles of equally many sets of one size, ring by ring.
    ///
    /// The variance of a ring is the mean of the variances: that within the sets, not that of
    /// their mean periodogram.
    ///
    /// # Panics
    /// If there is no spectrum, or they differ in density or range.
    pub fn mean_of(spectra: &[&Self]) -> Self {
        let mut mean = spectra.first().copied().expect("a mean needs a spectrum").clone();
        let share = 1.0 / spectra.len() as f64;
        let alike = |other: &Self| other.density == mean.density && other.bounds == mean.bounds;
        assert!(spectra.iter().all(|other| alike(other)), "the spectra differ in kind");
        for ring in 0..mean.means.len() {
            mean.means[ring] = spectra.iter().map(|one| one.means[ring]).sum::<f64>() * share;
            mean.variances[ring] =
                spectra.iter().map(|one| one.variances[ring]).sum::<f64>() * share;
        }
        mean
    }

    /// The inner bound of the first ring whose mean power reaches 0.98, from where Ω looks at the
    /// spectrum.
    pub fn onset(&self) -> Option<f64> {
        self.rings().onset()
    }

    /// Bounds of the rings in cycles per unit, one more than rings.
    pub fn bounds(&self) -> &[f64] {
        &self.bounds
    }

    /// Number of modes of each ring, k and −k both counted.
    pub fn modes(&self) -> &[u64] {
        &self.modes
    }

    /// Mean power of each ring.
    pub fn means(&self) -> &[f64] {
        &self.means
    }

    /// The radial power at the rings' centres, in cycles per unit; `None` without rings.
    pub fn curve(&self) -> Option<Curve> {
        let &[inner, outer, ..] = self.bounds.as_slice() else { return None };
        Some(Curve::new(0.5 * (inner + outer), outer - inner, self.means.clone()))
    }

    /// Anisotropy in dB at the rings' centres: 10·log₁₀ of the variance of the power within the
    /// ring over its squared mean (Ulichney 1987). For disordered points of m sets about
    /// −10·log₁₀ m. NaN where the mean is 0 or the ring has only two modes, −∞ where all powers are
    /// equal; `None` without rings. Where the exact power is 0, as between a lattice's peaks, the
    /// figure is that of the transform's errors.
    pub fn anisotropy_db(&self) -> Option<Curve> {
        let curve = self.curve()?;
        let decibels = (0..self.means.len()).map(|i| {
            let (mean, variance) = (self.means[i], self.variances[i]);
            if mean > 0.0 && self.modes[i] > 2 {
                10.0 * libm::log10(variance / (mean * mean))
            } else {
                f64::NAN
            }
        });
        Some(Curve::new(curve.start(), curve.step(), decibels.collect()))
    }

    /// The rings as the measures take them.
    pub fn rings(&self) -> RingMeans<'_> {
        RingMeans::new(&self.bounds, &self.means, &self.modes)
    }

    /// ν_eff in √n/2 by [`RingMeans::effective_nyquist`] at the thesis's threshold.
    pub fn effective_nyquist(&self) -> Option<NormalizedFrequency> {
        self.rings().effective_nyquist(self.density, QUIET_POWER)
    }

    /// Ω by [`RingMeans::oscillation`].
    pub fn oscillation(&self) -> Option<f64> {
        self.rings().oscillation(self.density)
    }
}

/// The mean power of a set over the modes 0 < |k| < `frequency` (cycles per unit); `None` if there
/// is no such mode.
///
/// # Errors
/// If the periodogram can't be planned for.
pub fn power_below(set: &PointSet, frequency: f64) -> Result<Option<f64>, NufftError> {
    if frequency.is_nan() || frequency <= 1.0 {
        return Ok(None);
    }
    // Modes strictly below; the cast saturates, and the plan refuses what is too large.
    let limit = (frequency.ceil() as usize).saturating_sub(1);
    let (mut sum, mut count) = (0.0, 0_u64);
    PeriodogramOptions::new(limit).for_each_block(std::slice::from_ref(set), |block| {
        for (kx, column) in block.iter() {
            let first = if kx == 0 { limit + 1 } else { 0 };
            for (i, &p) in column.iter().enumerate().skip(first) {
                let ky = i as i64 - limit as i64;
                if ((kx * kx) as f64 + (ky * ky) as f64).sqrt() < frequency {
                    sum += p;
                    count += 1;
                }
            }
        }
    })?;
    Ok(Some(sum / count as f64))
}
