//! The weighted graph Laplacian of a power diagram, and solving with it.

use rayon::prelude::*;

use super::PowerDiagram;

/// Rows that one task multiplies, and numbers that one partial sum holds.
const CHUNK: usize = 4096;

/// Below this many rows threads take longer to wake up than the work takes.
const PARALLEL: usize = 8 * CHUNK;

/// The matrix of ∂Aᵢ/∂wⱼ: how the areas of cells change with the weights.
///
/// Off the diagonal −Σ mass/(2 distance) over the edges between cells i and j, on it what makes
/// the sum of each row 0: symmetric and positive semidefinite, singular for equal changes of all
/// weights.
#[derive(Clone, Debug, Default)]
pub struct Laplacian {
    /// Row i has the entries `ends[i − 1]..ends[i]` off the diagonal.
    ends: Vec<u32>,
    columns: Vec<u32>,
    /// Their values without the sign.
    values: Vec<f64>,
    diagonal: Vec<f64>,
    scratch: Scratch,
}

/// The vectors of the conjugate gradient method.
#[derive(Clone, Debug, Default)]
struct Scratch {
    residual: Vec<f64>,
    preconditioned: Vec<f64>,
    direction: Vec<f64>,
    image: Vec<f64>,
}

impl Laplacian {
    /// Makes this the matrix of `diagram`.
    pub fn assemble(&mut self, diagram: &PowerDiagram) {
        self.ends.clear();
        self.columns.clear();
        self.values.clear();
        self.diagonal.clear();
        for i in 0..diagram.len() {
            let mut sum = 0.0;
            for edge in diagram.edges(i) {
                let j = edge.neighbor.index;
                if j as usize == i || diagram.cells()[j as usize].area == 0.0 {
                    continue;
                }
                let value = 0.5 * edge.mass / edge.neighbor.displacement.length();
                self.columns.push(j);
                self.values.push(value);
                sum += value;
            }
            self.ends.push(self.columns.len() as u32);
            self.diagonal.push(sum);
        }
    }

    /// Solves for x until the residual is `tolerance` times the right-hand side (less its mean, for
    /// which there is no solution) in the preconditioner's norm, or for `most` steps. Conjugate
    /// gradients, preconditioned by the diagonal. The mean of x is 0. Returns the number of steps.
    pub fn solve(&mut self, right: &[f64], x: &mut Vec<f64>, tolerance: f64, most: u32) -> u32 {
        let n = right.len();
        let mut scratch = std::mem::take(&mut self.scratch);
        x.clear();
        x.resize(n, 0.0);
        scratch.residual.clear();
        let mean = right.iter().sum::<f64>() / n as f64;
        scratch.residual.extend(right.iter().map(|r| r - mean));
        scratch.preconditioned.resize(n, 0.0);
        scratch.image.resize(n, 0.0);
        self.precondition(&mut scratch);
        scratch.direction.clone_from(&scratch.preconditioned);
        let mut rho = dot(&scratch.residual, &scratch.preconditioned);
        let goal = rho * tolerance * tolerance;
        let mut steps = 0;
        while steps < most && rho > goal {
            self.multiply(&scratch.direction, &mut scratch.image);
            let curvature = dot(&scratch.direction, &scratch.image);
            if curvature <= 0.0 {
                // Nothing but rounding is left.
                break;
            }
            let length = rho / curvature;
            add_scaled(x, length, &scratch.direction);
            add_scaled(&mut scratch.residual, -length, &scratch.image);
            self.precondition(&mut scratch);
            let next = dot(&scratch.residual, &scratch.preconditioned);
            let turn = next / rho;
            rho = next;
            for (d, z) in scratch.direction.iter_mut().zip(&scratch.preconditioned) {
                *d = z + turn * *d;
            }
            steps += 1;
        }
        self.scratch = scratch;
        let mean = x.iter().sum::<f64>() / n as f64;
        for x in x.iter_mut() {
            *x -= mean;
        }
        steps
    }

    fn precondition(&self, scratch: &mut Scratch) {
        let rows = scratch.preconditioned.iter_mut().zip(&scratch.residual).zip(&self.diagonal);
        for ((z, r), diagonal) in rows {
            *z = if *diagonal > 0.0 { r / diagonal } else { 0.0 };
        }
    }

    /// `image` = L·x.
    fn multiply(&self, x: &[f64], image: &mut [f64]) {
        let rows = |(k, image): (usize, &mut [f64])| self.multiply_rows(k * CHUNK, x, image);
        if x.len() < PARALLEL {
            image.chunks_mut(CHUNK).enumerate().for_each(rows);
        } else {
            image.par_chunks_mut(CHUNK).enumerate().for_each(rows);
        }
    }

    fn multiply_rows(&self, first: usize, x: &[f64], image: &mut [f64]) {
        let mut start = if first == 0 { 0 } else { self.ends[first - 1] as usize };
        let rows = self.ends[first..].iter().zip(&self.diagonal[first..]).zip(&x[first..]);
        for (image, ((&end, diagonal), x_i)) in image.iter_mut().zip(rows) {
            let end = end as usize;
            let entries = self.columns[start..end].iter().zip(&self.values[start..end]);
            let others: f64 = entries.map(|(&j, value)| value * x[j as usize]).sum();
            *image = diagonal * x_i - others;
            start = end;
        }
    }
}

/// a·b, added up in chunks and then in order.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let part = |(a, b): (&[f64], &[f64])| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    a.chunks(CHUNK).zip(b.chunks(CHUNK)).map(part).sum()
}

fn add_scaled(to: &mut [f64], factor: f64, what: &[f64]) {
    for (to, what) in to.iter_mut().zip(what) {
        *to += factor * what;
    }
}
