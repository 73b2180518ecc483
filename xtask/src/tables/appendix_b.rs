//! Appendix B: all statistics of all patterns (pp. 107–120).

use super::{TableSpec, statistics};
use crate::thesis::Quantity;

pub(super) const SPEC: TableSpec = TableSpec {
    id: "B",
    title: "Statistics of important sampling patterns (appendix B)",
    quantities: &Quantity::ALL,
    make: statistics::table,
};
