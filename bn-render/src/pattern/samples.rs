//! Samples that a pattern gives.

use bn_core::DVec2;

use crate::Rect;

/// Places of samples, one array for each coordinate so that loops over them can be vectorised.
#[derive(Clone, Debug, Default)]
pub struct SampleList {
    u: Vec<f64>,
    v: Vec<f64>,
    /// Nothing if all samples weigh the same.
    weights: Vec<f64>,
}

impl SampleList {
    /// Abscissae in pixels.
    pub fn u(&self) -> &[f64] {
        &self.u
    }

    /// Ordinates in pixels, downwards.
    pub fn v(&self) -> &[f64] {
        &self.v
    }

    /// Weights, of mean 1 over the pattern; nothing if all samples weigh the same.
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.u.len()
    }

    /// Whether there is no sample.
    pub fn is_empty(&self) -> bool {
        self.u.is_empty()
    }

    /// Forgets all samples, keeps the memory.
    pub fn clear(&mut self) {
        self.u.clear();
        self.v.clear();
        self.weights.clear();
    }

    /// Appends those of `points` that lie in the half-open rectangle, with their weights if they have
    /// any.
    pub(super) fn append(
        &mut self,
        rect: &Rect,
        points: impl ExactSizeIterator<Item = DVec2> + Clone,
        weights: Option<&[f64]>,
    ) {
        let inside = |p: DVec2| p.cmpge(rect.min).all() & p.cmplt(rect.max).all();
        if let Some(weights) = weights {
            let kept = points.clone().zip(weights).filter(|(p, _)| inside(*p));
            self.weights.extend(kept.map(|(_, weight)| weight));
        }
        let start = self.u.len();
        self.u.resize(start + points.len(), 0.0);
        self.v.resize(start + points.len(), 0.0);
        let (us, vs) = (&mut self.u[start..], &mut self.v[start..]);
        let mut kept = 0;
        // Written first, counted after: no branch to mispredict at the rectangle's border.
        for p in points {
            us[kept] = p.x;
            vs[kept] = p.y;
            kept += usize::from(inside(p));
        }
        self.u.truncate(start + kept);
        self.v.truncate(start + kept);
    }
}
