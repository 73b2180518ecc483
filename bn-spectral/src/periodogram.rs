//! Periodograms: P(k) = |Σⱼ exp(−2πi k·xⱼ)|²/n, streamed in blocks of columns.

use std::ops::Range;

use bn_core::PointSet;
use bn_fft::Complex;

use crate::{Nufft, NufftError, NufftOptions};

/// Numbers that a block of columns may hold: 512 MiB in the transform and up to 256 as power. Every
/// block spreads all points anew, so few are better.
const BLOCK_VALUES: usize = 1 << 25;

/// How a periodogram is evaluated: up to which frequency, how accurately.
///
/// *Error*: `tolerance` is the relative l2 error ε of the amplitudes S(k) = Σⱼ exp(−2πi k·xⱼ), whose
/// rms is about √n. Spread over all modes this is an error of about ε in S/√n, so a power comes out
/// with an error of about 2ε√P + ε²: with the default ε = 1e-6 a power of 1 is good to 2e-6 and a
/// mean power of 1e-12 can still be told from 0. On lattices, where the errors of all points agree,
/// ε is up to three times `tolerance` and the power of a mode up to n·ε² off.
///
/// *Cost*: one NUFFT a set and block of columns, O(n + K² log K) in all for modes |kx|, |ky| ≤ K;
/// memory O(n + K²) and never above O(n) plus about 800 MiB, whatever K.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PeriodogramOptions {
    max_frequency: usize,
    tolerance: f64,
    portable: bool,
}

/// The mean power of some columns of modes.
pub(crate) struct PowerBlock<'a> {
    /// Which kx.
    pub columns: Range<usize>,
    /// K.
    pub max_frequency: usize,
    /// Column after column, ky from −K to K.
    pub power: &'a [f64],
}

impl PowerBlock<'_> {
    /// Each column's kx and its powers at ky = −K … K.
    pub fn iter(&self) -> impl Iterator<Item = (usize, &[f64])> {
        self.columns.clone().zip(self.power.chunks_exact(2 * self.max_frequency + 1))
    }
}

impl PeriodogramOptions {
    /// Modes with |kx|, |ky| ≤ `max_frequency`, to the default tolerance 1e-6.
    pub fn new(max_frequency: usize) -> Self {
        Self { max_frequency, tolerance: 1e-6, portable: false }
    }

    /// The same to another tolerance; values outside [1e-13, 1e-2] count as the nearest in it.
    #[must_use]
    pub fn with_tolerance(self, tolerance: f64) -> Self {
        Self { tolerance, ..self }
    }

    /// Keeps to instructions that every CPU has, so that no digit depends on the one at hand; some
    /// 1.5 times slower.
    #[must_use]
    pub fn portable(self) -> Self {
        Self { portable: true, ..self }
    }

    /// K.
    pub fn max_frequency(self) -> usize {
        self.max_frequency
    }

    /// The same for |kx|, |ky| ≤ `max_frequency`.
    pub(crate) fn to(self, max_frequency: usize) -> Self {
        Self { max_frequency, ..self }
    }

    /// Hands the half plane kx ≥ 0 of the sets' mean periodogram to `take`, block by block in the
    /// order of kx. The mode 0 comes as it is, n.
    pub(crate) fn for_each_block(
        self,
        sets: &[PointSet],
        mut take: impl FnMut(&PowerBlock<'_>),
    ) -> Result<(), NufftError> {
        let points = sets.iter().map(PointSet::len).max().unwrap_or(1);
        let options = NufftOptions::new(self.max_frequency, self.tolerance).expecting(points);
        let options = if self.portable { options.portable() } else { options };
        let mut plan: Nufft = options.plan()?;
        let side = 2 * self.max_frequency + 1;
        let most = (BLOCK_VALUES / plan.grid_size()).max(1);
        // Blocks of equal width: a narrow last one would cost as much as the others.
        let width = (self.max_frequency + 1).div_ceil((self.max_frequency + 1).div_ceil(most));
        let mut power = Vec::new();
        for first in (0..=self.max_frequency).step_by(width) {
            let columns = first..(first + width).min(self.max_frequency + 1);
            power.clear();
            power.resize(columns.len() * side, 0.0);
            for set in sets {
                let scale = 1.0 / (set.len() as f64 * sets.len() as f64);
                let modes = plan.transform(set.points(), None, columns.clone());
                let outputs = power.chunks_exact_mut(side).collect();
                modes.each(columns.clone(), outputs, |_, output, modes| {
                    add_power(scale, modes, output);
                });
            }
            take(&PowerBlock { columns, max_frequency: self.max_frequency, power: &power });
        }
        Ok(())
    }
}

fn add_power(scale: f64, modes: &[Complex<f64>], power: &mut [f64]) {
    for (power, mode) in power.iter_mut().zip(modes) {
        *power += scale * mode.norm_sqr();
    }
}

/// The periodogram of a set, or the mean of several: P(k) = |Σⱼ exp(−2πi k·xⱼ)|²/n on the unit
/// torus (thesis section 5.1, where the 1/n is missing; eq. 5.3), P → 1 for large k.
///
/// Of independent points every P(k), k ≠ 0, has mean 1 and variance (1 − 1/n)/sets.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Periodogram {
    max_frequency: usize,
    /// Column after column of the half plane kx ≥ 0.
    power: Vec<f64>,
}

impl Periodogram {
    /// The mean periodogram of `sets`.
    ///
    /// Holds all modes in memory: 8·(K + 1)(2K + 1) bytes. [`RadialPower`](crate::RadialPower) and
    /// [`PowerImage`](crate::PowerImage) don't.
    ///
    /// # Errors
    /// If the tolerance or the largest frequency can't be planned for.
    pub fn of(sets: &[PointSet], options: PeriodogramOptions) -> Result<Self, NufftError> {
        let mut power = Vec::new();
        options.for_each_block(sets, |block| power.extend_from_slice(block.power))?;
        Ok(Self { max_frequency: options.max_frequency, power })
    }

    /// K: modes have |kx|, |ky| ≤ K.
    pub fn max_frequency(&self) -> usize {
        self.max_frequency
    }

    /// P(kx, ky); n at the mode 0, the square of the mean.
    ///
    /// # Panics
    /// If the mode is beyond K.
    pub fn power(&self, kx: i64, ky: i64) -> f64 {
        let limit = self.max_frequency as i64;
        assert!(kx.abs() <= limit && ky.abs() <= limit, "mode ({kx}, {ky}) is beyond {limit}");
        let (kx, ky) = if kx < 0 { (-kx, -ky) } else { (kx, ky) };
        self.power[(kx * (2 * limit + 1) + ky + limit) as usize]
    }
}
