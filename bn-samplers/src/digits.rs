//! Digits of numbers, mirrored at the radix point and scrambled: what digital sequences share.

/// Digits that a radical inverse in base b keeps: the most whose numbers an f64 holds exactly.
const fn digits_of(base: u64) -> u32 {
    let mut digits = 0;
    let mut power = base;
    while power <= 1 << f64::MANTISSA_DIGITS {
        power *= base;
        digits += 1;
    }
    digits
}

/// The radical inverse of `index` in `base`: its digits mirrored at the radix point.
///
/// In [0, 1), a fraction rounded once.
pub(crate) fn radical_inverse(base: u64, index: u64) -> f64 {
    let (mut numerator, mut denominator, mut rest) = (0, 1, index);
    while rest > 0 {
        numerator = numerator * base + rest % base;
        denominator *= base;
        rest /= base;
    }
    numerator as f64 / denominator as f64
}

/// [`radical_inverse`] with its digits, the zeros at the end too, permuted by [`nested`].
pub(crate) fn permuted_radical_inverse(base: u64, index: u64, key: u64) -> f64 {
    let mut rest = index;
    let digits = std::iter::repeat_with(|| {
        let digit = rest % base;
        rest /= base;
        digit
    });
    nested(base, digits, key)
}

/// The number 0.d₁d₂d₃… in `base` with its digits permuted, nested uniformly: the permutation of a
/// digit depends at random on all digits before it. The key stands for one set of permutations.
///
/// A. B. Owen, "Randomly permuted (t,m,s)-nets and (t,s)-sequences", 1995. In [0, 1), cut after as
/// many digits as an f64 holds.
pub(crate) fn nested(base: u64, digits: impl Iterator<Item = u64>, key: u64) -> f64 {
    let (mut numerator, mut denominator) = (0, 1);
    for digit in digits.take(digits_of(base) as usize) {
        // The permuted digits so far, with a 1 in front, number the nodes of Owen's tree.
        let node = mix(key ^ mix(numerator + denominator));
        numerator = numerator * base + permuted(node, base, digit);
        denominator *= base;
    }
    numerator as f64 / denominator as f64
}

/// The image of `digit` under a permutation of 0..base that is uniform for uniform `random`.
fn permuted(random: u64, base: u64, digit: u64) -> u64 {
    match base {
        2 => digit ^ (random >> 63),
        3 => {
            // The six permutations of three digits: a rotation, and a reflection or none.
            let which = ((u128::from(random) * 6) >> 64) as u64;
            let turned = (digit + which % 3) % 3;
            if which < 3 { turned } else { (3 - turned) % 3 }
        }
        _ => unreachable!("only bases 2 and 3 are used"),
    }
}

/// A bijection of 64-bit numbers whose every output bit depends on every input bit: the finaliser
/// of `SplitMix64` (G. L. Steele, D. Lea and C. H. Flood, OOPSLA 2014), variant 13.
pub(crate) fn mix(key: u64) -> u64 {
    let key = key.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let key = (key ^ key >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let key = (key ^ key >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    key ^ key >> 31
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mirrors_digits() {
        // 11 = 1011 in base 2, 102 in base 3.
        assert_eq!(radical_inverse(2, 11), 13.0 / 16.0);
        assert_eq!(radical_inverse(3, 11), 19.0 / 27.0);
        assert_eq!(radical_inverse(3, 0), 0.0);
        let last = radical_inverse(2, u64::from(u32::MAX));
        assert!(last < 1.0 && last > 0.999_999_999);
    }

    #[test]
    fn nested_permutations_keep_intervals() {
        // b^k consecutive numbers from a multiple of b^k lie one in each interval of length b^-k.
        for (base, k) in [(2_u64, 7), (3, 4)] {
            let count = base.pow(k);
            for key in 0..4 {
                let mut seen = vec![false; count as usize];
                for i in 5 * count..6 * count {
                    let x = permuted_radical_inverse(base, i, key);
                    assert!((0.0..1.0).contains(&x));
                    let cell = (x * count as f64) as usize;
                    assert!(!std::mem::replace(&mut seen[cell], true), "base {base}, key {key}");
                }
            }
        }
    }

    #[test]
    fn three_digits_are_permuted_in_six_ways() {
        let mut ways = std::collections::BTreeSet::new();
        for sixth in 0..6_u64 {
            let random = sixth * (u64::MAX / 6) + (1 << 40);
            let way: Vec<_> = (0..3).map(|digit| permuted(random, 3, digit)).collect();
            let mut sorted = way.clone();
            sorted.sort_unstable();
            assert_eq!(sorted, [0, 1, 2]);
            ways.insert(way);
        }
        assert_eq!(ways.len(), 6);
    }
}
