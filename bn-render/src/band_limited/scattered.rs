//! Sums over the samples: from weighted values at the points to modes, and back.

use bn_core::DVec2;
use bn_spectral::{Complex, Nufft, NufftOptions};

use super::error::BandLimitedError;
use super::modes::{Degree, Modes};

/// The points with their weights, and the transform between them and the modes.
pub(super) struct Scattered {
    points: Vec<DVec2>,
    /// Of sum 1.
    weights: Vec<f64>,
    degree: Degree,
    plan: Nufft,
    strengths: Vec<f64>,
}

/// Relative error of the transforms: far below what reconstruction is asked for.
const TOLERANCE: f64 = 1e-11;

/// Eigenvalues of the normal equations' matrix below this are as good as none: its error is near.
pub(super) const UNKNOWN: f64 = 1e-9;

impl Scattered {
    pub(super) fn new(
        points: Vec<DVec2>,
        weights: &[f64],
        degree: Degree,
    ) -> Result<Self, BandLimitedError> {
        assert_eq!(points.len(), weights.len(), "one weight a sample");
        let bad = weights.iter().position(|weight| !(weight.is_finite() && *weight >= 0.0));
        if let Some(index) = bad {
            return Err(BandLimitedError::Weight { index, weight: weights[index] });
        }
        // Divided by the largest first: the sum can't overflow then.
        let most = weights.iter().copied().fold(0.0, f64::max);
        if most == 0.0 {
            return Err(BandLimitedError::NoSamples);
        }
        let sum: f64 = weights.iter().map(|weight| weight / most).sum();
        let weights = weights.iter().map(|weight| weight / most / sum).collect();
        let plan = NufftOptions::new(degree.most(), TOLERANCE).expecting(points.len()).plan()?;
        Ok(Self { points, weights, degree, plan, strengths: Vec::new() })
    }

    pub(super) fn len(&self) -> usize {
        self.points.len()
    }

    pub(super) fn degree(&self) -> Degree {
        self.degree
    }

    pub(super) fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// Σ wⱼ·valueⱼ·exp(−2πi k·xⱼ).
    pub(super) fn sum_modes(&mut self, values: &[f64], modes: &mut Modes) {
        self.strengths.clear();
        self.strengths.extend(self.weights.iter().zip(values).map(|(w, v)| w * v));
        type1(&mut self.plan, &self.points, &self.strengths, modes);
    }

    /// The values at the points of the function with these modes.
    pub(super) fn sum_points(&mut self, modes: &Modes, values: &mut [f64]) {
        type2(&mut self.plan, modes, &self.points, values);
    }

    /// τ(k) = Σ wⱼ exp(−2πi k·xⱼ) for twice the degree: what the normal equations' matrix is made of.
    pub(super) fn weight_modes(&self) -> Result<Modes, BandLimitedError> {
        let degree = self.degree.doubled();
        let options = NufftOptions::new(degree.most(), TOLERANCE).expecting(self.points.len());
        let mut modes = Modes::zeros(degree);
        type1(&mut options.plan()?, &self.points, &self.weights, &mut modes);
        Ok(modes)
    }
}

fn type1(plan: &mut Nufft, points: &[DVec2], strengths: &[f64], modes: &mut Modes) {
    let (degree, limit) = (modes.degree(), plan.max_frequency());
    let wanted = 0..degree.x + 1;
    let outputs: Vec<&mut [Complex<f64>]> = modes.columns_mut().collect();
    plan.transform(points, Some(strengths), wanted.clone()).each(
        wanted,
        outputs,
        |_, out, column| {
            out.copy_from_slice(&column[limit - degree.y..=limit + degree.y]);
        },
    );
}

/// The values at any points of the function with these modes.
pub(super) fn type2(plan: &mut Nufft, modes: &Modes, points: &[DVec2], values: &mut [f64]) {
    let (degree, limit) = (modes.degree(), plan.max_frequency());
    plan.columns_to_points(points, values, |kx, column| {
        column.fill(Complex::new(0.0, 0.0));
        if kx <= degree.x {
            column[limit - degree.y..=limit + degree.y].copy_from_slice(modes.column(kx));
        }
    });
}
