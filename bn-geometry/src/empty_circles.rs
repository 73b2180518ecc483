//! The faces of a triangulation in the order of their circles.

use bn_core::DVec2;

use crate::max_tree::MaxTree;
use crate::{Circle, FaceId, Triangulation};

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
    /// Size by face; 0 where there is no face.
    size: MaxTree,
}

impl EmptyCircles {
    /// The circles of all faces of a triangulation, by their squared radii. O(n).
    pub fn new(triangulation: &Triangulation) -> Self {
        Self::sized(triangulation, by_radius)
    }

    /// As [`EmptyCircles::new`], but by any size ≥ 0 that is a function of the
    /// face's corners, as [`Face::corners`](crate::Face::corners) has them.
    pub fn sized(triangulation: &Triangulation, size: impl Fn([DVec2; 3]) -> f64) -> Self {
        let bound = triangulation.face_bound();
        let mut circles = Self { size: MaxTree::zeros(bound) };
        circles.renew(triangulation, (0..bound).map(FaceId::new), size);
        circles
    }

    /// Takes over what the last insertion or removal changed.
    #[inline]
    pub fn update(&mut self, triangulation: &Triangulation) {
        self.update_sized(triangulation, by_radius);
    }

    /// As [`EmptyCircles::update`], by the size given to [`EmptyCircles::sized`].
    #[inline]
    pub fn update_sized(
        &mut self,
        triangulation: &Triangulation,
        size: impl Fn([DVec2; 3]) -> f64,
    ) {
        let bound = triangulation.face_bound();
        if bound <= self.size.len() {
            self.renew(triangulation, triangulation.changed_faces().iter().copied(), size);
        } else {
            // Room to grow, so that adding points one by one costs O(1) amortised.
            self.size = MaxTree::zeros(2 * bound);
            self.renew(triangulation, (0..bound).map(FaceId::new), size);
        }
    }

    #[inline]
    fn renew(
        &mut self,
        triangulation: &Triangulation,
        faces: impl Iterator<Item = FaceId> + Clone,
        size: impl Fn([DVec2; 3]) -> f64,
    ) {
        self.size.set(&faces.map(FaceId::index), |index| {
            triangulation.corners(FaceId::new(index)).map_or(0.0, &size)
        });
    }

    /// The face with the largest circle, of several the one of lowest id; none if there is no face
    /// of a size above 0.
    #[inline]
    pub fn largest(&self) -> Option<FaceId> {
        let index = self.size.argmax();
        (self.size.get(index) > 0.0).then(|| FaceId::new(index))
    }

    /// The size of a face's circle, by default its squared radius; 0 if there was no such face at
    /// the last update.
    #[inline]
    pub fn size(&self, face: FaceId) -> f64 {
        let index = face.index();
        if index < self.size.len() { self.size.get(index) } else { 0.0 }
    }
}

fn by_radius(corners: [DVec2; 3]) -> f64 {
    Circle::through(corners).radius_squared
}
