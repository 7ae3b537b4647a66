//! A picture of a wind: its speed as color in a slice, its direction as streaks and arrows.
//!
//! The streaks are a line integral convolution (Cabral, Leedom 1993): noise that is averaged along the streamlines of the
//! wind's part in the slice, so what lies along a streamline has one brightness. The color is the whole speed, on a scale
//! whose lightness rises evenly in Oklab (Ottosson 2020); the scale stands below, with the length of a bar in meters.
//!
//! ```
//! use downpour_render::wind_picture::{WindPlane, WindSlice, draw_wind};
//! use glam::Vec3;
//! let slice = WindSlice::new(WindPlane::Xz, 1.5, Vec3::splat(-10.0), Vec3::splat(10.0), [160, 120])?;
//! let picture = draw_wind(&slice, &|at| Vec3::new(-at.z, 0.0, at.x));
//! assert_eq!(picture.pixels.len(), 160 * 120);
//! assert!(picture.divergence_rms < 1.0e-3 && picture.fastest > 10.0);
//! # Ok::<(), downpour_render::RenderError>(())
//! ```

mod arrows;
mod canvas;
mod colors;
mod streaks;

use downpour_math::in_range;
use glam::Vec3;
use rayon::prelude::*;

use crate::RenderError;
use canvas::Canvas;

/// Pixels each way.
const MIN_PIXELS: u32 = 64;
const MAX_PIXELS: u32 = 4096;

/// The fraction of the slice that is slower than the brightest color: a core of a few pixels shall not darken the rest.
const BRIGHTEST: f64 = 0.998;

/// Pixels each way at which the divergence is measured, at most.
const PROBES: u32 = 128;

/// Orientation of a slice. +Y is up in all pictures but those from above.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WindPlane {
    /// Constant z: x to the right, y up.
    Xy,
    /// Constant y, seen from above: x to the right, z down.
    Xz,
    /// Constant x: z to the left, as seen from +X; y up.
    Yz,
}

impl WindPlane {
    /// The directions in space of the picture's right and of its down.
    fn axes(self) -> [Vec3; 2] {
        match self {
            Self::Xy => [Vec3::X, Vec3::NEG_Y],
            Self::Xz => [Vec3::X, Vec3::Z],
            Self::Yz => [Vec3::NEG_Z, Vec3::NEG_Y],
        }
    }

    fn normal(self) -> Vec3 {
        match self {
            Self::Xy => Vec3::Z,
            Self::Xz => Vec3::Y,
            Self::Yz => Vec3::X,
        }
    }

    /// Name of the axis across the slice, written below the picture.
    fn name(self) -> &'static str {
        match self {
            Self::Xy => "z",
            Self::Xz => "y",
            Self::Yz => "x",
        }
    }
}

/// A slice through a box, as pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindSlice {
    plane: WindPlane,
    offset: f32,
    middle: Vec3,
    /// Meters per pixel.
    pixel: f32,
    /// Columns and rows of the picture, and rows of the slice.
    size: [u32; 2],
    rows: u32,
}

impl WindSlice {
    /// The slice of a box from `low` to `high`, m, at `offset`, m, along the third axis. Pixels are squares: the picture
    /// shows all of the box in two directions, and in one of them more.
    ///
    /// # Errors
    /// [`RenderError::Size`] if an edge is not 64 to 4096 pixels; [`RenderError::OutOfRange`] for an edge of the box that is
    /// not 0.01 to 1e6 m, or a position beyond 1e6 m.
    pub fn new(
        plane: WindPlane,
        offset: f32,
        low: Vec3,
        high: Vec3,
        size: [u32; 2],
    ) -> Result<Self, RenderError> {
        if !size.iter().all(|edge| (MIN_PIXELS..=MAX_PIXELS).contains(edge)) {
            return Err(RenderError::Size { found: size, min: MIN_PIXELS, max: MAX_PIXELS });
        }
        in_range("slice of the wind", offset, "m", &(-1.0e6..=1.0e6), 1.0, "-1e6 to 1e6")?;
        for (from, to) in low.to_array().into_iter().zip(high.to_array()) {
            in_range("corner of the box", from, "m", &(-1.0e6..=1.0e6), 1.0, "-1e6 to 1e6")?;
            in_range("edge of the box", to - from, "m", &(0.01..=1.0e6), 1.0, "0.01 to 1e6")?;
        }
        let rows = size[1].saturating_sub(legend_rows(size));
        let edges = plane.axes().map(|axis| axis.abs().dot(high - low));
        let pixel = (edges[0] / size[0] as f32).max(edges[1] / rows as f32);
        Ok(Self { plane, offset, middle: 0.5 * (low + high), pixel, size, rows })
    }

    /// The position of a pixel's middle.
    fn position(&self, column: u32, row: u32) -> Vec3 {
        let [right, down] = self.plane.axes();
        let normal = self.plane.normal();
        let from_middle = |n: u32, count: u32| (n as f32 + 0.5 - 0.5 * count as f32) * self.pixel;
        let level = self.middle - normal * self.middle.dot(normal) + normal * self.offset;
        level + right * from_middle(column, self.size[0]) + down * from_middle(row, self.rows)
    }
}

/// Height of the color scale below the picture, in pixels.
fn legend_rows(size: [u32; 2]) -> u32 {
    22 * letter_size(size)
}

/// Pixels per dot of a letter.
fn letter_size(size: [u32; 2]) -> u32 {
    (size[0].min(size[1]) / 400).clamp(1, 4)
}

/// Picture of a wind, with its statistics.
#[derive(Clone, Debug, PartialEq)]
pub struct WindPicture {
    /// Columns and rows.
    pub size: [u32; 2],
    /// sRGB, rows from the top.
    pub pixels: Vec<[u8; 3]>,
    /// Minimum speed in the slice, m/s.
    pub slowest: f64,
    /// Mean speed, m/s.
    pub mean: f64,
    /// Maximum speed, m/s.
    pub fastest: f64,
    /// Root mean square of the divergence, 1/s, from differences over a fifth of a pixel.
    pub divergence_rms: f64,
}

/// Wind in a slice, one value per pixel.
struct Flow {
    columns: usize,
    rows: usize,
    /// To the right and down, m/s.
    along: Vec<[f32; 2]>,
    speed: Vec<f32>,
    /// The speed of the brightest color, m/s; above 0.
    scale: f32,
}

impl Flow {
    fn new(slice: &WindSlice, air: &(dyn Fn(Vec3) -> Vec3 + Sync)) -> Self {
        let [columns, rows] = [slice.size[0], slice.rows].map(|n| n as usize);
        let [right, down] = slice.plane.axes();
        let velocity = |i: usize| air(slice.position((i % columns) as u32, (i / columns) as u32));
        let velocities: Vec<Vec3> = (0..columns * rows).into_par_iter().map(velocity).collect();
        let speed: Vec<f32> = velocities.iter().map(|v| v.length()).collect();
        let along = velocities.iter().map(|v| [v.dot(right), v.dot(down)]).collect();
        let mut sorted = speed.clone();
        sorted.sort_by(f32::total_cmp);
        let brightest = (BRIGHTEST * sorted.len().saturating_sub(1) as f64) as usize;
        let scale = sorted.get(brightest).copied().unwrap_or(0.0).max(1.0e-6);
        Self { columns, rows, along, speed, scale }
    }

    /// The flow at a position in pixels; nothing outside.
    fn at(&self, x: f32, y: f32) -> Option<[f32; 2]> {
        if x < 0.0 || y < 0.0 {
            return None;
        }
        let (column, row) = (x as usize, y as usize);
        if column >= self.columns { None } else { self.along.get(row * self.columns + column).copied() }
    }
}

/// Draws the wind in a slice; `air` gives the velocity at a position, m/s. The same bytes for any number of threads.
#[must_use]
pub fn draw_wind(slice: &WindSlice, air: &(dyn Fn(Vec3) -> Vec3 + Sync)) -> WindPicture {
    let flow = Flow::new(slice, air);
    let streaks = streaks::streaks(&flow);
    let mut canvas = Canvas::new(slice.size);
    for (i, (speed, streak)) in flow.speed.iter().zip(&streaks).enumerate() {
        let color = colors::of_speed(speed / flow.scale);
        canvas.set(i % flow.columns, i / flow.columns, color.map(|c| c * (1.0 + 0.45 * streak)));
    }
    arrows::draw(&mut canvas, &flow, letter_size(slice.size) as f32);
    legend(&mut canvas, slice, flow.scale);
    let count = flow.speed.len().max(1) as f64;
    WindPicture {
        size: slice.size,
        pixels: canvas.pixels(),
        slowest: flow.speed.iter().copied().fold(f32::INFINITY, f32::min).into(),
        mean: flow.speed.iter().map(|&s| f64::from(s)).sum::<f64>() / count,
        fastest: flow.speed.iter().copied().fold(0.0, f32::max).into(),
        divergence_rms: divergence(slice, air),
    }
}

/// The divergence at some pixels. A whole pixel may be as wide as the smallest eddy, whose slopes it would not see.
fn divergence(slice: &WindSlice, air: &(dyn Fn(Vec3) -> Vec3 + Sync)) -> f64 {
    let step = |n: u32| n.div_ceil(PROBES).max(1);
    let (across, down) = (step(slice.size[0]), step(slice.rows));
    let positions: Vec<[u32; 2]> = (0..slice.rows)
        .step_by(down as usize)
        .flat_map(|row| (0..slice.size[0]).step_by(across as usize).map(move |column| [column, row]))
        .collect();
    let h = 0.1 * slice.pixel;
    let squares: Vec<f64> = positions
        .par_iter()
        .map(|&[column, row]| {
            let at = slice.position(column, row);
            let slope = |axis: Vec3| (air(at + axis * h) - air(at - axis * h)).dot(axis) / (2.0 * h);
            let sum = f64::from(slope(Vec3::X)) + f64::from(slope(Vec3::Y)) + f64::from(slope(Vec3::Z));
            sum * sum
        })
        .collect();
    (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt()
}

/// The scale of the colors, where the slice is, and a bar of some meters.
fn legend(canvas: &mut Canvas, slice: &WindSlice, scale: f32) {
    let dot = letter_size(slice.size) as usize;
    let (width, top) = (slice.size[0] as usize, slice.rows as usize);
    let bar = (width / 3).max(20);
    let left = 4 * dot;
    for x in 0..bar {
        let color = colors::of_speed((x as f32 + 0.5) / bar as f32);
        for y in 0..5 * dot {
            canvas.set(left + x, top + 4 * dot + y, color);
        }
    }
    let base = top + 12 * dot;
    canvas.text(left, base, dot, "0");
    let most = format!("{} m/s", canvas::number(f64::from(scale)));
    canvas.text((left + bar).saturating_sub(canvas::width(&most) * dot), base, dot, &most);
    let what = format!("{}={} m", slice.plane.name(), canvas::number(f64::from(slice.offset)));
    let middle = left + bar + (width - left - bar) / 4;
    canvas.text(middle.saturating_sub(canvas::width(&what) * dot / 2), base, dot, &what);
    // The longest of 1, 2, 5 times a power of ten that fits a quarter of the picture.
    let meters = canvas::round_down(f64::from(slice.pixel) * width as f64 * 0.25);
    let long = ((meters / f64::from(slice.pixel)) as usize).clamp(1, width / 2);
    let start = width.saturating_sub(long + 4 * dot);
    for x in 0..long {
        for y in 0..2 * dot {
            canvas.set(start + x, top + 6 * dot + y, [0.8; 3]);
        }
    }
    let text = format!("{} m", canvas::number(meters));
    let at = (start + long / 2).saturating_sub(canvas::width(&text) * dot / 2);
    canvas.text(at.min(width.saturating_sub(canvas::width(&text) * dot)), base, dot, &text);
}
