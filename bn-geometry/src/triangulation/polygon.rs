//! The star polygon: the room in which a vertex is inserted, or was removed.

use bn_core::DVec2;

use super::face::{Edge, Frame, NONE, Shift, next, previous};
use super::mesh::Mesh;

/// A polygon of mesh edges with no vertex inside but for its centre, from which all of it can be
/// seen.
#[derive(Clone, Debug)]
pub struct StarPolygon {
    /// The vertex in the middle while the polygon is that of the mesh as it is.
    pub center: u32,
    /// Its corners counter-clockwise.
    pub corners: Vec<StarCorner>,
    /// The faces inside, whose records the new ones take.
    pub faces: Vec<u32>,
    /// Whether all corners belong to the same copy of the unit square as the centre.
    pub is_whole: bool,
}

/// A corner of the polygon, and the side from there to the next corner.
#[derive(Clone, Copy, Debug)]
pub struct StarCorner {
    /// From the centre to this corner.
    pub position: DVec2,
    pub vertex: u32,
    /// The half-edge of the side that lies outside.
    pub outer: Edge,
    /// The half-edge of the side that lies inside.
    pub inner: Edge,
}

impl Default for StarPolygon {
    fn default() -> Self {
        Self { center: NONE, corners: Vec::new(), faces: Vec::new(), is_whole: true }
    }
}

impl StarPolygon {
    pub fn clear(&mut self) {
        self.center = NONE;
        self.corners.clear();
        self.faces.clear();
        self.is_whole = true;
    }
}

impl Mesh {
    /// Which copy a corner is of its vertex, relative to the centre at `center` in [0, 1)².
    pub(super) fn corner_shift(&self, center: DVec2, corner: &StarCorner) -> Shift {
        // Exact, and whole.
        let shift = center + corner.position - self.position(corner.vertex);
        Shift { x: shift.x as i8, y: shift.y as i8 }
    }

    /// Collects the faces around `vertex`; false if the vertex is its own neighbour, so that its
    /// star is no polygon.
    pub(super) fn gather_star(&self, vertex: u32, star: &mut StarPolygon) -> bool {
        star.clear();
        let first = self.outgoing(vertex);
        let mut e = first;
        loop {
            let face = self.face(e.face());
            let (c, n) = (e.corner(), next(e.corner()));
            let to = face.vertex(n);
            if to == vertex {
                return false;
            }
            star.is_whole &= face.frame() == Frame::ZERO;
            let position = self.side(face, c, n);
            let corner =
                StarCorner { position, vertex: to, outer: face.twin(n), inner: Edge::NONE };
            star.corners.push(corner);
            star.faces.push(e.face());
            e = face.twin(previous(c));
            if e == first {
                star.center = vertex;
                return true;
            }
        }
    }
}
