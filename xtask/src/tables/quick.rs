//! What `--quick` must give, measured over many seeds.

use std::collections::BTreeMap;

use bn_cli::{Outcome, output};

use super::QUICK;
use crate::measure::{Measured, Plan, Workbench};
use crate::thesis::{Quantity, QuickExpected, Rows};
use crate::workspace;

/// The first of the seeds that expected values come from: none that the tables use.
const FIRST_SEED: u64 = 1001;

/// Runs every row `runs` times with different seeds and stores mean and deviation of the values in
/// `xtask/data/quick_expected.toml`.
pub(super) fn record(runs: u32) -> Outcome {
    let mut values: BTreeMap<(String, Quantity), Vec<f64>> = BTreeMap::new();
    let rows = Rows::load()?;
    for run in 0..u64::from(runs) {
        let plan = Plan { seed: FIRST_SEED + run, ..QUICK };
        let workbench = Workbench::new(plan, Quantity::ALL.into());
        // Where the seed makes no difference one run tells all.
        let varies = |method: Option<&bn_samplers::Method>| method.is_some_and(|m| m.seeded);
        for row in rows.iter().filter(|row| run == 0 || varies(row.method())) {
            let Measured::Values(measured) = &*workbench.measure(row)? else { continue };
            for (&quantity, estimate) in measured {
                if let Some(estimate) = estimate {
                    let key = (row.method.clone(), quantity);
                    values.entry(key).or_default().push(estimate.value);
                }
            }
        }
    }
    let mut expected = QuickExpected::default();
    for ((method, quantity), values) in &values {
        expected.record(method, *quantity, values);
    }
    let head = format!(
        "What `cargo xtask tables --quick` must give. Generated: cargo xtask tables --record-quick {runs}\n\
         {} sets of {} points; mean and standard deviation over {runs} seeds from {FIRST_SEED} on.",
        QUICK.sets, QUICK.n
    );
    let path = workspace::root()?.join("xtask/data/quick_expected.toml");
    output::write_file(&path, |w| Ok(w.write_all(expected.to_toml(&head).as_bytes())?))?;
    eprintln!("wrote {}", path.display());
    Ok(())
}
