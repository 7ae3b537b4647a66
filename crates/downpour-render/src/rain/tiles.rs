//! The drops of a picture, nearest first, and for each tile of the picture those that touch it.

use downpour_math::ops;
use downpour_shaders::render::rain::DROPS_TILE;
use downpour_sim::field::FallingDrop;
use glam::{DVec3, Vec3};

use super::capture::CaptureFrame;
use super::drops::{DropsDrop, DropsFrame};
use super::{DropMasks, RainOptions};
use crate::data::RenderFrame;

/// Drops of a smaller diameter on the picture, in pixels, are spread over the pixels round them.
const SMALL: f32 = 1.0;

/// The drops of one picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Rain {
    /// What the shader knows of the picture.
    pub frame: DropsFrame,
    /// How the surroundings are captured.
    pub capture: CaptureFrame,
    /// The drops on the picture, nearest first.
    pub list: Vec<DropsDrop>,
    /// Where each tile's list begins (one more than there are tiles), then the lists.
    pub tiles: Vec<u32>,
    /// For each drop of `list`, its place among the drops that were given.
    pub given: Vec<u32>,
    /// Pixels that each drop may touch: first and last column, first and last row.
    boxes: Vec<[u32; 4]>,
}

impl Rain {
    /// Puts drops on a picture whose eye is `eye` (in f64, so that drops far from the origin keep their places).
    #[must_use]
    pub fn new(
        picture: &RenderFrame,
        eye: DVec3,
        drops: &[FallingDrop],
        masks: &DropMasks,
        options: &RainOptions,
    ) -> Self {
        let capture = CaptureFrame::new(picture, options);
        let mut placed: Vec<(u32, DropsDrop, [u32; 4])> = (0u32..)
            .zip(drops)
            .filter_map(|(k, drop)| {
                let (shown, pixels) = project(picture, eye, drop, masks)?;
                Some((k, shown, pixels))
            })
            .collect();
        // Two drops at one distance go in the order in which they were given.
        placed.sort_by(|a, b| a.1.distance.total_cmp(&b.1.distance).then(a.0.cmp(&b.0)));
        let across = picture.width.div_ceil(DROPS_TILE);
        let count = (across * picture.height.div_ceil(DROPS_TILE)) as usize;
        let touched = |[left, right, top, bottom]: [u32; 4]| {
            (top / DROPS_TILE..=bottom / DROPS_TILE).flat_map(move |row| {
                (left / DROPS_TILE..=right / DROPS_TILE).map(move |column| (row * across + column) as usize)
            })
        };
        let mut tiles = vec![0u32; count + 1];
        for (_, _, pixels) in &placed {
            for tile in touched(*pixels) {
                tiles[tile + 1] += 1;
            }
        }
        let mut first = count as u32 + 1;
        for start in &mut tiles {
            first += *start;
            *start = first;
        }
        let mut next = tiles.clone();
        tiles.resize(first as usize, 0);
        for (index, (_, _, pixels)) in (0u32..).zip(&placed) {
            for tile in touched(*pixels) {
                tiles[next[tile] as usize] = index;
                next[tile] += 1;
            }
        }
        Self {
            frame: DropsFrame::new(picture, &capture, masks, across, &options.veil),
            capture,
            list: placed.iter().map(|p| p.1).collect(),
            given: placed.iter().map(|p| p.0).collect(),
            boxes: placed.iter().map(|p| p.2).collect(),
            tiles,
        }
    }

    /// For each drop that was given and is not hidden altogether by the scene, its place among those given.
    #[must_use]
    pub fn drawn(&self, clean: &[[f32; 4]]) -> Vec<u32> {
        let width = self.frame.width as usize;
        let seen = |drop: &DropsDrop, [left, right, top, bottom]: [u32; 4]| {
            (top as usize..=bottom as usize).any(|row| {
                let row = &clean[row * width..(row + 1) * width];
                row[left as usize..=right as usize].iter().any(|pixel| drop.distance < pixel[3])
            })
        };
        let all = self.list.iter().zip(&self.boxes).zip(&self.given);
        all.filter(|((drop, pixels), _)| seen(drop, **pixels)).map(|(_, &k)| k).collect()
    }
}

/// A drop on the picture, and the pixels that it may touch; `None` where it touches none.
fn project(
    picture: &RenderFrame,
    eye: DVec3,
    drop: &FallingDrop,
    masks: &DropMasks,
) -> Option<(DropsDrop, [u32; 4])> {
    let offset = (drop.position - eye).as_vec3();
    let distance = offset.length();
    let radius = 0.5 * drop.diameter;
    if !(distance > 2.0 * radius && distance.is_finite() && radius > 0.0) {
        return None;
    }
    let towards = offset / distance;
    let cosine = towards.dot(Vec3::from(picture.forward));
    if cosine < 0.05 {
        return None;
    }
    let (right, up) = (Vec3::from(picture.right), Vec3::from(picture.up));
    let (width, height) = (picture.width as f32, picture.height as f32);
    let x = (0.5 + 0.5 * towards.dot(right) / (right.dot(right) * cosine)) * width;
    let y = (0.5 - 0.5 * towards.dot(up) / (up.dot(up) * cosine)) * height;
    let elevation = ops::asin((-towards.y).clamp(-1.0, 1.0));
    let place = masks.place(drop.diameter, elevation);
    let slope = radius / distance;
    // The plane of the picture is farther away, and slanted, away from the middle.
    let pixels = slope / (picture.pixel_angle * cosine);
    let grid = match 2.0 * pixels {
        d if d < SMALL => 0,
        d if d < 2.0 => 8,
        d if d < 16.0 => 4,
        _ => 2,
    };
    let reach = if grid == 0 { 1.0 } else { place.half_extent * pixels / cosine * 1.02 + 1.0 };
    let (left, right) = ((x - reach).floor(), (x + reach).ceil() - 1.0);
    let (top, bottom) = ((y - reach).floor(), (y + reach).ceil() - 1.0);
    if !(right >= 0.0 && left < width && bottom >= 0.0 && top < height) {
        return None;
    }
    let inside = |v: f32, size: f32| v.clamp(0.0, size - 1.0) as u32;
    let shown = DropsDrop {
        towards: towards.into(),
        distance,
        place: [x, y],
        slope,
        half_extent: place.half_extent,
        row: place.row,
        area: place.area * pixels * pixels / cosine,
        grid,
    };
    Some((shown, [inside(left, width), inside(right, width), inside(top, height), inside(bottom, height)]))
}
