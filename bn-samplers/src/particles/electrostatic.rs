//! Electrostatic halftoning of a constant grey.

use bn_core::{DVec2, Observer, PointSet, Progress, Seed, torus};
use rand::RngExt;

use super::ewald::CoulombForces;
use crate::error::{check_count, observe};
use crate::stochastic::uniform_points;
use crate::{
    CountRule, DefaultValue, Method, OptionKind, OptionSpec, PointOrder, Report, Sample,
    SampleError, Sampler,
};

/// Random points that repel each other as equal charges do, on a background that attracts them
/// evenly, disturbed by a force field that keeps them from settling into a lattice.
///
/// Thesis p. 112; C. Schmaltz, P. Gwosdek, A. Bruhn and J. Weickert, "Electrostatic halftoning",
/// Computer Graphics Forum 29(8), 2010, for constant grey and with periodic boundaries. Each
/// iteration moves all particles along the forces on them; in the first half of the iterations
/// they are shaken, less and less. Forces take O(n log n): those of near particles pair by pair,
/// those of far ones by Fourier transforms, together exact to 10⁻⁵ of the force of a neighbour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Electrostatic {
    /// Strength of the random force field, from 0 to 10: a typical force, in units of the force
    /// between two particles at the mean spacing 1/√n.
    pub field: f64,
    /// Strength of the shaking, from 0 to 10: the largest displacement of the first one, in mean
    /// spacings.
    pub shaking: f64,
    /// Iterations at most, up to 10,000: fewer if the particles come to rest.
    pub iterations: u32,
}

impl Default for Electrostatic {
    fn default() -> Self {
        Self { field: 0.11, shaking: 0.1, iterations: 200 }
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
    ],
    build: |options| {
        let defaults = Electrostatic::default();
        Ok(Box::new(Electrostatic {
            field: options.real("field").unwrap_or(defaults.field),
            shaking: options.real("shaking").unwrap_or(defaults.shaking),
            iterations: options.integer("iterations").map_or(defaults.iterations, |i| i as u32),
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
        let mut forces = CoulombForces::new(n)?;
        let mut places = uniform_points(n, seed, 0)?;
        let (mut iterations, mut residual) = (0, f64::INFINITY);
        while iterations < self.iterations {
            let total = u64::from(self.iterations);
            observe(observer, &Progress::new("repelling", iterations.into(), Some(total)))?;
            let points = PointSet::new(places).expect("points of the unit torus");
            let forces = forces.at(&points);
            places = points.into_points();
            residual = advance(&mut places, &forces, &field, spacing);
            // Ever less, down to none half way.
            let rest = 1.0 - 2.0 * f64::from(iterations) / f64::from(self.iterations);
            if rest > 0.0 && iterations.is_multiple_of(SHAKE_EVERY) {
                shake(&mut places, self.shaking * rest * spacing, seed, iterations);
            }
            iterations += 1;
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
        for (option, value) in [("field", self.field), ("shaking", self.shaking)] {
            if !(0.0..=STRONGEST).contains(&value) {
                let reason = format!("{value} is not a number from 0 to {STRONGEST}");
                return Err(SampleError::InvalidOption { option, reason });
            }
        }
        if u64::from(self.iterations) > MOST {
            let reason = format!("{} is more than {MOST}", self.iterations);
            return Err(SampleError::InvalidOption { option: "iterations", reason });
        }
        Ok(())
    }
}

/// Moves the particles along the forces; the root mean square of the steps, in spacings.
fn advance(places: &mut [DVec2], forces: &[DVec2], field: &Field, spacing: f64) -> f64 {
    // −ΔΦ = −2πn where no charge is, a particle's own share of the potential's curvature: no mode
    // of motion has more, so steps up to 2/(2πn) of the force are stable.
    let step = STEP * spacing * spacing / std::f64::consts::PI;
    let mut sum = 0.0;
    for (p, &force) in places.iter_mut().zip(forces) {
        let shift = step * (force + field.at(*p));
        let shift = shift.clamp_length_max(LONGEST_STEP * spacing);
        sum += shift.length_squared();
        *p = torus::wrap_point(*p + shift);
    }
    (sum / places.len() as f64).sqrt() / spacing
}

/// Moves each particle by up to `length` along each axis.
fn shake(points: &mut [DVec2], length: f64, seed: Seed, iteration: u32) {
    let mut rng = seed.stream(SHAKE_STREAM + iteration / SHAKE_EVERY);
    for p in points {
        let direction = DVec2::new(rng.random(), rng.random()) * 2.0 - 1.0;
        *p = torus::wrap_point(*p + length * direction);
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
        let method = Electrostatic { field: 0.0, shaking: 0.0, iterations: 2000 };
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
