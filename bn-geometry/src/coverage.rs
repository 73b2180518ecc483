//! The hole in a point set.

use bn_core::{DVec2, torus};

use crate::Triangulation;

/// The largest disk that holds no point: its radius is the coverage radius `R_c`, the largest
/// distance of any place on the torus to its nearest point.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Coverage {
    /// `R_c` in unit lengths, at most √½.
    pub radius: f64,
    /// The centre of the disk, in [0, 1)²: a place farthest from all points. Of several the one in
    /// the face of lowest id.
    pub farthest_point: DVec2,
}

impl Coverage {
    /// The coverage of a triangulated set; none if it is empty. The largest circumcircle of a face,
    /// with a relative error of at most 2e-13 in the radius, for points as the triangulation holds
    /// them: on its coordinate grid, which moves them by up to 2⁻⁵¹; O(n).
    ///
    /// ```
    /// use bn_core::{DVec2, PointSet};
    /// use bn_geometry::{Coverage, Triangulation};
    ///
    /// let set = PointSet::new(vec![DVec2::new(0.25, 0.5)])?;
    /// let coverage = Coverage::of(&Triangulation::new(&set)).expect("a set is not empty");
    /// assert_eq!(coverage.radius, 0.5_f64.sqrt());
    /// assert_eq!(coverage.farthest_point, DVec2::new(0.75, 0.0));
    /// # Ok::<(), bn_core::PointSetError>(())
    /// ```
    pub fn of(triangulation: &Triangulation) -> Option<Self> {
        let circles = triangulation.circumcircles();
        let (_, largest) = circles.reduce(|largest, circle| {
            if circle.1.radius_squared > largest.1.radius_squared { circle } else { largest }
        })?;
        let farthest_point = torus::wrap_point(largest.center);
        Some(Self { radius: largest.radius(), farthest_point })
    }
}
