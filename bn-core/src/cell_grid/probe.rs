//! What a search keeps of the points that it meets.

use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::ops::ControlFlow;

use glam::DVec2;

use super::CellPoints;
use crate::torus;

/// Squares of distances below this have lost digits to underflow: they only say "very near".
const UNDERFLOW: f64 = 1e-290;

/// Collects points on behalf of a query.
pub(super) trait Probe {
    /// The square of the distance beyond which points need not be shown any more.
    fn reach_squared(&self) -> f64;

    /// How near points may be that are at least this far away in each axis: what comes first when
    /// nearer ones do. Rises with the distance.
    fn clearance(gap: DVec2) -> f64 {
        gap.length_squared()
    }

    /// The clearance beyond which points need not be shown any more.
    fn reach(&self) -> f64 {
        self.reach_squared()
    }

    /// Looks at a few points, and breaks if no others can matter.
    fn look(&mut self, at: CellPoints<'_>) -> ControlFlow<()>;
}

/// [`torus::distance_squared`], to the bit, without branches: |d ∓ 1| = 1 − |d|.
#[inline]
fn distance_squared(p: DVec2, q: DVec2) -> f64 {
    let shortest = |d: f64| {
        let (near, round) = (d.abs(), 1.0 - d.abs());
        if near < round { near } else { round }
    };
    let (x, y) = (shortest(q.x - p.x), shortest(q.y - p.y));
    x * x + y * y
}

/// No point has this index: a set has at most 2²⁹.
const NOBODY: u32 = u32::MAX;

/// Keeps the point of least squared distance, at equal ones that of least index.
pub(super) struct Nearest {
    origin: DVec2,
    except: u32,
    point: DVec2,
    index: u32,
    distance_squared: f64,
}

impl Nearest {
    pub(super) fn new(origin: DVec2, except: Option<u32>) -> Self {
        Self {
            origin,
            except: except.unwrap_or(NOBODY),
            point: origin,
            index: NOBODY,
            distance_squared: f64::INFINITY,
        }
    }

    /// Whether distances have underflown, so that [`VeryNear`] has to decide.
    pub(super) fn is_undecided(&self) -> bool {
        self.distance_squared < UNDERFLOW
    }

    pub(super) fn result(&self) -> Option<(u32, f64)> {
        let found = self.index != NOBODY;
        found.then(|| (self.index, torus::distance(self.origin, self.point)))
    }
}

impl Probe for Nearest {
    #[inline]
    fn reach_squared(&self) -> f64 {
        self.distance_squared
    }

    #[inline]
    fn look(&mut self, at: CellPoints<'_>) -> ControlFlow<()> {
        for (&q, &index) in at.points.iter().zip(at.indices) {
            let d = distance_squared(self.origin, q);
            let comes_first =
                d < self.distance_squared || (d == self.distance_squared && index < self.index);
            if comes_first && index != self.except {
                (self.distance_squared, self.index, self.point) = (d, index, q);
            }
        }
        // Enough: `VeryNear` decides then.
        if self.distance_squared < UNDERFLOW {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }
}

/// Keeps the nearest of points so near that squares of distances don't tell.
pub(super) struct VeryNear {
    origin: DVec2,
    except: Option<u32>,
    best: Option<(f64, u32)>,
}

impl VeryNear {
    pub(super) fn new(origin: DVec2, except: Option<u32>) -> Self {
        Self { origin, except, best: None }
    }

    pub(super) fn result(&self) -> Option<(u32, f64)> {
        self.best.map(|(distance, index)| (index, distance))
    }
}

impl Probe for VeryNear {
    fn reach_squared(&self) -> f64 {
        UNDERFLOW
    }

    /// The distance along the farther axis, which no square can lose.
    fn clearance(gap: DVec2) -> f64 {
        gap.max_element()
    }

    fn reach(&self) -> f64 {
        self.best.map_or(UNDERFLOW.sqrt(), |(distance, _)| distance)
    }

    fn look(&mut self, at: CellPoints<'_>) -> ControlFlow<()> {
        for (&q, &index) in at.points.iter().zip(at.indices) {
            let candidate = (torus::distance(self.origin, q), index);
            if Some(index) != self.except && self.best.is_none_or(|best| candidate < best) {
                self.best = Some(candidate);
                if candidate.0 == 0.0 {
                    return ControlFlow::Break(());
                }
            }
        }
        ControlFlow::Continue(())
    }
}

/// Keeps the k ≥ 1 nearest points.
pub(super) struct NearestK {
    origin: DVec2,
    except: Option<u32>,
    k: usize,
    /// The farthest on top.
    kept: BinaryHeap<Kept>,
}

#[derive(PartialEq)]
struct Kept {
    distance_squared: f64,
    index: u32,
    point: DVec2,
}

impl Eq for Kept {}

impl PartialOrd for Kept {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Kept {
    fn cmp(&self, other: &Self) -> Ordering {
        let by_distance = self.distance_squared.total_cmp(&other.distance_squared);
        by_distance.then(self.index.cmp(&other.index))
    }
}

impl NearestK {
    pub(super) fn new(origin: DVec2, k: usize, except: Option<u32>) -> Self {
        Self { origin, except, k, kept: BinaryHeap::new() }
    }

    pub(super) fn result(self) -> Vec<(u32, f64)> {
        let sorted = self.kept.into_sorted_vec();
        sorted.iter().map(|kept| (kept.index, torus::distance(self.origin, kept.point))).collect()
    }
}

impl Probe for NearestK {
    fn reach_squared(&self) -> f64 {
        match self.kept.peek() {
            Some(farthest) if self.kept.len() == self.k => farthest.distance_squared,
            _ => f64::INFINITY,
        }
    }

    fn look(&mut self, at: CellPoints<'_>) -> ControlFlow<()> {
        for (&point, &index) in at.points.iter().zip(at.indices) {
            let distance_squared = distance_squared(self.origin, point);
            if distance_squared <= self.reach_squared() && Some(index) != self.except {
                self.kept.push(Kept { distance_squared, index, point });
                if self.kept.len() > self.k {
                    self.kept.pop();
                }
            }
        }
        if self.reach_squared() == 0.0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// Hands every point of a closed disk to a visitor.
pub(super) struct Within<F, B> {
    center: DVec2,
    radius_squared: f64,
    visit: F,
    outcome: ControlFlow<B>,
}

impl<F: FnMut(u32, f64) -> ControlFlow<B>, B> Within<F, B> {
    pub(super) fn new(center: DVec2, radius: f64, visit: F) -> Self {
        let radius_squared = radius * radius;
        Self { center, radius_squared, visit, outcome: ControlFlow::Continue(()) }
    }

    pub(super) fn result(self) -> ControlFlow<B> {
        self.outcome
    }
}

impl<F: FnMut(u32, f64) -> ControlFlow<B>, B> Probe for Within<F, B> {
    #[inline]
    fn reach_squared(&self) -> f64 {
        self.radius_squared
    }

    #[inline]
    fn look(&mut self, at: CellPoints<'_>) -> ControlFlow<()> {
        for (&q, &index) in at.points.iter().zip(at.indices) {
            let d = distance_squared(self.center, q);
            if d <= self.radius_squared {
                let outcome = (self.visit)(index, d);
                if outcome.is_break() {
                    self.outcome = outcome;
                    return ControlFlow::Break(());
                }
            }
        }
        ControlFlow::Continue(())
    }
}
