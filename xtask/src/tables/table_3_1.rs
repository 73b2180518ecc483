//! Table 3.1: the effective Nyquist frequency and the oscillation of common patterns.

use super::{TableSpec, statistics};
use crate::thesis::Quantity;

pub(super) const SPEC: TableSpec = TableSpec {
    id: "3.1",
    title: "Effective Nyquist frequency and oscillation of common sampling patterns",
    quantities: &[Quantity::NuEff, Quantity::Omega, Quantity::DAvg],
    make: statistics::table,
};
