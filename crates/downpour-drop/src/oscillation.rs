//! Oscillation of a drop: `r(t, theta, phi) = r0 (1 + s2 P20(x) + s3 P31(x) cos(phi)) / V^(1/3)`,
//! `s_n = A_n sin(omega_n t + phase_n)`, `x = cos(theta)`.
//!
//! Source: equation 2 of P. Rousseau et al., "GPU rainfall", 2008, after K. Garg, S. K. Nayar,
//! "Photorealistic rendering of rain streaks", 2006, and A. Frohn, N. Roth, "Dynamics of droplets", 2000;
//! frequencies of Lord Rayleigh 1879, damping of H. Lamb, "Hydrodynamics".
//!
//! - `r0`: radius of the sphere of equal volume, in meters. `theta`: angle from the vertical axis; both modes
//!   are the same up and down. `phi`: angle about the axis.
//! - `P20`, `P31`: associated Legendre functions, not normalized. The papers leave the sign of P31 open. Here
//!   it has the Condon-Shortley sign, `P31 = -3/2 (5 x^2 - 1) sqrt(1 - x^2)`, by which a positive s3 pushes
//!   the outline (theta = pi / 2) outwards at phi = 0. The other sign is the same drop rotated by half a turn.
//! - `V`: volume of equation 2 over that of the sphere. The equation alone does not keep the volume: it
//!   reaches 1.032 for amplitudes (0.1, 0.1) and 1.051 for (0.2, 0.1). Dividing by `V^(1/3)` keeps it, and is
//!   the default; [`drop_oscillation_state_rousseau_2008`] is the equation as printed.
//!
//! The equation oscillates about a sphere. [`OscillatingDrop`] lets the equilibrium shape oscillate: its
//! radius is multiplied by the same factor, and the volume of the product is kept.
//!
//! Limits: amplitudes of 0 to 0.3; the modes (2,0) and (3,1) only, which dominate. Both laws are of first
//! order in the amplitude, so frequencies are those of a sphere. To second order the two modes together move
//! the center of mass sideways by `-1.54 s2 s3 r0` (3 % of the radius at most for the presets): the equation is
//! kept as it is.
//!
//! # Time
//!
//! `sin(omega t)` in f32 is noise after some seconds, and WGSL guarantees the sine in [-pi, pi] only. Time
//! is therefore counted in ticks of 2^-16 s and frequency in units of 2^-16 Hz: their product, in wrapping 32-bit
//! integers, is the phase in 2^-32 turns, exact at any time. The ticks wrap after 18 hours without a jump:
//! each frequency makes a whole number of turns by then. The remainder of a tick, or an offset within an
//! exposure, is added as f32, and the sine is taken of the fraction of a turn. The counted part is the same
//! on the CPU and the GPU, bit for bit; frequencies should then be computed once, not on both.
//!
//! Twin of `shaders/wgsl/drop/oscillation.wgsl`.

mod drop;
mod law;
mod motion;

use bytemuck::{Pod, Zeroable};
use downpour_math::ops;
use downpour_math::real::Real;
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_shaders::drop::oscillation::{
    DROP_OSCILLATION_DIMENSION, DROP_OSCILLATION_MAX_FREQUENCY, DROP_OSCILLATION_TICK, DROP_OSCILLATION_TURN,
    DROP_OSCILLATION_TURN_STEP, DROP_OSCILLATION_UNITS_PER_RADIAN,
};

pub use drop::{DropInstant, OscillatingDrop};
pub use law::{Fluids, FrequencyLaw, lamb_damping_time};
pub use motion::{Amplitudes, Oscillation};

/// Oscillation of one drop as a shader reads it: the WGSL struct of the same name, 32 bytes. Each pair holds
/// the modes (2,0) and (3,1).
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct DropOscillation {
    /// A20, A31: displacement over r0.
    pub amplitude: [f32; 2],
    /// 1 / tau in 1/s; 0 for no damping.
    pub damping: [f32; 2],
    /// Phase at time 0, in turns.
    pub phase: [f32; 2],
    /// Frequency in units of 2^-16 Hz.
    pub frequency: [u32; 2],
}

/// Time as a shader reads it: the WGSL struct of the same name, 8 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct DropOscillationTime {
    /// Ticks of 2^-16 s; wraps after 65536 s, which leaves every phase unchanged.
    pub ticks: u32,
    /// Offset in seconds, added to the ticks; small (below some seconds).
    pub offset: f32,
}

impl DropOscillationTime {
    /// Converts a time in seconds (any finite number; a time that is not finite counts as 0).
    ///
    /// ```
    /// use downpour_drop::oscillation::DropOscillationTime;
    /// assert_eq!(DropOscillationTime::from_seconds(2.0).ticks, 131072);
    /// assert_eq!(DropOscillationTime::from_seconds(65536.0 + 2.0), DropOscillationTime::from_seconds(2.0));
    /// ```
    #[must_use]
    pub fn from_seconds(seconds: f64) -> Self {
        if !seconds.is_finite() {
            return Self::default();
        }
        let wrapped = seconds.rem_euclid(65536.0);
        let ticks = (wrapped * 65536.0).floor();
        // rem_euclid of a tiny negative number is rounded up to 65536 itself, whose ticks wrap to 0.
        Self { ticks: (ticks as u64) as u32, offset: (wrapped - ticks / 65536.0) as f32 }
    }
}

/// P20(x).
#[inline(always)]
#[must_use]
pub fn drop_oscillation_legendre_20<R: Real>(x: R) -> R {
    x.constant(1.5) * x * x - x.constant(0.5)
}

/// P31(x), with the Condon-Shortley sign.
#[inline(always)]
#[must_use]
pub fn drop_oscillation_legendre_31<R: Real>(x: R) -> R {
    let one = x.constant(1.0);
    x.constant(1.5) * (one - x.constant(5.0) * x * x) * (one - x * x).at_least(x.constant(0.0)).sqrt()
}

/// Rayleigh 1879: `omega_n` in rad/s for a radius in m, a surface tension in N/m and a density in kg/m3. 0
/// for n < 2. [`FrequencyLaw`] is the same in f64.
#[inline]
#[must_use]
pub fn drop_oscillation_angular_frequency(n: u32, radius: f32, surface_tension: f32, density: f32) -> f32 {
    let m = (n as f32).max(1.0);
    (m * (m - 1.0) * (m + 2.0) * surface_tension / (density * (radius * radius * radius))).sqrt()
}

/// Lamb: `tau_n` in s, in which the amplitude falls to 1/e, for a kinematic viscosity in m2/s. n from 2.
/// [`lamb_damping_time`] is the same in f64.
#[inline]
#[must_use]
pub fn drop_oscillation_damping_time(n: u32, radius: f32, viscosity: f32) -> f32 {
    let m = n as f32;
    radius * radius / ((m - 1.0) * (2.0 * m + 1.0) * viscosity)
}

/// Converts rad/s to units of 2^-16 Hz, rounded down.
#[inline]
#[must_use]
pub fn drop_oscillation_frequency(angular_frequency: f32) -> u32 {
    let units = angular_frequency * DROP_OSCILLATION_UNITS_PER_RADIAN;
    units.clamp(0.0, DROP_OSCILLATION_MAX_FREQUENCY) as u32
}

/// Phases of both modes at time 0, in turns of [0, 1), derived from the drop's id.
///
/// ```
/// use downpour_drop::oscillation::drop_oscillation_phase;
/// use downpour_math::rng::seed_words;
/// let phase = drop_oscillation_phase(seed_words(7), 42);
/// assert!(phase.iter().all(|p| (0.0..1.0).contains(p)));
/// ```
#[inline]
#[must_use]
pub fn drop_oscillation_phase(seed: [u32; 2], id: u32) -> [f32; 2] {
    let [x, y, ..] = rng_draw(seed, id, 0, DROP_OSCILLATION_DIMENSION);
    [rng_unit(x), rng_unit(y)]
}

/// Azimuth of phi = 0 about the vertical axis in turns of [0, 1), derived from the drop's id.
#[inline]
#[must_use]
pub fn drop_oscillation_azimuth(seed: [u32; 2], id: u32) -> f32 {
    let [_, _, z, _] = rng_draw(seed, id, 0, DROP_OSCILLATION_DIMENSION);
    rng_unit(z)
}

/// Phase of one mode at a time, in turns; it may include whole turns.
#[inline]
#[must_use]
pub fn drop_oscillation_turns(frequency: u32, phase: f32, time: DropOscillationTime) -> f32 {
    let counted = (frequency.wrapping_mul(time.ticks) >> 8) as f32 * DROP_OSCILLATION_TURN_STEP;
    counted + phase + frequency as f32 * DROP_OSCILLATION_TICK * time.offset
}

/// Sine of an angle in turns.
#[inline]
#[must_use]
pub fn drop_oscillation_sine(turns: f32) -> f32 {
    ops::sin(DROP_OSCILLATION_TURN * (turns - (turns + 0.5).floor()))
}

/// (s2, s3) at a time; `age`: seconds since the disturbance from which damping counts.
#[inline]
#[must_use]
pub fn drop_oscillation_displacement(
    oscillation: DropOscillation,
    time: DropOscillationTime,
    age: f32,
) -> [f32; 2] {
    let since = age.max(0.0);
    let DropOscillation { amplitude, damping, phase, frequency } = oscillation;
    let turns_2 = drop_oscillation_turns(frequency[0], phase[0], time);
    let turns_3 = drop_oscillation_turns(frequency[1], phase[1], time);
    [
        amplitude[0] * ops::exp(-(since * damping[0])) * drop_oscillation_sine(turns_2),
        amplitude[1] * ops::exp(-(since * damping[1])) * drop_oscillation_sine(turns_3),
    ]
}

/// Volume of equation 2 over that of the sphere, exactly:
/// `1 + 3/5 s2^2 + 2/35 s2^3 + 18/7 s3^2 + 18/35 s2 s3^2`.
///
/// It is the mean over the sphere of `(1 + a + b cos(phi))^3`, with `a = s2 P20` and `b = s3 P31`: over phi
/// `(1 + a)^3 + 3/2 (1 + a) b^2`, then a polynomial in x.
#[inline(always)]
#[must_use]
pub fn drop_oscillation_volume<R: Real>([s2, s3]: [R; 2]) -> R {
    let c = |value: f64| s2.constant(value);
    c(1.0) + (s2 * s2 * (c(3.0 / 5.0) + c(2.0 / 35.0) * s2) + s3 * s3 * (c(18.0 / 7.0) + c(18.0 / 35.0) * s2))
}

/// `V^(-1/3)` for V in 1 to 1.4, by five steps of Newton's method for `y^-3 = V` from y = 1.
#[inline(always)]
#[must_use]
pub fn drop_oscillation_inverse_cube_root<R: Real>(volume: R) -> R {
    let (four, third) = (volume.constant(4.0), volume.constant(1.0 / 3.0));
    let y1 = (four - volume) * third;
    let y2 = y1 * (four - volume * y1 * y1 * y1) * third;
    let y3 = y2 * (four - volume * y2 * y2 * y2) * third;
    let y4 = y3 * (four - volume * y3 * y3 * y3) * third;
    y4 * (four - volume * y4 * y4 * y4) * third
}

/// Coefficients of the radius, computed once per drop and time: `[s2, s3, V^(-1/3)]`.
#[inline(always)]
#[must_use]
pub fn drop_oscillation_state<R: Real>(displacement: [R; 2]) -> [R; 3] {
    let scale = drop_oscillation_inverse_cube_root(drop_oscillation_volume(displacement));
    [displacement[0], displacement[1], scale]
}

/// The same for equation 2 as printed: the volume varies with the oscillation.
#[inline(always)]
#[must_use]
pub fn drop_oscillation_state_rousseau_2008<R: Real>(displacement: [R; 2]) -> [R; 3] {
    [displacement[0], displacement[1], displacement[0].constant(1.0)]
}

/// r / r0 in the direction with `x = cos(theta)`.
#[inline(always)]
#[must_use]
pub fn drop_oscillation_radius<R: Real>(state: [R; 3], x: R, cos_phi: R) -> R {
    let even = x.constant(1.0) + state[0] * drop_oscillation_legendre_20(x);
    (even + state[1] * drop_oscillation_legendre_31(x) * cos_phi) * state[2]
}

/// r / r0 on the left (phi) and right (phi + pi) outline of a drop seen from the side, at theta = pi / 2.
#[inline(always)]
#[must_use]
pub fn drop_oscillation_outline<R: Real>(state: [R; 3], cos_phi: R) -> [R; 2] {
    let even = cos_phi.constant(1.0) - cos_phi.constant(0.5) * state[0];
    let odd = cos_phi.constant(1.5) * state[1] * cos_phi;
    [(even + odd) * state[2], (even - odd) * state[2]]
}
