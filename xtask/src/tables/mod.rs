//! `cargo xtask tables`: the thesis's tables with our values beside the printed ones.

mod appendix_b;
mod kept;
mod markdown;
mod model;
mod quick;
mod reconstruction;
mod statistics;
mod table_3_1;
mod table_4_1;
mod table_4_2;
mod table_5_1;
mod table_5_2;
mod table_5_3;
mod tally;
mod write;

use std::collections::BTreeSet;
use std::path::PathBuf;

use bn_cli::{Failure, Outcome, output};
use clap::Args;

use crate::measure::{Plan, Store, Workbench};
use crate::thesis::{Judge, Quantity, Rows};
use crate::workspace;
pub(crate) use kept::Kept;
use kept::Maker;
pub(crate) use model::{Cell, Row, Table};
pub(crate) use tally::Tally;

/// A table of the thesis and how it is made. One file each; the list below is the registry.
pub(crate) struct TableSpec {
    /// Its number in the thesis.
    id: &'static str,
    title: &'static str,
    /// The statistics of point sets that it prints.
    quantities: &'static [Quantity],
    /// Makes it.
    make: fn(&TableSpec, &Context<'_>) -> Outcome<Table>,
}

/// What a table is made from.
pub(crate) struct Context<'a> {
    rows: &'a Rows,
    judge: &'a Judge,
    workbench: &'a Workbench,
}

/// The thesis's tables in its order, and one that answers its outlook.
static TABLES: [TableSpec; 8] = [
    table_3_1::SPEC,
    table_4_1::SPEC,
    table_4_2::SPEC,
    table_5_1::SPEC,
    table_5_2::SPEC,
    table_5_3::SPEC,
    reconstruction::SPEC,
    appendix_b::SPEC,
];

/// The thesis's tables: its value, ours, the difference, the tolerance and a verdict
#[derive(Debug, Args)]
pub(crate) struct TablesArgs {
    /// Only this table: 3.1, 4.1, 4.2, 5.1, 5.2, 5.3, reconstruction or B
    #[arg(long, value_name = "TABLE")]
    table: Option<String>,
    /// Number of sets to average
    #[arg(long, value_name = "K", default_value = "10",
          value_parser = clap::value_parser!(u32).range(1..=10_000))]
    sets: u32,
    /// Points in each set
    #[arg(short, long = "points", value_name = "N", default_value = "4096",
          value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    n: u32,
    /// 2 sets of 1024 points against stored expected values; nothing is kept on disk but the tables
    #[arg(long, conflicts_with_all = ["sets", "n", "fresh"])]
    quick: bool,
    /// A copy of the JSON output in this file
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Make all point sets again instead of reading those that are kept
    #[arg(long)]
    fresh: bool,
    /// Measure what --quick gives for many seeds and store it as what it must give
    #[arg(long, hide = true, value_name = "RUNS", num_args = 0..=1, default_missing_value = "40",
          value_parser = clap::value_parser!(u32).range(2..=10_000),
          conflicts_with_all = ["sets", "n", "fresh", "quick", "json", "table"])]
    record_quick: Option<u32>,
}

impl TablesArgs {
    /// What CI runs.
    pub(crate) fn for_ci() -> Self {
        let (table, json) = (None, None);
        Self { table, sets: 10, n: 4096, quick: true, json, fresh: false, record_quick: None }
    }
}

/// What `--quick` makes.
const QUICK: Plan = Plan { n: 1024, sets: 2, seed: 1 };

/// What the thesis's tables were made from.
const FULL: Plan = Plan { n: 4096, sets: 10, seed: 1 };

pub(crate) fn run(args: &TablesArgs) -> Outcome {
    if let Some(runs) = args.record_quick {
        return quick::record(runs);
    }
    let wanted = select(args.table.as_deref())?;
    let workshop = if args.quick {
        Workshop::quick(&wanted)?
    } else {
        let plan = Plan { n: args.n as usize, sets: args.sets, seed: 1 };
        Workshop::new(plan, &wanted, args.fresh)?
    };
    let (mut tables, mut tallies) = (Vec::new(), Vec::new());
    for spec in wanted {
        let (table, Kept { tally, text, .. }) = workshop.make(spec)?;
        output::write_stdout(|w| Ok(writeln!(w, "{text}")?))?;
        tables.push(table);
        tallies.push(tally);
    }
    let plan = workshop.maker.plan;
    write::json(&workshop.folder.join("tables.json"), &tables, plan)?;
    if let Some(path) = &args.json {
        write::json(path, &tables, plan)?;
    }
    Tally::sum(tallies.iter()).outcome()
}

/// All tables by their numbers. Those that this very program has made for the same points are not
/// made again, unless `fresh`.
pub(crate) fn all(quick: bool, fresh: bool) -> Outcome<Vec<(&'static str, Kept)>> {
    let folder = folder(quick)?;
    let maker = Maker::this(if quick { QUICK } else { FULL })?;
    let kept = |spec: &TableSpec| Kept::read(&folder, &write::name(spec.id), &maker);
    let kept: Vec<_> = TABLES.iter().map(|spec| kept(spec).filter(|_| !fresh)).collect();
    let is_missing = |(_, kept): &(_, &Option<Kept>)| kept.is_none();
    let missing: Vec<_> =
        TABLES.iter().zip(&kept).filter(is_missing).map(|(spec, _)| spec).collect();
    let workshop =
        if quick { Workshop::quick(&missing)? } else { Workshop::new(FULL, &missing, false)? };
    let table = |(spec, kept): (&'static TableSpec, Option<Kept>)| match kept {
        Some(kept) => Ok((spec.id, kept)),
        None => Ok((spec.id, workshop.make(spec)?.1)),
    };
    TABLES.iter().zip(kept).map(table).collect()
}

/// Makes tables and keeps them in a folder.
struct Workshop {
    rows: Rows,
    judge: Judge,
    workbench: Workbench,
    folder: PathBuf,
    maker: Maker,
}

/// Where tables are kept.
fn folder(quick: bool) -> Outcome<PathBuf> {
    Ok(workspace::root()?.join(if quick { "target/thesis/quick" } else { "target/thesis" }))
}

impl Workshop {
    /// For the quick forms of `tables`; point sets are not kept.
    fn quick(tables: &[&TableSpec]) -> Outcome<Self> {
        let workbench = Workbench::new(QUICK, quantities(tables));
        Ok(Self {
            rows: Rows::load()?,
            judge: Judge::for_quick()?,
            workbench,
            folder: folder(true)?,
            maker: Maker::this(QUICK)?,
        })
    }

    /// For `tables` by a plan; `fresh` makes point sets again that are kept.
    fn new(plan: Plan, tables: &[&TableSpec], fresh: bool) -> Outcome<Self> {
        let folder = folder(false)?;
        let workbench = Workbench::new(plan, quantities(tables)).keeping(
            Store::new(folder.join("points"), !fresh),
            folder.join(format!("curves/n{}_sets{}", plan.n, plan.sets)),
        );
        let judge = Judge::for_thesis(plan.n, plan.sets)?;
        Ok(Self { rows: Rows::load()?, judge, workbench, folder, maker: Maker::this(plan)? })
    }

    /// Makes a table, writes it down and keeps it.
    fn make(&self, spec: &TableSpec) -> Outcome<(Table, Kept)> {
        let Self { rows, judge, workbench, folder, maker } = self;
        let table = (spec.make)(spec, &Context { rows, judge, workbench })?;
        let text = write::table(folder, &table, maker.plan)?;
        let kept = Kept::new(*maker, Tally::of(table.cells()), text);
        kept.write(folder, &write::name(spec.id))?;
        Ok((table, kept))
    }
}

/// The tables asked for.
fn select(id: Option<&str>) -> Outcome<Vec<&'static TableSpec>> {
    let Some(id) = id else { return Ok(TABLES.iter().collect()) };
    if let Some(spec) = TABLES.iter().find(|spec| spec.id.eq_ignore_ascii_case(id)) {
        return Ok(vec![spec]);
    }
    let known: Vec<_> = TABLES.iter().map(|spec| spec.id).collect();
    Err(Failure::misuse(format!("no table {id}; there are {}", known.join(", "))))
}

/// All that the tables print of point sets.
fn quantities(tables: &[&TableSpec]) -> Vec<Quantity> {
    let all: BTreeSet<_> = tables.iter().flat_map(|spec| spec.quantities).copied().collect();
    all.into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_selected_by_number() {
        assert_eq!(select(None).expect("all").len(), 8);
        assert_eq!(select(Some("b")).expect("one")[0].id, "B");
        let error = select(Some("9.9")).err().expect("unknown");
        assert_eq!(error.code(), Failure::USAGE);
        assert!(error.to_string().contains("3.1, 4.1, 4.2"), "{error}");
    }

    #[test]
    fn only_what_is_printed_is_measured() {
        let asked = |id| quantities(&select(Some(id)).expect("made"));
        assert_eq!(asked("3.1"), [Quantity::DAvg, Quantity::NuEff, Quantity::Omega]);
        assert_eq!(asked("B"), Quantity::ALL);
    }
}
