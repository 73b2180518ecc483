//! Portable plans: the same bits with the instructions at hand as with those that every CPU has.

use bn_core::{DVec2, Seed};
use bn_fft::Complex;
use rand::RngExt as _;

use super::ffts::Ffts;
use super::simd::Simd;
use super::{HalfPlane, Nufft, NufftOptions, Real};

/// Bits of everything that decides a position in a matching: modes and gradients.
fn bits<T: Real>(any: bool) -> Vec<(u64, u64)> {
    let (n, k) = (900, 60);
    let mut rng = Seed::new(5).stream(0);
    let points: Vec<_> = (0..n).map(|_| DVec2::new(rng.random(), rng.random())).collect();
    let options = NufftOptions::new(k, 1e-4).expecting(n).portable();
    let mut plan: Nufft<T> = options.plan().expect("a plan");
    if any {
        plan.tables.simd = Simd::any();
        plan.tables.taps.simd = Simd::any();
        let Ffts::Portable { simd, .. } = &mut plan.tables.ffts else { panic!("not portable") };
        *simd = Simd::any();
    }
    let mut modes = HalfPlane::zeros(k);
    plan.points_to_modes(&points, None, &mut modes);
    let mut gradients = vec![DVec2::ZERO; n];
    plan.columns_to_gradients(&points, &mut gradients, |kx, out| {
        out.copy_from_slice(modes.column(kx));
    });
    let modes = modes.values().iter().map(|m: &Complex<T>| (m.re.wide(), m.im.wide()));
    let all = modes.chain(gradients.iter().map(|g| (g.x, g.y)));
    all.map(|(x, y)| (x.to_bits(), y.to_bits())).collect()
}

#[test]
fn portable_plans_give_the_same_bits_with_any_instructions() {
    assert!(bits::<f32>(true) == bits::<f32>(false));
    assert!(bits::<f64>(true) == bits::<f64>(false));
}
