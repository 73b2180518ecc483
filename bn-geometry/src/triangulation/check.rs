//! Every invariant of a triangulation, checked.

use bn_core::torus;

use super::Triangulation;
use super::face::{Edge, next, previous};
use super::mesh::Mesh;
use crate::predicates::cross;

impl Triangulation {
    /// Checks every invariant of the triangulation, for tests and fuzzing. O(n).
    ///
    /// Since a triangulation of a flat torus that is Delaunay across each of its edges is so as a
    /// whole, this is a complete check, up to the places and numbers of points.
    ///
    /// # Panics
    /// If one is broken, with what and where.
    pub fn sanity_check(&self) {
        self.mesh.check_records();
        for (id, face) in (0..).zip(&self.mesh.faces) {
            if face.is_alive() {
                self.mesh.check_face(id);
            }
        }
        for vertex in self.mesh.vertex_numbers() {
            self.mesh.check_vertex(vertex);
            assert_eq!(self.coincidences.vertex(vertex), vertex, "vertices stand for themselves");
        }
        let degrees: usize =
            self.mesh.vertex_numbers().map(|v| self.neighbors(v as usize).count()).sum();
        assert_eq!(degrees, 3 * self.face_count(), "half-edges that belong to no vertex");
    }
}

impl Mesh {
    fn check_records(&self) {
        let alive = self.faces.iter().filter(|face| face.is_alive()).count();
        assert_eq!(alive, self.face_count(), "living faces");
        assert!(self.free.iter().all(|&id| !self.face(id).is_alive()), "a living face is free");
        assert_eq!(2 * self.vertex_numbers().count(), alive, "Euler: n vertices, 2n faces");
        assert!(alive == 0 || self.face(self.last).is_alive(), "searches start at a dead face");
    }

    fn check_face(&self, id: u32) {
        let face = self.face(id);
        let corners = self.corners(face);
        assert_eq!(face.frame().shift(0).vector(), bn_core::DVec2::ZERO, "frame of face {id}");
        let area = cross(corners[1] - corners[0], corners[2] - corners[0]);
        assert!(area > 0.0, "face {id} has area {area}");
        for c in 0..3 {
            let (e, t) = (Edge::new(id, c), face.twin(c));
            assert!(t.corner() < 3 && self.face(t.face()).is_alive(), "{e:?} borders on nothing");
            assert_eq!(self.twin(t), e, "the twin of the twin of {e:?}");
            assert_ne!(t.face(), id, "face {id} is its own neighbour");
            assert_eq!(face.vertex(next(c)), self.origin(t), "the end of {e:?}");
            let there = self.face(t.face());
            let side = self.side(there, next(t.corner()), t.corner());
            assert_eq!(side, self.side(face, c, next(c)), "{e:?} and its twin differ");
            assert!(!self.is_illegal(e), "{e:?}, opposite {}, is not Delaunay", previous(c));
        }
    }

    fn check_vertex(&self, vertex: u32) {
        let p = self.position(vertex);
        assert!(torus::contains(p) && p == crate::predicates::snap(p), "{p} is off the grid");
        let e = self.outgoing(vertex);
        assert_eq!(self.origin(e), vertex, "{e:?} starts elsewhere");
    }
}
