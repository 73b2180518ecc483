//! Point sets of a row, read where they are kept and made where they are not.

use bn_cli::{Failure, Outcome};
use bn_core::{PointSet, Seed, Unobserved};
use bn_samplers::{Method, SampleError};
use rayon::prelude::*;

use super::{Plan, Store};
use crate::thesis::RowSpec;

/// Sets, and how many of them were not in the store.
pub(crate) type Made = (Vec<PointSet>, usize);

/// The sets of a row by the plan: one is enough where no seed matters. The inner error is the
/// method's own, the outer one any other failure.
pub(crate) fn sets(
    row: &RowSpec,
    method: &'static Method,
    plan: Plan,
    store: Option<&Store>,
) -> Outcome<Result<Made, SampleError>> {
    let options = row.options.iter().map(|(name, value)| (&**name, &**value));
    let sampler = method.with_options(options).map_err(Failure::usage)?;
    // `seeded` speaks of the default options.
    let sets = if method.seeded || !row.options.is_empty() { plan.sets } else { 1 };
    let one = |set: u32| {
        let place = store.map(|store| store.place(method, row, plan, set));
        if let Some(points) = place.as_ref().and_then(super::store::Place::read) {
            return Ok(Ok((points, 0)));
        }
        let seed = Seed::new(plan.seed).for_set(set);
        let points = match sampler.sample(plan.n, seed, &Unobserved) {
            Ok(sample) => sample.points,
            Err(error) => return Ok(Err(error)),
        };
        if let Some(place) = place {
            place.write(&points)?;
        }
        Ok(Ok((points, 1)))
    };
    let results: Outcome<Vec<_>> = (0..sets).into_par_iter().map(one).collect();
    Ok(results?.into_iter().collect::<Result<Vec<_>, _>>().map(|results| {
        let made = results.iter().map(|(_, made)| made).sum();
        (results.into_iter().map(|(points, _)| points).collect(), made)
    }))
}
