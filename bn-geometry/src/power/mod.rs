//! Power diagrams: Voronoi diagrams of points with weights.

mod balance;
mod laplacian;
mod polygon;
mod search;

use std::sync::Arc;

use bn_core::{CellGrid, DVec2, DensityIntegrals, PointSet};
use rayon::prelude::*;

use self::polygon::Polygon;
use self::search::Sites;
use crate::VoronoiCell;

pub use self::balance::{Balance, BalancedDiagram};

/// The power diagram of weighted points on the unit torus.
///
/// The cell of point i with weight wᵢ holds the places x for which the power distance
/// |x − pᵢ|² − wᵢ is least, over all points and all their periodic copies. Cells are convex, cover the
/// torus and may be empty (the point is *hidden*), and a point need not lie in its own cell. Equal
/// weights give the Voronoi diagram; only differences of weights matter.
///
/// Each cell is cut out of the unit square around its point by the bisectors of nearby points,
/// found in a [`CellGrid`] out to the distance from which no bisector can reach the cell. Cells depend
/// on nothing but the points, so they are right up to rounding whatever the input: cocircular
/// points, lattices and few points included. Of points that coincide the heaviest has the cell, of
/// equally heavy ones the first.
///
/// Errors: corners are off by some 1e-16 unit lengths (more where the bisectors that meet
/// there are nearly parallel), edges below 1e-15 of a cell's size may be missing.
///
/// Cost: O(n) for points spread evenly whose weights differ by no more than a few squared
/// distances, some 2 µs a cell; O(n²) at worst, for points crowded into a small part of the torus.
/// From 1024 points on rayon's threads share the work; the result does not depend on their number.
///
/// ```
/// use bn_core::{DVec2, PointSet};
/// use bn_geometry::PowerDiagram;
///
/// let set = PointSet::new(vec![DVec2::new(0.25, 0.5), DVec2::new(0.75, 0.5)])?;
/// let diagram = PowerDiagram::new(&set, &[0.05, 0.0]);
/// // Each bisector moves by the difference of weights over twice the distance.
/// assert!((diagram.cells()[0].area - 0.6).abs() < 1e-15);
/// assert!((diagram.cells()[1].area - 0.4).abs() < 1e-15);
/// # Ok::<(), bn_core::PointSetError>(())
/// ```
///
/// F. Aurenhammer, "Power diagrams: properties, algorithms and applications", SIAM J. Comput. 16(1),
/// 1987.
#[derive(Clone, Debug, Default)]
pub struct PowerDiagram {
    /// By which cells and edges are measured, evenly if there is none.
    density: Option<Arc<DensityIntegrals>>,
    cells: Vec<VoronoiCell>,
    /// The edges of cells in chunks of [`CHUNK`].
    chunks: Vec<Chunk>,
}

/// Whose cell lies beyond an edge of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PowerNeighbor {
    /// Index of the neighbour; the point itself where its cell meets its own copy.
    pub index: u32,
    /// The vector from the point to that copy of the neighbour whose cell it is.
    pub displacement: DVec2,
}

/// An edge of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PowerEdge {
    /// What lies beyond.
    pub neighbor: PowerNeighbor,
    /// Where the edge begins, counter-clockwise around the cell, relative to the point.
    pub corner: DVec2,
    /// Its length.
    pub length: f64,
    /// The density's integral along it: the length where the density is uniform.
    pub mass: f64,
}

/// Cells that one task cuts.
const CHUNK: usize = 256;

/// Below this many points threads take longer to wake up than the work takes.
const PARALLEL: usize = 4 * CHUNK;

/// The edges of up to [`CHUNK`] cells, and memory to work in.
#[derive(Clone, Debug, Default)]
struct Chunk {
    edges: Vec<PowerEdge>,
    /// Cell i of the chunk has the edges `ends[i − 1]..ends[i]`.
    ends: Vec<u32>,
    polygon: Polygon,
    /// The edges before an update.
    old: (Vec<PowerEdge>, Vec<u32>),
}

impl PowerDiagram {
    /// The diagram of a set with one weight a point, in squared unit lengths.
    ///
    /// # Panics
    /// If there is not one weight for each point, or one is not finite.
    pub fn new(set: &PointSet, weights: &[f64]) -> Self {
        let mut diagram = Self::default();
        diagram.update(set, weights);
        diagram
    }

    /// The diagram of no points, to be updated, whose cells are measured by a density: their areas are
    /// masses, their centroids and moments those of the mass.
    pub fn of_density(density: Arc<DensityIntegrals>) -> Self {
        Self { density: Some(density), ..Self::default() }
    }

    /// Makes this the diagram of other points and weights.
    ///
    /// As good as a new one, but faster where the points and weights are about the old ones: a cell
    /// is first cut by its former neighbours. No memory is allocated if there was enough. The
    /// result may differ from that of [`PowerDiagram::new`] by rounding.
    ///
    /// # Panics
    /// As [`PowerDiagram::new`].
    pub fn update(&mut self, set: &PointSet, weights: &[f64]) {
        assert_eq!(weights.len(), set.len(), "one weight for each point");
        assert!(weights.iter().all(|w| w.is_finite()), "weights are finite");
        let n = set.len();
        if self.cells.len() != n {
            self.cells.clear();
            self.cells.resize(n, VoronoiCell::EMPTY);
            self.chunks.clear();
            self.chunks.resize(n.div_ceil(CHUNK), Chunk::default());
        }
        let grid = CellGrid::new(set);
        let sites = Sites::new(set.points(), weights, &grid);
        let density = self.density.as_deref();
        let cut = |(k, (chunk, cells)): (usize, (&mut Chunk, &mut [VoronoiCell]))| {
            chunk.cut(&sites, density, k * CHUNK, cells);
        };
        if n < PARALLEL {
            self.chunks.iter_mut().zip(self.cells.chunks_mut(CHUNK)).enumerate().for_each(cut);
        } else {
            let cells = self.cells.par_chunks_mut(CHUNK);
            self.chunks.par_iter_mut().zip(cells).enumerate().for_each(cut);
        }
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.cells.len()
    }

    /// Whether this is the diagram of no point, which only a default one is.
    pub fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    /// The measures of the cells, by index of their points; [`VoronoiCell::EMPTY`] for hidden points, and
    /// where there is no mass.
    pub fn cells(&self) -> &[VoronoiCell] {
        &self.cells
    }

    /// The edges of the cell of point `index`, counter-clockwise; none if the point is hidden.
    ///
    /// # Panics
    /// If there is no such point.
    pub fn edges(&self, index: usize) -> &[PowerEdge] {
        assert!(index < self.cells.len(), "point {index} of {}", self.cells.len());
        self.chunks[index / CHUNK].edges_of(index % CHUNK)
    }

    /// Σ ∫ |x − pᵢ|² over the cells: with the weights that give all cells the same area, the cost
    /// of carrying the uniform distribution (or the density) to the points at best. Added up in the
    /// order of the points.
    pub fn transport_cost(&self) -> f64 {
        self.cells.iter().map(|cell| cell.second_moment).sum()
    }
}

impl Chunk {
    fn edges_of(&self, cell: usize) -> &[PowerEdge] {
        let start = if cell == 0 { 0 } else { self.ends[cell - 1] };
        &self.edges[start as usize..self.ends[cell] as usize]
    }

    /// Cuts the cells of the points from `first` on.
    fn cut(
        &mut self,
        sites: &Sites,
        density: Option<&DensityIntegrals>,
        first: usize,
        cells: &mut [VoronoiCell],
    ) {
        std::mem::swap(&mut self.edges, &mut self.old.0);
        std::mem::swap(&mut self.ends, &mut self.old.1);
        self.edges.clear();
        self.ends.clear();
        let mut start = 0;
        for (i, cell) in cells.iter_mut().enumerate() {
            let end = self.old.1.get(i).map_or(0, |&end| end as usize);
            let former = &self.old.0[start..end];
            start = end;
            sites.cut_cell(first + i, former, &mut self.polygon);
            let start_of_edges = self.edges.len();
            *cell = match density {
                None => self.polygon.measure(&mut self.edges),
                Some(density) => {
                    self.polygon.measure_mass(density, sites.place(first + i), &mut self.edges)
                }
            };
            if cell.area == 0.0 {
                self.edges.truncate(start_of_edges);
            }
            self.ends.push(self.edges.len() as u32);
        }
    }
}
