//! Lloyd's method: points move to the centroids of their Voronoi cells.

use bn_core::{Density, NormalizedDistance, Observer, PointSet, Progress, Seed, torus};
use bn_geometry::{Triangulation, VoronoiCell, voronoi_cells_into};

use crate::error::{check_count, observe};
use crate::{
    CountRule, DefaultValue, Method, OptionKind, OptionSpec, PointOrder, Report, Sample,
    SampleError, Sampler, Stochastic,
};

/// Random points, each moved to the centroid of its Voronoi cell, over and over: towards a
/// centroidal Voronoi tessellation (CVT).
///
/// Every iteration lowers the energy Σ ∫ |x − xⱼ|² over the cells, ever more slowly; patches of the
/// hexagonal lattice grow meanwhile. Thesis p. 114; S. P. Lloyd, "Least squares quantization in
/// PCM", IEEE Trans. Inf. Theory 28(2), 1982; Q. Du, V. Faber and M. Gunzburger, "Centroidal Voronoi
/// tessellations", SIAM Rev. 41(4), 1999. O(n log n) an iteration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lloyd {
    /// The most iterations.
    pub iterations: u32,
    /// Stop when no point moves farther than this in an iteration.
    pub tolerance: NormalizedDistance,
}

impl Default for Lloyd {
    fn default() -> Self {
        Self { iterations: 1000, tolerance: NormalizedDistance::new(1e-5) }
    }
}

/// The registry's entry.
pub(crate) const METHOD: Method = Method {
    name: "lloyd",
    aliases: &["cvt", "lloyd-relaxation"],
    summary: "points at the centroids of their Voronoi cells",
    page: Some(114),
    citation: "S. P. Lloyd, Least squares quantization in PCM, IEEE Trans. Inf. Theory 28(2), 1982",
    complexity: "O(n log n) an iteration",
    order: PointOrder::Random,
    counts: CountRule::Any,
    seeded: true,
    options: &[
        OptionSpec {
            name: "iterations",
            kind: OptionKind::Integer { min: 0, max: MOST_ITERATIONS },
            default: DefaultValue::Value("1000"),
            help: "the most iterations",
            unit: "",
        },
        OptionSpec {
            name: "tolerance",
            kind: OptionKind::Real { min: 0.0, max: 1.0 },
            default: DefaultValue::Value("1e-5"),
            help: "stop when no point moves farther in an iteration",
            unit: "d_hex",
        },
    ],
    build: |options| {
        let defaults = Lloyd::default();
        let iterations = options.integer("iterations");
        let tolerance = options.real("tolerance").map(NormalizedDistance::new);
        Ok(Box::new(Lloyd {
            // The option's range ends below 2³².
            iterations: iterations.map_or(defaults.iterations, |count| count as u32),
            tolerance: tolerance.unwrap_or(defaults.tolerance),
        }))
    },
    version: 1,
};

const MOST_ITERATIONS: u64 = 1_000_000;

impl Sampler for Lloyd {
    fn sample(&self, n: usize, seed: Seed, observer: &dyn Observer) -> Result<Sample, SampleError> {
        check_count(METHOD.name, n)?;
        if !(0.0..f64::INFINITY).contains(&self.tolerance.value()) {
            let reason = format!("{} is not a distance", self.tolerance);
            return Err(SampleError::InvalidOption { option: "tolerance", reason });
        }
        let density = Density::new(n);
        let mut points = Stochastic::default().sample(n, seed, observer)?.points;
        let mut cells = Vec::new();
        let (mut done, mut farthest) = (0, f64::INFINITY);
        observer.iterated(0, &|| points.points().to_vec());
        while done < self.iterations && farthest > self.tolerance.value() {
            let moved = [("moved", farthest)];
            let progress = Progress::new("relaxing", done.into(), Some(self.iterations.into()));
            observe(observer, &progress.with_figures(&moved))?;
            let step;
            (points, step) = relax(points, &mut cells);
            farthest = density.normalize_distance(step).value();
            done += 1;
            observer.iterated(done.into(), &|| points.points().to_vec());
        }
        let mut report = Report::new().with("iterations", u64::from(done));
        if done > 0 {
            report = report
                .with("residual", farthest)
                .with("converged", farthest <= self.tolerance.value());
        }
        Ok(Sample { points, report })
    }
}

/// One iteration, and the longest way that a point moved. Points that coincide stay together.
fn relax(points: PointSet, cells: &mut Vec<VoronoiCell>) -> (PointSet, f64) {
    let triangulation = Triangulation::new(&points);
    voronoi_cells_into(&triangulation, cells);
    let mut points = points.into_points();
    let mut longest = 0.0_f64;
    for (i, p) in points.iter_mut().enumerate() {
        let to_centroid = cells[triangulation.representative(i)].to_centroid;
        longest = longest.max(to_centroid.length_squared());
        *p = torus::wrap_point(*p + to_centroid);
    }
    (PointSet::new(points).expect("wrapped centroids are on the torus"), longest.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use bn_core::{DVec2, Unobserved};
    use bn_geometry::Spacing;

    /// The energy of the tessellation.
    fn energy(points: &PointSet) -> f64 {
        let mut cells = Vec::new();
        voronoi_cells_into(&Triangulation::new(points), &mut cells);
        cells.iter().map(|cell| cell.second_moment).sum()
    }

    #[test]
    fn the_energy_falls() {
        let mut points =
            Stochastic::default().sample(200, Seed::new(4), &Unobserved).expect("valid").points;
        let mut before = energy(&points);
        for _ in 0..50 {
            points = relax(points, &mut Vec::new()).0;
            let after = energy(&points);
            assert!(after <= before * (1.0 + 1e-12), "{after} after {before}");
            before = after;
        }
        // The hexagonal lattice's 5/(18√3 n) is the least energy possible.
        let least = 5.0 / (18.0 * 3.0_f64.sqrt() * 200.0);
        assert!(before > least && before < 1.06 * least, "{before} against {least}");
    }

    #[test]
    fn lattices_are_fixed_points() {
        let grid: Vec<DVec2> = (0..64)
            .map(|i| DVec2::new(f64::from(i % 8) + 0.5, f64::from(i / 8) + 0.5) / 8.0)
            .collect();
        let set = PointSet::new(grid).expect("valid");
        let (relaxed, moved) = relax(set.clone(), &mut Vec::new());
        assert!(moved < 1e-15);
        assert!((Spacing::new(&relaxed).min() - 0.125).abs() < 1e-14);
    }

    #[test]
    fn stops_when_converged() {
        let method = Lloyd { iterations: 100_000, tolerance: NormalizedDistance::new(1e-3) };
        let report = method.sample(16, Seed::new(1), &Unobserved).expect("valid").report;
        assert_eq!(report.get("converged"), Some(true.into()));
        let none = Lloyd { iterations: 0, ..method };
        let start = none.sample(16, Seed::new(1), &Unobserved).expect("valid").points;
        assert_eq!(
            start,
            Stochastic::default().sample(16, Seed::new(1), &Unobserved).expect("valid").points
        );
    }
}
