//! The drops of a picture, nearest first, and for each tile of the picture those that touch it.

use downpour_shaders::render::rain::DROPS_TILE;
use downpour_sim::field::FallingDrop;
use glam::{DVec3, Vec2};
use rayon::prelude::*;

use super::drops_frame::DropsFrame;
use super::environment::EnvironmentFrame;
use super::light::{DropLightForm, DropLightOptions, DropLights, drop_light_axes, drop_light_rows};
use super::medium::{MediumFrame, MediumLight, lamps_of};
use super::profiles::StreakProfiles;
use super::project::{Projected, project};
use super::streak::DropsDrop;
use super::{DropMasks, RainOptions, shapes};
use crate::RenderError;
use crate::camera::Camera;
use crate::plate::Lighting;

/// The drops of one picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Rain {
    /// Constants of the picture that the shader reads.
    pub frame: DropsFrame,
    /// Drops that are not drawn one by one.
    pub medium: MediumFrame,
    /// Layout of the environment map.
    pub environment: EnvironmentFrame,
    /// Profiles of moving drops in the streak radiance table.
    pub profiles: StreakProfiles,
    /// The drops on the picture, nearest first.
    pub list: Vec<DropsDrop>,
    /// Index of the beginning of each tile's list (one more than there are tiles), then the lists.
    pub tiles: Vec<u32>,
    /// The drops of `list` as lamps light them: place relative to the scene's origin, and radius, m. For an atlas then their
    /// axes and ids.
    pub rows: Vec<[f32; 4]>,
    /// Options of the light of lamps on them.
    light: DropLightOptions,
    /// For each drop of `list`, its place among the drops that were given.
    pub given: Vec<u32>,
    /// Pixels that each drop may touch: first and last column, first and last row.
    boxes: Vec<[u32; 4]>,
}

impl Rain {
    /// Puts drops on a picture whose eye is `eye` (in f64, so that drops far from the origin keep their places).
    #[must_use]
    pub fn new(
        camera: &Camera,
        eye: DVec3,
        drops: &[FallingDrop],
        masks: &DropMasks,
        options: &RainOptions,
    ) -> Self {
        let environment = EnvironmentFrame::new(camera, options);
        let [width, height] = camera.size();
        let mut placed: Vec<(u32, Projected)> = drops
            .par_iter()
            .enumerate()
            .filter_map(|(k, drop)| Some((k as u32, project(camera, eye, drop, masks, &options.exposure)?)))
            .filter(|(_, shown)| pixels(shown, width, height).is_some())
            .collect();
        // Two drops at one distance go in the order in which they were given, so that the order is the same for any number of
        // threads.
        placed.par_sort_unstable_by(|a, b| a.1.drop.nearest.total_cmp(&b.1.drop.nearest).then(a.0.cmp(&b.0)));
        let medium = options.medium.row().map(shapes::of_row);
        let profiles = StreakProfiles::new(&mut placed, drops, masks, &options.exposure, medium);
        let across = width.div_ceil(DROPS_TILE);
        let count = (across * height.div_ceil(DROPS_TILE)) as usize;
        let touched = |shown: &Projected| tiles_of(*shown, width, height);
        let mut tiles = vec![0u32; count + 1];
        for (_, shown) in &placed {
            for tile in touched(shown) {
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
        for (index, (_, shown)) in (0u32..).zip(&placed) {
            for tile in touched(shown) {
                tiles[next[tile] as usize] = index;
                next[tile] += 1;
            }
        }
        let given = || placed.iter().filter_map(|p| Some((drops.get(p.0 as usize)?, p.1.velocity)));
        let mut rows = drop_light_rows(given().map(|(drop, _)| drop));
        if options.light.form == DropLightForm::Atlas {
            rows.extend(drop_light_axes(given()));
        }
        Self {
            frame: DropsFrame::new(camera, &environment, masks, across, options),
            medium: MediumFrame {
                lit: lamps_of(options.light.form),
                ..MediumFrame::new(&options.medium, eye.as_vec3(), [width, height])
            },
            environment,
            profiles,
            list: placed.iter().map(|p| p.1.drop).collect(),
            rows,
            light: options.light,
            given: placed.iter().map(|p| p.0).collect(),
            boxes: placed.iter().filter_map(|p| pixels(&p.1, width, height)).collect(),
            tiles,
        }
    }

    /// The lamps of a plate on these drops.
    ///
    /// # Errors
    /// As [`DropLights::new`].
    pub fn lights<'a>(
        &'a self,
        lighting: &'a dyn Lighting,
        masks: &'a DropMasks,
    ) -> Result<DropLights<'a>, RenderError> {
        DropLights::new(lighting, self.frame.camera.eye, &masks.light, self.light)
    }

    /// The lamps of a plate on the streaks that have profiles, lamp by lamp.
    ///
    /// # Errors
    /// As [`DropLights::new`].
    pub fn streak_lights<'a>(
        &'a self,
        lighting: &'a dyn Lighting,
        masks: &'a DropMasks,
    ) -> Result<DropLights<'a>, RenderError> {
        DropLights::of_streaks(lighting, self.frame.camera.eye, &masks.light, self.light)
    }

    /// The streaks that have profiles, as lamps light them.
    #[must_use]
    pub fn streak_rows(&self) -> Vec<[f32; 4]> {
        self.profiles.paths.iter().map(|path| self.rows[path.drop as usize]).collect()
    }

    /// The drops that are not drawn one by one, before a plate; `lights` are those of [`Rain::lights`].
    #[must_use]
    pub fn medium_light<'a>(&self, lights: &DropLights<'a>) -> MediumLight<'a> {
        MediumLight::new(&self.medium, &self.frame.camera, lights, self.light.form)
    }

    /// For each drop that was given and is not hidden altogether by the scene, its place among those given.
    #[must_use]
    pub fn drawn(&self, clean: &[[f32; 4]]) -> Vec<u32> {
        let width = self.frame.camera.width as usize;
        let seen = |drop: &DropsDrop, [left, right, top, bottom]: [u32; 4]| {
            (top as usize..=bottom as usize).any(|row| {
                let row = &clean[row * width..(row + 1) * width];
                row[left as usize..=right as usize].iter().any(|pixel| drop.nearest < pixel[3])
            })
        };
        let all = self.list.iter().zip(&self.boxes).zip(&self.given);
        all.filter(|((drop, pixels), _)| seen(drop, **pixels)).map(|(_, &k)| k).collect()
    }
}

/// Columns and rows from the first to the last that lie within a range; `None` if none does.
fn within(low: f32, high: f32, count: u32) -> Option<[u32; 2]> {
    let (first, last) = (low.floor(), high.ceil() - 1.0);
    // The comparison is false for what is no number.
    (last >= 0.0 && first < count as f32 && first <= last)
        .then(|| [first, last].map(|v| v.clamp(0.0, count as f32 - 1.0) as u32))
}

/// The pixels that a drop may touch: first and last column, first and last row.
fn pixels(shown: &Projected, width: u32, height: u32) -> Option<[u32; 4]> {
    let (from, reach) = (Vec2::from(shown.drop.first), shown.reach);
    let to = from + Vec2::from(shown.drop.way);
    let (low, high) = (from.min(to) - reach, from.max(to) + reach);
    let [left, right] = within(low.x, high.x, width)?;
    let [top, bottom] = within(low.y, high.y, height)?;
    Some([left, right, top, bottom])
}

/// The tiles that a drop may touch: row by row those that its path passes there.
fn tiles_of(shown: Projected, width: u32, height: u32) -> impl Iterator<Item = usize> {
    let across = width.div_ceil(DROPS_TILE);
    let (from, way, reach) = (Vec2::from(shown.drop.first), Vec2::from(shown.drop.way), shown.reach);
    let box_of = pixels(&shown, width, height);
    let rows = box_of.map_or(0..0, |[_, _, top, bottom]| top / DROPS_TILE..bottom / DROPS_TILE + 1);
    rows.flat_map(move |row| {
        let top = (row * DROPS_TILE) as f32 - reach;
        let bottom = ((row + 1) * DROPS_TILE) as f32 + reach;
        // The part of the path that is as high as this row.
        let (mut low, mut high) = (0.0f32, 1.0f32);
        if way.y.abs() > 1.0e-3 {
            let (a, b) = ((top - from.y) / way.y, (bottom - from.y) / way.y);
            (low, high) = (low.max(a.min(b)), high.min(a.max(b)));
        }
        let (a, b) = (from.x + way.x * low, from.x + way.x * high);
        let columns = if low <= high { within(a.min(b) - reach, a.max(b) + reach, width) } else { None };
        let columns = columns.map_or(0..0, |[left, right]| left / DROPS_TILE..right / DROPS_TILE + 1);
        columns.map(move |column| (row * across + column) as usize)
    })
}
