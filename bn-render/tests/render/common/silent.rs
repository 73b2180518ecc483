//! A scene that keeps what it knows to itself; for tests and benches.

use bn_render::{Channels, Scene};

/// The scene without its optional knowledge.
pub struct Silent<'a>(pub &'a dyn Scene);

impl Scene for Silent<'_> {
    fn channels(&self) -> Channels {
        self.0.channels()
    }
    fn values(&self, u: &[f64], v: &[f64], out: &mut [f64]) {
        self.0.values(u, v, out);
    }
}
