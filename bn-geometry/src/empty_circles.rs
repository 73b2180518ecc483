//! The faces of a triangulation in the order of their circles.

use crate::max_tree::MaxTree;
use crate::{FaceId, Triangulation};

/// Knows at any time which face of a changing triangulation has the largest circumcircle: the
/// largest hole among the points.
///
/// A companion of one [`Triangulation`]: call [`EmptyCircles::update`] after each insertion and
/// removal. An update takes some ten nanoseconds for each changed face, the question for the
/// largest O(log n).
///
/// ```
/// use bn_core::{DVec2, PointSet, torus};
/// use bn_geometry::{EmptyCircles, Triangulation};
///
/// // Ten times a point in the middle of the largest hole.
/// let mut triangulation = Triangulation::new(&PointSet::new(vec![DVec2::ZERO])?);
/// let mut holes = EmptyCircles::new(&triangulation);
/// for index in 1..=10 {
///     let face = holes.largest().expect("there are points");
///     let center = torus::wrap_point(triangulation.circumcircle(face).center);
///     triangulation.insert_near(index, center, face);
///     holes.update(&triangulation);
/// }
/// # Ok::<(), bn_core::PointSetError>(())
/// ```
#[derive(Clone, Debug)]
pub struct EmptyCircles {
    /// Squared radius by face; 0 where there is no face.
    radius_squared: MaxTree,
}

impl EmptyCircles {
    /// The circles of all faces of a triangulation. O(n).
    pub fn new(triangulation: &Triangulation) -> Self {
        let bound = triangulation.face_bound();
        let mut circles = Self { radius_squared: MaxTree::zeros(bound) };
        circles.renew(triangulation, (0..bound).map(FaceId::new));
        circles
    }

    /// Takes over what the last insertion or removal changed.
    #[inline]
    pub fn update(&mut self, triangulation: &Triangulation) {
        let bound = triangulation.face_bound();
        if bound <= self.radius_squared.len() {
            self.renew(triangulation, triangulation.changed_faces().iter().copied());
        } else {
            // Room to grow, so that adding points one by one costs O(1) amortised.
            self.radius_squared = MaxTree::zeros(2 * bound);
            self.renew(triangulation, (0..bound).map(FaceId::new));
        }
    }

    #[inline]
    fn renew(
        &mut self,
        triangulation: &Triangulation,
        faces: impl Iterator<Item = FaceId> + Clone,
    ) {
        self.radius_squared.set(&faces.map(FaceId::index), |index| {
            triangulation.circumradius_squared(FaceId::new(index)).unwrap_or(0.0)
        });
    }

    /// The face with the largest circle, of several the one of lowest id; none if there is no face.
    #[inline]
    pub fn largest(&self) -> Option<FaceId> {
        let index = self.radius_squared.argmax();
        (self.radius_squared.get(index) > 0.0).then(|| FaceId::new(index))
    }

    /// The squared radius of a face's circle; 0 if there was no such face at the last update.
    #[inline]
    pub fn radius_squared(&self, face: FaceId) -> f64 {
        let index = face.index();
        if index < self.radius_squared.len() { self.radius_squared.get(index) } else { 0.0 }
    }
}
