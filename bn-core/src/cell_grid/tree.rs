//! A k-d tree on the torus, for sets too clustered for cells.

use std::ops::ControlFlow;

use glam::DVec2;

use super::CellPoints;
use super::probe::Probe;

/// A node of at most this many points is looked through point by point.
const LEAF: usize = 12;

/// Distances round the torus are computed from rounded coordinates; bounds on them are loosened by
/// this. Distances that don't cross the seam are differences, which round monotonically.
const SEAM_SLACK: f64 = 1e-15;

/// Points in the order of a balanced k-d tree: every node is a range of them, split at its middle.
#[derive(Clone)]
pub(super) struct Tree {
    points: Vec<DVec2>,
    indices: Vec<u32>,
    /// In preorder: the left child follows its parent.
    nodes: Vec<Node>,
}

#[derive(Clone, Copy)]
struct Node {
    /// The bounding box.
    low: DVec2,
    high: DVec2,
    start: u32,
    end: u32,
    /// The right child; 0 in a leaf.
    right: u32,
}

impl Tree {
    /// The tree of the points with their indices, in O(n log n).
    pub(super) fn new(points: &[DVec2], indices: &[u32]) -> Self {
        let mut both: Vec<_> = points.iter().copied().zip(indices.iter().copied()).collect();
        let mut nodes = Vec::with_capacity(4 * points.len().div_ceil(LEAF));
        build(&mut both, 0, &mut nodes);
        let (points, indices) = both.into_iter().unzip();
        Self { points, indices, nodes }
    }

    /// Shows the probe all points that may be within its shrinking reach of `p`, near ones first.
    pub(super) fn search(&self, p: DVec2, probe: &mut impl Probe) -> ControlFlow<()> {
        self.search_node(0, p, probe)
    }

    fn search_node<P: Probe>(&self, node: usize, p: DVec2, probe: &mut P) -> ControlFlow<()> {
        let Node { start, end, right, .. } = self.nodes[node];
        if right == 0 {
            let slots = start as usize..end as usize;
            let (points, indices) = (&self.points[slots.clone()], &self.indices[slots]);
            return probe.look(CellPoints { points, indices });
        }
        let (left, right) = (node + 1, right as usize);
        let clearance = |node: usize| P::clearance(self.nodes[node].gap(p));
        let (to_left, to_right) = (clearance(left), clearance(right));
        let children = if to_right < to_left {
            [(right, to_right), (left, to_left)]
        } else {
            [(left, to_left), (right, to_right)]
        };
        for (child, clearance) in children {
            if clearance <= probe.reach() {
                self.search_node(child, p, probe)?;
            }
        }
        ControlFlow::Continue(())
    }
}

/// Appends the node of `points`, which start at `start` of all, and those below it; the depth is
/// log₂(n), at most 31.
fn build(points: &mut [(DVec2, u32)], start: usize, nodes: &mut Vec<Node>) {
    let (low, high) = points
        .iter()
        .fold((DVec2::ONE, DVec2::ZERO), |(low, high), (p, _)| (low.min(*p), high.max(*p)));
    let (node, end) = (nodes.len(), start + points.len());
    nodes.push(Node { low, high, start: start as u32, end: end as u32, right: 0 });
    if points.len() <= LEAF {
        points.sort_unstable_by_key(|&(_, index)| index);
        return;
    }
    let middle = points.len() / 2;
    let size = high - low;
    let axis = |p: DVec2| if size.x >= size.y { p.x } else { p.y };
    // The index breaks ties, so that the tree doesn't hang on how the library selects.
    points
        .select_nth_unstable_by(middle, |a, b| axis(a.0).total_cmp(&axis(b.0)).then(a.1.cmp(&b.1)));
    let (left, right) = points.split_at_mut(middle);
    build(left, start, nodes);
    nodes[node].right = nodes.len() as u32;
    build(right, start + middle, nodes);
}

impl Node {
    /// How far the points of the node are from `p` at least, in each axis.
    fn gap(&self, p: DVec2) -> DVec2 {
        DVec2::new(gap(p.x, self.low.x, self.high.x), gap(p.y, self.low.y, self.high.y))
    }
}

/// How far `x` is from [low, high] on the circle at least.
fn gap(x: f64, low: f64, high: f64) -> f64 {
    if x < low {
        (low - x).min((x + (1.0 - high) - SEAM_SLACK).max(0.0))
    } else if x > high {
        (x - high).min((low + (1.0 - x) - SEAM_SLACK).max(0.0))
    } else {
        0.0
    }
}
