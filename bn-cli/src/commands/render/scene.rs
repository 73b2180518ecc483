//! What is rendered: a scene by name, or an image.

use std::path::Path;

use anyhow::anyhow;
use bn_render::{
    Encoding, Frame, FrameError, Interpolation, Picture, SCENES, Scene, SceneOptions, Window,
};
use clap::{Args, ValueEnum};
use serde_json::{Map, Value, json};

use crate::image_file::ImageFormat;
use crate::{Failure, Outcome, image_file};

#[derive(Debug, Args)]
#[command(next_help_heading = "Scene")]
pub(super) struct SceneArgs {
    /// A scene by name (below), or an image file: .png, .pfm or .exr. PNG values are taken to linear
    /// light by the curve that the file names (sRGB or gAMA), else sRGB's; the others are linear.
    /// Alpha is ignored
    #[arg(value_name = "SCENE")]
    pub(super) scene: String,
    /// Size of the image in pixels, sides from 1 to 1048576 (default: 512x512, or that of the image
    /// file)
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    size: Option<(u32, u32)>,
    /// Render only this window of it, bit for bit what the whole image has there
    #[arg(long, value_name = "X,Y,W,H", value_parser = parse_window)]
    crop: Option<Window>,
    /// Between the pixels of an image file (default: bilinear)
    #[arg(long, value_name = "KIND")]
    interpolation: Option<Between>,
    /// The curve of a PNG's values, whatever the file says
    #[arg(long, value_name = "CURVE")]
    scene_encoding: Option<Curve>,
    /// zone-plate: local frequency in cycles per pixel at half the image's width;
    /// zone-plate-limited: the highest frequency; plane-wave: its frequency f, in level + amplitude
    /// cos(2 pi (f s + phase)), s the distance from the image's upper left corner along the angle
    /// (default: 1)
    #[arg(long, value_name = "F", allow_negative_numbers = true)]
    frequency: Option<f64>,
    /// zone-plate-limited: where the highest frequency is reached, over half the width; above 0
    /// (default: 1)
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    cut_radius: Option<f64>,
    /// plane-wave: angle of its frequency in degrees, clockwise (default: 0)
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true)]
    angle: Option<f64>,
    /// plane-wave: phase in turns (default: 0)
    #[arg(long, value_name = "TURNS", allow_negative_numbers = true)]
    phase: Option<f64>,
    /// plane-wave: mean; constant: the value; checkerboard: the sky (default: 0.5)
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    level: Option<f64>,
    /// plane-wave: amplitude (default: 0.5)
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    amplitude: Option<f64>,
    /// sphere: contrast about middle grey (default: 1)
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    contrast: Option<f64>,
    /// checkerboard: the horizon's distance from the top over the height, from 0 to below 1 (default:
    /// 0.3)
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    horizon: Option<f64>,
    /// checkerboard: squares along the lower edge, above 0 (default: 12)
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    squares: Option<f64>,
}

/// How an image is continued between its pixels.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Between {
    Box,
    Bilinear,
    Bicubic,
    Lanczos,
}

impl From<Between> for Interpolation {
    fn from(between: Between) -> Self {
        match between {
            Between::Box => Self::Box,
            Between::Bilinear => Self::Bilinear,
            Between::Bicubic => Self::Bicubic,
            Between::Lanczos => Self::Lanczos,
        }
    }
}

/// How stored integers relate to light.
#[derive(Clone, Copy, Debug, Default, ValueEnum)]
pub(super) enum Curve {
    #[default]
    Srgb,
    Linear,
}

impl From<Curve> for Encoding {
    fn from(curve: Curve) -> Self {
        match curve {
            Curve::Srgb => Self::Srgb,
            Curve::Linear => Self::Linear,
        }
    }
}

/// A scene over its frame.
pub(super) struct Subject {
    pub(super) scene: Box<dyn Scene>,
    pub(super) frame: Frame,
}

impl SceneArgs {
    /// The scene, or why there is none.
    pub(super) fn subject(&self) -> Outcome<Subject> {
        let entry = SCENES.iter().find(|entry| entry.name == self.scene);
        let takes = entry.map_or(&["interpolation", "scene-encoding"][..], |entry| entry.options);
        if let Some((name, _)) =
            self.given().iter().find(|(name, _)| !takes.contains(&name.as_str()))
        {
            return Err(Failure::misuse(format!("--{name} does not concern {}", self.scene)));
        }
        if entry.is_some() {
            let frame = self.frame((512, 512))?;
            let scene = bn_render::scene(&self.scene, &frame, &self.options());
            return Ok(Subject { scene: scene.map_err(Failure::usage)?, frame });
        }
        let path = Path::new(&self.scene);
        if path.extension().is_none() {
            let known: Vec<_> = SCENES.iter().map(|entry| entry.name).collect();
            return Err(Failure::misuse(format!(
                "there is no scene {:?}; there are {}, and image files (.png, .pfm, .exr)",
                self.scene,
                known.join(", ")
            )));
        }
        if self.scene_encoding.is_some() && ImageFormat::from_path(path)? != ImageFormat::Png {
            return Err(Failure::misuse(format!(
                "--scene-encoding concerns .png only; {} holds light",
                self.scene
            )));
        }
        let image = image_file::read(path, self.scene_encoding.map(Encoding::from))?;
        let frame = self.frame((image.width(), image.height()))?;
        let interpolation = self.interpolation.map_or_else(Interpolation::default, Into::into);
        Ok(Subject { scene: Box::new(Picture::covering(image, interpolation, &frame)), frame })
    }

    fn frame(&self, default: (u32, u32)) -> Outcome<Frame> {
        let (width, height) = self.size.unwrap_or(default);
        let refused = |option: &'static str| {
            move |error: FrameError| Failure::usage(anyhow!(error).context(option))
        };
        let frame = Frame::new(width, height).map_err(refused("--size"))?;
        match self.crop {
            Some(window) => frame.cropped(window).map_err(refused("--crop")),
            None => Ok(frame),
        }
    }

    /// The options that were given and concern some scenes only.
    pub(super) fn given(&self) -> Map<String, Value> {
        let number = |name, value: Option<f64>| Some((name, json!(value?)));
        let given = [
            self.interpolation.map(|between| ("interpolation", word(&between))),
            self.scene_encoding.map(|curve| ("scene-encoding", word(&curve))),
            number("frequency", self.frequency),
            number("cut-radius", self.cut_radius),
            number("angle", self.angle),
            number("phase", self.phase),
            number("level", self.level),
            number("amplitude", self.amplitude),
            number("contrast", self.contrast),
            number("horizon", self.horizon),
            number("squares", self.squares),
        ];
        given.into_iter().flatten().map(|(name, value)| (name.to_owned(), value)).collect()
    }

    fn options(&self) -> SceneOptions {
        let mut options = SceneOptions::default();
        let mut set = |slot: fn(&mut SceneOptions) -> &mut f64, value: Option<f64>| {
            if let Some(value) = value {
                *slot(&mut options) = value;
            }
        };
        set(|o| &mut o.frequency, self.frequency);
        set(|o| &mut o.cut_radius, self.cut_radius);
        set(|o| &mut o.angle_degrees, self.angle);
        set(|o| &mut o.phase_turns, self.phase);
        set(|o| &mut o.level, self.level);
        set(|o| &mut o.amplitude, self.amplitude);
        set(|o| &mut o.contrast, self.contrast);
        set(|o| &mut o.horizon, self.horizon);
        set(|o| &mut o.squares, self.squares);
        options
    }
}

/// The word that was typed for a value.
pub(super) fn word(value: &impl ValueEnum) -> Value {
    json!(value.to_possible_value().map(|word| word.get_name().to_owned()))
}

fn numbers<const N: usize>(text: &str, separator: char) -> Option<[u32; N]> {
    let parts: Result<Vec<u32>, _> =
        text.split(separator).map(|part| part.trim().parse()).collect();
    parts.ok()?.try_into().ok()
}

fn parse_size(text: &str) -> Result<(u32, u32), String> {
    let [width, height] = numbers(&text.to_ascii_lowercase(), 'x')
        .ok_or("a size looks like 640x480, up to 1048576")?;
    Ok((width, height))
}

fn parse_window(text: &str) -> Result<Window, String> {
    let [x, y, width, height] = numbers(text, ',').ok_or(
        "a window is its first column and row, its width and height, such as 100,50,64,64",
    )?;
    Ok(Window { x, y, width, height })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_and_windows_are_read() {
        assert_eq!(parse_size("640x480"), Ok((640, 480)));
        assert_eq!(parse_size("640X480"), Ok((640, 480)));
        let window = Window { x: 1, y: 2, width: 3, height: 4 };
        assert_eq!(parse_window("1, 2,3,4"), Ok(window));
        for bad in ["", "640", "640x", "1x2x3", "-1x3", "1.5x2", "99999999999x1"] {
            assert!(parse_size(bad).is_err(), "{bad}");
        }
        assert!(parse_window("1,2,3").is_err() && parse_window("1,2,3,-4").is_err());
    }

    /// Every option of a scene can be typed: a new one has to be entered here too.
    #[test]
    fn every_option_of_every_scene_is_known() {
        let command = SceneArgs::augment_args(clap::Command::new("render"));
        for entry in SCENES {
            for option in entry.options {
                let known = command.get_arguments().any(|arg| arg.get_long() == Some(option));
                assert!(known, "{option} of {}", entry.name);
            }
        }
    }
}
