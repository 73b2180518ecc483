//! From linear light to the numbers in a file, and back.

/// How stored integers relate to linear light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Encoding {
    /// The transfer curve of sRGB (IEC 61966-2-1): what screens expect.
    #[default]
    Srgb,
    /// Proportional to light.
    Linear,
}

/// The sRGB curve: 12.92 x up to 0.0031308, then 1.055 x^(1/2.4) − 0.055.
pub fn srgb_from_linear(linear: f64) -> f64 {
    if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055
    }
}

/// The inverse of the sRGB curve: x/12.92 up to 0.04045, then ((x + 0.055)/1.055)^2.4.
pub fn linear_from_srgb(encoded: f64) -> f64 {
    if encoded <= 0.040_45 { encoded / 12.92 } else { libm::pow((encoded + 0.055) / 1.055, 2.4) }
}

impl Encoding {
    /// Encoded value of linear light.
    pub fn encode(self, linear: f64) -> f64 {
        match self {
            Self::Srgb => srgb_from_linear(linear),
            Self::Linear => linear,
        }
    }

    /// Linear light of an encoded value.
    pub fn decode(self, encoded: f64) -> f64 {
        match self {
            Self::Srgb => linear_from_srgb(encoded),
            Self::Linear => encoded,
        }
    }
}

/// Turns linear light into integers 0 … max, rounding the encoded value to the nearest.
///
/// The light at which one integer gives way to the next is tabulated, so a value costs a look-up
/// and a few comparisons, no power.
pub(super) struct Quantizer {
    /// thresholds\[k\]: the least light that becomes k + 1.
    thresholds: Vec<f32>,
    /// The integer at the lower end of each of equal steps of light.
    guide: Vec<u16>,
}

impl Quantizer {
    /// For integers 0 … `max`.
    pub(super) fn new(encoding: Encoding, max: u16) -> Self {
        let threshold = |k: u16| encoding.decode((f64::from(k) + 0.5) / f64::from(max)) as f32;
        let thresholds: Vec<f32> = (0..max).map(threshold).collect();
        let steps = 4 * usize::from(max);
        let mut code = 0;
        let guide = (0..=steps)
            .map(|i| {
                // Rounding of the step's index below must not lead past the right integer.
                let light = i as f32 / steps as f32 * (1.0 - 1e-6);
                while code < thresholds.len() && thresholds[code] <= light {
                    code += 1;
                }
                code as u16
            })
            .collect();
        Self { thresholds, guide }
    }

    /// The integer for `light`; values outside [0, 1] are clamped, NaN gives 0.
    pub(super) fn quantize(&self, light: f32) -> u16 {
        let light = light.clamp(0.0, 1.0);
        let steps = (self.guide.len() - 1) as f32;
        let mut code = self.guide[(light * steps) as usize];
        while self.thresholds.get(usize::from(code)).is_some_and(|&next| light >= next) {
            code += 1;
        }
        code
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_and_its_inverse_meet_the_standard() {
        for i in 0..=1000 {
            let x = f64::from(i) / 1000.0;
            assert!((linear_from_srgb(srgb_from_linear(x)) - x).abs() < 1e-7, "{x}");
        }
        // The standard's constants leave a step of 3e-8 where the pieces meet.
        assert!((srgb_from_linear(0.5) - 0.735_356_983_052_449).abs() < 1e-12);
        assert!((linear_from_srgb(0.5) - 0.214_041_140_482_232_5).abs() < 1e-12);
    }

    #[test]
    fn quantizing_rounds_the_encoded_value() {
        for (encoding, max) in [
            (Encoding::Srgb, 255),
            (Encoding::Linear, 255),
            (Encoding::Srgb, 65535),
            (Encoding::Linear, 65535),
        ] {
            let quantizer = Quantizer::new(encoding, max);
            for i in 0..=30_000 {
                let light = i as f32 / 30_000.0;
                let exact = encoding.encode(f64::from(light)) * f64::from(max);
                let got = f64::from(quantizer.quantize(light));
                // Half a step, and the rounding of the tabulated threshold to f32.
                assert!((got - exact).abs() <= 0.5 + 0.01, "{encoding:?}/{max}: {got} for {exact}");
            }
            for k in 0..=max {
                let light = encoding.decode(f64::from(k) / f64::from(max)) as f32;
                assert_eq!(quantizer.quantize(light), k, "{encoding:?}/{max}");
            }
            assert_eq!(quantizer.quantize(-3.0), 0);
            assert_eq!(quantizer.quantize(7.0), max);
            assert_eq!(quantizer.quantize(f32::NAN), 0);
        }
    }
}
