//! Density functions from images and formulas.

use std::path::Path;

use anyhow::anyhow;
use bn_core::{DensityFunction, DensityFunctionError};
use bn_render::Channels;
use exmex::{BinOp, Express, FlatEx, FloatOpsFactory, MakeOperators, Operator};

use crate::{Failure, Outcome, image_file};

/// Pixels on a side of the raster that a formula is evaluated on.
const FORMULA_SIDE: usize = 1024;

/// The longest formula.
const MAX_FORMULA: usize = 1000;

/// The density that `text` says: the name of a `.png`, `.pfm` or `.exr` image, or a formula of x and y.
///
/// An image lies on the unit square with its top row at y = 1; points are as dense as it is dark,
/// in proportion to 1 minus its linear luminance. A formula such as `0.1 + x^2` is evaluated at the
/// centres of 1024 × 1024 pixels.
///
/// # Errors
/// Files and formulas that are bad, negative or all 0 are bad use.
pub fn density(text: &str) -> Outcome<DensityFunction> {
    let path = Path::new(text);
    let extension = path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase);
    match extension.as_deref() {
        Some("png" | "pfm" | "exr") => from_image(path),
        _ => from_formula(text).map_err(Failure::usage),
    }
    .map_err(|failure| failure.context(format!("--density {text}")))
}

fn from_image(path: &Path) -> Outcome<DensityFunction> {
    let image = image_file::read(path, None)?;
    let (width, height) = (image.width() as usize, image.height() as usize);
    let mut values = Vec::with_capacity(width * height);
    for row in (0..image.height()).rev() {
        for column in 0..image.width() {
            let pixel = image.pixel(column, row);
            let luminance = match image.channels() {
                Channels::Grey => f64::from(pixel[0]),
                // Rec. 709, whose primaries are those of sRGB.
                Channels::Rgb => {
                    0.2126 * f64::from(pixel[0])
                        + 0.7152 * f64::from(pixel[1])
                        + 0.0722 * f64::from(pixel[2])
                }
            };
            values.push((1.0 - luminance).clamp(0.0, 1.0));
        }
    }
    DensityFunction::from_raster(width, height, values).map_err(|error| match error {
        DensityFunctionError::Sum { .. } => {
            Failure::misuse("the image is white all over: points go where it is dark")
        }
        other => Failure::usage(other),
    })
}

/// The usual operators and functions, those that platforms compute differently by libm: formulas
/// decide where points lie.
#[derive(Clone, Debug)]
struct Portable;

impl MakeOperators<f64> for Portable {
    fn make<'a>() -> Vec<Operator<'a, f64>> {
        type Function = fn(f64) -> f64;
        let functions: [(&str, Function); 19] = [
            ("sin", libm::sin),
            ("cos", libm::cos),
            ("tan", libm::tan),
            ("asin", libm::asin),
            ("acos", libm::acos),
            ("atan", libm::atan),
            ("sinh", libm::sinh),
            ("cosh", libm::cosh),
            ("tanh", libm::tanh),
            ("asinh", libm::asinh),
            ("acosh", libm::acosh),
            ("atanh", libm::atanh),
            ("exp", libm::exp),
            ("cbrt", libm::cbrt),
            ("ln", libm::log),
            ("log", libm::log),
            ("log2", libm::log2),
            ("log10", libm::log10),
            ("round", libm::round),
        ];
        let power = BinOp { apply: libm::pow, prio: 4, is_commutative: false };
        let angle = BinOp { apply: libm::atan2, prio: 0, is_commutative: false };
        let replaced = |name: &str| {
            ["^", "atan2"].contains(&name) || functions.iter().any(|(ours, _)| *ours == name)
        };
        let mut operators = FloatOpsFactory::<f64>::make();
        operators.retain(|operator| !replaced(operator.repr()));
        operators.push(Operator::make_bin("^", power));
        operators.push(Operator::make_bin("atan2", angle));
        operators.extend(functions.map(|(name, apply)| Operator::make_unary(name, apply)));
        operators
    }
}

const GRAMMAR: &str = "formulas have numbers such as 0.001 (not 1e-3), x, y, PI, E, + - * / ^, \
                       sqrt, abs, exp, ln, sin, cos, min, max and the like";

fn from_formula(text: &str) -> anyhow::Result<DensityFunction> {
    let mend = "give an image (.png, .pfm) or a formula of x and y such as 0.1+x^2";
    if text.len() > MAX_FORMULA {
        return Err(anyhow!("longer than {MAX_FORMULA} characters; {mend}"));
    }
    let formula: FlatEx<f64, Portable> =
        FlatEx::parse(text).map_err(|_| anyhow!("not a formula; {mend}; {GRAMMAR}"))?;
    let names = formula.var_names();
    if let Some(name) = names.iter().find(|name| *name != "x" && *name != "y") {
        return Err(anyhow!("no variable is called {name}; {mend}"));
    }
    let mut variables = vec![0.0; names.len()];
    let density = DensityFunction::from_fn(FORMULA_SIDE, |p| {
        for (variable, name) in variables.iter_mut().zip(names) {
            *variable = if name == "x" { p.x } else { p.y };
        }
        formula.eval(&variables).unwrap_or(f64::NAN)
    });
    Ok(density?)
}

#[cfg(test)]
mod tests {
    use std::fs::File;

    use super::*;
    use bn_core::DVec2;
    use bn_render::Image;

    #[test]
    fn formulas_know_x_and_y() {
        let ramp = density("3*x").expect("valid");
        assert!((ramp.at(DVec2::new(0.75, 0.1)) - 1.5).abs() < 2e-3);
        let both = density("1 + cos(2*PI*y)*x").expect("valid");
        assert!(both.at(DVec2::new(0.99, 0.01)) > both.at(DVec2::new(0.99, 0.5)));
        let gaussian = density("exp(-8*((x-0.5)^2+(y-0.5)^2))").expect("valid");
        let ratio = gaussian.at(DVec2::splat(0.5)) / gaussian.at(DVec2::new(1e-3, 0.5));
        // Pixels of 1/1024 move the places by half of that.
        assert!((ratio / libm::exp(2.0) - 1.0).abs() < 0.02, "{ratio}");
        assert_eq!(density("2").expect("constant").max(), 1.0);
    }

    #[test]
    fn bad_densities_are_refused() {
        for text in ["", "x +", "z", "x - 2", "1/0*x", "0", "nosuch.png", "nosuch.pfm", "sin("] {
            assert!(density(text).is_err(), "{text:?}");
        }
        assert!(density(&"x+".repeat(MAX_FORMULA)).is_err());
        assert!(density(&"(".repeat(900)).is_err());
    }

    #[test]
    fn dark_pixels_of_an_image_are_dense() {
        // Two rows: black above white.
        let image = Image::new(1, 2, Channels::Grey, vec![0.0, 1.0]).expect("valid");
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("step.pfm");
        bn_render::write_pfm(&image, File::create(&path).expect("a file")).expect("written");
        let density = density(path.to_str().expect("text")).expect("valid");
        assert_eq!(density.at(DVec2::new(0.5, 0.75)), 2.0);
        assert_eq!(density.at(DVec2::new(0.5, 0.25)), 0.0);
    }
}
