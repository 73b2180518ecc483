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
        // Room to grow, so that adding points one by one costs O(1) amortised.
        let mut radius_squared = MaxTree::zeros(triangulation.face_bound() * 2);
        for (face, circle) in triangulation.circumcircles() {
            radius_squared.set(face.id.index(), circle.radius_squared);
        }
        Self { radius_squared }
    }

    /// Takes over what the last insertion or removal changed.
    #[inline]
    pub fn update(&mut self, triangulation: &Triangulation) {
        if triangulation.face_bound() > self.radius_squared.len() {
            *self = Self::new(triangulation);
            return;
        }
        for &face in triangulation.changed_faces() {
            let circle = triangulation.has_face(face).then(|| triangulation.circumcircle(face));
            let radius_squared = circle.map_or(0.0, |circle| circle.radius_squared);
            self.radius_squared.set(face.index(), radius_squared);
        }
    }

    /// The face with the largest circle, of several the one of lowest id; none if there is no face.
    #[inline]
    pub fn largest(&self) -> Option<FaceId> {
        let index = self.radius_squared.argmax();
        (self.radius_squared.get(index) > 0.0).then(|| FaceId::new(index))
    }

    /// The squared radius of a face's circle; 0 if there is no such face.
    #[inline]
    pub fn radius_squared(&self, face: FaceId) -> f64 {
        self.radius_squared.get(face.index())
    }
}
