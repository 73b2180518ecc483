//! Minimisation of a smooth function of many points by the limited-memory BFGS method with a line
//! search for the strong Wolfe conditions.
//!
//! J. Nocedal, "Updating quasi-Newton matrices with limited storage", Math. Comp. 35, 1980; D. C. Liu
//! and J. Nocedal, "On the limited memory BFGS method for large scale optimization", Math. Program.
//! 45, 1989; the line search after J. Nocedal and S. J. Wright, *Numerical Optimization* (2006),
//! algorithms 3.5 and 3.6.

use std::collections::VecDeque;

use bn_core::DVec2;

/// Pairs of steps and gradient differences that stand for the Hessian.
const MEMORY: usize = 10;
/// Sufficient decrease: f(a) ≤ f(0) + `ARMIJO`·a·f′(0).
const ARMIJO: f64 = 1e-4;
/// Curvature: |f′(a)| ≤ `CURVATURE`·|f′(0)|.
const CURVATURE: f64 = 0.9;
/// Evaluations of one line search.
const TRIALS: u32 = 12;

/// A function of many points with its gradient.
pub(super) trait Objective {
    /// The value at `x`, the gradient into `gradient`; infinite or NaN where it can't be computed.
    fn evaluate(&mut self, x: &[DVec2], gradient: &mut [DVec2]) -> f64;
}

/// The state of a minimisation, between two steps.
pub(super) struct Lbfgs {
    x: Vec<DVec2>,
    gradient: Vec<DVec2>,
    value: f64,
    pairs: VecDeque<Pair>,
    direction: Vec<DVec2>,
    trial: Trial,
    evaluations: u32,
    /// The most evaluations.
    limit: u32,
}

/// s = x′ − x, y = ∇f′ − ∇f, ρ = 1/(s·y).
struct Pair {
    s: Vec<DVec2>,
    y: Vec<DVec2>,
    rho: f64,
    /// Of the two-loop recursion.
    alpha: f64,
}

/// A point of the line search.
#[derive(Default)]
struct Trial {
    x: Vec<DVec2>,
    gradient: Vec<DVec2>,
}

/// What a place along the line is known to be like.
#[derive(Clone, Copy)]
struct Sample {
    length: f64,
    value: f64,
    slope: f64,
}

impl Lbfgs {
    /// A minimisation from `x` on, of at most `limit` evaluations; the first is due at once.
    pub(super) fn new(x: Vec<DVec2>, objective: &mut impl Objective, limit: u32) -> Self {
        let mut gradient = vec![DVec2::ZERO; x.len()];
        let value = objective.evaluate(&x, &mut gradient);
        let zeros = || vec![DVec2::ZERO; x.len()];
        let (direction, trial) = (zeros(), Trial { x: zeros(), gradient: zeros() });
        let pairs = VecDeque::new();
        Self { gradient, value, pairs, direction, trial, evaluations: 1, limit, x }
    }

    /// Bytes that a minimisation of `n` points takes.
    pub(super) fn bytes(n: usize) -> usize {
        // Place, gradient and direction, a place and gradient on trial, and the pairs.
        n.saturating_mul((5 + 2 * MEMORY) * size_of::<DVec2>())
    }

    /// The value at the present place.
    pub(super) fn value(&self) -> f64 {
        self.value
    }

    /// The present place.
    pub(super) fn x(&self) -> &[DVec2] {
        &self.x
    }

    /// The present place, by value.
    pub(super) fn into_x(self) -> Vec<DVec2> {
        self.x
    }

    /// Evaluations so far.
    pub(super) fn evaluations(&self) -> u32 {
        self.evaluations
    }

    /// One line search. `first_move` is how far the fastest point moves at the first trial where
    /// nothing is known of the Hessian. False where no lower value was found: a minimum, or as near
    /// as rounding allows, or as the evaluations that are left.
    pub(super) fn step(&mut self, objective: &mut impl Objective, first_move: f64) -> bool {
        if self.search(objective, first_move) {
            return true;
        }
        // The memory may be to blame: once more along the gradient.
        if self.pairs.is_empty() {
            return false;
        }
        self.pairs.clear();
        self.search(objective, first_move)
    }

    fn search(&mut self, objective: &mut impl Objective, first_move: f64) -> bool {
        self.set_direction();
        let slope = dot(&self.direction, &self.gradient);
        if slope.is_nan() || slope >= 0.0 {
            return false;
        }
        let start = Sample { length: 0.0, value: self.value, slope };
        let first = if self.pairs.is_empty() {
            first_move
                / self.direction.iter().map(|d| d.length_squared()).fold(0.0, f64::max).sqrt()
        } else {
            1.0
        };
        let Some(found) = self.line_search(objective, start, first) else { return false };
        self.accept(found);
        true
    }

    /// The direction −H∇f by the two-loop recursion.
    fn set_direction(&mut self) {
        let d = &mut self.direction;
        for (d, g) in d.iter_mut().zip(&self.gradient) {
            *d = -*g;
        }
        for pair in self.pairs.iter_mut().rev() {
            pair.alpha = pair.rho * dot(&pair.s, d);
            add_scaled(d, -pair.alpha, &pair.y);
        }
        if let Some(last) = self.pairs.back() {
            let scale = 1.0 / (last.rho * dot(&last.y, &last.y));
            for d in d.iter_mut() {
                *d *= scale;
            }
        }
        for pair in &self.pairs {
            let beta = pair.rho * dot(&pair.y, d);
            add_scaled(d, pair.alpha - beta, &pair.s);
        }
    }

    fn accept(&mut self, found: Sample) {
        let mut pair = if self.pairs.len() == MEMORY { self.pairs.pop_front() } else { None }
            .unwrap_or_else(|| Pair { s: self.x.clone(), y: self.x.clone(), rho: 0.0, alpha: 0.0 });
        for i in 0..self.x.len() {
            pair.s[i] = self.trial.x[i] - self.x[i];
            pair.y[i] = self.trial.gradient[i] - self.gradient[i];
        }
        std::mem::swap(&mut self.x, &mut self.trial.x);
        std::mem::swap(&mut self.gradient, &mut self.trial.gradient);
        self.value = found.value;
        let curvature = dot(&pair.s, &pair.y);
        if curvature > f64::EPSILON * dot(&pair.y, &pair.y) {
            pair.rho = 1.0 / curvature;
            self.pairs.push_back(pair);
        }
    }

    fn evaluate_at(&mut self, objective: &mut impl Objective, length: f64) -> Sample {
        let Trial { x, gradient } = &mut self.trial;
        for ((x, from), d) in x.iter_mut().zip(&self.x).zip(&self.direction) {
            *x = *from + length * *d;
        }
        self.evaluations += 1;
        let value = objective.evaluate(x, gradient);
        Sample { length, value, slope: dot(&self.direction, gradient) }
    }

    /// A place that fulfils the strong Wolfe conditions, or the lowest one found that at least
    /// fulfils the first; the trial holds it. None if there is no such place.
    fn line_search(
        &mut self,
        objective: &mut impl Objective,
        start: Sample,
        first: f64,
    ) -> Option<Sample> {
        let decreases = |s: &Sample| s.value <= start.value + ARMIJO * s.length * start.slope;
        let flat = |s: &Sample| s.slope.abs() <= -CURVATURE * start.slope;
        let (mut low, mut high): (Sample, Option<Sample>) = (start, None);
        let (mut length, mut tried) = (first, 0.0);
        for _ in 0..TRIALS {
            // One is kept for the way back to the lowest place.
            if self.evaluations + u32::from(low.length > 0.0) >= self.limit {
                break;
            }
            tried = length;
            let here = self.evaluate_at(objective, length);
            if !decreases(&here) || (low.length > 0.0 && here.value >= low.value) {
                high = Some(here);
            } else if flat(&here) {
                return Some(here);
            } else {
                // Rising towards the far end of the bracket: the minimum lies back towards `low`.
                let ahead = high.map_or(1.0, |high| high.length - low.length);
                if here.slope * ahead >= 0.0 {
                    high = Some(low);
                }
                low = here;
            }
            length = match high {
                None => 2.0 * low.length,
                Some(high) => between(low, high),
            };
        }
        // Out of trials: the lowest place will do, if the trial can be put back there.
        if low.length > 0.0 && low.length != tried {
            low = self.evaluate_at(objective, low.length);
        }
        (low.length > 0.0).then_some(low)
    }
}

/// The minimum of the cubic through two samples, kept off both.
fn between(a: Sample, b: Sample) -> f64 {
    let d1 = a.slope + b.slope - 3.0 * (a.value - b.value) / (a.length - b.length);
    let root = (d1 * d1 - a.slope * b.slope).sqrt() * (b.length - a.length).signum();
    let cubic =
        b.length - (b.length - a.length) * (b.slope + root - d1) / (b.slope - a.slope + 2.0 * root);
    let (least, most) = (a.length.min(b.length), a.length.max(b.length));
    let margin = 0.1 * (most - least);
    if cubic.is_finite() {
        cubic.clamp(least + margin, most - margin)
    } else {
        0.5 * (least + most)
    }
}

/// Σ a·b in four partial sums, an order that is fixed and vectorises.
fn dot(a: &[DVec2], b: &[DVec2]) -> f64 {
    let mut sums = [DVec2::ZERO; 4];
    let ((a4, a_rest), (b4, b_rest)) = (a.as_chunks::<4>(), b.as_chunks::<4>());
    for (a, b) in a4.iter().zip(b4) {
        for lane in 0..4 {
            sums[lane] += a[lane] * b[lane];
        }
    }
    let rest = a_rest.iter().zip(b_rest).map(|(a, b)| *a * *b).fold(DVec2::ZERO, |s, p| s + p);
    let sum = (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest;
    sum.x + sum.y
}

fn add_scaled(to: &mut [DVec2], factor: f64, what: &[DVec2]) {
    for (to, what) in to.iter_mut().zip(what) {
        *to += factor * *what;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rosenbrock's valley in each point, of different steepness.
    struct Valleys;

    impl Objective for Valleys {
        fn evaluate(&mut self, x: &[DVec2], gradient: &mut [DVec2]) -> f64 {
            let mut sum = 0.0;
            for ((i, p), g) in x.iter().enumerate().zip(gradient) {
                let steepness = 10.0 * (i + 1) as f64;
                let (a, b) = (1.0 - p.x, p.y - p.x * p.x);
                sum += a * a + steepness * b * b;
                *g = DVec2::new(-2.0 * a - 4.0 * steepness * b * p.x, 2.0 * steepness * b);
            }
            sum
        }
    }

    #[test]
    fn reaches_the_minimum_and_never_climbs() {
        let start: Vec<DVec2> =
            (0..7).map(|i| DVec2::new(-1.2 + 0.1 * f64::from(i), 1.0)).collect();
        let mut search = Lbfgs::new(start, &mut Valleys, u32::MAX);
        let mut before = search.value();
        while search.value() > 1e-16 && search.evaluations() < 1000 {
            assert!(search.step(&mut Valleys, 0.1), "stuck at {}", search.value());
            assert!(search.value() <= before);
            before = search.value();
        }
        assert!(search.evaluations() < 500, "{} evaluations", search.evaluations());
        assert!(search.x().iter().all(|p| (*p - DVec2::ONE).length() < 1e-6));
    }

    #[test]
    fn stops_where_there_is_no_way_down() {
        struct Flat;
        impl Objective for Flat {
            fn evaluate(&mut self, _: &[DVec2], gradient: &mut [DVec2]) -> f64 {
                gradient.fill(DVec2::ZERO);
                3.0
            }
        }
        struct Undefined;
        impl Objective for Undefined {
            fn evaluate(&mut self, _: &[DVec2], gradient: &mut [DVec2]) -> f64 {
                gradient.fill(DVec2::NAN);
                f64::NAN
            }
        }
        let start = vec![DVec2::new(0.5, 0.5); 3];
        assert!(!Lbfgs::new(start.clone(), &mut Flat, 100).step(&mut Flat, 0.1));
        assert!(!Lbfgs::new(start, &mut Undefined, 100).step(&mut Undefined, 0.1));
    }

    /// Wherever a line search is cut short, the state is that of the lowest place seen.
    #[test]
    fn no_more_evaluations_than_the_limit() {
        let start: Vec<DVec2> =
            (0..7).map(|i| DVec2::new(-1.2 + 0.1 * f64::from(i), 1.0)).collect();
        let mut values = Vec::new();
        for limit in 1..120 {
            let mut search = Lbfgs::new(start.clone(), &mut Valleys, limit);
            while search.step(&mut Valleys, 0.1) {}
            assert_eq!(search.evaluations(), limit);
            let mut gradient = vec![DVec2::ZERO; start.len()];
            assert_eq!(Valleys.evaluate(search.x(), &mut gradient), search.value());
            assert_eq!(search.gradient, gradient);
            values.push(search.value());
        }
        assert!(values[118] < 0.1 * values[0], "{values:?}");
    }
}
