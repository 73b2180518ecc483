//! Moving points: their places change first, and edges flip where that made them illegal.

use bn_core::{DVec2, torus};

use super::Triangulation;
use super::build::build;
use super::face::{Edge, FaceId, Frame, NONE, Shift, next, previous};
use super::mesh::{Mesh, Scratch};
use super::polygon::StarPolygon;
use crate::predicates::{Angle, cross, in_circle_exactly, is_inside, snap};

impl Triangulation {
    /// Moves point `index` to `p`: the same as taking it out and adding it there, and much faster
    /// where the point stays among its neighbours.
    ///
    /// # Panics
    /// If there is no such point, or `p` is not in [0, 1)².
    pub fn relocate(&mut self, index: usize, p: DVec2) {
        assert!(torus::contains(p), "{p} is not in [0, 1)²");
        let vertex = self.vertex(index);
        let scratch = &mut self.scratch;
        let is_ready = scratch.star.center == vertex || {
            !self.coincidences.is_shared(vertex) && self.mesh.gather_star(vertex, &mut scratch.star)
        };
        scratch.star.center = NONE;
        if !(is_ready && self.mesh.shift_vertex(vertex, snap(p), scratch)) {
            self.relocate_far(index, p);
        }
    }

    /// Moves all points at once, each to `place(index, position)`: the same as building the
    /// triangulation of the new places, and much faster where neighbours stay neighbours. Points
    /// that share a place move together, as their representative says.
    ///
    /// # Panics
    /// If a place is not in [0, 1)².
    pub fn relocate_all(&mut self, mut place: impl FnMut(usize, DVec2) -> DVec2) {
        let scratch = &mut self.scratch;
        scratch.star.center = NONE;
        if !self.mesh.shift_all(&mut place, scratch) {
            self.rebuild();
        }
    }

    /// Builds everything anew from the places of the points.
    #[cold]
    fn rebuild(&mut self) {
        let (mut numbers, mut places) = (Vec::new(), Vec::new());
        for index in (0..self.index_bound()).filter(|&index| self.contains(index)) {
            numbers.push(index as u32);
            places.push(self.position(index));
        }
        let former_faces = self.mesh.faces.len() as u32;
        (self.mesh, self.coincidences) = build(&places, |i| numbers[i as usize]);
        self.hints.rebuild(&self.mesh);
        let faces = former_faces.max(self.mesh.faces.len() as u32);
        self.mesh.changed.extend((0..faces).map(FaceId));
    }

    /// Takes the point out and adds it again.
    #[cold]
    fn relocate_far(&mut self, index: usize, p: DVec2) {
        self.remove(index);
        let mut changed = std::mem::take(&mut self.mesh.changed);
        self.insert(index, p);
        changed.extend_from_slice(&self.mesh.changed);
        self.mesh.changed = changed;
        self.mesh.list_changes_once();
    }
}

impl Mesh {
    /// Moves `vertex`, whose star polygon is given, to `p`, if all of the polygon can be seen from
    /// there; else changes nothing and returns false.
    #[inline]
    fn shift_vertex(&mut self, vertex: u32, p: DVec2, scratch: &mut Scratch) -> bool {
        let Scratch { star, suspects, .. } = scratch;
        let home = self.position(vertex);
        let way = torus::delta(home, p);
        // Exact, and whole: by how much the copy in the frames of the faces is off.
        let shift = home + way - p;
        self.vertices[vertex as usize].position = p;
        if shift != DVec2::ZERO {
            self.shift_frames(vertex, shift, star);
        }
        for corner in &mut star.corners {
            corner.position -= way;
        }
        suspects.clear();
        if !self.list_illegal(star, suspects) {
            self.vertices[vertex as usize].position = home;
            if shift != DVec2::ZERO {
                self.shift_frames(vertex, -shift, star);
            }
            return false;
        }
        self.changed.clear();
        self.changed.extend(star.faces.iter().copied().map(FaceId));
        if !suspects.is_empty() {
            self.restore_delaunay(suspects);
        }
        true
    }

    /// Moves every vertex to `place(vertex, position)`; false if a face does not turn
    /// counter-clockwise any more, or if so much changes that building anew is as fast: then places
    /// are right but nothing else is.
    fn shift_all(
        &mut self,
        place: &mut impl FnMut(usize, DVec2) -> DVec2,
        scratch: &mut Scratch,
    ) -> bool {
        let Scratch { suspects, crossings, .. } = scratch;
        crossings.clear();
        for (number, vertex) in self.vertices.iter_mut().enumerate() {
            if !vertex.is_present() {
                continue;
            }
            let p = place(number, vertex.position);
            assert!(torus::contains(p), "{p} is not in [0, 1)²");
            let p = snap(p);
            let shift = vertex.position + torus::delta(vertex.position, p) - p;
            vertex.position = p;
            if shift != DVec2::ZERO {
                let (x, y) = (shift.x as i8, shift.y as i8);
                crossings.push((number as u32, Shift { x, y }));
            }
        }
        for &(vertex, shift) in crossings.iter() {
            self.cross_seam(vertex, shift);
        }
        suspects.clear();
        self.changed.clear();
        if !self.list_all_illegal(suspects) {
            return false;
        }
        self.restore_delaunay(suspects);
        true
    }

    /// The faces at `vertex` connect the copy of it that is farther by `shift` than before.
    fn cross_seam(&mut self, vertex: u32, shift: Shift) {
        let first = self.outgoing(vertex);
        let mut e = first;
        loop {
            let face = &mut self.faces[e.face() as usize];
            let mut shifts = [0, 1, 2].map(|corner| face.frame().shift(corner));
            // A face that touches the vertex with several corners is met as often.
            shifts[e.corner()] = shifts[e.corner()].plus(shift);
            face.set_frame(Frame::new(shifts));
            e = self.turn(e);
            if e == first {
                break;
            }
        }
    }

    /// Lists all edges that are not Delaunay, and all faces as changed; false if a face does not
    /// turn counter-clockwise, or if more than a quarter of the edges are listed.
    fn list_all_illegal(&mut self, suspects: &mut Vec<Edge>) -> bool {
        for id in 0..self.faces.len() as u32 {
            let face = &self.faces[id as usize];
            if !face.is_alive() {
                continue;
            }
            let [a, b, c] = self.corners(face);
            if cross(b - a, c - a) <= 0.0 {
                return false;
            }
            self.changed.push(FaceId(id));
        }
        for &FaceId(id) in &self.changed {
            for corner in 0..3 {
                let e = Edge::new(id, corner);
                if e.0 < self.twin(e).0 && self.is_illegal(e) {
                    suspects.push(e);
                }
            }
        }
        suspects.len() <= 3 * self.vertex_count() / 4
    }

    /// The faces around `vertex` connect the copy of it that is farther by `shift` than before.
    #[cold]
    fn shift_frames(&mut self, vertex: u32, shift: DVec2, star: &StarPolygon) {
        let shift = Shift { x: shift.x as i8, y: shift.y as i8 };
        for &id in &star.faces {
            let face = &mut self.faces[id as usize];
            let frame = face.frame();
            face.set_frame(Frame::new([0, 1, 2].map(|corner| {
                let moves = face.vertex(corner) == vertex;
                if moves { frame.shift(corner).plus(shift) } else { frame.shift(corner) }
            })));
        }
    }

    /// Lists the edges of the star, sides and spokes, that are not Delaunay; false if the centre
    /// does not see all sides from the left.
    #[inline]
    fn list_illegal(&self, star: &StarPolygon, suspects: &mut Vec<Edge>) -> bool {
        let corners = &star.corners;
        let degree = corners.len();
        let (mut before, mut here) = (corners[degree - 2].position, &corners[degree - 1]);
        // At the corner before, from the corner here to the centre.
        let mut back = Angle::between(here.position - before, -before);
        for corner in corners {
            let (at, to) = (here.position, corner.position);
            let apart = to - at;
            let at_center = Angle::between(at, to);
            if !at_center.is_left().or_else(|| cross(at, to) > 0.0) {
                return false;
            }
            let at_next = Angle::between(-to, -apart);
            if is_inside(back, at_next).or_else(|| in_circle_exactly(-to, before - to, at - to)) {
                suspects.push(self.twin(here.outer).previous());
            }
            let there = self.face(here.outer.face());
            let (n, p) = (next(here.outer.corner()), previous(here.outer.corner()));
            let apex = at + self.side(there, n, p);
            let at_apex = Angle::between(to - apex, at - apex);
            if is_inside(at_center, at_apex).or_else(|| in_circle_exactly(to, at, apex)) {
                suspects.push(here.outer);
            }
            back = Angle::between(apart, -at);
            (before, here) = (at, corner);
        }
        true
    }
}
