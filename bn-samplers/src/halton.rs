//! Halton's sequence in bases 2 and 3.

use bn_core::{DVec2, Observer, Seed};
use rand::Rng;

use crate::common_options::START;
use crate::digits::{permuted_radical_inverse, radical_inverse};
use crate::placing::place_sequence;
use crate::{
    CountRule, DefaultValue, Method, OptionKind, OptionSpec, PointOrder, Sample, SampleError,
    Sampler,
};

/// Points (φ₂(i), φ₃(i)) for i from `start`: radical inverses, the digits of i mirrored at the
/// radix point.
///
/// J. H. Halton, "On the efficiency of certain quasi-random sequences of points in evaluating
/// multi-dimensional integrals", Numerische Mathematik 2, 1960. Of the low-discrepancy family of
/// the thesis's p. 115.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Halton {
    /// Index of the first point.
    pub start: u32,
    /// Whether the digits are permuted at random, nested uniformly (Owen): keeps the stratification
    /// and breaks the correlation of the two bases.
    pub scramble: bool,
}

/// The registry's entry.
pub(crate) const METHOD: Method = Method {
    name: "halton",
    aliases: &[],
    summary: "Halton's low-discrepancy sequence in bases 2 and 3",
    page: Some(115),
    citation: "J. H. Halton, On the efficiency of certain quasi-random sequences of points, Numer. Math. 2, 1960",
    complexity: "O(n log n)",
    order: PointOrder::Progressive,
    counts: CountRule::Any,
    seeded: false,
    options: &[
        START,
        OptionSpec {
            name: "scramble",
            kind: OptionKind::Choice(&["none", "owen"]),
            default: DefaultValue::Value("none"),
            help: "how the digits are permuted; owen is random by the seed",
            unit: "",
        },
    ],
    build: |options| {
        Ok(Box::new(Halton {
            start: options.count(START.name),
            scramble: options.choice("scramble") == Some("owen"),
        }))
    },
    version: 1,
};

impl Sampler for Halton {
    fn sample(&self, n: usize, seed: Seed, observer: &dyn Observer) -> Result<Sample, SampleError> {
        let mut rng = seed.stream(0);
        let keys = [(); 2].map(|()| self.scramble.then(|| rng.next_u64()));
        let coordinate = |base, key: Option<u64>, i| {
            key.map_or_else(
                || radical_inverse(base, i),
                |key| permuted_radical_inverse(base, i, key),
            )
        };
        place_sequence(METHOD.name, n, self.start, observer, |i| {
            DVec2::new(coordinate(2, keys[0], i), coordinate(3, keys[1], i))
        })
    }
}
