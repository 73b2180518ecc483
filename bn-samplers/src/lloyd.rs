//! Lloyd's method: points move to the centroids of their Voronoi cells.

use std::sync::Arc;

use bn_core::{
    DVec2, Density, DensityFunction, DensityIntegrals, NormalizedDistance, Observer, PointSet,
    Progress, Seed, torus,
};
use bn_geometry::{Triangulation, VoronoiCell, hilbert_order, voronoi_cells_into};
use rayon::prelude::*;

use crate::common_options::{DENSITY_OPTION, check_tolerance, iterations, tolerance, uneven};
use crate::error::{check_count, observe};
use crate::{CountRule, Method, PointOrder, Report, Sample, SampleError, Sampler, Stochastic};

/// Random points, each moved to the centroid of its Voronoi cell, over and over: towards a
/// centroidal Voronoi tessellation (CVT).
///
/// Every iteration lowers the energy Σ ∫ |x − xⱼ|² over the cells, ever more slowly; patches of the
/// hexagonal lattice grow meanwhile. Coordinates are rounded to multiples of 2⁻⁵⁰. Thesis p. 114;
/// S. P. Lloyd, "Least squares quantization in PCM", IEEE Trans. Inf. Theory 28(2), 1982; Q. Du, V. Faber
/// and M. Gunzburger, "Centroidal Voronoi tessellations", SIAM Rev. 41(4), 1999. O(n) an iteration but
/// for the first few.
///
/// With a density ρ, centroids are those of the mass ρ²: the cells of a tessellation that is
/// centroidal by the mass w have areas in proportion to 1/√w (A. Gersho, "Asymptotically optimal block
/// quantization", IEEE Trans. Inf. Theory 25(4), 1979), so that points are as dense as ρ says. Points
/// whose cells have no mass stay. An iteration takes time for every pixel on a cell's boundary then.
#[derive(Clone, Debug, PartialEq)]
pub struct Lloyd {
    /// The most iterations.
    pub iterations: u32,
    /// Stop when no point moves farther than this in an iteration.
    pub tolerance: NormalizedDistance,
    /// The density of the points, uniform if there is none.
    pub density: Option<Arc<DensityFunction>>,
}

impl Default for Lloyd {
    fn default() -> Self {
        Self { iterations: 1000, tolerance: NormalizedDistance::new(1e-5), density: None }
    }
}

/// The registry's entry.
pub(crate) const METHOD: Method = Method {
    name: "lloyd",
    aliases: &["cvt", "lloyd-relaxation"],
    summary: "points at the centroids of their Voronoi cells",
    page: Some(114),
    citation: "S. P. Lloyd, Least squares quantization in PCM, IEEE Trans. Inf. Theory 28(2), 1982",
    complexity: "O(n) an iteration",
    order: PointOrder::Random,
    counts: CountRule::Any,
    seeded: true,
    options: &[
        iterations("1000"),
        tolerance("1e-5", "stop when no point moves farther in an iteration"),
        DENSITY_OPTION,
    ],
    build: |options| {
        Ok(Box::new(Lloyd {
            iterations: options.count("iterations"),
            tolerance: options.distance("tolerance"),
            density: options.density("density"),
        }))
    },
    version: 2,
};

impl Sampler for Lloyd {
    fn sample(&self, n: usize, seed: Seed, observer: &dyn Observer) -> Result<Sample, SampleError> {
        check_count(METHOD.name, n)?;
        check_tolerance(self.tolerance)?;
        let mean_density = Density::new(n);
        let density = uneven(self.density.as_ref());
        let start = Stochastic { density: density.clone() }.sample(n, seed, observer)?.points;
        let mut tessellation = Tessellation::new(&start, density.as_deref());
        let (mut done, mut farthest) = (0, f64::INFINITY);
        observer.iterated(0, &|| start.points().to_vec());
        while done < self.iterations && farthest > self.tolerance.value() {
            let moved = [("moved", farthest)];
            let progress = Progress::new("relaxing", done.into(), Some(self.iterations.into()));
            observe(observer, &progress.with_figures(&moved))?;
            farthest = mean_density.normalize_distance(tessellation.relax()).value();
            done += 1;
            observer.iterated(done.into(), &|| tessellation.points());
        }
        let report = Report::new().with("iterations", u64::from(done));
        if done == 0 {
            return Ok(Sample { points: start, report });
        }
        let report =
            report.with("residual", farthest).with("converged", farthest <= self.tolerance.value());
        Ok(Sample::new(tessellation.points(), report))
    }
}

/// The points with their Voronoi cells.
struct Tessellation {
    triangulation: Triangulation,
    cells: Vec<VoronoiCell>,
    /// The index that each point had: here they are numbered along a Hilbert curve, so that
    /// neighbours on the torus are neighbours in memory.
    names: Vec<u32>,
    /// What cells are weighed by, if unevenly.
    mass: Option<DensityIntegrals>,
}

/// Cells that one task weighs.
const CHUNK: usize = 256;

impl Tessellation {
    fn new(points: &PointSet, density: Option<&DensityFunction>) -> Self {
        let names = hilbert_order(points.points());
        let along = names.iter().map(|&name| points.points()[name as usize]).collect();
        let along = PointSet::new(along).expect("points of a set");
        let mass = density.map(|density| {
            let squared = density.map(|value| value * value);
            DensityIntegrals::new(&squared.expect("squares of densities of mean 1"))
        });
        Self { triangulation: Triangulation::new(&along), cells: Vec::new(), names, mass }
    }

    /// One iteration; returns the longest way that a point moved. Points that coincide stay
    /// together.
    fn relax(&mut self) -> f64 {
        match &self.mass {
            None => voronoi_cells_into(&self.triangulation, &mut self.cells),
            Some(mass) => weigh_cells(&self.triangulation, mass, &mut self.cells),
        }
        let mut longest = 0.0_f64;
        self.triangulation.relocate_all(|point, p| {
            let way = self.cells[point].to_centroid;
            longest = longest.max(way.length_squared());
            torus::wrap_point(p + way)
        });
        longest.sqrt()
    }

    fn points(&self) -> Vec<DVec2> {
        let mut points = vec![DVec2::ZERO; self.names.len()];
        for (point, &name) in self.names.iter().enumerate() {
            points[name as usize] = self.triangulation.position(point);
        }
        points
    }
}

/// The Voronoi cells by mass.
fn weigh_cells(
    triangulation: &Triangulation,
    mass: &DensityIntegrals,
    cells: &mut Vec<VoronoiCell>,
) {
    cells.clear();
    cells.resize(triangulation.index_bound(), VoronoiCell::EMPTY);
    cells.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, cells)| {
        let mut corners = Vec::new();
        for (point, cell) in (chunk * CHUNK..).zip(cells) {
            if triangulation.representative(point) == point {
                corners.clear();
                corners.extend(triangulation.cell_corners(point));
                let place = triangulation.position(point);
                *cell = VoronoiCell::of_moments(&mass.over_polygon(place, &corners));
            }
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use bn_core::Unobserved;
    use bn_geometry::Spacing;

    /// The energy of the tessellation.
    fn energy(points: &PointSet) -> f64 {
        let mut cells = Vec::new();
        voronoi_cells_into(&Triangulation::new(points), &mut cells);
        cells.iter().map(|cell| cell.second_moment).sum()
    }

    #[test]
    fn the_energy_falls() {
        let start = Stochastic::default().sample(200, Seed::new(4), &Unobserved).expect("valid");
        let mut tessellation = Tessellation::new(&start.points, None);
        let mut before = energy(&start.points);
        for _ in 0..50 {
            tessellation.relax();
            let after = energy(&PointSet::new(tessellation.points()).expect("valid"));
            assert!(after <= before * (1.0 + 1e-12), "{after} after {before}");
            before = after;
        }
        // The hexagonal lattice's 5/(18√3 n) is the least energy possible.
        let least = 5.0 / (18.0 * 3.0_f64.sqrt() * 200.0);
        assert!(before > least && before < 1.06 * least, "{before} against {least}");
    }

    /// Points that move in place end where a tessellation built anew in each iteration puts them.
    #[test]
    fn iterations_are_exact() {
        let start = Stochastic::default().sample(300, Seed::new(5), &Unobserved).expect("valid");
        let mut tessellation = Tessellation::new(&start.points, None);
        for _ in 0..60 {
            let before = PointSet::new(tessellation.points()).expect("valid");
            let mut cells = Vec::new();
            voronoi_cells_into(&Triangulation::new(&before), &mut cells);
            tessellation.relax();
            let places = before.points().iter().zip(&cells).zip(tessellation.points());
            for ((&p, cell), q) in places {
                let want = torus::wrap_point(p + cell.to_centroid);
                assert!(torus::distance(want, q) < 1e-14, "{want} {q}");
            }
        }
    }

    #[test]
    fn lattices_are_fixed_points() {
        let grid: Vec<DVec2> = (0..64)
            .map(|i| DVec2::new(f64::from(i % 8) + 0.5, f64::from(i / 8) + 0.5) / 8.0)
            .collect();
        let mut tessellation = Tessellation::new(&PointSet::new(grid).expect("valid"), None);
        assert!(tessellation.relax() < 1e-15);
        let relaxed = PointSet::new(tessellation.points()).expect("valid");
        assert!((Spacing::new(&relaxed).min() - 0.125).abs() < 1e-14);
    }

    #[test]
    fn stops_when_converged() {
        let tolerance = NormalizedDistance::new(1e-3);
        let method = Lloyd { iterations: 100_000, tolerance, density: None };
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
