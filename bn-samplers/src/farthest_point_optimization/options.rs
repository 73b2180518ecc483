//! The options of farthest-point optimisation as text.

use bn_core::NormalizedDistance;

use super::{FarthestPointOptimization, FpoStart, FpoUntil, FpoVariant};
use crate::common_options::DENSITY_OPTION;
use crate::{
    CountRule, DefaultValue, Method, OptionError, OptionKind, OptionSpec, OptionValues, PointOrder,
};

/// The registry's entry.
pub(crate) const METHOD: Method = Method {
    name: "fpo",
    aliases: &["farthest-point-optimization", "farthest-point-optimisation"],
    summary: "each point moved to the largest hole among the others, over and over",
    page: Some(118),
    citation: "T. Schlömer, D. Heck and O. Deussen, Farthest-point optimized point sets with maximized minimum distance, High Performance Graphics, 2011",
    complexity: "O(n log n) an iteration",
    order: PointOrder::Random,
    counts: CountRule::Any,
    seeded: true,
    options: &[
        OptionSpec {
            name: "variant",
            kind: OptionKind::Choice(&["global", "local", "hybrid", "constrained"]),
            default: DefaultValue::Value("hybrid"),
            help: "where points look for holes: everywhere, at their neighbours, first this then that, or so in blocks",
            unit: "",
        },
        OptionSpec {
            name: "until",
            kind: OptionKind::Choice(&["spacing", "converged"]),
            default: DefaultValue::Value("spacing"),
            help: "stop when --d-min is reached, or only when no point moves by more than 1e-6 d_hex: \
                   4096 random points then have a d_min of 0.930 to 0.933 by the variants hybrid and \
                   constrained, of 0.929 to 0.931 by global and local, which jam a little earlier",
            unit: "",
        },
        OptionSpec {
            name: "d-min",
            kind: OptionKind::Real { min: 0.0, max: 1.0 },
            default: DefaultValue::Absent("0.9251 with --until spacing"),
            help: "the smallest distance of two points to reach",
            unit: "d_hex",
        },
        OptionSpec {
            name: "iterations",
            kind: OptionKind::Integer { min: 0, max: 1_000_000 },
            default: DefaultValue::Value("10000"),
            help: "the most iterations",
            unit: "",
        },
        OptionSpec {
            name: "initial",
            kind: OptionKind::Points,
            default: DefaultValue::Absent("random points"),
            help: "the points to start from",
            unit: "",
        },
        OptionSpec {
            name: "initial-method",
            kind: OptionKind::Text,
            default: DefaultValue::Absent("random points"),
            help: "the method whose pattern to start from, by name",
            unit: "",
        },
        OptionSpec {
            name: "plug",
            kind: OptionKind::Flag,
            default: DefaultValue::Value("false"),
            help: "close the holes that remain, at some cost of the smallest distance",
            unit: "",
        },
        DENSITY_OPTION,
    ],
    build: |options| Ok(Box::new(build(options)?)),
    version: 2,
};

fn build(options: &OptionValues) -> Result<FarthestPointOptimization, OptionError> {
    let defaults = FarthestPointOptimization::default();
    let plug = options.flag("plug");
    if plug && options.density(DENSITY_OPTION.name).is_some() {
        let reason = "holes are as large as a density wants them; leave out --density";
        return Err(OptionError::Conflict { option: "plug", reason: reason.into() });
    }
    Ok(FarthestPointOptimization {
        variant: match options.choice("variant") {
            Some("global") => FpoVariant::Global,
            Some("local") => FpoVariant::Local,
            Some("constrained") => FpoVariant::Constrained,
            _ => FpoVariant::Hybrid,
        },
        until: match (options.choice("until"), options.real("d-min")) {
            (Some("converged"), Some(_)) => {
                let reason = "--until converged knows no distance; leave out one of the two";
                return Err(OptionError::Conflict { option: "d-min", reason: reason.into() });
            }
            (Some("converged"), None) => FpoUntil::Converged,
            (_, Some(d_min)) => FpoUntil::Spacing(NormalizedDistance::new(d_min)),
            (_, None) => defaults.until,
        },
        // The option's range ends below 2³².
        iterations: options.integer("iterations").map_or(defaults.iterations, |i| i as u32),
        start: start(options)?,
        plug,
        density: options.density(DENSITY_OPTION.name),
    })
}

fn start(options: &OptionValues) -> Result<FpoStart, OptionError> {
    let conflict = |reason| OptionError::Conflict { option: "initial-method", reason };
    match (options.points("initial"), options.text("initial-method")) {
        (None, None) => Ok(FpoStart::Random),
        (Some(points), None) => Ok(FpoStart::Points(points)),
        (None, Some(name)) => match crate::find(name) {
            Ok(method) => Ok(FpoStart::Method(method)),
            Err(unknown) => Err(conflict(unknown.to_string())),
        },
        (Some(_), Some(_)) => Err(conflict("give either --initial or --initial-method".into())),
    }
}
