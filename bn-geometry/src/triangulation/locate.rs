//! Point location: a walk through the mesh, and a grid of places to start from.

use bn_core::{DVec2, torus};

use super::face::{Edge, NONE, Shift, next};
use super::mesh::Mesh;
use crate::predicates::cross;

/// What a point lies on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    Vertex(u32),
    Edge(Edge),
    Face(u32),
}

/// Where a point lies in the mesh.
#[derive(Clone, Copy, Debug)]
pub struct Located {
    pub place: Place,
    /// The copy of the point that lies in the face, in the face's frame.
    pub shift: Shift,
}

impl Mesh {
    /// Finds `p`, a point of the coordinate grid, in a mesh that is not empty.
    ///
    /// Crosses sides that separate the face from the point, starting at face `start`. That ends
    /// because the power of the point to the circles of the faces falls from face to face.
    pub fn walk(&self, start: u32, p: DVec2) -> Located {
        let mut id = start;
        let mut shift = self.nearest_shift(start, p);
        let mut entry = None;
        loop {
            let face = self.face(id);
            let corners = self.corners(face);
            let q = p + shift.vector();
            let mut on_side = [false; 3];
            let mut exit = None;
            for c in 0..3 {
                if entry == Some(c) {
                    continue;
                }
                let area = cross(corners[next(c)] - corners[c], q - corners[c]);
                if area < 0.0 {
                    exit = Some(c);
                    break;
                }
                on_side[c] = area == 0.0;
            }
            let Some(c) = exit else {
                return Located { place: self.place_in(id, on_side), shift };
            };
            let e = Edge::new(id, c);
            let t = face.twin(c);
            shift = shift.minus(self.shift_across(e));
            id = t.face();
            entry = Some(t.corner());
        }
    }

    /// The copy of `p` nearest to the first corner of `face`, which is not shifted.
    #[inline]
    pub(super) fn nearest_shift(&self, face: u32, p: DVec2) -> Shift {
        let d = self.position(self.face(face).vertex(0)) - p;
        if d.x.abs() <= 0.5 && d.y.abs() <= 0.5 {
            return Shift::ZERO;
        }
        let nearest = |d: f64| i8::from(d > 0.5) - i8::from(d < -0.5);
        Shift { x: nearest(d.x), y: nearest(d.y) }
    }

    fn place_in(&self, face: u32, on_side: [bool; 3]) -> Place {
        match on_side {
            [false, false, false] => Place::Face(face),
            [true, false, false] => Place::Edge(Edge::new(face, 0)),
            [false, true, false] => Place::Edge(Edge::new(face, 1)),
            [false, false, true] => Place::Edge(Edge::new(face, 2)),
            // Two sides meet in the corner where the second starts.
            [true, true, _] => Place::Vertex(self.face(face).vertex(1)),
            [_, true, true] => Place::Vertex(self.face(face).vertex(2)),
            [true, _, true] => Place::Vertex(self.face(face).vertex(0)),
        }
    }
}

/// A coarse grid over the square that remembers a face in or near each of its cells.
///
/// An entry may be out of date: it only says where to start walking.
#[derive(Clone, Debug)]
pub struct Hints {
    side: usize,
    face: Vec<u32>,
}

impl Default for Hints {
    fn default() -> Self {
        Self { side: 1, face: vec![NONE] }
    }
}

impl Hints {
    /// Vertices a cell: the walk from a cell's entry takes some two steps, and the table is small.
    const LOAD: usize = 2;

    /// Whether the mesh has outgrown the grid.
    pub fn is_too_coarse(&self, vertices: usize) -> bool {
        vertices > 4 * Self::LOAD * self.face.len()
    }

    /// Enters the mesh anew.
    pub fn rebuild(&mut self, mesh: &Mesh) {
        self.side = ((mesh.vertex_count() / Self::LOAD) as f64).sqrt().ceil().max(1.0) as usize;
        self.face.clear();
        self.face.resize(self.side * self.side, NONE);
        for vertex in mesh.vertices.iter().filter(|vertex| vertex.is_present()) {
            self.set(vertex.position, vertex.outgoing.face());
        }
        let mut near = mesh.last;
        for face in &mut self.face {
            if *face == NONE {
                *face = near;
            }
            near = *face;
        }
    }

    /// A living face to start from when looking for `p`, in a mesh that is not empty.
    ///
    /// Entries go out of date when their face moves away, with its number, to where a point was
    /// inserted; a neighbouring cell then has a better one.
    #[inline]
    pub fn get(&self, mesh: &Mesh, p: DVec2) -> u32 {
        let near = 2.0 / self.side as f64;
        let (x, y) = self.cell(p);
        let mut best = (f64::INFINITY, mesh.last);
        for (dx, dy) in [(0, 0), (1, 0), (self.side - 1, 0), (0, 1), (0, self.side - 1)] {
            let face = self.face[self.index((x + dx) % self.side, (y + dy) % self.side)];
            let record = mesh.faces.get(face as usize).filter(|face| face.is_alive());
            let distance = record.map_or(f64::INFINITY, |face| {
                let corner = mesh.position(face.vertex(0));
                torus::delta(corner, p).abs().max_element()
            });
            if distance <= near {
                return face;
            }
            if distance < best.0 {
                best = (distance, face);
            }
        }
        best.1
    }

    /// Remembers that `p` lies in or near `face`.
    #[inline]
    pub fn set(&mut self, p: DVec2, face: u32) {
        let (x, y) = self.cell(p);
        let index = self.index(x, y);
        self.face[index] = face;
    }

    #[inline]
    fn cell(&self, p: DVec2) -> (usize, usize) {
        debug_assert!(torus::contains(p), "{p} is not in [0, 1)²");
        let side = self.side as f64;
        // The largest coordinate below 1 may round up to `side`.
        let cell = |x: f64| ((x * side) as usize).min(self.side - 1);
        (cell(p.x), cell(p.y))
    }

    #[inline]
    fn index(&self, x: usize, y: usize) -> usize {
        y * self.side + x
    }
}
