//! Spectrum matching: seconds against the error of the spectrum, for every algorithm.

use std::ops::ControlFlow;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use bn_cli::{Failure, Outcome};
use bn_core::{DVec2, Density, Observer, PointSet, Progress, Seed};
use bn_samplers::{Algorithm, SampleError, Sampler as _, SpectrumMatching};
use bn_spectral::{Target, WindowedSpectrum, highest_step};

use super::chapter::{Chapter, Curve, Diagram, Value};
use super::{Effort, SEED};

/// Times at which the algorithms are compared.
const MOMENTS: [f64; 6] = [0.1, 0.3, 1.0, 3.0, 10.0, 30.0];
/// A run ends when it took a little longer than the last of them.
const PATIENCE: f64 = 31.0;
/// Between the moments, points are kept when a run has become this many times older.
const RATIO: f64 = 1.2;

const COLUMNS: &[&str] = &[
    "algorithm",
    "points",
    "rms at 0.1 s",
    "at 0.3 s",
    "at 1 s",
    "at 3 s",
    "at 10 s",
    "at 30 s",
    "ended after / s",
    "rms",
    "power below the step",
    "Omega by the RDF",
];

pub(super) fn measure(effort: Effort) -> Outcome<Chapter> {
    let sizes: &[usize] = if effort.quick { &[256] } else { &[1024, 4096, 16_384] };
    let patience = Duration::from_secs_f64(if effort.quick { 0.3 } else { PATIENCE });
    let (mut rows, mut diagrams) = (Vec::new(), Vec::new());
    for &n in sizes {
        let mut curves = Vec::new();
        for &name in Algorithm::NAMES {
            let run = Run::of(name, n, patience)?;
            rows.push(run.row(name, n));
            let points = run.places.iter().map(|place| [place.seconds, place.rms]).collect();
            curves.push(Curve { name: name.to_owned(), points });
        }
        let title = format!("*n* = {n}");
        diagrams.push(Diagram { title, x: "time / s", y: "rms of P − P_{t}", curves });
    }
    Ok(Chapter {
        id: "matching",
        title: "Spectrum matching",
        method: "Step blue noise at its highest frequency, one set from the same random points for all \
                 algorithms, all threads. The error is the root mean square of ring means less the \
                 target over all modes up to 6 sqrt(n): what the last state not later than a moment \
                 has. Algorithms that match the RDF leave the scatter of single rings, 0.12 at 1024 \
                 random points, as it is: what they reach shows in the power below the step, and in the \
                 oscillation Omega by the windowed RDF. A run is ended after 31 s."
            .to_owned(),
        columns: COLUMNS,
        rows,
        diagrams,
    })
}

/// A state on the way of one run.
struct Place {
    seconds: f64,
    rms: f64,
    empty_power: f64,
}

/// The way of one run, from its start on.
struct Run {
    places: Vec<Place>,
    /// Whether it came to its own end.
    ended: bool,
    /// Ω of its last state, by the windowed RDF.
    omega: Option<f64>,
}

impl Run {
    fn of(name: &str, n: usize, patience: Duration) -> Outcome<Self> {
        let failed = |error: SampleError| Failure::failed(anyhow::anyhow!("{name}: {error}"));
        let target =
            Target::step(Density::new(n), highest_step(n as f64)).map_err(Failure::failed)?;
        let matching = SpectrumMatching::new(target, Algorithm::named(name).unwrap_or_default());
        let recorder = Recorder::new(patience);
        let result = matching.sample(n, Seed::new(SEED), &recorder);
        let total = recorder.start.elapsed();
        let ended = !matches!(result, Err(SampleError::Cancelled));
        let mut states = recorder.states.into_inner().expect("no run panicked");
        if ended {
            states.push((total, result.map_err(failed)?.points.into_points()));
        }
        let last = states.last().map(|(_, points)| PointSet::new(points.clone()));
        let last = last.transpose().map_err(Failure::failed)?;
        let spectrum = last.map(|set| WindowedSpectrum::of(&[set])).transpose();
        let omega = spectrum.map_err(Failure::failed)?.and_then(|s| s.oscillation());
        let place = |(time, points): (Duration, Vec<DVec2>)| {
            let set = PointSet::new(points).map_err(Failure::failed)?;
            let residual = matching.residual(&set).map_err(failed)?;
            let (rms, empty_power) = (residual.rms, residual.empty_power);
            Ok(Place { seconds: time.as_secs_f64(), rms, empty_power })
        };
        let places = states.into_iter().map(place).collect::<Outcome<_>>()?;
        Ok(Self { places, ended, omega })
    }

    fn row(&self, name: &str, n: usize) -> Vec<Value> {
        let at = |moment: f64| self.places.iter().rfind(|place| place.seconds <= moment);
        let last = self.places.last();
        let mut row: Vec<Value> = vec![name.into(), n.into()];
        row.extend(MOMENTS.map(|moment| Value::from(at(moment).map(|place| place.rms))));
        row.push(last.filter(|_| self.ended).map(|place| place.seconds).into());
        row.push(last.map(|place| place.rms).into());
        row.push(last.map(|place| place.empty_power).into());
        row.push(self.omega.into());
        row
    }
}

/// Keeps the points of a run now and then, and ends it when it takes too long.
struct Recorder {
    start: Instant,
    patience: Duration,
    states: Mutex<Vec<(Duration, Vec<DVec2>)>>,
}

/// Adds a state, and drops the one before it unless it is the last at a moment of [`MOMENTS`] or
/// [`RATIO`] times older than those that are kept.
fn add<T>(states: &mut Vec<(Duration, T)>, now: Duration, state: T) {
    let at =
        |from: Duration| MOMENTS.iter().any(|&m| (from..now).contains(&Duration::from_secs_f64(m)));
    let is_dropped = match &states[..] {
        [.., (before, _), (last, _)] => !at(*last) && *last <= before.mul_f64(RATIO),
        // The first is kept.
        _ => false,
    };
    if is_dropped {
        states.pop();
    }
    states.push((now, state));
}

impl Recorder {
    fn new(patience: Duration) -> Self {
        Self { start: Instant::now(), patience, states: Mutex::default() }
    }
}

impl Observer for Recorder {
    fn observe(&self, _: &Progress<'_>) -> ControlFlow<()> {
        if self.start.elapsed() > self.patience {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    }

    fn iterated(&self, _: u64, points: &dyn Fn() -> Vec<DVec2>) {
        let (now, points) = (self.start.elapsed(), points());
        add(&mut self.states.lock().expect("no run panicked"), now, points);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_state_before_each_moment_is_kept_and_few_others() {
        for step in [1, 37, 900, 7000] {
            let mut states = Vec::new();
            for i in 0..=31_000 / step {
                add(&mut states, Duration::from_millis(i * step), i);
            }
            for moment in MOMENTS {
                let last = states.iter().rfind(|(time, _)| time.as_secs_f64() <= moment);
                let want = (1e3 * moment) as u64 / step;
                assert_eq!(last.map(|&(_, i)| i), Some(want), "every {step} ms, at {moment} s");
            }
            assert_eq!(states.last().map(|&(_, i)| i), Some(31_000 / step));
            assert!(states.len() < 80, "{} states", states.len());
            assert!(states.is_sorted());
        }
    }

    #[test]
    fn a_run_is_followed_and_ended() {
        let run = Run::of("spectral", 64, Duration::from_secs(60)).expect("made");
        assert!(run.ended && run.places.len() > 3);
        let (first, last) = (&run.places[0], &run.places[run.places.len() - 1]);
        assert!(last.rms < 0.2 * first.rms && last.seconds > first.seconds);
        let run = Run::of("force", 64, Duration::ZERO).expect("made");
        assert!(!run.ended && run.places.len() <= 1);
        assert_eq!(run.row("force", 64).len(), COLUMNS.len());
    }
}
