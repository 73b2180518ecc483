//! Going through faces, and around points.

use bn_core::DVec2;

use super::Triangulation;
use super::face::{Edge, FaceId, next};
use super::mesh::Mesh;
use crate::circle::{Circle, circumcircle};

/// A face: three points, counter-clockwise, and their places.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Face {
    /// Names the face.
    pub id: FaceId,
    /// The points at its corners, representatives where several coincide.
    pub vertices: [usize; 3],
    /// The copies of these points that the face connects: the first in [0, 1)², the others
    /// wherever they lie next to it.
    pub corners: [DVec2; 3],
}

impl Triangulation {
    /// All faces, in the order of their ids.
    pub fn faces(&self) -> Faces<'_> {
        Faces { mesh: &self.mesh, id: 0 }
    }

    /// All faces with their circles, in the order of their ids; a circle's centre lies in the frame
    /// of [`Face::corners`].
    pub fn circumcircles(&self) -> impl Iterator<Item = (Face, Circle)> {
        self.faces().map(|face| (face, circumcircle(face.corners)))
    }

    /// The face of this id.
    ///
    /// # Panics
    /// If there is no such face.
    pub fn face(&self, id: FaceId) -> Face {
        assert!(self.has_face(id), "{id:?} is not part of the triangulation");
        self.mesh.view(id)
    }

    /// The points that share an edge with point `index`, counter-clockwise, each with its
    /// displacement from there; representatives where several points coincide.
    ///
    /// Where several edges lead to a point, or one to a copy of `index` itself, each end of an
    /// edge counts. No allocation.
    ///
    /// # Panics
    /// If there is no such point.
    pub fn neighbors(&self, index: usize) -> Neighbors<'_> {
        Neighbors { around: self.around(index) }
    }

    /// The faces around point `index`, counter-clockwise, as many as it has neighbours. A face
    /// that touches the point with two corners comes twice.
    ///
    /// # Panics
    /// If there is no such point.
    pub fn star(&self, index: usize) -> Star<'_> {
        Star { around: self.around(index) }
    }

    /// For each face around point `index`, counter-clockwise, the place of the corner where the
    /// point is and the circle of the face, both in the face's frame.
    pub(crate) fn corners_around(&self, index: usize) -> impl Iterator<Item = (DVec2, Circle)> {
        self.around(index).map(|e| {
            let corners = self.mesh.corners(self.mesh.face(e.face()));
            (corners[e.corner()], circumcircle(corners))
        })
    }

    fn around(&self, index: usize) -> Around<'_> {
        let first = self.mesh.outgoing(self.vertex(index));
        Around { mesh: &self.mesh, first, next: Some(first) }
    }
}

impl Mesh {
    fn view(&self, id: FaceId) -> Face {
        let face = self.face(id.0);
        let vertices = face.vertices().map(|v| v as usize);
        Face { id, vertices, corners: self.corners(face) }
    }
}

/// The half-edges that start at a vertex, counter-clockwise.
#[derive(Clone, Debug)]
struct Around<'a> {
    mesh: &'a Mesh,
    first: Edge,
    next: Option<Edge>,
}

impl Iterator for Around<'_> {
    type Item = Edge;

    #[inline]
    fn next(&mut self) -> Option<Edge> {
        let e = self.next?;
        self.next = Some(self.mesh.turn(e)).filter(|&e| e != self.first);
        Some(e)
    }
}

/// Iterator over the neighbours of a point; see [`Triangulation::neighbors`].
#[derive(Clone, Debug)]
pub struct Neighbors<'a> {
    around: Around<'a>,
}

impl Iterator for Neighbors<'_> {
    type Item = (usize, DVec2);

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        let e = self.around.next()?;
        let face = self.around.mesh.face(e.face());
        let (c, n) = (e.corner(), next(e.corner()));
        Some((face.vertex(n) as usize, self.around.mesh.side(face, c, n)))
    }
}

/// Iterator over the faces around a point; see [`Triangulation::star`].
#[derive(Clone, Debug)]
pub struct Star<'a> {
    around: Around<'a>,
}

impl Iterator for Star<'_> {
    type Item = FaceId;

    #[inline]
    fn next(&mut self) -> Option<FaceId> {
        self.around.next().map(|e| FaceId(e.face()))
    }
}

/// Iterator over all faces; see [`Triangulation::faces`].
#[derive(Clone, Debug)]
pub struct Faces<'a> {
    mesh: &'a Mesh,
    id: u32,
}

impl Iterator for Faces<'_> {
    type Item = Face;

    fn next(&mut self) -> Option<Face> {
        loop {
            let id = FaceId(self.id);
            let face = self.mesh.faces.get(id.index())?;
            self.id += 1;
            if face.is_alive() {
                return Some(self.mesh.view(id));
            }
        }
    }
}
