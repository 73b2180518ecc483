//! The general case of insertion, by flips: where the surroundings of the new vertex meet those
//! of its own copies.

use super::face::{Edge, Face, FaceId, Frame, Shift, next, previous};
use super::locate::Place;
use super::mesh::Mesh;

impl Mesh {
    /// Adds `vertex`, whose place is known and free: connects it to the corners of the face that
    /// holds it and flips edges until none is illegal.
    #[cold]
    pub(super) fn insert_by_flips(&mut self, vertex: u32, suspects: &mut Vec<Edge>) {
        let found = self.walk(self.last, self.position(vertex));
        match found.place {
            Place::Vertex(at) => debug_assert!(false, "vertex {at} is in the place of {vertex}"),
            Place::Face(face) => {
                self.split(face, vertex, found.shift);
            }
            Place::Edge(e) => {
                // The part on this side is flat: its two neighbours merge across it.
                let sides = self.split(e.face(), vertex, found.shift);
                let flat = sides[e.corner()];
                self.changed.push(FaceId(self.twin(flat).face()));
                self.flip(flat);
            }
        }
        suspects.clear();
        let first = self.outgoing(vertex);
        let mut e = first;
        loop {
            suspects.extend([e, e.next()]);
            e = self.turn(e);
            if e == first {
                break;
            }
        }
        self.restore_delaunay(suspects);
    }

    /// Connects `vertex`, the copy of it by `shift` in the frame of `face`, to the corners.
    /// Returns the sides of the former face; each has the vertex opposite.
    fn split(&mut self, face: u32, vertex: u32, shift: Shift) -> [Edge; 3] {
        let old = *self.face(face);
        let ids = [face, self.new_face(), self.new_face()];
        let [a, b, c] = [0, 1, 2].map(|corner| (old.vertex(corner), old.frame().shift(corner)));
        for (k, [from, to]) in [[a, b], [b, c], [c, a]].into_iter().enumerate() {
            let (n, p) = (ids[next(k)], ids[previous(k)]);
            let twins = [old.twin(k), Edge::new(n, 2), Edge::new(p, 1)];
            let frame = Frame::new([from.1, to.1, shift]);
            self.faces[ids[k] as usize] = Face::new([from.0, to.0, vertex], twins, frame);
        }
        for (k, from) in [a, b, c].into_iter().enumerate() {
            let side = Edge::new(ids[k], 0);
            self.glue(side, old.twin(k));
            self.set_outgoing(from.0, side);
        }
        self.set_outgoing(vertex, Edge::new(face, 2));
        self.changed.extend(ids.map(FaceId));
        ids.map(|id| Edge::new(id, 0))
    }

    /// Flips edges, starting from those in `suspects`, until no edge is illegal.
    ///
    /// Ends because each flip lowers the surface that lifts the points to their (perturbed)
    /// squared norm, and correct because a locally Delaunay triangulation of a flat torus is
    /// globally so (Bobenko and Springborn 2007).
    pub(super) fn restore_delaunay(&mut self, suspects: &mut Vec<Edge>) {
        while let Some(e) = suspects.pop() {
            if self.is_illegal(e) {
                let t = self.twin(e);
                self.flip(e);
                self.changed.extend([FaceId(e.face()), FaceId(t.face())]);
                suspects.extend([e, e.previous(), t, t.previous()]);
            }
        }
        self.list_changes_once();
    }

    /// Turns the edge of `h` within its quadrilateral.
    ///
    /// With h from u to v, w to its left and x to its right, the edge becomes x–w. Afterwards h is
    /// the side u → x of the face (u, x, w), and its former twin the side v → w of (v, w, x); the
    /// sides w → u and x → v keep their half-edges.
    fn flip(&mut self, h: Edge) {
        let t = self.twin(h);
        let (fa, fb) = (h.face(), t.face());
        let (frame_a, frame_b) = self.flipped_frames(h);
        let (mut a, mut b) = (*self.face(fa), *self.face(fb));
        let (hn, hp) = (next(h.corner()), previous(h.corner()));
        let (tn, tp) = (next(t.corner()), previous(t.corner()));
        let (u, v, w, x) = (b.vertex(tn), a.vertex(hn), a.vertex(hp), b.vertex(tp));
        let (beyond_ux, beyond_vw) = (b.twin(tn), a.twin(hn));
        a.set_frame(frame_a);
        a.set_vertex(hn, x);
        a.set_twin(hn, Edge::new(fb, tn));
        b.set_frame(frame_b);
        b.set_vertex(tn, w);
        b.set_twin(tn, Edge::new(fa, hn));
        self.faces[fa as usize] = a;
        self.faces[fb as usize] = b;
        if beyond_ux == Edge::new(fa, hn) {
            // The sides u → x and v → w were glued to each other.
            self.glue(h, t);
        } else {
            self.glue(h, beyond_ux);
            self.glue(t, beyond_vw);
        }
        self.set_outgoing(u, h);
        self.set_outgoing(v, t);
    }

    /// The frames of the faces of `h` and its twin after the flip of `h`.
    fn flipped_frames(&self, h: Edge) -> (Frame, Frame) {
        let t = self.twin(h);
        let (a, b) = (self.face(h.face()).frame(), self.face(t.face()).frame());
        let (hc, hn, hp) = (h.corner(), next(h.corner()), previous(h.corner()));
        let (tc, tn, tp) = (t.corner(), next(t.corner()), previous(t.corner()));
        let shift_x = b.shift(tp).plus(self.shift_across(h));
        let [mut sa, mut sb] = [[Shift::ZERO; 3]; 2];
        (sa[hc], sa[hn], sa[hp]) = (a.shift(hc), shift_x, a.shift(hp));
        (sb[tc], sb[tn], sb[tp]) = (a.shift(hn), a.shift(hp), shift_x);
        (Frame::new(sa), Frame::new(sb))
    }
}
