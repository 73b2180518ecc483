//! How far an image is from another.

use crate::{Image, ImageError, linear_from_srgb};

/// Mean square error: the mean of (a − b)² over all pixels and channels, of the unquantised values.
///
/// Sums run in f64, row by row, so the result is exact to some 1e-14 relatively and the same
/// whatever the number of threads.
///
/// # Errors
/// If the images differ in size or channels.
pub fn mean_square_error(a: &Image, b: &Image) -> Result<f64, ImageError> {
    check_shapes(a, b)?;
    let row = a.row_len();
    let rows = a.values().chunks_exact(row).zip(b.values().chunks_exact(row));
    let sum: f64 = rows.map(|(a, b)| square_distance(a, b)).sum();
    Ok(sum / a.values().len() as f64)
}

fn square_distance(a: &[f32], b: &[f32]) -> f64 {
    let squares = a.iter().zip(b).map(|(&a, &b)| (f64::from(a) - f64::from(b)).powi(2));
    squares.sum()
}

/// Peak signal-to-noise ratio 10·log₁₀(1/MSE) in dB, for values in [0, 1] units; infinite for
/// equal images.
///
/// The thesis's 255²/MSE of 8-bit values is the same number before rounding to 8 bits.
pub fn peak_signal_to_noise(mean_square_error: f64) -> f64 {
    -10.0 * libm::log10(mean_square_error)
}

/// The error image a − b, signed.
///
/// # Errors
/// If the images differ in size or channels.
pub fn difference(a: &Image, b: &Image) -> Result<Image, ImageError> {
    check_shapes(a, b)?;
    let values = a.values().iter().zip(b.values()).map(|(a, b)| a - b).collect();
    Image::new(a.width(), a.height(), a.channels(), values)
}

/// The error image as a picture: middle grey where a = b, lighter where a is lighter, `gain` times
/// enlarged. Written with the sRGB curve, the values in the file are ½ + gain·(a − b).
///
/// # Errors
/// If the images differ in size or channels.
pub fn error_picture(a: &Image, b: &Image, gain: f32) -> Result<Image, ImageError> {
    let error = difference(a, b)?;
    let light = |d: f32| linear_from_srgb(f64::from((0.5 + gain * d).clamp(0.0, 1.0))) as f32;
    let values = error.values().iter().map(|&d| light(d)).collect();
    Image::new(a.width(), a.height(), a.channels(), values)
}

fn check_shapes(a: &Image, b: &Image) -> Result<(), ImageError> {
    if a.shape() == b.shape() {
        Ok(())
    } else {
        Err(ImageError::Mismatch { a: a.shape(), b: b.shape() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Channels;

    fn image(values: Vec<f32>) -> Image {
        Image::new(values.len() as u32 / 2, 2, Channels::Grey, values).expect("an image")
    }

    #[test]
    fn errors_of_known_images() {
        let (a, b) = (image(vec![0.0, 0.5, 1.0, 0.25]), image(vec![0.0, 0.75, 0.5, 0.25]));
        let mse = mean_square_error(&a, &b).expect("same shape");
        assert_eq!(mse, (0.0625 + 0.25) / 4.0);
        assert!((peak_signal_to_noise(1e-3) - 30.0).abs() < 1e-12);
        assert_eq!(peak_signal_to_noise(0.0), f64::INFINITY);
        assert_eq!(difference(&a, &b).expect("same shape").values(), [0.0, -0.25, 0.5, 0.0]);
        let picture = error_picture(&a, &b, 4.0).expect("same shape");
        let grey = linear_from_srgb(0.5) as f32;
        assert_eq!(picture.values(), [grey, 0.0, 1.0, grey]);
    }

    #[test]
    fn different_shapes_are_refused() {
        let (a, b) = (image(vec![0.0; 4]), image(vec![0.0; 6]));
        assert!(matches!(mean_square_error(&a, &b), Err(ImageError::Mismatch { .. })));
        assert!(difference(&a, &b).is_err());
    }
}
