//! Spectra and RDFs that are known in closed form, for tests and predictions.
//!
//! Independent points have P = 1 and g = 1 and need no function.

use std::f64::consts::{FRAC_PI_4, PI, TAU};

use crate::jinc;

/// Stratified jitter (thesis §3.2.2): one point, uniformly placed, in each of m × m cells.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct JitteredGrid {
    cells_per_side: f64,
}

impl JitteredGrid {
    /// m × m cells, n = m² points.
    ///
    /// # Panics
    /// If `cells_per_side` is 0.
    pub fn new(cells_per_side: usize) -> Self {
        assert!(cells_per_side > 0, "a grid has at least one cell");
        Self { cells_per_side: cells_per_side as f64 }
    }

    /// The expected power 1 − sinc²(kx/m) sinc²(ky/m) at the integer wave vector (kx, ky) ≠ 0,
    /// sinc(x) = sin(πx)/(πx), with an error of a few ε: eq. 3.15, with sinc(νT) for its subscripts.
    pub fn power(self, kx: f64, ky: f64) -> f64 {
        1.0 - (sinc(kx / self.cells_per_side) * sinc(ky / self.cells_per_side)).powi(2)
    }

    /// The mean of that power over all directions at `nu` cycles per unit, to about 1e-14: the
    /// trapezoid rule over an octant, which converges geometrically once it resolves sinc².
    /// O(ν/m) operations.
    pub fn radial_power(self, nu: f64) -> f64 {
        let steps = 16 + (4.0 * (nu / self.cells_per_side).abs()).ceil() as usize;
        let at = |i: usize| {
            let (sin, cos) = libm::sincos(FRAC_PI_4 * i as f64 / steps as f64);
            self.power(nu * cos, nu * sin)
        };
        let inner: f64 = (1..steps).map(at).sum();
        (inner + 0.5 * (at(0) + at(steps))) / steps as f64
    }
}

/// sin(πx)/(πx).
fn sinc(x: f64) -> f64 {
    if x.abs() < 1e-8 { 1.0 } else { libm::sin(PI * x) / (PI * x) }
}

/// Frequencies |k| of equal length at which a lattice has its power, P = n in each mode.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LatticeRing {
    /// |k| in cycles per unit.
    pub frequency: f64,
    /// Number of modes, k and −k counted as two.
    pub modes: u32,
}

/// The rings of the square lattice of density `n` with 0 < |k| ≤ `highest`: √n·√(a² + b²).
///
/// O((highest/√n)²) time and, for the highest number of rings, memory.
///
/// # Panics
/// If (highest/√n)² is 10⁷ or more.
pub fn square_lattice_rings(n: f64, highest: f64) -> Vec<LatticeRing> {
    rings(n.sqrt(), highest, |a, b| a * a + b * b)
}

/// The rings of the hexagonal lattice of density `n` with 0 < |k| ≤ `highest`:
/// √(2n/√3)·√(a² + ab + b²). The torus admits such a lattice only nearly.
///
/// # Panics
/// As [`square_lattice_rings`], for the lattice's own unit.
pub fn hexagonal_lattice_rings(n: f64, highest: f64) -> Vec<LatticeRing> {
    rings((2.0 * n / 3.0_f64.sqrt()).sqrt(), highest, |a, b| a * a + a * b + b * b)
}

/// Counts the pairs (a, b) ≠ 0 by the value of a quadratic form that is at least ¾ max(a², b²).
fn rings(unit: f64, highest: f64, form: impl Fn(i64, i64) -> i64) -> Vec<LatticeRing> {
    let largest = (highest / unit * (1.0 + 1e-12)).powi(2);
    if !(unit > 0.0 && largest >= 1.0) {
        return Vec::new();
    }
    assert!(largest < 1e7, "{largest} lattice rings are too many");
    let reach = (largest / 0.75).sqrt() as i64 + 1;
    let mut modes = vec![0; largest as usize + 1];
    for (a, b) in (-reach..=reach).flat_map(|a| (-reach..=reach).map(move |b| (a, b))) {
        if let Some(count) = modes.get_mut(form(a, b) as usize) {
            *count += 1;
        }
    }
    let ring = |(form, &modes): (usize, &u32)| LatticeRing {
        frequency: unit * (form as f64).sqrt(),
        modes,
    };
    modes.iter().enumerate().skip(1).filter(|(_, modes)| **modes > 0).map(ring).collect()
}

/// The RDF of the step spectrum P(ν) = H(ν − ν₀) at density `n`:
///
/// g(r) = 1 − (2πν₀²/n)·jinc(2πν₀r), ν₀ in cycles per unit and r in unit lengths, to a few ε. The
/// thesis's table 5.1 and eq. 5.12 leave the π out of jinc's argument.
pub fn step_rdf(n: f64, nu0: f64, r: f64) -> f64 {
    1.0 - TAU * nu0 * nu0 / n * jinc(TAU * nu0 * r)
}

/// ν_max = √(n/π) cycles per unit: g of [`step_rdf`] is nowhere negative exactly up to this ν₀.
pub fn highest_step(n: f64) -> f64 {
    (n / PI).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lattice_rings_are_the_known_ones() {
        let square = square_lattice_rings(1024.0, 72.0);
        let want = [(32.0, 4), (32.0 * 2.0_f64.sqrt(), 4), (64.0, 4), (32.0 * 5.0_f64.sqrt(), 8)];
        assert_eq!(square.len(), want.len());
        for (ring, (frequency, modes)) in square.iter().zip(want) {
            assert!((ring.frequency - frequency).abs() < 1e-12 && ring.modes == modes);
        }
        let unit = (2.0 / 3.0_f64.sqrt()).sqrt();
        let hexagonal = hexagonal_lattice_rings(1.0, 3.1 * unit);
        let want = [(1.0, 6), (3.0, 6), (4.0, 6), (7.0, 12), (9.0, 6)];
        assert_eq!(hexagonal.len(), want.len());
        for (ring, (square, modes)) in hexagonal.iter().zip(want) {
            assert!((ring.frequency - unit * f64::sqrt(square)).abs() < 1e-14);
            assert_eq!(ring.modes, modes);
        }
        assert!(square_lattice_rings(0.0, 1.0).is_empty());
        assert!(square_lattice_rings(4.0, 1.9).is_empty());
    }

    /// All modes to a radius: an area, up to the circle's length.
    #[test]
    fn every_lattice_vector_is_in_a_ring() {
        for rings in [square_lattice_rings, hexagonal_lattice_rings] {
            let modes: u32 = rings(1.0, 40.0).iter().map(|ring| ring.modes).sum();
            assert!((f64::from(modes) - PI * 1600.0).abs() < 80.0, "{modes}");
        }
    }

    #[test]
    fn the_steepest_step_empties_the_origin() {
        let nu0 = highest_step(4096.0);
        assert!((nu0 - 36.108).abs() < 1e-3);
        assert!(step_rdf(4096.0, nu0, 0.0).abs() < 1e-15);
        assert!(step_rdf(4096.0, 1.01 * nu0, 0.0) < -0.02);
        let lowest = (0..5000).map(|i| step_rdf(4096.0, nu0, f64::from(i) * 1e-4));
        assert!(lowest.fold(1.0, f64::min) > -1e-15);
    }
}
