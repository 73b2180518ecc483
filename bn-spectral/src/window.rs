//! Window functions.

/// A three-term cosine window: w(x) = a₀ + a₁ cos(πx/h) + a₂ cos(2πx/h) for |x| < h, else 0.
///
/// Its maximum is at x = 0 and h is its half-width: the thesis's "window of width r₁" is the one of
/// half-width r₁. The main lobe of its transform reaches 3/(2h) to either side.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Window {
    a: [f64; 3],
}

impl Window {
    /// Blackman's window, 0.42, 0.5, 0.08: w(0) = 1, w(h) = 0.
    pub const BLACKMAN: Self = Self { a: [0.42, 0.5, 0.08] };

    /// The window behind the thesis's printed spectral numbers: 0.43, 0.5, 0.08, by a slip; it has
    /// w(0) = 1.01 and falls from 0.01 to 0 at its edge.
    pub const THESIS: Self = Self { a: [0.43, 0.5, 0.08] };

    /// w(x) for the given half-width, with an error of a few ε; 0 if the half-width is not positive.
    pub fn at(&self, x: f64, half_width: f64) -> f64 {
        if x.abs() >= half_width || half_width.is_nan() || x.is_nan() {
            return 0.0;
        }
        let c = libm::cos(std::f64::consts::PI * x / half_width);
        // cos 2t = 2 cos² t − 1.
        (self.a[0] - self.a[2]) + c * (self.a[1] + 2.0 * self.a[2] * c)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_at_the_marks() {
        for (window, top, edge) in [(Window::BLACKMAN, 1.0, 0.0), (Window::THESIS, 1.01, 0.01)] {
            assert!((window.at(0.0, 0.25) - top).abs() < 1e-15);
            assert!((window.at(0.25 * (1.0 - 1e-15), 0.25) - edge).abs() < 1e-15);
            // cos(π/2) = 0 and cos π = −1.
            assert!((window.at(-1.0, 2.0) - (window.a[0] - 0.08)).abs() < 1e-15);
            for (x, half_width) in [(0.25, 0.25), (-3.0, 1.0), (0.0, 0.0), (0.0, -1.0)] {
                assert_eq!(window.at(x, half_width), 0.0);
            }
            assert_eq!(window.at(f64::NAN, 1.0), 0.0);
        }
    }
}
