//! Insertion: the faces whose circles hold the new vertex make room for its star
//! (Bowyer 1981, Watson 1981).

use bn_core::DVec2;

use super::face::{Edge, Face, FaceId, Frame, Shift, next, previous};
use super::locate::{Located, Place};
use super::mesh::{Mesh, Scratch};
use super::polygon::{StarCorner, StarPolygon};
use crate::predicates::{Angle, in_circle, in_circle_exactly, is_inside};

/// A half-edge that borders on the cavity from outside, still to be looked across.
#[derive(Clone, Copy, Debug)]
pub struct Border {
    outer: Edge,
    /// Where the side ends that has the cavity to its left, seen from the new vertex. It starts
    /// where the one before it ends.
    to: DVec2,
}

impl Mesh {
    /// Adds `vertex` at `p`, a point of the coordinate grid, seeking its place from face `start`.
    /// Returns the vertex that is there already, if one is; then nothing changes.
    pub fn insert(
        &mut self,
        vertex: u32,
        p: DVec2,
        start: u32,
        scratch: &mut Scratch,
    ) -> Option<u32> {
        debug_assert!(!self.has_vertex(vertex), "vertex {vertex} is there already");
        self.changed.clear();
        if self.face_count() == 0 {
            self.place_vertex(vertex, p);
            self.insert_first(vertex);
            return None;
        }
        let (face, shift) = match self.conflict(start, p) {
            Some(shift) => (start, shift),
            None => match self.walk(start, p) {
                Located { place: Place::Vertex(at), .. } => return Some(at),
                Located { place: Place::Edge(e), shift } => (e.face(), shift),
                Located { place: Place::Face(face), shift } => (face, shift),
            },
        };
        self.place_vertex(vertex, p);
        if self.gather_cavity(vertex, face, p + shift.vector(), scratch) {
            scratch.star.is_whole &= shift == Shift::ZERO;
            self.fill_cavity(vertex, &mut scratch.star);
        } else {
            self.release(&scratch.star.faces);
            self.insert_by_flips(vertex, &mut scratch.suspects);
        }
        self.last = self.outgoing(vertex).face();
        None
    }

    fn place_vertex(&mut self, vertex: u32, p: DVec2) {
        self.reserve_vertex(vertex);
        self.vertices[vertex as usize].position = p;
    }

    /// The mesh of one vertex: the unit square, cut along its second diagonal.
    fn insert_first(&mut self, vertex: u32) {
        self.clear();
        let at = |x, y| Shift { x, y };
        let edge = Edge::new;
        self.faces.extend([
            Face::new(
                [vertex; 3],
                [edge(1, 1), edge(1, 2), edge(1, 0)],
                Frame::new([at(0, 0), at(1, 0), at(0, 1)]),
            ),
            Face::new(
                [vertex; 3],
                [edge(0, 2), edge(0, 0), edge(0, 1)],
                Frame::new([at(1, 0), at(1, 1), at(0, 1)]),
            ),
        ]);
        self.set_outgoing(vertex, edge(0, 0));
        self.changed.extend([FaceId(0), FaceId(1)]);
        self.last = 0;
    }

    /// The copy of `p` that lies inside the circle of `face`, if the nearest one does.
    fn conflict(&self, face: u32, p: DVec2) -> Option<Shift> {
        let shift = self.nearest_shift(face, p);
        let [a, b, c] = self.corners(self.face(face));
        let q = p + shift.vector();
        in_circle(a - q, b - q, c - q).then_some(shift)
    }

    /// Claims the faces whose circles hold the new vertex, which is at `q` in the frame of one of
    /// them, `face`. They form a polygon that `q` sees all of, with no vertex inside.
    ///
    /// False if the polygon meets its own copy (few points, or wide holes): then the copies of
    /// the new vertex matter to each other.
    fn gather_cavity(&mut self, vertex: u32, face: u32, q: DVec2, scratch: &mut Scratch) -> bool {
        let Scratch { star, borders, .. } = scratch;
        star.clear();
        self.claim(face, vertex, star);
        let record = *self.face(face);
        let [start, b, c] = self.corners(&record).map(|corner| corner - q);
        borders.clear();
        borders.extend([
            Border { outer: record.twin(2), to: start },
            Border { outer: record.twin(1), to: c },
            Border { outer: record.twin(0), to: b },
        ]);
        let mut from = start;
        while let Some(Border { mut outer, mut to }) = borders.pop() {
            // Sides are looked across in counter-clockwise order.
            loop {
                let there = self.face(outer.face());
                if there.claimant() == vertex {
                    return false;
                }
                let (n, p) = (next(outer.corner()), previous(outer.corner()));
                let apex = from + self.side(there, n, p);
                if !sees_across(from, to, apex) {
                    let vertex = there.vertex(n);
                    let corner = StarCorner { position: from, vertex, outer, inner: Edge::NONE };
                    star.corners.push(corner);
                    break;
                }
                let (beyond_n, beyond_p) = (there.twin(n), there.twin(p));
                self.claim(outer.face(), vertex, star);
                borders.push(Border { outer: beyond_p, to });
                (outer, to) = (beyond_n, apex);
            }
            from = to;
        }
        let claimed = |corner: &StarCorner| self.face(corner.outer.face()).claimant() == vertex;
        !star.corners.iter().any(claimed)
    }

    #[inline]
    fn claim(&mut self, face: u32, vertex: u32, star: &mut StarPolygon) {
        let record = &mut self.faces[face as usize];
        record.claim(vertex);
        star.is_whole &= record.frame().is_zero();
        star.faces.push(face);
    }

    #[cold]
    fn release(&mut self, faces: &[u32]) {
        for &face in faces {
            self.faces[face as usize].claim(super::face::NONE);
        }
    }

    /// Connects the new vertex to all corners of the polygon around it.
    fn fill_cavity(&mut self, vertex: u32, star: &mut StarPolygon) {
        star.faces.extend([self.new_face(), self.new_face()]);
        let degree = star.corners.len();
        debug_assert_eq!(star.faces.len(), degree, "two faces more than before");
        let mut corner = star.corners[degree - 1];
        let mut face = star.faces[degree - 1];
        let mut previous = star.faces[degree - 2];
        for (&next_corner, &next_face) in star.corners.iter().zip(&star.faces) {
            let frame = if star.is_whole {
                Frame::ZERO
            } else {
                self.spoke_frame(vertex, &corner, &next_corner)
            };
            let twins = [corner.outer, Edge::new(next_face, 2), Edge::new(previous, 1)];
            let vertices = [corner.vertex, next_corner.vertex, vertex];
            self.faces[face as usize] = Face::new(vertices, twins, frame);
            let side = Edge::new(face, 0);
            self.faces[corner.outer.face() as usize].set_twin(corner.outer.corner(), side);
            self.set_outgoing(corner.vertex, side);
            self.changed.push(FaceId(face));
            (corner, previous, face) = (next_corner, face, next_face);
        }
        self.set_outgoing(vertex, Edge::new(face, 2));
    }

    /// The frame of the face of two corners of a polygon and its centre.
    #[cold]
    fn spoke_frame(&self, center: u32, from: &StarCorner, to: &StarCorner) -> Frame {
        let p = self.position(center);
        Frame::new([self.corner_shift(p, from), self.corner_shift(p, to), Shift::ZERO])
    }
}

/// Whether the origin, to the left of the edge from `from` to `to`, lies inside the circle of
/// the face on its other side, whose third corner is `apex`.
#[inline]
fn sees_across(from: DVec2, to: DVec2, apex: DVec2) -> bool {
    let inside = is_inside(Angle::between(from, to), Angle::between(to - apex, from - apex));
    inside.or_else(|| in_circle_exactly(to, from, apex))
}
