//! Oscillation of one drop in time.

use downpour_math::OutOfRange;
use std::f64::consts::TAU;

use downpour_math::ops;

use super::{DropOscillation, Fluids, FrequencyLaw, drop_oscillation_phase, lamb_damping_time};
use crate::DropError;
use crate::shape::check_diameter;

/// Amplitudes of the modes (2,0) and (3,1): displacement of the surface over r0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Amplitudes {
    a20: f64,
    a31: f64,
}

impl Amplitudes {
    /// A drop at rest.
    pub const NONE: Self = Self { a20: 0.0, a31: 0.0 };
    /// The first pair of Garg & Nayar 2006 and Rousseau et al. 2008: (0.1, 0.1).
    pub const GARG_NAYAR_EVEN: Self = Self { a20: 0.1, a31: 0.1 };
    /// Their second pair, with a stronger oblate-prolate mode: (0.2, 0.1).
    pub const GARG_NAYAR_OBLATE: Self = Self { a20: 0.2, a31: 0.1 };

    /// Creates a pair of amplitudes.
    ///
    /// # Errors
    /// [`DropError::OutOfRange`] if one is not 0 to 0.3. (P31 reaches 2.07: an amplitude of 0.3 moves the surface by
    /// 62 % of r0.)
    pub fn new(a20: f64, a31: f64) -> Result<Self, DropError> {
        for (quantity, found) in [("amplitude of mode (2,0)", a20), ("amplitude of mode (3,1)", a31)] {
            if !(0.0..=0.3).contains(&found) {
                let (unit, allowed) = ("of the radius", "0 to 0.3");
                return Err(DropError::OutOfRange(OutOfRange {
                    quantity,
                    found,
                    unit,
                    allowed: allowed.into(),
                }));
            }
        }
        Ok(Self { a20, a31 })
    }

    /// [A20, A31].
    #[must_use]
    pub fn pair(&self) -> [f64; 2] {
        [self.a20, self.a31]
    }
}

/// Oscillation of one drop. Pairs hold the modes (2,0) and (3,1).
///
/// It is undamped by default, as that of a falling drop, which the air keeps exciting; [`Oscillation::damped`]
/// is for a drop that was disturbed once.
///
/// ```
/// use downpour_drop::oscillation::{Amplitudes, Fluids, FrequencyLaw, Oscillation};
/// use downpour_math::rng::seed_words;
/// let oscillation = Oscillation::new(
///     2.0e-3,
///     Amplitudes::GARG_NAYAR_OBLATE,
///     &Fluids::AT_20_C,
///     FrequencyLaw::Rayleigh1879,
/// )?
/// .of_drop(seed_words(7), 42);
/// let [s2, s3] = oscillation.displacement(12.5, 0.0);
/// assert!(s2.abs() <= 0.2 && s3.abs() <= 0.1);
/// # Ok::<(), downpour_drop::DropError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Oscillation {
    amplitudes: Amplitudes,
    frequency: [f64; 2],
    damping_time: [f64; 2],
    phase: [f64; 2],
    is_damped: bool,
}

impl Oscillation {
    /// Creates the oscillation of a drop of this diameter, with phases of 0.
    ///
    /// # Errors
    /// [`DropError::OutOfRange`] if the diameter is not 0.05 to 9 mm (a smaller drop is at rest within 0.2 ms, and its
    /// frequencies exceed the integers of the shader), or a property of the fluids is far from any liquid's.
    pub fn new(
        diameter_m: f64,
        amplitudes: Amplitudes,
        fluids: &Fluids,
        law: FrequencyLaw,
    ) -> Result<Self, DropError> {
        check_diameter(diameter_m, 0.05e-3..=9.0e-3, "0.05 to 9")?;
        let frequency = [law.frequency(2, diameter_m, fluids)?, law.frequency(3, diameter_m, fluids)?];
        let damping_time =
            [lamb_damping_time(2, diameter_m, fluids)?, lamb_damping_time(3, diameter_m, fluids)?];
        if frequency[1] >= 65536.0 {
            let (quantity, unit, allowed) = ("frequency of mode (3,1)", "Hz", "below 65536");
            return Err(DropError::OutOfRange(OutOfRange {
                quantity,
                found: frequency[1],
                unit,
                allowed: allowed.into(),
            }));
        }
        Ok(Self { amplitudes, frequency, damping_time, phase: [0.0; 2], is_damped: false })
    }

    /// The same oscillation with phases derived from a drop's id.
    #[must_use]
    pub fn of_drop(self, seed: [u32; 2], id: u32) -> Self {
        Self { phase: drop_oscillation_phase(seed, id).map(f64::from), ..self }
    }

    /// The same oscillation with these phases, in turns. A phase that is not finite counts as 0.
    #[must_use]
    pub fn with_phases(self, turns: [f64; 2]) -> Self {
        let phase = turns.map(|p| if p.is_finite() { p.rem_euclid(1.0) } else { 0.0 });
        Self { phase, ..self }
    }

    /// The same oscillation, damped by viscosity.
    #[must_use]
    pub fn damped(self) -> Self {
        Self { is_damped: true, ..self }
    }

    /// Amplitudes at age 0.
    #[must_use]
    pub fn amplitudes(&self) -> Amplitudes {
        self.amplitudes
    }

    /// Frequencies in Hz.
    #[must_use]
    pub fn frequency(&self) -> [f64; 2] {
        self.frequency
    }

    /// Lamb's damping times in s, also of an undamped oscillation.
    #[must_use]
    pub fn damping_time(&self) -> [f64; 2] {
        self.damping_time
    }

    /// Phases at time 0, in turns.
    #[must_use]
    pub fn phase(&self) -> [f64; 2] {
        self.phase
    }

    /// (s2, s3) at a time in s; `age` is the time in s since the disturbance from which damping counts, and has no
    /// effect on an undamped oscillation.
    #[must_use]
    pub fn displacement(&self, time: f64, age: f64) -> [f64; 2] {
        let amplitudes = self.amplitudes.pair();
        std::array::from_fn(|mode| {
            let turns = (self.frequency[mode] * time).rem_euclid(1.0) + self.phase[mode];
            let left =
                if self.is_damped { ops::f64::exp(-age.max(0.0) / self.damping_time[mode]) } else { 1.0 };
            amplitudes[mode] * left * ops::f64::sin(TAU * turns.fract())
        })
    }

    /// Converts the oscillation for a shader. Frequencies are rounded to 2^-16 Hz.
    #[must_use]
    pub fn gpu(&self) -> DropOscillation {
        DropOscillation {
            amplitude: self.amplitudes.pair().map(|a| a as f32),
            damping: if self.is_damped { self.damping_time.map(|tau| (1.0 / tau) as f32) } else { [0.0; 2] },
            phase: self.phase.map(|p| p as f32),
            frequency: self.frequency.map(|f| (f * 65536.0).round() as u32),
        }
    }
}
