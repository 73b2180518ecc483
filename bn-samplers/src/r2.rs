//! The R2 sequence: Kronecker's sequence of the plastic number.

use bn_core::{DVec2, Observer, Seed};
use rand::Rng;

use crate::common_options::START;
use crate::placing::place_sequence;
use crate::{
    CountRule, DefaultValue, Method, OptionKind, OptionSpec, PointOrder, Sample, SampleError,
    Sampler,
};

/// Points (½ + i/g, ½ + i/g²) mod 1 for i from `start`, where g = 1.3247… solves g³ = g + 1.
///
/// Computed in fixed point: every coordinate is exact to i·2⁻⁶⁵, rounded down to 2⁻⁵³.
/// M. Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct R2 {
    /// Index of the first point.
    pub start: u32,
    /// Whether the whole pattern is moved on the torus by a random vector (Cranley and Patterson).
    pub shift: bool,
}

/// The registry's entry.
pub(crate) const METHOD: Method = Method {
    name: "r2",
    aliases: &["roberts", "plastic"],
    summary: "R2 sequence, multiples of the plastic number's powers",
    page: None,
    citation: "M. Roberts, The unreasonable effectiveness of quasirandom sequences, 2018",
    complexity: "O(n)",
    order: PointOrder::Progressive,
    counts: CountRule::Any,
    seeded: false,
    options: &[
        START,
        OptionSpec {
            name: "shift",
            kind: OptionKind::Flag,
            default: DefaultValue::Value("false"),
            help: "move the pattern on the torus by a random vector",
            unit: "",
        },
    ],
    build: |options| {
        Ok(Box::new(R2 { start: options.count(START.name), shift: options.flag("shift") }))
    },
    version: 1,
};

/// 2⁶⁴/g and 2⁶⁴/g², rounded.
const STEP: [u64; 2] = [0xc13f_a9a9_02a6_328f, 0x91e1_0da5_c79e_7b1d];

impl Sampler for R2 {
    fn sample(&self, n: usize, seed: Seed, observer: &dyn Observer) -> Result<Sample, SampleError> {
        let mut rng = seed.stream(0);
        let origin = [(); 2].map(|()| if self.shift { rng.next_u64() } else { 1 << 63 });
        let coordinate = |axis: usize, i: u64| {
            let fixed = origin[axis].wrapping_add(STEP[axis].wrapping_mul(i));
            (fixed >> 11) as f64 / (1_u64 << 53) as f64
        };
        place_sequence(METHOD.name, n, self.start, observer, |i| {
            DVec2::new(coordinate(0, i), coordinate(1, i))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bn_core::{Unobserved, torus};

    #[test]
    fn steps_are_powers_of_the_plastic_number() {
        // g³ = g + 1 for x = 1/g means x³ + x² = 1; in exact integers, x = STEP/2⁶⁴ to half a unit.
        let x = u128::from(STEP[0]);
        let cube_and_square = |x: u128| {
            let square = (x * x) >> 64;
            ((square * x) >> 64) + square
        };
        // The derivative 3x² + 2x is 3.2: half a unit and three truncations shift the sum by < 6.
        assert!((1_u128 << 64).abs_diff(cube_and_square(x)) < 6);
        assert!(u128::from(STEP[1]).abs_diff((x * x) >> 64) < 3);
    }

    #[test]
    fn later_starts_continue_the_sequence() {
        let long = R2::default().sample(20, Seed::new(1), &Unobserved).expect("valid");
        let late = R2 { start: 15, shift: false }.sample(5, Seed::new(1), &Unobserved);
        assert_eq!(late.expect("valid").points.points(), &long.points.points()[15..]);
    }

    #[test]
    fn shifting_moves_the_whole_pattern() {
        let shifted = R2 { start: 0, shift: true }.sample(9, Seed::new(1), &Unobserved);
        let shifted = shifted.expect("valid").points;
        let plain = R2::default().sample(9, Seed::new(1), &Unobserved).expect("valid").points;
        let by = shifted.points()[0] - plain.points()[0];
        for (p, q) in plain.translated(by).points().iter().zip(shifted.points()) {
            // Rounding down to 2⁻⁵³ once on each side.
            assert!(torus::distance(*p, *q) < 1e-15);
        }
    }
}
