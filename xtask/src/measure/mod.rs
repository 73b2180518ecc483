//! Point sets and their statistics, each made and measured once a run whatever tables ask for it.

pub(crate) mod course;
mod curves;
pub(crate) mod downsampling;
pub(crate) mod imitation;
pub(crate) mod make;
pub(crate) mod noise;
pub(crate) mod reconstruction;
mod store;
pub(crate) mod trace;

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::rc::Rc;
use std::time::Instant;

use bn_cli::Outcome;
use bn_cli::analysis::{Analysis, Estimate};
use bn_core::PointSet;
use bn_samplers::Method;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::thesis::{Quantity, RowSpec};
pub(crate) use store::{Store, hash_points, program_digest};

/// How many points, in how many sets, from which seed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Plan {
    pub(crate) n: usize,
    pub(crate) sets: u32,
    pub(crate) seed: u64,
}

/// Makes and measures the rows' point sets.
pub(crate) struct Workbench {
    plan: Plan,
    /// What is measured of every row: what the tables of this run ask for.
    quantities: Vec<Quantity>,
    /// Where point sets are kept, if they are.
    store: Option<Store>,
    /// Where the curves of each row are written, if they are.
    curves: Option<PathBuf>,
    measured: RefCell<BTreeMap<String, Rc<Measured>>>,
}

/// What came of a row.
#[derive(Clone, Debug)]
pub(crate) enum Measured {
    /// The registry has no such method.
    NotYet,
    /// The method gave no points.
    Failed(String),
    /// The statistics, where they can be measured.
    Values(BTreeMap<Quantity, Option<Estimate>>),
}

impl Workbench {
    /// A workbench that measures `quantities`; it keeps nothing on disk.
    pub(crate) fn new(plan: Plan, quantities: Vec<Quantity>) -> Self {
        Self { plan, quantities, store: None, curves: None, measured: RefCell::default() }
    }

    /// The same, keeping point sets in `store` and writing each row's curves into `curves`.
    pub(crate) fn keeping(self, store: Store, curves: PathBuf) -> Self {
        Self { store: Some(store), curves: Some(curves), ..self }
    }

    pub(crate) fn plan(&self) -> Plan {
        self.plan
    }

    /// Where point sets are kept, if they are.
    pub(crate) fn store(&self) -> Option<&Store> {
        self.store.as_ref()
    }

    /// The row's statistics; measured when first asked for.
    pub(crate) fn measure(&self, row: &RowSpec) -> Outcome<Rc<Measured>> {
        if let Some(measured) = self.measured.borrow().get(&row.method) {
            return Ok(Rc::clone(measured));
        }
        let measured = Rc::new(match row.method() {
            None => Measured::NotYet,
            Some(method) => self.measure_method(row, method)?,
        });
        self.measured.borrow_mut().insert(row.method.clone(), Rc::clone(&measured));
        Ok(measured)
    }

    fn measure_method(&self, row: &RowSpec, method: &'static Method) -> Outcome<Measured> {
        let start = Instant::now();
        let (sets, made) = match make::sets(row, method, self.plan, self.store.as_ref())? {
            Ok(sets) => sets,
            Err(error) => return Ok(Measured::Failed(error.to_string())),
        };
        if sets.iter().any(|set| set.len() != sets[0].len()) {
            return Ok(Measured::Failed("its sets differ in size".to_owned()));
        }
        let making = start.elapsed().as_secs_f64();
        let start = Instant::now();
        let analysis = Analysis::of(&sets);
        let values =
            self.quantities.iter().map(|&q| (q, analysis.estimate(q.statistic()))).collect();
        let spectral = self.quantities.iter().any(|quantity| quantity.is_spectral());
        if let Some(folder) = self.curves.as_ref().filter(|_| spectral) {
            curves::write(folder, &row.method, &analysis)?;
        }
        let measuring = start.elapsed().as_secs_f64();
        let count = sets.len();
        eprintln!(
            "{:<24} {made} of {count} sets made in {making:.2} s, measured in {measuring:.2} s",
            row.method
        );
        Ok(Measured::Values(values))
    }

    /// The point sets of several rows, made side by side: for each at most so many, or the reason
    /// why the method gave none.
    pub(crate) fn point_sets(
        &self,
        rows: &[(RowSpec, u32)],
    ) -> Outcome<Vec<Result<Vec<PointSet>, String>>> {
        let (plan, store) = (self.plan, self.store.as_ref());
        let of = |(row, most): &(RowSpec, u32)| {
            let Some(method) = row.method() else { return Ok(Err("no such method".to_owned())) };
            let made = make::sets(row, method, Plan { sets: plan.sets.min(*most), ..plan }, store)?;
            Ok(made.map(|(sets, _)| sets).map_err(|error| error.to_string()))
        };
        rows.par_iter().map(of).collect()
    }
}
