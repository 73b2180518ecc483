//! The points while they move, their triangulation and what is known of its holes.

use bn_core::{DVec2, PointSet, Seed, torus};
use bn_geometry::{Coverage, EmptyCircles, FaceId, Spacing, Triangulation, hilbert_order};
use rand::seq::SliceRandom;

/// A hole must exceed a point's clearance by this factor, in squares, to attract it: more than
/// rounding can feign, so that lattices stay put and no distance ever falls.
const GAIN: f64 = 1.0 + 1e-12;

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

/// Where a point looks for a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Search {
    /// Everywhere.
    Global,
    /// Among the faces at its neighbours.
    Local,
}

/// The points, and what is known of the holes among them.
#[derive(Debug)]
pub(super) struct Swarm {
    triangulation: Triangulation,
    /// The caller's index of each point here: here they are numbered along a Hilbert curve, so that
    /// neighbours on the torus are neighbours in memory.
    names: Vec<u32>,
    /// The first points of the rounds, in the order of rounds.
    rounds: Vec<usize>,
    /// The circles in order, while that is of use.
    holes: Option<EmptyCircles>,
    /// At least the squared radius of every face's circle.
    ceiling: f64,
    /// Points that have moved far since they were numbered.
    jumps: usize,
}

impl Swarm {
    pub(super) fn new(start: &PointSet, seed: Seed) -> Self {
        let mut rounds: Vec<usize> = (0..ROUNDS).collect();
        rounds.shuffle(&mut seed.stream(ORDER_STREAM));
        let mut swarm = Self {
            triangulation: Triangulation::empty(),
            names: (0..start.len() as u32).collect(),
            rounds,
            holes: None,
            ceiling: f64::INFINITY,
            jumps: 0,
        };
        swarm.number(start.points());
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

    /// The points in the caller's order.
    pub(super) fn points(&self) -> Vec<DVec2> {
        let mut points = vec![DVec2::ZERO; self.names.len()];
        for (&name, p) in self.names.iter().zip(self.places()) {
            points[name as usize] = p;
        }
        points
    }

    pub(super) fn spacing(&self) -> Spacing {
        Spacing::of(&self.triangulation)
    }

    /// Measures the largest circle, and returns its radius.
    fn measure_ceiling(&mut self) -> f64 {
        let radius = Coverage::of(&self.triangulation).map_or(0.0, |coverage| coverage.radius);
        self.ceiling = radius * radius;
        radius
    }

    /// Takes note of `d_min` before a sweep: where no hole exceeds it, nothing attracts any point
    /// but the room that it would leave behind, and the circles need no order.
    pub(super) fn settle(&mut self, d_min: f64) {
        let may_attract = self.holes.is_some() || self.ceiling > d_min * d_min;
        if may_attract && self.measure_ceiling() < d_min {
            self.stay_local();
        }
    }

    /// Prepares for sweeps in which points stay near their places.
    pub(super) fn stay_local(&mut self) {
        self.holes = None;
        if self.jumps > self.names.len() / 4 {
            let places: Vec<DVec2> = self.places().collect();
            self.number(&places);
        }
    }

    /// Visits every point once, and returns how many moved.
    pub(super) fn sweep(&mut self, search: Search) -> usize {
        let mut moved = 0;
        for round in 0..ROUNDS {
            for point in (self.rounds[round]..self.names.len()).step_by(ROUNDS) {
                moved += usize::from(self.visit(point, search));
            }
        }
        moved
    }

    /// Moves a point to the largest hole that it would find if it were not there, if that is larger
    /// than its clearance.
    #[inline]
    fn visit(&mut self, point: usize, search: Search) -> bool {
        let Some(vacancy) = self.triangulation.vacancy(point) else {
            return self.visit_crowded(point);
        };
        let best = vacancy.radius_squared.max(vacancy.clearance_squared);
        if best < self.ceiling
            && let Some(face) = self.larger_hole(point, search, best)
        {
            self.jump(point, face);
            return true;
        }
        let moves = vacancy.radius_squared > vacancy.clearance_squared * GAIN;
        if moves {
            let home = self.triangulation.position(point);
            self.triangulation.relocate(point, torus::wrap_point(home + vacancy.to_center));
            self.note_changes();
        }
        moves
    }

    /// A hole that the point does not touch and whose squared radius exceeds `best`.
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
        let squared = holes.radius_squared(face);
        self.ceiling = squared;
        (squared > best * GAIN && !self.touches(point, face)).then_some(face)
    }

    fn neighboring_hole(&self, point: usize, best: f64) -> Option<FaceId> {
        let (mut found, mut largest) = (None, best * GAIN);
        for (neighbor, _) in self.triangulation.neighbors(point) {
            for face in self.triangulation.star(neighbor) {
                let squared = self.triangulation.circumradius_squared(face).unwrap_or(0.0);
                if squared > largest && !self.touches(point, face) {
                    (found, largest) = (Some(face), squared);
                }
            }
        }
        found
    }

    fn touches(&self, point: usize, face: FaceId) -> bool {
        self.triangulation.face(face).vertices.contains(&point)
    }

    fn ordered_holes(&mut self) -> &EmptyCircles {
        self.holes.get_or_insert_with(|| EmptyCircles::new(&self.triangulation))
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
        torus::wrap_point(self.triangulation.circumcircle(face).center)
    }

    /// As [`Swarm::visit`], for a point that shares its place or is its own neighbour: always looks
    /// everywhere.
    #[cold]
    fn visit_crowded(&mut self, point: usize) -> bool {
        let home = self.triangulation.position(point);
        let clearance_squared = self.clearance_squared(point);
        self.triangulation.remove(point);
        self.note_changes();
        let holes = self.ordered_holes();
        let attracts = |&face: &FaceId| holes.radius_squared(face) > clearance_squared * GAIN;
        let hole = holes.largest().filter(attracts);
        match hole {
            Some(face) => self.triangulation.insert_near(point, self.center(face), face),
            None => self.triangulation.insert(point, home),
        }
        self.note_changes();
        self.jumps += 1;
        hole.is_some()
    }

    /// The squared distance from a point to the nearest other one.
    fn clearance_squared(&self, point: usize) -> f64 {
        if self.triangulation.shares_place(point) {
            return 0.0;
        }
        let others = self.triangulation.neighbors(point).filter(|&(other, _)| other != point);
        others.map(|(_, way)| way.length_squared()).fold(f64::INFINITY, f64::min)
    }

    /// Takes over the circles of the faces that changed.
    #[inline]
    fn note_changes(&mut self) {
        if let Some(holes) = &mut self.holes {
            holes.update(&self.triangulation);
            self.ceiling = f64::INFINITY;
            return;
        }
        for &face in self.triangulation.changed_faces() {
            let squared = self.triangulation.circumradius_squared(face).unwrap_or(0.0);
            self.ceiling = if squared > self.ceiling { squared } else { self.ceiling };
        }
    }
}
