//! A list of numbers that knows where its largest is.

/// Children of a node: eight f64 fill a cache line.
const FAN: usize = 8;

/// Numbers ≥ 0 under a tree whose nodes hold the largest number below them.
///
/// Changing a number costs O(log n), but what changes no maximum stops early: on the average two
/// nodes are looked at.
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

    /// Makes the number at `index` be `value`.
    #[inline]
    pub fn set(&mut self, mut index: usize, value: f64) {
        let (mut new, mut level) = (value, 0);
        let mut old = std::mem::replace(&mut self.nodes[index], new);
        while let Some(&above) = self.starts.get(level + 1) {
            let node = index / FAN;
            let largest = self.nodes[above + node];
            if new < largest {
                if old < largest {
                    return;
                }
                let children = self.starts[level] + node * FAN;
                new = self.nodes[children..children + FAN].iter().copied().fold(0.0, f64::max);
            }
            old = std::mem::replace(&mut self.nodes[above + node], new);
            if old == new {
                return;
            }
            (index, level) = (node, level + 1);
        }
    }

    /// Where the largest number is, the first of several.
    pub fn argmax(&self) -> usize {
        let mut node = 0;
        for &start in self.starts.iter().rev() {
            let children = &self.nodes[start + node * FAN..start + (node + 1) * FAN];
            let mut best = 0;
            for i in 1..FAN {
                if children[i] > children[best] {
                    best = i;
                }
            }
            node = node * FAN + best;
        }
        node
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn knows_the_first_largest(
            len in 1_usize..700,
            changes in prop::collection::vec((any::<prop::sample::Index>(), 0_u32..50), 1..300),
        ) {
            let (mut tree, mut list) = (MaxTree::zeros(len), vec![0.0; len]);
            for (index, value) in changes {
                let index = index.index(len);
                list[index] = f64::from(value);
                tree.set(index, list[index]);
                prop_assert_eq!(tree.get(index), list[index]);
                let largest = list.iter().copied().fold(0.0, f64::max);
                let first = list.iter().position(|&x| x == largest).expect("not empty");
                prop_assert_eq!(tree.argmax(), first);
            }
            prop_assert!(tree.len() >= len && tree.len() < len + FAN);
        }
    }
}
