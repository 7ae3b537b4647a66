//! The water that a blade has pushed together, as a smooth ridge.
//!
//! The lattice has it cell by cell in a line that is as ragged as its cells. A piece of the ridge is drawn for each of them, where the
//! water of the neighboring cells has its middle across the ridge, as wide as a ridge with the mean of their water is.

use downpour_lattice::glass::motion::glass_motion_unpack;
use downpour_lattice::glass::ridge::glass_ridge_is;
use downpour_lattice::glass::{Glass, GlassOptions, GlassState, GlassWiper};
use downpour_math::ops::f64 as ops;
use glam::{DVec2, IVec2};

use super::water::GlassPictureDrop;

/// Standard deviation of the means along the ridge, cells.
const SMOOTH: f64 = 5.0;

/// Cells along the ridge that count.
const ALONG: i32 = 13;

/// Cells across it.
const ACROSS: f64 = 4.0;

/// Half of the length of a piece, cells: pieces overlap.
const HALF: f64 = 1.0;

/// Thinnest ridge that is drawn, m.
const MIN_HALF_WIDTH_M: f64 = 2.0e-5;

/// Largest slope of the half-width along a ridge.
const MAX_TAPER: f64 = 0.3;

/// Water per cell of the length, in units, and its middle, cells ahead of a cell of a ridge, `aside` cells along the ridge from there.
fn around(options: &GlassOptions, state: &GlassState, cell: IVec2, ahead: DVec2, aside: f64) -> [f64; 2] {
    let size = IVec2::new(options.size[0] as i32, options.size[1] as i32);
    let (mut water, mut moment) = (0.0, 0.0);
    for y in -ALONG..=ALONG {
        for x in -ALONG..=ALONG {
            let (off, to) = (IVec2::new(x, y).as_dvec2(), cell + IVec2::new(x, y));
            let (along, across) = (off.dot(ahead.perp()) - aside, off.dot(ahead));
            if along.abs() > f64::from(ALONG) || across.abs() > ACROSS {
                continue;
            }
            if to.cmplt(IVec2::ZERO).any() || to.cmpge(size).any() {
                continue;
            }
            let index = (to.y * size.x + to.x) as usize;
            let (Some(&mass), Some(&[velocity, progress])) = (state.mass.get(index), state.motion.get(index))
            else {
                continue;
            };
            let other = glass_motion_unpack(velocity).as_dvec2().normalize_or_zero();
            if mass == 0 || !glass_ridge_is(progress) || other.dot(ahead) < 0.7 {
                continue;
            }
            let weight = ops::exp(-0.5 * along * along / (SMOOTH * SMOOTH)) * f64::from(mass);
            water += weight;
            moment += weight * across;
        }
    }
    // The weights of a line of cells sum to this.
    let unit = SMOOTH * (2.0 * std::f64::consts::PI).sqrt();
    [water / unit, moment / water.max(1.0e-9)]
}

/// The piece of a ridge at a cell of it; `None` if there is next to no water.
pub(super) fn ridge_piece(
    options: &GlassOptions,
    state: &GlassState,
    index: u32,
) -> Option<GlassPictureDrop> {
    let [columns, _] = options.size;
    let cell = IVec2::new((index % columns) as i32, (index / columns) as i32);
    let &[velocity, _] = state.motion.get(index as usize)?;
    let ahead = glass_motion_unpack(velocity).as_dvec2().normalize_or_zero();
    let section = |aside: f64| {
        let [units, middle] = around(options, state, cell, ahead, aside);
        let radius = options.contact.ridge(units * Glass::UNIT_M3 / options.cell_m);
        let across = middle * options.cell_m + GlassWiper::LIP_M + radius;
        let along = (cell.as_dvec2() + 0.5 + ahead.perp() * aside) * options.cell_m;
        (along + ahead * across, radius)
    };
    let (center, radius) = section(0.0);
    if radius < MIN_HALF_WIDTH_M {
        return None;
    }
    // Pieces follow the ridge's bends and grow with it, so that neighboring ones meet.
    let ((before, narrow), (after, wide)) = (section(-1.0), section(1.0));
    let along = (after - before).normalize_or_zero();
    let taper = (wide - narrow) / (after - before).length().max(options.cell_m);
    let axis = along * (HALF * options.cell_m);
    let droop = if taper < 0.0 { -along } else { along };
    Some(GlassPictureDrop {
        center: center.as_vec2().into(),
        radius: radius as f32,
        sphere: options.contact.sphere(radius) as f32,
        along: ahead.as_vec2().into(),
        behind: 1.0,
        lean: taper.abs().min(MAX_TAPER) as f32,
        droop: droop.as_vec2().into(),
        axis: axis.as_vec2().into(),
        lobes: [0.0; 4],
    })
}

#[cfg(test)]
mod tests {
    use downpour_lattice::glass::{GlassTexture, GlassWiperKey, GlassWiperMotion};
    use glam::Vec2;

    use super::super::water::glass_picture_water_cap;
    use super::*;

    /// A blade of 80 mm pushes the water of drops together: along it the water is one ridge, without gaps, no beads, as high as a
    /// segment of a circle that has its cross-section.
    #[test]
    fn swept_water_is_one_ridge_and_not_beads() {
        let key = |time_s, angle_rad| GlassWiperKey { time_s, angle_rad };
        let wiper = GlassWiper {
            // Nearly parallel: the pivot is far away.
            pivot_m: [0.05, 0.19],
            inner_m: 0.1,
            outer_m: 0.18,
            motion: GlassWiperMotion::Keys(vec![key(0.0, 1.72), key(0.6, 1.42)]),
            film_m: 0.0,
            worn: Vec::new(),
        };
        let options = GlassOptions {
            size: [160, 160],
            tilt_rad: 0.0,
            affinity: GlassTexture::Even,
            friction: GlassTexture::Even,
            wipers: vec![wiper],
            ..GlassOptions::default()
        };
        let mut glass = Glass::new(&options).expect("a pane");
        for y in (20..150).step_by(7) {
            for x in (4..156).step_by(7) {
                glass.pour(x, y, 0.5e-9).expect("a drop");
            }
        }
        glass.step(0.5).expect("a step");
        let state = glass.state();
        let is_ridge = |i: &usize| state.mass[*i] > 0 && glass_ridge_is(state.motion[*i][1]);
        let cells: Vec<usize> = (0..state.mass.len()).filter(is_ridge).collect();
        let pieces: Vec<GlassPictureDrop> =
            cells.iter().filter_map(|&i| ridge_piece(&options, &state, i as u32)).collect();
        assert!(pieces.len() > 80, "{}", pieces.len());
        // The crest along the middle 50 mm of the blade.
        let height =
            |at: Vec2| pieces.iter().map(|piece| glass_picture_water_cap(piece, at).x).fold(0.0f32, f32::max);
        let crest: Vec<f32> = (30..110)
            .map(|row| {
                let y = row as f32 * 0.6e-3;
                (0..960).map(|k| height(Vec2::new(k as f32 * 1.0e-4, y))).fold(0.0, f32::max)
            })
            .collect();
        let mean = crest.iter().sum::<f32>() / crest.len() as f32;
        let least = crest.iter().copied().fold(f32::INFINITY, f32::min);
        let most = crest.iter().copied().fold(0.0, f32::max);
        assert!(least > 0.6 * mean && most < 1.5 * mean, "{least} to {most}, {mean}");
        // As high as its water makes it.
        let units: u32 = cells.iter().map(|&i| state.mass[i]).sum();
        let area = f64::from(units) * Glass::UNIT_M3 / 0.08;
        let expected = options.contact.ridge(area) * ops::tan(0.5 * options.contact.mean_rad());
        assert!((f64::from(mean) / expected - 1.0).abs() < 0.15, "{mean} for {expected}");
    }
}
