//! The options of farthest-point optimisation as text.

use bn_core::NormalizedDistance;

use super::{FarthestPointOptimization, FpoStart, FpoUntil, FpoVariant};
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
            kind: OptionKind::Choice(&["global", "local", "hybrid"]),
            default: DefaultValue::Value("hybrid"),
            help: "where points look for holes: everywhere, at their neighbours, or first this then that",
            unit: "",
        },
        OptionSpec {
            name: "until",
            kind: OptionKind::Choice(&["spacing", "converged"]),
            default: DefaultValue::Value("spacing"),
            help: "stop when --d-min is reached, or only when no point moves",
            unit: "",
        },
        OptionSpec {
            name: "d-min",
            kind: OptionKind::Real { min: 0.0, max: 1.0 },
            default: DefaultValue::Value("0.9251"),
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
    ],
    build: |options| Ok(Box::new(build(options)?)),
    version: 1,
};

fn build(options: &OptionValues) -> Result<FarthestPointOptimization, OptionError> {
    let defaults = FarthestPointOptimization::default();
    Ok(FarthestPointOptimization {
        variant: match options.choice("variant") {
            Some("global") => FpoVariant::Global,
            Some("local") => FpoVariant::Local,
            _ => FpoVariant::Hybrid,
        },
        until: match (options.choice("until"), options.real("d-min")) {
            (Some("converged"), _) => FpoUntil::Converged,
            (_, Some(d_min)) => FpoUntil::Spacing(NormalizedDistance::new(d_min)),
            (_, None) => defaults.until,
        },
        // The option's range ends below 2³².
        iterations: options.integer("iterations").map_or(defaults.iterations, |i| i as u32),
        start: start(options)?,
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
