//! When a PSNR of table 5.3 agrees with the thesis.

use super::judge::{Basis, KnownPlace};
use super::{Judge, Judgement, Verdict};

/// The test image is ours, its contrast fixed by one number of the table.
const ANCHOR: (&str, u32, f64) = ("random", 16, 0.7);

/// The methods whose error depends on their points' definition alone, not on a program.
const NEAR: [&str; 3] = ["random", "jitter", "hex"];

/// How far those may be from the thesis at 16 and 32 samples per pixel, in dB.
const NEAR_TOLERANCE: f64 = 2.0;

/// Methods closer than this, in dB, are ties in the ranking.
const TIE: f64 = 1.0;

/// What a doubling of the rate gains with independent samples, in dB, and how far it may be off.
const DOUBLING: (f64, f64) = (3.0103, 0.3);

/// The key of the thesis's values.
fn key(samples_per_pixel: u32) -> String {
    format!("psnr_{samples_per_pixel}spp")
}

impl Judge {
    /// Judges the PSNR `ours` of the thesis's row `method`. Only what the scene was adjusted to and
    /// what lies near it is held against the thesis's number; at high rates it is the ranking.
    pub(crate) fn judge_psnr(&self, method: &str, samples_per_pixel: u32, ours: f64) -> Judgement {
        let thesis = self.thesis().value("5.3", method, &key(samples_per_pixel));
        let tolerance = if (method, samples_per_pixel) == (ANCHOR.0, ANCHOR.1) {
            Some(ANCHOR.2)
        } else if NEAR.contains(&method) && samples_per_pixel <= 32 {
            Some(NEAR_TOLERANCE)
        } else {
            None
        };
        let judgement = match (self.basis(), thesis, tolerance) {
            (Basis::Thesis, Some(thesis), Some(tolerance)) => {
                let expected = (thesis, thesis);
                Judgement::held_against(Some(ours), expected, tolerance, None, Verdict::Agrees)
            }
            _ => Judgement::not_judged(None, Verdict::NotJudged),
        };
        Judgement { thesis, ..judgement }
    }

    /// A value that is shown beside the thesis's and not held against anything, with the reason.
    pub(crate) fn show_psnr(
        &self,
        method: &str,
        samples_per_pixel: u32,
        reason: Option<&str>,
    ) -> Judgement {
        let thesis = self.thesis().value("5.3", method, &key(samples_per_pixel));
        let reason = reason.map(str::to_owned);
        Judgement { thesis, ..Judgement::not_judged(reason, Verdict::NotJudged) }
    }

    /// Judges the gain per doubling of the rate, in dB, of independent samples.
    pub(crate) fn judge_doubling(&self, ours: f64) -> Judgement {
        let (want, tolerance) = DOUBLING;
        match self.basis() {
            Basis::Thesis => {
                let reason = "noise of independent samples: 10 log 2 dB".to_owned();
                let expected = (want, want);
                Judgement::held_against(
                    Some(ours),
                    expected,
                    tolerance,
                    Some(reason),
                    Verdict::Agrees,
                )
            }
            _ => Judgement::not_judged(None, Verdict::NotJudged),
        }
    }

    /// By how many dB a method is on the wrong side of another at `samples_per_pixel`, at most:
    /// `others` are keys and values, `method` may be among them. 0 where the thesis's order holds or
    /// the thesis has a tie.
    pub(crate) fn misplaced(
        &self,
        method: &str,
        ours: f64,
        others: &[(&str, f64)],
        samples_per_pixel: u32,
    ) -> f64 {
        let thesis = |method: &str| self.thesis().value("5.3", method, &key(samples_per_pixel));
        let Some(printed) = thesis(method) else { return 0.0 };
        let worst = others.iter().filter_map(|&(other, value)| {
            let gap = printed - thesis(other)?;
            (gap.abs() > TIE).then_some(if gap > 0.0 { value - ours } else { ours - value })
        });
        worst.fold(0.0, f64::max)
    }

    /// Whether it is known that this method's place in the ranking is not the thesis's.
    pub(crate) fn is_misplaced(&self, method: &str) -> bool {
        self.place(method).is_some()
    }

    /// Judges a method's place in the ranking, `misplaced` dB off: fine up to a tie, explained as far
    /// as is known.
    pub(crate) fn judge_place(&self, method: &str, misplaced: f64) -> Judgement {
        if !matches!(self.basis(), Basis::Thesis) {
            return Judgement::not_judged(None, Verdict::NotJudged);
        }
        let up_to = |most, reason, good| {
            Judgement::held_against(Some(misplaced), (0.0, most), TIE, reason, good)
        };
        let plain = up_to(0.0, None, Verdict::Agrees);
        match self.place(method).filter(|_| plain.verdict == Verdict::Outside) {
            Some(known) => up_to(known.value, Some(known.reason.clone()), Verdict::Explained),
            None => plain,
        }
    }

    fn place(&self, method: &str) -> Option<&KnownPlace> {
        self.places().iter().find(|place| place.thesis == method)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_anchor_is_tight_and_high_rates_are_shown_only() {
        let judge = Judge::for_thesis(4096, 10).expect("the embedded files parse");
        let of = |method, spp, ours| judge.judge_psnr(method, spp, ours).verdict;
        assert_eq!(
            [of("random", 16, 32.9), of("random", 16, 33.0)],
            [Verdict::Agrees, Verdict::Outside]
        );
        assert_eq!([of("hex", 32, 66.7), of("hex", 32, 66.9)], [Verdict::Agrees, Verdict::Outside]);
        assert_eq!(of("hex", 64, 66.1), Verdict::NotJudged);
        assert_eq!(of("cccvt", 16, 51.9), Verdict::NotJudged);
    }

    #[test]
    fn places_are_compared_beyond_ties() {
        let judge = Judge::for_thesis(4096, 10).expect("the embedded files parse");
        // The thesis: hexagonal 75.1, CCCVT 69.9, FPO 58.3, step 58.3, kernel 57.7.
        let others = [("hex", 70.0), ("cccvt", 72.5), ("fpo", 60.0), ("kernel", 66.0)];
        let of = |method, ours| judge.misplaced(method, ours, &others, 128);
        assert_eq!(of("hex", 70.0), 2.5);
        assert_eq!(of("cccvt", 72.5), 2.5);
        assert_eq!(of("fpo", 60.0), 0.0, "a tie with kernel density");
        let verdict = |misplaced| judge.judge_place("hex", misplaced).verdict;
        assert_eq!([verdict(1.0), verdict(1.1)], [Verdict::Agrees, Verdict::Outside]);
        for known in judge.places() {
            let at = |misplaced| judge.judge_place(&known.thesis, misplaced).verdict;
            assert_eq!([at(0.0), at(1.0)], [Verdict::Agrees; 2], "the thesis's own place");
            assert_eq!([at(1.1), at(known.value)], [Verdict::Explained; 2]);
            assert_eq!([at(known.value + 1.1), at(f64::NAN)], [Verdict::Outside; 2]);
        }
    }
}
