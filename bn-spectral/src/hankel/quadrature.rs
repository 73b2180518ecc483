//! Gauss–Legendre quadrature on panels.

/// Nodes on a panel: exact for polynomials of degree 31. An oscillation of one wavelength a panel is
/// integrated to 1e-28, of two to 1e-19; what is beyond rounding serves the function itself.
const NODES: usize = 16;

/// Nodes r > 0 and weights of ∫ f(r) dr over panels between `breaks`, none longer than `longest`.
pub fn gauss_panels(breaks: &[f64], longest: f64) -> (Vec<f64>, Vec<f64>) {
    let rule = gauss_legendre();
    let (mut nodes, mut weights) = (Vec::new(), Vec::new());
    for pair in breaks.windows(2) {
        let panels = ((pair[1] - pair[0]) / longest).ceil().max(1.0);
        let half = (pair[1] - pair[0]) / (2.0 * panels);
        for panel in 0..panels as usize {
            let mid = pair[0] + half * (2 * panel + 1) as f64;
            nodes.extend(rule.iter().map(|(x, _)| mid + half * x));
            weights.extend(rule.iter().map(|(_, w)| half * w));
        }
    }
    (nodes, weights)
}

/// Abscissae in (−1, 1), ascending, and weights: the zeros x of the Legendre polynomial, by
/// Newton's method from Tricomi's estimate, and 2/((1 − x²) P′(x)²).
fn gauss_legendre() -> [(f64, f64); NODES] {
    let n = NODES as f64;
    std::array::from_fn(|k| {
        let mut x = -libm::cos(std::f64::consts::PI * (k as f64 + 0.75) / (n + 0.5));
        let mut slope = 1.0;
        // Three steps reach the last bits; the fourth makes the slope that of the final place.
        for _ in 0..4 {
            let (mut before, mut value) = (1.0, x);
            slope = 1.0;
            for m in 2..=NODES {
                let m = m as f64;
                slope = x * slope + m * value;
                (before, value) = (value, ((2.0 * m - 1.0) * x * value - (m - 1.0) * before) / m);
            }
            x -= value / slope;
        }
        (x, 2.0 / ((1.0 - x) * (1.0 + x) * slope * slope))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integrates_its_polynomials() {
        for degree in 0..32 {
            let sum: f64 = gauss_legendre().iter().map(|(x, w)| w * x.powi(degree)).sum();
            let exact = if degree % 2 == 0 { 2.0 / f64::from(degree + 1) } else { 0.0 };
            assert!((sum - exact).abs() < 1e-14, "degree {degree}: {sum}");
        }
    }

    #[test]
    fn panels_end_at_the_breaks() {
        let (nodes, weights) = gauss_panels(&[0.5, 1.0, 4.0], 0.3);
        assert_eq!(nodes.len(), (2 + 10) * NODES);
        assert!(nodes.is_sorted() && nodes[0] > 0.5 && nodes[nodes.len() - 1] < 4.0);
        assert!((weights.iter().sum::<f64>() - 3.5).abs() < 1e-14);
    }
}
