//! The density of a point set and the units that follow from it.

use std::fmt;

/// The density of n points on the unit torus, and with it the units of distances and frequencies.
///
/// - distances are reported in `d_hex` = √(2/(√3·n)), the largest smallest distance that n points
///   could have, that of a hexagonal lattice (thesis eq. 4.3, whose printed form is a slip);
/// - frequencies are reported in √n/2, the Nyquist frequency of a square grid of n points (the
///   thesis calls it the hexagonal one).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Density {
    #[cfg_attr(feature = "serde", serde(deserialize_with = "positive"))]
    points: f64,
}

/// A number of points that units can follow from.
#[cfg(feature = "serde")]
fn positive<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    use serde::{Deserialize, de};
    let points = f64::deserialize(deserializer)?;
    if points >= 1.0 && points.is_finite() {
        return Ok(points);
    }
    Err(de::Error::invalid_value(
        de::Unexpected::Float(points),
        &"a number of points of at least 1",
    ))
}

impl Density {
    /// The density of `n` points on the unit square.
    ///
    /// # Panics
    /// If `n` is 0: nothing can be measured in the units of an empty set.
    pub fn new(n: usize) -> Self {
        assert!(n > 0, "the density of an empty set has no units");
        Self { points: n as f64 }
    }

    /// Points per unit area, n.
    pub fn points_per_unit_area(self) -> f64 {
        self.points
    }

    /// `d_hex` = √(2/(√3·n)) in unit lengths: the spacing of the hexagonal lattice of this density.
    pub fn hexagonal_spacing(self) -> f64 {
        (2.0 / (3.0_f64.sqrt() * self.points)).sqrt()
    }

    /// √n/2 in cycles per unit: the Nyquist frequency of the square grid of this density.
    pub fn grid_nyquist(self) -> f64 {
        self.points.sqrt() / 2.0
    }

    /// A distance in unit lengths as one in `d_hex`.
    pub fn normalize_distance(self, distance: f64) -> NormalizedDistance {
        NormalizedDistance(distance / self.hexagonal_spacing())
    }

    /// A frequency in cycles per unit as one in √n/2.
    pub fn normalize_frequency(self, frequency: f64) -> NormalizedFrequency {
        NormalizedFrequency(frequency / self.grid_nyquist())
    }
}

macro_rules! normalized {
    ($(#[$doc:meta])* $name:ident, $unit:ident, $to_unit:ident, $unit_doc:literal) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(transparent))]
        pub struct $name(f64);

        impl $name {
            /// A number that already is in this unit.
            pub fn new(value: f64) -> Self {
                Self(value)
            }

            /// The number in this unit.
            pub fn value(self) -> f64 {
                self.0
            }

            #[doc = $unit_doc]
            pub fn $to_unit(self, density: Density) -> f64 {
                self.0 * density.$unit()
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                self.0.fmt(f)
            }
        }
    };
}

normalized! {
    /// A distance in units of `d_hex` = √(2/(√3·n)).
    NormalizedDistance, hexagonal_spacing, to_unit_lengths, "The distance in unit lengths."
}
normalized! {
    /// A frequency in units of √n/2.
    NormalizedFrequency, grid_nyquist, to_cycles_per_unit, "The frequency in cycles per unit."
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_of_the_square_grid() {
        let density = Density::new(4096);
        assert_eq!(density.grid_nyquist(), 32.0);
        // A square grid's spacing 1/√n over d_hex is (√3/2)^½.
        let spacing = density.normalize_distance(1.0 / 64.0).value();
        assert!((spacing - (3.0_f64.sqrt() / 2.0).sqrt()).abs() < 1e-15);
        assert!((density.normalize_distance(0.25).to_unit_lengths(density) - 0.25).abs() < 1e-15);
        assert_eq!(density.normalize_frequency(48.0).value(), 1.5);
        assert_eq!(NormalizedFrequency::new(2.0).to_cycles_per_unit(density), 64.0);
    }

    #[cfg(feature = "serde")]
    #[test]
    fn only_a_number_of_points_deserializes() {
        let read = |text: &str| serde_json::from_str::<Density>(text);
        assert_eq!(read(r#"{"points":4096.0}"#).expect("valid"), Density::new(4096));
        for points in ["0", "-1.0", "0.5", "1e999", "null"] {
            assert!(read(&format!(r#"{{"points":{points}}}"#)).is_err(), "{points}");
        }
    }
}
