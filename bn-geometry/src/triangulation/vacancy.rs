//! What a point would leave behind, without taking it out.

use bn_core::DVec2;

use super::Triangulation;
use super::polygon::StarPolygon;
use super::remove::delaunay_apex;
use crate::circle::{circumcircle, circumradius_squared};

/// The room that a point would leave behind if it were taken out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vacancy {
    /// The squared distance from the point to its nearest neighbour.
    pub clearance_squared: f64,
    /// The squared radius of the largest circle among those of the faces that would fill the room.
    pub radius_squared: f64,
    /// The vector from the point to the centre of that circle.
    pub to_center: DVec2,
}

impl Triangulation {
    /// The room that point `index` would leave behind if it were taken out; none if the point
    /// shares its place with others or is its own neighbour. Changes nothing that can be seen; a
    /// [`Triangulation::relocate`] of the same point that follows at once takes less time.
    ///
    /// O(d²) for a point with d neighbours, with no allocation.
    ///
    /// # Panics
    /// If there is no such point.
    #[inline]
    pub fn vacancy(&mut self, index: usize) -> Option<Vacancy> {
        let vertex = self.vertex(index);
        if self.coincidences.is_shared(vertex) {
            return None;
        }
        let star = &mut self.scratch.star;
        self.mesh.gather_star(vertex, star).then(|| star.vacancy(&mut self.scratch.spans))
    }
}

impl StarPolygon {
    /// The vacancy of the centre.
    #[inline]
    fn vacancy(&self, spans: &mut Vec<(usize, usize)>) -> Vacancy {
        let lengths = self.corners.iter().map(|corner| corner.position.length_squared());
        let clearance_squared = lengths.fold(f64::INFINITY, f64::min);
        let (mut largest, mut radius_squared) = ([0; 3], 0.0);
        spans.clear();
        let (mut first, mut last) = (0, self.corners.len() - 1);
        loop {
            let apex = delaunay_apex(&self.corners, first, last);
            let face = [first, apex, last];
            let squared = circumradius_squared(face.map(|i| self.corners[i].position));
            if squared > radius_squared {
                (largest, radius_squared) = (face, squared);
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
        let circle = circumcircle(largest.map(|i| self.corners[i].position));
        Vacancy { clearance_squared, radius_squared, to_center: circle.center }
    }
}
