//! The first two dimensions of Sobol's sequence.

use bn_core::{DVec2, Observer, Seed};
use rand::Rng;

use crate::common_options::START;
use crate::digits::nested;
use crate::placing::place_sequence;
use crate::{
    CountRule, DefaultValue, Method, OptionKind, OptionSpec, PointOrder, Sample, SampleError,
    Sampler,
};

/// The first two dimensions of Sobol's sequence, in its natural order from index `start`: a
/// (0,2)-sequence, so 2^m consecutive points from a multiple of 2^m are a (0,m,2)-net.
///
/// I. M. Sobol', "On the distribution of points in a cube and the approximate evaluation of
/// integrals", USSR Comput. Math. Math. Phys. 7(4), 1967. Every set of direction numbers in use
/// agrees on these two dimensions. Of the low-discrepancy family of the thesis's p. 115.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sobol {
    /// Index of the first point.
    pub start: u32,
    /// How the binary digits are permuted; all keep the net property.
    pub scramble: Scramble,
}

/// A permutation of the binary digits of all points' coordinates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Scramble {
    /// None: the first point is the origin.
    #[default]
    None,
    /// Some digits inverted, the same at all points: random digital shift.
    Xor,
    /// Nested uniform permutation (Owen).
    Owen,
}

/// The registry's entry.
pub(crate) const METHOD: Method = Method {
    name: "sobol",
    aliases: &["sobol-02", "02-sequence"],
    summary: "Sobol's low-discrepancy sequence, first two dimensions",
    page: Some(115),
    citation: "I. M. Sobol', On the distribution of points in a cube, USSR Comput. Math. Math. Phys. 7(4), 1967",
    complexity: "O(n)",
    order: PointOrder::Progressive,
    counts: CountRule::Any,
    seeded: false,
    options: &[
        START,
        OptionSpec {
            name: "scramble",
            kind: OptionKind::Choice(&["none", "xor", "owen"]),
            default: DefaultValue::Value("none"),
            help: "how the binary digits are permuted; xor and owen are random by the seed",
            unit: "",
        },
    ],
    build: |options| {
        Ok(Box::new(Sobol {
            start: options.count(START.name),
            scramble: match options.choice("scramble") {
                Some("xor") => Scramble::Xor,
                Some("owen") => Scramble::Owen,
                _ => Scramble::None,
            },
        }))
    },
    version: 1,
};

/// Binary digits of a coordinate: as many as an f64 holds.
const DIGITS: u32 = f64::MANTISSA_DIGITS;

impl Sampler for Sobol {
    fn sample(&self, n: usize, seed: Seed, observer: &dyn Observer) -> Result<Sample, SampleError> {
        let mut rng = seed.stream(0);
        let keys = [rng.next_u64(), rng.next_u64()];
        let coordinate = |axis: usize, bits: u64| match self.scramble {
            Scramble::None => fraction(bits),
            Scramble::Xor => fraction(bits ^ keys[axis] >> (u64::BITS - DIGITS)),
            Scramble::Owen => {
                nested(2, (0..DIGITS).rev().map(|place| bits >> place & 1), keys[axis])
            }
        };
        let directions = pascal_directions();
        place_sequence(METHOD.name, n, self.start, observer, |i| {
            let x = i.reverse_bits() >> (u64::BITS - DIGITS);
            DVec2::new(coordinate(0, x), coordinate(1, combine(&directions, i)))
        })
    }
}

fn fraction(bits: u64) -> f64 {
    bits as f64 / (1_u64 << DIGITS) as f64
}

/// The direction numbers of the primitive polynomial x + 1: the columns of Pascal's triangle
/// modulo 2, first digit on top.
fn pascal_directions() -> [u64; DIGITS as usize] {
    let mut column = 1 << (DIGITS - 1);
    [(); DIGITS as usize].map(|()| {
        let this = column;
        column ^= column >> 1;
        this
    })
}

/// The sum modulo 2 of the columns whose bit is set in `index`.
fn combine(columns: &[u64], index: u64) -> u64 {
    let mut rest = index;
    let mut sum = 0;
    while rest > 0 {
        sum ^= columns[rest.trailing_zeros() as usize];
        rest &= rest - 1;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use bn_core::Unobserved;

    #[test]
    fn begins_as_published() {
        // The first eight points of every published table (dimensions 1 and 2).
        let want = [
            (0.0, 0.0),
            (0.5, 0.5),
            (0.25, 0.75),
            (0.75, 0.25),
            (0.125, 0.625),
            (0.625, 0.125),
            (0.375, 0.375),
            (0.875, 0.875),
        ];
        let sample = Sobol::default().sample(8, Seed::new(1), &Unobserved).expect("valid");
        let got: Vec<(f64, f64)> = sample.points.points().iter().map(|p| (p.x, p.y)).collect();
        assert_eq!(got, want);
    }

    #[test]
    fn every_scramble_keeps_the_net_property() {
        for scramble in [Scramble::None, Scramble::Xor, Scramble::Owen] {
            for m in 1..=8 {
                let n = 1 << m;
                let sobol = Sobol { start: 3 * n as u32, scramble };
                let set = sobol.sample(n, Seed::new(7), &Unobserved).expect("valid").points;
                for columns in (0..=m).map(|bits| 1_usize << bits) {
                    let rows = n / columns;
                    let mut seen = vec![false; n];
                    for p in set.points() {
                        let (x, y) = (p.x * columns as f64, p.y * rows as f64);
                        let cell = x as usize + y as usize * columns;
                        let again = std::mem::replace(&mut seen[cell], true);
                        assert!(!again, "{scramble:?}, m = {m}, {columns} columns");
                    }
                }
            }
        }
    }
}
