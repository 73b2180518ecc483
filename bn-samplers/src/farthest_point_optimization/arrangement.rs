//! Points on their way to the best places, whoever keeps track of them.

use bn_core::DVec2;

use super::blocks::Blocks;
use super::field::Field;
use super::swarm::Swarm;

/// Points on their way to the best places.
pub(super) trait Arrangement {
    /// The points in the caller's order.
    fn points(&self) -> Vec<DVec2>;

    /// How far apart they are.
    fn spread(&self) -> Spread;

    /// Visits every point, given the present `d_min`.
    fn sweep(&mut self, search: Search, d_min: f64) -> Moves;
}

/// What points did in a sweep.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Moves {
    /// How many moved.
    pub(super) count: usize,
    /// The longest way, infinite if it led to a hole that the point did not touch.
    pub(super) longest: f64,
}

impl Moves {
    pub(super) fn and(self, other: Self) -> Self {
        Self { count: self.count + other.count, longest: self.longest.max(other.longest) }
    }
}

/// Where a point looks for a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Search {
    /// Everywhere in its torus or block.
    Global,
    /// Among the faces at its neighbours.
    Local,
}

/// Distances to nearest neighbours, each as long as it is in the field.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spread {
    pub(super) min: f64,
    pub(super) mean: f64,
}

impl Spread {
    pub(super) fn new(
        distances: &[f64],
        places: impl Iterator<Item = DVec2>,
        field: &impl Field,
    ) -> Self {
        let (mut min, mut sum) = (f64::INFINITY, 0.0);
        for (distance, place) in distances.iter().zip(places) {
            let scaled = distance * field.root(place);
            min = scaled.min(min);
            sum += scaled;
        }
        Self { min, mean: sum / distances.len() as f64 }
    }
}

/// Points that are moved block by block for some sweeps, and from then on the torus over.
#[derive(Debug)]
pub(super) enum Stages<F> {
    /// In blocks for so many sweeps more.
    Blocks(Blocks<F>, u32),
    /// On the whole torus.
    Whole(Box<Swarm<F>>),
}

impl<F: Field + Clone + Sync> Arrangement for Stages<F> {
    fn points(&self) -> Vec<DVec2> {
        match self {
            Self::Blocks(blocks, _) => blocks.points(),
            Self::Whole(swarm) => swarm.points(),
        }
    }

    fn spread(&self) -> Spread {
        match self {
            Self::Blocks(blocks, _) => blocks.spread(),
            Self::Whole(swarm) => swarm.spread(),
        }
    }

    fn sweep(&mut self, search: Search, d_min: f64) -> Moves {
        if let Self::Blocks(blocks, 0) = self {
            *self = Self::Whole(Box::new(blocks.to_swarm()));
        }
        match self {
            Self::Blocks(blocks, sweeps) => {
                *sweeps -= 1;
                blocks.sweep(search, d_min)
            }
            Self::Whole(swarm) => swarm.sweep(search, d_min),
        }
    }
}
