//! What is known of blocks of pixels before any sample is taken.

use std::ops::Range;

use super::BLOCK;
use crate::{Color, Rect, Scene, Window};

/// One row of blocks of 32 × 32 pixels, aligned with the image's corner.
///
/// Each block has a reference: the scene's value at the centre of the block (of its part within
/// the image). Pixels are accumulated relative to it, so that where the scene is constant nothing
/// is accumulated at all and the result is the constant to the last bit.
pub(super) struct BlockRow {
    /// The first of the blocks' indices.
    first: i64,
    blocks: Vec<Block>,
    /// References of each channel, column by column of the accumulation planes.
    columns: Vec<f64>,
    width: usize,
}

/// A block of pixels that is wanted at least in part.
#[derive(Clone, Copy)]
struct Block {
    reference: Color,
    /// The value of all samples that reach the block, if they have one.
    constant: Option<Color>,
}

/// Where blocks lie and who asks.
pub(super) struct BlockPlan<'a> {
    pub(super) scene: &'a dyn Scene,
    pub(super) image: (u32, u32),
    pub(super) window: Window,
    pub(super) kernel_radius: f64,
    /// The pixel columns of the accumulation planes.
    pub(super) columns: Range<i64>,
}

impl BlockPlan<'_> {
    /// The blocks of row `row` that meet the window; none if the row misses it.
    pub(super) fn row(&self, row: i64) -> BlockRow {
        let width = (self.columns.end - self.columns.start) as usize;
        let channels = self.scene.channels().count();
        let mut columns = vec![0.0; channels * width];
        let meets = block_range(self.window.y, self.window.height).contains(&row);
        let indices = block_range(self.window.x, self.window.width);
        let first = indices.start;
        let blocks: Vec<Block> = if meets {
            indices.map(|column| self.block(column, row)).collect()
        } else {
            Vec::new()
        };
        for (i, block) in blocks.iter().enumerate() {
            let start = (first + i as i64) * BLOCK - self.columns.start;
            let covered = start.max(0) as usize..((start + BLOCK) as usize).min(width);
            for (plane, &reference) in columns.chunks_exact_mut(width).zip(&block.reference) {
                plane[covered.clone()].fill(reference);
            }
        }
        BlockRow { first, blocks, columns, width }
    }

    fn block(&self, column: i64, row: i64) -> Block {
        let span = |index: i64, side: u32| {
            let start = index * BLOCK;
            (start as f64, (start + BLOCK).min(i64::from(side)) as f64)
        };
        let (u, v) = (span(column, self.image.0), span(row, self.image.1));
        let rect = Rect::new(u.0, v.0, u.1, v.1);
        let constant = self.scene.constant_over(&rect.expanded(self.kernel_radius));
        let reference = constant.unwrap_or_else(|| self.scene.value(rect.center()));
        Block { reference, constant }
    }
}

impl BlockRow {
    /// One reference for `width` columns, blocks unknown.
    pub(super) fn uniform(reference: Color, channels: usize, width: usize) -> Self {
        let columns = reference[..channels].iter().flat_map(|&c| std::iter::repeat_n(c, width));
        Self { first: 0, blocks: Vec::new(), columns: columns.collect(), width }
    }

    /// References of channel `channel` along the accumulation planes' columns.
    pub(super) fn references(&self, channel: usize) -> &[f64] {
        &self.columns[channel * self.width..][..self.width]
    }

    /// The constant of block `column`, if it is wanted and has one.
    pub(super) fn constant(&self, column: i64) -> Option<Color> {
        self.get(column).and_then(|block| block.constant)
    }

    /// Whether any of these blocks is wanted and not constant.
    pub(super) fn any_varies(&self, mut columns: Range<i64>) -> bool {
        columns.any(|column| self.get(column).is_some_and(|block| block.constant.is_none()))
    }

    /// Number of references that had to be evaluated.
    pub(super) fn evaluated(&self) -> u64 {
        self.blocks.iter().filter(|block| block.constant.is_none()).count() as u64
    }

    fn get(&self, column: i64) -> Option<&Block> {
        usize::try_from(column - self.first).ok().and_then(|i| self.blocks.get(i))
    }
}

/// The indices of the blocks that pixels start … start + length − 1 lie in.
pub(super) fn block_range(start: u32, length: u32) -> Range<i64> {
    let (start, length) = (i64::from(start), i64::from(length));
    start / BLOCK..(start + length - 1) / BLOCK + 1
}
