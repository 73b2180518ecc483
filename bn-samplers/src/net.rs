//! (0,m,2)-nets in base 2.

use bn_core::{DVec2, Observer, Seed};

use crate::placing::{begin_placing, between_counts};
use crate::{
    CountRule, DefaultValue, Method, OptionKind, OptionSpec, PointOrder, Report, Sample,
    SampleError, Sampler,
};

/// n = 2^m points (i/n, y(i)/n), exactly one in each elementary interval: in each box of area 1/n
/// whose sides are powers of ½ and which lies on a grid of such boxes.
///
/// Thesis p. 115; L. Grünschloß and A. Keller, "(t,m,s)-nets and maximized minimum distance, part
/// II", Monte Carlo and Quasi-Monte Carlo Methods 2008. The maximin net is our own construction to
/// the same end, see [`Construction::Maximin`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Net {
    /// Which net.
    pub construction: Construction,
}

/// A family of nets, one for each m.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Construction {
    /// Parallel slanted lines of points that slide along themselves.
    ///
    /// Points on lines of direction (p, q) that are n/|(p, q)| apart keep that distance however the
    /// lines slide, and sliding by bit-reversed amounts makes the net. For odd m the direction is
    /// (w, w) with 2w² = n, and `d_min` = 1/√n = 0.9306 `d_hex`, that of the square grid. For even
    /// m it is (w/4, w) with w² = n; `d_min` → √(16/17)/√n = 0.9028 `d_hex`, less 1/n² terms as the
    /// lines have to be broken at four places: 0.658, 0.736, 0.823, 0.865, 0.892, 0.9013, 0.9026
    /// `d_hex` for m = 2, 4, …, 14. (One cell of a w × w grid must hold one point, which rules out
    /// flatter lines: (w/8, w) would put two or none into some boxes of 2 × ½ cells.)
    #[default]
    Maximin,
    /// y(i) is i with its digits reversed: Hammersley's points.
    Hammersley,
    /// Larcher and Pillichshammer's net of small discrepancy, 2002; `d_min` is 0.658 `d_hex` for
    /// even m.
    LarcherPillichshammer,
}

/// The registry's entry.
pub(crate) const METHOD: Method = Method {
    name: "net",
    aliases: &["low-discrepancy", "lowdisc", "0m2-net"],
    summary: "(0,m,2)-net with a large minimum distance",
    page: Some(115),
    citation: "L. Grünschloß and A. Keller, (t,m,s)-nets and maximized minimum distance, part II, MCQMC 2008",
    complexity: "O(n)",
    order: PointOrder::Scan,
    counts: CountRule::PowerOfTwo,
    seeded: false,
    options: &[OptionSpec {
        name: "construction",
        kind: OptionKind::Choice(&["maximin", "hammersley", "larcher-pillichshammer"]),
        default: DefaultValue::Value("maximin"),
        help: "which net",
        unit: "",
    }],
    build: |options| {
        Ok(Box::new(Net {
            construction: match options.choice("construction") {
                Some("hammersley") => Construction::Hammersley,
                Some("larcher-pillichshammer") => Construction::LarcherPillichshammer,
                _ => Construction::Maximin,
            },
        }))
    },
    version: 1,
};

impl Sampler for Net {
    fn sample(
        &self,
        n: usize,
        _seed: Seed,
        observer: &dyn Observer,
    ) -> Result<Sample, SampleError> {
        let mut points = begin_placing(METHOD.name, n, observer)?;
        if !n.is_power_of_two() {
            let above = n.next_power_of_two();
            return Err(between_counts(METHOD.name, n, "a power of 2", [above / 2, above]));
        }
        let m = n.trailing_zeros();
        points.extend((0..n as u32).map(|i| {
            let y = match self.construction {
                Construction::Maximin => maximin(m, i),
                Construction::Hammersley => reverse(i, m),
                Construction::LarcherPillichshammer => larcher_pillichshammer(m, i),
            };
            DVec2::new(f64::from(i), f64::from(y)) / n as f64
        }));
        Ok(Sample::new(points, Report::new().with("m", u64::from(m))))
    }
}

/// The lowest `bits` bits of `i`, reversed.
fn reverse(i: u32, bits: u32) -> u32 {
    if bits == 0 { 0 } else { i.reverse_bits() >> (u32::BITS - bits) }
}

/// y(i): the bits of i from the highest on are added up, and the sums are its bits reversed.
fn larcher_pillichshammer(m: u32, i: u32) -> u32 {
    // Prefix sums modulo 2, by doubling.
    let mut sums = i;
    for shift in [1, 2, 4, 8, 16] {
        sums ^= sums >> shift;
    }
    reverse(sums, m)
}

fn maximin(m: u32, i: u32) -> u32 {
    match m {
        0..=2 => reverse(i, m),
        _ if m % 2 == 1 => diagonal_lines(m, i),
        _ => steep_lines(m, i, order_of_segments(m)),
    }
}

/// Lines along (w, w), 2w² = n, in 2w × 2w cells of side w.
///
/// Line l passes the cells (c, c + 2l) at the offset (u, u), where u is l reversed.
fn diagonal_lines(m: u32, i: u32) -> u32 {
    let h = (m - 1) / 2;
    let line = reverse(i, h);
    (i + (line << (h + 1))) & ((1 << m) - 1)
}

/// Lines along (w/4, w), w² = n, in 4w × w cells of w/4 by w.
///
/// Line l passes the cells (c, c + 4l + 1) at the offset (u, 4u + s), where u is l reversed. It
/// comes to each row of cells four times, once in each quarter of the columns, and s is different
/// each time: `segments` of the quarter. The 1 makes that boxes of 2 × 2 and ½ × 2 cells have one
/// point each, not two or none.
fn steep_lines(m: u32, i: u32, segments: [u32; 4]) -> u32 {
    let h = m / 2;
    let (column, offset) = (i >> (h - 2), i & ((1 << (h - 2)) - 1));
    let line = reverse(offset, h - 2);
    let row = (column + 4 * line + 1) & ((1 << h) - 1);
    (row << h) | (offset << 2) | segments[(column >> h) as usize]
}

/// The offsets in the quarters that leave the largest minimum distance: found by trying all that
/// make a net (see the tests); from m = 12 on it is always the same.
fn order_of_segments(m: u32) -> [u32; 4] {
    match m {
        4..=8 => [0, 3, 2, 1],
        10 => [0, 2, 3, 1],
        _ => [1, 2, 3, 0],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bn_core::{Density, Unobserved};

    fn is_net(m: u32, y: &[u32]) -> bool {
        (0..=m).all(|rows| {
            let mut seen = vec![false; y.len()];
            (0..).zip(y).all(|(x, y): (u32, &u32)| {
                // A box of 2^rows by 2^(m − rows).
                let number = (x >> rows << rows) + (y >> (m - rows));
                !std::mem::replace(&mut seen[number as usize], true)
            })
        })
    }

    /// The squared minimum distance on the torus in units of 1/n.
    fn distance_squared(y: &[u32]) -> u32 {
        let n = y.len() as u32;
        let mut least = 2 * n * n;
        for step in 1..n {
            let across = step.min(n - step);
            // The torus's symmetry: half of the steps are enough.
            if across * across >= least || step > n / 2 {
                break;
            }
            for x in 0..n {
                let d = y[x as usize].abs_diff(y[((x + step) % n) as usize]);
                let d = d.min(n - d);
                least = least.min(across * across + d * d);
            }
        }
        least
    }

    #[test]
    fn every_construction_makes_nets() {
        for m in 0..=13 {
            for f in [maximin, larcher_pillichshammer, |m, i| reverse(i, m)] {
                let y: Vec<u32> = (0..1 << m).map(|i| f(m, i)).collect();
                assert!(is_net(m, &y), "m = {m}");
            }
        }
    }

    #[test]
    fn distances_are_as_stated() {
        let distances = [(2, 2), (4, 10), (6, 50), (8, 221), (10, 941), (12, 3842), (14, 15413)];
        for (m, want) in distances {
            let y: Vec<u32> = (0..1 << m).map(|i| maximin(m, i)).collect();
            assert_eq!(distance_squared(&y), want, "m = {m}");
        }
        for m in [1, 3, 5, 7, 9, 11, 13] {
            let y: Vec<u32> = (0..1 << m).map(|i| maximin(m, i)).collect();
            assert_eq!(distance_squared(&y), 1 << m, "m = {m}");
        }
        let n = 4096;
        let d_min = f64::from(3842).sqrt() / n as f64;
        assert!(Density::new(n).normalize_distance(d_min).value() > 0.9);
    }

    /// The search behind [`order_of_segments`]: all orders of the four offsets that make a net.
    #[test]
    fn no_order_of_segments_is_better() {
        for m in [4, 6, 8, 10, 12] {
            let net = |segments| -> Vec<u32> {
                (0..1 << m).map(|i| steep_lines(m, i, segments)).collect()
            };
            let chosen = distance_squared(&net(order_of_segments(m)));
            let mut tried = 0;
            for code in 0..256 {
                let segments = [0, 2, 4, 6].map(|shift| code >> shift & 3);
                let y = net(segments);
                if is_net(m, &y) {
                    tried += 1;
                    assert!(distance_squared(&y) <= chosen, "m = {m}: {segments:?}");
                }
            }
            // The offsets of quarters 0 and 1, and of 2 and 3, must differ in the higher bit.
            assert_eq!(tried, 16);
        }
    }

    #[test]
    fn names_the_nearest_power() {
        for (n, want) in [(3, 2), (5, 4), (6, 4), (7, 8), (4000, 4096), (5000, 4096)] {
            let error = Net::default().sample(n, Seed::new(1), &Unobserved).expect_err("no power");
            assert!(matches!(error, SampleError::InvalidCount { nearest, .. } if nearest == want));
        }
    }
}
