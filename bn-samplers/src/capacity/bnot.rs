//! Blue noise through optimal transport.

use std::sync::Arc;

use bn_core::{DensityFunction, NormalizedDistance, Observer, Progress, Seed};

use super::relaxation::{LOOSE, Relaxation};
use crate::common_options::{
    DENSITY_OPTION, check_range, check_tolerance, iterations, tolerance, uneven,
};
use crate::error::{check_count, observe};
use crate::{
    CountRule, DefaultValue, Method, OptionKind, OptionSpec, PointOrder, Report, Sample,
    SampleError, Sampler, Stochastic,
};

/// Random points, moved until carrying the uniform distribution to them, equal parts to each, costs
/// the least: blue noise through optimal transport (BNOT).
///
/// The cost Σ ∫ |x − xⱼ|² over power cells of equal area has the gradient 2(xⱼ − bⱼ)/n, with bⱼ the
/// cell's centroid. Points first jump to their centroids until they are within twice the tolerance of
/// them, and then go down the gradient as far as a line search says, up to twice the way to the
/// centroids; weights follow by Newton's method ([`bn_geometry::BalancedDiagram`]). Then regular
/// patches are sought: points whose cells have about the second moments of all cells around them.
/// If there are any, these points and their neighbours are shaken, up to 100 of
/// them thrown anywhere, and all begins anew.
///
/// The default tolerance is where the original program comes to rest at 4096 points, before there is
/// any regular patch; with smaller ones the cost falls on, patches grow and are broken up.
///
/// F. de Goes, K. Breeden, V. Ostromoukhov and M. Desbrun, "Blue noise through optimal transport",
/// ACM Trans. Graph. 31(6), 2012. Not in the thesis's tables (it is cited on p. 24). O(n^1.5) an
/// iteration, for the linear systems; some 25 ms on one core at 4096 points.
///
/// With a density, cells have equal masses instead of equal areas, and carrying the density to the points
/// costs the least; nothing is broken up. An iteration takes time for every pixel on a cell's boundary then.
#[derive(Clone, Debug, PartialEq)]
pub struct Bnot {
    /// The most iterations in all.
    pub iterations: u32,
    /// Stop when the root mean square distance of points to their cells' centroids is below this.
    pub tolerance: NormalizedDistance,
    /// A point is regular if the second moments of the cells around its own differ from its own
    /// by less than this in the mean, in units of the regular hexagon's; 0 breaks nothing.
    pub regularity: f64,
    /// The density of the points, uniform if there is none.
    pub density: Option<Arc<DensityFunction>>,
}

impl Default for Bnot {
    fn default() -> Self {
        Self {
            iterations: 1000,
            tolerance: NormalizedDistance::new(0.0062),
            regularity: 0.001,
            density: None,
        }
    }
}

/// The registry's entry.
pub(crate) const METHOD: Method = Method {
    name: "bnot",
    aliases: &["optimal-transport"],
    summary: "points to which the plane can be carried at the least cost",
    page: None,
    citation: "F. de Goes, K. Breeden, V. Ostromoukhov, M. Desbrun, Blue noise through optimal transport, ACM Trans. Graph. 31(6), 2012",
    complexity: "O(n^1.5) an iteration",
    order: PointOrder::Random,
    counts: CountRule::Any,
    seeded: true,
    options: &[
        iterations("1000"),
        tolerance(
            "0.0062",
            "stop when points are nearer to their cells' centroids, root mean square",
        ),
        OptionSpec {
            name: "regularity",
            kind: OptionKind::Real { min: 0.0, max: 1.0 },
            default: DefaultValue::Value("0.001"),
            help: "break up patches whose cells' second moments differ by less; 0 for none",
            unit: "",
        },
        DENSITY_OPTION,
    ],
    build: |options| {
        Ok(Box::new(Bnot {
            iterations: options.count("iterations"),
            tolerance: options.distance("tolerance"),
            regularity: options.number("regularity"),
            density: options.density("density"),
        }))
    },
    version: 1,
};

/// Areas are equal to this, relative to 1/n, while a line search compares energies.
const FINE: f64 = 1e-4;

/// Areas are equal to this in the end, relative to 1/n.
const EXACT: f64 = 1e-9;

/// Regular patches are broken up this often at most.
const MOST_ROUNDS: u32 = 20;

/// Line searches begin with this many times the way to the centroids: at −1/f″ where cells keep
/// their shapes the step would be 1, and beyond 2 the cost would rise.
const LONGEST: f64 = 2.0;

impl Sampler for Bnot {
    fn sample(&self, n: usize, seed: Seed, observer: &dyn Observer) -> Result<Sample, SampleError> {
        check_count(METHOD.name, n)?;
        check_tolerance(self.tolerance)?;
        check_range("regularity", self.regularity, 0.0, f64::MAX)?;
        let density = uneven(self.density.as_ref());
        let start = Stochastic { density: density.clone() }.sample(n, seed, observer)?.points;
        let relaxation = Relaxation::new(&start, density.as_deref());
        let mut run = Run { method: self, observer, done: 0, relaxation };
        run.relaxation.balance(LOOSE);
        observer.iterated(0, &|| run.relaxation.points());
        let mut rounds = 0;
        loop {
            run.relax()?;
            run.descend()?;
            let regular = run.relaxation.regular_points(self.regularity);
            if regular.is_empty() || rounds == MOST_ROUNDS || run.is_spent() {
                break;
            }
            // No stream of the random points has such a number.
            run.relaxation.break_up(&regular, &mut seed.stream(u32::MAX - rounds));
            run.relaxation.balance(LOOSE);
            rounds += 1;
        }
        let balance = run.relaxation.balance(EXACT);
        let unrest = run.relaxation.unrest();
        let report = Report::new()
            .with("iterations", u64::from(run.done))
            .with("rounds", u64::from(rounds + 1))
            .with("energy", run.relaxation.energy())
            .with("unrest_d_hex", unrest.value())
            .with("residual", balance.residual)
            .with("converged", unrest <= self.tolerance && balance.converged);
        Ok(Sample::new(run.relaxation.points(), report))
    }
}

/// A run on its way.
struct Run<'a> {
    method: &'a Bnot,
    observer: &'a dyn Observer,
    done: u32,
    relaxation: Relaxation,
}

impl Run<'_> {
    fn is_spent(&self) -> bool {
        self.done >= self.method.iterations
    }

    /// Tells the observer, and counts an iteration.
    fn iterate(&mut self, step: impl FnOnce(&mut Relaxation)) -> Result<(), SampleError> {
        let (energy, unrest) = (self.relaxation.energy(), self.relaxation.unrest().value());
        let figures = [("energy", energy), ("unrest", unrest)];
        let total = Some(self.method.iterations.into());
        let progress = Progress::new("relaxing", self.done.into(), total);
        observe(self.observer, &progress.with_figures(&figures))?;
        step(&mut self.relaxation);
        self.done += 1;
        self.observer.iterated(self.done.into(), &|| self.relaxation.points());
        Ok(())
    }

    /// Moves points to centroids until they are within twice the tolerance.
    fn relax(&mut self) -> Result<(), SampleError> {
        let coarse = 2.0 * self.method.tolerance.value();
        while self.relaxation.unrest().value() > coarse && !self.is_spent() {
            self.iterate(|relaxation| {
                relaxation.advance(1.0);
                relaxation.balance(LOOSE);
            })?;
        }
        Ok(())
    }

    /// Goes down the gradient until points are within the tolerance or the cost falls no more.
    fn descend(&mut self) -> Result<(), SampleError> {
        let mut falls = true;
        self.relaxation.balance(FINE);
        while falls && self.relaxation.unrest() > self.method.tolerance && !self.is_spent() {
            self.iterate(|relaxation| falls = relaxation.descend(LONGEST, FINE))?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bn_core::Unobserved;

    fn figure(report: &Report, name: &str) -> f64 {
        match report.get(name) {
            Some(crate::FigureValue::Real(value)) => value,
            Some(crate::FigureValue::Count(count)) => count as f64,
            other => panic!("{name} is {other:?}"),
        }
    }

    #[test]
    fn cells_are_equal_and_cheap() {
        let sample = Bnot::default().sample(500, Seed::new(1), &Unobserved).expect("valid");
        assert_eq!(sample.report.get("converged"), Some(true.into()));
        assert!(figure(&sample.report, "residual") <= 1e-9);
        // The hexagonal lattice's cost, and what the original program reaches at 4096 points.
        let energy = figure(&sample.report, "energy");
        assert!(energy > 5.0 / (18.0 * 3.0_f64.sqrt()) && energy < 0.1652, "{energy}");
    }

    #[test]
    fn regular_patches_are_broken_up() {
        let tolerance = NormalizedDistance::new(2e-4);
        let patient = Bnot { tolerance, iterations: 3000, ..Bnot::default() };
        let broken = patient.sample(300, Seed::new(2), &Unobserved).expect("valid").report;
        let left = Bnot { regularity: 0.0, ..patient.clone() };
        let left = left.sample(300, Seed::new(2), &Unobserved).expect("valid").report;
        assert!(figure(&broken, "rounds") > 1.0, "{broken:?}");
        assert_eq!(figure(&left, "rounds"), 1.0);
    }

    #[test]
    fn absurd_fields_are_refused() {
        for method in [
            Bnot { tolerance: NormalizedDistance::new(f64::NAN), ..Bnot::default() },
            Bnot { regularity: -1.0, ..Bnot::default() },
        ] {
            let error = method.sample(10, Seed::new(1), &Unobserved).expect_err("absurd");
            assert!(error.is_usage());
        }
    }
}
