//! What a point would leave behind, without taking it out.

use bn_core::DVec2;

use super::Triangulation;
use super::mesh::Scratch;
use super::polygon::StarPolygon;
use super::remove::delaunay_apex;

/// The room that a point would leave behind if it were taken out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vacancy {
    /// How near the nearest neighbour is.
    pub clearance: f64,
    /// The size of the largest of the faces that would fill the room; 0 if all are of size 0.
    pub size: f64,
    /// The corners of that face, relative to the point; none if all are of size 0.
    pub face: Option<[DVec2; 3]>,
}

impl Triangulation {
    /// The room that point `index` would leave behind if it were taken out, its faces measured by
    /// `size`, a function ≥ 0 of their corners such as the radius of the circle through them, and
    /// neighbours by `distance`, both of places relative to the point; none if the point shares its
    /// place with others or is its own neighbour.
    ///
    /// Changes nothing that can be seen; a [`Triangulation::relocate`] of the same point that
    /// follows at once takes less time. O(d²) for a point with d neighbours, with no allocation.
    ///
    /// # Panics
    /// If there is no such point.
    #[inline]
    pub fn vacancy(
        &mut self,
        index: usize,
        size: impl Fn([DVec2; 3]) -> f64,
        distance: impl Fn(DVec2) -> f64,
    ) -> Option<Vacancy> {
        let vertex = self.vertex(index);
        if self.coincidences.is_shared(vertex) {
            return None;
        }
        let Scratch { star, spans, .. } = &mut self.scratch;
        self.mesh.gather_star(vertex, star).then(|| star.vacancy(spans, size, distance))
    }
}

impl StarPolygon {
    /// The vacancy of the centre.
    #[inline]
    fn vacancy(
        &self,
        spans: &mut Vec<(usize, usize)>,
        size: impl Fn([DVec2; 3]) -> f64,
        distance: impl Fn(DVec2) -> f64,
    ) -> Vacancy {
        let distances = self.corners.iter().map(|corner| distance(corner.position));
        let clearance = distances.fold(f64::INFINITY, f64::min);
        let places = |face: [usize; 3]| face.map(|i| self.corners[i].position);
        let (mut largest, mut greatest) = (None, 0.0);
        spans.clear();
        let (mut first, mut last) = (0, self.corners.len() - 1);
        loop {
            let apex = delaunay_apex(&self.corners, first, last);
            let face = [first, apex, last];
            let found = size(places(face));
            if found > greatest {
                (largest, greatest) = (Some(face), found);
            }
            if apex > first + 1 {
                spans.push((first, apex));
            }
            if last > apex + 1 {
                first = apex;
            } else if let Some(rest) = spans.pop() {
                (first, last) = rest;
            } else {
                break;
            }
        }
        Vacancy { clearance, size: greatest, face: largest.map(places) }
    }
}
