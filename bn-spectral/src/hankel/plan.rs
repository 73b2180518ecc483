//! The transform of a function that is known at the nodes of a quadrature.

use super::quadrature::gauss_panels;
use crate::bessel::{j0_slice, j0_slice_alike};

/// Kernel matrices up to this many entries (16 MB) are kept; above, J₀ is evaluated each time.
const KEPT: usize = 1 << 21;
/// Values of J₀ that are made and used together.
const CHUNK: usize = 512;

/// The Hankel transform F(u) = 2π ∫ r f(r) J₀(2πru) dr at given frequencies u, planned once for a
/// range of r and applied to the values of any f at [`nodes`](Self::nodes).
///
/// The nodes are those of Gauss–Legendre panels (16 a panel) between break points, none longer than
/// the scale on which f is smooth nor than 1/u for the highest frequency: every oscillation of J₀
/// is resolved, however large r·u becomes, and nothing is aliased. Where f is analytic between the
/// breaks with a panel's length as its scale, the error is about 1e-12·2π∫ r |f| dr (rounding, and
/// nothing else for f resolved twice as well); jumps and kinks of f belong on breaks. What lies
/// beyond the last break counts as 0: a function that falls off slowly must be cut by a smooth
/// window first, or its edge rings.
///
/// Frequencies and radii are in reciprocal units; the transform is its own inverse, so "radii" may
/// as well be frequencies of a spectrum. Cost of an application: one product a node and frequency,
/// about 0.5 ns where the kernel matrix is kept (up to 2²¹ entries), 3–5 ns above.
///
/// ```
/// use bn_spectral::HankelPlan;
///
/// let plan = HankelPlan::new(&[0.0, 4.0], 0.5, &[0.0, 1.0]);
/// let gaussian = |r: f64| (-std::f64::consts::PI * r * r).exp();
/// for (got, want) in plan.transform(gaussian).iter().zip([1.0, gaussian(1.0)]) {
///     assert!((got - want).abs() < 1e-14);
/// }
/// ```
#[derive(Clone, Debug)]
pub struct HankelPlan {
    nodes: Vec<f64>,
    /// 2πr times the quadrature's weight.
    weights: Vec<f64>,
    frequencies: Vec<f64>,
    /// J₀(2πur), a row a frequency; empty if too large.
    kernel: Vec<f64>,
    /// What evaluates J₀.
    j0: fn(&[f64], &mut [f64]),
}

impl HankelPlan {
    /// The plan for functions on [first break, last break], smooth between the breaks on the scale
    /// `scale`, at these frequencies.
    ///
    /// # Panics
    /// If there are fewer than two breaks, they are not finite, ascending and ≥ 0, `scale` is not
    /// positive, a frequency is not finite, or more than 2²⁸ nodes would be needed.
    pub fn new(breaks: &[f64], scale: f64, frequencies: &[f64]) -> Self {
        Self::with(j0_slice, breaks, scale, frequencies)
    }

    /// As [`Self::new`], with transforms of the same bits on every CPU.
    pub(crate) fn alike(breaks: &[f64], scale: f64, frequencies: &[f64]) -> Self {
        Self::with(j0_slice_alike, breaks, scale, frequencies)
    }

    fn with(j0: fn(&[f64], &mut [f64]), breaks: &[f64], scale: f64, frequencies: &[f64]) -> Self {
        assert!(breaks.len() >= 2 && breaks[0] >= 0.0, "breaks {breaks:?} are no range of radii");
        assert!(breaks.is_sorted_by(|a, b| a < b), "breaks must ascend");
        assert!(scale > 0.0, "scale {scale} is not a length");
        assert!(frequencies.iter().all(|u| u.is_finite()), "frequencies must be finite");
        let highest = frequencies.iter().fold(0.0_f64, |top, u| top.max(u.abs()));
        let longest = if highest > 0.0 { scale.min(1.0 / highest) } else { scale };
        let range = breaks[breaks.len() - 1] - breaks[0];
        let most = range / longest + breaks.len() as f64;
        assert!(most < f64::from(1 << 24), "{most} panels are too many");
        let (nodes, mut weights) = gauss_panels(breaks, longest);
        for (weight, r) in weights.iter_mut().zip(&nodes) {
            *weight *= std::f64::consts::TAU * r;
        }
        let mut plan =
            Self { nodes, weights, frequencies: frequencies.to_vec(), kernel: vec![], j0 };
        let entries = plan.nodes.len().saturating_mul(frequencies.len());
        if entries <= KEPT {
            let mut kernel = vec![0.0; entries];
            for (&u, row) in frequencies.iter().zip(kernel.chunks_exact_mut(plan.nodes.len())) {
                plan.bessel_row(u, 0, row);
            }
            plan.kernel = kernel;
        }
        plan
    }

    /// The radii r at which a function's values are wanted, ascending.
    pub fn nodes(&self) -> &[f64] {
        &self.nodes
    }

    /// The frequencies u at which the transform is given.
    pub fn frequencies(&self) -> &[f64] {
        &self.frequencies
    }

    /// The transform of the function with values `f` at the nodes, into `transform` at the
    /// frequencies. Neither allocates nor starts a thread.
    ///
    /// # Panics
    /// If a length is not that of the nodes or frequencies.
    pub fn apply_into(&self, f: &[f64], transform: &mut [f64]) {
        assert_eq!(f.len(), self.nodes.len(), "one value for every node");
        self.apply_batch_into(f, transform);
    }

    /// [`apply_into`](Self::apply_into) for several functions, one after the other in `f` as their
    /// transforms are in `transforms`; a kernel that is not kept is evaluated once for all.
    ///
    /// # Panics
    /// If `f` is not a multiple of the nodes and `transforms` the same multiple of the frequencies.
    pub fn apply_batch_into(&self, f: &[f64], transforms: &mut [f64]) {
        let (nodes, frequencies) = (self.nodes.len(), self.frequencies.len());
        let functions = f.len() / nodes;
        assert_eq!(f.len(), functions * nodes, "one value for every node");
        assert_eq!(transforms.len(), functions * frequencies, "one result for every frequency");
        let mut buffer = [0.0; CHUNK];
        for (j, &u) in self.frequencies.iter().enumerate() {
            transforms.iter_mut().skip(j).step_by(frequencies).for_each(|t| *t = 0.0);
            for start in (0..nodes).step_by(CHUNK) {
                let end = (start + CHUNK).min(nodes);
                let bessel = if self.kernel.is_empty() {
                    let row = &mut buffer[..end - start];
                    self.bessel_row(u, start, row);
                    &*row
                } else {
                    &self.kernel[j * nodes + start..j * nodes + end]
                };
                for k in 0..functions {
                    let f = &f[k * nodes + start..k * nodes + end];
                    transforms[k * frequencies + j] +=
                        triple_product(&self.weights[start..end], bessel, f);
                }
            }
        }
    }

    /// The transform of a function given by its values anywhere.
    pub fn transform(&self, f: impl FnMut(f64) -> f64) -> Vec<f64> {
        let values: Vec<f64> = self.nodes.iter().copied().map(f).collect();
        let mut transform = vec![0.0; self.frequencies.len()];
        self.apply_into(&values, &mut transform);
        transform
    }

    /// J₀(2πur) at the nodes from `start` on.
    fn bessel_row(&self, u: f64, start: usize, row: &mut [f64]) {
        let mut x = [0.0; CHUNK];
        for (nodes, row) in
            self.nodes[start..start + row.len()].chunks(CHUNK).zip(row.chunks_mut(CHUNK))
        {
            let x = &mut x[..nodes.len()];
            for (x, r) in x.iter_mut().zip(nodes) {
                *x = std::f64::consts::TAU * u * r;
            }
            (self.j0)(x, row);
        }
    }
}

/// Σ a·b·c in eight interleaved partial sums, an order that is fixed and vectorises.
fn triple_product(a: &[f64], b: &[f64], c: &[f64]) -> f64 {
    const LANES: usize = 8;
    let mut sums = [0.0; LANES];
    let (a8, a_rest) = a.as_chunks::<LANES>();
    let (b8, b_rest) = b.as_chunks::<LANES>();
    let (c8, c_rest) = c.as_chunks::<LANES>();
    for ((a, b), c) in a8.iter().zip(b8).zip(c8) {
        for lane in 0..LANES {
            sums[lane] += a[lane] * b[lane] * c[lane];
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).zip(c_rest).map(|((a, b), c)| a * b * c).sum();
    sums.iter().sum::<f64>() + rest
}
