//! Ripples on shallow water, as a lattice of heights (Tatarchuk & Isidoro 2006, section 4).
//!
//! Law: with the height eta of the surface over its level and its velocity v,
//!
//! > dv/dt = -A eta - 2 gamma v - 4 nu L v,   d eta/dt = v
//!
//! where L is the negative Laplacian of the lattice and A the operator that approximates omega^2: c^2 L for the paper's
//! membrane, and a polynomial of L for real water, whose waves of different lengths have different speeds
//! ([`PuddleForm`]). Time is integrated by leapfrog, with velocities half a step behind heights. A step that is too
//! long for the lattice is divided, so that the Courant number stays below 0.70, and is an error where that would take
//! more than 64 sub-steps: it is never silently unstable.
//!
//! Units: SI. Heights in m, row by row. Deterministic: the same bits for any number of threads.
//!
//! Errors of the phase speed of real water ([`Puddle::speed_error`] has them by wavelength). Water of up to 5 mm: 2.5
//! % from 4 cells to any length, below 1 % from 6. Deeper water: the operator has a small support, so waves much
//! longer than [`max_wave_m`](PuddleOptions::max_wave_m) are too slow, at 20 mm of depth by a tenth at 60
//! cells. Waves below 4 cells are too slow as well, and no lattice resolves their directions. The model is linear:
//! breaking, jets and splashes are not included.

#[cfg(feature = "wgpu")]
mod craters;
mod dispersion;
pub mod lattice;
mod model;
mod normal;
mod rain;
mod reference;
mod ring;
mod seed;
mod storage;
mod sweep;
mod symbol;

#[cfg(feature = "wgpu")]
pub use craters::{CraterMaker, Craters};
pub use dispersion::{PuddleForm, PuddleWater, phase_speed};
pub use model::{MAX_SUBSTEPS, PuddleBorder, PuddleDamping, PuddleOptions, SIZE_RANGE};
pub use normal::{puddle_normal_lean, puddle_normal_slopes, puddle_normal_texel, slope_levels};
pub use rain::PuddleRain;
pub use ring::DropRing;
pub use seed::{Impact, PuddleSeed, Wake, puddle_seed_height, puddle_seed_shape};
pub use storage::PuddleStorage;
pub use symbol::{MAX_COURANT, MAX_DEGREE};

pub(crate) use model::Model;
#[cfg(feature = "wgpu")]
pub(crate) use normal::whole as whole_normal;
#[cfg(feature = "wgpu")]
pub(crate) use seed::SeedSquares;
pub(crate) use seed::{craters, footprints};

use crate::error::LatticeError;
use downpour_math::ops::ops_is_finite;
use storage::State;

/// A puddle on the CPU.
///
/// ```
/// use downpour_lattice::puddle::{Impact, Puddle, PuddleOptions};
/// let mut puddle = Puddle::new(&PuddleOptions { size: [64, 64], ..PuddleOptions::default() })?;
/// puddle.seed(&[Impact { position_m: [0.064, 0.064], speed_m_s: 6.5, diameter_m: 2.0e-3 }])?;
/// for _ in 0..6 {
///     puddle.step(1.0 / 60.0)?;
/// }
/// assert!(puddle.heights().iter().any(|h| h.abs() > 1.0e-5));
/// # Ok::<(), downpour_lattice::LatticeError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Puddle {
    model: Model,
    state: State,
    other: State,
    steps: u64,
    reset: u64,
}

impl Puddle {
    /// Creates level water over the whole lattice.
    ///
    /// # Errors
    /// [`LatticeError::OutOfRange`] names the option out of range.
    pub fn new(options: &PuddleOptions) -> Result<Self, LatticeError> {
        Self::assemble(Model::new(options, None)?)
    }

    /// Creates level water where `land` is false: one flag per cell, row by row. Land reflects ripples, and keeps the
    /// height 0.
    ///
    /// # Errors
    /// As [`new`](Self::new); [`LatticeError::Cells`] if the mask does not match the lattice.
    pub fn with_land(options: &PuddleOptions, land: &[bool]) -> Result<Self, LatticeError> {
        Self::assemble(Model::new(options, Some(land))?)
    }

    fn assemble(model: Model) -> Result<Self, LatticeError> {
        let cells = model.links.stride() * model.links.size[1];
        let state = State::new(model.options.storage, cells);
        Ok(Self { model, other: state.clone(), state, steps: 0, reset: 0 })
    }

    /// Options of the puddle.
    #[must_use]
    pub fn options(&self) -> &PuddleOptions {
        &self.model.options
    }

    /// Degree of the operator: passes over the neighbors per time step.
    #[must_use]
    pub fn degree(&self) -> u32 {
        self.model.degree
    }

    /// Edges of the lattice, m.
    #[must_use]
    pub fn extent_m(&self) -> [f32; 2] {
        self.options().size.map(|n| n as f32 * self.options().cell_m)
    }

    /// Longest time, in s, of a single step.
    #[must_use]
    pub fn max_step_s(&self) -> f64 {
        self.model.limit()
    }

    /// Courant number of a time as a single step: leapfrog is stable below 0.7071, and 0.70 is the maximum used. For a
    /// membrane without viscosity it is c dt / cell.
    #[must_use]
    pub fn courant(&self, dt_s: f32) -> f64 {
        self.model.courant(f64::from(dt_s))
    }

    /// Number of sub-steps into which a time is divided.
    ///
    /// # Errors
    /// [`LatticeError::OutOfRange`] if the time is not positive and finite, or would take more sub-steps than are allowed.
    pub fn substeps(&self, dt_s: f32) -> Result<u32, LatticeError> {
        self.model.substeps(f64::from(dt_s))
    }

    /// Relative error of the phase speed of a wavelength (m) that runs along the rows: -0.01 is 1 % too slow.
    #[must_use]
    pub fn speed_error(&self, wavelength_m: f64) -> f64 {
        let turn = std::f64::consts::TAU * self.model.cell() / wavelength_m;
        let (symbol, dt) = self.model.fitted();
        let wanted = self.model.law.squared_frequency(turn / self.model.cell()).sqrt();
        symbol.frequency([turn, 0.0], dt) / wanted - 1.0
    }

    /// Advances the puddle by `dt_s` seconds. Returns the number of sub-steps.
    ///
    /// # Errors
    /// As [`substeps`](Self::substeps); the puddle is then unchanged.
    pub fn step(&mut self, dt_s: f32) -> Result<u32, LatticeError> {
        let substeps = self.substeps(dt_s)?;
        let dt = f64::from(dt_s) / f64::from(substeps);
        let mut left = substeps;
        while left > 0 {
            let steps = left.min(self.model.steps_per_sweep());
            let grid = self.model.grid(dt, steps);
            self.reset += sweep::sweep(&grid, &self.model.links, &self.state, &mut self.other);
            std::mem::swap(&mut self.state, &mut self.other);
            left -= steps;
        }
        self.steps += u64::from(substeps);
        Ok(substeps)
    }

    /// Adds the crater of each impact.
    ///
    /// # Errors
    /// [`LatticeError::OutOfRange`] names the quantity of an impact out of range; no crater is then made. Impacts beyond the
    /// lattice and on land are allowed.
    pub fn seed(&mut self, impacts: &[Impact]) -> Result<(), LatticeError> {
        let seeds = craters(&self.model, impacts)?;
        self.add(&seeds);
        Ok(())
    }

    /// Displaces water by an object that moves through it.
    ///
    /// # Errors
    /// [`LatticeError::OutOfRange`] names the quantity out of range.
    pub fn displace(&mut self, wake: &Wake) -> Result<(), LatticeError> {
        let seeds = footprints(&self.model, wake)?;
        self.add(&seeds);
        Ok(())
    }

    fn add(&mut self, seeds: &[PuddleSeed]) {
        let stride = self.model.links.stride();
        let heights = &mut self.state.heights;
        for seed in seeds {
            seed.visit(&self.model.links, |x, y| {
                let at = y * stride + x;
                heights.set(at, heights.get(at) + puddle_seed_height(seed, [x as f32, y as f32]));
            });
        }
    }

    /// Heights over the level, m, row by row.
    #[must_use]
    pub fn heights(&self) -> Vec<f32> {
        self.rows(&self.state.heights)
    }

    /// Height over the level of the cell at a position, m from the corner of the lattice; beyond it that of the nearest.
    #[must_use]
    pub fn height_at(&self, position_m: [f32; 2]) -> f32 {
        let options = self.options();
        let cell = |axis: usize| {
            let cell = (position_m[axis] / options.cell_m) as usize;
            cell.min(options.size[axis] as usize - 1)
        };
        self.state.heights.get(cell(1) * self.model.links.stride() + cell(0))
    }

    /// Velocities of the surface, m/s, half a time step before the heights.
    #[must_use]
    pub fn velocities(&self) -> Vec<f32> {
        self.rows(&self.state.velocities)
    }

    fn rows(&self, field: &storage::Field) -> Vec<f32> {
        let [nx, ny] = self.model.links.size;
        let mut out = vec![0.0; nx * ny];
        for (y, row) in out.chunks_exact_mut(nx).enumerate() {
            field.read(y * self.model.links.stride(), row);
        }
        out
    }

    /// Sets heights and velocities, a number per cell each. Cells of water with a number that is not finite are reset
    /// and counted, as those that become so later; returns the count. Land stays at rest.
    ///
    /// # Errors
    /// [`LatticeError::Cells`] if the number of values is not that of the cells.
    pub fn set_state(&mut self, heights: &[f32], velocities: &[f32]) -> Result<u64, LatticeError> {
        let cells = self.model.cells();
        for (quantity, values) in [("the field of heights", heights), ("the field of velocities", velocities)]
        {
            if values.len() != cells {
                return Err(LatticeError::Cells { quantity, found: values.len(), allowed: cells });
            }
        }
        let [nx, _] = self.model.links.size;
        let mut bad = 0;
        for (i, (&height, &velocity)) in heights.iter().zip(velocities).enumerate() {
            let (x, y) = (i % nx, i / nx);
            let at = y * self.model.links.stride() + x;
            let water = self.model.links.is_water(x, y);
            let finite = ops_is_finite(height) && ops_is_finite(velocity);
            bad += u64::from(water && !finite);
            let keep = water && finite;
            self.state.heights.set(at, if keep { height } else { 0.0 });
            self.state.velocities.set(at, if keep { velocity } else { 0.0 });
        }
        self.reset += bad;
        Ok(bad)
    }

    /// Normals of the surface by Sobel sums: x along the rows, y up, z along the columns.
    #[must_use]
    pub fn normals(&self) -> Vec<[f32; 3]> {
        normal::normals(&self.model.links, &self.heights(), (1.0 / (8.0 * self.model.cell())) as f32)
    }

    /// Slopes along the rows and the columns of each cell, the square of the slope, and 0, row by row: those of the normals.
    #[must_use]
    pub fn slopes(&self) -> Vec<[f32; 4]> {
        normal::texels(&self.model.links, &self.heights(), (1.0 / (8.0 * self.model.cell())) as f32)
    }

    /// Energy that leapfrog conserves without damping: `Sum (v^2 + eta A eta') / 2` per cell area, m^4/s^2, with the
    /// heights before and after the last step. It includes the energy of each wave times a factor that depends on the
    /// wavelength alone.
    #[must_use]
    pub fn energy(&self) -> f64 {
        let (symbol, dt) = self.model.fitted();
        let per_cell = reference::energy(&self.model.links, symbol, dt, &self.heights(), &self.velocities());
        per_cell * self.model.cell() * self.model.cell()
    }

    /// Volume of water over the level, m^3.
    #[must_use]
    pub fn volume(&self) -> f64 {
        let sum: f64 = self.heights().iter().copied().map(f64::from).sum();
        sum * self.model.cell() * self.model.cell()
    }

    /// Number of time steps so far.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Number of cells that were reset because they were not finite. A number above 0 indicates bad input.
    #[must_use]
    pub fn reset_cells(&self) -> u64 {
        self.reset
    }
}
