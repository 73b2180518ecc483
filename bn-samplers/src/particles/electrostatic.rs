//! Electrostatic halftoning.

use std::sync::Arc;

use bn_core::{DVec2, DensityFunction, Observer, PointSet, Progress, Seed, torus};
use rand::RngExt;

use super::ewald::CoulombForces;
use crate::common_options::{DENSITY_OPTION, check_range, uneven};
use crate::error::{check_count, observe};
use crate::{
    CountRule, DefaultValue, Method, OptionKind, OptionSpec, PointOrder, Report, Sample,
    SampleError, Sampler, Stochastic,
};

/// Random points that repel each other as equal charges do, on a grey background that attracts
/// them, evenly or by a density, disturbed by a force field that keeps them from settling into a lattice.
///
/// Thesis p. 112 (for constant grey); C. Schmaltz, P. Gwosdek, A. Bruhn and J. Weickert, "Electrostatic
/// halftoning", Computer Graphics Forum 29(8), 2010, with periodic boundaries. Each
/// iteration moves all particles along the forces on them; in the first half of the iterations
/// they are shaken, less and less. Forces take O(n log n): those of near particles pair by pair,
/// those of far ones by Fourier transforms, together exact to 10⁻⁵ of the force of a neighbour.
///
/// With a density, steps, shaking and field are in proportion to the spacing that it makes nearby, and
/// details finer than about half a spacing are blurred. Where most points crowd in less than a
/// sixteenth of the torus, pairs of near particles take longer than O(n).
#[derive(Clone, Debug, PartialEq)]
pub struct Electrostatic {
    /// Strength of the random force field, from 0 to 10: a typical force, in units of the force
    /// between two particles at the mean spacing 1/√n.
    pub field: f64,
    /// Strength of the shaking, from 0 to 10: the largest displacement of the first one, in mean
    /// spacings.
    pub shaking: f64,
    /// Iterations at most, up to 10,000: fewer if the particles come to rest.
    pub iterations: u32,
    /// The density of the points, uniform if there is none.
    pub density: Option<Arc<DensityFunction>>,
}

impl Default for Electrostatic {
    fn default() -> Self {
        Self { field: 0.11, shaking: 0.1, iterations: 200, density: None }
    }
}

/// The registry's entry.
pub(crate) const METHOD: Method = Method {
    name: "electrostatic",
    aliases: &["electrostatic-halftoning", "halftoning"],
    summary: "repelling charges in a random force field",
    page: Some(112),
    citation: "C. Schmaltz et al., Electrostatic halftoning, Comput. Graph. Forum 29(8), 2010",
    complexity: "O(n log n) per iteration",
    order: PointOrder::Random,
    counts: CountRule::Any,
    seeded: true,
    options: &[
        OptionSpec {
            name: "field",
            kind: OptionKind::Real { min: 0.0, max: STRONGEST },
            default: DefaultValue::Value("0.11"),
            help: "strength of the random force field that prevents lattices",
            unit: "force between neighbours",
        },
        OptionSpec {
            name: "shaking",
            kind: OptionKind::Real { min: 0.0, max: STRONGEST },
            default: DefaultValue::Value("0.1"),
            help: "largest displacement of the first of the decreasing shakes",
            unit: "1/√n",
        },
        OptionSpec {
            name: "iterations",
            kind: OptionKind::Integer { min: 0, max: MOST },
            default: DefaultValue::Value("200"),
            help: "steps along the forces",
            unit: "",
        },
        DENSITY_OPTION,
    ],
    build: |options| {
        Ok(Box::new(Electrostatic {
            field: options.number("field"),
            shaking: options.number("shaking"),
            iterations: options.count("iterations"),
            density: options.density("density"),
        }))
    },
    version: 1,
};

const STRONGEST: f64 = 10.0;
const MOST: u64 = 10_000;

/// Iterations between two shakes.
const SHAKE_EVERY: u32 = 10;

/// The farthest that a particle moves in one iteration, in mean spacings.
const LONGEST_STEP: f64 = 0.1;

/// The random streams after those of the points.
const FIELD_STREAM: u32 = 1 << 31;
const SHAKE_STREAM: u32 = FIELD_STREAM + 1;

impl Sampler for Electrostatic {
    fn sample(&self, n: usize, seed: Seed, observer: &dyn Observer) -> Result<Sample, SampleError> {
        check_count(METHOD.name, n)?;
        self.check()?;
        let spacing = 1.0 / (n as f64).sqrt();
        let field = Field::new(n, self.field / spacing, seed);
        let density = uneven(self.density.as_ref());
        let mut coulomb = CoulombForces::new(n, density.as_deref())?;
        let mut places = Stochastic { density }.sample(n, seed, observer)?.points.into_points();
        let (mut iterations, mut residual) = (0, f64::INFINITY);
        observer.iterated(0, &|| places.clone());
        while iterations < self.iterations {
            let total = u64::from(self.iterations);
            observe(observer, &Progress::new("repelling", iterations.into(), Some(total)))?;
            let points = PointSet::new(places).expect("points of the unit torus");
            let forces = coulomb.at(&points);
            places = points.into_points();
            let crowding = |p| coulomb.crowding(p);
            residual = advance(&mut places, &forces, &field, spacing, crowding);
            // Ever less, down to none half way.
            let rest = 1.0 - 2.0 * f64::from(iterations) / f64::from(self.iterations);
            if rest > 0.0 && iterations.is_multiple_of(SHAKE_EVERY) {
                shake(&mut places, self.shaking * rest * spacing, seed, iterations, crowding);
            }
            iterations += 1;
            observer.iterated(iterations.into(), &|| places.clone());
            if rest <= 0.0 && residual < AT_REST {
                break;
            }
        }
        let report = Report::new()
            .with("iterations", u64::from(iterations))
            .with("last_step_spacings", residual);
        Ok(Sample::new(places, report))
    }
}

/// Length of a step, relative to the longest that is stable.
const STEP: f64 = 0.8;

/// Root mean square of the steps in mean spacings below which particles are at rest.
const AT_REST: f64 = 1e-6;

impl Electrostatic {
    fn check(&self) -> Result<(), SampleError> {
        check_range("field", self.field, 0.0, STRONGEST)?;
        check_range("shaking", self.shaking, 0.0, STRONGEST)?;
        check_range("iterations", self.iterations.into(), 0.0, MOST as f64)
    }
}

/// Moves the particles along the forces; the root mean square of the steps, in spacings. These are
/// the smaller the more particles are crowded.
fn advance(
    places: &mut [DVec2],
    forces: &[DVec2],
    field: &Field,
    spacing: f64,
    crowding: impl Fn(DVec2) -> f64,
) -> f64 {
    // −ΔΦ = −2πnρ where no charge is, a particle's own share of the potential's curvature: no mode
    // of motion has more, so steps up to 2/(2πnρ) of the force are stable.
    let step = STEP * spacing * spacing / std::f64::consts::PI;
    let mut sum = 0.0;
    for (p, &force) in places.iter_mut().zip(forces) {
        let crowding = crowding(*p);
        let shrink = crowding.sqrt();
        let shift = step / crowding * (force + shrink * field.at(*p));
        let shift = shift.clamp_length_max(LONGEST_STEP * spacing / shrink);
        sum += shift.length_squared() * crowding;
        *p = torus::wrap_point(*p + shift);
    }
    (sum / places.len() as f64).sqrt() / spacing
}

/// Moves each particle by up to `length` along each axis, less where they are crowded.
fn shake(
    points: &mut [DVec2],
    length: f64,
    seed: Seed,
    iteration: u32,
    crowding: impl Fn(DVec2) -> f64,
) {
    let mut rng = seed.stream(SHAKE_STREAM + iteration / SHAKE_EVERY);
    for p in points {
        let direction = DVec2::new(rng.random(), rng.random()) * 2.0 - 1.0;
        *p = torus::wrap_point(*p + length / crowding(*p).sqrt() * direction);
    }
}

/// A random force field: vectors at the corners of square cells of about the mean spacing, in
/// between interpolated.
struct Field {
    side: usize,
    corners: Vec<DVec2>,
}

impl Field {
    /// A field for `n` points whose components are uniform with a root mean square of `strength`
    /// at the corners.
    fn new(n: usize, strength: f64, seed: Seed) -> Self {
        let side = n.isqrt().max(1);
        let mut rng = seed.stream(FIELD_STREAM);
        let mut component = || (2.0 * rng.random::<f64>() - 1.0) * strength * 3.0_f64.sqrt();
        let corners = (0..side * side).map(|_| DVec2::new(component(), component())).collect();
        Self { side, corners }
    }

    /// The force at a place of [0, 1)².
    fn at(&self, p: DVec2) -> DVec2 {
        let place = p * self.side as f64;
        let cell = place.floor();
        let within = place - cell;
        // A coordinate just below 1 may be rounded to the side itself.
        let corner = |right: usize, up: usize| {
            let (column, row) = (cell.x as usize + right, cell.y as usize + up);
            self.corners[row % self.side * self.side + column % self.side]
        };
        let along = |up| corner(0, up).lerp(corner(1, up), within.x);
        along(0).lerp(along(1), within.y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bn_core::Unobserved;

    /// Undisturbed charges end where their forces vanish: two of them half a period apart.
    #[test]
    fn two_charges_flee_to_the_far_corner() {
        let method =
            Electrostatic { field: 0.0, shaking: 0.0, iterations: 2000, ..Default::default() };
        for seed in 0..20 {
            let points = method.sample(2, Seed::new(seed), &Unobserved).expect("valid").points;
            let distance = torus::distance(points.points()[0], points.points()[1]);
            assert!((distance - torus::DIAMETER).abs() < 1e-5, "{distance}");
        }
    }

    #[test]
    fn fields_are_continuous_and_as_strong_as_asked() {
        let field = Field::new(10_000, 3.0, Seed::new(1));
        let squares = field.corners.iter().map(|corner| corner.length_squared());
        let mean = squares.sum::<f64>() / field.corners.len() as f64;
        // Twice 3²; the variance of a squared uniform number is 4/5 of its squared mean.
        assert!((mean / 18.0 - 1.0).abs() < 5.0 * (0.8 / 20_000.0_f64).sqrt(), "{mean}");
        for i in 0..100 {
            let edge = DVec2::new(f64::from(i) / 100.0, 0.37);
            let before = torus::wrap_point(edge - DVec2::new(1e-12, 0.0));
            // The slope is at most 2·√3·3 over a cell of 1/100.
            assert!((field.at(edge) - field.at(before)).length() < 1e-8);
        }
    }
}
