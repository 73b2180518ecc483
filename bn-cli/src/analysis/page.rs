//! What the page of a report shows, measured.

use bn_core::Curve;
use bn_spectral::{Autocorrelation, PeriodogramOptions, PowerImage};

use super::thinning::thinned;
use super::{Analysis, Statistic, WINDOWED_LIMIT};
use crate::plot::{Grid, Text};
use crate::report::{self, ReportData};

/// Bins of the RDF over that range, where there are points enough to fill them.
const RDF_BINS: usize = 400;
/// Cells a side of the autocorrelation, likewise.
const AUTOCORRELATION_CELLS: usize = 161;
/// Pairs that a cell or bin should hold on the average.
const PAIRS: f64 = 10.0;

impl Analysis<'_> {
    /// The data of the page, with the spectrum up to `max_frequency` cycles per unit.
    ///
    /// The windowed statistics are left out above [`WINDOWED_LIMIT`] points a set. Of points that
    /// crowd in one place, pairs are counted among some only, and the provenance says so.
    pub fn report_data(
        &self,
        title: String,
        provenance: String,
        max_frequency: usize,
    ) -> ReportData {
        let n = self.sets[0].len();
        let range = (report::MOST_DISTANCE * self.density.hexagonal_spacing()).min(0.5);
        let fewer = thinned(self.sets, range);
        let pairs = Analysis::of(fewer.as_deref().unwrap_or(self.sets));
        let provenance = match &fewer {
            Some(sets) => format!("{provenance}; pairs of {} points a set", sets[0].len()),
            None => provenance,
        };
        let radial = self.radial_power(max_frequency);
        let undefined = || Curve::new(0.0, 1.0, vec![f64::NAN]);
        ReportData {
            title,
            points_per_set: n,
            sets: self.sets.len(),
            points: self.sets[0].points().to_vec(),
            autocorrelation: pairs.autocorrelation(range),
            spectrum: self.spectrum(max_frequency),
            anisotropy: radial
                .anisotropy_db()
                .map_or_else(undefined, |c| over(&c, self.density.grid_nyquist())),
            rdf: over(
                &pairs.rdf_within(range, pairs.rdf_bins(range)),
                self.density.hexagonal_spacing(),
            ),
            radial_power: radial
                .curve()
                .map_or_else(undefined, |c| over(&c, self.density.grid_nyquist())),
            statistics: self.page_statistics(n <= WINDOWED_LIMIT),
            provenance,
        }
    }

    /// As many bins as hold [`PAIRS`] pairs at the middle of the range, up to [`RDF_BINS`].
    fn rdf_bins(&self, range: f64) -> usize {
        let n = self.density.points_per_unit_area();
        let pairs = self.sets.len() as f64 * n * n / 2.0 * std::f64::consts::PI * range * range;
        ((pairs / PAIRS) as usize).clamp(8, RDF_BINS)
    }

    fn autocorrelation(&self, range: f64) -> Grid {
        let n = self.density.points_per_unit_area();
        let pairs = self.sets.len() as f64 * n * n * 4.0 * range * range;
        let side = ((pairs / PAIRS).sqrt() as usize).clamp(9, AUTOCORRELATION_CELLS) | 1;
        let image = Autocorrelation::of(self.sets, range, side);
        let half = self.density.normalize_distance(range).value();
        Grid::new(side, image.values().to_vec(), [-half, half], [-half, half])
    }

    fn spectrum(&self, max_frequency: usize) -> Grid {
        let options = PeriodogramOptions::new(max_frequency);
        let image = PowerImage::of(self.sets, options, report::MOST_CELLS)
            .expect("up to SPECTRAL_LIMIT points ask for frequencies that can be planned");
        let half = self.density.normalize_frequency(image.half_width()).value();
        Grid::new(image.side(), image.power().to_vec(), [-half, half], [-half, half])
    }

    fn page_statistics(&self, windowed: bool) -> Vec<report::Statistic> {
        const SHOWN: [(Statistic, &str); 8] = [
            (Statistic::BondOrder, "*Q*^{6}"),
            (Statistic::CoverageRadius, "*R*_{c}"),
            (Statistic::MinDistance, "*d*_{min}"),
            (Statistic::MeanDistance, "*d*_{avg}"),
            (Statistic::NuEff, "*ν*_{eff} (windowed)"),
            (Statistic::Omega, "Ω (windowed)"),
            (Statistic::NuEffDirect, "*ν*_{eff} (direct)"),
            (Statistic::OmegaDirect, "Ω (direct)"),
        ];
        let shown = SHOWN.into_iter().filter(|(statistic, _)| windowed || !statistic.is_windowed());
        shown
            .map(|(statistic, label)| {
                let estimate = self.estimate(statistic);
                report::Statistic {
                    label: Text::math(label),
                    value: estimate.map_or(f64::NAN, |e| e.value),
                    std_error: estimate.and_then(|e| e.std_error),
                }
            })
            .collect()
    }
}

/// The curve with its abscissae in units of `unit`.
fn over(curve: &Curve, unit: f64) -> Curve {
    Curve::new(curve.start() / unit, curve.step() / unit, curve.values().to_vec())
}
