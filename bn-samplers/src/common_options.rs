//! Options that several methods have, and how options become the fields of samplers.

use std::sync::Arc;

use bn_core::{DensityFunction, NormalizedDistance};

use crate::{DefaultValue, OptionKind, OptionSpec, OptionValues, SampleError};

/// Where the points are to be how dense.
pub(crate) const DENSITY_OPTION: OptionSpec = OptionSpec {
    name: "density",
    kind: OptionKind::Density,
    default: DefaultValue::Absent("uniform"),
    help: "where the points are to be how dense",
    unit: "",
};

/// The index of the first point of a sequence that need not begin at its beginning.
pub(crate) const START: OptionSpec = OptionSpec {
    name: "start",
    kind: OptionKind::Integer { min: 0, max: u32::MAX as u64 },
    default: DefaultValue::Value("0"),
    help: "index of the first point of the sequence",
    unit: "",
};

/// How often points are moved.
pub(crate) const fn iterations(default: &'static str) -> OptionSpec {
    OptionSpec {
        name: "iterations",
        kind: OptionKind::Integer { min: 0, max: 1_000_000 },
        default: DefaultValue::Value(default),
        help: "the most iterations",
        unit: "",
    }
}

/// When points that are moved are at rest.
pub(crate) const fn tolerance(default: &'static str, help: &'static str) -> OptionSpec {
    OptionSpec {
        name: "tolerance",
        kind: OptionKind::Real { min: 0.0, max: 1.0 },
        default: DefaultValue::Value(default),
        help,
        unit: "d_hex",
    }
}

/// Getters for options that have a default.
///
/// # Panics
/// If the method has no option of this name and kind, or one without a default or beyond the type's range:
/// slips in its registration.
impl OptionValues {
    /// The whole number `name`, whose range ends below 2³².
    pub(crate) fn count(&self, name: &str) -> u32 {
        let value = self.integer(name).and_then(|value| u32::try_from(value).ok());
        value.expect("the option has a default and a range below 2³²")
    }

    /// The real number `name`.
    pub(crate) fn number(&self, name: &str) -> f64 {
        self.real(name).expect("the option has a default")
    }

    /// The distance `name` in `d_hex`.
    pub(crate) fn distance(&self, name: &str) -> NormalizedDistance {
        NormalizedDistance::new(self.number(name))
    }
}

/// Checks that a field is in its option's range: fields are public.
pub(crate) fn check_range(
    option: &'static str,
    value: f64,
    min: f64,
    max: f64,
) -> Result<(), SampleError> {
    if (min..=max).contains(&value) {
        return Ok(());
    }
    let reason = format!("{value} is not a number from {min} to {max}");
    Err(SampleError::InvalidOption { option, reason })
}

/// Checks that a tolerance is a distance.
pub(crate) fn check_tolerance(tolerance: NormalizedDistance) -> Result<(), SampleError> {
    if (0.0..f64::INFINITY).contains(&tolerance.value()) {
        return Ok(());
    }
    let reason = format!("{tolerance} is not a distance");
    Err(SampleError::InvalidOption { option: "tolerance", reason })
}

/// The density, if it says anything: methods serve an even one as they do none.
pub(crate) fn uneven(density: Option<&Arc<DensityFunction>>) -> Option<Arc<DensityFunction>> {
    density.filter(|density| !density.is_uniform()).cloned()
}
