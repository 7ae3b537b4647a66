//! The drops of a picture, with all that the shaders read of it.

use downpour_sim::field::{EyeDrop, FallingDrop};
use glam::{DVec3, Vec2, Vec3};
use rayon::prelude::*;

use super::drops_frame::DropsFrame;
use super::environment::{EnvironmentFrame, EnvironmentMap};
use super::layers::LayersFrame;
use super::light::{DropLightForm, DropLightOptions, DropLights};
use super::medium::{MediumFrame, MediumLight, lamps_of};
use super::profiles::StreakProfiles;
use super::project::{Projected, Projector, project_axis, project_row};
use super::spray::{SprayBlend, SprayFrame, SprayMap, SprayView};
use super::streak::{ScreenDrop, streak_pixels};

use super::{DropMasks, RainOptions, StreakTable};
use crate::RenderError;
use crate::camera::Camera;
use crate::plate::Lighting;

/// A drop that is shown.
struct Shown {
    /// Its place among the drops that were given.
    given: u32,
    drop: ScreenDrop,
    velocity: Vec3,
    row: [f32; 4],
}

/// The drops of one picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Rain {
    /// Constants of the picture that the shader reads.
    pub frame: DropsFrame,
    /// Drops that are not drawn one by one.
    pub medium: MediumFrame,
    /// Layers of a texture in place of drops, without their lamps.
    pub layers: Option<LayersFrame>,
    /// Spray over what the rain hits.
    pub spray: Option<SprayFrame>,
    /// Layout of the environment map.
    pub environment: EnvironmentFrame,
    /// Profiles of moving drops in the streak radiance table.
    pub profiles: StreakProfiles,
    /// The drops on the picture, in the order in which they were given.
    pub list: Vec<ScreenDrop>,
    /// The drops of `list` as lamps light them: place relative to the scene's origin, and radius, m. For an atlas then their
    /// axes and ids.
    pub rows: Vec<[f32; 4]>,
    /// Options of the light of lamps on them.
    light: DropLightOptions,
    /// For each drop of `list`, its place among the drops that were given.
    pub given: Vec<u32>,
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
        let size = camera.size();
        let shown = shown(camera, eye, drops, masks, options);
        let mut list: Vec<ScreenDrop> = shown.iter().map(|shown| shown.drop).collect();
        let mut rows: Vec<[f32; 4]> = shown.iter().map(|shown| shown.row).collect();
        let radii: Vec<f32> = rows.iter().map(|row| row[3]).collect();
        let medium = options.medium.class();
        let profiles = StreakProfiles::new(&mut list, &radii, masks, &options.exposure, medium);
        if options.light.form == DropLightForm::Atlas {
            rows.extend(shown.iter().map(|shown| project_axis(shown.velocity, shown.drop.id)));
        }
        Self {
            frame: DropsFrame::new(camera, &environment, masks, options),
            medium: MediumFrame {
                lit: lamps_of(options.light.form),
                ..MediumFrame::new(&options.medium, eye.as_vec3(), size).with_streaks(
                    &options.medium,
                    camera,
                    &options.exposure,
                )
            },
            layers: LayersFrame::new(camera, options),
            spray: options.spray.and_then(|spray| SprayFrame::new(&spray, &options.medium, eye.as_vec3())),
            environment,
            profiles,
            list,
            rows,
            light: options.light,
            given: shown.iter().map(|shown| shown.given).collect(),
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

    /// Puts spray behind the rain of a picture over a plate (its pixels and environment map) with the light of its streaks; `lights` are those of
    /// [`Rain::lights`]. There is none where no obstacle is.
    pub fn add_spray(
        &self,
        frame: &SprayFrame,
        lights: &DropLights<'_>,
        (clean, environment, table): (&[[f32; 4]], &EnvironmentMap, &StreakTable),
        layer: &mut [[f32; 4]],
    ) {
        if lights.lighting.is_open() {
            return;
        }
        let frame = frame.with_rays(lights.lighting.ray_spacing());
        let map = SprayMap::new(&frame, lights.lighting);
        let mut found = SprayView { frame: &frame, map: &map }.found(&self.frame.camera, &self.medium, clean);
        self.medium_light(lights).light_spray(&mut found);
        self.blend_spray(&frame, &found, (environment, table), layer);
    }

    /// Puts spray that was found and lit before each pixel behind the rain of a picture.
    pub fn blend_spray(
        &self,
        frame: &SprayFrame,
        found: &[[f32; 4]],
        (environment, table): (&EnvironmentMap, &StreakTable),
        layer: &mut [[f32; 4]],
    ) {
        let (drops, medium) = (&self.frame, &self.medium);
        SprayBlend { frame, found, drops, environment, table, medium }.behind(layer);
    }

    /// For each drop that was given and is not hidden altogether by the scene, its place among those given, nearest first.
    #[must_use]
    pub fn drawn(&self, clean: &[[f32; 4]]) -> Vec<u32> {
        let seen = self.list.par_iter().map(|drop| seen(drop, clean, self.frame.camera.size()));
        let seen: Vec<f32> = seen.collect();
        nearest_first(&seen).into_iter().map(|k| self.given[k as usize]).collect()
    }
}

/// The drops that are on a picture.
fn shown(
    camera: &Camera,
    eye: DVec3,
    drops: &[FallingDrop],
    masks: &DropMasks,
    options: &RainOptions,
) -> Vec<Shown> {
    // The tables of a projector are not made for a picture whose drops the device projects.
    if drops.is_empty() {
        return Vec::new();
    }
    let (projector, size) = (Projector::new(camera, masks, options), camera.size());
    let project = |(k, drop): (usize, &FallingDrop)| {
        let placed = EyeDrop::new(drop, eye);
        let Projected { drop, velocity } = projector.project_drop(&placed)?;
        pixels(&drop, size)?;
        Some(Shown { given: k as u32, drop, velocity, row: project_row(camera.eye, &placed) })
    };
    drops.par_iter().enumerate().filter_map(project).collect()
}

/// Distance of a drop, m; 0 where the scene of a picture hides all of it, below 0 where it is not on the picture.
#[must_use]
pub fn seen(drop: &ScreenDrop, clean: &[[f32; 4]], size: [u32; 2]) -> f32 {
    let Some([left, right, top, bottom]) = pixels(drop, size) else { return -1.0 };
    let width = size[0] as usize;
    let is_seen = (top as usize..=bottom as usize).any(|row| {
        let row = &clean[row * width..(row + 1) * width];
        row[left as usize..=right as usize].iter().any(|pixel| drop.nearest < pixel[3])
    });
    if is_seen { drop.nearest } else { 0.0 }
}

/// The places of the distances above 0, in the order of these.
#[must_use]
pub fn nearest_first(distances: &[f32]) -> Vec<u32> {
    let mut all: Vec<(f32, u32)> = distances.iter().copied().zip(0..).filter(|(at, _)| *at > 0.0).collect();
    all.par_sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    all.into_iter().map(|(_, place)| place).collect()
}

/// The pixels that a drop may touch: first and last column, first and last row; `None` where it touches none.
fn pixels(drop: &ScreenDrop, [width, height]: [u32; 2]) -> Option<[u32; 4]> {
    if drop.reach <= 0.0 {
        return None;
    }
    let (from, way) = (Vec2::from(drop.first), Vec2::from(drop.screen_delta));
    let (low, high) = (from.min(from + way) - drop.reach, from.max(from + way) + drop.reach);
    let [left, right] = streak_pixels(low.x, high.x, width)?;
    let [top, bottom] = streak_pixels(low.y, high.y, height)?;
    Some([left, right, top, bottom])
}
