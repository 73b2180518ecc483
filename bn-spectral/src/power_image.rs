//! The power spectrum as an image.

use bn_core::PointSet;

use crate::{NufftError, PeriodogramOptions};

/// The mean periodogram of sets over the square of modes |kx|, |ky| ≤ K, mode by mode or averaged
/// over blocks of modes, as an image. The mode 0 is left out.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct PowerImage {
    half_width: f64,
    side: usize,
    power: Vec<f64>,
}

impl PowerImage {
    /// The image of at most `most_cells` cells a side: where there are more modes, cells of b × b
    /// modes with an odd b, so that one is centred at 0 and the image is symmetric; K is rounded up
    /// to whole cells.
    ///
    /// Modes are streamed; memory is that of [`PeriodogramOptions`] and of the image.
    ///
    /// # Errors
    /// If the periodogram can't be planned for.
    ///
    /// # Panics
    /// If `most_cells` is 0.
    pub fn of(
        sets: &[PointSet],
        options: PeriodogramOptions,
        most_cells: usize,
    ) -> Result<Self, NufftError> {
        assert!(most_cells > 0, "an image needs cells");
        let modes = 2 * options.max_frequency() + 1;
        let block = modes.div_ceil(most_cells) | 1;
        let beyond = (options.max_frequency() + 1).saturating_sub(block.div_ceil(2));
        let arm = beyond.div_ceil(block);
        let side = 2 * arm + 1;
        let limit = arm * block + block / 2;
        let (mut sums, mut counts) = (vec![0.0; side * side], vec![0_u32; side * side]);
        let cell = |k: i64| ((k + limit as i64) / block as i64) as usize;
        options.to(limit).for_each_block(sets, |columns| {
            for (kx, column) in columns.iter() {
                for (i, &p) in column.iter().enumerate() {
                    let (kx, ky) = (kx as i64, i as i64 - limit as i64);
                    if (kx, ky) == (0, 0) {
                        continue;
                    }
                    let mut add = |kx: i64, ky: i64| {
                        let at = cell(ky) * side + cell(kx);
                        sums[at] += p;
                        counts[at] += 1;
                    };
                    add(kx, ky);
                    if kx != 0 {
                        add(-kx, -ky);
                    }
                }
            }
        })?;
        let mean = |(sum, &count): (&f64, &u32)| sum / f64::from(count);
        let power = sums.iter().zip(&counts).map(mean).collect();
        Ok(Self { half_width: limit as f64 + 0.5, side, power })
    }

    /// Half the side of the image in cycles per unit: it shows [−h, h]².
    pub fn half_width(&self) -> f64 {
        self.half_width
    }

    /// Cells a side.
    pub fn side(&self) -> usize {
        self.side
    }

    /// The mean power of each cell, row by row from the lowest ky; NaN in a cell of the mode 0 alone.
    pub fn power(&self) -> &[f64] {
        &self.power
    }
}
