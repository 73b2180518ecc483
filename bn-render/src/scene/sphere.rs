//! A small ray-traced scene: a textured sphere, a box and a striped floor under one lamp.

use bn_core::DVec2;

use super::Scene;
use crate::simd::cos_turns;
use crate::{Channels, Frame};

/// A striped sphere beside a box on a striped floor before a wall, lit by one point lamp with hard
/// shadows: fine textures, hard edges and smooth shading, like the scene of the thesis's figure
/// 5.10, which is not ours to ship.
///
/// The sphere's stripes have 160 to 190 cycles to the image's width over most of it and ever more
/// towards its silhouette, with a third harmonic, the floor's mostly 100 to 300: in an image of 160
/// pixels most of the variance is finer than pixels, so that every pattern has noise to show, and the
/// few edges leave lattices an order of magnitude less.
///
/// Procedural and deterministic; one ray and at most one shadow ray for each sample, no
/// reflections. Values are ½ + contrast·(shade − ½) with shades in [0, 1]. Cost: some 100 ns a
/// sample.
#[derive(Clone, Copy, Debug)]
pub struct SphereScene {
    middle: DVec2,
    /// Pixels from the middle to the nearer edge.
    half: f64,
    contrast: f64,
}

impl SphereScene {
    /// The scene in the frame's middle, its height or width (whichever is less) filled.
    pub fn new(frame: &Frame, contrast: f64) -> Self {
        let middle = 0.5 * DVec2::new(f64::from(frame.width()), f64::from(frame.height()));
        Self { middle, half: middle.min_element(), contrast }
    }
}

impl Scene for SphereScene {
    fn channels(&self) -> Channels {
        Channels::Grey
    }

    fn values(&self, u: &[f64], v: &[f64], out: &mut [f64]) {
        for ((value, &u), &v) in out.iter_mut().zip(u).zip(v) {
            let p = (DVec2::new(u, v) - self.middle) / self.half;
            *value = 0.5 + self.contrast * (shade(camera_ray(p.x, -p.y)) - 0.5);
        }
    }
}

/// A vector in space: right, up, away from the camera.
type Vec3 = [f64; 3];

fn add(a: Vec3, b: Vec3, scale: f64) -> Vec3 {
    [a[0] + scale * b[0], a[1] + scale * b[1], a[2] + scale * b[2]]
}

fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn unit(a: Vec3) -> Vec3 {
    add([0.0; 3], a, 1.0 / dot(a, a).sqrt())
}

const EYE: Vec3 = [0.0, 1.5, -5.2];
const LAMP: Vec3 = [-3.2, 5.0, -3.4];
const SPHERE: Vec3 = [0.45, 1.0, 0.0];
const BOX_MIN: Vec3 = [-2.3, 0.0, 0.5];
const BOX_MAX: Vec3 = [-1.1, 1.5, 1.7];
const WALL: f64 = 4.0;
const AMBIENT: f64 = 0.18;

/// The direction in which the camera sees the picture's point (x, y), y upwards.
fn camera_ray(x: f64, y: f64) -> Vec3 {
    // The camera looks down by atan 0.125; half the picture is 0.36 of the distance.
    let (cos, sin) = (0.992_277_876_713_668_1, 0.124_034_734_589_208_5);
    let (x, y) = (0.36 * x, 0.36 * y);
    unit([x, y * cos - sin, y * sin + cos])
}

/// What a ray meets.
struct Hit {
    distance: f64,
    point: Vec3,
    normal: Vec3,
    surface: Surface,
}

#[derive(Clone, Copy, PartialEq)]
enum Surface {
    Sphere,
    Box,
    Floor,
    Wall,
}

/// The distance at which a ray from `from` meets the sphere.
fn meet_sphere(from: Vec3, ray: Vec3) -> Option<f64> {
    let to = add(from, SPHERE, -1.0);
    let b = dot(to, ray);
    let root = b * b - (dot(to, to) - 1.0);
    let t = -b - root.max(0.0).sqrt();
    (root > 0.0 && t > 1e-9).then_some(t)
}

/// The distance at which a ray enters the box, and the axis of the face.
fn meet_box(from: Vec3, ray: Vec3) -> Option<(f64, usize)> {
    let (mut enter, mut leave, mut axis) = (f64::NEG_INFINITY, f64::INFINITY, 0);
    for k in 0..3 {
        // Rays along a face divide by 0: the infinities sort themselves out, NaN loses.
        let a = (BOX_MIN[k] - from[k]) / ray[k];
        let b = (BOX_MAX[k] - from[k]) / ray[k];
        let (near, far) = (a.min(b), a.max(b));
        if near > enter {
            (enter, axis) = (near, k);
        }
        leave = leave.min(far);
    }
    (enter < leave && enter > 1e-9).then_some((enter, axis))
}

fn first_hit(ray: Vec3) -> Hit {
    let hit = |distance: f64, normal: Vec3, surface| Hit {
        distance,
        point: add(EYE, ray, distance),
        normal,
        surface,
    };
    let floor = if ray[1] < 0.0 { -EYE[1] / ray[1] } else { f64::INFINITY };
    let wall = if ray[2] > 0.0 { (WALL - EYE[2]) / ray[2] } else { f64::INFINITY };
    let mut nearest = if floor < wall {
        hit(floor, [0.0, 1.0, 0.0], Surface::Floor)
    } else {
        // Rays never leave this room: the camera looks at the wall.
        hit(wall, [0.0, 0.0, -1.0], Surface::Wall)
    };
    if let Some((t, axis)) = meet_box(EYE, ray).filter(|&(t, _)| t < nearest.distance) {
        let mut normal = [0.0; 3];
        normal[axis] = if ray[axis] > 0.0 { -1.0 } else { 1.0 };
        nearest = hit(t, normal, Surface::Box);
    }
    if let Some(t) = meet_sphere(EYE, ray).filter(|&t| t < nearest.distance) {
        let point = add(EYE, ray, t);
        nearest = hit(t, add(point, SPHERE, -1.0), Surface::Sphere);
    }
    nearest
}

/// The shade in [0, 1] that a ray from the camera sees.
fn shade(ray: Vec3) -> f64 {
    let Hit { point, normal, surface, .. } = first_hit(ray);
    let to_lamp = add(LAMP, point, -1.0);
    let range = dot(to_lamp, to_lamp).sqrt();
    let toward = add([0.0; 3], to_lamp, 1.0 / range);
    let facing = dot(normal, toward).max(0.0);
    // Convex bodies shadow others, never their own lit side.
    let hidden = (surface != Surface::Sphere
        && meet_sphere(point, toward).is_some_and(|t| t < range))
        || (surface != Surface::Box && meet_box(point, toward).is_some_and(|(t, _)| t < range));
    let direct = if hidden { 0.0 } else { facing * (40.0 / (10.0 + range * range)).min(1.0) };
    let matte = albedo(point, surface) * (AMBIENT + (1.0 - AMBIENT) * direct);
    let gloss =
        if surface == Surface::Sphere && !hidden { highlight(ray, normal, toward) } else { 0.0 };
    (matte + gloss * (1.0 - matte)).clamp(0.0, 1.0)
}

/// The share of light that the surface gives back.
///
/// The textures are waves in the two directions that the camera sees undistorted (sphere) or in
/// the one (floor): their frequencies in the picture vary little, by design.
fn albedo(point: Vec3, surface: Surface) -> f64 {
    match surface {
        Surface::Sphere => {
            let turns = 52.0 * (0.8 * point[0] + 0.6 * point[1]);
            0.5 + 0.5 / 1.09 * (sin_turns(turns) + 0.3 * sin_turns(3.0 * turns))
        }
        Surface::Floor => 0.5 + 0.45 * sin_turns(40.0 * point[0]),
        Surface::Box => 0.9,
        Surface::Wall => 0.45,
    }
}

/// sin(2π·`turns`).
fn sin_turns(turns: f64) -> f64 {
    cos_turns(turns - 0.25)
}

/// A soft highlight: the 32nd power of the cosine between mirrored ray and lamp.
fn highlight(ray: Vec3, normal: Vec3, toward: Vec3) -> f64 {
    let mirrored = add(ray, normal, -2.0 * dot(ray, normal));
    let mut power = dot(mirrored, toward).max(0.0);
    for _ in 0..5 {
        power *= power;
    }
    0.4 * power
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(contrast: f64) -> SphereScene {
        SphereScene::new(&Frame::new(160, 160).expect("a size"), contrast)
    }

    #[test]
    fn the_camera_looks_along_unit_vectors() {
        for (x, y) in [(0.0, 0.0), (1.0, 1.0), (-0.3, 0.7)] {
            let ray = camera_ray(x, y);
            assert!((dot(ray, ray) - 1.0).abs() < 1e-14);
        }
        let centre = camera_ray(0.0, 0.0);
        assert!((centre[1] / centre[2] + 0.125).abs() < 1e-14);
    }

    #[test]
    fn contrast_scales_about_middle_grey() {
        let (full, half) = (scene(1.0), scene(0.5));
        let mut values = Vec::new();
        for i in 0..160 * 160 {
            let at = DVec2::new(f64::from(i % 160) + 0.5, f64::from(i / 160) + 0.5);
            let (a, b) = (full.value(at)[0], half.value(at)[0]);
            assert!((0.0..=1.0).contains(&a) && ((b - 0.5) - 0.5 * (a - 0.5)).abs() < 1e-15);
            values.push(a);
        }
        values.sort_by(f64::total_cmp);
        let quantile = |q: usize| values[q * values.len() / 100];
        assert!(quantile(5) < 0.1 && quantile(95) > 0.6, "{} {}", quantile(5), quantile(95));
    }

    #[test]
    fn rays_meet_what_they_should() {
        let down = first_hit(unit([0.0, -1.0, 0.2]));
        assert!(down.surface == Surface::Floor && down.point[1].abs() < 1e-12);
        let ahead = first_hit(unit(add(SPHERE, EYE, -1.0)));
        assert!(
            ahead.surface == Surface::Sphere
                && (dot(ahead.normal, ahead.normal) - 1.0).abs() < 1e-12
        );
        let middle = [-1.7, 1.0, 1.1];
        assert!(first_hit(unit(add(middle, EYE, -1.0))).surface == Surface::Box);
        assert!(first_hit(unit([0.6, 0.3, 1.0])).surface == Surface::Wall);
    }
}
