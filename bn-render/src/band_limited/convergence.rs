//! When iterations end, and what is told of them.

/// When to end an iteration.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Stopping {
    /// The most iterations.
    pub iterations: usize,
    /// The residual ‖b − T a‖/‖b‖ that suffices.
    pub tolerance: f64,
}

impl Default for Stopping {
    /// 30 iterations, residual 1e-6. Where samples are too few or too uneven for the band, ending
    /// early is also what keeps noise from being enlarged.
    fn default() -> Self {
        Self { iterations: 30, tolerance: 1e-6 }
    }
}

/// Why an iteration ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Stop {
    /// The residual is within the tolerance.
    Tolerance,
    /// All iterations were made.
    Iterations,
    /// Nothing changes any more, to rounding: a tolerance below some 1e-11, the transforms' error, is
    /// not reached.
    Exhausted,
}

/// How an iteration went.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Convergence {
    /// Why it ended.
    pub stop: Stop,
    /// The residual ‖b − T a‖/‖b‖ of the normal equations at the end, computed anew.
    pub residual: f64,
    /// The residual after each iteration, as the iteration knows it.
    pub history: Vec<f64>,
    /// A lower bound of the condition number of T, from what conjugate gradients learnt of its
    /// eigenvalues; none for the other method, or without iterations.
    pub condition: Option<f64>,
    /// Coefficients of the polynomial.
    pub coefficients: usize,
    /// Samples.
    pub samples: usize,
}

/// Where the residual that an iteration updates means no more than that it is small.
pub(super) const ROUNDING: f64 = 1e-13;

impl Stop {
    /// The same, judged by the residual as computed anew: updated ones drift, by less than this
    /// leaves room for.
    pub(super) fn confirmed(self, residual: f64, tolerance: f64) -> Self {
        let is_reached = residual <= 1.01 * tolerance || residual == 0.0;
        if self == Self::Tolerance && !is_reached { Self::Exhausted } else { self }
    }
}

impl Convergence {
    /// Iterations made.
    pub fn iterations(&self) -> usize {
        self.history.len()
    }

    /// Whether the tolerance was reached.
    pub fn converged(&self) -> bool {
        self.stop == Stop::Tolerance
    }

    /// Whether there are fewer samples than coefficients: many polynomials fit, and the one given has
    /// the least energy about the samples' weighted mean.
    pub fn is_underdetermined(&self) -> bool {
        self.samples < self.coefficients
    }
}

/// The steps of a conjugate gradient iteration as a Lanczos process: T in the basis of the residuals
/// is tridiagonal, dᵢ = 1/αᵢ + βᵢ₋₁/αᵢ₋₁ beside √βᵢ/αᵢ (G. H. Golub, C. F. Van Loan, *Matrix
/// computations*, §10.2).
#[derive(Clone, Debug, Default)]
pub(super) struct Lanczos {
    diagonal: Vec<f64>,
    /// Squares of the numbers beside the diagonal, one for each step.
    beside: Vec<f64>,
    /// βᵢ₋₁/αᵢ₋₁.
    carried: f64,
}

impl Lanczos {
    pub(super) fn step(&mut self, alpha: f64, beta: f64) {
        self.diagonal.push(1.0 / alpha + self.carried);
        self.beside.push(beta / (alpha * alpha));
        self.carried = beta / alpha;
    }

    /// The largest over the smallest eigenvalue of the tridiagonal matrix: at most T's.
    pub(super) fn condition(&self) -> Option<f64> {
        let n = self.diagonal.len();
        if n == 0 {
            return None;
        }
        let most = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
        // Gershgorin.
        let bound = most(&self.diagonal) + 2.0 * most(&self.beside).sqrt();
        let (smallest, largest) = (self.eigenvalue(0, bound), self.eigenvalue(n - 1, bound));
        Some(largest / smallest).filter(|condition| condition.is_finite())
    }

    /// The eigenvalue of this rank, between 0 and `bound`, by bisection.
    fn eigenvalue(&self, rank: usize, bound: f64) -> f64 {
        let (mut low, mut high) = (0.0, bound);
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if self.below(middle) > rank { high = middle } else { low = middle }
        }
        high
    }

    /// Number of eigenvalues below x: negative pivots of the matrix less x (Sturm).
    fn below(&self, x: f64) -> usize {
        let mut pivot = 1.0;
        let mut count = 0;
        for (i, d) in self.diagonal.iter().enumerate() {
            let square = if i == 0 { 0.0 } else { self.beside[i - 1] };
            pivot = d - x - square / pivot;
            if pivot == 0.0 {
                pivot = f64::MIN_POSITIVE;
            }
            count += usize::from(pivot < 0.0);
        }
        count
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eigenvalues_of_a_known_matrix() {
        // 2 on the diagonal, −1 beside: 2 − 2 cos(πj/(n + 1)).
        let n = 9;
        let lanczos = Lanczos { diagonal: vec![2.0; n], beside: vec![1.0; n], carried: 0.0 };
        for rank in [0, 4, 8] {
            let angle = std::f64::consts::PI * (rank + 1) as f64 / (n + 1) as f64;
            let want = 2.0 - 2.0 * libm::cos(angle);
            assert!((lanczos.eigenvalue(rank, 4.0) - want).abs() < 1e-14, "{rank}");
        }
        assert_eq!(Lanczos::default().condition(), None);
    }

    #[test]
    fn two_steps_on_a_diagonal_matrix_find_its_condition() {
        // Conjugate gradients for diag(1, 10) x = (1, 1) by hand.
        let t = [1.0, 10.0];
        let (mut r, mut p) = ([1.0_f64, 1.0], [1.0_f64, 1.0]);
        let mut lanczos = Lanczos::default();
        for _ in 0..2 {
            let rho = r[0] * r[0] + r[1] * r[1];
            let alpha = rho / (t[0] * p[0] * p[0] + t[1] * p[1] * p[1]);
            for i in 0..2 {
                r[i] -= alpha * t[i] * p[i];
            }
            let beta = (r[0] * r[0] + r[1] * r[1]) / rho;
            for i in 0..2 {
                p[i] = r[i] + beta * p[i];
            }
            lanczos.step(alpha, beta);
        }
        let condition = lanczos.condition().expect("steps were made");
        assert!((condition - 10.0).abs() < 1e-9, "{condition}");
    }
}
