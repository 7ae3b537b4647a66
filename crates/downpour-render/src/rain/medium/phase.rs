//! Phase functions of drops and fog. Twin of `shaders/wgsl/render/medium_phase.wgsl`.

use std::f32::consts::PI;

use downpour_math::ops;
use downpour_shaders::render::drop_light::DROP_LIGHT_ENTRIES;
use downpour_shaders::render::medium::MEDIUM_ANGLES;
use glam::{Vec3, Vec4};

use super::fog::phase_integral;
use crate::rain::light::{DropLightForm, DropLightTable, drop_light_mean};

const _: () = assert!(MEDIUM_ANGLES == DROP_LIGHT_ENTRIES);

/// Integral of a drop's phase function over the scattering angle: row k up to the angle k pi / 256.
///
/// [`DropLightForm::Rousseau2006`] depends on the vertical, too; lamps are taken to be as high as the eye.
pub(super) fn phase_table(form: DropLightForm, table: &DropLightTable, asymmetry: f64) -> Vec<[f32; 4]> {
    let width = std::f64::consts::PI / f64::from(MEDIUM_ANGLES);
    let mut sum = [0.0f64; 3];
    let mut fog = 0.0;
    let mut rows = vec![[0.0; 4]];
    for (k, row) in (0..MEDIUM_ANGLES).zip(table.rows()) {
        let of_formula = |value: f32| [f64::from(value); 3];
        let values = match form {
            DropLightForm::Traced | DropLightForm::Atlas => std::array::from_fn(|c| f64::from(row[c])),
            DropLightForm::Rousseau2006
            | DropLightForm::Rousseau2006External
            | DropLightForm::Rousseau2006Internal => {
                let angle = (k as f32 + 0.5) * (PI / MEDIUM_ANGLES as f32);
                let light = Vec3::new(ops::sin(angle), 0.0, -ops::cos(angle));
                of_formula(drop_light_mean(Vec3::NEG_Z, light, form.terms()) / PI)
            }
            DropLightForm::ImSung2022 => of_formula(1.0 / PI),
            DropLightForm::None => of_formula(0.0),
        };
        for (sum, value) in sum.iter_mut().zip(values) {
            *sum += value * width;
        }
        fog += phase_integral(asymmetry, k);
        let [r, g, b] = sum.map(|sum| sum as f32);
        rows.push([r, g, b, fog as f32]);
    }
    rows
}

/// The integral of the phase functions of a table up to an angle.
pub(in crate::rain) fn medium_phase_within(table: &[[f32; 4]], angle: f32) -> Vec4 {
    let position = (angle * (MEDIUM_ANGLES as f32 / PI)).clamp(0.0, MEDIUM_ANGLES as f32);
    let low = (position as u32).min(MEDIUM_ANGLES - 1);
    let part = position - low as f32;
    let at = |k: u32| Vec4::from(table[k as usize]);
    at(low) * (1.0 - part) + at(low + 1) * part
}

/// The phase functions of a table at an angle: their mean over half an interval of it to each side.
pub(in crate::rain) fn medium_phase_at(table: &[[f32; 4]], angle: f32) -> Vec4 {
    let width = PI / MEDIUM_ANGLES as f32;
    let low = (angle - 0.5 * width).max(0.0);
    let high = (angle + 0.5 * width).min(PI);
    (medium_phase_within(table, high) - medium_phase_within(table, low)) / (high - low)
}
