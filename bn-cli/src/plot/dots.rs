//! Point sets of the unit square: discs for what a page can hold, pixels beyond that.

use bn_core::DVec2;

use super::picture::Picture;

/// The points of a set on the unit torus, drawn as discs whose size goes with their spacing.
#[derive(Clone, Debug, PartialEq)]
pub struct Dots {
    points: Vec<DVec2>,
    window: f64,
}

/// Radius of a disc in units of the mean spacing 1/√n.
const RADIUS: f64 = 0.22;

/// Radius of the largest disc in points: sparse sets are not drawn as blots.
const LARGEST_RADIUS: f64 = 1.7;

impl Dots {
    /// More points than this are drawn as pixels, with an inset: as discs they would make a file
    /// heavy without being told apart.
    pub const MOST_DISCS: usize = 20_000;

    /// Points of [0, 1)²; those that are not finite are left out.
    pub fn new(points: impl IntoIterator<Item = DVec2>) -> Self {
        let points = points.into_iter().filter(|p| p.is_finite()).collect();
        Self { points, window: 1.0 }
    }

    /// The dots as they look in the square [0, `side`)² of the torus, at their own density.
    #[must_use]
    pub fn window(&self, side: f64) -> Self {
        Self { points: self.points.clone(), window: side }
    }

    /// Number of points on the whole torus.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Whether there is no point.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Whether the points are too many for discs.
    pub(super) fn are_many(&self) -> bool {
        self.points.len() as f64 * self.window * self.window > Self::MOST_DISCS as f64
    }

    /// Side of the part of the torus that is shown.
    pub(super) fn side(&self) -> f64 {
        self.window
    }

    /// Radius of the discs on a panel of `side` points.
    pub(super) fn radius(&self, side: f64) -> f64 {
        let spacing = side / (self.window * (self.points.len().max(1) as f64).sqrt());
        (RADIUS * spacing).min(LARGEST_RADIUS)
    }

    /// The points of the window in units of its side, those of the neighbouring copies that reach
    /// in by up to `margin` included.
    pub(super) fn visible(&self, margin: f64) -> impl Iterator<Item = DVec2> {
        let bound = -margin..1.0 + margin;
        let scale = 1.0 / self.window;
        let copies = [-1.0, 0.0, 1.0];
        self.points
            .iter()
            .flat_map(move |&p| copies.map(|dx| p + DVec2::new(dx, 0.0)))
            .flat_map(move |p| copies.map(|dy| p + DVec2::new(0.0, dy)))
            .map(move |p| p * scale)
            .filter(move |p| bound.contains(&p.x) && bound.contains(&p.y))
    }

    /// The window as an image of `pixels`² pixels: each pixel's darkness is the part of it that
    /// discs cover. Discs under half a pixel in radius are spread over a pixel's width; they are
    /// made no smaller than 0.22 pixels, or a million points would be a faint grey.
    pub(super) fn to_picture(&self, pixels: u32) -> Picture {
        let side = f64::from(pixels);
        let disc = Disc::of_radius(self.radius(side).max(0.22));
        let mut light = vec![1.0_f32; pixels as usize * pixels as usize];
        for p in self.visible((disc.radius + 0.5) / side) {
            disc.darken(&mut light, pixels as usize, p.x * side, (1.0 - p.y) * side);
        }
        let samples = light.iter().map(|&level| (255.0 * level).round() as u8).collect();
        Picture::grey(pixels, pixels, samples)
    }
}

/// A disc on a pixel grid.
struct Disc {
    radius: f64,
    strength: f64,
}

impl Disc {
    /// A disc with an edge one pixel wide that covers πr². Such an edge makes a disc cover
    /// π(radius² + 1/12); from radius ½ down it only gets fainter.
    fn of_radius(r: f64) -> Self {
        let blurred = r * r - 1.0 / 12.0;
        if blurred >= 0.25 {
            return Self { radius: blurred.sqrt(), strength: 1.0 };
        }
        Self { radius: 0.5, strength: 3.0 * r * r }
    }

    /// Covers the pixels around (x, y), edges blended over the width of a pixel.
    fn darken(&self, light: &mut [f32], pixels: usize, x: f64, y: f64) {
        let reach = self.radius + 0.5;
        let span = |centre: f64| {
            let first = (centre - reach - 0.5).ceil().max(0.0) as usize;
            let end = (centre + reach - 0.5).floor() + 1.0;
            first..(end.max(0.0) as usize).min(pixels)
        };
        for row in span(y) {
            for column in span(x) {
                let (dx, dy) = (column as f64 + 0.5 - x, row as f64 + 0.5 - y);
                let covered = (reach - dx.hypot(dy)).clamp(0.0, 1.0) * self.strength;
                light[row * pixels + column] *= 1.0 - covered as f32;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lattice(side: usize) -> Dots {
        let at = |i: usize| (i as f64 + 0.5) / side as f64;
        Dots::new((0..side * side).map(|i| DVec2::new(at(i % side), at(i / side))))
    }

    #[test]
    fn discs_cover_the_same_part_of_the_square_at_any_density() {
        for side in [100, 300, 700] {
            let dots = lattice(side);
            let share = dots.radius(130.0).powi(2) * dots.len() as f64 / (130.0 * 130.0);
            assert!((share - RADIUS * RADIUS).abs() < 1e-12);
        }
        assert_eq!(lattice(4).radius(130.0), LARGEST_RADIUS);
        assert_eq!(Dots::new([]).radius(130.0), LARGEST_RADIUS);
    }

    #[test]
    fn many_points_darken_evenly_and_by_their_area() {
        let picture = lattice(400).to_picture(1600);
        let dark = |p: &[u8]| p.iter().map(|&v| 255.0 - f64::from(v)).sum::<f64>() / 255.0;
        let share = dark(picture.samples()) / (1600.0 * 1600.0);
        // Discs of 0.88 pixels all sit alike on the pixels: their area is right to a few percent.
        assert!((share / (std::f64::consts::PI * RADIUS * RADIUS) - 1.0).abs() < 0.05, "{share}");
    }

    #[test]
    fn points_at_the_seam_show_on_both_sides() {
        let dots = Dots::new([DVec2::new(0.001, 0.5), DVec2::new(0.0, 0.0)]);
        assert_eq!(dots.visible(0.01).count(), 2 + 4);
        assert_eq!(dots.visible(0.0).count(), 2);
        assert_eq!(Dots::new([DVec2::NAN, DVec2::ZERO]).len(), 1);
    }

    #[test]
    fn a_window_keeps_the_density() {
        let dots = lattice(200);
        assert!(dots.are_many());
        let near = dots.window(0.1);
        assert!(!near.are_many());
        assert_eq!(near.visible(0.0).count(), 400);
        assert!((near.radius(13.0) - dots.radius(130.0)).abs() < 1e-12);
    }
}
