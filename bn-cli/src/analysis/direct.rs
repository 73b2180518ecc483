//! What comes from the exact periodogram.

use bn_core::{Density, PointSet};
use bn_spectral::{OSCILLATION_RANGE, PeriodogramOptions, RadialPower};

use super::Estimate;

/// Where to look first for the place where the spectrum reaches 1, in √n/2: beyond the first peak
/// of any pattern that is even, the hexagonal lattice's at 2.15 included.
const FIRST_LOOK: f64 = 3.0;

/// Where to stop looking.
const LAST_LOOK: f64 = 24.0;

/// The ring means of an ensemble's periodogram as far as ν_eff and Ω need them.
#[derive(Clone, Debug)]
pub struct Direct {
    mean: RadialPower,
    left_out: Vec<RadialPower>,
}

impl Direct {
    pub(super) fn of(sets: &[PointSet]) -> Self {
        let frequency =
            |relative: f64| (relative * sets[0].density().grid_nyquist()).ceil() as usize + 1;
        let mut look = FIRST_LOOK;
        while look < LAST_LOOK {
            let near = Self::within(sets, frequency(look));
            if let Some(onset) = near.last_onset() {
                return Self::within(sets, onset.ceil() as usize + frequency(OSCILLATION_RANGE));
            }
            look *= 2.0;
        }
        Self::within(sets, frequency(LAST_LOOK + OSCILLATION_RANGE))
    }

    /// The ring means up to `max_frequency` cycles per unit.
    fn within(sets: &[PointSet], max_frequency: usize) -> Self {
        let each: Vec<RadialPower> =
            sets.iter().map(|set| radial_power(std::slice::from_ref(set), max_frequency)).collect();
        let left_out = (0..each.len()).filter(|_| each.len() > 1).map(|i| {
            let others: Vec<&RadialPower> =
                each.iter().enumerate().filter(|(j, _)| *j != i).map(|(_, one)| one).collect();
            RadialPower::mean_of(&others)
        });
        let left_out = left_out.collect();
        let mean = RadialPower::mean_of(&each.iter().collect::<Vec<_>>());
        Self { mean, left_out }
    }

    /// From where Ω has to be looked at in the mean and with any set left out, if that is in range.
    fn last_onset(&self) -> Option<f64> {
        let mut last = self.mean.onset()?;
        for left_out in &self.left_out {
            last = last.max(left_out.onset()?);
        }
        Some(last)
    }

    pub(super) fn effective_nyquist(&self) -> Option<Estimate> {
        self.estimate(|power| Some(power.effective_nyquist()?.value()))
    }

    pub(super) fn oscillation(&self) -> Option<Estimate> {
        self.estimate(RadialPower::oscillation)
    }

    /// A figure of the mean spectrum, its error from the means with each set left out.
    fn estimate(&self, figure: impl Fn(&RadialPower) -> Option<f64>) -> Option<Estimate> {
        let left_out: Vec<Option<f64>> = self.left_out.iter().map(&figure).collect();
        Some(Estimate::jackknife(figure(&self.mean)?, &left_out))
    }
}

pub(super) fn radial_power(sets: &[PointSet], max_frequency: usize) -> RadialPower {
    RadialPower::of(sets, PeriodogramOptions::new(max_frequency))
        .expect("up to SPECTRAL_LIMIT points ask for frequencies that can be planned")
}

/// The mean power below `frequency` of each set; none if no mode lies there.
pub(super) fn powers_below(sets: &[PointSet], frequency: f64) -> Vec<f64> {
    let below = |set| {
        bn_spectral::power_below(set, frequency)
            .expect("frequencies up to POWER_BELOW_LIMIT can be planned")
    };
    sets.iter().filter_map(below).collect()
}

/// The largest frequency, in cycles per unit, up to which figures show a spectrum by default.
pub(super) fn shown_frequency(density: Density) -> usize {
    (OSCILLATION_RANGE * density.grid_nyquist()).ceil().max(1.0) as usize
}
