//! A convex polygon that half-planes cut smaller.

use bn_core::{DVec2, DensityIntegrals, Moments};

use super::{PowerEdge, PowerNeighbor};
use crate::VoronoiCell;

/// Corners this close to a cutting line, relative to the polygon's size, lie on it: edges that are
/// shorter come from rounding.
const SLACK: f64 = 8.0 * f64::EPSILON;

/// Displacements below this are scaled up, so that products with them don't underflow.
const TINY: f64 = 1e-150;

/// The part of the plane that the half-planes so far have left of a cell, the site at the origin.
#[derive(Clone, Debug, Default)]
pub struct Polygon {
    corners: Vec<Corner>,
    /// For each corner how far it is beyond the cutting line; scratch memory of `cut`.
    beyond: Vec<f64>,
    /// The largest distance of a corner from the site.
    radius: f64,
}

/// A corner and the edge from there, counter-clockwise, to the next corner.
#[derive(Clone, Copy, Debug)]
pub struct Corner {
    pub at: DVec2,
    pub neighbor: PowerNeighbor,
}

impl Polygon {
    /// The square that the site's own copies to the left, right, above and below leave.
    pub fn reset(&mut self, site: u32) {
        let sides = [
            (DVec2::new(-0.5, -0.5), DVec2::NEG_Y),
            (DVec2::new(0.5, -0.5), DVec2::X),
            (DVec2::new(0.5, 0.5), DVec2::Y),
            (DVec2::new(-0.5, 0.5), DVec2::NEG_X),
        ];
        let corner = |(at, displacement)| Corner {
            at,
            neighbor: PowerNeighbor { index: site, displacement },
        };
        self.corners.clear();
        self.corners.extend(sides.map(corner));
        self.radius = std::f64::consts::FRAC_1_SQRT_2;
    }

    pub fn is_empty(&self) -> bool {
        self.corners.is_empty()
    }

    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Cuts off the places x that are nearer to `neighbor`, where `advantage` is the site's weight
    /// less the neighbour's: those with |x − d|² + advantage < |x|².
    #[inline]
    pub fn offer(&mut self, neighbor: PowerNeighbor, advantage: f64) {
        let d = neighbor.displacement;
        // Twice the offset of the line x·d = offset.
        let offset = d.length_squared() + advantage;
        let reach = 2.0 * self.radius;
        let misses = offset >= 0.0 && offset * offset >= d.length_squared() * (reach * reach);
        if misses && d.length_squared() > 0.0 {
            return;
        }
        self.offer_near(neighbor, 0.5 * offset);
    }

    fn offer_near(&mut self, neighbor: PowerNeighbor, offset: f64) {
        let d = neighbor.displacement;
        if self.corners.iter().any(|corner| corner.neighbor == neighbor) {
            return;
        }
        if d.abs().max_element() >= TINY {
            self.cut(neighbor, d, offset);
        } else {
            let scale = 1.0 / (TINY * TINY);
            self.cut(neighbor, d * scale, offset * scale);
        }
    }

    /// Removes all: the cell is hidden by a site at the same place.
    pub fn clear(&mut self) {
        self.corners.clear();
        self.radius = 0.0;
    }

    /// Keeps what is not beyond the line x·normal = offset.
    fn cut(&mut self, neighbor: PowerNeighbor, normal: DVec2, offset: f64) {
        let slack = SLACK * (normal.x.abs() + normal.y.abs()) * self.radius;
        self.beyond.clear();
        self.beyond.extend(self.corners.iter().map(|corner| corner.at.dot(normal) - offset));
        let mut farthest = 0;
        for (i, &beyond) in self.beyond.iter().enumerate() {
            if beyond > self.beyond[farthest] {
                farthest = i;
            }
        }
        let is_out = |i: usize| self.beyond[i] > slack;
        if self.corners.is_empty() || !is_out(farthest) {
            return;
        }
        // The corners beyond the line are consecutive: from `first` up to, without, `last`.
        let n = self.corners.len();
        let (mut first, mut last) = (farthest, (farthest + 1) % n);
        while is_out(last) {
            last = (last + 1) % n;
            if last == farthest {
                return self.clear();
            }
        }
        while is_out((first + n - 1) % n) {
            first = (first + n - 1) % n;
        }
        let before = (first + n - 1) % n;
        let entry = self.crossing(before, first, slack).map(|at| Corner { at, neighbor });
        let exit = self.crossing(last, (last + n - 1) % n, slack);
        let exit =
            exit.map(|at| Corner { at, neighbor: self.corners[(last + n - 1) % n].neighbor });
        self.replace(first, last, entry, exit, neighbor);
        let square = self.corners.iter().map(|corner| corner.at.length_squared());
        self.radius = square.fold(0.0, f64::max).sqrt();
    }

    /// Where the line crosses the edge from corner `inside` to corner `outside`; none if the corner
    /// inside is on the line.
    fn crossing(&self, inside: usize, outside: usize, slack: f64) -> Option<DVec2> {
        let (s, t) = (self.beyond[inside], self.beyond[outside]);
        if s >= -slack {
            return None;
        }
        let (a, b) = (self.corners[inside].at, self.corners[outside].at);
        Some(a + (b - a) * (s / (s - t)))
    }

    /// Puts a new edge in the place of the corners `first` .. `last` (cyclically): from `entry`, or
    /// the corner before, to `exit`, or the corner after.
    fn replace(
        &mut self,
        first: usize,
        last: usize,
        entry: Option<Corner>,
        exit: Option<Corner>,
        neighbor: PowerNeighbor,
    ) {
        let n = self.corners.len();
        if entry.is_none() {
            self.corners[(first + n - 1) % n].neighbor = neighbor;
        }
        let new = entry.into_iter().chain(exit);
        if first < last {
            self.corners.splice(first..last, new);
        } else {
            // Around the end of the list.
            self.corners.truncate(first);
            self.corners.drain(..last);
            self.corners.extend(new);
        }
    }

    /// The edges: corner, neighbour, next corner.
    fn edges(&self) -> impl Iterator<Item = (Corner, DVec2)> {
        let next = self.corners.iter().cycle().skip(1);
        self.corners.iter().zip(next).map(|(&corner, next)| (corner, next.at))
    }

    /// Area, centroid and second moment about the site; adds the edges to the list.
    pub fn measure(&self, edges: &mut Vec<PowerEdge>) -> VoronoiCell {
        let mut cell = VoronoiCell::EMPTY;
        for (corner, next) in self.edges() {
            cell.add_triangle(0.5 * corner.at.perp_dot(next), corner.at, next);
            let length = (next - corner.at).length();
            let Corner { at, neighbor } = corner;
            edges.push(PowerEdge { neighbor, corner: at, length, mass: length });
        }
        if cell.area > 0.0 {
            cell.to_centroid /= cell.area;
            cell
        } else {
            VoronoiCell::EMPTY
        }
    }

    /// The same by a density around the site's place.
    pub fn measure_mass(
        &self,
        density: &DensityIntegrals,
        place: DVec2,
        edges: &mut Vec<PowerEdge>,
    ) -> VoronoiCell {
        let mut moments = Moments::default();
        for (corner, next) in self.edges() {
            let (part, mass) = density.along(place, corner.at, next);
            moments += part;
            let length = (next - corner.at).length();
            let Corner { at, neighbor } = corner;
            edges.push(PowerEdge { neighbor, corner: at, length, mass });
        }
        VoronoiCell::of_moments(&moments)
    }
}
