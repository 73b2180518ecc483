//! Transforms against their definition.

use bn_fft::{Complex, Planner};

/// A signal without symmetries.
fn signal(n: usize) -> Vec<Complex<f64>> {
    let at = |i: usize| Complex::new((i * 37 % 11) as f64 - 5.0, (i * i % 7) as f64 - 3.0);
    (0..n).map(at).collect()
}

/// Σⱼ zⱼ e^(±2πi jk/n), the exponent reduced modulo n.
fn by_definition(z: &[Complex<f64>], sign: f64) -> Vec<Complex<f64>> {
    let n = z.len();
    let term = |j: usize, k: usize| {
        let turn = (j * k % n) as f64 / n as f64;
        z[j] * Complex::from_polar(1.0, sign * std::f64::consts::TAU * turn)
    };
    (0..n).map(|k| (0..n).map(|j| term(j, k)).sum()).collect()
}

fn norm(z: impl Iterator<Item = Complex<f64>>) -> f64 {
    z.map(|z| z.norm_sqr()).sum::<f64>().sqrt()
}

/// Primes, powers and products, as far as the direct sum (error about ε·√n) is an oracle.
const LENGTHS: [usize; 14] = [1, 2, 3, 4, 5, 7, 8, 12, 17, 64, 97, 120, 360, 512];

#[test]
fn transforms_are_what_their_definition_says() {
    for n in LENGTHS {
        let z = signal(n);
        for (sign, fft) in
            [(-1.0, Planner::<f64>::new().forward(n)), (1.0, Planner::<f64>::new().inverse(n))]
        {
            let mut ours = z.clone();
            fft.process(&mut ours);
            let want = by_definition(&z, sign);
            let error = norm(ours.iter().zip(&want).map(|(a, b)| a - b));
            assert!(
                error <= 4.0 * f64::EPSILON * (n as f64).sqrt() * norm(want.into_iter()),
                "{n}"
            );
        }
    }
}

#[test]
fn single_precision_is_as_good_as_it_can_be() {
    for n in LENGTHS {
        let z = signal(n);
        for (sign, fft) in
            [(-1.0, Planner::<f32>::new().forward(n)), (1.0, Planner::<f32>::new().inverse(n))]
        {
            let mut ours: Vec<_> =
                z.iter().map(|z| Complex::new(z.re as f32, z.im as f32)).collect();
            fft.process(&mut ours);
            let want = by_definition(&z, sign);
            let wide = |z: &Complex<f32>| Complex::new(f64::from(z.re), f64::from(z.im));
            let error = norm(ours.iter().zip(&want).map(|(a, b)| wide(a) - b));
            let bound = 4.0 * f64::from(f32::EPSILON) * (1.0 + (n as f64).log2());
            assert!(error <= bound * norm(want.into_iter()), "{n}: {error}");
        }
    }
}
