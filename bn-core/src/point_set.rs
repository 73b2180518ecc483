//! Point sets and ensembles that can only hold valid points.

use glam::DVec2;
use thiserror::Error;

use crate::{Density, torus};

/// Why points don't form a [`PointSet`].
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum PointSetError {
    /// No point at all.
    #[error("the set holds no point; a set needs at least one")]
    Empty,
    /// A coordinate is NaN or infinite.
    #[error("point {index} is ({x:?}, {y:?}); coordinates must be finite numbers")]
    NotFinite {
        /// Position of the point, from 0.
        index: usize,
        /// Its abscissa.
        x: f64,
        /// Its ordinate.
        y: f64,
    },
    /// A coordinate lies outside [0, 1).
    #[error(
        "point {index} is ({x:?}, {y:?}), outside the unit square [0, 1)²; scale or wrap the points"
    )]
    OutOfDomain {
        /// Position of the point, from 0.
        index: usize,
        /// Its abscissa.
        x: f64,
        /// Its ordinate.
        y: f64,
    },
    /// More points than 32-bit indices can number.
    #[error("{count} points are too many; a set holds at most 2²⁹")]
    TooMany {
        /// How many points were given.
        count: usize,
    },
}

/// One to 2²⁹ points of the unit torus, each finite and in [0, 1)²; order and duplicates are kept.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(transparent))]
pub struct PointSet {
    points: Vec<DVec2>,
}

impl PointSet {
    /// The largest number of points in one set: indices are 32 bits wide and triangulations number
    /// two triangles a point.
    pub const MAX_POINTS: usize = 1 << 29;

    /// The set of these points.
    ///
    /// # Errors
    /// [`PointSetError`] if there is none, or one is outside [0, 1)²; it tells the first such point.
    pub fn new(points: Vec<DVec2>) -> Result<Self, PointSetError> {
        check_count(points.len())?;
        for (index, p) in points.iter().enumerate() {
            if !p.is_finite() {
                return Err(PointSetError::NotFinite { index, x: p.x, y: p.y });
            }
            if !torus::contains(*p) {
                return Err(PointSetError::OutOfDomain { index, x: p.x, y: p.y });
            }
        }
        Ok(Self { points })
    }

    /// The set of these points, each wrapped into [0, 1)².
    ///
    /// # Errors
    /// [`PointSetError`] if there is none, or one is not finite.
    pub fn wrapped(mut points: Vec<DVec2>) -> Result<Self, PointSetError> {
        check_count(points.len())?;
        for (index, p) in points.iter_mut().enumerate() {
            if !p.is_finite() {
                return Err(PointSetError::NotFinite { index, x: p.x, y: p.y });
            }
            *p = torus::wrap_point(*p);
        }
        Ok(Self { points })
    }

    /// The points, in order.
    pub fn points(&self) -> &[DVec2] {
        &self.points
    }

    /// The points, in order, by value.
    pub fn into_points(self) -> Vec<DVec2> {
        self.points
    }

    /// Number of points n ≥ 1.
    #[expect(clippy::len_without_is_empty, reason = "a point set is never empty")]
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// The density n and its units.
    pub fn density(&self) -> Density {
        Density::new(self.points.len())
    }

    /// The set moved by `displacement` on the torus.
    ///
    /// # Panics
    /// If `displacement` is not finite.
    #[must_use]
    pub fn translated(&self, displacement: DVec2) -> Self {
        assert!(displacement.is_finite(), "displacement {displacement} is not finite");
        Self { points: self.points.iter().map(|&p| torus::wrap_point(p + displacement)).collect() }
    }
}

fn check_count(count: usize) -> Result<(), PointSetError> {
    match count {
        0 => Err(PointSetError::Empty),
        1..=PointSet::MAX_POINTS => Ok(()),
        _ => Err(PointSetError::TooMany { count }),
    }
}

#[cfg(feature = "serde")]
impl<'de> serde::Deserialize<'de> for PointSet {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Self::new(Vec::deserialize(deserializer)?).map_err(serde::de::Error::custom)
    }
}

/// Why sets don't form an [`Ensemble`].
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum EnsembleError {
    /// No set at all.
    #[error("the ensemble holds no set; it needs at least one")]
    Empty,
}

/// One or more point sets that belong together, such as the realisations of one random method.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(transparent))]
pub struct Ensemble {
    sets: Vec<PointSet>,
}

impl Ensemble {
    /// The ensemble of these sets, in order.
    ///
    /// # Errors
    /// [`EnsembleError::Empty`] if there is none.
    pub fn new(sets: Vec<PointSet>) -> Result<Self, EnsembleError> {
        if sets.is_empty() { Err(EnsembleError::Empty) } else { Ok(Self { sets }) }
    }

    /// The sets, in order.
    pub fn sets(&self) -> &[PointSet] {
        &self.sets
    }

    /// The sets, in order, by value.
    pub fn into_sets(self) -> Vec<PointSet> {
        self.sets
    }

    /// Number of sets, at least 1.
    #[expect(clippy::len_without_is_empty, reason = "an ensemble is never empty")]
    pub fn len(&self) -> usize {
        self.sets.len()
    }

    /// Number of points in each set, if all sets have the same.
    pub fn points_per_set(&self) -> Option<usize> {
        let n = self.sets[0].len();
        self.sets.iter().all(|set| set.len() == n).then_some(n)
    }
}

impl From<PointSet> for Ensemble {
    fn from(set: PointSet) -> Self {
        Self { sets: vec![set] }
    }
}

#[cfg(feature = "serde")]
impl<'de> serde::Deserialize<'de> for Ensemble {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Self::new(Vec::deserialize(deserializer)?).map_err(serde::de::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x: f64, y: f64) -> DVec2 {
        DVec2::new(x, y)
    }

    #[test]
    fn rejects_what_is_not_on_the_torus() {
        assert_eq!(PointSet::new(vec![]), Err(PointSetError::Empty));
        let nan = PointSet::new(vec![at(0.5, 0.5), at(f64::NAN, 0.0)]);
        assert!(matches!(nan, Err(PointSetError::NotFinite { index: 1, .. })));
        assert!(matches!(
            PointSet::wrapped(vec![at(f64::INFINITY, 0.0)]),
            Err(PointSetError::NotFinite { .. })
        ));
        let edge = PointSet::new(vec![at(1.0, 0.0)]);
        assert_eq!(edge, Err(PointSetError::OutOfDomain { index: 0, x: 1.0, y: 0.0 }));
        assert!(PointSet::new(vec![at(0.0, torus::ONE_MINUS_EPSILON), at(1e-300, -0.0)]).is_ok());
    }

    #[test]
    fn wrapped_keeps_order_and_duplicates() {
        let set = PointSet::wrapped(vec![at(1.25, -0.25), at(0.25, 0.75)]).expect("finite");
        assert_eq!(set.points(), [at(0.25, 0.75), at(0.25, 0.75)]);
    }

    #[test]
    fn translation_goes_round() {
        let set = PointSet::new(vec![at(0.75, 0.5)]).expect("valid");
        assert_eq!(set.translated(at(0.5, -0.75)).points(), [at(0.25, 0.75)]);
    }

    #[test]
    fn ensembles_know_their_common_size() {
        let one = PointSet::new(vec![at(0.5, 0.5)]).expect("valid");
        let two = PointSet::new(vec![at(0.5, 0.5), at(0.0, 0.0)]).expect("valid");
        assert_eq!(Ensemble::new(vec![]), Err(EnsembleError::Empty));
        let same = Ensemble::new(vec![one.clone(), one.clone()]).expect("two sets");
        assert_eq!(same.points_per_set(), Some(1));
        assert_eq!(Ensemble::new(vec![one, two]).expect("two sets").points_per_set(), None);
    }
}
