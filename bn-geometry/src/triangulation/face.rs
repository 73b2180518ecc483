//! The records that the mesh is made of: faces, half-edges and integer translations.

use bn_core::DVec2;

/// No vertex, no half-edge.
pub const NONE: u32 = u32::MAX;

/// Names a face of a [`Triangulation`](crate::Triangulation) until the next insertion or removal.
///
/// Ids are small: below twice the largest number of vertices that the triangulation ever had.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
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

/// The corner that follows `corner` counter-clockwise.
#[inline]
pub const fn next(corner: usize) -> usize {
    if corner == 2 { 0 } else { corner + 1 }
}

/// The corner that precedes `corner`.
#[inline]
pub const fn previous(corner: usize) -> usize {
    if corner == 0 { 2 } else { corner - 1 }
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

/// Which copies of its vertices a face connects, in the frame where the first one is not shifted.
///
/// All zero for the faces that don't cross the seam of the unit square: nearly all of them, so
/// one comparison spares the arithmetic.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Frame([Shift; 3]);

impl Frame {
    pub const ZERO: Self = Self([Shift::ZERO; 3]);

    /// The frame of three shifts that are relative to any one copy of the square.
    #[inline]
    pub fn new(shifts: [Shift; 3]) -> Self {
        Self(shifts.map(|shift| shift.minus(shifts[0])))
    }

    #[inline]
    pub fn is_zero(self) -> bool {
        self == Self::ZERO
    }

    #[inline]
    pub fn shift(self, corner: usize) -> Shift {
        self.0[corner]
    }
}

/// A triangle: its vertices counter-clockwise, the half-edges on the other side of its sides, and
/// its place among the periodic copies. Half a cache line.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub struct Face {
    pub vertex: [u32; 3],
    pub twin: [Edge; 3],
    pub frame: Frame,
}

impl Face {
    /// The record of a face that is no longer part of the mesh.
    pub const DEAD: Self = Self { vertex: [NONE; 3], twin: [Edge::NONE; 3], frame: Frame::ZERO };

    #[inline]
    pub fn is_alive(&self) -> bool {
        self.vertex[0] != NONE
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
