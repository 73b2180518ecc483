//! Fourier sums Σ gₖ e^{2πi α k j} on any lattice, by Bluestein's chirp transform.

use std::sync::Arc;

use bn_fft::Complex;
use bn_fft::num_traits::Zero;
use bn_fft::{Fft, Planner};

type C64 = Complex<f64>;

/// e^{iπαk²} for k = 0, 1, … below `count`, with αk² reduced modulo 2 without loss: a fused product
/// gives its rounding error.
pub fn chirps(alpha: f64, count: usize) -> Vec<C64> {
    let chirp = |k: usize| {
        let square = k as f64 * k as f64;
        let product = alpha * square;
        let lost = alpha.mul_add(square, -product);
        let turns = (product - 2.0 * (product / 2.0).round()) + lost;
        let (sin, cos) = libm::sincos(std::f64::consts::PI * turns);
        C64::new(cos, sin)
    };
    (0..count).map(chirp).collect()
}

/// Sums over k in `first_input..… + inputs` for j in `first_output..… + outputs`, as
/// kj = (k² + j² − (j − k)²)/2 turns them into a convolution (Bluestein 1970).
///
/// [`convolve`](Self::convolve) leaves out the factor [`output_chirp`](Self::output_chirp), which
/// is common to all sums for the same j. Rounding error about 1e-15·log(length)·Σ|g|.
pub struct ChirpPlan {
    inputs: Vec<C64>,
    outputs: Vec<C64>,
    /// Transform of the conjugate chirp over the differences j − k, over the length.
    filter: Vec<C64>,
    forward: Arc<dyn Fft<f64>>,
    inverse: Arc<dyn Fft<f64>>,
}

impl ChirpPlan {
    /// The plan for the α whose [`chirps`] are given, up to the largest index among inputs and
    /// outputs.
    pub fn new(
        chirps: &[C64],
        (first_input, inputs): (usize, usize),
        (first_output, outputs): (usize, usize),
        planner: &mut Planner<f64>,
    ) -> Self {
        let length = fast_length(inputs + outputs - 1);
        let mut filter = vec![C64::zero(); length];
        // The difference that stands at d is first_output + d − last_input, so that the output
        // j of the convolution, counted from first_output, is found at inputs − 1 + j.
        let last_input = first_input + inputs - 1;
        for (d, value) in filter.iter_mut().enumerate().take(inputs + outputs - 1) {
            *value = chirps[(first_output + d).abs_diff(last_input)].conj() / length as f64;
        }
        let forward = planner.forward(length);
        let inverse = planner.inverse(length);
        forward.process(&mut filter);
        let inputs = chirps[first_input..first_input + inputs].to_vec();
        let outputs = chirps[first_output..first_output + outputs].to_vec();
        Self { inputs, outputs, filter, forward, inverse }
    }

    /// Numbers that `buffer` must hold.
    pub fn length(&self) -> usize {
        self.filter.len()
    }

    /// Numbers that `scratch` must hold at least.
    pub fn scratch_length(&self) -> usize {
        self.forward.get_inplace_scratch_len().max(self.inverse.get_inplace_scratch_len())
    }

    /// e^{iπαj²} for every output.
    pub fn output_chirp(&self) -> &[C64] {
        &self.outputs
    }

    /// The sums without their output chirps, for real `g`; they are part of `buffer`.
    pub fn convolve<'a>(&self, g: &[f64], buffer: &'a mut [C64], scratch: &mut [C64]) -> &'a [C64] {
        let inputs = self.inputs.len();
        debug_assert_eq!((g.len(), buffer.len()), (inputs, self.length()));
        for ((out, chirp), g) in buffer.iter_mut().zip(&self.inputs).zip(g) {
            *out = chirp * g;
        }
        buffer[inputs..].fill(C64::zero());
        self.forward.process_with_scratch(buffer, scratch);
        for (value, filter) in buffer.iter_mut().zip(&self.filter) {
            *value *= filter;
        }
        self.inverse.process_with_scratch(buffer, scratch);
        &buffer[inputs - 1..inputs - 1 + self.outputs.len()]
    }
}

/// The least 2^a·3^b ≥ `length`, for which FFTs are fastest.
fn fast_length(length: usize) -> usize {
    let mut best = length.next_power_of_two();
    let mut threes = 3;
    while threes < best {
        let twos = length.div_ceil(threes).next_power_of_two();
        best = best.min(threes * twos);
        threes *= 3;
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_the_next_smooth_ones() {
        for (length, want) in
            [(1, 1), (5, 6), (7, 8), (25, 27), (65, 72), (4097, 4374), (6400, 6561)]
        {
            assert_eq!(fast_length(length), want);
        }
    }

    #[test]
    fn sums_are_those_of_the_definition() {
        let (alpha, inputs, outputs) = (0.017_3, (3, 50), (41, 30));
        let plan = ChirpPlan::new(&chirps(alpha, 71), inputs, outputs, &mut Planner::<f64>::new());
        let g: Vec<f64> = (0..50).map(|i| f64::from(i * 37 % 11) - 5.0).collect();
        let mut buffer = vec![C64::zero(); plan.length()];
        let mut scratch = vec![C64::zero(); plan.scratch_length()];
        let sums = plan.convolve(&g, &mut buffer, &mut scratch);
        for ((j, sum), chirp) in (41..).zip(sums).zip(plan.output_chirp()) {
            let term = |(i, g): (usize, &f64)| {
                C64::from_polar(*g, std::f64::consts::TAU * alpha * (i + 3) as f64 * f64::from(j))
            };
            let want: C64 = g.iter().enumerate().map(term).sum();
            assert!((sum * chirp - want).norm() < 1e-12, "at {j}");
        }
    }
}
