//! The points while they move, their triangulation and what is known of its holes.

use bn_core::{DVec2, PointSet, Seed, torus};
use bn_geometry::{EmptyCircles, FaceId, Spacing, Triangulation, hilbert_order};
use rand::seq::SliceRandom;

use super::arrangement::{Arrangement, Moves, Search, Spread};
use super::field::Field;

/// A hole must exceed a point's clearance by this factor, in squares, to attract it: more than
/// rounding can feign, so that lattices stay put and no distance ever falls.
const GAIN: f64 = 1.0 + 1e-12;

/// Points of a local sweep whose rounds are done before the next ones': their triangulation fits a
/// core's own cache. Global sweeps go round by round over all points, who compete for the same holes.
const STRETCH: usize = 8192;

/// Rounds of visits in a sweep; each visits every 16th point along the Hilbert curve.
///
/// A cell of 4 × 4 points or so, of which each round takes one: points that are visited one after
/// the other are near enough to share the cache, and far enough apart not to push each other along.
/// Measured at n = 4096 to `d_min` 0.9251, means of 6 seeds: 84 sweeps with 16 rounds, about 120
/// with 8, 32 or 64 rounds, 115 in random order, more than 250 in random order within stretches of
/// 512 points. Redrawing the order for each sweep also takes more.
const ROUNDS: usize = 16;

/// The random stream of the order of visits: above all that the initial points draw from.
const ORDER_STREAM: u32 = 1 << 31;

/// The order of visits: the first points of the rounds, in the order of rounds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Order([usize; ROUNDS]);

impl Order {
    pub(super) fn new(seed: Seed) -> Self {
        let mut rounds = std::array::from_fn(|round| round);
        rounds.shuffle(&mut seed.stream(ORDER_STREAM));
        Self(rounds)
    }

    /// The numbers below n, stretch by stretch, round by round.
    fn visits(&self, n: usize, stretch: usize) -> impl Iterator<Item = usize> {
        let stretches = (0..n).step_by(stretch).map(move |first| (first, n.min(first + stretch)));
        stretches.flat_map(|(first, end)| {
            self.0.iter().flat_map(move |&round| (first + round..end).step_by(ROUNDS))
        })
    }
}

/// The points, and what is known of the holes among them.
#[derive(Debug)]
pub(super) struct Swarm<F> {
    field: F,
    triangulation: Triangulation,
    /// The caller's index of each point here: here they are numbered along a Hilbert curve, so that
    /// neighbours on the torus are neighbours in memory.
    names: Vec<u32>,
    order: Order,
    /// The circles in order, while that is of use.
    holes: Option<EmptyCircles>,
    /// At least the size of every face's hole.
    ceiling: f64,
    /// Points that have moved far since they were numbered.
    jumps: usize,
}

impl<F: Field> Arrangement for Swarm<F> {
    /// The points in the caller's order.
    fn points(&self) -> Vec<DVec2> {
        let mut points = vec![DVec2::ZERO; self.names.len()];
        for (&name, p) in self.names.iter().zip(self.places()) {
            points[name as usize] = p;
        }
        points
    }

    fn spread(&self) -> Spread {
        let spacing = Spacing::of(&self.triangulation);
        Spread::new(spacing.nearest_distances(), self.places(), &self.field)
    }

    fn sweep(&mut self, search: Search, d_min: f64) -> Moves {
        self.prepare(search, d_min);
        self.visit_where(search, |_| true)
    }
}

impl<F: Field> Swarm<F> {
    pub(super) fn new(start: &[DVec2], field: F, order: Order) -> Self {
        let mut swarm = Self {
            field,
            triangulation: Triangulation::empty(),
            names: (0..start.len() as u32).collect(),
            order,
            holes: None,
            ceiling: f64::INFINITY,
            jumps: 0,
        };
        swarm.number(start);
        swarm
    }

    /// Numbers the points, given in the order of their present numbers, along the curve.
    fn number(&mut self, points: &[DVec2]) {
        let curve = hilbert_order(points);
        self.names = curve.iter().map(|&i| self.names[i as usize]).collect();
        let along = curve.iter().map(|&i| points[i as usize]).collect();
        let set = PointSet::new(along).expect("points of the unit torus");
        self.triangulation = Triangulation::new(&set);
        self.holes = None;
        self.jumps = 0;
        self.measure_ceiling();
    }

    fn places(&self) -> impl Iterator<Item = DVec2> {
        (0..self.names.len()).map(|point| self.triangulation.position(point))
    }

    fn measure_ceiling(&mut self) {
        let sizes = self.triangulation.faces().map(|face| self.size(face.corners));
        self.ceiling = sizes.fold(0.0, |most, one| if one > most { one } else { most });
    }

    /// Takes note of how to search and of `d_min` before a sweep: where no hole exceeds it, nothing
    /// attracts any point but the room that it would leave behind, and the circles need no order.
    fn prepare(&mut self, search: Search, d_min: f64) {
        let d_min_squared = d_min * d_min;
        if self.jumps > self.names.len() / 4 {
            let places: Vec<DVec2> = self.places().collect();
            self.number(&places);
        }
        let mut needs_order = search == Search::Global;
        if self.holes.is_some() || self.ceiling > d_min_squared {
            self.measure_ceiling();
            needs_order &= self.ceiling >= d_min_squared;
        }
        if !needs_order {
            self.holes = None;
        }
    }

    /// Visits every point once for which `is_wanted(place)`.
    pub(super) fn visit_where(
        &mut self,
        search: Search,
        is_wanted: impl Fn(DVec2) -> bool,
    ) -> Moves {
        let (mut count, mut longest_squared) = (0, 0.0);
        let order = self.order;
        let n = self.names.len();
        let stretch = if search == Search::Global { n } else { STRETCH };
        for point in order.visits(n, stretch) {
            if is_wanted(self.triangulation.position(point)) {
                let squared = self.visit(point, search);
                count += usize::from(squared > 0.0);
                longest_squared = squared.max(longest_squared);
            }
        }
        Moves { count, longest: longest_squared.sqrt() }
    }

    /// Moves a point to the largest hole that it would find if it were not there, if that is larger
    /// than its clearance. Returns the squared way; infinity for any way to a hole that the point did
    /// not touch.
    #[inline]
    fn visit(&mut self, point: usize, search: Search) -> f64 {
        let home = self.triangulation.position(point);
        let field = &self.field;
        let size = |corners| field.hole(home, corners).size;
        let distance = |way| field.distance_squared(home, way);
        let Some(vacancy) = self.triangulation.vacancy(point, size, distance) else {
            return self.visit_crowded(point);
        };
        let best = vacancy.size.max(vacancy.clearance);
        if best < self.ceiling
            && let Some(face) = self.larger_hole(point, search, best)
        {
            self.jump(point, face);
            return f64::INFINITY;
        }
        match vacancy.face {
            Some(corners) if vacancy.size > vacancy.clearance * GAIN => {
                let way = self.field.hole(home, corners).center;
                self.triangulation.relocate(point, torus::wrap_point(home + way));
                self.note_changes();
                way.length_squared()
            }
            _ => 0.0,
        }
    }

    /// A hole that the point does not touch and that is larger than `best`.
    ///
    /// A face at the point itself is no candidate: the room that the point would leave behind is no
    /// smaller.
    #[inline]
    fn larger_hole(&mut self, point: usize, search: Search, best: f64) -> Option<FaceId> {
        match search {
            Search::Global => self.largest_hole(point, best),
            Search::Local => self.neighboring_hole(point, best),
        }
    }

    fn largest_hole(&mut self, point: usize, best: f64) -> Option<FaceId> {
        let holes = self.ordered_holes();
        let face = holes.largest()?;
        let most = holes.size(face);
        self.ceiling = most;
        (most > best * GAIN && !self.touches(point, face)).then_some(face)
    }

    fn neighboring_hole(&self, point: usize, best: f64) -> Option<FaceId> {
        let (mut found, mut most) = (None, best * GAIN);
        for (neighbor, _) in self.triangulation.neighbors(point) {
            for face in self.triangulation.star(neighbor) {
                let size = self.triangulation.corners(face).map_or(0.0, |face| self.size(face));
                if size > most && !self.touches(point, face) {
                    (found, most) = (Some(face), size);
                }
            }
        }
        found
    }

    /// The size of the hole between the corners of a face.
    #[inline]
    fn size(&self, corners: [DVec2; 3]) -> f64 {
        self.field.hole(DVec2::ZERO, corners).size
    }

    fn touches(&self, point: usize, face: FaceId) -> bool {
        self.triangulation.face(face).vertices.contains(&point)
    }

    fn ordered_holes(&mut self) -> &EmptyCircles {
        self.holes.get_or_insert_with(|| {
            EmptyCircles::sized(&self.triangulation, |face| self.field.hole(DVec2::ZERO, face).size)
        })
    }

    /// Moves a point into a face that it does not touch.
    fn jump(&mut self, point: usize, face: FaceId) {
        let center = self.center(face);
        self.triangulation.remove(point);
        self.note_changes();
        self.triangulation.insert_near(point, center, face);
        self.note_changes();
        self.jumps += 1;
    }

    fn center(&self, face: FaceId) -> DVec2 {
        let corners = self.triangulation.face(face).corners;
        torus::wrap_point(self.field.hole(DVec2::ZERO, corners).center)
    }

    /// As [`Swarm::visit`], for a point that shares its place or is its own neighbour: always looks
    /// everywhere.
    #[cold]
    fn visit_crowded(&mut self, point: usize) -> f64 {
        let home = self.triangulation.position(point);
        let clearance = self.clearance(point);
        self.triangulation.remove(point);
        self.note_changes();
        let holes = self.ordered_holes();
        let hole = holes.largest().filter(|&face| holes.size(face) > clearance * GAIN);
        match hole {
            Some(face) => self.triangulation.insert_near(point, self.center(face), face),
            None => self.triangulation.insert(point, home),
        }
        self.note_changes();
        self.jumps += 1;
        if hole.is_some() { f64::INFINITY } else { 0.0 }
    }

    /// The squared distance from a point to the nearest other one.
    fn clearance(&self, point: usize) -> f64 {
        if self.triangulation.shares_place(point) {
            return 0.0;
        }
        let home = self.triangulation.position(point);
        let others = self.triangulation.neighbors(point).filter(|&(other, _)| other != point);
        let distances = others.map(|(_, way)| self.field.distance_squared(home, way));
        distances.fold(f64::INFINITY, f64::min)
    }

    /// Takes over the circles of the faces that changed.
    #[inline]
    fn note_changes(&mut self) {
        let field = &self.field;
        let size = |corners| field.hole(DVec2::ZERO, corners).size;
        if let Some(holes) = &mut self.holes {
            holes.update_sized(&self.triangulation, size);
            self.ceiling = f64::INFINITY;
            return;
        }
        for &face in self.triangulation.changed_faces() {
            let size = self.triangulation.corners(face).map_or(0.0, size);
            self.ceiling = if size > self.ceiling { size } else { self.ceiling };
        }
    }
}
