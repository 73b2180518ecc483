//! Building the mesh of many points at once.

use bn_core::DVec2;

use super::coincident::Coincidences;
use super::mesh::{Mesh, Scratch, Vertex};
use crate::hilbert;
use crate::predicates::snap;

/// Between rounds of insertion the number of points grows by this factor.
const ROUND_FACTOR: usize = 4;

/// The mesh of these points, the point at place i of the list called by `number(i)`, and who shares
/// whose vertex.
///
/// Inserts along a Hilbert curve, so that each search starts next to its goal, in rounds that take
/// every 4ᵏth point of the curve, so that no round leaves wide gaps to fill with slivers (a biased
/// insertion order, Amenta, Choi and Rote 2003, with regular samples for random ones). While the
/// mesh grows its vertices are numbered along the curve: neighbours in the mesh are neighbours in
/// memory.
pub fn build(points: &[DVec2], number: impl Fn(u32) -> u32) -> (Mesh, Coincidences) {
    let mut curve: Vec<(u64, u32)> =
        points.iter().zip(0..).map(|(&p, i)| (hilbert::index(snap(p)), i)).collect();
    curve.sort_unstable();
    let mut mesh = Mesh::default();
    mesh.reserve(points.len());
    let (mut shared, mut scratch) = (Vec::new(), Scratch::default());
    for rank in insertion_order(curve.len()) {
        let p = snap(points[curve[rank].1 as usize]);
        if let Some(vertex) = mesh.insert(rank as u32, p, mesh.last, &mut scratch) {
            shared.push((vertex, rank as u32));
        }
    }
    let mut numbers: Vec<u32> = curve.into_iter().map(|(_, i)| number(i)).collect();
    let coincidences = name_coincident(&mut numbers, shared);
    mesh.renumber(&numbers);
    mesh.changed.clear();
    (mesh, coincidences)
}

/// 0 .. n, multiples of high powers of the round factor first, in order within a round.
fn insertion_order(n: usize) -> impl Iterator<Item = usize> {
    let rounds = n.max(1).ilog(ROUND_FACTOR);
    (0..=rounds).rev().flat_map(move |round| {
        let stride = ROUND_FACTOR.pow(round);
        (0..n)
            .step_by(stride)
            .filter(move |rank| round == rounds || !rank.is_multiple_of(stride * ROUND_FACTOR))
    })
}

/// Groups the points that share a vertex, given as pairs of ranks; of each group the point with
/// the lowest number stands for the vertex.
fn name_coincident(number: &mut [u32], mut shared: Vec<(u32, u32)>) -> Coincidences {
    let mut coincidences = Coincidences::default();
    shared.sort_unstable();
    for group in shared.chunk_by(|a, b| a.0 == b.0) {
        let rank = group[0].0 as usize;
        let mut members: Vec<u32> =
            group.iter().map(|&(_, other)| number[other as usize]).collect();
        members.push(number[rank]);
        members.sort_unstable();
        for &other in &members[1..] {
            coincidences.join(other, members[0]);
        }
        number[rank] = members[0];
    }
    coincidences
}

impl Mesh {
    fn reserve(&mut self, vertices: usize) {
        self.faces.reserve(2 * vertices);
        self.vertices.resize(vertices, Vertex::ABSENT);
    }

    /// Gives vertex v the number `number[v]`.
    fn renumber(&mut self, number: &[u32]) {
        for face in &mut self.faces {
            for corner in 0..3 {
                face.set_vertex(corner, number[face.vertex(corner) as usize]);
            }
        }
        let bound = number.iter().max().map_or(0, |&last| last as usize + 1);
        let renumbered = vec![Vertex::ABSENT; bound];
        let vertices = std::mem::replace(&mut self.vertices, renumbered);
        for (vertex, &new) in vertices.into_iter().zip(number) {
            if vertex.is_present() {
                self.vertices[new as usize] = vertex;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_rank_is_inserted_once() {
        for n in [0, 1, 2, 3, 4, 5, 15, 16, 17, 64, 1000] {
            let mut order: Vec<usize> = insertion_order(n).collect();
            order.sort_unstable();
            assert_eq!(order, (0..n).collect::<Vec<_>>());
        }
    }
}
