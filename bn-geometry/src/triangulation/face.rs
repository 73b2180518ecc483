//! The records that the mesh is made of: faces, half-edges and integer translations.

use bn_core::DVec2;

/// No vertex, no half-edge.
pub const NONE: u32 = u32::MAX;

/// Names a face of a [`Triangulation`](crate::Triangulation) until the next insertion or removal.
///
/// Ids are small: below twice the largest number of vertices that the triangulation ever had.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct FaceId(pub(crate) u32);

impl FaceId {
    pub(crate) fn new(index: usize) -> Self {
        Self(index as u32)
    }

    /// The id as an index into tables of one entry a face.
    #[inline]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// The corner that follows `corner` counter-clockwise: 0 → 1 → 2 → 0.
///
/// A table in a number: results below 4 need no check as indices of the arrays of [`Face`].
#[inline]
pub const fn next(corner: usize) -> usize {
    0b00_10_01 >> (2 * corner) & 3
}

/// The corner that precedes `corner`: 0 → 2 → 1 → 0.
#[inline]
pub const fn previous(corner: usize) -> usize {
    0b01_00_10 >> (2 * corner) & 3
}

/// A half-edge: side `corner` of a face, from that corner to the next, face to its left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edge(pub u32);

impl Edge {
    pub const NONE: Self = Self(NONE);

    #[inline]
    pub fn new(face: u32, corner: usize) -> Self {
        Self(face << 2 | corner as u32)
    }

    #[inline]
    pub fn face(self) -> u32 {
        self.0 >> 2
    }

    #[inline]
    pub fn corner(self) -> usize {
        (self.0 & 3) as usize
    }

    /// The half-edge of the same face that starts where this one ends.
    #[inline]
    pub fn next(self) -> Self {
        Self::new(self.face(), next(self.corner()))
    }

    /// The half-edge of the same face that ends where this one starts.
    #[inline]
    pub fn previous(self) -> Self {
        Self::new(self.face(), previous(self.corner()))
    }
}

/// A translation by whole numbers: which periodic copy is meant.
///
/// Edges of a periodic Delaunay triangulation are at most √2 long, so small integers suffice.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Shift {
    pub x: i8,
    pub y: i8,
}

impl Shift {
    pub const ZERO: Self = Self { x: 0, y: 0 };

    #[inline]
    pub fn plus(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y }
    }

    #[inline]
    pub fn minus(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y }
    }

    #[inline]
    pub fn vector(self) -> DVec2 {
        DVec2::new(f64::from(self.x), f64::from(self.y))
    }
}

/// Which copies of its vertices a face connects, in the frame where the first one is not shifted:
/// the shifts of the second and the third.
///
/// All zero for the faces that don't cross the seam of the unit square: nearly all of them, so
/// one comparison spares the arithmetic.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frame(u32);

impl Frame {
    pub const ZERO: Self = Self(0);

    /// The frame of three shifts that are relative to any one copy of the square.
    pub fn new(shifts: [Shift; 3]) -> Self {
        let (second, third) = (shifts[1].minus(shifts[0]), shifts[2].minus(shifts[0]));
        let bytes = [second.x, second.y, third.x, third.y].map(i8::cast_unsigned);
        Self(u32::from_le_bytes(bytes))
    }

    #[inline]
    pub fn is_zero(self) -> bool {
        self == Self::ZERO
    }

    pub fn shift(self, corner: usize) -> Shift {
        let [x1, y1, x2, y2] = self.0.to_le_bytes().map(u8::cast_signed);
        match corner {
            0 => Shift::ZERO,
            1 => Shift { x: x1, y: y1 },
            _ => Shift { x: x2, y: y2 },
        }
    }
}

/// A triangle: its vertices counter-clockwise, the half-edges on the other side of its sides, and
/// its place among the periodic copies. Half a cache line.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub struct Face {
    /// Three vertices and the frame. Arrays of four take a corner of two bits without a check.
    vertex: [u32; 4],
    /// Three half-edges, and the vertex for which an insertion in progress has claimed the face.
    twin: [Edge; 4],
}

impl Face {
    /// The record of a face that is no longer part of the mesh.
    pub const DEAD: Self = Self { vertex: [NONE; 4], twin: [Edge::NONE; 4] };

    #[inline]
    pub fn new(vertices: [u32; 3], twins: [Edge; 3], frame: Frame) -> Self {
        let [a, b, c] = vertices;
        let [p, q, r] = twins;
        Self { vertex: [a, b, c, frame.0], twin: [p, q, r, Edge::NONE] }
    }

    #[inline]
    pub fn is_alive(&self) -> bool {
        self.vertex[0] != NONE
    }

    #[inline]
    pub fn vertices(&self) -> [u32; 3] {
        let [a, b, c, _] = self.vertex;
        [a, b, c]
    }

    #[inline]
    pub fn vertex(&self, corner: usize) -> u32 {
        self.vertex[corner & 3]
    }

    #[inline]
    pub fn set_vertex(&mut self, corner: usize, vertex: u32) {
        self.vertex[corner & 3] = vertex;
    }

    #[inline]
    pub fn twin(&self, corner: usize) -> Edge {
        self.twin[corner & 3]
    }

    #[inline]
    pub fn set_twin(&mut self, corner: usize, twin: Edge) {
        self.twin[corner & 3] = twin;
    }

    #[inline]
    pub fn claimant(&self) -> u32 {
        self.twin[3].0
    }

    #[inline]
    pub fn claim(&mut self, vertex: u32) {
        self.twin[3].0 = vertex;
    }

    #[inline]
    pub fn frame(&self) -> Frame {
        Frame(self.vertex[3])
    }

    #[inline]
    pub fn set_frame(&mut self, frame: Frame) {
        self.vertex[3] = frame.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_face_is_half_a_cache_line() {
        assert_eq!(size_of::<Face>(), 32);
    }

    #[test]
    fn frames_are_relative_to_the_first_corner() {
        let at = |x, y| Shift { x, y };
        let frame = Frame::new([at(3, -1), at(3, -1), at(4, -1)]);
        assert_eq!([0, 1, 2].map(|c| frame.shift(c)), [at(0, 0), at(0, 0), at(1, 0)]);
        assert!(!frame.is_zero() && Frame::new([at(2, 2); 3]).is_zero());
    }

    #[test]
    fn half_edges_go_round_their_face() {
        let e = Edge::new(7, 1);
        assert_eq!((e.face(), e.corner(), e.next().corner(), e.previous().corner()), (7, 1, 2, 0));
        assert_eq!(e.next().next(), e.previous());
        assert_eq!(e.next().next().next(), e);
    }
}
