//! Delaunay triangulation on the torus that points can join and leave.

mod build;
mod check;
mod coincident;
mod face;
mod insert;
mod iter;
mod locate;
mod mesh;
mod polygon;
mod relocate;
mod remove;
mod touching;
mod vacancy;

use bn_core::{DVec2, PointSet, torus};

use self::coincident::{Coincidences, Departure};
use self::face::{Face as FaceRecord, NONE};
use self::locate::{Hints, Place};
use self::mesh::{Mesh, Scratch};
use crate::circle::{Circle, circumcircle};
use crate::predicates::snap;

pub use self::face::FaceId;
pub use self::iter::{Face, Faces, Neighbors, Star};
pub use self::vacancy::Vacancy;

/// The Delaunay triangulation of points on the unit torus.
///
/// It is the quotient of the periodic Delaunay triangulation of the plane by integer translations:
/// n distinct points have exactly 2n faces and 3n edges, for every n ≥ 1. With few points an edge
/// may join a point to its own copy, and two points may be joined by several edges; no periodic
/// copies are stored.
///
/// *Points* are known by the caller's indices. *Exactness*: coordinates are rounded to multiples
/// of 2⁻⁵⁰, which moves a point by at most 2⁻⁵¹ in each coordinate; from there on every decision is
/// exact. Points that coincide after rounding share a vertex; one of them, the *representative*,
/// stands for all. *Uniqueness*: more than three points on an empty circle are connected by a rule
/// that depends on their relative places alone (the Delaunay triangulation in the metric
/// x² + y² + ε·xy with infinitesimal ε > 0), so the triangulation is a function of the set of
/// points: a square lattice has all its cells cut along the second diagonal, and the order of
/// insertions and removals leaves no trace.
///
/// *Cost*: some 100 bytes a point; insertion near a known face and removal take O(1)
/// expected time and no allocation.
#[derive(Clone, Debug, Default)]
pub struct Triangulation {
    mesh: Mesh,
    coincidences: Coincidences,
    hints: Hints,
    scratch: Scratch,
}

/// Where a point lies in a triangulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Location {
    /// At the place of this point, the representative of those there.
    Point(usize),
    /// On the edge between this face and another.
    Edge(FaceId),
    /// Inside this face.
    Face(FaceId),
}

impl Triangulation {
    /// The triangulation of all points of a set, indexed as there. O(n log n).
    pub fn new(set: &PointSet) -> Self {
        let (mesh, coincidences) = build::build(set.points(), |i| i);
        let mut hints = Hints::default();
        hints.rebuild(&mesh);
        Self { mesh, coincidences, hints, scratch: Scratch::default() }
    }

    /// The triangulation of no point, to be filled by [`Triangulation::insert`].
    pub fn empty() -> Self {
        Self::default()
    }

    /// Number of distinct places of points.
    pub fn vertex_count(&self) -> usize {
        self.mesh.vertex_count()
    }

    /// Number of points, those that coincide counted severally.
    pub fn point_count(&self) -> usize {
        self.vertex_count() + self.coincidences.duplicate_count()
    }

    /// Number of faces: twice the number of vertices.
    pub fn face_count(&self) -> usize {
        self.mesh.face_count()
    }

    /// Whether point `index` is part of the triangulation.
    pub fn contains(&self, index: usize) -> bool {
        u32::try_from(index).is_ok_and(|i| self.mesh.has_vertex(self.coincidences.vertex(i)))
    }

    /// The representative of the points at the place of point `index`: itself, unless several
    /// points coincide there.
    ///
    /// # Panics
    /// If there is no such point.
    pub fn representative(&self, index: usize) -> usize {
        self.vertex(index) as usize
    }

    /// Whether other points lie at the place of point `index`.
    ///
    /// # Panics
    /// If there is no such point.
    pub fn shares_place(&self, index: usize) -> bool {
        self.coincidences.is_shared(self.vertex(index))
    }

    /// The points whose place is that of other points as well, in no particular order.
    pub fn shared_places(&self) -> impl Iterator<Item = usize> {
        self.coincidences.shared().map(|index| index as usize)
    }

    /// The place of point `index`, on the coordinate grid.
    ///
    /// # Panics
    /// If there is no such point.
    #[inline]
    pub fn position(&self, index: usize) -> DVec2 {
        self.mesh.position(self.vertex(index))
    }

    /// Adds point `index` at `p`. Amortised O(1) expected for points spread about evenly; memory
    /// grows with the largest index ever used.
    ///
    /// # Panics
    /// If there is such a point already, if `p` is not in [0, 1)², or if the index is not below
    /// [`PointSet::MAX_POINTS`].
    pub fn insert(&mut self, index: usize, p: DVec2) {
        assert!(torus::contains(p), "{p} is not in [0, 1)²");
        self.insert_from(index, p, self.hints.get(&self.mesh, p));
    }

    /// Adds point `index` at `p`, which lies in or near `face`; saves the search for the place.
    ///
    /// # Panics
    /// As [`Triangulation::insert`], and if there is no such face.
    pub fn insert_near(&mut self, index: usize, p: DVec2, face: FaceId) {
        assert!(torus::contains(p), "{p} is not in [0, 1)²");
        assert!(self.has_face(face), "{face:?} is not part of the triangulation");
        self.insert_from(index, p, face.0);
    }

    fn insert_from(&mut self, index: usize, p: DVec2, start: u32) {
        assert!(index < PointSet::MAX_POINTS, "index {index} is not below 2²⁹");
        assert!(!self.contains(index), "point {index} is in the triangulation already");
        let (point, p) = (index as u32, snap(p));
        self.scratch.star.center = NONE;
        if let Some(vertex) = self.mesh.insert(point, p, start, &mut self.scratch) {
            self.mesh.changed.clear();
            self.coincidences.join(point, vertex);
        } else if self.hints.is_too_coarse(self.mesh.vertex_count()) {
            self.hints.rebuild(&self.mesh);
        } else {
            self.hints.set(p, self.mesh.last);
        }
    }

    /// Takes out point `index`. O(d²) for a point with d neighbours, d being 6 in the mean. Where a
    /// point is its own neighbour, which takes an empty circle of radius ½ or more, everything is
    /// built anew, in O(n log n). At worst, at the hub of a wheel, d is of the order of n.
    ///
    /// # Panics
    /// If there is no such point.
    pub fn remove(&mut self, index: usize) {
        let vertex = self.vertex(index);
        self.scratch.star.center = NONE;
        match self.coincidences.leave(index as u32) {
            Departure::Vertex => self.mesh.remove(vertex, &mut self.scratch),
            Departure::Duplicate => self.mesh.changed.clear(),
            Departure::Heir(heir) => self.mesh.rename(vertex, heir),
        }
    }

    /// The faces that the last insertion or removal made, altered or took away, each once.
    ///
    /// All that depends on faces (circles, an order among them) is up to date if it is renewed for
    /// these; [`Triangulation::has_face`] tells which are gone.
    #[inline]
    pub fn changed_faces(&self) -> &[FaceId] {
        &self.mesh.changed
    }

    /// Whether the face is part of the triangulation.
    #[inline]
    pub fn has_face(&self, face: FaceId) -> bool {
        self.mesh.faces.get(face.index()).is_some_and(FaceRecord::is_alive)
    }

    /// More than the index of any point: the length of a table of points.
    pub fn index_bound(&self) -> usize {
        self.mesh.vertices.len().max(self.coincidences.index_bound())
    }

    /// More than the index of any face: the length of a table of faces.
    pub fn face_bound(&self) -> usize {
        self.mesh.faces.len()
    }

    /// Where `p` lies; none if there are no points. O(1) expected for points spread about evenly.
    ///
    /// # Panics
    /// If `p` is not in [0, 1)².
    pub fn locate(&self, p: DVec2) -> Option<Location> {
        assert!(torus::contains(p), "{p} is not in [0, 1)²");
        if self.face_count() == 0 {
            return None;
        }
        let p = snap(p);
        Some(match self.mesh.walk(self.hints.get(&self.mesh, p), p).place {
            Place::Vertex(v) => Location::Point(v as usize),
            Place::Edge(e) => Location::Edge(FaceId(e.face())),
            Place::Face(face) => Location::Face(FaceId(face)),
        })
    }

    /// The circle through the corners of a face, which holds no point: its centre in the frame of
    /// [`Face::corners`], so perhaps outside the unit square.
    ///
    /// # Panics
    /// If there is no such face.
    #[inline]
    pub fn circumcircle(&self, face: FaceId) -> Circle {
        let record = self.mesh.face(face.0);
        assert!(record.is_alive(), "{face:?} is not part of the triangulation");
        circumcircle(self.mesh.corners(record))
    }

    /// The places of a face's corners, as [`Face::corners`] has them; none if there is no such face.
    #[inline]
    pub fn corners(&self, face: FaceId) -> Option<[DVec2; 3]> {
        let record = self.mesh.faces.get(face.index()).filter(|record| record.is_alive())?;
        Some(self.mesh.corners(record))
    }

    #[inline]
    fn vertex(&self, index: usize) -> u32 {
        assert!(self.contains(index), "there is no point {index}");
        self.coincidences.vertex(index as u32)
    }
}
