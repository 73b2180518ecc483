//! Points on their way from a file into sets.

use std::mem;

use glam::DVec2;

use super::{ReadOptions, ReadProblem};
use crate::{Ensemble, PointSet, PointSetError, torus};

/// Checks and collects the points of a file. Memory follows the points that were read, never a
/// number that the file states.
pub(super) struct Gather {
    options: ReadOptions,
    points: Vec<DVec2>,
    sets: Vec<PointSet>,
}

impl Gather {
    pub(super) fn new(options: ReadOptions) -> Self {
        Self { options, points: Vec::new(), sets: Vec::new() }
    }

    /// Adds a point to the current set.
    #[inline]
    pub(super) fn push(&mut self, x: f64, y: f64) -> Result<(), ReadProblem> {
        let p = DVec2::new(x, y);
        let p = if torus::contains(p) { p } else { self.mend(p)? };
        if self.points.len() == PointSet::MAX_POINTS {
            return Err(ReadProblem::TooMany);
        }
        self.points.push(p);
        Ok(())
    }

    #[cold]
    fn mend(&self, p: DVec2) -> Result<DVec2, ReadProblem> {
        let DVec2 { x, y } = p;
        if !p.is_finite() {
            Err(ReadProblem::NotFinite { x, y })
        } else if !self.options.wrap {
            Err(ReadProblem::OutOfDomain { x, y })
        } else {
            Ok(torus::wrap_point(p))
        }
    }

    /// Number of points in the current set.
    pub(super) fn points(&self) -> usize {
        self.points.len()
    }

    /// Number of complete sets, which is the current set's number.
    pub(super) fn sets(&self) -> usize {
        self.sets.len()
    }

    /// Completes the current set and starts the next one.
    pub(super) fn end_set(&mut self) -> Result<(), ReadProblem> {
        let mut points = mem::take(&mut self.points);
        points.shrink_to_fit();
        let set = PointSet::new(points).map_err(|error| match error {
            PointSetError::Empty => ReadProblem::Empty,
            PointSetError::TooMany { .. } => ReadProblem::TooMany,
            PointSetError::NotFinite { x, y, .. } => ReadProblem::NotFinite { x, y },
            PointSetError::OutOfDomain { x, y, .. } => ReadProblem::OutOfDomain { x, y },
        })?;
        self.sets.push(set);
        Ok(())
    }

    /// All complete sets.
    pub(super) fn finish(self) -> Result<Ensemble, ReadProblem> {
        Ensemble::new(self.sets).map_err(|_| ReadProblem::Empty)
    }
}
