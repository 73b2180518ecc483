//! ν_eff and Ω from the powers of the modes, by way of ring means.

use bn_core::{Density, NormalizedFrequency};

use super::{LOUD_POWER, ONSET_POWER, OSCILLATION_RANGE, OSCILLATION_SCALE};

/// Mean powers over rings `bounds[i]` < |k| ≤ `bounds[i + 1]` of modes, from an exact periodogram.
///
/// What ν_eff needs is the sum over all modes below a frequency, so that its resolution is that of
/// the bounds (within a ring the modes count as evenly spread) and its noise does not depend on
/// them; Ω is about the ring means themselves and grows with their noise, the narrower the rings.
/// Rings of width 1 suit both: a step at ν is then known to ±0.5/√n.
#[derive(Clone, Copy, Debug)]
pub struct RingMeans<'a> {
    bounds: &'a [f64],
    power: &'a [f64],
    modes: &'a [u64],
}

/// Fewer modes than this can have a mean power below any threshold by chance.
const FEWEST_MODES: f64 = 12.0;

impl<'a> RingMeans<'a> {
    /// The rings between `bounds` (cycles per unit, ascending from 0, the mode 0 not counted), with
    /// the mean `power` over each and the number of its `modes`, where k and −k count as two. The
    /// power of a ring without modes is not looked at.
    ///
    /// # Panics
    /// If there is not one bound more than powers and as many powers as mode counts, or the bounds
    /// don't ascend from a number ≥ 0.
    pub fn new(bounds: &'a [f64], power: &'a [f64], modes: &'a [u64]) -> Self {
        assert_eq!(bounds.len(), power.len() + 1, "one bound more than rings");
        assert_eq!(power.len(), modes.len(), "one mode count for every ring");
        assert!(bounds[0] >= 0.0 && bounds.is_sorted_by(|a, b| a < b), "bounds must ascend from 0");
        Self { bounds, power, modes }
    }

    /// Mode count, as a number, and power of ring `i`; no power without modes.
    fn ring(&self, i: usize) -> (f64, f64) {
        match self.modes[i] {
            0 => (0.0, 0.0),
            modes => (modes as f64, self.power[i]),
        }
    }

    /// The effective Nyquist frequency: with the mean power over all modes 0 < |k| ≤ ν, from the
    /// first bound ν ≥ √n/2 where it exceeds ½ down to the largest ν where it is below `quiet`
    /// ([`QUIET_POWER`](super::QUIET_POWER) in the thesis) and at least 12 modes are counted; half of it.
    ///
    /// 0 if the mean never is below `quiet`; `None` if it never exceeds ½ above √n/2.
    pub fn effective_nyquist(&self, density: Density, quiet: f64) -> Option<NormalizedFrequency> {
        // Modes and power up to each bound; the mean of no modes is taken for silence.
        let mut below = vec![(0.0, 0.0)];
        for i in 0..self.power.len() {
            let (modes, power) = self.ring(i);
            below.push((below[i].0 + modes, below[i].1 + modes * power));
        }
        let start = density.grid_nyquist();
        let is_loud = |&i: &usize| {
            self.bounds[i] >= start && below[i].0 > 0.0 && below[i].1 > LOUD_POWER * below[i].0
        };
        let loud = (0..below.len()).find(is_loud)?;
        for i in (0..loud).rev() {
            let (modes, power) = below[i];
            if modes < FEWEST_MODES {
                break;
            }
            if power < quiet * modes {
                let crossing = self.crossing(i, quiet * modes - power, quiet);
                return Some(density.normalize_frequency(crossing / 2.0));
            }
        }
        Some(density.normalize_frequency(0.0))
    }

    /// The frequency in ring `i` up to which its modes have used up `margin`, the power that was
    /// missing below the ring for a mean of `quiet`.
    fn crossing(&self, i: usize, margin: f64, quiet: f64) -> f64 {
        let (modes, power) = self.ring(i);
        let fraction = (margin / (modes * (power - quiet))).clamp(0.0, 1.0);
        let (inner, outer) = (self.bounds[i], self.bounds[i + 1]);
        (inner * inner + fraction * (outer * outer - inner * inner)).sqrt()
    }

    /// ν₀ of the oscillation: the inner bound of the first ring with P ≥ 0.98, cycles per unit.
    pub fn onset(&self) -> Option<f64> {
        self.onset_ring().map(|ring| self.bounds[ring])
    }

    fn onset_ring(&self) -> Option<usize> {
        (0..self.power.len()).find(|&i| self.modes[i] > 0 && self.power[i] >= ONSET_POWER)
    }

    /// The oscillation Ω: ten times the root mean square of P − 1, weighted by modes, from the first
    /// ring with P ≥ 0.98 (its inner bound is ν₀) to ν₀ + 10·√n/2, where the last ring counts by
    /// the share of its area.
    ///
    /// `None` if no ring reaches 0.98 or the rings end before.
    pub fn oscillation(&self, density: Density) -> Option<f64> {
        let rings = 0..self.power.len();
        let first = self.onset_ring()?;
        let end = self.bounds[first] + OSCILLATION_RANGE * density.grid_nyquist();
        if self.bounds[self.power.len()] < end {
            return None;
        }
        let (mut squares, mut weights) = (0.0, 0.0);
        for i in rings.skip(first).take_while(|&i| self.bounds[i] < end) {
            let (inner, outer) = (self.bounds[i], self.bounds[i + 1]);
            let covered = outer.min(end);
            let share = (covered * covered - inner * inner) / (outer * outer - inner * inner);
            let (modes, power) = self.ring(i);
            squares += share * modes * (power - 1.0) * (power - 1.0);
            weights += share * modes;
        }
        Some(OSCILLATION_SCALE * (squares / weights).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bounds 0.5, 1.5, …, and in each ring the modes with its share of an expected power.
    fn rings(count: usize, power: impl Fn(f64) -> f64) -> (Vec<f64>, Vec<f64>, Vec<u64>) {
        let (mut sums, mut modes) = (vec![0.0; count], vec![0_u64; count]);
        let reach = count as i64;
        for (x, y) in (-reach..=reach).flat_map(|x| (-reach..=reach).map(move |y| (x, y))) {
            let nu = ((x * x + y * y) as f64).sqrt();
            let ring = (nu + 0.5).floor() as usize;
            if (1..=count).contains(&ring) {
                sums[ring - 1] += power(nu);
                modes[ring - 1] += 1;
            }
        }
        let means = sums.iter().zip(&modes).map(|(s, &m)| s / m as f64).collect();
        ((0..=count).map(|i| i as f64 + 0.5).collect(), means, modes)
    }

    #[test]
    fn step_and_lattice() {
        let density = Density::new(1024);
        let nu0 = 18.0;
        let (bounds, power, modes) = rings(200, |nu| f64::from(u8::from(nu >= nu0)));
        let rings_of_step = RingMeans::new(&bounds, &power, &modes);
        let got = rings_of_step.effective_nyquist(density, 0.1).expect("exists").value();
        // 1/√0.9 of the step; lattice points on a disk scatter by a few in a thousand.
        assert!((got - nu0 / 0.9_f64.sqrt() / 32.0).abs() < 0.01, "{got}");
        assert!(rings_of_step.oscillation(density).expect("exists") < 0.5);
        // All power of the square grid in the four modes |k| = 32, those of |k| = 32√2 and so on.
        let on_grid = |nu: f64| {
            let square = (nu / 32.0).powi(2).round();
            let hit = (nu * nu - 1024.0 * square).abs() < 1e-6;
            if hit && [1.0, 2.0, 4.0, 5.0, 8.0].contains(&square) { 1024.0 } else { 0.0 }
        };
        let (bounds, power, modes) = rings(60, on_grid);
        let grid = RingMeans::new(&bounds, &power, &modes);
        let got = grid.effective_nyquist(density, 0.1).expect("exists").value();
        assert!((got - 1.0).abs() <= 0.5 / 32.0, "{got}");
        assert_eq!(grid.oscillation(density), None);
    }

    /// Chance makes the first ring silent: with 12 modes asked for, ν_eff stays 0.
    #[test]
    fn few_silent_modes_are_not_a_gap() {
        let density = Density::new(1024);
        let (bounds, mut power, modes) = rings(200, |_| 1.0);
        power[0] = 0.0;
        assert!(modes[0] < 12);
        let white = RingMeans::new(&bounds, &power, &modes);
        assert_eq!(
            white.effective_nyquist(density, 0.1).map(NormalizedFrequency::value),
            Some(0.0)
        );
        assert_eq!(white.oscillation(density), Some(0.0));
    }

    #[test]
    fn empty_and_short_data() {
        let density = Density::new(4);
        let none = RingMeans::new(&[0.0], &[], &[]);
        assert_eq!(none.effective_nyquist(density, 0.1), None);
        assert_eq!(none.oscillation(density), None);
        let hollow = RingMeans::new(&[0.0, 2.0, 40.0], &[f64::NAN, 1.0], &[0, 100]);
        assert_eq!(
            hollow.effective_nyquist(density, 0.1).map(NormalizedFrequency::value),
            Some(0.0)
        );
        assert_eq!(hollow.oscillation(density), Some(0.0));
    }
}
