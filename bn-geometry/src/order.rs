//! Bond-orientational order.

use bn_core::DVec2;

use crate::Triangulation;

/// qⱼⁿ of every point j: how well the directions to its neighbours agree modulo 2π/n,
///
/// qⱼⁿ = |Σₖ exp(i·n·θⱼₖ)| / |𝒩ⱼ|  (thesis eq. B.1),
///
/// the sum over the Delaunay neighbours 𝒩ⱼ, with θⱼₖ the direction from j to k. Where several edges
/// lead to one neighbour, or from the point to its own copies, each counts.
///
/// In [0, 1]; 1 if all directions agree, 1 for n = 0. By index of the points up to the largest one;
/// 0 where there is no point. Points that coincide have the value of their place. The result
/// depends on how squares are cut: the triangulation cuts all alike, so a square lattice has
/// q⁶ = ⅓ (thesis table 4.2: 0.33).
///
/// Absolute error below (`fold` + 10)·1e-15 for points as the triangulation holds them: on its coordinate
/// grid, which turns a bond of length d by up to 2⁻⁵⁰/d, and qⁿ's angle by `fold` times that.
/// O(N log `fold`) for N points.
pub fn local_bond_orientational_order(triangulation: &Triangulation, fold: u32) -> Vec<f64> {
    let mut sums = vec![Bonds::default(); triangulation.index_bound()];
    for face in triangulation.faces() {
        // Each half-edge belongs to one face and to the point where it starts.
        for (c, &from) in face.vertices.iter().enumerate() {
            let bond = face.corners[(c + 1) % 3] - face.corners[c];
            sums[from].add(unit_power(bond, fold));
        }
    }
    let mut order: Vec<f64> = sums.iter().map(Bonds::order).collect();
    if triangulation.point_count() > triangulation.vertex_count() {
        for index in (0..order.len()).filter(|&index| triangulation.contains(index)) {
            order[index] = order[triangulation.representative(index)];
        }
    }
    order
}

/// Qⁿ = (1/N) Σⱼ qⱼⁿ over all N points (thesis eq. B.2); see [`local_bond_orientational_order`].
/// None if there are no points.
///
/// ```
/// use bn_core::{DVec2, PointSet};
/// use bn_geometry::{Triangulation, bond_orientational_order};
///
/// let lattice = (0..64).map(|i| DVec2::new((i % 8) as f64, (i / 8) as f64) / 8.0).collect();
/// let triangulation = Triangulation::new(&PointSet::new(lattice)?);
/// let order = |fold| bond_orientational_order(&triangulation, fold).expect("64 points");
/// assert!((order(6) - 1.0 / 3.0).abs() < 1e-14);
/// assert!((order(8) - 1.0).abs() < 1e-14);
/// # Ok::<(), bn_core::PointSetError>(())
/// ```
pub fn bond_orientational_order(triangulation: &Triangulation, fold: u32) -> Option<f64> {
    let points = triangulation.point_count();
    let local = local_bond_orientational_order(triangulation, fold);
    (points > 0).then(|| local.iter().sum::<f64>() / points as f64)
}

/// The bonds of a point: Σ exp(inθ) and how many.
#[derive(Clone, Copy, Default)]
struct Bonds {
    sum: DVec2,
    count: f64,
}

impl Bonds {
    fn add(&mut self, bond: DVec2) {
        self.sum += bond;
        self.count += 1.0;
    }

    fn order(&self) -> f64 {
        if self.count == 0.0 { 0.0 } else { (self.sum.length() / self.count).min(1.0) }
    }
}

/// (z/|z|)ⁿ for z ≠ 0, as a complex number, by repeated squaring.
fn unit_power(z: DVec2, n: u32) -> DVec2 {
    // z² / |z|² needs no root; only an odd power does.
    let mut square = complex_square(z) / z.length_squared();
    let mut power = if n.is_multiple_of(2) { DVec2::X } else { z.normalize() };
    let mut rest = n / 2;
    while rest > 0 {
        if rest & 1 == 1 {
            power = power.rotate(square);
        }
        square = complex_square(square);
        rest /= 2;
    }
    power
}

fn complex_square(z: DVec2) -> DVec2 {
    z.rotate(z)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unit_powers_agree_with_angles() {
        for n in [0, 1, 2, 3, 4, 5, 6, 7, 12, 31, 100] {
            for step in 0..64 {
                let angle = f64::from(step) * 0.1;
                let z = DVec2::from_angle(angle) * f64::from(step + 1) * 1e-10;
                let want = DVec2::from_angle(angle * f64::from(n));
                assert!((unit_power(z, n) - want).length() < 1e-15 * f64::from(n + 10));
            }
        }
    }
}
