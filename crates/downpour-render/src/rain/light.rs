//! Light of lamps and sun on falling drops. Twin of `shaders/wgsl/render/drop_light.wgsl`.
//!
//! A drop shows what is behind and around it through its mask; a lamp is far smaller than a texel of that. Here is what
//! lamps add: for each drop the mean radiance over its disk, and where on the disk its brightest glints stand. Each lamp
//! is looked up at the drop's own position (distance, cone, range), with one ray for what stands between.
//!
//! Law of the default form: a drop of radius a in an irradiance E sends E pi a^2 phase(theta) per steradian toward the
//! eye ([`SphereScattering`](downpour_drop::optics::SphereScattering)); seen as a disk of pi a^2, its mean radiance is
//! L = E phase(theta). The drop is a sphere: a flattened one has its bows elsewhere, but nearly the same mean.
//!
//! With the form [`DropLightForm::Atlas`] the drop's light is that of a streak atlas ([`downpour_atlas`], where its amount is
//! compared with that of a sphere): traced with the
//! shape and the oscillation of a falling drop, bright and dark along its path.
//!
//! - [`DropLightForm`], [`DropLightOptions`]: what is asked for;
//! - [`DropLightTable`]: the scattering of water for red, green and blue;
//! - [`DropLights`]: the lamps of a scene, on drops.

mod atlas;
mod keep;
mod table;

use downpour_math::{OutOfRange, in_range};
use std::f32::consts::PI;

use downpour_math::ops;
use downpour_shaders::render::drop_light::{
    DROP_ATLAS_ROWS, DROP_GLINT_TINY, DROP_LIGHT_ATLAS, DROP_LIGHT_ENTRIES, DROP_LIGHT_EXTERNAL,
    DROP_LIGHT_GLINTS, DROP_LIGHT_IM_SUNG, DROP_LIGHT_INTERNAL, DROP_LIGHT_LAMPS, DROP_LIGHT_LAMPS_ROUSSEAU,
    DROP_LIGHT_LAMPS_TRACED, DROP_LIGHT_NONE, DROP_LIGHT_PATHS, DROP_LIGHT_POINTS, DROP_LIGHT_RINGS,
    DROP_LIGHT_ROUSSEAU, DROP_LIGHT_TRACED,
};
use downpour_shaders::render::rain::STREAK_LAMPS;
use downpour_shaders::render::scene::SCENE_FAR;
use downpour_sim::field::FallingDrop;
use downpour_weather::{RainDropLight, StreakLook, Weather};
use glam::{Vec2, Vec3, Vec4};
use rayon::prelude::*;

use super::GLINTS;
use super::glint::{
    drop_glint_angle, drop_glint_pack, drop_glint_right, drop_glint_rousseau, drop_glint_side,
    drop_glint_sine,
};
use crate::RenderError;
use crate::light::{Light, check_lights, light_weight};
use crate::plate::Lighting;

use atlas::drop_atlas_slot;
use keep::{drop_light_keep, drop_light_keep_facing, drop_light_keep_streak, drop_light_reach};
pub use table::DropLightTable;

/// Model of the light of lamps on a drop.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum DropLightForm {
    /// Geometric optics of a sphere of water: Fresnel's equations, orders 0 to 3, with colored rainbows.
    #[default]
    Traced = DROP_LIGHT_TRACED,
    /// Rousseau 2006, section 6: `C_L DistFact (V_PE . V_N) (A_2 + A_3)`, as printed, without exponents, at each pixel by the
    /// drop's normal there; a drop below a pixel shows the mean over its disk, a streak the mean over what passes. `C_L DistFact`
    /// is taken as the irradiance over pi at the drop: what a white surface shows.
    Rousseau2006 = DROP_LIGHT_ROUSSEAU,
    /// [`DropLightForm::Rousseau2006`], external reflection only: `A_1 A_2`.
    Rousseau2006External = DROP_LIGHT_ROUSSEAU | DROP_LIGHT_EXTERNAL << 8,
    /// [`DropLightForm::Rousseau2006`], internal reflection only: `A_1 A_3`.
    Rousseau2006Internal = DROP_LIGHT_ROUSSEAU | DROP_LIGHT_INTERNAL << 8,
    /// Im & Sung 2022, equations (7) to (10): drops in a spot's cone have the light's color, others nothing; point lights
    /// and parallel ones are left out. The cone is as high as the lamp's range. Here its edge is soft, from the inner
    /// cone to the outer, and the intensity falls with the distance (their light has one intensity everywhere).
    ImSung2022 = DROP_LIGHT_IM_SUNG,
    /// The streaks of an atlas, by the directions of lamp and viewer, by elevation and diameter, or at random: for drops
    /// that move. One that stands still shows the mean of its streak.
    Atlas = DROP_LIGHT_ATLAS,
    /// No light.
    None = DROP_LIGHT_NONE,
}

impl DropLightForm {
    /// The form as the shaders know it.
    fn number(self) -> u32 {
        match self {
            Self::Rousseau2006External | Self::Rousseau2006Internal => DROP_LIGHT_ROUSSEAU,
            other => other as u32,
        }
    }

    /// The terms of the formula of Rousseau 2006 that it has, as bits; of other forms none are asked.
    pub(crate) fn terms(self) -> u32 {
        match self {
            Self::Rousseau2006External => DROP_LIGHT_EXTERNAL,
            Self::Rousseau2006Internal => DROP_LIGHT_INTERNAL,
            _ => DROP_LIGHT_EXTERNAL | DROP_LIGHT_INTERNAL,
        }
    }
}

impl From<RainDropLight> for DropLightForm {
    fn from(form: RainDropLight) -> Self {
        match form {
            RainDropLight::Rousseau2006 => Self::Rousseau2006,
            RainDropLight::Rousseau2006External => Self::Rousseau2006External,
            RainDropLight::Rousseau2006Internal => Self::Rousseau2006Internal,
            RainDropLight::ImSung2022 => Self::ImSung2022,
            RainDropLight::None => Self::None,
            _ => Self::Traced,
        }
    }
}

/// Options of the light on drops.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DropLightOptions {
    /// Model of the light of lamps on a drop.
    pub form: DropLightForm,
    /// Rows of light of each drop besides its mean, 0 to 16: in the traced form its brightest glints; in that of Rousseau 2006
    /// its brightest lamps, two rows each; of an atlas its brightest streaks, three rows each. The other forms have none.
    pub glints: u32,
}

impl DropLightOptions {
    /// Light of an atlas, with four streaks per drop.
    pub const ATLAS: Self = Self { form: DropLightForm::Atlas, glints: 4 * DROP_ATLAS_ROWS };

    /// Options of a weather: its `drop_light`, traced light by the streaks of an atlas if its streaks are of one.
    #[must_use]
    pub fn of_weather(weather: &Weather) -> Self {
        let form = weather.rain.drop_light.into();
        let of_atlas = matches!(weather.streaks.look, StreakLook::Atlas | StreakLook::AtlasRandom);
        if of_atlas && form == DropLightForm::Traced {
            return Self::ATLAS;
        }
        // A lamp of Rousseau 2006 has two rows.
        Self { form, glints: if form.number() == DROP_LIGHT_ROUSSEAU { 2 * GLINTS } else { GLINTS } }
    }
}

/// Constants of a dispatch. The same layout as `DropLightFrame` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct DropLightFrame {
    /// Form of the light, a [`DropLightForm`].
    pub form: u32,
    /// Number of drops.
    pub count: u32,
    /// Rows kept for each drop besides its mean.
    pub glints: u32,
    /// First lamp of the dispatch.
    pub first_light: u32,
    /// Terms of the formula of Rousseau 2006.
    pub terms: u32,
}

/// A position on a drop's disk where light of a lamp leaves it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DropGlint {
    /// Index of the lamp in the scene.
    pub light: u32,
    /// Internal reflections plus 1; 0: reflected at the outside.
    pub order: u32,
    /// Position on the disk, radii along the right ([`drop_glint_right`]) and the up of the view.
    pub position: Vec2,
    /// Radius of the lamp's image there, in radii: of the disk that has its area.
    pub image: f32,
    /// Its part of the mean radiance over the disk: a glint that covers a fraction s of the disk is 1/s times as bright.
    pub radiance: Vec3,
}

/// Light of a plate's lamps on drops.
#[derive(Clone, Copy, Debug)]
pub struct DropLights<'a> {
    pub(crate) lighting: &'a dyn Lighting,
    eye: Vec3,
    pub(crate) table: &'a DropLightTable,
    /// [`DropLightForm`], or what keeps lamps for streaks.
    form: u32,
    /// Terms of the formula of Rousseau 2006.
    terms: u32,
    glints: u32,
}

/// Rows of drops for [`DropLights::light`]: position relative to the scene's origin, and radius, meters.
#[must_use]
pub fn drop_light_rows<'a>(drops: impl IntoIterator<Item = &'a FallingDrop>) -> Vec<[f32; 4]> {
    let row = |drop: &FallingDrop| drop.position.as_vec3().extend(0.5 * drop.diameter).to_array();
    drops.into_iter().map(row).collect()
}

impl<'a> DropLights<'a> {
    /// The lamps of a plate, seen from an eye.
    ///
    /// # Errors
    /// [`RenderError::Light`] if a lamp's color is not finite, or negative; [`RenderError::OutOfRange`] above 16 glints, or for
    /// the form of an atlas if the table has none.
    pub fn new(
        lighting: &'a dyn Lighting,
        eye: Vec3,
        table: &'a DropLightTable,
        options: DropLightOptions,
    ) -> Result<Self, RenderError> {
        check_lights(lighting)?;
        in_range("number of glints of a drop", options.glints, "", &(0..=DROP_LIGHT_GLINTS), 1.0, "0 to 16")?;
        if options.form == DropLightForm::Atlas && !table.has_atlas() {
            return Err(RenderError::OutOfRange(OutOfRange {
                quantity: "number of streak atlases",
                found: 0.0,
                unit: "",
                allowed: "1 (DropMasks::with_atlas)".into(),
            }));
        }
        let DropLightOptions { form, glints } = options;
        Ok(Self { lighting, eye, table, form: form.number(), terms: form.terms(), glints })
    }

    /// The lamps of a plate as the profiles of streaks want them: of each drop the brightest ones, two rows each (its irradiance,
    /// and the chord from the middle to the edge of its disk; its direction), the others in the mean. In the form of
    /// [`DropLightForm::Rousseau2006`] the irradiance is that over pi, and the chord is below 0. Other forms have no more than
    /// their mean; an atlas adds its streaks elsewhere.
    ///
    /// # Errors
    /// As [`DropLights::new`].
    pub fn of_streaks(
        lighting: &'a dyn Lighting,
        eye: Vec3,
        table: &'a DropLightTable,
        options: DropLightOptions,
    ) -> Result<Self, RenderError> {
        let form = match options.form {
            DropLightForm::Traced => DROP_LIGHT_LAMPS_TRACED,
            DropLightForm::Rousseau2006
            | DropLightForm::Rousseau2006External
            | DropLightForm::Rousseau2006Internal => DROP_LIGHT_LAMPS_ROUSSEAU,
            DropLightForm::ImSung2022 => DROP_LIGHT_IM_SUNG,
            DropLightForm::Atlas | DropLightForm::None => DROP_LIGHT_NONE,
        };
        Ok(Self { form, glints: 2 * STREAK_LAMPS, ..Self::new(lighting, eye, table, options)? })
    }

    /// Number of rows of a drop in [`DropLights::light`]: its mean and its glints.
    #[must_use]
    pub fn stride(&self) -> usize {
        1 + self.glints as usize
    }

    /// Returns the dispatches for `count` drops, each with a part of the lamps.
    #[must_use]
    pub fn frames(&self, count: u32) -> Vec<DropLightFrame> {
        let (form, glints, terms) = (self.form, self.glints, self.terms);
        let frame = |first_light| DropLightFrame { count, form, glints, first_light, terms };
        let lights = if form == DROP_LIGHT_NONE { 1 } else { self.lighting.light_count().max(1) };
        (0..lights).step_by(DROP_LIGHT_LAMPS as usize).map(frame).collect()
    }

    /// Number of drops in the rows: those of an atlas have two each.
    pub(crate) fn count(&self, rows: &[[f32; 4]]) -> usize {
        if self.form == DROP_LIGHT_ATLAS { rows.len() / 2 } else { rows.len() }
    }

    /// The light on drops ([`drop_light_rows`]; for an atlas then a row for each drop with its axis, against its motion,
    /// and its id below 2^24), in parallel; the same bits for any number of threads. For each drop [`DropLights::stride`]
    /// rows: the mean radiance over its disk and 0; then its brightest glints in no order, their part of the mean, and their
    /// position ([`drop_glint_unpack`](super::glint::drop_glint_unpack)) and image
    /// ([`drop_glint_image`](super::glint::drop_glint_image)), 0 where there are no more. Of an atlas: its
    /// streaks, three rows each as in the shader.
    #[must_use]
    pub fn light(&self, drops: &[[f32; 4]]) -> Vec<[f32; 4]> {
        let (drops, about) = drops.split_at(self.count(drops));
        let mut out = vec![[0.0; 4]; drops.len() * self.stride()];
        out.par_chunks_mut(self.stride()).zip(drops).enumerate().for_each(|(index, (slot, drop))| {
            self.drop_light_of(drop, about.get(index).copied().unwrap_or_default(), slot);
        });
        out
    }

    /// Returns all glints of a drop in the traced form, by lamp and light path, without dark ones. Their
    /// sum is the mean radiance, up to the table's rounding.
    #[must_use]
    pub fn glints(&self, drop: [f32; 4]) -> Vec<DropGlint> {
        let (position, least) = (Vec4::from(drop).truncate(), drop[3]);
        let (towards, right, up) = self.facing(position);
        let mut all = Vec::new();
        for k in 0..self.lighting.light_count() {
            let lamp = self.lighting.light(k);
            let light = lamp.light_sample(position, least);
            let visible = self.lighting.visibility(position, light.direction, light.distance);
            let irradiance = light.irradiance * visible * PI;
            let angle = drop_glint_angle(light.direction, towards);
            let side = drop_glint_side(light.direction, right, up);
            let sine = drop_glint_sine(light.direction, towards);
            let reach = drop_light_reach(&lamp, light.spread);
            for (path, order) in (1..=DROP_LIGHT_PATHS).zip([0, 1, 2, 2, 3, 3]) {
                let entry = drop_light_entry(self.table, path, angle);
                let radiance = irradiance * entry.truncate();
                if light_weight(radiance) > 0.0 {
                    let image = drop_light_image(self.table, path, [angle, sine], entry.w, reach);
                    all.push(DropGlint { light: k, order, position: side * entry.w, image, radiance });
                }
            }
        }
        all
    }

    /// Direction of a position from the eye, and right and up of its view.
    fn facing(&self, position: Vec3) -> (Vec3, Vec3, Vec3) {
        let offset = position - self.eye;
        let towards = offset / offset.dot(offset).max(DROP_GLINT_TINY).sqrt();
        let right = drop_glint_right(towards);
        (towards, right, right.cross(towards))
    }

    /// Im & Sung 2022, equations (7) to (10): irradiance over pi at a position in a spot's cone, which is a pile of circles.
    /// Full light within the inner cone; between the two cones it fades. Zero for other lamps.
    fn drop_light_cone(light: &Light, position: Vec3, least: f32) -> Vec3 {
        let (axis, [scale, edge]) = (light.axis, light.cone);
        if light.is_parallel() || scale <= 0.0 {
            return Vec3::ZERO;
        }
        let offset = position - light.position;
        let below = offset.dot(axis);
        let height = if light.range > 0.0 { light.range } else { SCENE_FAR };
        if below <= 0.0 || below > height {
            return Vec3::ZERO;
        }
        let outer = (-edge / scale).clamp(1.0e-3, 1.0);
        let inner = ((1.0 - edge) / scale).clamp(outer, 1.0);
        let circle = below * (1.0 - outer * outer).max(0.0).sqrt() / outer;
        let core = below * (1.0 - inner * inner).max(0.0).sqrt() / inner;
        let aside = offset - axis * below;
        let away = aside.dot(aside).sqrt();
        let fraction = ((circle - away) / (circle - core).max(1.0e-6 * below)).clamp(0.0, 1.0);
        let square = offset.dot(offset).max((least * least).max(1.0e-8));
        light.color * (fraction / square)
    }

    /// The light on a drop: its mean, then its glints.
    fn drop_light_of(&self, drop: &[f32; 4], about: [f32; 4], slot: &mut [[f32; 4]]) {
        let Some((mean, glints)) = slot.split_first_mut() else { return };
        let (position, radius) = (Vec4::from(*drop).truncate(), drop[3]);
        // An empty place in the list.
        if radius <= 0.0 {
            return;
        }
        let mut sum = Vec3::ZERO;
        let (towards, right, up) = self.facing(position);
        let form = self.form;
        let count = if form == DROP_LIGHT_NONE { 0 } else { self.lighting.light_count() };
        for k in 0..count {
            let lamp = self.lighting.light(k);
            let light = lamp.light_sample(position, radius);
            let mut lit = light.irradiance;
            if form == DROP_LIGHT_IM_SUNG {
                lit = Self::drop_light_cone(&lamp, position, radius);
            }
            if light_weight(lit) <= 0.0 {
                continue;
            }
            lit *= self.lighting.visibility(position, light.direction, light.distance);
            let reach = drop_light_reach(&lamp, light.spread);
            match form {
                DROP_LIGHT_IM_SUNG => sum += lit,
                DROP_LIGHT_LAMPS_TRACED | DROP_LIGHT_LAMPS_ROUSSEAU => {
                    let rows = [lit.extend(reach), light.direction.extend(0.0)];
                    sum += self.drop_light_keep_lamp(glints, rows, towards);
                }
                DROP_LIGHT_ROUSSEAU => {
                    let mean = drop_light_mean(towards, light.direction, self.terms);
                    sum += lit * mean;
                    drop_light_keep_facing(glints, lit.extend(-1.0 - mean), light.direction.extend(0.0));
                }
                DROP_LIGHT_ATLAS => {
                    let (axis, id) = (Vec4::from(about).truncate(), about[3] as u32);
                    let diameter = 2.0 * radius;
                    let streak = drop_atlas_slot(self.table, id, diameter, axis, light.direction, -towards);
                    let radiance = lit * (PI * streak.amount);
                    sum += radiance;
                    drop_light_keep_streak(glints, radiance, &streak);
                }
                _ => {
                    let angle = drop_glint_angle(light.direction, towards);
                    let side = drop_glint_side(light.direction, right, up);
                    let sine = drop_glint_sine(light.direction, towards);
                    let irradiance = lit * PI;
                    sum += irradiance * drop_light_entry(self.table, 0, angle).truncate();
                    for path in 1..=DROP_LIGHT_PATHS {
                        let entry = drop_light_entry(self.table, path, angle);
                        let radiance = irradiance * entry.truncate();
                        let image = drop_light_image(self.table, path, [angle, sine], entry.w, reach);
                        drop_light_keep(glints, radiance.extend(drop_glint_pack(side * entry.w, image)));
                    }
                }
            }
        }
        *mean = sum.extend(0.0).to_array();
    }
}

/// A row of the table at a scattering angle over pi: linear between the middles of the intervals.
fn drop_light_entry(table: &DropLightTable, row: u32, angle: f32) -> Vec4 {
    let last = DROP_LIGHT_ENTRIES - 1;
    let position = (angle * DROP_LIGHT_ENTRIES as f32 - 0.5).clamp(0.0, last as f32);
    let low = position as u32;
    let part = position - low as f32;
    let first = row * DROP_LIGHT_ENTRIES;
    let at = |k: u32| table.rows().get((first + k) as usize).map_or(Vec4::ZERO, |&row| Vec4::from(row));
    let here = at(low);
    here + (at((low + 1).min(last)) - here) * part
}

/// Radius of the image of a lamp on a drop's disk, in radii of the drop: of the disk that has its area. Law: a lamp whose rays leave the
/// drop at `position` from the axis is an ellipse there: along the side of the lamp as large as its disk times the change of the
/// position with the scattering angle, around the axis as large as its disk times the position over the angle's sine.
fn drop_light_image(
    table: &DropLightTable,
    path: u32,
    [angle, sine]: [f32; 2],
    position: f32,
    reach: f32,
) -> f32 {
    let step = 1.0 / DROP_LIGHT_ENTRIES as f32;
    let change =
        drop_light_entry(table, path, angle + step).w - drop_light_entry(table, path, angle - step).w;
    let along = change.abs() / (2.0 * PI * step);
    let around = position.abs() / sine.max(step);
    (reach * (along * around).sqrt()).min(1.0)
}

/// The mean over a drop's disk of what Rousseau's formula gives at its pixels.
#[must_use]
pub fn drop_light_mean(towards: Vec3, light: Vec3, terms: u32) -> f32 {
    let right = drop_glint_right(towards);
    let up = right.cross(towards);
    let mut sum = 0.0;
    for k in 0..DROP_LIGHT_RINGS * DROP_LIGHT_POINTS {
        let square = ((k / DROP_LIGHT_POINTS) as f32 + 0.5) / DROP_LIGHT_RINGS as f32;
        let angle = 2.0 * PI * ((k % DROP_LIGHT_POINTS) as f32 + 0.5) / DROP_LIGHT_POINTS as f32;
        let away = square.sqrt();
        let normal = right * (away * ops::cos(angle)) + up * (away * ops::sin(angle))
            - towards * (1.0 - square).sqrt();
        sum += drop_glint_rousseau(normal, -towards, light, terms);
    }
    sum / (DROP_LIGHT_RINGS * DROP_LIGHT_POINTS) as f32
}
