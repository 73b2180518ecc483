//! The scenes by name.

use bn_core::DVec2;
use thiserror::Error;

use super::{
    Checkerboard, Constant, LimitedZonePlate, PlaneWave, PlaneWaves, Scene, SphereScene,
    StripedCloth, ZonePlate,
};
use crate::Frame;

/// The parameters of the scenes; each scene uses those that concern it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default))]
#[non_exhaustive]
pub struct SceneOptions {
    /// `zone-plate`: local frequency in cycles per pixel at half the image's width;
    /// `zone-plate-limited`: the highest frequency; `plane-wave`: its frequency. Default 1.
    pub frequency: f64,
    /// `zone-plate-limited`: where the highest frequency is reached, as a part of half the
    /// image's width. Default 1.
    pub cut_radius: f64,
    /// `plane-wave`: angle of the frequency vector against the u axis in degrees, clockwise as v
    /// points down. Default 0.
    pub angle_degrees: f64,
    /// `plane-wave`: phase in turns. Default 0.
    pub phase_turns: f64,
    /// `plane-wave`: mean; `constant`: the value; `checkerboard`: the sky. Default ½.
    pub level: f64,
    /// `plane-wave`: amplitude. Default ½.
    pub amplitude: f64,
    /// `sphere`: contrast about middle grey. Default 1.
    pub contrast: f64,
    /// `checkerboard`: the horizon's distance from the top as a part of the height. Default 0.3.
    pub horizon: f64,
    /// `checkerboard`: squares along the lower edge. Default 12.
    pub squares: f64,
}

impl Default for SceneOptions {
    fn default() -> Self {
        Self {
            frequency: 1.0,
            cut_radius: 1.0,
            angle_degrees: 0.0,
            phase_turns: 0.0,
            level: 0.5,
            amplitude: 0.5,
            contrast: 1.0,
            horizon: 0.3,
            squares: 12.0,
        }
    }
}

/// Why there is no such scene.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum SceneError {
    /// No scene has this name.
    #[error("there is no scene {name:?}")]
    Unknown {
        /// The name asked for.
        name: String,
    },
    /// A parameter is out of range.
    #[error("the scene's {option} is {value:?}; it must be {must}")]
    Option {
        /// The parameter's name.
        option: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        must: &'static str,
    },
}

/// A scene of the catalogue.
#[derive(Clone, Copy, Debug)]
pub struct SceneEntry {
    /// The name on the command line.
    pub name: &'static str,
    /// What it shows, in a line.
    pub summary: &'static str,
    /// The names of the options that concern it, as on the command line.
    pub options: &'static [&'static str],
    make: fn(&Frame, &SceneOptions) -> Box<dyn Scene>,
}

/// All scenes that are made by formulas.
pub const SCENES: &[SceneEntry] = &[
    SceneEntry {
        name: "zone-plate",
        summary: "concentric waves whose frequency grows with the radius",
        options: &["frequency"],
        make: |frame, o| Box::new(ZonePlate::new(frame, o.frequency)),
    },
    SceneEntry {
        name: "zone-plate-limited",
        summary: "the zone plate up to a highest frequency",
        options: &["frequency", "cut-radius"],
        make: |frame, o| {
            let radius = o.cut_radius * 0.5 * f64::from(frame.width());
            Box::new(LimitedZonePlate::new(frame, o.frequency, radius))
        },
    },
    SceneEntry {
        name: "checkerboard",
        summary: "an infinite checkerboard up to its horizon",
        options: &["level", "horizon", "squares"],
        make: |frame, o| Box::new(Checkerboard::new(frame, o.horizon, o.squares, o.level)),
    },
    SceneEntry {
        name: "plane-wave",
        summary: "a sinusoid",
        options: &["frequency", "angle", "phase", "level", "amplitude"],
        make: |_, o| Box::new(plane_wave(o)),
    },
    SceneEntry {
        name: "constant",
        summary: "one grey level",
        options: &["level"],
        make: |_, o| Box::new(Constant::grey(o.level)),
    },
    SceneEntry {
        name: "sphere",
        summary: "a ray-traced sphere and box with textures, edges and smooth shades",
        options: &["contrast"],
        make: |frame, o| Box::new(SphereScene::new(frame, o.contrast)),
    },
    SceneEntry {
        name: "striped-cloth",
        summary: "stripes in many directions, for moiré",
        options: &[],
        make: |frame, _| Box::new(StripedCloth::new(frame)),
    },
];

fn plane_wave(options: &SceneOptions) -> PlaneWaves {
    let angle = options.angle_degrees.to_radians();
    let direction = DVec2::new(libm::cos(angle), libm::sin(angle));
    let wave = PlaneWave {
        amplitude: options.amplitude,
        frequency: options.frequency * direction,
        phase_turns: options.phase_turns,
    };
    PlaneWaves::new(options.level, vec![wave])
}

/// The scene of this name over the frame.
///
/// # Errors
/// If there is no such scene or an option is out of range.
pub fn scene(
    name: &str,
    frame: &Frame,
    options: &SceneOptions,
) -> Result<Box<dyn Scene>, SceneError> {
    check(options)?;
    let entry = SCENES.iter().find(|entry| entry.name == name);
    let entry = entry.ok_or_else(|| SceneError::Unknown { name: name.to_owned() })?;
    Ok((entry.make)(frame, options))
}

fn check(options: &SceneOptions) -> Result<(), SceneError> {
    // Frequencies beyond this are sampled by nobody; phases keep their digits.
    const MOST: f64 = 1e6;
    let o = options;
    let ok = |option, value: f64, good: bool, must| {
        if good && value.is_finite() {
            Ok(())
        } else {
            Err(SceneError::Option { option, value, must })
        }
    };
    let modest = |x: f64| x.abs() <= MOST;
    ok("frequency", o.frequency, modest(o.frequency), "at most 1e6 in size")?;
    ok(
        "cut-off radius",
        o.cut_radius,
        o.cut_radius > 0.0 && modest(o.cut_radius),
        "above 0 and at most 1e6",
    )?;
    ok("angle", o.angle_degrees, modest(o.angle_degrees), "at most 1e6 in size")?;
    ok("phase", o.phase_turns, modest(o.phase_turns), "at most 1e6 in size")?;
    ok("level", o.level, modest(o.level), "at most 1e6 in size")?;
    ok("amplitude", o.amplitude, modest(o.amplitude), "at most 1e6 in size")?;
    ok("contrast", o.contrast, modest(o.contrast), "at most 1e6 in size")?;
    ok("horizon", o.horizon, (0.0..1.0).contains(&o.horizon), "from 0 to below 1")?;
    ok(
        "number of squares",
        o.squares,
        o.squares > 0.0 && modest(o.squares),
        "above 0 and at most 1e6",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_scene_gives_finite_values_whatever_the_slice() {
        let frame = Frame::new(64, 48).expect("a size");
        let u: Vec<f64> = (0..400).map(|i| f64::from(i % 20) * 3.7 - 4.0).collect();
        let v: Vec<f64> = (0..400).map(|i| f64::from(i / 20) * 2.9 - 4.0).collect();
        for entry in SCENES {
            let scene = scene(entry.name, &frame, &SceneOptions::default()).expect("a scene");
            let mut whole = vec![f64::NAN; 400 * scene.channels().count()];
            scene.values(&u, &v, &mut whole);
            assert!(whole.iter().all(|x| (-0.01..=1.01).contains(x)), "{}", entry.name);
            for i in 0..400 {
                let one = scene.value(DVec2::new(u[i], v[i]));
                assert_eq!(one[0].to_bits(), whole[i].to_bits(), "{} at {i}", entry.name);
            }
        }
    }

    #[test]
    fn names_and_options_are_checked() {
        let frame = Frame::new(64, 48).expect("a size");
        let unknown = scene("zone", &frame, &SceneOptions::default());
        assert!(matches!(unknown, Err(SceneError::Unknown { .. })));
        let bad = |o: SceneOptions| {
            matches!(scene("constant", &frame, &o), Err(SceneError::Option { .. }))
        };
        assert!(bad(SceneOptions { horizon: 1.0, ..Default::default() }));
        assert!(bad(SceneOptions { cut_radius: 0.0, ..Default::default() }));
        assert!(bad(SceneOptions { frequency: f64::NAN, ..Default::default() }));
        assert!(bad(SceneOptions { squares: f64::INFINITY, ..Default::default() }));
    }
}
