//! Removal: triangulate the star polygon that a vertex leaves behind.

use bn_core::DVec2;

use super::face::{Edge, Face, FaceId, Frame, Shift, next, previous};
use super::mesh::Mesh;
use crate::predicates::{cross, in_circle};

/// The polygon around a removed vertex, and the room to triangulate it in.
#[derive(Clone, Debug, Default)]
pub struct StarPolygon {
    corners: Vec<StarCorner>,
    pending: Vec<Chain>,
}

/// A corner of the star polygon and the side that starts there, counter-clockwise.
#[derive(Clone, Copy, Debug)]
struct StarCorner {
    vertex: u32,
    /// From the removed vertex to this corner.
    position: DVec2,
    /// The copy of the corner's vertex, relative to that of the removed one.
    shift: Shift,
    /// The face of the star at this side; gives its record to a new face.
    face: u32,
    /// The half-edge on the outer side.
    outer: Edge,
    /// The half-edge of the new face at this side.
    inner: Edge,
}

/// The part of the polygon to the right of the diagonal from corner `first` to corner `last`:
/// the corners first ..= last, still to be triangulated.
#[derive(Clone, Copy, Debug)]
struct Chain {
    first: usize,
    last: usize,
    /// The half-edge first → last on the other side of the diagonal; none for the whole polygon.
    base: Edge,
}

impl Mesh {
    /// Takes out `vertex`, which the mesh has. O(d²) for a vertex of degree d; O(n) where the
    /// vertex is its own neighbour, which needs an empty circle of radius ½.
    pub fn remove(&mut self, vertex: u32) {
        let mut star = std::mem::take(&mut self.star);
        if self.gather_star(vertex, &mut star) {
            self.fill_star(&mut star);
            self.outgoing[vertex as usize] = Edge::NONE;
        } else {
            self.rebuild_without(vertex);
        }
        self.star = star;
    }

    /// Collects the polygon; false if the vertex is its own neighbour.
    fn gather_star(&self, vertex: u32, star: &mut StarPolygon) -> bool {
        star.corners.clear();
        let first = self.outgoing[vertex as usize];
        let mut e = first;
        loop {
            let face = self.face(e.face());
            let (c, n) = (e.corner(), next(e.corner()));
            if face.vertex[n] == vertex {
                return false;
            }
            star.corners.push(StarCorner {
                vertex: face.vertex[n],
                position: self.side(face, c, n),
                shift: face.frame.shift(n).minus(face.frame.shift(c)),
                face: e.face(),
                outer: face.twin[n],
                inner: Edge::NONE,
            });
            e = face.twin[previous(c)];
            if e == first {
                break;
            }
        }
        self.resolve_glued_sides(vertex, star);
        true
    }

    /// Where two sides of the polygon are glued to each other, `outer` becomes a reference to the
    /// other side: the pseudo half-edge (its index, 3).
    fn resolve_glued_sides(&self, vertex: u32, star: &mut StarPolygon) {
        for i in 0..star.corners.len() {
            let outer = star.corners[i].outer;
            if self.origin(outer.previous()) == vertex {
                let glued = |corner: &StarCorner| corner.face == outer.face();
                if let Some(other) = star.corners.iter().position(glued) {
                    star.corners[i].outer = Edge::new(other as u32, 3);
                }
            }
        }
    }

    /// Replaces the d faces of the star by d − 2 others.
    fn fill_star(&mut self, star: &mut StarPolygon) {
        self.changed.clear();
        self.changed.extend(star.corners.iter().map(|corner| FaceId(corner.face)));
        let degree = star.corners.len();
        let mut used = 0;
        star.pending.clear();
        star.pending.push(Chain { first: 0, last: degree - 1, base: Edge::NONE });
        while let Some(chain) = star.pending.pop() {
            let face = star.corners[used].face;
            used += 1;
            self.fill_chain(star, chain, face);
        }
        for i in 0..degree {
            let StarCorner { outer, inner, .. } = star.corners[i];
            let outer = match outer.corner() {
                3 => star.corners[outer.face() as usize].inner,
                _ => outer,
            };
            self.glue(inner, outer);
        }
        self.last = star.corners[0].face;
        for corner in &star.corners[used..] {
            self.free_face(corner.face);
        }
    }

    /// Makes the Delaunay face at the base of a chain, and leaves the chains on its other sides.
    fn fill_chain(&mut self, star: &mut StarPolygon, chain: Chain, face: u32) {
        let Chain { first, last, base } = chain;
        let apex = delaunay_apex(&star.corners, first, last);
        let corners = [first, apex, last].map(|i| star.corners[i]);
        let shifts = corners.map(|corner| corner.shift);
        self.faces[face as usize] = Face {
            vertex: corners.map(|corner| corner.vertex),
            twin: [Edge::NONE; 3],
            frame: Frame::new(shifts),
        };
        for (c, corner) in corners.iter().enumerate() {
            self.outgoing[corner.vertex as usize] = Edge::new(face, c);
        }
        if base == Edge::NONE {
            star.corners[last].inner = Edge::new(face, 2);
        } else {
            self.glue(Edge::new(face, 2), base);
        }
        for (c, from, to) in [(0, first, apex), (1, apex, last)] {
            let e = Edge::new(face, c);
            if to == from + 1 {
                star.corners[from].inner = e;
            } else {
                star.pending.push(Chain { first: from, last: to, base: e });
            }
        }
    }

    /// Builds the mesh of all other vertices from nothing.
    #[cold]
    fn rebuild_without(&mut self, vertex: u32) {
        let others: Vec<u32> = self.vertices().filter(|&v| v != vertex).collect();
        let former_faces = self.faces.len() as u32;
        self.clear();
        for v in others {
            let existing = self.insert(v, self.position[v as usize], self.last);
            debug_assert_eq!(existing, None, "vertices are distinct");
        }
        self.changed.clear();
        self.changed.extend((0..former_faces).map(FaceId));
    }
}

/// The corner strictly between `first` and `last` that forms a Delaunay face with them.
///
/// Among the corners to the left of last → first it is the one whose circle with these two holds
/// no other: the corners of the polygon suffice, because its sides stay Delaunay.
fn delaunay_apex(corners: &[StarCorner], first: usize, last: usize) -> usize {
    let mut best = first + 1;
    if last == first + 2 {
        return best;
    }
    let (a, b) = (corners[last].position, corners[first].position);
    let is_left = |i: usize| cross(b - a, corners[i].position - a) > 0.0;
    while !is_left(best) {
        best += 1;
    }
    for i in best + 1..last {
        let p = corners[i].position;
        if is_left(i) && in_circle(a - p, b - p, corners[best].position - p) {
            best = i;
        }
    }
    best
}
