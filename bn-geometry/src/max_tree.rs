//! A list of numbers that knows where its largest is.

/// Children of a node: eight f64 fill a cache line.
const FAN: usize = 1 << FAN_BITS;
const FAN_BITS: u32 = 3;

/// Numbers ≥ 0 under a tree whose nodes hold the largest number below them.
///
/// Changing k numbers costs O(k log n) in a way that the processor can foresee, which beats stopping
/// early on the way up; and so does keeping maxima exact, since those who ask for the largest number
/// tend to change it next.
#[derive(Clone, Debug)]
pub struct MaxTree {
    /// All levels, each padded with zeros to whole nodes: the numbers, the maxima of every eight of
    /// them, and so on to a single node.
    nodes: Vec<f64>,
    /// Where each level starts.
    starts: Vec<usize>,
}

impl MaxTree {
    /// A list of zeros, at least `len` of them.
    pub fn zeros(len: usize) -> Self {
        let (mut starts, mut total) = (Vec::new(), 0);
        let mut width = len.max(1);
        loop {
            starts.push(total);
            total += width.next_multiple_of(FAN);
            width = width.div_ceil(FAN);
            if width == 1 {
                return Self { nodes: vec![0.0; total], starts };
            }
        }
    }

    /// Length of the list.
    pub fn len(&self) -> usize {
        self.starts.get(1).copied().unwrap_or(self.nodes.len())
    }

    /// The number at `index`.
    #[inline]
    pub fn get(&self, index: usize) -> f64 {
        self.nodes[index]
    }

    /// Takes over new numbers for some of the indices.
    ///
    /// Goes up level by level, not number by number: that is independent work on each level.
    #[inline]
    pub fn set<I>(&mut self, indices: &I, value: impl Fn(usize) -> f64)
    where
        I: Iterator<Item = usize> + Clone,
    {
        for index in indices.clone() {
            self.nodes[index] = value(index);
        }
        let mut bits = 0;
        for level in 1..self.starts.len() {
            let (start, above) = (self.starts[level - 1], self.starts[level]);
            bits += FAN_BITS;
            for group in indices.clone().map(|index| index >> bits) {
                self.nodes[above + group] = max(self.group(start, group));
            }
        }
    }

    /// Where the largest number is, the first of several.
    #[inline]
    pub fn argmax(&self) -> usize {
        self.starts
            .iter()
            .rev()
            .fold(0, |group, &start| group * FAN + argmax(self.group(start, group)))
    }

    #[inline]
    fn group(&self, start: usize, group: usize) -> &[f64; FAN] {
        let first = start + group * FAN;
        self.nodes[first..].first_chunk().expect("levels consist of whole groups")
    }
}

/// The largest of eight numbers.
#[inline]
fn max(n: &[f64; FAN]) -> f64 {
    let max = |a: f64, b: f64| if a > b { a } else { b };
    // In an order in which two can be done at a time.
    let (a, b) = (max(n[0], n[2]), max(n[1], n[3]));
    let (c, d) = (max(n[4], n[6]), max(n[5], n[7]));
    max(max(a, c), max(b, d))
}

/// Where the first largest of eight numbers is: in three rounds of choices that the processor need
/// not foresee.
#[inline]
fn argmax(n: &[f64; FAN]) -> usize {
    let better = |a: (usize, f64), b: (usize, f64)| if b.1 > a.1 { b } else { a };
    let pair = |i: usize| better((i, n[i]), (i + 1, n[i + 1]));
    better(better(pair(0), pair(2)), better(pair(4), pair(6))).0
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn knows_the_first_largest(
            len in 1_usize..700,
            changes in prop::collection::vec(
                prop::collection::vec((any::<prop::sample::Index>(), 0_u32..50), 0..9), 1..100,
            ),
        ) {
            let (mut tree, mut list) = (MaxTree::zeros(len), vec![0.0; len]);
            for batch in changes {
                for &(index, value) in &batch {
                    list[index.index(len)] = f64::from(value);
                }
                tree.set(&batch.iter().map(|(index, _)| index.index(len)), |index| list[index]);
                prop_assert!((0..len).all(|index| tree.get(index) == list[index]));
                let largest = list.iter().copied().fold(0.0, f64::max);
                let first = list.iter().position(|&x| x == largest).expect("not empty");
                prop_assert_eq!(tree.argmax(), first);
            }
            prop_assert!(tree.len() >= len && tree.len() < len + FAN);
        }
    }
}
