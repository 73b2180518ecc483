//! Images inside panels: grids of values and what they look like.

use png::{ColorType, EncodingError};

use super::encode::{PngNotes, png};

/// A function sampled on cells of a rectangle, row by row from the lowest y.
///
/// A cell without a value is NaN.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    columns: usize,
    values: Vec<f64>,
    x: [f64; 2],
    y: [f64; 2],
}

impl Grid {
    /// `values` in rows of `columns` cells over the rectangle `x` × `y` (outer edges of the cells).
    ///
    /// # Panics
    /// If there is no cell or the last row is not full.
    pub fn new(columns: usize, values: Vec<f64>, x: [f64; 2], y: [f64; 2]) -> Self {
        assert!(columns > 0 && !values.is_empty(), "a grid needs a cell");
        assert!(values.len().is_multiple_of(columns), "the last row of the grid is not full");
        Self { columns, values, x, y }
    }

    /// Cells a row.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.values.len() / self.columns
    }

    /// Left and right edge.
    pub fn x(&self) -> [f64; 2] {
        self.x
    }

    /// Lower and upper edge.
    pub fn y(&self) -> [f64; 2] {
        self.y
    }

    /// The values, lowest row first.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The grid with every cell above `threshold` spread over the disc of `reach` cells around it,
    /// so that lone peaks can be seen; where discs meet, the highest value stands. Cells without a
    /// value stay so. Cost O(cells + peaks·reach²).
    #[must_use]
    pub fn with_peaks_widened(mut self, threshold: f64, reach: usize) -> Self {
        let peaks: Vec<(usize, f64)> = self
            .values
            .iter()
            .copied()
            .enumerate()
            .filter(|&(_, v)| v.is_finite() && v > threshold)
            .collect();
        for (cell, peak) in peaks {
            let (row, column) = (cell / self.columns, cell % self.columns);
            for y in row.saturating_sub(reach)..(row + reach + 1).min(self.rows()) {
                for x in column.saturating_sub(reach)..(column + reach + 1).min(self.columns) {
                    let (dx, dy) = (x.abs_diff(column), y.abs_diff(row));
                    let value = &mut self.values[y * self.columns + x];
                    if dx * dx + dy * dy <= reach * reach && value.is_finite() {
                        *value = value.max(peak);
                    }
                }
            }
        }
        self
    }

    /// Whether a cell is above `threshold`.
    pub fn exceeds(&self, threshold: f64) -> bool {
        self.values.iter().any(|&v| v.is_finite() && v > threshold)
    }

    /// The grid as an image of `columns` × `rows` pixels, linear grey from 0 (black) to `white`
    /// and beyond. A pixel smaller than a cell shows the cell that its centre is in; a larger one
    /// the mean of the cells that it covers, weighted by the area covered. Cells that are not
    /// finite do not count; a pixel without any is black.
    ///
    /// # Panics
    /// If the image has no pixel.
    pub fn to_picture(&self, columns: u32, rows: u32, white: f64) -> Picture {
        assert!(columns > 0 && rows > 0, "an image needs a pixel");
        let across = footprints(self.columns, columns as usize);
        let down = footprints(self.rows(), rows as usize);
        let mut pixels = Vec::with_capacity(columns as usize * rows as usize);
        for row in down.iter().rev() {
            for column in &across {
                pixels.push(grey(self.mean(column, row), white));
            }
        }
        Picture { width: columns, height: rows, samples: pixels, colour: false }
    }

    /// The mean over the cells of a footprint, NaN if none has a value.
    fn mean(&self, columns: &Footprint, rows: &Footprint) -> f64 {
        let (mut sum, mut total) = (0.0, 0.0);
        for (row, v) in rows.cells() {
            for (column, u) in columns.cells() {
                let value = self.values[row * self.columns + column];
                if value.is_finite() {
                    sum += u * v * value;
                    total += u * v;
                }
            }
        }
        sum / total
    }
}

/// The cells that a pixel covers along one axis: whole ones but for the first and the last.
struct Footprint {
    first: usize,
    weights: Vec<f64>,
}

impl Footprint {
    fn cells(&self) -> impl Iterator<Item = (usize, f64)> {
        self.weights.iter().enumerate().map(|(i, &weight)| (self.first + i, weight))
    }
}

/// What each of `pixels` pixels covers of `cells` cells.
fn footprints(cells: usize, pixels: usize) -> Vec<Footprint> {
    let single = |first: usize| Footprint { first, weights: vec![1.0] };
    if pixels >= cells {
        return (0..pixels).map(|p| single((2 * p + 1) * cells / (2 * pixels))).collect();
    }
    (0..pixels)
        .map(|p| {
            // Edges in units of 1/pixels of a cell, so that the weights are exact.
            let (start, end) = (p * cells, (p + 1) * cells);
            let (first, last) = (start / pixels, (end - 1) / pixels);
            let weight =
                |cell: usize| (end.min((cell + 1) * pixels) - start.max(cell * pixels)) as f64;
            Footprint { first, weights: (first..=last).map(weight).collect() }
        })
        .collect()
}

fn grey(value: f64, white: f64) -> u8 {
    let level = value / white;
    if level.is_nan() { 0 } else { (255.0 * level.clamp(0.0, 1.0)).round() as u8 }
}

/// An 8-bit image, grey or colour, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    width: u32,
    height: u32,
    samples: Vec<u8>,
    colour: bool,
}

impl Picture {
    /// A grey image.
    ///
    /// # Panics
    /// If there is not one sample a pixel, or no pixel.
    pub fn grey(width: u32, height: u32, samples: Vec<u8>) -> Self {
        Self::new(width, height, samples, false)
    }

    /// A colour image: red, green, blue for each pixel.
    ///
    /// # Panics
    /// If there are not three samples a pixel, or no pixel.
    pub fn rgb(width: u32, height: u32, samples: Vec<u8>) -> Self {
        Self::new(width, height, samples, true)
    }

    fn new(width: u32, height: u32, samples: Vec<u8>, colour: bool) -> Self {
        let pixels = width as usize * height as usize;
        let expected = pixels * if colour { 3 } else { 1 };
        assert!(pixels > 0, "an image needs a pixel");
        assert_eq!(samples.len(), expected, "samples of an image of {width} × {height} pixels");
        Self { width, height, samples, colour }
    }

    /// Pixels a row.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Number of rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The samples, top row first.
    pub fn samples(&self) -> &[u8] {
        &self.samples
    }

    /// The image as a PNG file.
    pub(super) fn to_png(&self, notes: PngNotes<'_>) -> Result<Vec<u8>, EncodingError> {
        let color = if self.colour { ColorType::Rgb } else { ColorType::Grayscale };
        png((self.width, self.height), color, &self.samples, notes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp(columns: usize, rows: usize) -> Grid {
        let values = (0..columns * rows).map(|i| i as f64).collect();
        Grid::new(columns, values, [0.0, 1.0], [0.0, 1.0])
    }

    #[test]
    fn a_pixel_a_cell_is_the_grid_upside_down() {
        let picture = ramp(2, 2).to_picture(2, 2, 255.0);
        assert_eq!(picture.samples(), [2, 3, 0, 1]);
    }

    #[test]
    fn fewer_cells_than_pixels_become_blocks() {
        let picture = ramp(2, 1).to_picture(5, 2, 1.0);
        // The middle pixel's centre is on the edge: it goes to the right.
        assert_eq!(picture.samples(), [0, 0, 255, 255, 255].repeat(2));
    }

    #[test]
    fn more_cells_than_pixels_are_averaged_by_area() {
        // 3 cells 0 1 2 on 2 pixels: (0 + ½)/1.5 and (½ + 2)/1.5, white at 2.
        let picture = ramp(3, 1).to_picture(2, 1, 2.0);
        assert_eq!(picture.samples(), [43, 213]);
        // The mean of all pixels is that of all cells, whatever the ratio.
        for (cells, pixels) in [(641, 600), (10_001, 641), (7, 7), (1000, 1)] {
            let covered = footprints(cells, pixels);
            let mut weight = vec![0.0; cells];
            covered.iter().flat_map(Footprint::cells).for_each(|(c, w)| weight[c] += w);
            let each = if cells == pixels { 1.0 } else { pixels as f64 };
            assert!(weight.iter().all(|&w| w == each), "{cells} on {pixels}");
        }
    }

    #[test]
    fn lone_peaks_become_discs() {
        let mut values = vec![1.0; 49];
        (values[24], values[25], values[6]) = (9.0, f64::NAN, 20.0);
        let wide = Grid::new(7, values, [0.0, 1.0], [0.0, 1.0]).with_peaks_widened(5.0, 2);
        let count = |level: f64| wide.values().iter().filter(|&&v| v == level).count();
        // A disc of radius 2 has 13 cells, a quarter of it 6; one cell of the first has no value.
        assert_eq!((count(9.0), count(20.0), count(1.0)), (12, 6, 30));
        assert!(wide.exceeds(9.5) && !wide.exceeds(20.0));
    }

    #[test]
    fn cells_without_a_value_do_not_count() {
        let values = vec![f64::NAN, 2.0, f64::INFINITY, f64::NAN];
        let grid = Grid::new(4, values, [0.0, 1.0], [0.0, 1.0]);
        assert_eq!(grid.to_picture(2, 1, 2.0).samples(), [255, 0]);
        assert_eq!(grid.to_picture(2, 1, 0.0).samples(), [255, 0]);
        assert_eq!(grid.to_picture(1, 1, f64::NAN).samples(), [0]);
    }
}
