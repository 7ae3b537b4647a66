//! Relaxation of a drop to its terminal speed, and the dimensionless numbers of its flow.
//!
//! Law: quadratic drag, `dv/dt = g - g |u| u / v_t^2` with u the slip between drop and air. About the steady
//! fall this relaxes with `v_t / (2g)` along the fall and `v_t / g` across it; from rest, after a fall of z,
//! `v = v_t sqrt(1 - exp(-2 g z / v_t^2))`, and after a time t, `v = v_t tanh(g t / v_t)`.

use downpour_math::OutOfRange;
use downpour_math::ops::f64 as ops;
use downpour_shaders::drop::fall_speed::FALL_SPEED_GRAVITY;

use super::{FallSpeedModel, terminal_speed};
use crate::DropError;
use crate::air::{Air, STANDARD_GRAVITY};

/// Relaxation times of the slip between a falling drop and the air, in seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relaxation {
    /// Along the fall: v / (2g).
    pub vertical_s: f64,
    /// Across the fall, as toward a wind: v / g.
    pub horizontal_s: f64,
}

/// Relaxation times of a drop whose terminal speed is `speed_m_s`.
///
/// ```
/// let r = downpour_drop::fall_speed::relaxation(6.49);
/// assert!((r.vertical_s - 0.33).abs() < 0.005 && (r.horizontal_s - 0.66).abs() < 0.005);
/// ```
#[must_use]
pub fn relaxation(speed_m_s: f64) -> Relaxation {
    let horizontal_s = speed_m_s / STANDARD_GRAVITY;
    Relaxation { vertical_s: 0.5 * horizontal_s, horizontal_s }
}

/// Relaxation times of the slip, in seconds: along the fall, and across it.
#[must_use]
pub fn fall_speed_relaxation(speed: f32) -> [f32; 2] {
    let across = speed / FALL_SPEED_GRAVITY;
    [0.5 * across, across]
}

/// Distance in meters that a drop of terminal speed `terminal_m_s` falls from rest until it has a `fraction` of that
/// speed.
///
/// ```
/// let z = downpour_drop::fall_speed::distance_to_fraction(6.49, 0.99)?;
/// assert!((z - 8.4).abs() < 0.05);
/// # Ok::<(), downpour_drop::DropError>(())
/// ```
///
/// # Errors
/// [`DropError::OutOfRange`] if the fraction is not at least 0 and below 1.
pub fn distance_to_fraction(terminal_m_s: f64, fraction: f64) -> Result<f64, DropError> {
    let fraction = checked_fraction(fraction)?;
    Ok(-terminal_m_s * terminal_m_s / (2.0 * STANDARD_GRAVITY) * ops::ln_1p(-fraction * fraction))
}

/// Time in seconds that a drop of terminal speed `terminal_m_s` falls from rest until it has a `fraction` of that
/// speed.
///
/// # Errors
/// [`DropError::OutOfRange`] if the fraction is not at least 0 and below 1.
pub fn time_to_fraction(terminal_m_s: f64, fraction: f64) -> Result<f64, DropError> {
    let fraction = checked_fraction(fraction)?;
    Ok(0.5 * terminal_m_s / STANDARD_GRAVITY * (ops::ln_1p(fraction) - ops::ln_1p(-fraction)))
}

/// Speed in m/s of a drop of terminal speed `terminal_m_s` that fell `distance_m` meters from rest.
#[must_use]
pub fn speed_after_fall(terminal_m_s: f64, distance_m: f64) -> f64 {
    if terminal_m_s <= 0.0 {
        return 0.0;
    }
    let exponent = -2.0 * STANDARD_GRAVITY * distance_m.max(0.0) / (terminal_m_s * terminal_m_s);
    terminal_m_s * (-ops::exp_m1(exponent)).sqrt()
}

/// Distance in m that a drop of terminal speed `terminal_m_s` has fallen from rest after `time_s` seconds, and its speed in
/// m/s: `v^2 / g ln cosh(g t / v)` and `v tanh(g t / v)`.
///
/// ```
/// let [distance, speed] = downpour_drop::fall_speed::fall_from_rest(9.0, 0.5);
/// assert!((distance - 1.170).abs() < 1.0e-3 && (speed - 4.470).abs() < 1.0e-3);
/// ```
#[must_use]
pub fn fall_from_rest(terminal_m_s: f64, time_s: f64) -> [f64; 2] {
    if terminal_m_s <= 0.0 || time_s <= 0.0 {
        return [0.0; 2];
    }
    let x = STANDARD_GRAVITY * time_s / terminal_m_s;
    // ln cosh x = x + ln((1 + exp(-2x)) / 2), whose digits are lost where x is small.
    let ln_cosh = if x < 1.0e-2 {
        x * x * (0.5 - x * x / 12.0)
    } else {
        x + ops::ln_1p(ops::exp(-2.0 * x)) - std::f64::consts::LN_2
    };
    [terminal_m_s * terminal_m_s / STANDARD_GRAVITY * ln_cosh, terminal_m_s * ops::tanh(x)]
}

/// Time in s in which a drop of terminal speed `terminal_m_s` falls `distance_m` meters from rest:
/// `v / g arcosh(exp(g y / v^2))`; infinite for a speed of 0.
#[must_use]
pub fn time_of_fall(terminal_m_s: f64, distance_m: f64) -> f64 {
    if distance_m <= 0.0 {
        return 0.0;
    }
    if terminal_m_s <= 0.0 {
        return f64::INFINITY;
    }
    let a = STANDARD_GRAVITY * distance_m / (terminal_m_s * terminal_m_s);
    // arcosh(exp a) = a + ln(1 + sqrt(1 - exp(-2a))).
    terminal_m_s / STANDARD_GRAVITY * (a + ops::ln_1p((-ops::exp_m1(-2.0 * a)).sqrt()))
}

fn checked_fraction(fraction: f64) -> Result<f64, DropError> {
    if (0.0..1.0).contains(&fraction) {
        return Ok(fraction);
    }
    let quantity = "fraction of the terminal speed";
    Err(DropError::OutOfRange(OutOfRange {
        quantity,
        found: fraction,
        unit: "",
        allowed: "at least 0, below 1".into(),
    }))
}

/// Dimensionless numbers of the flow around a drop at its terminal speed v, with d the diameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FallNumbers {
    /// Terminal speed v in m/s.
    pub speed_m_s: f64,
    /// Reynolds number, inertia to viscosity of the air: rho v d / eta.
    pub reynolds: f64,
    /// Weber number, inertia of the air to surface tension: rho v^2 d / sigma. (A splash uses the density of water.)
    pub weber: f64,
    /// Bond number, weight to surface tension: `(rho_w - rho) g d^2 / sigma`. (Beard's Bo is 4/3 of it.)
    pub bond: f64,
    /// Drag coefficient on the cross-section of the sphere of equal volume: `4 (rho_w - rho) g d / (3 rho v^2)`.
    pub drag_coefficient: f64,
}

/// Numbers of the flow around a drop of `diameter_m` meters that falls in `air`.
///
/// ```
/// use downpour_drop::air::Air;
/// use downpour_drop::fall_speed::{FallSpeedModel, fall_numbers};
/// let n = fall_numbers(FallSpeedModel::Beard1976, 2.0e-3, &Air::standard())?;
/// assert!((n.reynolds - 863.0).abs() < 1.0 && (n.drag_coefficient - 0.51).abs() < 0.01);
/// # Ok::<(), downpour_drop::DropError>(())
/// ```
///
/// # Errors
/// [`DropError::OutOfRange`] if the diameter is not above 0 and at most 9 mm. Where a fit gives no speed, the drag
/// coefficient is infinite.
pub fn fall_numbers(model: FallSpeedModel, diameter_m: f64, air: &Air) -> Result<FallNumbers, DropError> {
    let v = terminal_speed(model, diameter_m, air)?;
    let (rho, eta, sigma) = (air.density(), air.viscosity(), air.water_surface_tension());
    let weight = (air.water_density() - rho) * STANDARD_GRAVITY;
    Ok(FallNumbers {
        speed_m_s: v,
        reynolds: rho * v * diameter_m / eta,
        weber: rho * v * v * diameter_m / sigma,
        bond: weight * diameter_m * diameter_m / sigma,
        drag_coefficient: 4.0 * weight * diameter_m / (3.0 * rho * v * v),
    })
}
