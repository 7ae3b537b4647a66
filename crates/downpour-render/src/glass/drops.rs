//! The drops of a lattice as surfaces, and the bins in which a ray finds them.

use std::f64::consts::TAU;

use downpour_drop::air::STANDARD_GRAVITY;
use downpour_drop::water;
use downpour_lattice::glass::height::glass_height_stretch;
use downpour_lattice::glass::motion::{
    glass_motion_length, glass_motion_octant, glass_motion_offset, glass_motion_unpack,
};
use downpour_lattice::glass::ridge::glass_ridge_is;
use downpour_lattice::glass::{Glass, GlassError, GlassOptions, GlassState};
use downpour_math::bins::Bins;
use downpour_math::ops::f64 as ops;
use downpour_math::rng::{rng_draw, rng_unit, seed_words};
use glam::{DVec2, IVec2};

use super::ridge::ridge_piece;
use super::water::GlassPictureDrop;

/// Edge of a bin, m.
const BIN_M: f64 = 3.0e-3;

/// Largest deviation of the outline from a circle, as a fraction of the squared radius.
const UNEVEN: f64 = 0.5;

/// The radius, m, from which a drop is as uneven as the glass: small ones are round.
const ROUND_M: f64 = 1.4e-3;

/// Widths of spots of the glass that pull the outline, m.
const SPOTS_M: [f64; 2] = [4.5e-3, 1.7e-3];

/// Positions around the outline at which the glass is asked.
const ROUND: u32 = 8;

/// Relative excess of the slope below a drop over that in its middle when it is about to slide: from tan 20 to tan 60 degrees.
const LEAN: f64 = 0.6;

/// Cells off their middle, at most, that a resting drop is: drops do not sit on a grid.
const JITTER: f64 = 0.8;

/// Drops, in the order of memory, and bins.
pub(super) struct Binned {
    pub(super) drops: Vec<GlassPictureDrop>,
    pub(super) bins: Vec<u32>,
    pub(super) columns: u32,
    pub(super) rows: u32,
    pub(super) per_meter: f64,
}

/// Parameters that all drops of a pane have in common.
struct Common<'a> {
    options: &'a GlassOptions,
    seed: [u32; 2],
    density: f64,
    tension: f64,
    air_density: f64,
}

/// All drops of a pane whose uppermost rows are above what is seen of it. Positions are from the corner of what is seen.
///
/// # Errors
/// [`GlassError::Rain`] if water at the pane's temperature is not known.
pub(super) fn binned(options: &GlassOptions, state: &GlassState, above: u32) -> Result<Binned, GlassError> {
    let common = Common {
        options,
        seed: seed_words(options.seed ^ 0x70616e65),
        density: water::density(options.temperature_c)?,
        tension: water::surface_tension(options.temperature_c)?,
        air_density: options.rain.air.density(),
    };
    let cells = state.mass.iter().zip(&state.motion).enumerate();
    let drops: Vec<GlassPictureDrop> = cells
        .filter(|(_, (mass, _))| **mass != 0)
        .filter_map(|(index, (&mass, motion))| {
            if glass_ridge_is(motion[1]) {
                return ridge_piece(options, state, index as u32);
            }
            Some(common.drop(index as u32, mass, *motion))
        })
        .filter_map(|drop| lowered(drop, f64::from(above) * options.cell_m))
        .collect();
    let [columns, rows] = options.size;
    let size = [columns, rows - above].map(|edge| f64::from(edge) * options.cell_m);
    let [columns, rows] = size.map(|edge| ((edge / BIN_M).ceil() as u32).max(1));
    let count = (columns * rows) as usize;
    let bin = |at: f64, most: u32| ((at / BIN_M).max(0.0) as u32).min(most - 1);
    let touched = |index: u32, each: &mut dyn FnMut(usize)| {
        let drop = &drops[index as usize];
        let reach = f64::from(drop.reach());
        let [x, y] = drop.center.map(f64::from);
        let (left, right) = (bin(x - reach, columns), bin(x + reach, columns));
        let (top, bottom) = (bin(y - reach, rows), bin(y + reach, rows));
        for row in top..=bottom {
            (left..=right).for_each(|column| each((row * columns + column) as usize));
        }
    };
    let Bins { starts, items } = Bins::new(count, drops.len() as u32, touched);
    // The lists are behind their indices, in one buffer.
    let bins = starts.iter().map(|start| count as u32 + 1 + start).chain(items).collect();
    Ok(Binned { drops, bins, columns, rows, per_meter: 1.0 / BIN_M })
}

/// A drop from a corner that is so many meters lower; `None` if it is all above.
fn lowered(mut drop: GlassPictureDrop, by: f64) -> Option<GlassPictureDrop> {
    drop.center[1] -= by as f32;
    (drop.center[1] + drop.reach() > 0.0).then_some(drop)
}

impl Common<'_> {
    fn drop(&self, index: u32, mass: u32, [velocity, progress]: [u32; 2]) -> GlassPictureDrop {
        let options = self.options;
        let contact = &options.contact;
        let volume = f64::from(mass) * Glass::UNIT_M3;
        let radius = contact.radius(volume);
        let v = glass_motion_unpack(velocity);
        let speed = glass_motion_length(v);
        let cell = IVec2::new((index % options.size[0]) as i32, (index / options.size[0]) as i32);
        let center = self.center(cell, v, progress as i32);
        let pull = self.pull(volume, radius);
        let strength = pull.length();
        let droop = if strength > 0.0 { pull / strength } else { DVec2::Y };
        let held = contact.hold(radius, self.tension);
        let runs = speed >= 4;
        let along = if runs { v.as_dvec2().normalize() } else { droop };
        let behind = if runs { 256.0 / f64::from(glass_height_stretch(speed)) } else { 1.0 };
        GlassPictureDrop {
            center: center.as_vec2().into(),
            radius: radius as f32,
            sphere: contact.sphere(radius) as f32,
            along: along.as_vec2().into(),
            behind: behind as f32,
            lean: (LEAN * (strength / held.max(1.0e-12)).min(1.0)) as f32,
            droop: droop.as_vec2().into(),
            axis: [0.0; 2],
            lobes: self.lobes(center, radius, along),
        }
    }

    /// Position of a drop on its way from a point near the center of its cell to one near that of the next cell.
    fn center(&self, cell: IVec2, v: IVec2, progress: i32) -> DVec2 {
        let near = |cell: IVec2| {
            let [a, b, ..] = rng_draw(self.seed, cell.x as u32, cell.y as u32, 0);
            let off = DVec2::new(f64::from(rng_unit(a)), f64::from(rng_unit(b))) - 0.5;
            (cell.as_dvec2() + 0.5 + off * JITTER) * self.options.cell_m
        };
        if v == IVec2::ZERO {
            return near(cell);
        }
        let next = cell + glass_motion_offset(glass_motion_octant(v));
        let fraction = (f64::from(progress) / 16384.0).clamp(0.0, 1.0);
        near(cell).lerp(near(next), fraction)
    }

    /// The force along the pane on a drop, N.
    fn pull(&self, volume: f64, radius: f64) -> DVec2 {
        let options = self.options;
        let weight = self.density * STANDARD_GRAVITY * ops::sin(options.tilt_rad) * volume;
        let air = &options.air;
        let pressure = 0.5 * self.air_density * air.speed_m_s * air.speed_m_s * air.drag;
        let push = pressure * options.contact.frontal_area(radius);
        let towards = DVec2::new(ops::cos(air.direction_rad), -ops::sin(air.direction_rad));
        DVec2::Y * weight + towards * push
    }

    /// The outline: the glass around a drop, as its second and third harmonic.
    fn lobes(&self, center: DVec2, radius: f64, along: DVec2) -> [f32; 4] {
        let fraction = UNEVEN * (radius / ROUND_M).min(1.0) * 2.0 / f64::from(ROUND);
        let mut lobes = [0.0; 4];
        for k in 0..ROUND {
            let angle = TAU * f64::from(k) / f64::from(ROUND);
            let (sin, cos) = (ops::sin(angle), ops::cos(angle));
            let at = center + (along * cos + along.perp() * sin) * radius;
            let pulls = fraction * self.glass(at);
            let parts = [
                cos * cos - sin * sin,
                2.0 * sin * cos,
                cos * (cos * cos - 3.0 * sin * sin),
                sin * (3.0 * cos * cos - sin * sin),
            ];
            for (lobe, part) in lobes.iter_mut().zip(parts) {
                *lobe += pulls * part;
            }
        }
        lobes.map(|lobe| lobe.clamp(-0.3, 0.3) as f32)
    }

    /// Pull of the glass at a position, -1 to 1: value noise on square grids of two sizes.
    fn glass(&self, at: DVec2) -> f64 {
        let ease = |t: f64| t * t * (3.0 - 2.0 * t);
        let mut sum = 0.0;
        for (octave, spot) in (1..).zip(SPOTS_M) {
            let scaled = at / spot;
            let low = scaled.floor();
            let (s, t) = (ease(scaled.x - low.x), ease(scaled.y - low.y));
            let corner = |dx: i32, dy: i32| {
                let (x, y) = (low.x as i32 + dx, low.y as i32 + dy);
                let [word, ..] = rng_draw(self.seed, x as u32, y as u32, octave);
                2.0 * f64::from(rng_unit(word)) - 1.0
            };
            let upper = corner(0, 0) * (1.0 - s) + corner(1, 0) * s;
            let lower = corner(0, 1) * (1.0 - s) + corner(1, 1) * s;
            sum += 0.5 * (upper * (1.0 - t) + lower * t);
        }
        sum
    }
}
