//! Halton's sequence in bases 2 and 3.

use bn_core::{DVec2, Observer, Seed};
use rand::Rng;

use crate::digits::{permuted_radical_inverse, radical_inverse};
use crate::placing::{START, begin_placing, start};
use crate::{
    CountRule, DefaultValue, Method, OptionKind, OptionSpec, PointOrder, Report, Sample,
    SampleError, Sampler,
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
            start: start(options),
            scramble: options.choice("scramble") == Some("owen"),
        }))
    },
    version: 1,
};

impl Sampler for Halton {
    fn sample(&self, n: usize, seed: Seed, observer: &dyn Observer) -> Result<Sample, SampleError> {
        let mut points = begin_placing(METHOD.name, n, observer)?;
        let indices = (u64::from(self.start)..).take(n);
        if self.scramble {
            let mut rng = seed.stream(0);
            let keys = [rng.next_u64(), rng.next_u64()];
            let point = |i| {
                [(2, keys[0]), (3, keys[1])]
                    .map(|(base, key)| permuted_radical_inverse(base, i, key))
            };
            points.extend(indices.map(|i| DVec2::from(point(i))));
        } else {
            points
                .extend(indices.map(|i| DVec2::from([2, 3].map(|base| radical_inverse(base, i)))));
        }
        Ok(Sample::new(points, Report::new()))
    }
}
