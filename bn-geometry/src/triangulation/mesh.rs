//! The mesh of distinct vertices: storage, navigation and the edge flip.

use bn_core::DVec2;

use super::face::{Edge, Face, FaceId, Frame, NONE, Shift, next, previous};
use super::insert::Border;
use super::polygon::StarPolygon;
use super::remove::Chain;
use crate::predicates::in_circle;

/// Memory that insertions and removals use again.
#[derive(Clone, Debug, Default)]
pub struct Scratch {
    pub(super) star: StarPolygon,
    pub(super) borders: Vec<Border>,
    pub(super) chains: Vec<Chain>,
    /// Parts of a polygon by their first and last corners.
    pub(super) spans: Vec<(usize, usize)>,
    pub(super) suspects: Vec<Edge>,
    /// Vertices that cross the seam, and which way.
    pub(super) crossings: Vec<(u32, Shift)>,
}

/// A vertex, or room for one. Half a cache line.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub struct Vertex {
    /// Its place on the coordinate grid in [0, 1)².
    pub position: DVec2,
    /// A half-edge that starts there; none if there is no such vertex.
    pub outgoing: Edge,
}

impl Vertex {
    pub const ABSENT: Self = Self { position: DVec2::ZERO, outgoing: Edge::NONE };

    #[inline]
    pub fn is_present(&self) -> bool {
        self.outgoing != Edge::NONE
    }
}

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
    pub vertices: Vec<Vertex>,
    /// Faces made, altered or freed by the last insertion or removal.
    pub changed: Vec<FaceId>,
    /// Where a search starts that has no better place: a living face, unless there is none.
    pub last: u32,
}

impl Mesh {
    pub fn face_count(&self) -> usize {
        self.faces.len() - self.free.len()
    }

    pub fn vertex_count(&self) -> usize {
        self.face_count() / 2
    }

    pub fn has_vertex(&self, vertex: u32) -> bool {
        self.vertices.get(vertex as usize).is_some_and(Vertex::is_present)
    }

    /// The vertices that the mesh has, in order.
    pub fn vertex_numbers(&self) -> impl Iterator<Item = u32> {
        (0..).zip(&self.vertices).filter(|(_, vertex)| vertex.is_present()).map(|(v, _)| v)
    }

    /// Where a vertex is, in [0, 1)².
    #[inline]
    pub fn position(&self, vertex: u32) -> DVec2 {
        self.vertices[vertex as usize].position
    }

    /// A half-edge that starts at a vertex.
    #[inline]
    pub fn outgoing(&self, vertex: u32) -> Edge {
        self.vertices[vertex as usize].outgoing
    }

    #[inline]
    pub fn set_outgoing(&mut self, vertex: u32, e: Edge) {
        self.vertices[vertex as usize].outgoing = e;
    }

    #[inline]
    pub fn face(&self, face: u32) -> &Face {
        &self.faces[face as usize]
    }

    #[inline]
    pub fn twin(&self, e: Edge) -> Edge {
        self.face(e.face()).twin(e.corner())
    }

    /// Where the half-edge starts.
    #[inline]
    pub fn origin(&self, e: Edge) -> u32 {
        self.face(e.face()).vertex(e.corner())
    }

    /// The half-edge that follows counter-clockwise around the same origin.
    #[inline]
    pub fn turn(&self, e: Edge) -> Edge {
        self.twin(e.previous())
    }

    /// The places of a face's corners in its own frame.
    #[inline]
    pub fn corners(&self, face: &Face) -> [DVec2; 3] {
        let [a, b, c] = face.vertices().map(|v| self.position(v));
        if face.frame().is_zero() {
            [a, b, c]
        } else {
            [a, shifted(b, face.frame(), 1), shifted(c, face.frame(), 2)]
        }
    }

    /// The vector from a face's corner `from` to its corner `to`.
    #[inline]
    pub fn side(&self, face: &Face, from: usize, to: usize) -> DVec2 {
        let p = self.position(face.vertex(from));
        let q = self.position(face.vertex(to));
        if face.frame().is_zero() {
            q - p
        } else {
            shifted(q, face.frame(), to) - shifted(p, face.frame(), from)
        }
    }

    /// The translation from the frame of the face across `e` into that of the face of `e`.
    #[inline]
    pub fn shift_across(&self, e: Edge) -> Shift {
        let here = self.face(e.face());
        let t = here.twin(e.corner());
        let there = self.face(t.face());
        if here.frame().is_zero() && there.frame().is_zero() {
            return Shift::ZERO;
        }
        // The start of e is the end of its twin.
        here.frame().shift(e.corner()).minus(there.frame().shift(next(t.corner())))
    }

    /// Makes room for a vertex of this number.
    pub fn reserve_vertex(&mut self, vertex: u32) {
        let len = vertex as usize + 1;
        if self.vertices.len() < len {
            self.vertices.resize(len, Vertex::ABSENT);
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
        self.faces[e.face() as usize].set_twin(e.corner(), t);
        self.faces[t.face() as usize].set_twin(t.corner(), e);
    }

    /// Calls the vertex `old` by the number `new`.
    pub fn rename(&mut self, old: u32, new: u32) {
        self.reserve_vertex(new);
        self.vertices[new as usize] = self.vertices[old as usize];
        self.vertices[old as usize] = Vertex::ABSENT;
        let first = self.outgoing(new);
        self.changed.clear();
        let mut e = first;
        loop {
            self.faces[e.face() as usize].set_vertex(e.corner(), new);
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
        for vertex in &mut self.vertices {
            vertex.outgoing = Edge::NONE;
        }
        self.last = NONE;
    }

    /// Whether the far corner of the face across `e` lies inside the circle of the face of `e`.
    pub fn is_illegal(&self, e: Edge) -> bool {
        let here = self.face(e.face());
        let far = previous(e.corner());
        let from = self.side(here, far, e.corner());
        let to = self.side(here, far, next(e.corner()));
        let t = here.twin(e.corner());
        let across = self.side(self.face(t.face()), next(t.corner()), previous(t.corner()));
        in_circle(to, from, from + across)
    }

    /// Puts the list of changed faces in order.
    pub(super) fn list_changes_once(&mut self) {
        self.changed.sort_unstable();
        self.changed.dedup();
    }
}

#[cold]
fn shifted(p: DVec2, frame: Frame, corner: usize) -> DVec2 {
    p + frame.shift(corner).vector()
}
