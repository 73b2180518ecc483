//! Gauss–Legendre quadrature.

/// Nodes and weights of the Gauss–Legendre rule on [0, 1], by Newton's method from the usual
/// cosines.
pub(crate) fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    let count = n as f64;
    let root = |i: usize| {
        let mut x = libm::cos(std::f64::consts::PI * (i as f64 + 0.75) / (count + 0.5));
        let mut slope = 1.0;
        // Quadratic from a start that is right to 1e-3: four steps suffice.
        for _ in 0..8 {
            let (mut before, mut p) = (0.0, 1.0);
            for k in 0..n {
                let k = k as f64;
                (before, p) = (p, ((2.0 * k + 1.0) * x * p - k * before) / (k + 1.0));
            }
            slope = count * (x * p - before) / (x * x - 1.0);
            x -= p / slope;
        }
        (0.5 - 0.5 * x, 1.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..n).map(root).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_integrate_polynomials() {
        for n in [1, 2, 4, 8, 16, 32] {
            let rule = gauss_legendre(n);
            for degree in 0..2 * n as i32 {
                let sum: f64 = rule.iter().map(|&(x, w)| w * x.powi(degree)).sum();
                let want = 1.0 / f64::from(degree + 1);
                assert!((sum - want).abs() < 1e-14, "{n} nodes, degree {degree}: {sum}");
            }
        }
    }
}
