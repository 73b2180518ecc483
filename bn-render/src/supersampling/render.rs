//! Images through supersampling patterns.

use bn_core::{DVec2, Observer};
use rayon::prelude::*;

use super::{Class, Supersampling};
use crate::watch::Watch;
use crate::{Frame, Image, RenderError, Scene};

impl Supersampling {
    /// The frame's window of the scene through this pattern, and the number of samples taken:
    /// each sample is evaluated once, however many pixels share it. Where taps lie so far apart that
    /// the rectangle around their samples holds more of them than all pixels have taps, each tap takes
    /// its own.
    ///
    /// Sums run over classes of shared samples and then over taps, in f64, the same on any number
    /// of threads and for any window. Memory: two f64 a pixel and channel beside the image, and as much
    /// again for margins as wide as the taps are apart.
    ///
    /// The observer is asked once for each class, and told how many of them are done.
    ///
    /// # Errors
    /// If the window is too large for an image in memory, or the observer asks to stop.
    pub fn render(
        &self,
        scene: &dyn Scene,
        frame: &Frame,
        observer: &dyn Observer,
    ) -> Result<(Image, u64), RenderError> {
        let window = frame.window();
        let (width, height) = (window.width as usize, window.height as usize);
        let channels = scene.channels().count();
        Image::check_size(window.width, window.height, scene.channels())?;
        let mut sums = vec![0.0; width * height * channels];
        let mut taken = 0;
        let classes = self.classes();
        let watch = Watch::new(observer, classes.len() as u64);
        for (done, class) in (0..).zip(&classes) {
            if !watch.reached(done) {
                return Err(RenderError::Cancelled);
            }
            for shifts in parts(class, frame) {
                let lattice = Lattice::around(shifts, frame);
                let samples = lattice.evaluate(scene, class.residue);
                taken += (lattice.width * lattice.height) as u64;
                let rows = sums.par_chunks_exact_mut(width * channels).enumerate();
                rows.for_each(|(j, row)| lattice.add_row(shifts, &samples, channels, j, row));
            }
        }
        let values = sums.into_iter().map(|sum| sum as f32).collect();
        Ok((Image::new(window.width, window.height, scene.channels(), values)?, taken))
    }
}

/// A tap's distance in whole pixels from its class's residue, and its weight.
type Shift = (i64, i64, f64);

/// The shifts of a class, together or each alone, whatever takes fewer samples.
fn parts<'a>(class: &'a Class, frame: &Frame) -> std::slice::Chunks<'a, Shift> {
    let window = frame.window();
    let (together, all) = (Lattice::around(&class.shifts, frame), class.shifts.len());
    let alone = all as f64 * f64::from(window.width) * f64::from(window.height);
    let shared = together.width as f64 * together.height as f64;
    class.shifts.chunks(if shared <= alone { all.max(1) } else { 1 })
}

/// The samples of some shifts of one class that a window needs: one for each pixel and a margin.
struct Lattice {
    /// The pixel that the first sample belongs to, and how far the window's first pixel is from it.
    first: (i64, i64),
    margin: (i64, i64),
    width: usize,
    height: usize,
}

impl Lattice {
    fn around(shifts: &[Shift], frame: &Frame) -> Self {
        let window = frame.window();
        let span = |along: fn(&Shift) -> i64| {
            let places = || shifts.iter().map(along);
            (places().min().unwrap_or(0), places().max().unwrap_or(0))
        };
        let (x, y) = (span(|s| s.0), span(|s| s.1));
        Self {
            first: (i64::from(window.x) + x.0, i64::from(window.y) + y.0),
            margin: (-x.0, -y.0),
            width: (i64::from(window.width) + x.1 - x.0) as usize,
            height: (i64::from(window.height) + y.1 - y.0) as usize,
        }
    }

    /// The samples' values: for each row first all of channel 0, then all of channel 1, …
    fn evaluate(&self, scene: &dyn Scene, residue: DVec2) -> Vec<f64> {
        let channels = scene.channels().count();
        let start = (self.first.0 as f64 + 0.5) + residue.x;
        let u: Vec<f64> = (0..self.width).map(|i| start + i as f64).collect();
        let mut samples = vec![0.0; self.width * self.height * channels];
        let rows = samples.par_chunks_exact_mut(self.width * channels).enumerate();
        rows.for_each_init(
            || vec![0.0; self.width],
            |v, (j, row)| {
                v.fill(((self.first.1 + j as i64) as f64 + 0.5) + residue.y);
                scene.values(&u, v, row);
            },
        );
        samples
    }

    /// Adds what the class gives to row `j` of the window.
    fn add_row(
        &self,
        shifts: &[Shift],
        samples: &[f64],
        channels: usize,
        j: usize,
        row: &mut [f64],
    ) {
        let width = row.len() / channels;
        for &(dx, dy, weight) in shifts {
            let (x, y) = ((self.margin.0 + dx) as usize, (self.margin.1 + dy) as usize + j);
            for c in 0..channels {
                let line = &samples[(y * channels + c) * self.width + x..][..width];
                for (sum, value) in row.iter_mut().skip(c).step_by(channels).zip(line) {
                    *sum += weight * value;
                }
            }
        }
    }
}
