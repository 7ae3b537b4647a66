//! Options of a puddle, checked, and parameters of its time steps.

use downpour_math::{OutOfRange, in_range};
use std::f64::consts::TAU;

use downpour_math::ops::f64 as ops;

use super::dispersion::{Dispersion, PuddleForm, PuddleWater};
use super::lattice::{Links, PuddleGrid};
use super::storage::PuddleStorage;
use super::symbol::{MAX_COURANT, MAX_DEGREE, Stencil, Symbol, degree_for};
use crate::error::LatticeError;

/// Range of the number of cells along an edge.
pub const SIZE_RANGE: std::ops::RangeInclusive<u32> = 64..=4096;

/// Maximum number of sub-steps of one call of `step`.
pub const MAX_SUBSTEPS: u32 = 64;

/// Maximum width of the halo of a tile, in cells.
const MAX_HALO: u32 = 24;

/// Width of the absorbing border, in cells, and its maximum fraction of the lattice.
const SPONGE_CELLS: f64 = 32.0;
const SPONGE_FRACTION: f64 = 0.25;

/// Border of the lattice.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum PuddleBorder {
    /// Reflecting wall.
    #[default]
    Reflecting,
    /// Open water: the outermost 32 cells (or a quarter of the lattice) absorb ripples.
    Open,
}

/// Damping of ripples.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum PuddleDamping {
    /// No damping.
    None,
    /// Damping of clean water: viscosity, amplitude rate 2 nu k^2 (Lamb, section 348), and friction on the ground,
    /// k sqrt(nu omega / 2) / sinh(2 k h), at the rate of a 30 mm ripple for all.
    #[default]
    Water,
    /// Custom rates.
    Rates {
        /// Rate at which the amplitude of every ripple decays, 1/s: 0 to 1000.
        drag_per_s: f32,
        /// Kinematic viscosity, m^2/s: 0 to 1e-2. A thin film on the water, oil or soap, acts like ten times that of
        /// water.
        viscosity_m2_s: f32,
    },
}

/// Options of a puddle.
#[derive(Clone, Debug, PartialEq)]
pub struct PuddleOptions {
    /// Number of cells along x and y: 64 to 4096.
    pub size: [u32; 2],
    /// Edge of a cell, m: 1e-4 to 1.
    pub cell_m: f32,
    /// Depth of the water, m: 1e-4 to 1000.
    pub depth_m: f32,
    /// Dispersion law of the ripples.
    pub form: PuddleForm,
    /// Water, and gravity.
    pub water: PuddleWater,
    /// Damping of ripples.
    pub damping: PuddleDamping,
    /// Border of the lattice.
    pub border: PuddleBorder,
    /// Storage of the state.
    pub storage: PuddleStorage,
    /// Longest wavelength that has to be accurate, m; `None`: 40 cells. A shorter one gives a lower degree or smaller
    /// errors.
    pub max_wave_m: Option<f32>,
    /// Degree of the operator, 1 to 12: number of passes over the neighbors per time step. `None`: the lowest with
    /// errors of the phase speed below 2.5 %, or 12. The membrane has 1.
    pub degree: Option<u32>,
    /// Maximum number of sub-steps of one call of `step`: 1 to 64.
    pub max_substeps: u32,
    /// Number of time steps per pass over the memory: 1 to 8, limited by the degree. It changes the speed only, and the
    /// rounding in [`PuddleStorage::Half`].
    pub steps_per_sweep: u32,
    /// Fraction of a drop's kinetic energy that becomes ripples: 0 to 1. Most of it goes into the splash and into heat.
    pub wave_energy_fraction: f32,
}

impl Default for PuddleOptions {
    /// 256 x 256 cells of 2 mm, 5 mm deep, real water between walls.
    fn default() -> Self {
        Self {
            size: [256, 256],
            cell_m: 2.0e-3,
            depth_m: 5.0e-3,
            form: PuddleForm::GravityCapillary,
            water: PuddleWater::default(),
            damping: PuddleDamping::Water,
            border: PuddleBorder::Reflecting,
            storage: PuddleStorage::Full,
            max_wave_m: None,
            degree: None,
            max_substeps: MAX_SUBSTEPS,
            steps_per_sweep: 8,
            wave_energy_fraction: 0.02,
        }
    }
}

impl PuddleOptions {
    /// The dispersion law.
    pub(super) fn law(&self) -> Dispersion {
        Dispersion { form: self.form, water: self.water, depth: f64::from(self.depth_m) }
    }

    /// Rate at which the amplitude of all ripples decays, 1/s, and viscosity, m^2/s.
    pub(super) fn damping_rates(&self, law: &Dispersion) -> (f64, f64) {
        match self.damping {
            PuddleDamping::None => (0.0, 0.0),
            PuddleDamping::Water => (ground_friction(law), self.water.viscosity),
            PuddleDamping::Rates { drag_per_s, viscosity_m2_s } => {
                (f64::from(drag_per_s), f64::from(viscosity_m2_s))
            }
        }
    }

    pub(super) fn check(&self) -> Result<(), LatticeError> {
        for n in self.size {
            let range = f64::from(*SIZE_RANGE.start())..=f64::from(*SIZE_RANGE.end());
            in_range(
                "size of the lattice",
                f64::from(n),
                "cells",
                &range,
                1.0,
                "64 to 4096 cells along an edge",
            )?;
        }
        let check = |quantity, value: f32, unit, range, factor, allowed: &'static str| {
            in_range(quantity, f64::from(value), unit, &range, factor, allowed)
        };
        check("edge of a cell", self.cell_m, "mm", 0.999e-4..=1.001, 1.0e3, "0.1 to 1000 mm")?;
        check("depth", self.depth_m, "mm", 0.999e-4..=1000.0, 1.0e3, "0.1 mm to 1000 m")?;
        if let PuddleForm::Membrane { speed_m_s } = self.form {
            check("speed of the membrane", speed_m_s, "m/s", 0.999e-3..=100.0, 1.0, "0.001 to 100 m/s")?;
        }
        let w = &self.water;
        in_range("density", w.density, "kg/m^3", &(500.0..=2000.0), 1.0, "500 to 2000 kg/m^3")?;
        in_range("surface tension", w.surface_tension, "N/m", &(0.0..=0.5), 1.0, "0 to 0.5 N/m")?;
        in_range("viscosity", w.viscosity, "m^2/s", &(0.0..=1.0e-2), 1.0, "0 to 0.01 m^2/s")?;
        in_range("gravity", w.gravity, "m/s^2", &(0.1..=100.0), 1.0, "0.1 to 100 m/s^2")?;
        if let PuddleDamping::Rates { drag_per_s, viscosity_m2_s } = self.damping {
            check("drag", drag_per_s, "1/s", 0.0..=1000.0, 1.0, "0 to 1000 1/s")?;
            check("viscosity", viscosity_m2_s, "m^2/s", 0.0..=1.0e-2, 1.0, "0 to 0.01 m^2/s")?;
        }
        if let Some(longest) = self.max_wave_m {
            let cells = f64::from(longest) / f64::from(self.cell_m);
            in_range("longest wavelength", cells, "cells", &(8.0..=4096.0), 1.0, "8 to 4096 cells")?;
        }
        if let Some(degree) = self.degree {
            let range = 1.0..=f64::from(MAX_DEGREE);
            in_range("degree of the operator", f64::from(degree), "", &range, 1.0, "1 to 12")?;
        }
        let range = 1.0..=f64::from(MAX_SUBSTEPS);
        in_range("number of sub-steps", f64::from(self.max_substeps), "", &range, 1.0, "1 to 64")?;
        in_range("steps per sweep", f64::from(self.steps_per_sweep), "", &(1.0..=8.0), 1.0, "1 to 8")?;
        check("fraction of a drop's energy", self.wave_energy_fraction, "", 0.0..=1.0, 1.0, "0 to 1")?;
        Ok(())
    }
}

/// Parts that the CPU and the GPU version share.
#[derive(Clone, Debug)]
pub(crate) struct Model {
    pub(crate) options: PuddleOptions,
    pub(crate) law: Dispersion,
    pub(crate) links: Links,
    pub(crate) degree: u32,
    longest: f64,
    /// Amplitude rate of all ripples, 1/s, and viscosity, m^2/s.
    drag: f64,
    viscosity: f64,
    /// Maximum time step, s.
    limit: f64,
    /// Last fitted time step, and its operator.
    fitted: (f64, Symbol),
}

impl Model {
    pub(crate) fn new(options: &PuddleOptions, land: Option<&[bool]>) -> Result<Self, LatticeError> {
        options.check()?;
        let size = options.size.map(|n| n as usize);
        if let Some(land) = land
            && land.len() != size[0] * size[1]
        {
            let allowed = size[0] * size[1];
            return Err(LatticeError::Cells { quantity: "the mask of land", found: land.len(), allowed });
        }
        let law = options.law();
        let cell = f64::from(options.cell_m);
        let longest = options.max_wave_m.map_or(40.0 * cell, f64::from);
        let degree = match (options.form, options.degree) {
            (PuddleForm::Membrane { .. }, _) => 1,
            (_, Some(degree)) => degree,
            (_, None) => degree_for(&law, cell, longest),
        };
        let (drag, viscosity) = options.damping_rates(&law);
        let symbol = Symbol::fit(&law, cell, degree, longest, 0.0);
        // The Courant number grows with the time step: bisect the interval to the precision of f32.
        let (mut low, mut high) = (0.0, 1.0e3);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            let fits = symbol.courant(middle, viscosity, cell) <= MAX_COURANT;
            (low, high) = if fits { (middle, high) } else { (low, middle) };
        }
        let links = Links::new(size, |x, y| land.is_some_and(|land| land[y * size[0] + x]));
        Ok(Self {
            options: options.clone(),
            law,
            links,
            degree,
            longest,
            drag,
            viscosity,
            limit: low,
            fitted: (0.0, symbol),
        })
    }

    pub(crate) fn cell(&self) -> f64 {
        f64::from(self.options.cell_m)
    }

    pub(crate) fn cells(&self) -> usize {
        self.links.size[0] * self.links.size[1]
    }

    /// Longest time of a single step, s.
    pub(crate) fn limit(&self) -> f64 {
        self.limit
    }

    /// Courant number of a time as a single step.
    pub(crate) fn courant(&self, dt: f64) -> f64 {
        let symbol = Symbol::fit(&self.law, self.cell(), self.degree, self.longest, 0.0);
        symbol.courant(dt, self.viscosity, self.cell())
    }

    /// Number of sub-steps into which a time is divided.
    pub(crate) fn substeps(&self, dt: f64) -> Result<u32, LatticeError> {
        in_range("time step", dt, "s", &(1.0e-9..=1.0e3), 1.0, "1e-9 s and more, finite")?;
        let wanted = (dt / self.limit).ceil().max(1.0);
        if wanted > f64::from(self.options.max_substeps) {
            // The same time in the maximum number of sub-steps.
            let courant = self.courant(dt / f64::from(self.options.max_substeps));
            return Err(LatticeError::OutOfRange(OutOfRange {
                quantity: "Courant number of the shortest sub-step",
                found: courant,
                unit: "",
                allowed: "up to 0.70: a shorter time, larger cells, or more sub-steps (at most 64)".into(),
            }));
        }
        Ok(wanted as u32)
    }

    /// Number of time steps per sweep.
    pub(crate) fn steps_per_sweep(&self) -> u32 {
        self.options.steps_per_sweep.min(MAX_HALO / self.degree / 2).max(1)
    }

    /// Grid for `steps` time steps of `dt`.
    pub(crate) fn grid(&mut self, dt: f64, steps: u32) -> PuddleGrid {
        if self.fitted.0 != dt {
            self.fitted = (dt, Symbol::fit(&self.law, self.cell(), self.degree, self.longest, dt));
        }
        let symbol = &self.fitted.1;
        let Stencil { weights, unit, largest } = symbol.stencil;
        let first = symbol.coefficients.first().copied().unwrap_or(1.0);
        let mut coefficients = [[0.0; 4]; 4];
        for (slot, c) in coefficients.as_flattened_mut().iter_mut().zip(&symbol.coefficients) {
            *slot = (c / first) as f32;
        }
        let kick = dt * first / largest;
        let cell = self.cell();
        let (sponge_cells, sponge_drag) = self.sponge();
        PuddleGrid {
            size: self.options.size,
            quads: self.options.size[0].div_ceil(4),
            degree: self.degree,
            coefficients,
            weights,
            dt: dt as f32,
            twice: (2.0 / largest) as f32,
            kick: kick as f32,
            viscosity: (dt * 4.0 * self.viscosity / (cell * cell * unit) / kick) as f32,
            keep: (1.0 / (1.0 + 2.0 * self.drag * dt)) as f32,
            sponge_cells: sponge_cells as f32,
            sponge_drag: (sponge_drag * dt) as f32,
            steps,
            halo: self.degree * steps,
            half_storage: u32::from(self.options.storage == PuddleStorage::Half),
            slope: (1.0 / (8.0 * cell)) as f32,
            first_texel: 0,
            padding: 0,
        }
    }

    /// Operator of the last time step, and that step.
    pub(crate) fn fitted(&self) -> (&Symbol, f64) {
        (&self.fitted.1, self.fitted.0)
    }

    /// Width of the border in cells, and drag at its edge in 1/s.
    fn sponge(&self) -> (f64, f64) {
        if self.options.border == PuddleBorder::Reflecting {
            return (0.0, 0.0);
        }
        let [nx, ny] = self.options.size;
        let cells = SPONGE_CELLS.min(SPONGE_FRACTION * f64::from(nx.min(ny)));
        let width = cells * self.cell();
        // A ripple of twelve cells, there and back through a drag that grows as the square, keeps exp(-4).
        let speed = self.law.phase_speed(12.0 * self.cell());
        (cells, 12.0 * speed / width)
    }
}

/// Rate at which friction on the ground damps the amplitude of a 30 mm ripple, 1/s.
fn ground_friction(law: &Dispersion) -> f64 {
    let k = TAU / 0.03;
    let omega = law.squared_frequency(k).sqrt();
    let e = ops::exp(-2.0 * k * law.depth);
    // 1 / sinh(x) = 2 e^-x / (1 - e^-2x)
    k * (0.5 * law.water.viscosity * omega).sqrt() * 2.0 * e / (1.0 - e * e)
}
