//! What the thesis says, which of our rows stands for which of its rows, and when a value of ours
//! agrees. All numbers are data, under `xtask/data/`.

mod counts;
mod expected;
mod judge;
mod psnr;
mod quantity;
mod rows;
mod values;

pub(crate) use counts::Counts;
pub(crate) use expected::{Expected, QuickExpected};
pub(crate) use judge::{Judge, Judgement, Verdict};
pub(crate) use quantity::Quantity;
pub(crate) use rows::{RowSpec, Rows};
pub(crate) use values::ThesisValues;
