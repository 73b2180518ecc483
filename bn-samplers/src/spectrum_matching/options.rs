//! The options of matching as text: declared once, for every method that matches a spectrum and for
//! programs that offer a choice of algorithms.

use super::{Algorithm, Force, Spectral};
use crate::{DefaultValue, OptionError, OptionKind, OptionSpec, OptionValues};

/// The option that chooses the algorithm.
const ALGORITHM: OptionSpec = OptionSpec {
    name: "algorithm",
    kind: OptionKind::Choice(Algorithm::NAMES),
    default: DefaultValue::Value("spectral"),
    help: "how to come near the spectrum",
    unit: "",
};

/// The option that bounds the work of any algorithm.
const ITERATIONS: OptionSpec = OptionSpec {
    name: "iterations",
    kind: OptionKind::Integer { min: 0, max: 1_000_000 },
    default: DefaultValue::Absent("until it stops paying"),
    help: "the most iterations, of spectral the most evaluations in all stages together",
    unit: "",
};

/// The options of [`Spectral`].
const SPECTRAL: [OptionSpec; 5] = [
    OptionSpec {
        name: "weight-exponent",
        kind: OptionKind::Real { min: 0.0, max: 8.0 },
        default: DefaultValue::Value("2"),
        help: "spectral: power at the frequency nu where none is wanted costs as nu to minus this",
        unit: "",
    },
    OptionSpec {
        name: "range",
        kind: OptionKind::Real { min: 0.1, max: 16.0 },
        default: DefaultValue::Value("6"),
        help: "spectral: the highest frequency that is matched",
        unit: "sqrt(n)",
    },
    OptionSpec {
        name: "stages",
        kind: OptionKind::Integer { min: 1, max: 8 },
        default: DefaultValue::Value("2"),
        help: "spectral: stages of growing range, from 1.5 sqrt(n) to --range in equal ratios",
        unit: "",
    },
    OptionSpec {
        name: "evaluations",
        kind: OptionKind::Integer { min: 1, max: 1_000_000 },
        default: DefaultValue::Absent("150, and 1000 to imitate point sets"),
        help: "spectral: the most evaluations of each stage",
        unit: "",
    },
    OptionSpec {
        name: "tolerance",
        kind: OptionKind::Real { min: 0.0, max: 1.0 },
        default: DefaultValue::Absent("a weighted mean square of 1e-6"),
        help: "spectral: stop at this residual, the root mean square of ring means less the target \
               up to --range",
        unit: "",
    },
];

/// The options of [`Force`].
const FORCE: [OptionSpec; 4] = [
    OptionSpec {
        name: "smoothing",
        kind: OptionKind::Real { min: 0.0, max: 1000.0 },
        default: DefaultValue::Absent("8"),
        help: "force: deviation of the Gaussian that smooths the RDF",
        unit: "bins of 1/(2n), or of 1/131070 for more than 65535 points",
    },
    OptionSpec {
        name: "patience",
        kind: OptionKind::Integer { min: 1, max: 1_000_000 },
        default: DefaultValue::Absent("20"),
        help: "force: iterations without a lower error before the temperature falls",
        unit: "",
    },
    OptionSpec {
        name: "cooling",
        kind: OptionKind::Real { min: 0.0, max: 0.999 },
        default: DefaultValue::Absent("0.9"),
        help: "force: the factor by which the temperature falls, from 1 on",
        unit: "",
    },
    OptionSpec {
        name: "coldest",
        kind: OptionKind::Real { min: 1e-9, max: 1.0 },
        default: DefaultValue::Absent("0.001"),
        help: "force: the temperature to stop at",
        unit: "",
    },
];

const COMMON: [OptionSpec; 2] = [ALGORITHM, ITERATIONS];

/// The options that belong to one algorithm alone.
const OWNED: [(&str, &[OptionSpec]); 2] = [("spectral", &SPECTRAL), ("force", &FORCE)];

/// All of them.
const OPTIONS: [OptionSpec; COMMON.len() + SPECTRAL.len() + FORCE.len()] =
    joined(joined::<_, _, { COMMON.len() + SPECTRAL.len() }>(COMMON, SPECTRAL), FORCE);

/// One list after the other.
const fn joined<const A: usize, const B: usize, const ALL: usize>(
    a: [OptionSpec; A],
    b: [OptionSpec; B],
) -> [OptionSpec; ALL] {
    assert!(ALL == A + B);
    let mut all = [ALGORITHM; ALL];
    let mut i = 0;
    while i < ALL {
        all[i] = if i < A { a[i] } else { b[i - A] };
        i += 1;
    }
    all
}

/// The options of a method that matches: its own, then those of the algorithms.
pub(super) const fn with_algorithms<const OWN: usize, const ALL: usize>(
    own: [OptionSpec; OWN],
) -> [OptionSpec; ALL] {
    joined(own, OPTIONS)
}

impl Algorithm {
    /// The options by which an algorithm is chosen and tuned. Some belong to one algorithm alone,
    /// with which their help begins.
    pub const OPTIONS: &'static [OptionSpec] = &OPTIONS;

    /// Whether the algorithm called `name` takes this option.
    pub fn takes(name: &str, option: &str) -> bool {
        owner(option).is_none_or(|owner| owner == name)
    }

    /// The algorithm that these options, [`Self::OPTIONS`] among them, ask for.
    ///
    /// # Errors
    /// [`OptionError::Conflict`] if an option is given that belongs to another algorithm.
    ///
    /// # Panics
    /// If one of [`Self::OPTIONS`] isn't among those that the values were parsed by.
    pub fn from_options(options: &OptionValues) -> Result<Self, OptionError> {
        let name = options.choice(ALGORITHM.name).unwrap_or(Self::NAMES[0]);
        let given = Self::OPTIONS.iter().filter(|spec| options.is_given(spec.name));
        for OptionSpec { name: option, .. } in given {
            if let Some(owner) = owner(option).filter(|owner| *owner != name) {
                let reason = format!("it belongs to --algorithm {owner}, not to {name}");
                return Err(OptionError::Conflict { option, reason });
            }
        }
        let chosen = match Self::named(name).unwrap_or_default() {
            Self::Spectral(default) => Self::Spectral(spectral(default, options)),
            Self::Force(default) => Self::Force(force(default, options)),
            other => other,
        };
        Ok(match options.integer(ITERATIONS.name) {
            // The option's range ends below 2³².
            Some(iterations) => chosen.with_iterations(iterations as u32),
            None => chosen,
        })
    }
}

/// The one algorithm that an option belongs to, if it doesn't serve all.
fn owner(option: &str) -> Option<&'static str> {
    let owned = OWNED.iter().find(|(_, specs)| specs.iter().any(|spec| spec.name == option));
    owned.map(|(owner, _)| *owner)
}

fn spectral(mut spectral: Spectral, options: &OptionValues) -> Spectral {
    spectral.ranges = Spectral::staged(options.number("range"), options.count("stages"));
    spectral.weights.exponent = options.number("weight-exponent");
    spectral.tolerance = options.real("tolerance");
    // The option's range ends below 2³².
    spectral.evaluations = options.integer("evaluations").map(|evaluations| evaluations as u32);
    spectral
}

fn force(default: Force, options: &OptionValues) -> Force {
    Force {
        smoothing: options.real("smoothing").unwrap_or(default.smoothing),
        // The option's range ends below 2³².
        patience: options.integer("patience").map_or(default.patience, |patience| patience as u32),
        cooling: options.real("cooling").unwrap_or(default.cooling),
        coldest: options.real("coldest").unwrap_or(default.coldest),
        iterations: default.iterations,
    }
}
