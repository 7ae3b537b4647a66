//! Choice of the glints, streaks or lamps of a drop that are kept: the brightest.

use std::f32::consts::PI;

use downpour_atlas::lookup::AtlasSlot;
use downpour_shaders::render::drop_light::{DROP_ATLAS_ROWS, DROP_LIGHT_LAMPS_ROUSSEAU, DROP_LIGHT_REACH};
use glam::{Vec3, Vec4};

use super::{DropLights, drop_light_entry, drop_light_mean};
use crate::light::{Light, light_weight};
use crate::rain::glint::drop_glint_angle;

/// The rows of the faintest of a drop's lights, N rows each, if it is fainter than `fraction`.
fn drop_light_weakest<const N: usize>(rows: &mut [[f32; 4]], fraction: f32) -> Option<&mut [[f32; 4]; N]> {
    let mut least = fraction;
    let mut weakest = None;
    let (lights, _) = rows.as_chunks_mut::<N>();
    for light in lights {
        let kept = light.first().map_or(0.0, |row| light_weight(Vec4::from(*row).truncate()));
        if kept < least {
            least = kept;
            weakest = Some(light);
        }
    }
    weakest
}

/// Keeps a glint of a drop if it is brighter than the least of those that are kept.
pub(super) fn drop_light_keep(rows: &mut [[f32; 4]], glint: Vec4) {
    if let Some(weakest) = drop_light_weakest(rows, light_weight(glint.truncate())) {
        *weakest = [glint.to_array()];
    }
}

/// Keeps a lamp of a drop in the form of Rousseau 2006, two rows, if it is brighter than the least of those that are kept.
pub(super) fn drop_light_keep_facing(rows: &mut [[f32; 4]], light: Vec4, direction: Vec4) {
    if let Some(weakest) = drop_light_weakest(rows, light_weight(light.truncate())) {
        *weakest = [light.to_array(), direction.to_array()];
    }
}

/// Keeps a streak of an atlas, three rows, if it is brighter than the least of those that are kept.
pub(super) fn drop_light_keep_streak(rows: &mut [[f32; 4]], radiance: Vec3, slot: &AtlasSlot) {
    if let Some(weakest) = drop_light_weakest::<{ DROP_ATLAS_ROWS as usize }>(rows, light_weight(radiance)) {
        let [a, b, c] = slot.layers.map(|layer| layer as f32);
        *weakest = [
            radiance.extend(slot.side).to_array(),
            [a, b, c, slot.weights[0]],
            [slot.weights[1], slot.parts[0], slot.parts[1], 0.0],
        ];
    }
}

/// Chord from the middle to the edge of a lamp's disk as a drop sees it: no lamp has less than the sun's.
pub(super) fn drop_light_reach(light: &Light, spread: f32) -> f32 {
    light.chord.max(spread).max(DROP_LIGHT_REACH)
}

impl DropLights<'_> {
    /// Mean radiance of a lamp over a drop's whole disk, from the lamp's irradiance over pi and its direction.
    fn drop_light_whole(&self, lit: Vec3, direction: Vec3, towards: Vec3) -> Vec3 {
        if self.form == DROP_LIGHT_LAMPS_ROUSSEAU {
            return lit * drop_light_mean(towards, direction, self.terms);
        }
        let angle = drop_glint_angle(direction, towards);
        lit * PI * drop_light_entry(self.table, 0, angle).truncate()
    }

    /// Keeps a lamp of a streak if it is brighter than the least of those that are kept; returns what the drop shows on the mean
    /// of the lamp that is not kept. The fourth number of the second row is how bright it is.
    pub(super) fn drop_light_keep_lamp(
        &self,
        rows: &mut [[f32; 4]],
        [first, second]: [Vec4; 2],
        towards: Vec3,
    ) -> Vec3 {
        let (lit, direction) = (first.truncate(), second.truncate());
        let whole = self.drop_light_whole(lit, direction, towards);
        let mut least = light_weight(whole);
        let mut weakest = None;
        for kept in rows.chunks_exact_mut(2) {
            if kept[1][3] < least {
                least = kept[1][3];
                weakest = Some(kept);
            }
        }
        let Some(weakest) = weakest else { return whole };
        let (old, way) = (Vec4::from(weakest[0]), Vec4::from(weakest[1]).truncate());
        let is_rousseau = self.form == DROP_LIGHT_LAMPS_ROUSSEAU;
        let factor = if is_rousseau { 1.0 } else { PI };
        let reach = if is_rousseau { -1.0 } else { first.w };
        weakest.copy_from_slice(&[
            (lit * factor).extend(reach).to_array(),
            direction.extend(light_weight(whole)).to_array(),
        ]);
        if old.w == 0.0 {
            return Vec3::ZERO;
        }
        self.drop_light_whole(old.truncate() / factor, way, towards)
    }
}
