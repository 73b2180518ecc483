//! A point set laid over the image plane again and again, more densely each time.

use bn_core::{DVec2, PointSet, Seed};
use rand::RngExt;

use crate::pattern::check_rate;
use crate::{Pattern, PatternError, TileVariation};

/// Layers of one point set: every layer is the whole set, tiled at its own rate and shifted on the
/// torus by its own random vector, so that the errors of two layers are independent of each other.
///
/// Each layer is four times as dense as the one before, and an image is made of the densest alone:
/// the union of shifted layers would lose what sets a good pattern apart from independent samples.
/// The layer before serves to judge it. Level 0, the pilot, has the first two layers; all samples of
/// a level together are [`samples_per_pixel`](Self::samples_per_pixel), of which the last layer has
/// 3/4 or more.
#[derive(Clone, Debug)]
pub struct ProgressivePattern {
    layers: Vec<Pattern>,
}

impl ProgressivePattern {
    /// How many times as dense each layer is as the one before.
    pub(super) const GROWTH: f64 = 4.0;

    /// The set in levels of `pilot` samples per pixel and more, the last of at most `most` (but at
    /// least one level), shifts drawn from `seed`.
    ///
    /// Memory: a copy of the set for each layer.
    ///
    /// # Errors
    /// If a rate is not a number from 2⁻¹⁶ to 2¹⁶.
    pub fn new(set: &PointSet, pilot: f64, most: f64, seed: Seed) -> Result<Self, PatternError> {
        let first = pilot / (1.0 + Self::GROWTH);
        // Checks both: `most` need not be the rate of any layer, and from a first of 0 on layers would
        // have no end.
        check_rate(first)?;
        check_rate(most)?;
        let mut rates = vec![first, pilot - first];
        let (mut total, mut next) = (pilot, first * Self::GROWTH.powi(2));
        while total + next <= most {
            rates.push(next);
            total += next;
            next *= Self::GROWTH;
        }
        let layer = |(index, &rate): (usize, &f64)| {
            let mut rng = seed.stream(index as u32);
            let shift = DVec2::new(rng.random(), rng.random());
            Pattern::tiled(&set.translated(shift), rate)
        };
        let layers = rates.iter().enumerate().map(layer).collect::<Result<_, _>>()?;
        Ok(Self { layers })
    }

    /// The same with tiles that differ within each layer.
    #[must_use]
    pub fn varied(self, variation: TileVariation) -> Self {
        let layers = self.layers.into_iter().map(|layer| layer.varied(variation)).collect();
        Self { layers }
    }

    /// Number of levels, the pilot included.
    pub fn levels(&self) -> usize {
        self.layers.len() - 1
    }

    /// Samples per pixel of all layers that `level` takes.
    ///
    /// # Panics
    /// If there is no such level.
    pub fn samples_per_pixel(&self, level: usize) -> f64 {
        self.layers[..level + 2].iter().map(Pattern::samples_per_pixel).sum()
    }

    /// The layers, those of level ℓ up to index ℓ + 1.
    pub(super) fn layers(&self) -> &[Pattern] {
        &self.layers
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Rect;

    fn set() -> PointSet {
        let points = (0..64).map(|i| DVec2::new(f64::from(i % 8), f64::from(i / 8)) / 8.0);
        PointSet::new(points.collect()).expect("a set")
    }

    #[test]
    fn levels_hold_their_rates() {
        let pattern = ProgressivePattern::new(&set(), 3.0, 30.0, Seed::new(1)).expect("rates");
        assert_eq!(pattern.levels(), 2);
        let area = Rect::new(0.0, 0.0, 200.0, 200.0);
        let mut total = 0;
        for (i, layer) in pattern.layers().iter().enumerate() {
            total += layer.count_in(&area);
            if i > 0 {
                let rate = pattern.samples_per_pixel(i - 1);
                let count = rate * 4e4;
                // A grid's count is off by its border.
                assert!((total as f64 - count).abs() < 0.03 * count, "{total} for {count}");
            }
        }
        let one = ProgressivePattern::new(&set(), 3.0, 1.0, Seed::new(1)).expect("rates");
        assert_eq!(one.levels(), 1);
        for (pilot, most) in [(0.0, 4.0), (f64::NAN, 4.0), (1.0, f64::INFINITY), (1e-5, 1.0)] {
            assert!(ProgressivePattern::new(&set(), pilot, most, Seed::new(1)).is_err());
        }
    }
}
