//! The list of all methods.

use thiserror::Error;

use crate::capacity::{bnot, cccvt};
use crate::names::nearest_name;
use crate::particles::{electrostatic, kernel_density};
use crate::poisson_disk::{dart_throwing, maximal};
use crate::spectrum_matching::{single_peak, step};
use crate::{
    Method, best_candidate, farthest_point_optimization, farthest_point_strategy, halton,
    hexagonal, jittered, lloyd, net, r2, regular, sobol, stochastic,
};

/// Every method, in the order of the thesis's appendix B, then those that it doesn't show.
///
/// Help texts, lists, tables, tests and benches are made from this slice: a new method is one
/// file and one line here.
pub const METHODS: &[&Method] = &[
    &stochastic::METHOD,
    &jittered::METHOD,
    &dart_throwing::METHOD,
    &maximal::METHOD,
    &best_candidate::METHOD,
    &farthest_point_strategy::METHOD,
    &kernel_density::METHOD,
    &electrostatic::METHOD,
    &cccvt::METHOD,
    &lloyd::METHOD,
    &net::METHOD,
    &regular::METHOD,
    &hexagonal::METHOD,
    &farthest_point_optimization::METHOD,
    &step::METHOD,
    &single_peak::METHOD,
    &halton::METHOD,
    &sobol::METHOD,
    &r2::METHOD,
    &bnot::METHOD,
];

/// There is no method of this name.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("there is no method called {name:?}{}", suggestion(*.nearest))]
pub struct UnknownMethod {
    /// The name that was given.
    pub name: String,
    /// The method that was probably meant.
    pub nearest: Option<&'static str>,
}

fn suggestion(nearest: Option<&str>) -> String {
    nearest.map(|name| format!("; did you mean {name}?")).unwrap_or_default()
}

/// The method with this name or alias; case doesn't matter, and `_` is as good as `-`.
///
/// # Errors
/// [`UnknownMethod`], with the nearest name if one is near.
pub fn find(name: &str) -> Result<&'static Method, UnknownMethod> {
    let wanted = name.to_lowercase().replace('_', "-");
    let known_as = |method: &Method| method.name == wanted || method.aliases.contains(&&*wanted);
    if let Some(method) = METHODS.iter().find(|method| known_as(method)) {
        return Ok(method);
    }
    let names = METHODS
        .iter()
        .flat_map(|method| std::iter::once(method.name).chain(method.aliases.iter().copied()));
    Err(UnknownMethod { name: name.to_owned(), nearest: nearest_name(&wanted, names) })
}
