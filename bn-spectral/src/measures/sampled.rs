//! ν_eff and Ω of a spectrum that is given by samples at uniform frequencies.

use bn_core::{Curve, Density, NormalizedFrequency};

use super::{LOUD_POWER, ONSET_POWER, OSCILLATION_RANGE, OSCILLATION_SCALE};

/// The effective Nyquist frequency of a spectrum sampled at ν = 0, Δν, 2Δν, … cycles per unit.
///
/// With the mean power up to ν, C(ν) = Σ 2ν′P(ν′)Δν/ν² (last sample included): from the first
/// ν ≥ √n/2 with C > ½ down to the first with C < `quiet`, half of that frequency; the thesis uses
/// [`QUIET_POWER`](super::QUIET_POWER) = 0.1. It is a multiple of Δν/2, 0 if C stays above `quiet` all the
/// way down, and `None` if C never exceeds ½ above √n/2 within the samples.
///
/// # Panics
/// If the samples don't start at 0.
pub fn effective_nyquist(
    power: &Curve,
    density: Density,
    quiet: f64,
) -> Option<NormalizedFrequency> {
    let mean = mean_power(power);
    // A grid that is meant to have a sample at √n/2 may miss it by rounding.
    let start = density.grid_nyquist() * (1.0 - 1e-9);
    let loud = (0..mean.len()).find(|&j| power.abscissa(j) >= start && mean[j] > LOUD_POWER)?;
    let edge = (0..=loud).rev().find(|&j| mean[j] < quiet).unwrap_or(0);
    Some(density.normalize_frequency(power.abscissa(edge) / 2.0))
}

/// C(ν) at every sample, 0 at ν = 0.
fn mean_power(power: &Curve) -> Vec<f64> {
    assert!(power.start() == 0.0, "the samples start at {} and not at 0", power.start());
    let mut sum = 0.0;
    let samples = power.iter().map(|(nu, p)| {
        sum += 2.0 * nu * p * power.step();
        if nu > 0.0 { sum / (nu * nu) } else { 0.0 }
    });
    samples.collect()
}

/// The oscillation Ω of a spectrum sampled at ν = 0, Δν, 2Δν, … cycles per unit:
///
/// Ω = 10·√(2π ∫ (P − 1)² ν dν / (π(ν₁² − ν₀²))) from the first ν₀ with P ≥ 0.98 to
/// ν₁ = ν₀ + 10·√n/2. `None` if P never reaches 0.98 or the samples end before ν₁, which for
/// samples up to n/2 happens below about 100 points.
///
/// # Panics
/// If the samples don't start at 0.
pub fn oscillation(power: &Curve, density: Density) -> Option<f64> {
    assert!(power.start() == 0.0, "the samples start at {} and not at 0", power.start());
    let (nu0, _) = power.iter().find(|&(_, p)| p >= ONSET_POWER)?;
    let nu1 = nu0 + OSCILLATION_RANGE * density.grid_nyquist();
    let end = nu1 * (1.0 + 1e-9);
    if power.end() + power.step() < nu1 {
        return None;
    }
    let ring = power.iter().filter(|&(nu, _)| nu >= nu0 && nu <= end);
    let sum: f64 = ring.map(|(nu, p)| (p - 1.0) * (p - 1.0) * nu * power.step()).sum();
    Some(OSCILLATION_SCALE * (2.0 * sum / (nu1 * nu1 - nu0 * nu0)).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// P = H(ν − ν₀): C = 1 − (ν₀/ν)², so ν_eff = ν₀/√(1 − quiet)/√n, to a sample.
    #[test]
    fn step_spectrum() {
        let (density, nu0) = (Density::new(1024), 18.05);
        let step = Curve::sample(0.0, 0.02, 15_000, |nu| f64::from(u8::from(nu >= nu0)));
        for quiet in [0.1, 0.01] {
            let want = nu0 / (1.0_f64 - quiet).sqrt() / 32.0;
            let got = effective_nyquist(&step, density, quiet).expect("exists").value();
            assert!((got - want).abs() < 2.0 * 0.02 / 32.0, "{got} for {want}");
        }
        assert_eq!(oscillation(&step, density), Some(0.0));
    }

    /// From ν₀ on P = 1 + a cos(ω(ν − ν₀)): Ω = 10·a/√2 for many periods.
    #[test]
    fn ringing_spectrum() {
        let a = 0.3;
        let ringing = |nu: f64| if nu < 20.0 { 0.0 } else { 1.0 + a * libm::cos(nu - 20.0) };
        let power = Curve::sample(0.0, 0.01, 30_000, ringing);
        let got = oscillation(&power, Density::new(1024)).expect("exists");
        // The end of the ring is cut at any phase: 1/(periods) of the value.
        assert!((got - 10.0 * a / 2.0_f64.sqrt()).abs() < 0.05, "{got}");
    }

    #[test]
    fn what_does_not_exist_is_none() {
        let density = Density::new(1024);
        let silent = Curve::sample(0.0, 0.5, 2000, |_| 0.2);
        assert_eq!(effective_nyquist(&silent, density, 0.1), None);
        assert_eq!(oscillation(&silent, density), None);
        let short = Curve::sample(0.0, 0.5, 300, |_| 1.0);
        assert_eq!(oscillation(&short, density), None);
        let white = Curve::sample(0.0, 0.5, 400, |_| 1.0);
        assert_eq!(oscillation(&white, density), Some(0.0));
        assert_eq!(
            effective_nyquist(&white, density, 0.1).map(NormalizedFrequency::value),
            Some(0.0)
        );
    }
}
