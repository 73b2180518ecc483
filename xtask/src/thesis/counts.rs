//! When a number of iterations agrees with the thesis.

use super::judge::Basis;
use super::values::PrintedCount;
use super::{Judge, Judgement, Verdict};

/// How a method's counts of iterations compare with the thesis's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Counts {
    /// The same algorithm: as many, up to chance.
    Alike,
    /// As many or fewer.
    AtMost,
    /// Another algorithm, for this reason.
    NotComparable(&'static str),
}

/// Part of a count by which ours may differ.
const RELATIVE: f64 = 0.25;

/// Where counts are small, the thesis's rounding and one iteration of chance.
const ABSOLUTE: f64 = 1.0;

impl Judge {
    /// Judges the iterations `reached` by each run (none: never; no runs: no such method) against
    /// what the thesis prints under `key`.
    ///
    /// What the thesis reached in some runs only, or never, is a matter of single unlucky points,
    /// so that the mean over the others says little: it is not judged. Where all its runs got there,
    /// all of ours must.
    pub(crate) fn judge_count(
        &self,
        table: &str,
        method: &str,
        key: &str,
        reached: Option<&[Option<u64>]>,
        counts: Counts,
    ) -> Judgement {
        let printed = self.thesis().count(table, method, key);
        let thesis = printed.and_then(PrintedCount::mean);
        let Some(reached) = reached else {
            return Judgement { thesis, ..Judgement::not_judged(None, Verdict::NotYet) };
        };
        let known: Vec<f64> = reached.iter().flatten().map(|&count| count as f64).collect();
        let some = format!("reached in {} of {} runs", known.len(), reached.len());
        let partly = (known.len() < reached.len()).then_some(some);
        let reason = match (counts, partly) {
            (Counts::NotComparable(why), Some(partly)) => Some(format!("{why}; {partly}")),
            (Counts::NotComparable(why), None) => Some(why.to_owned()),
            (_, partly) => partly,
        };
        let complete = known.len() == reached.len() && !known.is_empty();
        let ours = complete.then(|| known.iter().sum::<f64>() / known.len() as f64);
        let judged = matches!(self.basis(), Basis::Thesis);
        let expected = match (counts, printed) {
            (Counts::Alike, Some(PrintedCount::EveryRun(count))) => Some((count, count)),
            (Counts::AtMost, Some(PrintedCount::EveryRun(count))) => Some((0.0, count)),
            _ => None,
        };
        let judgement = match expected.filter(|_| judged) {
            Some(range) => {
                let tolerance = (RELATIVE * range.1).max(ABSOLUTE);
                Judgement::held_against(ours, range, tolerance, reason, Verdict::Agrees)
            }
            None => Judgement::not_judged(reason, Verdict::NotJudged),
        };
        Judgement { thesis, ..judgement }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn verdict(method: &str, level: &str, runs: Option<&[Option<u64>]>, counts: Counts) -> Verdict {
        let judge = Judge::for_thesis(4096, 10).expect("the embedded files parse");
        let key = format!("iterations_to_{level}");
        judge.judge_count("4.1", method, &key, runs, counts).verdict
    }

    #[test]
    fn fewer_iterations_are_as_good() {
        let of =
            |count| verdict("fpo_global", "d_min_0.925", Some(&[Some(count); 2]), Counts::AtMost);
        assert_eq!([of(3), of(118), of(147)], [Verdict::Agrees; 3]);
        assert_eq!(of(148), Verdict::Outside);
        let one_never = [Some(100), None];
        let partly = verdict("fpo_global", "d_min_0.925", Some(&one_never), Counts::AtMost);
        assert_eq!(partly, Verdict::Outside);
    }

    #[test]
    fn the_same_algorithm_takes_as_many() {
        let of = |count| verdict("lloyd", "d_avg_0.925", Some(&[Some(count); 2]), Counts::Alike);
        assert_eq!([of(92), of(152)], [Verdict::Agrees; 2]);
        assert_eq!([of(91), of(153)], [Verdict::Outside; 2]);
    }

    #[test]
    fn the_thesis_decides_what_is_judged() {
        let of = |level, runs: &[_]| verdict("lloyd", level, Some(runs), Counts::Alike);
        // All its runs got there.
        assert_eq!(of("d_avg_0.925", &[Some(122), None]), Verdict::Outside);
        assert_eq!(of("d_avg_0.925", &[None; 2]), Verdict::Outside);
        // Some did, or none.
        for level in ["d_min_0.8", "d_min_0.9"] {
            for runs in [[Some(1); 2], [Some(1), None], [None; 2]] {
                assert_eq!(of(level, &runs), Verdict::NotJudged, "{level}: {runs:?}");
            }
        }
    }

    #[test]
    fn what_is_not_there_is_not_judged() {
        assert_eq!(verdict("fpo_global", "d_min_0.9", None, Counts::AtMost), Verdict::NotYet);
        let other = Counts::NotComparable("another algorithm");
        let judged = verdict("cccvt", "d_avg_0.875", Some(&[Some(900); 2]), other);
        assert_eq!(judged, Verdict::NotJudged);
    }
}
