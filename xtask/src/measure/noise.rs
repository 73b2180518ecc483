//! The noise of sampled waves: predicted from the patterns' spectra and measured (thesis figure 3.6).

use bn_cli::{Failure, Outcome};
use bn_core::{DVec2, PointSet};
use bn_render::{
    Frame, Image, ImageSpectrum, Kernel, KernelTable, KernelTransfer, Normalization, Pattern,
    PatternPower, PlaneWave, PlaneWaves, Prediction, Renderer, Scene as _,
};
use bn_spectral::{HalfPlane, Nufft, NufftOptions};

/// The amplitude of the waves, about a mean of 0.
const AMPLITUDE: f64 = 0.5;

/// Samples per pixel: not 1, where the cells of a jittered grid of 4096 points are the pixels, and the
/// noise is not what it is on the average over all places.
pub(crate) const RATE: f64 = 1.1;

/// The direction of the waves' frequency: no axis, no diagonal.
const DIRECTION: DVec2 = DVec2::new(0.8, 0.6);

/// Variances of the pixels about the noiseless image.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Noise {
    pub(crate) predicted: f64,
    pub(crate) measured: f64,
}

impl Noise {
    /// Predicted over measured in dB.
    pub(crate) fn difference_db(&self) -> f64 {
        10.0 * libm::log10(self.predicted / self.measured)
    }
}

/// Sets of a method and their mean spectrum.
pub(crate) struct Sampled<'a> {
    sets: &'a [PointSet],
    pub(crate) power: PatternPower,
}

impl<'a> Sampled<'a> {
    /// The sets, their spectrum up to 4√n.
    pub(crate) fn new(sets: &'a [PointSet]) -> Outcome<Self> {
        let points = sets[0].len();
        let power = PatternPower::of(sets, 4 * (points as f64).sqrt().round() as usize);
        Ok(Self { sets, power: power.map_err(Failure::failed)? })
    }

    /// The noise of a wave of `frequency`, in √n, after plain convolution with `kernel` on a square of
    /// `side` pixels.
    pub(crate) fn noise(&self, frequency: f64, kernel: &dyn Kernel, side: u32) -> Outcome<Noise> {
        let frame = Frame::new(side, side).map_err(Failure::failed)?;
        let table = KernelTable::new(kernel);
        let frequency = DIRECTION * frequency * RATE.sqrt();
        let gain = KernelTransfer::new(kernel, frequency.length()).response(frequency);
        let mut measured = 0.0;
        for (i, set) in self.sets.iter().enumerate() {
            // Each set meets the wave in another phase, unless it is a constant.
            let phase =
                if frequency == DVec2::ZERO { 0.0 } else { i as f64 / self.sets.len() as f64 };
            let scene = wave(frequency, phase);
            let pattern = Pattern::tiled(set, RATE).map_err(Failure::failed)?;
            let renderer = Renderer::new(&scene, &pattern, &table, Normalization::None, &frame);
            let image = renderer.image().map_err(Failure::failed)?.0;
            measured += mean_square_about(&image, |at| gain * scene.value(at)[0]);
        }
        let prediction = Prediction::new(&self.power, RATE).map_err(Failure::failed)?;
        let spectrum = ImageSpectrum::of_waves(&wave(frequency, 0.0));
        Ok(Noise {
            predicted: prediction.noise(&spectrum, kernel),
            measured: measured / self.sets.len() as f64,
        })
    }

    /// ε over |ν| in √n, ring by ring of two modes, predicted and measured, up to `highest`; of a wave
    /// whose frequency is the mode nearest to `frequency`, in √n. Over the wave's power and the rate: 1
    /// for stochastic sampling.
    pub(crate) fn spectra(&self, frequency: f64, highest: f64) -> Outcome<[Vec<[f64; 2]>; 2]> {
        let points = self.power.points();
        let unit = (points as f64).sqrt();
        let limit = (highest * unit).round() as usize;
        let mode = (DIRECTION * frequency * unit).round();
        let mut predicted = Rings::new(limit);
        let mut found = Rings::new(limit);
        let signal = [mode, -mode];
        // A constant's lines coincide.
        let power = AMPLITUDE * AMPLITUDE * if mode == DVec2::ZERO { 1.0 } else { 0.5 };
        let share = power * points as f64;
        for k in modes(limit).filter(|k| !signal.contains(k)) {
            let shifted = signal.map(|f| {
                let k = k - f;
                self.power.power(k.x as i64, k.y as i64)
            });
            predicted.add(k, 0.5 * (shifted[0] + shifted[1]));
        }
        let mut plan: Nufft = NufftOptions::new(limit, 1e-6).plan().map_err(Failure::failed)?;
        let mut spectrum = HalfPlane::zeros(limit);
        for set in self.sets {
            let turns = |p: &DVec2| std::f64::consts::TAU * mode.dot(*p);
            let values: Vec<f64> =
                set.points().iter().map(|p| AMPLITUDE * libm::cos(turns(p))).collect();
            plan.points_to_modes(set.points(), Some(&values), &mut spectrum);
            for k in modes(limit).filter(|k| !signal.contains(k)) {
                let value = spectrum.get(k.x as i64, k.y as i64).norm_sqr();
                found.add(k, value / share);
            }
        }
        Ok([predicted.means(unit), found.means(unit)])
    }
}

/// The mean square of what a grey image is off from `exact`, a function of the pixels' centres.
fn mean_square_about(image: &Image, exact: impl Fn(DVec2) -> f64) -> f64 {
    let place = |i: usize| {
        let (x, y) = (i % image.width() as usize, i / image.width() as usize);
        DVec2::new(x as f64 + 0.5, y as f64 + 0.5)
    };
    let values = image.values().iter().enumerate();
    let squares = values.map(|(i, &value)| (f64::from(value) - exact(place(i))).powi(2));
    squares.sum::<f64>() / image.values().len() as f64
}

/// The wave of `frequency` cycles per pixel.
fn wave(frequency: DVec2, phase_turns: f64) -> PlaneWaves {
    PlaneWaves::new(0.0, vec![PlaneWave { amplitude: AMPLITUDE, frequency, phase_turns }])
}

/// All modes with |kx|, |ky| ≤ limit.
fn modes(limit: usize) -> impl Iterator<Item = DVec2> {
    let side = -(limit as i64)..=limit as i64;
    side.clone().flat_map(move |y| side.clone().map(move |x| DVec2::new(x as f64, y as f64)))
}

/// Means over rings that are two modes wide.
struct Rings {
    sums: Vec<(f64, u32)>,
}

impl Rings {
    fn new(limit: usize) -> Self {
        Self { sums: vec![(0.0, 0); limit / 2] }
    }

    fn add(&mut self, k: DVec2, value: f64) {
        if let Some((sum, count)) = self.sums.get_mut((k.length() / 2.0) as usize) {
            *sum += value;
            *count += 1;
        }
    }

    fn means(&self, unit: f64) -> Vec<[f64; 2]> {
        let mean = |(i, &(sum, count)): (usize, &(f64, u32))| {
            [(2 * i + 1) as f64 / unit, sum / f64::from(count)]
        };
        self.sums.iter().enumerate().map(mean).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bn_core::{Seed, Unobserved};
    use rayon::prelude::*;

    fn sets(method: &str, n: usize) -> Vec<PointSet> {
        let sampler = bn_samplers::find(method).expect("a method").with_options([]);
        let sampler = sampler.expect("defaults are valid");
        let one = |i: u32| {
            let seed = Seed::new(1).for_set(i);
            sampler.sample(n, seed, &Unobserved).expect("a set").points
        };
        (0..10).into_par_iter().map(one).collect()
    }

    /// Within 1 dB at each f > 0, plain convolution, ensembles of 10. The frequencies 0.1 to
    /// 0.7 both in √n and in 2√n, the figure's unit.
    #[test]
    fn predicted_noise_is_the_measured_one() {
        let lanczos = bn_render::kernel("lanczos2").expect("in the list");
        for method in ["jittered", "fpo", "cccvt", "step"] {
            let sets = sets(method, 256);
            let sampled = Sampled::new(&sets).expect("small");
            for frequency in [0.1, 0.3, 0.5, 0.7, 0.2, 0.6, 1.0, 1.4] {
                let noise = sampled.noise(frequency, lanczos, 96).expect("small");
                let off = noise.difference_db();
                assert!(off.abs() < 1.0, "{method} at {frequency}: {off} dB, {noise:?}");
            }
            // Constants too, by (3.16): (3.19) would be 3 dB low.
            let flat = sampled.noise(0.0, lanczos, 96).expect("small").difference_db();
            assert!(flat.abs() < 1.0, "{method}: {flat} dB");
        }
    }

    #[test]
    fn predicted_spectra_are_the_measured_ones() {
        let sets = sets("fpo", 256);
        let sampled = Sampled::new(&sets).expect("small");
        for frequency in [0.0, 0.2, 1.0] {
            let [predicted, found] = sampled.spectra(frequency, 2.0).expect("small");
            assert_eq!(predicted.len(), found.len());
            for (want, got) in predicted.iter().zip(&found).skip(2) {
                // Cross terms between the two copies: rings of 20 modes and more in 10 sets.
                let tolerance = 0.4 * want[1] + 0.02;
                assert!((got[1] - want[1]).abs() < tolerance, "{frequency}: {got:?} {want:?}");
            }
        }
    }
}
