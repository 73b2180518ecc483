//! Insertion: split the face that holds the new vertex and flip what is no longer Delaunay.

use bn_core::DVec2;

use super::face::{Edge, Face, FaceId, Frame, Shift, next, previous};
use super::locate::Place;
use super::mesh::Mesh;
use crate::predicates::in_circle;

impl Mesh {
    /// Adds `vertex` at `p`, a point of the coordinate grid, seeking its place from face `start`.
    /// Returns the vertex that is there already, if one is; then nothing changes.
    ///
    /// The numbers below `vertex` are absent or present as before; `vertex` must be absent.
    pub fn insert(&mut self, vertex: u32, p: DVec2, start: u32) -> Option<u32> {
        debug_assert!(!self.has_vertex(vertex), "vertex {vertex} is there already");
        if self.face_count() == 0 {
            self.reserve_vertex(vertex);
            self.position[vertex as usize] = p;
            self.insert_first(vertex);
            return None;
        }
        let found = self.walk(start, p);
        let (face, side) = match found.place {
            Place::Vertex(at) => return Some(at),
            Place::Edge(e) => (e.face(), Some(e.corner())),
            Place::Face(face) => (face, None),
        };
        self.reserve_vertex(vertex);
        self.position[vertex as usize] = p;
        self.changed.clear();
        let link = self.split(face, vertex, found.shift);
        if let Some(side) = side {
            // The face on this side is flat: its two neighbours merge across it.
            self.flip(link[side]);
        }
        self.legalize_star(vertex, link[0]);
        self.last = self.outgoing[vertex as usize].face();
        None
    }

    /// The mesh of one vertex: the unit square, cut along its second diagonal.
    fn insert_first(&mut self, vertex: u32) {
        self.clear();
        let at = |x, y| Shift { x, y };
        let edge = Edge::new;
        self.faces.push(Face {
            vertex: [vertex; 3],
            twin: [edge(1, 1), edge(1, 2), edge(1, 0)],
            frame: Frame::new([at(0, 0), at(1, 0), at(0, 1)]),
        });
        self.faces.push(Face {
            vertex: [vertex; 3],
            twin: [edge(0, 2), edge(0, 0), edge(0, 1)],
            frame: Frame::new([at(1, 0), at(1, 1), at(0, 1)]),
        });
        self.outgoing[vertex as usize] = edge(0, 0);
        self.changed.extend([FaceId(0), FaceId(1)]);
        self.last = 0;
    }

    /// Connects `vertex`, the copy of it by `shift` in the frame of `face`, to the corners.
    /// Returns the sides of the former face; each has the vertex opposite.
    fn split(&mut self, face: u32, vertex: u32, shift: Shift) -> [Edge; 3] {
        let old = *self.face(face);
        let ids = [face, self.new_face(), self.new_face()];
        let whole = old.frame.is_zero() && shift == Shift::ZERO;
        for (c, &id) in ids.iter().enumerate() {
            let (n, p) = (next(c), previous(c));
            let shifts = [old.frame.shift(c), old.frame.shift(n), shift];
            self.faces[id as usize] = Face {
                vertex: [old.vertex[c], old.vertex[n], vertex],
                twin: [old.twin[c], Edge::new(ids[n], 2), Edge::new(ids[p], 1)],
                frame: if whole { Frame::ZERO } else { Frame::new(shifts) },
            };
        }
        for (c, &id) in ids.iter().enumerate() {
            let side = Edge::new(id, 0);
            self.glue(side, old.twin[c]);
            self.outgoing[old.vertex[c] as usize] = side;
        }
        self.outgoing[vertex as usize] = Edge::new(face, 2);
        ids.map(|id| Edge::new(id, 0))
    }

    /// Flips the sides opposite to a new vertex until its star is Delaunay; `first` is one of them.
    ///
    /// Goes once round the star, with displacements from the vertex, which know no frame.
    fn legalize_star(&mut self, vertex: u32, first: Edge) {
        let mut e = first;
        let face = self.face(e.face());
        let mut from = self.side(face, previous(e.corner()), e.corner());
        let mut to = self.side(face, previous(e.corner()), next(e.corner()));
        loop {
            let t = self.twin(e);
            if self.origin(t.previous()) == vertex {
                return self.legalize_touching_star(vertex);
            }
            let apex = from + self.to_apex(t);
            if in_circle(to, from, apex) {
                self.flip(e);
                to = apex;
                continue;
            }
            self.changed.push(FaceId(e.face()));
            e = self.twin(e.next()).next();
            if e == first {
                return;
            }
            from = to;
            to = from + self.side(self.face(e.face()), e.corner(), next(e.corner()));
        }
    }

    /// The general case: where the star of a vertex meets that of its own copy (few points, or
    /// wide holes), edges at the vertex may be illegal as well.
    #[cold]
    fn legalize_touching_star(&mut self, vertex: u32) {
        self.suspects.clear();
        let first = self.outgoing[vertex as usize];
        let mut e = first;
        loop {
            self.suspects.extend([e, e.next()]);
            self.changed.push(FaceId(e.face()));
            e = self.turn(e);
            if e == first {
                break;
            }
        }
        self.restore_delaunay();
    }
}
