//! The pane on the CPU.

use downpour_math::in_range;
use downpour_shaders::lattice::glass::{GLASS_MAX_MASS, GLASS_OBSTACLE};
use glam::{IVec2, Vec3};

use super::cells::{Cells, Tick, load};
use super::error::GlassError;
use super::frame::GlassFrame;
use super::motion::{glass_motion_unpack, glass_motion_wetness};
use super::options::{GlassAir, GlassOptions, GlassRain};
use super::plan::Plan;
use super::ridge::glass_ridge_is;
use super::state::GlassState;
use super::totals::{Counters, GlassTotals};
use super::{height, normal, smooth, surface};

/// Volume of a unit of mass, m^3: a nanoliter.
pub(super) const UNIT_M3: f64 = 1.0e-12;

/// A pane of glass with drops.
///
/// ```
/// use downpour_lattice::glass::{Glass, GlassOptions, GlassRain};
/// let rain = GlassRain { rate_mm_h: 25.0, towards_m_s: 5.0, ..GlassRain::default() };
/// let mut glass = Glass::new(&GlassOptions { size: [64, 64], rain, ..GlassOptions::default() })?;
/// for _ in 0..10 {
///     glass.step(0.1)?;
/// }
/// let totals = glass.totals();
/// assert!(totals.stored > 0);
/// assert_eq!(totals.lost(), 0);
/// # Ok::<(), downpour_lattice::glass::GlassError>(())
/// ```
#[derive(Debug)]
pub struct Glass {
    plan: Plan,
    cells: Cells,
    counters: Counters,
    poured: u64,
}

impl Glass {
    /// Volume of a unit of mass, m^3: a nanoliter.
    pub const UNIT_M3: f64 = UNIT_M3;

    /// Maximum mass of a cell, in units: a drop of 7.9 mm.
    pub const MAX_MASS: u32 = GLASS_MAX_MASS;

    /// Creates a dry pane.
    ///
    /// # Errors
    /// [`GlassError`] that names the quantity out of range.
    pub fn new(options: &GlassOptions) -> Result<Self, GlassError> {
        let plan = Plan::new(options)?;
        let cells = Cells::new(surface::surface(options)?);
        Ok(Self { plan, cells, counters: Counters::default(), poured: 0 })
    }

    /// Advances the pane by `dt_s` seconds: above 0 to 60. Time passes in whole ticks; the remainder counts for the
    /// next step. The bits do not depend on the number of threads or the division of the time into steps, and are
    /// those of a GPU.
    ///
    /// # Errors
    /// [`GlassError::OutOfRange`] if the step is not in its range, or the pane is older than 12 days.
    pub fn step(&mut self, dt_s: f64) -> Result<(), GlassError> {
        let ticks = self.plan.ticks(dt_s)?;
        // The pool is entered once, not once for each part of each tick.
        let (cells, counters, table) = (&mut self.cells, &self.counters, &self.plan.table);
        rayon::scope(|_| {
            for k in 0..ticks.count {
                let blades = ticks.frame.blades as usize;
                let first = k as usize * blades;
                let tick = Tick {
                    frame: &ticks.frame,
                    table,
                    blades: ticks.blades.get(first..first + blades).unwrap_or_default(),
                    step: ticks.frame.first_step + k,
                    clock: ticks.frame.first_clock + k * ticks.frame.clock_step,
                };
                cells.tick(&tick, counters);
            }
        });
        Ok(())
    }

    /// Sets rain and air from now on: changing weather, an accelerating car.
    ///
    /// # Errors
    /// [`GlassError::OutOfRange`] for numbers out of their ranges, and for rain that is too dense for the tick, which the
    /// options of [`Glass::new`] determine; the pane is then unchanged.
    pub fn set_weather(&mut self, rain: &GlassRain, air: &GlassAir) -> Result<(), GlassError> {
        self.plan.set_weather(rain, air)
    }

    /// Adds water to a cell, m^3, rounded to whole units.
    ///
    /// # Errors
    /// [`GlassError::NoSuchCell`] off the pane and on an obstacle; [`GlassError::OutOfRange`] if the cell would hold more
    /// than [`Glass::MAX_MASS`], or the volume is below 0 or NaN.
    pub fn pour(&mut self, x: u32, y: u32, volume_m3: f64) -> Result<(), GlassError> {
        let index = free_cell(self.plan.options(), &self.cells.surface, x, y)?;
        let Some(mass) = self.cells.mass.get_mut(index) else { return Err(GlassError::NoSuchCell { x, y }) };
        let units = poured_units(volume_m3, *mass)?;
        if *mass == 0 && units != 0 {
            self.cells.drops.push(index as u32);
        }
        *mass += units;
        self.poured += u64::from(units);
        Ok(())
    }

    /// Options of the pane.
    #[must_use]
    pub fn options(&self) -> &GlassOptions {
        self.plan.options()
    }

    /// Length of a tick, s.
    #[must_use]
    pub fn tick_s(&self) -> f64 {
        self.plan.tick_s()
    }

    /// Number of ticks that have passed.
    #[must_use]
    pub fn ticks(&self) -> u64 {
        self.plan.done()
    }

    /// Mass of each cell in units of [`Glass::UNIT_M3`], row by row from the top.
    #[must_use]
    pub fn mass(&self) -> &[u32] {
        &self.cells.mass
    }

    /// Velocity of the drop in each cell, m/s right and down.
    #[must_use]
    pub fn velocities(&self) -> Vec<[f32; 2]> {
        let unit = (self.options().cell_m / self.tick_s() / 16384.0) as f32;
        let of = |m: &[u32; 2]| {
            // The word of a ridge is the direction of its blade.
            let v = if glass_ridge_is(m[1]) { IVec2::ZERO } else { glass_motion_unpack(m[0]) };
            (v.as_vec2() * unit).to_array()
        };
        self.cells.motion.iter().map(of).collect()
    }

    /// Velocity and progress of the drop in each cell in the format of the kernels.
    #[must_use]
    pub fn motion(&self) -> &[[u32; 2]] {
        &self.cells.motion
    }

    /// Wetness of each cell where water has passed, 0 to 255.
    #[must_use]
    pub fn traversal(&self) -> Vec<u8> {
        let of = |i: u32| wetness(self.plan.frame(), load(&self.cells.wet, i));
        (0..self.cells.wet.len() as u32).map(of).collect()
    }

    /// Times when water last moved over the cells, by the clock of the ticks.
    fn clocks(&self) -> Vec<u32> {
        (0..self.cells.wet.len() as u32).map(|i| load(&self.cells.wet, i)).collect()
    }

    /// The water on the pane now.
    #[must_use]
    pub fn state(&self) -> GlassState {
        GlassState {
            mass: self.cells.mass.clone(),
            motion: self.cells.motion.clone(),
            traversal: self.traversal(),
            tails: self.plan.tails(&self.clocks()),
        }
    }

    /// Water balance, to the unit.
    #[must_use]
    pub fn totals(&self) -> GlassTotals {
        let stored = self.cells.mass.iter().map(|&m| u64::from(m)).sum();
        self.counters.totals(self.poured, stored)
    }

    /// Height of the water in each cell, in cells / 256.
    #[must_use]
    pub fn height_units(&self) -> Vec<u32> {
        let frame = self.plan.frame();
        let caps = height::caps(&self.cells, frame, &self.plan.table);
        smooth::smooth(frame, &caps)
    }

    /// Height of the water in each cell, m.
    #[must_use]
    pub fn heights(&self) -> Vec<f32> {
        let unit = (self.options().cell_m / 256.0) as f32;
        self.height_units().into_iter().map(|h| h as f32 * unit).collect()
    }

    /// Unit normals of the water surface: x right, y down the pane, z out of it.
    #[must_use]
    pub fn normals(&self) -> Vec<Vec3> {
        let normals = normal::normals(self.plan.frame(), &self.height_units());
        normals.into_iter().map(|n| n.extend((1.0 - n.length_squared()).max(0.0).sqrt())).collect()
    }

    /// Checks the whole state: no mass above the maximum, none on obstacles, nothing lost, nothing left in the scratch.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        let cells = &self.cells;
        let held = |(&mass, &word): (&u32, &u32)| {
            mass <= GLASS_MAX_MASS && (mass == 0 || word & GLASS_OBSTACLE == 0)
        };
        let scratch = cells.next.iter().chain(&cells.arrival).chain(&cells.keys);
        cells.mass.iter().zip(&cells.surface).all(held)
            && scratch.into_iter().all(|w| w.load(std::sync::atomic::Ordering::Relaxed) == 0)
            && self.totals().lost() == 0
    }
}

/// Wetness of a cell where water has passed, 0 to 255, by the clock of the last time.
pub(crate) fn wetness(frame: &GlassFrame, last: u32) -> u8 {
    glass_motion_wetness(frame.first_clock, last, frame.wet_life) as u8
}

/// Index of a cell that can hold water.
pub(crate) fn free_cell(
    options: &GlassOptions,
    surface: &[u32],
    x: u32,
    y: u32,
) -> Result<usize, GlassError> {
    let [width, height] = options.size;
    let index = y as usize * width as usize + x as usize;
    match surface.get(index) {
        Some(word) if x < width && y < height && word & GLASS_OBSTACLE == 0 => Ok(index),
        _ => Err(GlassError::NoSuchCell { x, y }),
    }
}

/// Converts a volume to units, if it fits into a cell that holds `mass`.
pub(crate) fn poured_units(volume_m3: f64, mass: u32) -> Result<u32, GlassError> {
    let most = f64::from(GLASS_MAX_MASS - mass.min(GLASS_MAX_MASS));
    let units = (volume_m3 / UNIT_M3).round();
    in_range(
        "poured volume",
        units,
        "mm^3",
        &(0.0..=most),
        1.0e-3,
        "0 to what the cell can still hold of 262.144",
    )?;
    Ok(units as u32)
}
