//! Removal: triangulate the star polygon that a vertex leaves behind.

use bn_core::DVec2;

use super::build::build;
use super::face::{Edge, Face, FaceId, Frame};
use super::mesh::{Mesh, Scratch};
use super::polygon::{StarCorner, StarPolygon};
use crate::predicates::{Angle, cross, in_circle_exactly, is_inside};

/// The part of the polygon to the right of the diagonal from corner `first` to corner `last`:
/// the corners first ..= last, still to be triangulated.
#[derive(Clone, Copy, Debug)]
pub struct Chain {
    first: usize,
    last: usize,
    /// The half-edge first → last on the other side of the diagonal; none for the whole polygon.
    base: Edge,
}

impl Mesh {
    /// Takes out `vertex`, which the mesh has. O(d²) for a vertex of degree d; O(n log n) where the
    /// vertex is its own neighbour, which needs an empty circle of radius ½.
    pub fn remove(&mut self, vertex: u32, scratch: &mut Scratch) {
        self.changed.clear();
        if self.gather_star(vertex, &mut scratch.star) {
            self.resolve_glued_sides(vertex, &mut scratch.star);
            self.fill_star(vertex, &mut scratch.star, &mut scratch.chains);
            self.set_outgoing(vertex, Edge::NONE);
        } else {
            self.rebuild_without(vertex);
        }
    }

    /// Where two sides of the polygon are glued to each other, `outer` becomes a reference to the
    /// other side: the pseudo half-edge (its index, 3).
    fn resolve_glued_sides(&self, vertex: u32, star: &mut StarPolygon) {
        for i in 0..star.corners.len() {
            let outer = star.corners[i].outer;
            if self.origin(outer.previous()) == vertex
                && let Some(other) = star.faces.iter().position(|&face| face == outer.face())
            {
                star.corners[i].outer = Edge::new(other as u32, 3);
            }
        }
    }

    /// Replaces the d faces of the star by d − 2 others.
    fn fill_star(&mut self, center: u32, star: &mut StarPolygon, chains: &mut Vec<Chain>) {
        self.changed.extend(star.faces.iter().copied().map(FaceId));
        let degree = star.corners.len();
        let mut chain = Chain { first: 0, last: degree - 1, base: Edge::NONE };
        chains.clear();
        for i in 2..degree {
            let face = star.faces[i];
            self.fill_chain(center, star, chains, chain, face);
            chain = chains.pop().unwrap_or(chain);
        }
        for corner in &star.corners {
            let outer = match corner.outer.corner() {
                3 => star.corners[corner.outer.face() as usize].inner,
                _ => corner.outer,
            };
            self.glue(corner.inner, outer);
        }
        self.last = star.faces[2];
        self.free_face(star.faces[0]);
        self.free_face(star.faces[1]);
    }

    /// Makes the Delaunay face at the base of a chain, and leaves the chains on its other sides.
    #[inline]
    fn fill_chain(
        &mut self,
        center: u32,
        star: &mut StarPolygon,
        chains: &mut Vec<Chain>,
        chain: Chain,
        face: u32,
    ) {
        let Chain { first, last, base } = chain;
        let StarPolygon { corners, is_whole, .. } = star;
        let apex = delaunay_apex(corners, first, last);
        let [a, b, c] = [first, apex, last].map(|i| corners[i].vertex);
        let frame = if *is_whole {
            Frame::ZERO
        } else {
            self.triangle_frame(center, [first, apex, last].map(|i| &corners[i]))
        };
        let sides = [Edge::new(face, 0), Edge::new(face, 1), Edge::new(face, 2)];
        self.faces[face as usize] = Face::new([a, b, c], [Edge::NONE, Edge::NONE, base], frame);
        self.set_outgoing(a, sides[0]);
        self.set_outgoing(b, sides[1]);
        self.set_outgoing(c, sides[2]);
        if base == Edge::NONE {
            corners[last].inner = sides[2];
        } else {
            self.faces[base.face() as usize].set_twin(base.corner(), sides[2]);
        }
        if apex == first + 1 {
            corners[first].inner = sides[0];
        } else {
            chains.push(Chain { first, last: apex, base: sides[0] });
        }
        if last == apex + 1 {
            corners[apex].inner = sides[1];
        } else {
            chains.push(Chain { first: apex, last, base: sides[1] });
        }
    }

    /// The frame of a face of three corners of a polygon.
    #[cold]
    fn triangle_frame(&self, center: u32, corners: [&StarCorner; 3]) -> Frame {
        let p = self.position(center);
        Frame::new(corners.map(|corner| self.corner_shift(p, corner)))
    }

    /// Builds the mesh of all other vertices from nothing.
    #[cold]
    fn rebuild_without(&mut self, vertex: u32) {
        let others: Vec<u32> = self.vertex_numbers().filter(|&v| v != vertex).collect();
        let places: Vec<DVec2> = others.iter().map(|&v| self.position(v)).collect();
        let former_faces = self.faces.len() as u32;
        let (mesh, _) = build(&places, |i| others[i as usize]);
        *self = mesh;
        self.changed.extend((0..former_faces).map(FaceId));
    }
}

/// The corner strictly between `first` and `last` that forms a Delaunay face with them.
///
/// Among the corners to the left of last → first it is the one whose circle with these two holds
/// no other, that is, which sees them at the widest angle: the corners of the polygon suffice,
/// because its sides stay Delaunay.
#[inline]
pub fn delaunay_apex(corners: &[StarCorner], first: usize, last: usize) -> usize {
    if last == first + 2 {
        return first + 1;
    }
    let (a, b) = (corners[last].position, corners[first].position);
    // No branch depends on which corner wins, only on whether rounding might decide.
    let (mut best, mut widest) = (first, Angle::ZERO);
    for i in first + 1..last {
        let p = corners[i].position;
        let angle = Angle::between(a - p, b - p);
        let (left, wider) = (angle.is_left(), is_inside(widest, angle.reversed()));
        let mut wins = left.is_positive & wider.is_positive;
        if !(left.is_sure & wider.is_sure) {
            let q = corners[best].position;
            wins = cross(b - a, p - a) > 0.0
                && (best == first || in_circle_exactly(a - p, b - p, q - p));
        }
        best = if wins { i } else { best };
        widest = if wins { angle } else { widest };
    }
    best
}
