//! What every generator of patterns can do.

use std::fmt::Debug;

use bn_core::{DVec2, Observer, PointSet, Seed};

use crate::{Report, SampleError};

/// A method of making sampling patterns together with its options.
///
/// Every implementor is a struct whose public fields are the options; its `Default` holds the
/// method's defaults.
pub trait Sampler: Debug + Send + Sync {
    /// Makes one pattern of `n` points on the unit torus.
    ///
    /// The same options, `n` and `seed` give the same bytes on any machine and any number of
    /// threads; `observer` sees how the work proceeds and can stop it, but never changes a result.
    ///
    /// # Errors
    /// [`SampleError`]: a count or option that the method cannot serve, a target that was not
    /// reached, or the observer's wish to stop.
    fn sample(&self, n: usize, seed: Seed, observer: &dyn Observer) -> Result<Sample, SampleError>;
}

/// A pattern and the account of how it was made.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Sample {
    /// The points, in the order that the method states ([`crate::PointOrder`]).
    pub points: PointSet,
    /// What the method has to say about the run.
    pub report: Report,
}

impl Sample {
    /// The sample of points that are in [0, 1)² by construction.
    pub(crate) fn new(points: Vec<DVec2>, report: Report) -> Self {
        let points = PointSet::new(points).expect("methods make points of the unit torus");
        Self { points, report }
    }
}
