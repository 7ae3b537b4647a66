//! Wind over time: primitives, gusts, turbulence.

use glam::DVec3;

use crate::design::WindPrimitive;
use crate::error::WindError;
use crate::field::WindField;
use crate::grid::WindGrid;
use crate::gusts::Gusts;
use crate::mask::WindMask;
use crate::part::{WindPart, uniform};
use crate::timeline::{Keyed, WIND_KEYS, sort_times};
use crate::turbulence::{Turbulence, WindTurbulenceMode};
use crate::uniform::UniformWind;

/// Maximum number of parts of a wind.
pub const WIND_PARTS: usize = 1024;

/// Wind over time, in range at all times.
///
/// ```
/// use downpour_wind::{Gusts, Keyed, Wind, WindPart};
/// use glam::DVec3;
///
/// // It freshens from 3 to 12 m/s within ten seconds, and gusts.
/// let speed = Keyed::new(vec![(0.0, 3.0), (10.0, 12.0)])?;
/// let part = WindPart::uniform(&speed, &DVec3::X.into())?;
/// let wind = Wind::new(vec![part], Some(Gusts::default()), None)?;
/// let air = wind.uniform().expect("no primitive that differs from position to position");
/// let drop = air.followed(7.5, 0.66);
/// assert!((drop.velocity - air.velocity(7.5)).length() > 0.1, "a drop of 2 mm lags behind");
/// # Ok::<(), downpour_wind::WindError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Wind {
    parts: Vec<WindPart>,
    gusts: Option<Gusts>,
    turbulence: Option<Turbulence>,
    /// Uniform parts and gusts.
    air: UniformWind,
}

impl Default for Wind {
    /// Still air.
    fn default() -> Self {
        Self {
            parts: Vec::new(),
            gusts: None,
            turbulence: None,
            air: UniformWind::new(&DVec3::ZERO.into(), None),
        }
    }
}

impl Wind {
    /// Creates the sum of parts, with gusts of its uniform wind and turbulence that its uniform wind carries.
    ///
    /// # Errors
    /// [`WindError::TooManyParts`]; [`WindError::KeyCount`] if the uniform parts have more than
    /// [`WIND_KEYS`] different times of keys together; else the error of the first parameter that is out of its range
    /// at some key, or of an axis that reverses.
    pub fn new(
        parts: Vec<WindPart>,
        gusts: Option<Gusts>,
        turbulence: Option<Turbulence>,
    ) -> Result<Self, WindError> {
        if parts.len() > WIND_PARTS {
            return Err(WindError::TooManyParts { found: parts.len(), allowed: WIND_PARTS });
        }
        gusts.as_ref().map_or(Ok(()), Gusts::check)?;
        turbulence.as_ref().map_or(Ok(()), Turbulence::check)?;
        let parts = parts.into_iter().map(WindPart::checked).collect::<Result<Vec<_>, _>>()?;
        let air = UniformWind::new(&mean(&parts)?, gusts.as_ref());
        Ok(Self { parts, gusts, turbulence, air })
    }

    /// Primitives at a time, s, all in range. Gusts come last, as a uniform wind of 200 m/s at most.
    #[must_use]
    pub fn at(&self, time_s: f64) -> Vec<WindPrimitive> {
        let mut primitives: Vec<WindPrimitive> = self.parts.iter().map(|part| part.at(time_s)).collect();
        if self.gusts.is_some() {
            let gust = self.air.velocity(time_s) - self.air.mean(time_s);
            primitives.push(WindPrimitive::Uniform(uniform(gust)));
        }
        primitives
    }

    /// Modes of turbulence that a grid resolves at a time, s: see [`Turbulence::modes`].
    #[must_use]
    pub fn modes(&self, time_s: f64, grid: &WindGrid) -> Vec<WindTurbulenceMode> {
        let carried = self.air.mean_displacement(time_s);
        self.turbulence.map_or_else(Vec::new, |turbulence| turbulence.modes(grid, carried))
    }

    /// Field over a grid at a time, s.
    ///
    /// # Errors
    /// [`WindError::MaskSize`] if the mask does not match the grid.
    pub fn field(&self, time_s: f64, grid: &WindGrid, mask: &WindMask) -> Result<WindField, WindError> {
        WindField::with_turbulence(grid, &self.at(time_s), &self.modes(time_s, grid), mask)
    }

    /// The wind as a uniform wind, if it has uniform parts and gusts only, or is still air.
    #[must_use]
    pub fn uniform(&self) -> Option<UniformWind> {
        let even = self.parts.iter().all(|part| matches!(part, WindPart::Uniform(_)));
        (even && self.turbulence.is_none()).then(|| self.air.clone())
    }

    /// Uniform parts and gusts, without the other parts.
    #[must_use]
    pub fn air(&self) -> &UniformWind {
        &self.air
    }

    /// True if there are no parts and no turbulence.
    #[must_use]
    pub fn is_still(&self) -> bool {
        self.parts.is_empty() && self.turbulence.is_none()
    }

    /// Parts; their axes have length 1 at each key.
    #[must_use]
    pub fn parts(&self) -> &[WindPart] {
        &self.parts
    }

    /// Gusts of the uniform wind.
    #[must_use]
    pub fn gusts(&self) -> Option<&Gusts> {
        self.gusts.as_ref()
    }

    /// Turbulence.
    #[must_use]
    pub fn turbulence(&self) -> Option<&Turbulence> {
        self.turbulence.as_ref()
    }
}

/// Sum of the uniform parts.
fn mean(parts: &[WindPart]) -> Result<Keyed<DVec3>, WindError> {
    let uniform: Vec<&Keyed<DVec3>> = parts
        .iter()
        .filter_map(|part| if let WindPart::Uniform(velocity) = part { Some(velocity) } else { None })
        .collect();
    let mut times = Vec::new();
    uniform.iter().for_each(|velocity| velocity.times(&mut times));
    sort_times(&mut times);
    let sum = |time: f64| uniform.iter().map(|velocity| velocity.at(time)).sum();
    if times.is_empty() {
        return Ok(Keyed::from(sum(0.0)));
    }
    // The count is checked before the parts are summed.
    if times.len() > WIND_KEYS {
        return Err(WindError::KeyCount { found: times.len(), allowed: WIND_KEYS });
    }
    Keyed::new(times.into_iter().map(|time| (time, sum(time))).collect())
}
