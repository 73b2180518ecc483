//! What there is to see: functions over the image plane.

mod catalogue;
mod checkerboard;
mod cloth;
mod picture;
mod plane_wave;
mod sphere;
mod zone_plate;

use bn_core::DVec2;

pub use catalogue::{SCENES, SceneEntry, SceneError, SceneOptions, scene};
pub use checkerboard::Checkerboard;
pub use cloth::StripedCloth;
pub use picture::{Interpolation, Picture};
pub use plane_wave::{Constant, PlaneWave, PlaneWaves};
pub use sphere::SphereScene;
pub use zone_plate::{LimitedZonePlate, ZonePlate};

use crate::{Channels, Rect};

/// A value with up to three channels; a grey one uses the first, the others are 0.
pub type Color = [f64; 3];

/// A function over the whole image plane: linear light, nominally in [0, 1], finite.
///
/// The value at a point depends on nothing but the point: not on the other points of a slice, nor
/// on the thread. Everything but [`Scene::channels`] and [`Scene::values`] is optional knowledge
/// that lets the renderer skip work or a figure explain itself.
pub trait Scene: Send + Sync {
    /// The channels that the scene has.
    fn channels(&self) -> Channels;

    /// The values at the points (u\[i\], v\[i\]), in pixels: first all of channel 0, then all of
    /// channel 1, …
    ///
    /// # Panics
    /// May panic if the lengths of `u`, `v` and `out` don't fit.
    fn values(&self, u: &[f64], v: &[f64], out: &mut [f64]);

    /// The value that the scene has at *every* point of the closed rectangle, bit for bit, if the
    /// scene can promise one.
    fn constant_over(&self, _rect: &Rect) -> Option<Color> {
        None
    }

    /// Bounds (lower, upper) that no channel leaves on the closed rectangle, if known.
    fn bounds_over(&self, rect: &Rect) -> Option<(f64, f64)> {
        let color = self.constant_over(rect)?;
        let used = &color[..self.channels().count()];
        Some(
            used.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &c| {
                (low.min(c), high.max(c))
            }),
        )
    }

    /// The local frequency at a point in cycles per pixel, a vector, where the scene is a wave.
    fn local_frequency(&self, _at: DVec2) -> Option<DVec2> {
        None
    }

    /// The value at one point.
    fn value(&self, at: DVec2) -> Color {
        let mut color = [0.0; 3];
        self.values(&[at.x], &[at.y], &mut color[..self.channels().count()]);
        color
    }
}
