//! The mesh of distinct vertices: storage, navigation and the edge flip.

use bn_core::DVec2;

use super::face::{Edge, Face, FaceId, Frame, NONE, Shift, next, previous};
use super::remove::StarPolygon;
use crate::predicates::in_circle;

/// A triangulation of the torus by faces whose sides are glued in pairs.
///
/// The gluing may join a vertex or a face's neighbour to itself in several ways (a Δ-complex), so
/// one vertex with two faces is as good a mesh as any. Only a face is never its own neighbour: the
/// gluing is by translations and no two sides of a triangle are parallel.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Faces in use and dead ones, which are listed in `free`.
    pub faces: Vec<Face>,
    pub free: Vec<u32>,
    /// Place of each vertex on the coordinate grid in [0, 1)²; meaningless for absent vertices.
    pub position: Vec<DVec2>,
    /// A half-edge that starts at the vertex, or none for absent vertices.
    pub outgoing: Vec<Edge>,
    /// Faces made, altered or freed by the last insertion or removal.
    pub changed: Vec<FaceId>,
    /// Where a search starts that has no better place: a living face, unless there is none.
    pub last: u32,
    pub(super) star: StarPolygon,
    pub(super) suspects: Vec<Edge>,
}

impl Mesh {
    pub fn face_count(&self) -> usize {
        self.faces.len() - self.free.len()
    }

    pub fn vertex_count(&self) -> usize {
        self.face_count() / 2
    }

    pub fn has_vertex(&self, vertex: u32) -> bool {
        self.outgoing.get(vertex as usize).is_some_and(|&e| e != Edge::NONE)
    }

    /// The vertices that the mesh has, in order.
    pub fn vertices(&self) -> impl Iterator<Item = u32> {
        (0..self.outgoing.len() as u32).filter(|&v| self.has_vertex(v))
    }

    #[inline]
    pub fn face(&self, face: u32) -> &Face {
        &self.faces[face as usize]
    }

    #[inline]
    pub fn twin(&self, e: Edge) -> Edge {
        self.face(e.face()).twin[e.corner()]
    }

    /// Where the half-edge starts.
    #[inline]
    pub fn origin(&self, e: Edge) -> u32 {
        self.face(e.face()).vertex[e.corner()]
    }

    /// The half-edge that follows counter-clockwise around the same origin.
    #[inline]
    pub fn turn(&self, e: Edge) -> Edge {
        self.twin(e.previous())
    }

    /// The place of a face's corner in the face's own frame.
    #[inline]
    pub fn corner(&self, face: &Face, corner: usize) -> DVec2 {
        let p = self.position[face.vertex[corner] as usize];
        if face.frame.is_zero() { p } else { p + face.frame.shift(corner).vector() }
    }

    /// The places of a face's corners in its own frame.
    #[inline]
    pub fn corners(&self, face: &Face) -> [DVec2; 3] {
        let p = face.vertex.map(|v| self.position[v as usize]);
        if face.frame.is_zero() {
            return p;
        }
        [0, 1, 2].map(|c| p[c] + face.frame.shift(c).vector())
    }

    /// The vector from a face's corner `from` to its corner `to`.
    #[inline]
    pub fn side(&self, face: &Face, from: usize, to: usize) -> DVec2 {
        self.corner(face, to) - self.corner(face, from)
    }

    /// The translation from the frame of the face across `e` into that of the face of `e`.
    #[inline]
    pub fn shift_across(&self, e: Edge) -> Shift {
        let here = self.face(e.face());
        let t = here.twin[e.corner()];
        let there = self.face(t.face());
        if here.frame.is_zero() && there.frame.is_zero() {
            return Shift::ZERO;
        }
        // The start of e is the end of its twin.
        here.frame.shift(e.corner()).minus(there.frame.shift(next(t.corner())))
    }

    /// Makes room for a vertex of this number.
    pub fn reserve_vertex(&mut self, vertex: u32) {
        let len = vertex as usize + 1;
        if self.position.len() < len {
            self.position.resize(len, DVec2::ZERO);
            self.outgoing.resize(len, Edge::NONE);
        }
    }

    /// A face to be filled in, recycled or new.
    #[inline]
    pub fn new_face(&mut self) -> u32 {
        self.free.pop().unwrap_or_else(|| {
            self.faces.push(Face::DEAD);
            self.faces.len() as u32 - 1
        })
    }

    pub fn free_face(&mut self, face: u32) {
        self.faces[face as usize] = Face::DEAD;
        self.free.push(face);
    }

    /// Glues two half-edges together.
    #[inline]
    pub fn glue(&mut self, e: Edge, t: Edge) {
        self.faces[e.face() as usize].twin[e.corner()] = t;
        self.faces[t.face() as usize].twin[t.corner()] = e;
    }

    /// Calls the vertex `old` by the number `new`.
    pub fn rename(&mut self, old: u32, new: u32) {
        self.reserve_vertex(new);
        self.position[new as usize] = self.position[old as usize];
        let first = std::mem::replace(&mut self.outgoing[old as usize], Edge::NONE);
        self.outgoing[new as usize] = first;
        self.changed.clear();
        let mut e = first;
        loop {
            self.faces[e.face() as usize].vertex[e.corner()] = new;
            self.changed.push(FaceId(e.face()));
            e = self.turn(e);
            if e == first {
                break;
            }
        }
        self.list_changes_once();
    }

    /// Forgets every face; places of vertices stay.
    pub fn clear(&mut self) {
        self.faces.clear();
        self.free.clear();
        self.changed.clear();
        self.outgoing.fill(Edge::NONE);
        self.last = NONE;
    }

    /// Turns the edge of `h` within its quadrilateral.
    ///
    /// With h from u to v, w to its left and x to its right, the edge becomes x–w. Afterwards h is
    /// the side u → x of the face (u, x, w), and its former twin the side v → w of (v, w, x); the
    /// sides w → u and x → v keep their half-edges.
    pub fn flip(&mut self, h: Edge) {
        let t = self.twin(h);
        let (fa, fb) = (h.face(), t.face());
        let (mut a, mut b) = (*self.face(fa), *self.face(fb));
        let (hn, hp) = (next(h.corner()), previous(h.corner()));
        let (tn, tp) = (next(t.corner()), previous(t.corner()));
        let (u, v, w, x) = (b.vertex[tn], a.vertex[hn], a.vertex[hp], b.vertex[tp]);

        if !(a.frame.is_zero() && b.frame.is_zero()) {
            let shift = self.shift_across(h);
            let shift_x = b.frame.shift(tp).plus(shift);
            let [mut sa, mut sb] = [[Shift::ZERO; 3]; 2];
            (sa[h.corner()], sa[hn], sa[hp]) =
                (a.frame.shift(h.corner()), shift_x, a.frame.shift(hp));
            (sb[t.corner()], sb[tn], sb[tp]) = (a.frame.shift(hn), a.frame.shift(hp), shift_x);
            (a.frame, b.frame) = (Frame::new(sa), Frame::new(sb));
        }
        a.vertex[hn] = x;
        b.vertex[tn] = w;
        let (beyond_ux, beyond_vw) = (b.twin[tn], a.twin[hn]);
        a.twin[hn] = Edge::new(fb, tn);
        b.twin[tn] = Edge::new(fa, hn);
        self.faces[fa as usize] = a;
        self.faces[fb as usize] = b;
        if beyond_ux == Edge::new(fa, hn) {
            // The sides u → x and v → w were glued to each other.
            self.glue(h, t);
        } else {
            self.glue(h, beyond_ux);
            self.glue(t, beyond_vw);
        }
        self.outgoing[u as usize] = h;
        self.outgoing[v as usize] = t;
    }

    /// Whether the far corner of the face across `e` lies inside the circle of the face of `e`.
    pub fn is_illegal(&self, e: Edge) -> bool {
        let here = self.face(e.face());
        let far = previous(e.corner());
        let from = self.side(here, far, e.corner());
        let to = self.side(here, far, next(e.corner()));
        in_circle(to, from, from + self.to_apex(here.twin[e.corner()]))
    }

    /// The vector from the end of half-edge `t` to the third corner of its face.
    #[inline]
    pub fn to_apex(&self, t: Edge) -> DVec2 {
        self.side(self.face(t.face()), next(t.corner()), previous(t.corner()))
    }

    /// Flips edges, starting from those in `suspects`, until no edge is illegal.
    ///
    /// Ends because each flip lowers the surface that lifts the points to their (perturbed)
    /// squared norm, and correct because a locally Delaunay triangulation of a flat torus is
    /// globally so (Bobenko and Springborn 2007).
    pub fn restore_delaunay(&mut self) {
        while let Some(e) = self.suspects.pop() {
            if self.is_illegal(e) {
                let t = self.twin(e);
                self.flip(e);
                self.changed.extend([FaceId(e.face()), FaceId(t.face())]);
                self.suspects.extend([e, e.previous(), t, t.previous()]);
            }
        }
        self.list_changes_once();
    }

    fn list_changes_once(&mut self) {
        self.changed.sort_unstable();
        self.changed.dedup();
    }
}
