//! Rain in the pictures of a device has the density of the rain, in each part of the picture and for each size, for any motion of the camera:
//! a pan of 360 degrees a second, jumps, a zoom. In closed form, and step by step. Expectations are integrals of the size distribution.
#![cfg(feature = "wgpu")]

mod device;

use std::error::Error;

use downpour::drop::distribution::{DropSizeDistribution, DropSizeLaw};
use downpour::gpu::{Gpu, LimitSet};
use downpour::math::ops::f64 as ops;
use downpour::scene::Budget;
use downpour::sim::field::FallingDrop;
use downpour::sim::resolved::Resolved;
use downpour::weather::CameraPose;
use downpour::{Device, Frame, Renderer, RendererOptions, Source};
use glam::DVec3;

type Outcome = Result<(), Box<dyn Error>>;

/// Columns and rows of pictures: few, with small drops, since all are drawn.
const SIZE: [f64; 2] = [320.0, 180.0];

/// Parts of the picture along its width and its height, and along the distance.
const PARTS: [usize; 3] = [3, 2, 2];

/// Line of `[rain]` for rain that goes step by step.
const STEPS: &str = "volume = \"view\"";

/// mm/h.
const RATE: f64 = 500.0;

/// Diameters between which drops are counted together, m.
const SIZES: [f64; 5] = [0.4e-3, 1.1e-3, 1.6e-3, 2.4e-3, 6.0e-3];

/// Rain alone, with these lines in `[rain]` and `[camera]`.
fn renderer(gpu: &Gpu, of_rain: &str, of_camera: &str) -> Result<Renderer, Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let file = folder.path().join("rain.toml");
    let [width, height] = SIZE;
    let weather = format!(
        "[rain]\nrate_mm_h = {RATE}\n{of_rain}\n[camera]\n{of_camera}\nshutter_s = 0\n[output]\nsize = [{width}, {height}]\n\
         [[wind]]\nuniform = {{ speed_m_s = 3, towards_deg = 40 }}\n"
    );
    std::fs::write(&file, weather)?;
    let source = Source::read(&file, &[], &mut Budget::default())?;
    let options = RendererOptions { samples: 1, sky_rays: 0, ..RendererOptions::default() };
    Ok(Renderer::new(source.weather, source.loaded, options, Device::gpu(gpu.clone(), false))?)
}

/// Solid angle, sr, of the rectangle from the middle of a picture to a point, both in the plane at distance 1.
fn solid_angle([x, y]: [f64; 2]) -> f64 {
    ops::atan2(x * y, (1.0 + x * x + y * y).sqrt())
}

/// Chi-square of counts that are Poisson distributed, minus its mean, in its standard deviations.
fn excess(counts: &[f64], expected: &[f64]) -> f64 {
    let chi: f64 = counts.iter().zip(expected).map(|(n, mean)| (n - mean) * (n - mean) / mean).sum();
    let freedom = counts.len() as f64;
    (chi - freedom) / (2.0 * freedom).sqrt()
}

/// Parts of a picture, and the drops that are expected in them.
struct Density<'a> {
    resolved: &'a Resolved,
    /// Half of the picture's width and height at distance 1.
    half: [f64; 2],
}

impl Density<'_> {
    /// Part of the picture, and of the distance up to which drops of its size are resolved, that a drop is in.
    fn part(&self, drop: &FallingDrop, pose: &CameraPose) -> Option<usize> {
        let right = pose.forward.cross(DVec3::Y).normalize();
        let up = right.cross(pose.forward);
        let offset = drop.position - pose.position;
        let ahead = offset.dot(pose.forward);
        let at = [offset.dot(right) / ahead, offset.dot(up) / ahead];
        let [near, far] = self.ranges(f64::from(drop.diameter)).map(|range| ops::pow(range, 3.0));
        let deep = (ops::pow(offset.length(), 3.0) - near) / (far - near);
        let along = [at[0] / self.half[0] * 0.5 + 0.5, at[1] / self.half[1] * 0.5 + 0.5, deep];
        if ahead <= 0.0 || along.iter().any(|part| !(0.0..1.0).contains(part)) {
            return None;
        }
        let [x, y, z] = [0, 1, 2].map(|k| (along[k] * PARTS[k] as f64) as usize);
        Some((x * PARTS[1] + y) * PARTS[2] + z)
    }

    /// Least and greatest distance of drops of a diameter, m.
    fn ranges(&self, diameter: f64) -> [f64; 2] {
        [self.resolved.near, self.resolved.range(diameter).max(self.resolved.near)]
    }

    /// Drops between two diameters, m, that are expected in a steradian of the picture.
    fn expected(&self, rain: &DropSizeDistribution, [from, to]: [f64; 2]) -> f64 {
        let steps = 2000;
        let of = |k: u32| {
            let diameter = from + (to - from) * (f64::from(k) + 0.5) / f64::from(steps);
            let [near, far] = self.ranges(diameter).map(|range| ops::pow(range, 3.0));
            rain.concentration(diameter) * (far - near) / 3.0
        };
        (0..steps).map(of).sum::<f64>() * (to - from) / f64::from(steps)
    }

    /// Solid angle of a part of the picture, sr.
    fn solid(&self, x: usize, y: usize) -> f64 {
        let edge = |k: usize, axis: usize| self.half[axis] * (2.0 * k as f64 / PARTS[axis] as f64 - 1.0);
        let corner = |x, y| solid_angle([edge(x, 0), edge(y, 1)]);
        corner(x + 1, y + 1) - corner(x, y + 1) - corner(x + 1, y) + corner(x, y)
    }
}

/// Compares the drops of a frame with the rain.
fn check(frame: &Frame, pose: &CameraPose, fov_deg: f64, when: &str) -> Outcome {
    let rain = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, RATE)?;
    let half = ops::tan(0.5 * fov_deg.to_radians());
    let resolved = &frame.drops.resolved;
    let density = Density { resolved, half: [half * SIZE[0] / SIZE[1], half] };
    let mut parts = vec![0.0; PARTS.iter().product()];
    let mut sizes = vec![0.0; SIZES.len() - 1];
    for drop in &frame.drops.drops {
        let of_size = SIZES.partition_point(|&edge| edge <= f64::from(drop.diameter));
        if let Some(part) = density.part(drop, pose)
            && (1..SIZES.len()).contains(&of_size)
        {
            parts[part] += 1.0;
            sizes[of_size - 1] += 1.0;
        }
    }
    let of_all: Vec<f64> = SIZES.windows(2).map(|pair| density.expected(&rain, [pair[0], pair[1]])).collect();
    let all: f64 = of_all.iter().sum();
    let cells = (0..PARTS[0]).flat_map(|x| (0..PARTS[1]).map(move |y| (x, y)));
    let of_parts: Vec<f64> =
        cells.flat_map(|(x, y)| [density.solid(x, y) * all / PARTS[2] as f64; PARTS[2]]).collect();
    let solid = 4.0 * solid_angle(density.half);
    let of_sizes: Vec<f64> = of_all.iter().map(|of_size| of_size * solid).collect();
    let (over_parts, over_sizes) = (excess(&parts, &of_parts), excess(&sizes, &of_sizes));
    let counted: f64 = parts.iter().sum();
    println!("{when}: {counted} of {:.0}, {over_parts:.1}, sizes {over_sizes:.1}", all * solid);
    assert!(of_parts.iter().chain(&of_sizes).all(|&mean| mean > 10.0), "{of_parts:?} {of_sizes:?}");
    assert!(over_parts.abs() < 4.0, "{when}: {over_parts} standard deviations over the picture: {parts:?}");
    assert!(over_sizes.abs() < 4.0, "{when}: {over_sizes} standard deviations over the sizes: {sizes:?}");
    Ok(())
}

/// A change of the field of view: degrees at the start and at the end, and its duration, s.
#[derive(Clone, Copy)]
struct Zoom([f64; 2], f64);

impl Zoom {
    fn at(&self, time_s: f64) -> f64 {
        let Self([from, to], duration_s) = *self;
        from + (to - from) * (time_s / duration_s).min(1.0)
    }
}

/// Motion of the camera.
#[derive(Clone, Copy)]
enum Motion {
    /// Lines of `[camera]`.
    Keys(&'static str),
    /// Each picture from elsewhere.
    Jumps,
}

/// Pictures, `fps` in a second, with the density of every fourth.
fn run(gpu: &Gpu, name: &str, of_rain: &str, zoom: Zoom, fps: f64, motion: Motion) -> Outcome {
    let Zoom([from, to], duration_s) = zoom;
    let keys = match motion {
        Motion::Keys(keys) => keys,
        Motion::Jumps => "",
    };
    let mut renderer =
        renderer(gpu, of_rain, &format!("fov_deg = [[0, {from}], [{duration_s}, {to}]]\n{keys}"))?;
    for k in 0..=8 {
        let time_s = f64::from(k) / fps;
        if let Motion::Jumps = motion {
            renderer.set_camera(elsewhere(f64::from(k)))?;
        }
        if k % 4 == 0 {
            let frame = renderer.frame(time_s)?;
            let pose = renderer.weather().camera.path.as_ref().ok_or("a path")?.at(time_s);
            check(&frame, &pose, zoom.at(time_s), &format!("{name}, picture {k}"))?;
        } else if of_rain == STEPS {
            renderer.display(time_s)?;
        }
    }
    Ok(())
}

/// 360 degrees a second while the eye walks.
const PAN: Motion = Motion::Keys(
    "position_m = [[0, [0, 50, 0]], [1, [2, 50, -3]]]\nyaw_deg = [[0, 0], [1, 360]]\npitch_deg = [[0, -20], [0.2, 20]]",
);

/// A camera on its tripod.
const STILL: Motion = Motion::Keys("position_m = [3, 50, 0]\nyaw_deg = 20\npitch_deg = 5");

/// A pose that has nothing to do with those of other numbers.
fn elsewhere(number: f64) -> CameraPose {
    let position = DVec3::new(300.0 * ops::sin(2.3 * number), 50.0, 300.0 * ops::cos(1.7 * number));
    let forward = DVec3::new(ops::sin(2.0 * number), 0.4, -ops::cos(2.0 * number)).normalize();
    CameraPose { position, forward }
}

#[test]
fn density_is_the_rains_in_closed_form() -> Outcome {
    let Some(gpu) = device::gpu(LimitSet::Adapter) else { return Ok(()) };
    let zoom = Zoom([60.0, 25.0], 0.3);
    run(&gpu, "pan", "", zoom, 60.0, PAN)?;
    run(&gpu, "jumps", "", zoom, 60.0, Motion::Jumps)
}

/// A state serves the pictures until the next step: those between steps are turned away from it.
#[test]
fn density_is_the_rains_step_by_step() -> Outcome {
    let Some(gpu) = device::gpu(LimitSet::Adapter) else { return Ok(()) };
    let zoom = Zoom([45.0, 40.0], 0.3);
    run(&gpu, "pan in steps", STEPS, zoom, 60.0, PAN)?;
    run(&gpu, "pan between steps", STEPS, zoom, 85.0, PAN)?;
    run(&gpu, "jumps in steps", STEPS, zoom, 60.0, Motion::Jumps)
}

/// Some of the pictures of a state see more to the sides than that in the middle, others farther.
#[test]
fn density_is_the_rains_in_a_fast_zoom() -> Outcome {
    let Some(gpu) = device::gpu(LimitSet::Adapter) else { return Ok(()) };
    for (name, ends) in [("in", [70.0, 20.0]), ("out", [20.0, 70.0])] {
        run(&gpu, name, STEPS, Zoom(ends, 0.1), 85.0, STILL)?;
    }
    Ok(())
}
