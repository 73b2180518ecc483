//! Which single-peak spectra are realizable: the map of ν₀, p₀ and σ.

use bn_cli::plot::{Axis, Page, Panel, Reference, Row, Series, Style, Text};
use bn_cli::{Failure, Outcome};
use bn_core::Density;
use bn_spectral::{SinglePeak, Target, highest_step};

use super::FigureSpec;
use super::studio::Studio;

pub(super) const FIGURES: &[FigureSpec] =
    &[FigureSpec { id: "feasible", title: "which single-peak spectra are realizable", draw }];

/// The density that frequencies refer to.
const POINTS: usize = 4096;
/// Deviations of the Gaussian in cycles.
const SIGMAS: [f64; 4] = [0.5, 2.5, 5.0, 8.0];
/// Width of the peak before it is smoothed.
const WIDTH: f64 = 0.25;
/// Halvings of a step of ν₀ in search of the highest.
const BISECTIONS: usize = 12;
/// The greatest p₀ shown, in cycles.
const MOST_POWER: f64 = 45.0;

/// Least and greatest p₀ by ν₀, for some σ.
fn draw(studio: &Studio) -> Outcome {
    let across = if studio.quick() { 11 } else { 161 };
    let mut panels = Vec::new();
    let mut ends = Vec::new();
    for (i, sigma) in SIGMAS.into_iter().enumerate() {
        let [low, high] = boundaries(&steps(0.9, 1.7, across), sigma)?;
        let end = low.last().map_or(f64::NAN, |p| p[0]);
        ends.push(format!("{end:.3} for *σ* = {sigma}"));
        let edge = |points: Vec<[f64; 2]>| Series::new(points).styled(Style::Cycle(i));
        let axis = |label: &str, low, high| Axis::linear(Text::math(label)).over(low, high);
        let panel = Panel::new(
            axis("*ν*_{0}/*ν*_{max}", 0.9, 1.7),
            axis("*p*_{0} in cycles per unit", 0.0, MOST_POWER),
        );
        panels.push(
            panel
                .titled(Text::math(&format!("*σ* = {sigma} cycles")))
                .reference(Reference::vertical(1.0))
                .line(edge(low))
                .line(edge(high)),
        );
    }
    let right = panels.split_off(2);
    let text = format!(
        "Between the curves min *P* ≥ 0 and min *g* ≥ 0, at {POINTS} points, for a peak {WIDTH} cycles wide before it is \
         smoothed; for *n* points *ν*_{{0}}, *p*_{{0}}, *σ* and the width scale with √*n*. Highest realizable *ν*_{{0}}/*ν*_{{max}}: {}.",
        ends.join(", ")
    );
    let page = Page::new()
        .titled(Text::plain("Realizable single-peak spectra"))
        .row(Row::new(140.0, panels))
        .row(Row::new(140.0, right))
        .paragraph(Text::math(&text));
    studio.page("", &page)
}

fn steps(from: f64, to: f64, count: usize) -> Vec<f64> {
    (0..count).map(|i| from + (to - from) * i as f64 / (count - 1) as f64).collect()
}

/// The least and the greatest p₀ that is realizable at each ν₀ (in ν_max), where any is; P ≥ 0 always
/// holds.
fn boundaries(nus: &[f64], sigma: f64) -> Outcome<[Vec<[f64; 2]>; 2]> {
    let highest = highest_step(POINTS as f64);
    let (mut low, mut high) = (Vec::new(), Vec::new());
    let mut add = |nu: f64| -> Outcome<bool> {
        let range = powers(nu * highest, sigma)?;
        if let Some((least, most)) = range {
            low.push([nu, least]);
            high.push([nu, most]);
        }
        Ok(range.is_some())
    };
    for pair in nus.windows(2) {
        let (mut inside, mut outside) = (pair[0], pair[1]);
        if !add(inside)? {
            break;
        }
        // Where the curves meet is found by bisection.
        if powers(outside * highest, sigma)?.is_none() {
            for _ in 0..BISECTIONS {
                let middle = 0.5 * (inside + outside);
                if add(middle)? { inside = middle } else { outside = middle }
            }
            break;
        }
    }
    Ok([low, high])
}

/// The range of p₀ in which g ≥ 0. g is linear in p₀: every distance bounds it from below or above.
fn powers(nu0: f64, sigma: f64) -> Outcome<Option<(f64, f64)>> {
    let r: Vec<f64> = (0..2000).map(|i| f64::from(i) * 1e-4).collect();
    let rdf = |peak: f64| {
        let shape = SinglePeak { nu0, peak, sigma, width: WIDTH };
        let target = Target::single_peak(Density::new(POINTS), shape).map_err(Failure::failed)?;
        Ok::<_, Failure>(target.rdf(&r))
    };
    let (without, with) = (rdf(0.0)?, rdf(1.0)?);
    let (mut least, mut most) = (0.0_f64, f64::INFINITY);
    for (g, with) in without.iter().zip(&with) {
        let slope = with - g;
        if slope > 0.0 {
            least = least.max(-g / slope);
        } else if slope < 0.0 {
            most = most.min(-g / slope);
        }
    }
    Ok((least <= most).then_some((least, most)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use bn_spectral::Realizability;

    #[test]
    fn curves_meet_at_the_highest_frequency() {
        let [low, high] = boundaries(&steps(0.9, 1.7, 5), 2.5).expect("valid");
        let (low, high) = (low[low.len() - 1], high[high.len() - 1]);
        assert!(high[1] >= low[1] && high[1] - low[1] < 1.0, "{low:?} {high:?}");
        let beyond = (low[0] + 0.2 / f64::from(1 << BISECTIONS)) * highest_step(POINTS as f64);
        assert!(powers(beyond, 2.5).expect("valid").is_none());
    }

    #[test]
    fn boundaries_are_those_of_the_verdict() {
        let nu0 = 1.3 * highest_step(POINTS as f64);
        let (least, most) = powers(nu0, 2.5).expect("valid").expect("realizable");
        for (peak, want) in [(least, false), (most, true)] {
            for (factor, inside) in [(0.99, want), (1.01, !want)] {
                let shape = SinglePeak { nu0, peak: factor * peak, sigma: 2.5, width: WIDTH };
                let target = Target::single_peak(Density::new(POINTS), shape).expect("valid");
                assert_eq!(Realizability::of(&target).realizable, inside, "{peak} {factor}");
            }
        }
        assert!(powers(1.66 * highest_step(POINTS as f64), 2.5).expect("valid").is_none());
    }
}
