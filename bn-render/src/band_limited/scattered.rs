//! Sums over the samples: from weighted values at the points to modes, and back.

use bn_core::DVec2;
use bn_spectral::{Complex, Nufft, NufftOptions};

use super::error::BandLimitedError;
use super::modes::{Degree, Modes};

/// The points with their weights, and the transform between them and the modes.
///
/// Wide degrees are transformed with their axes exchanged, so that they need no more than tall ones.
pub(super) struct Scattered {
    /// With their axes exchanged if the degree is wide.
    points: Vec<DVec2>,
    /// Of sum 1.
    weights: Vec<f64>,
    degree: Degree,
    plan: Nufft,
    strengths: Vec<f64>,
    /// The modes with their axes exchanged, if the degree is wide.
    turned: Option<Modes>,
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
        let plan = plan(degree, points.len())?;
        let turned = degree.is_wide().then(|| Modes::zeros(degree.transposed()));
        let points = upright(points, degree);
        Ok(Self { points, weights, degree, plan, strengths: Vec::new(), turned })
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
        match &mut self.turned {
            None => type1(&mut self.plan, &self.points, &self.strengths, modes),
            Some(turned) => {
                type1(&mut self.plan, &self.points, &self.strengths, turned);
                modes.transpose_from(turned);
            }
        }
    }

    /// The values at the points of the function with these modes.
    pub(super) fn sum_points(&mut self, modes: &Modes, values: &mut [f64]) {
        let modes = match &mut self.turned {
            None => modes,
            Some(turned) => {
                turned.transpose_from(modes);
                turned
            }
        };
        type2(&mut self.plan, modes, &self.points, values);
    }

    /// τ(k) = Σ wⱼ exp(−2πi k·xⱼ) for twice the degree: what the normal equations' matrix is made of.
    pub(super) fn weight_modes(&self) -> Result<Modes, BandLimitedError> {
        let degree = self.degree.doubled();
        let mut plan = plan(degree, self.points.len())?;
        let upright = if degree.is_wide() { degree.transposed() } else { degree };
        let mut modes = Modes::zeros(upright);
        type1(&mut plan, &self.points, &self.weights, &mut modes);
        if upright == degree {
            return Ok(modes);
        }
        let mut turned = Modes::zeros(degree);
        turned.transpose_from(&modes);
        Ok(turned)
    }
}

/// The transform between `points` points and modes of this degree.
fn plan(degree: Degree, points: usize) -> Result<Nufft, BandLimitedError> {
    Ok(NufftOptions::new(degree.most(), TOLERANCE).expecting(points).plan()?)
}

/// The points as transforms of this degree take them: with their axes exchanged if it is wide.
fn upright(mut points: Vec<DVec2>, degree: Degree) -> Vec<DVec2> {
    if degree.is_wide() {
        for point in &mut points {
            *point = DVec2::new(point.y, point.x);
        }
    }
    points
}

/// The values at any points of the function with these modes.
pub(super) fn values_at(modes: &Modes, points: &[DVec2]) -> Result<Vec<f64>, BandLimitedError> {
    let degree = modes.degree();
    let mut plan = plan(degree, points.len())?;
    let mut values = vec![0.0; points.len()];
    if degree.is_wide() {
        let mut turned = Modes::zeros(degree.transposed());
        turned.transpose_from(modes);
        type2(&mut plan, &turned, &upright(points.to_vec(), degree), &mut values);
    } else {
        type2(&mut plan, modes, points, &mut values);
    }
    Ok(values)
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

fn type2(plan: &mut Nufft, modes: &Modes, points: &[DVec2], values: &mut [f64]) {
    let (degree, limit) = (modes.degree(), plan.max_frequency());
    plan.columns_to_points(points, values, |kx, column| {
        column.fill(Complex::new(0.0, 0.0));
        if kx <= degree.x {
            column[limit - degree.y..=limit + degree.y].copy_from_slice(modes.column(kx));
        }
    });
}
