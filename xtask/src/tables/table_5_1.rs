//! Table 5.1: Hankel transform pairs, each closed form against the numerical transform.

use std::f64::consts::{PI, TAU};

use bn_cli::Outcome;
use bn_cli::analysis::Estimate;
use bn_spectral::{HankelPlan, jinc};

use super::{Cell, Context, Row, Table, TableSpec};
use crate::thesis::{Judgement, Verdict};

pub(super) const SPEC: TableSpec = TableSpec {
    id: "5.1",
    title: "Hankel transform pairs, closed form against numerical transform",
    quantities: &[],
    make,
};

/// Digits to which a closed form must agree: the numerical transform promises an error of 1e-12 of
/// 2π ∫ r |f| dr, and the closed forms have rounding errors of their own.
const PROMISED: f64 = 11.0;
/// More than double precision has, for masses up to 400.
const MOST: f64 = 20.0;
/// A wrong form may agree to this many digits where its transform is small.
const WRONG: f64 = 1.5;
/// Frequencies at which a pair is compared.
const FREQUENCIES: usize = 400;
const HIGHEST: f64 = 20.0;
/// Beyond this a Gaussian of width 1 is 0 in double precision.
const END: f64 = 6.5;

/// A function, its smooth range, its transform in closed form, and 2π ∫ r |f| dr.
struct Pair {
    label: &'static str,
    end: f64,
    f: fn(f64) -> f64,
    transform: fn(f64) -> f64,
    /// What the thesis prints, if that is something else.
    printed: Option<fn(f64) -> f64>,
    mass: f64,
}

/// Why the printed forms don't hold.
const ERRATUM: &str = "with jinc(x) = J1(x)/x, as the thesis defines it, jinc's argument lacks a factor of π; \
                       as printed the pair holds for jinc(x) = J1(πx)/(πx)";

fn gaussian(x: f64) -> f64 {
    libm::exp(-PI * x * x)
}

fn disk(u: f64) -> f64 {
    TAU * jinc(TAU * u)
}

const PAIRS: [Pair; 5] = [
    Pair {
        label: "disk(r) to 2π jinc(2πu)",
        end: 1.0,
        f: |_| 1.0,
        transform: disk,
        printed: Some(|u| TAU * jinc(2.0 * u)),
        mass: PI,
    },
    Pair {
        label: "H(r − a) − 1 to −2πa² jinc(2πua), a = 1/2",
        end: 0.5,
        f: |_| -1.0,
        transform: |u| -0.25 * disk(0.5 * u),
        printed: Some(|u| -TAU * 0.25 * jinc(u)),
        mass: PI / 4.0,
    },
    Pair {
        label: "linearity: 2 exp(−πr²) − 3 exp(−π(r/2)²)",
        end: 2.0 * END,
        f: |r| 2.0 * gaussian(r) - 3.0 * gaussian(r / 2.0),
        transform: |u| 2.0 * gaussian(u) - 12.0 * gaussian(2.0 * u),
        printed: None,
        mass: 14.0,
    },
    Pair {
        label: "scaling: f(ar) to F(u/a)/a², a = 3",
        end: END / 3.0,
        f: |r| gaussian(3.0 * r),
        transform: |u| gaussian(u / 3.0) / 9.0,
        printed: None,
        mass: 1.0 / 9.0,
    },
    Pair {
        label: "constant 1 to δ(u)/2πu, seen through exp(−π(r/20)²)",
        // 400 exp(−400πu²) has the mass 1 and tends to the delta.
        end: 20.0 * END,
        f: |r| gaussian(r / 20.0),
        transform: |u| 400.0 * gaussian(20.0 * u),
        printed: None,
        mass: 400.0,
    },
];

impl Pair {
    /// Digits to which the numerical transform agrees with `closed`, relative to the mass.
    fn digits(&self, closed: fn(f64) -> f64) -> f64 {
        let u: Vec<f64> =
            (0..FREQUENCIES).map(|i| HIGHEST * i as f64 / FREQUENCIES as f64).collect();
        let numerical = HankelPlan::new(&[0.0, self.end], 0.5, &u).transform(self.f);
        let errors = u.iter().zip(numerical).map(|(&u, got)| (got - closed(u)).abs());
        -(errors.fold(f64::EPSILON * self.mass, f64::max) / self.mass).log10()
    }

    fn row(&self) -> Row {
        let mut cells = vec![cell("digits", self.digits(self.transform), PROMISED, MOST, None)];
        if let Some(printed) = self.printed {
            cells.push(cell("digits, as printed", self.digits(printed), 0.0, WRONG, Some(ERRATUM)));
        }
        Row {
            label: self.label.to_owned(),
            method: String::new(),
            options: String::new(),
            why: String::new(),
            failure: None,
            cells,
        }
    }
}

/// A number of digits that must lie between two others.
fn cell(name: &str, digits: f64, least: f64, most: f64, reason: Option<&str>) -> Cell {
    let verdict = match (least <= digits && digits <= most, reason) {
        (false, _) => Verdict::Outside,
        (true, None) => Verdict::Agrees,
        (true, Some(_)) => Verdict::Explained,
    };
    let judgement = Judgement {
        thesis: None,
        expected: Some((least, most)),
        tolerance: Some(0.0),
        reason: reason.map(str::to_owned),
        verdict,
    };
    Cell::new(&name, Some(Estimate { value: digits, std_error: None }), judgement)
}

#[expect(clippy::unnecessary_wraps, reason = "all tables are made by functions of one type")]
fn make(spec: &TableSpec, _: &Context<'_>) -> Outcome<Table> {
    let rows = PAIRS.iter().map(Pair::row).collect();
    Ok(Table { id: spec.id, title: spec.title, decimals: 1, rows })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pair_agrees() {
        for pair in &PAIRS {
            let digits = pair.digits(pair.transform);
            assert!(digits >= PROMISED, "{}: {digits}", pair.label);
        }
    }
}
