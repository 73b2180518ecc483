//! Table 5.2: frequency and spatial statistics of step and single-peak blue noise and others.

use super::{TableSpec, statistics};
use crate::thesis::Quantity;

pub(super) const SPEC: TableSpec = TableSpec {
    id: "5.2",
    title: "Frequency and spatial statistics of step and single-peak blue noise and others",
    quantities: &[Quantity::NuEff, Quantity::Omega, Quantity::DMin, Quantity::DAvg, Quantity::RC],
    make: statistics::table,
};
