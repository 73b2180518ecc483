//! Table 4.2: geometric measures of uniformity.

use super::{TableSpec, statistics};
use crate::thesis::Quantity;

pub(super) const SPEC: TableSpec = TableSpec {
    id: "4.2",
    title: "Geometric measures of uniformity for common irregular sampling patterns",
    quantities: &[Quantity::DMin, Quantity::DAvg, Quantity::RC],
    make: statistics::table,
};
