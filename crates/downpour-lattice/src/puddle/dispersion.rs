//! Dispersion relation of ripples.
//!
//! Law, for waves of low amplitude relative to their length on water of depth h:
//!
//! > omega^2 = (g k + sigma k^3 / rho) tanh(k h)
//!
//! with the angular frequency omega, the wave number k = 2 pi / wavelength, gravity g, surface tension sigma and
//! density rho (H. Lamb, "Hydrodynamics", 6th edition, sections 228 and 267). On deep water the phase speed omega / k
//! has its minimum, 0.231 m/s, at 17 mm: longer waves are driven by gravity, shorter ones by surface tension, and both
//! are faster.
//!
//! A membrane (Tatarchuk & Isidoro 2006, section 4) has one speed for all: omega = c k. It neglects gravity and
//! does not spread a ring into a train of ripples; it is kept as the paper's form.

use std::f64::consts::TAU;

use downpour_math::ops::f64 as ops;

/// Water of a puddle, and gravity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PuddleWater {
    /// Density, kg/m^3.
    pub density: f64,
    /// Surface tension, N/m.
    pub surface_tension: f64,
    /// Kinematic viscosity, m^2/s: the amplitude of a ripple of wave number k decays at the rate 2 nu k^2.
    pub viscosity: f64,
    /// Gravity, m/s^2.
    pub gravity: f64,
}

impl Default for PuddleWater {
    /// Clean water of 20 C (`downpour_drop::water`) at sea level.
    fn default() -> Self {
        Self { density: 998.2, surface_tension: 0.072_74, viscosity: 1.003e-6, gravity: 9.806_65 }
    }
}

/// Dispersion law of the ripples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PuddleForm {
    /// Gravity and surface tension over a flat ground, as for real water.
    GravityCapillary,
    /// The membrane of Tatarchuk & Isidoro 2006: one speed for every wavelength.
    Membrane {
        /// Speed, m/s: 0.001 to 100.
        speed_m_s: f32,
    },
}

/// A form with its parameters in f64.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Dispersion {
    pub(crate) form: PuddleForm,
    pub(crate) water: PuddleWater,
    pub(crate) depth: f64,
}

impl Dispersion {
    /// omega^2 of a wave number in 1/m.
    pub(crate) fn squared_frequency(&self, k: f64) -> f64 {
        match self.form {
            PuddleForm::GravityCapillary => {
                let w = &self.water;
                (w.gravity * k + w.surface_tension / w.density * k * k * k) * ops::tanh(k * self.depth)
            }
            PuddleForm::Membrane { speed_m_s } => {
                let ck = f64::from(speed_m_s) * k;
                ck * ck
            }
        }
    }

    /// Phase speed of a wavelength, m/s.
    pub(crate) fn phase_speed(&self, wavelength: f64) -> f64 {
        let k = TAU / wavelength;
        self.squared_frequency(k).sqrt() / k
    }
}

/// Phase speed, in m/s, of ripples of a wavelength on water of a depth (both in meters, above 0).
///
/// ```
/// use downpour_lattice::puddle::{PuddleWater, phase_speed};
/// let deep = phase_speed(0.0171, 1.0, &PuddleWater::default());
/// assert!((deep - 0.2312).abs() < 1e-4);
/// ```
#[must_use]
pub fn phase_speed(wavelength_m: f64, depth_m: f64, water: &PuddleWater) -> f64 {
    Dispersion { form: PuddleForm::GravityCapillary, water: *water, depth: depth_m }.phase_speed(wavelength_m)
}
