//! Coulomb forces in the plane, on the torus.

use bn_core::{DVec2, DensityFunction, PointSet};
use bn_spectral::{Complex, HalfPlane, Nufft, NufftOptions};
use std::f64::consts::PI;

use super::background::Background;
use super::pair_forces::pair_forces;
use crate::SampleError;

/// Forces between equal charges on the torus with a neutralising background of density ρ: −∇Φ with
/// −ΔΦ = 2π·(Σⱼ δ(x − xⱼ) − n·ρ(x)), so 1/r between two nearby charges.
///
/// P. P. Ewald's splitting in two dimensions: each charge is surrounded by a Gaussian cloud of the
/// opposite charge, of density exp(−r²/s²)/(πs²), which leaves exp(−r²/s²)/r between two charges,
/// summed pair by pair; the clouds' own field is smooth, a sum over modes k of
/// −i·k/|k|²·exp(−π²s²|k|²)·S(k)·exp(2πi k·x), with S(k) = Σⱼ exp(−2πi k·xⱼ). An uneven background adds
/// −n·ρ̂(k) to that, blurred by clouds of half the width: details finer than charges can show are left out.
pub(super) struct CoulombForces {
    /// s.
    width: f64,
    cutoff: f64,
    nufft: Nufft,
    structure: HalfPlane,
    clouds: Vec<Complex<f64>>,
    /// The background, if it is uneven, and its charge by modes.
    background: Option<(Background, HalfPlane)>,
}

/// Both parts leave out what is smaller than this, relative to the force of a charge at a cloud's
/// width.
const TOLERANCE: f64 = 1e-5;

/// Width of a cloud in mean spacings 1/√n: balances the work on both sides.
const CLOUD: f64 = 0.9;

/// Clouds are made narrower where charges are crowded, up to so often the mean density: the number of modes
/// grows as much.
const MOST_CROWDED: f64 = 16.0;

/// Clouds may be as narrow as for so many charges in any case.
const FEW: f64 = 16_384.0;

impl CoulombForces {
    /// Forces of `n` charges on a background of this density.
    pub(super) fn new(n: usize, density: Option<&DensityFunction>) -> Result<Self, SampleError> {
        // The density around a charge, on average.
        let crowding = density.map_or(1.0, |density| {
            let squares: f64 = density.values().iter().map(|value| value * value).sum();
            let most = MOST_CROWDED.max(FEW / n as f64);
            (squares / density.values().len() as f64).min(most)
        });
        let width = CLOUD / (n as f64 * crowding).sqrt();
        // exp(−decay²) is the tolerance.
        let decay = (-libm::log(TOLERANCE)).sqrt();
        let max_frequency = (decay / (PI * width)).ceil() as usize;
        let mut nufft = NufftOptions::new(max_frequency, TOLERANCE)
            .expecting(n)
            .portable()
            .plan()
            .map_err(|_| SampleError::OutOfMemory { n })?;
        let structure = HalfPlane::zeros(max_frequency);
        let clouds = vec![Complex::new(0.0, 0.0); n];
        let background = density.map(|density| {
            let background = Background::new(density, n, max_frequency);
            let mut modes = background.modes(&mut nufft);
            blur(&mut modes, n as f64, 0.5 * width);
            (background, modes)
        });
        Ok(Self { width, cutoff: decay * width, nufft, structure, clouds, background })
    }

    /// How dense charges may be around `p`, relative to the mean.
    pub(super) fn crowding(&self, p: DVec2) -> f64 {
        self.background.as_ref().map_or(1.0, |(background, _)| background.crowding(p))
    }

    /// The force on each charge.
    pub(super) fn at(&mut self, points: &PointSet) -> Vec<DVec2> {
        let scale = 1.0 / (self.width * self.width);
        let factor = |squared: f64| libm::exp(-squared * scale) / squared;
        let mut forces = pair_forces(points, self.cutoff, factor);
        self.add_clouds(points.points(), &mut forces);
        forces
    }

    fn add_clouds(&mut self, points: &[DVec2], forces: &mut [DVec2]) {
        self.nufft.points_to_modes(points, None, &mut self.structure);
        let last = self.structure.max_frequency() as i64;
        let structure = &self.structure;
        // exp(−π²s²k²) for one axis: the product of both is the Gaussian's transform.
        let decay = (PI * self.width).powi(2);
        let gaussian: Vec<f64> = (0..=last).map(|k| libm::exp(-decay * (k * k) as f64)).collect();
        let background = self.background.as_ref().map(|(_, modes)| modes);
        let fill = |kx: i64, column: &mut [Complex<f64>]| {
            for (ky, mode) in (-last..).zip(column) {
                let squared = (kx * kx + ky * ky) as f64;
                if squared == 0.0 {
                    *mode = Complex::new(0.0, 0.0);
                    continue;
                }
                let smooth = gaussian[kx.unsigned_abs() as usize]
                    * gaussian[ky.unsigned_abs() as usize]
                    / squared;
                // −i·kx for the real part, i·(−i·ky) for the imaginary one.
                let along = Complex::new(ky as f64, -kx as f64) * smooth;
                *mode = along * structure.get(kx, ky);
                if let Some(background) = background {
                    let along = Complex::new(ky as f64, -kx as f64) / squared;
                    *mode -= along * background.get(kx, ky);
                }
            }
        };
        self.nufft.columns_to_complex_points(points, &mut self.clouds, fill);
        for (force, cloud) in forces.iter_mut().zip(&self.clouds) {
            *force += DVec2::new(cloud.re, cloud.im);
        }
    }
}

/// Makes the modes of a density those of a charge, smeared out to clouds of this width.
fn blur(modes: &mut HalfPlane, charge: f64, width: f64) {
    let last = modes.max_frequency() as i64;
    for (kx, column) in (0_i64..).zip(modes.columns_mut()) {
        for (ky, mode) in (-last..).zip(column) {
            let squared = (kx * kx + ky * ky) as f64;
            *mode *= charge * libm::exp(-(PI * width).powi(2) * squared);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stochastic::uniform_points;
    use bn_core::{Seed, torus};
    use std::f64::consts::TAU;

    /// The force between two charges on the torus by rows: the field of a row of charges a
    /// distance 1 apart and its background is known in closed form.
    fn force_of_one(d: DVec2) -> DVec2 {
        // A row along x: π·(sin 2πx, sinh 2πy)/(cosh 2πy − cos 2πx); the uniform background leaves
        // −2π·y of the slab. Rows at y + m, m ≠ 0, in pairs.
        let row = |y: f64| {
            let denominator = libm::cosh(TAU * y) - libm::cos(TAU * d.x);
            DVec2::new(libm::sin(TAU * d.x), libm::sinh(TAU * y)) * PI / denominator
        };
        let mut force = row(d.y) - DVec2::new(0.0, TAU * d.y);
        for m in 1..8 {
            force += row(d.y + f64::from(m)) + row(d.y - f64::from(m));
        }
        force
    }

    #[test]
    fn forces_are_those_of_the_closed_form() {
        for n in [2, 3, 10, 200] {
            let points = uniform_points(n, Seed::new(8), 0).expect("few points");
            let set = PointSet::new(points).expect("valid");
            let forces = CoulombForces::new(n, None).expect("room").at(&set);
            let points = set.points();
            let typical = (n as f64).sqrt();
            for (i, (&p, force)) in points.iter().zip(forces).enumerate() {
                let others = points.iter().enumerate().filter(|&(j, _)| j != i);
                let want: DVec2 = others.map(|(_, &q)| force_of_one(torus::delta(q, p))).sum();
                // The tolerance of both parts, over some dozens of terms.
                let error = (force - want).length() / typical;
                assert!(error < 30.0 * TOLERANCE, "{force} against {want} of {n}");
            }
        }
    }
}
