//! Integrals of a density function over polygons.

use glam::DVec2;

use crate::DensityFunction;

/// A [`DensityFunction`] ρ prepared for exact integrals over polygons, anywhere in the plane that the
/// torus is wound up from.
///
/// By Green's theorem an integral over a polygon is a sum over its edges of ∫ F dy, where F is
/// the antiderivative along x. On each pixel that an edge crosses, F is a polynomial of the place:
/// cumulative sums of each row of pixels give it in O(1), so a polygon costs one step for each
/// pixel on its boundary, however many are inside.
///
/// Errors: some 1e-16 times the polygon's height for the mass, relative to all mass. Memory: 32
/// bytes a pixel.
///
/// ```
/// use bn_core::{DVec2, DensityFunction, DensityIntegrals};
///
/// let density = DensityFunction::from_raster(2, 1, vec![1.0, 3.0])?;
/// let integrals = DensityIntegrals::new(&density);
/// // A unit square across the seam holds everything.
/// let square = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)].map(|(x, y)| DVec2::new(x, y));
/// let whole = integrals.over_polygon(DVec2::new(0.9, 0.2), &square);
/// assert!((whole.mass - 1.0).abs() < 1e-14);
/// # Ok::<(), bn_core::DensityFunctionError>(())
/// ```
#[derive(Clone, Debug)]
pub struct DensityIntegrals {
    width: usize,
    height: usize,
    /// `width + 1` a row: for each pixel, and for where the row ends.
    columns: Vec<Column>,
}

/// A pixel and what its row holds before it.
#[derive(Clone, Copy, Debug)]
struct Column {
    density: f64,
    /// ∫ ρ·xᵏ dx from 0 to the pixel, k = 0, 1, 2.
    before: [f64; 3],
}

/// What a density adds up to over a region, about an origin.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Moments {
    /// ∫ ρ: the part of all points that the region is to hold.
    pub mass: f64,
    /// ∫ ρ·x, with x from the origin.
    pub first: DVec2,
    /// ∫ ρ·|x|².
    pub second: f64,
}

impl std::ops::AddAssign for Moments {
    fn add_assign(&mut self, other: Self) {
        self.mass += other.mass;
        self.first += other.first;
        self.second += other.second;
    }
}

impl DensityIntegrals {
    /// Sums up the rows. O(pixels).
    pub fn new(density: &DensityFunction) -> Self {
        let (width, height) = (density.width(), density.height());
        let mut columns = Vec::with_capacity((width + 1) * height);
        for row in density.values().chunks_exact(width) {
            let mut before = [0.0; 3];
            for (i, &density) in row.iter().enumerate() {
                columns.push(Column { density, before });
                let [low, high] = [i, i + 1].map(|i| i as f64 / width as f64);
                let step = density * (high - low);
                before[0] += step;
                before[1] += step * (low + high) / 2.0;
                before[2] += step * (low * low + low * high + high * high) / 3.0;
            }
            columns.push(Column { density: 0.0, before });
        }
        Self { width, height, columns }
    }

    /// The moments of the polygon with these corners, counter-clockwise, relative to `origin`, about
    /// `origin`, which is in [0, 1)². Clockwise polygons count negatively.
    pub fn over_polygon(&self, origin: DVec2, corners: &[DVec2]) -> Moments {
        let mut moments = Moments::default();
        for (i, &corner) in corners.iter().enumerate() {
            let next = corners[(i + 1) % corners.len()];
            moments += self.along(origin, corner, next).0;
        }
        moments
    }

    /// The part that the edge `from` – `to` (relative to `origin`) of a polygon contributes to its
    /// moments about `origin`, and ∫ ρ along it.
    ///
    /// Parts mean something only when they are summed up around a polygon. O(pixels on the edge).
    pub fn along(&self, origin: DVec2, from: DVec2, to: DVec2) -> (Moments, f64) {
        let mut part = Part { origin, moments: Moments::default(), line: 0.0 };
        let mut pixel = Pixel::at(self, origin + from);
        let way = to - from;
        let mut crossings = Crossings::new(self, origin + from, way);
        let (mut start, mut time) = (from, 0.0);
        loop {
            let (crossed, next) = crossings.next();
            let end = if next < 1.0 { from + way * next } else { to };
            // Roundings may put a crossing before the one just passed.
            if next > time {
                let column = self.columns[pixel.row * (self.width + 1) + pixel.column];
                part.add(self.antiderivative(&pixel, column), column.density, start, end);
                (start, time) = (end, next);
            }
            if next >= 1.0 {
                return (part.moments, part.line);
            }
            pixel.step(crossed, crossings.direction(crossed), [self.width, self.height]);
        }
    }

    /// Where the pixel begins, and ∫ ρ·tᵏ dt from 0 to there, over as many turns around the torus as lie
    /// between.
    fn antiderivative(&self, pixel: &Pixel, column: Column) -> (f64, [f64; 3]) {
        let low = pixel.column as f64 / self.width as f64;
        if pixel.turns == 0 {
            return (low, column.before);
        }
        let k = pixel.turns as f64;
        let [t0, t1, t2] = self.columns[pixel.row * (self.width + 1) + self.width].before;
        let [s0, s1, s2] = column.before;
        // Whole turns 0 … k − 1, each moved by its number, then the last one up to the pixel.
        let (ones, squares) = (k * (k - 1.0) / 2.0, (k - 1.0) * k * (2.0 * k - 1.0) / 6.0);
        let first = s1 + k * s0 + k * t1 + ones * t0;
        let second = s2 + 2.0 * k * s1 + k * k * s0 + k * t2 + 2.0 * ones * t1 + squares * t0;
        (low + k, [s0 + k * t0, first, second])
    }
}

/// What an edge has contributed so far.
struct Part {
    origin: DVec2,
    moments: Moments,
    line: f64,
}

impl Part {
    /// Adds the piece from `a` to `b`, in a pixel of this density whose left side and antiderivatives there
    /// are given.
    #[inline]
    fn add(&mut self, (low, before): (f64, [f64; 3]), density: f64, a: DVec2, b: DVec2) {
        let x = self.origin.x;
        // About the origin: F(t) = Σ base + ρ·(tᵏ⁺¹ − lowᵏ⁺¹)/(k + 1).
        let base = [
            before[0],
            before[1] - x * before[0],
            before[2] - 2.0 * x * before[1] + x * x * before[0],
        ];
        let low = low - x;
        let base = [
            base[0] - density * low,
            base[1] - density * low * low / 2.0,
            base[2] - density * low * low * low / 3.0,
        ];
        let (dx, dy) = (b.x - a.x, b.y - a.y);
        // Means along the piece of products of the linear functions x and y.
        let (mx, my) = (0.5 * (a.x + b.x), 0.5 * (a.y + b.y));
        let (sx, sy) = (dx * dx / 12.0, dy * dy / 12.0);
        let (xx, yy, xy) = (mx * mx + sx, my * my + sy, mx * my + dx * dy / 12.0);
        let xxx = mx * (mx * mx + 3.0 * sx);
        let xyy = mx * yy + my * (dx * dy / 6.0);
        self.moments.mass += dy * (base[0] + density * mx);
        self.moments.first.x += dy * (base[1] + density * xx / 2.0);
        self.moments.first.y += dy * (base[0] * my + density * xy);
        self.moments.second += dy * (base[2] + density * xxx / 3.0 + base[0] * yy + density * xyy);
        self.line += density * (dx * dx + dy * dy).sqrt();
    }
}

/// A pixel, and how often around the torus it lies.
struct Pixel {
    column: usize,
    row: usize,
    /// Turns in x; those in y change nothing.
    turns: i64,
}

impl Pixel {
    fn at(integrals: &DensityIntegrals, p: DVec2) -> Self {
        let (width, height) = (integrals.width as i64, integrals.height as i64);
        let column = (p.x * width as f64).floor() as i64;
        let row = (p.y * height as f64).floor() as i64;
        Self {
            column: column.rem_euclid(width) as usize,
            row: row.rem_euclid(height) as usize,
            turns: column.div_euclid(width),
        }
    }

    /// Goes to the next pixel along an axis, up or down.
    #[inline]
    fn step(&mut self, axis: usize, is_up: bool, [width, height]: [usize; 2]) {
        match (axis, is_up) {
            (0, true) => {
                self.column += 1;
                if self.column == width {
                    (self.column, self.turns) = (0, self.turns + 1);
                }
            }
            (0, false) if self.column == 0 => {
                (self.column, self.turns) = (width - 1, self.turns - 1);
            }
            (0, false) => self.column -= 1,
            (_, true) => self.row = if self.row + 1 == height { 0 } else { self.row + 1 },
            (_, false) => self.row = self.row.checked_sub(1).unwrap_or(height - 1),
        }
    }
}

/// Where a segment crosses the sides of pixels, in parts of its way.
struct Crossings {
    /// For each axis: the start in pixels, 1/way in pixels, the line to be crossed next.
    start: [f64; 2],
    inverse: [f64; 2],
    line: [f64; 2],
}

impl Crossings {
    fn new(integrals: &DensityIntegrals, start: DVec2, way: DVec2) -> Self {
        let sides = [integrals.width as f64, integrals.height as f64];
        let start = [start.x * sides[0], start.y * sides[1]];
        let way = [way.x * sides[0], way.y * sides[1]];
        let line = [0, 1].map(|axis| {
            let floor = start[axis].floor();
            if way[axis] > 0.0 { floor + 1.0 } else { floor }
        });
        Self { start, inverse: way.map(|way| 1.0 / way), line }
    }

    /// Which way an axis is followed.
    #[inline]
    fn direction(&self, axis: usize) -> bool {
        self.inverse[axis] > 0.0
    }

    /// The axis across which the next side is, and after which part of the way; 1 or more if there is no
    /// other.
    #[inline]
    fn next(&mut self) -> (usize, f64) {
        let time = |axis: usize| {
            let time = (self.line[axis] - self.start[axis]) * self.inverse[axis];
            // A way of 0 never gets there.
            if self.inverse[axis].is_finite() { time } else { f64::INFINITY }
        };
        let times = [time(0), time(1)];
        let axis = usize::from(times[1] < times[0]);
        self.line[axis] += if self.direction(axis) { 1.0 } else { -1.0 };
        (axis, times[axis])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Moments of a polygon by clipping it with each pixel of three by three tori.
    fn by_clipping(density: &DensityFunction, origin: DVec2, corners: &[DVec2]) -> Moments {
        let (width, height) = (density.width() as i64, density.height() as i64);
        let size = DVec2::new(width as f64, height as f64);
        let mut moments = Moments::default();
        for row in -height..2 * height {
            for column in -width..2 * width {
                let low = DVec2::new(column as f64, row as f64) / size - origin;
                let high = DVec2::new((column + 1) as f64, (row + 1) as f64) / size - origin;
                let mut piece = corners.to_vec();
                for (normal, offset) in [
                    (DVec2::X, high.x),
                    (DVec2::Y, high.y),
                    (DVec2::NEG_X, -low.x),
                    (DVec2::NEG_Y, -low.y),
                ] {
                    piece = clip(&piece, normal, offset);
                }
                let pixel = row.rem_euclid(height) * width + column.rem_euclid(width);
                moments += of_uniform(&piece, density.values()[pixel as usize]);
            }
        }
        moments
    }

    fn clip(corners: &[DVec2], normal: DVec2, offset: f64) -> Vec<DVec2> {
        let mut kept = Vec::new();
        for (i, &a) in corners.iter().enumerate() {
            let b = corners[(i + 1) % corners.len()];
            let (s, t) = (a.dot(normal) - offset, b.dot(normal) - offset);
            if s <= 0.0 {
                kept.push(a);
            }
            if (s < 0.0 && t > 0.0) || (s > 0.0 && t < 0.0) {
                kept.push(a + (b - a) * (s / (s - t)));
            }
        }
        kept
    }

    fn of_uniform(corners: &[DVec2], density: f64) -> Moments {
        let mut moments = Moments::default();
        for (i, &a) in corners.iter().enumerate() {
            let b = corners[(i + 1) % corners.len()];
            let mass = density * a.perp_dot(b) / 2.0;
            let second = (a.length_squared() + a.dot(b) + b.length_squared()) / 6.0;
            moments += Moments { mass, first: (a + b) / 3.0 * mass, second: second * mass };
        }
        moments
    }

    fn assert_near(got: &Moments, want: &Moments) {
        let off = (got.mass - want.mass).abs()
            + (got.first - want.first).abs().max_element()
            + (got.second - want.second).abs();
        assert!(off < 1e-12, "{got:?} instead of {want:?}");
    }

    proptest! {
        #[test]
        fn polygons_are_the_sum_of_their_pixels(
            width in 1_usize..7,
            height in 1_usize..7,
            values in proptest::collection::vec(0.0_f64..1.0, 49),
            origin in (0.0_f64..1.0, 0.0_f64..1.0),
            radii in proptest::collection::vec(0.01_f64..0.7, 3..8),
        ) {
            let density =
                DensityFunction::from_raster(width, height, values[..width * height].to_vec())
                    .expect("valid");
            let integrals = DensityIntegrals::new(&density);
            let corner = |(i, &radius): (usize, &f64)| {
                let angle = std::f64::consts::TAU * i as f64 / radii.len() as f64;
                DVec2::new(libm::cos(angle), libm::sin(angle)) * radius
            };
            // A star-shaped polygon; the clipping needs a convex one, so it goes by triangles.
            let corners: Vec<DVec2> = radii.iter().enumerate().map(corner).collect();
            let origin = DVec2::from(origin);
            let mut want = Moments::default();
            for (i, &a) in corners.iter().enumerate() {
                let b = corners[(i + 1) % corners.len()];
                want += by_clipping(&density, origin, &[DVec2::ZERO, a, b]);
            }
            assert_near(&integrals.over_polygon(origin, &corners), &want);
        }
    }

    /// Corners and edges on the sides of pixels, and edges of no length.
    #[test]
    fn degenerate_edges_are_exact() {
        let density = DensityFunction::from_raster(4, 2, (1..=8).map(f64::from).collect());
        let density = density.expect("valid");
        let integrals = DensityIntegrals::new(&density);
        for (origin, low, high) in [
            (DVec2::ZERO, DVec2::ZERO, DVec2::new(0.25, 0.5)),
            (DVec2::new(0.25, 0.5), DVec2::splat(-0.5), DVec2::splat(0.5)),
            (DVec2::new(0.75, 0.0), DVec2::new(-1.0, -0.25), DVec2::new(0.5, 0.0)),
            (DVec2::new(0.5, 0.5), DVec2::ZERO, DVec2::ZERO),
            (DVec2::new(0.5, 0.5), DVec2::ZERO, DVec2::splat(1e-300)),
        ] {
            let square = [low, DVec2::new(high.x, low.y), high, high, DVec2::new(low.x, high.y)];
            let got = integrals.over_polygon(origin, &square);
            assert_near(&got, &by_clipping(&density, origin, &square));
        }
    }

    #[test]
    fn lines_have_the_density_along_them() {
        let density = DensityFunction::from_raster(2, 2, vec![1.0, 2.0, 3.0, 2.0]).expect("valid");
        let integrals = DensityIntegrals::new(&density);
        let line = |a: (f64, f64), b: (f64, f64)| {
            integrals.along(DVec2::new(0.5, 0.25), DVec2::from(a), DVec2::from(b)).1
        };
        // Rows 1, 2 below and 3, 2 above, of mean 2.
        assert!((line((-0.5, 0.0), (0.5, 0.0)) - 0.75).abs() < 1e-15);
        assert!((line((0.5, 0.0), (-0.5, 0.0)) - 0.75).abs() < 1e-15);
        assert!((line((-0.25, -0.25), (-0.25, 0.75)) - 1.0).abs() < 1e-15);
        let diagonal = line((-0.5, -0.25), (0.5, 0.75));
        assert!((diagonal - 0.75 * 2.0_f64.sqrt()).abs() < 1e-15, "{diagonal}");
    }
}
