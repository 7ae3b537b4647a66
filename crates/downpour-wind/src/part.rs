//! Primitives with parameters over time.

use downpour_math::in_range;
use glam::{DVec3, Vec3};

use crate::design::{WindCore, WindForm, WindPrimitive, WindSingularity, WindTornado, WindUniform};
use crate::error::WindError;
use crate::timeline::{Keyed, sort_times};

/// Maximum speed of the uniform wind, m/s.
const MAX_SPEED_M_S: f64 = 200.0;

/// A source, sink or vortex over time; units and ranges as in [`WindSingularity`].
#[derive(Clone, Debug, PartialEq)]
pub struct KeyedSingularity {
    /// Line or point.
    pub form: WindForm,
    /// Core of a line form.
    pub core: WindCore,
    /// Strength, m^2/s (line) or m^3/s (point).
    pub strength: Keyed<f64>,
    /// A point of the axis, or the point of a point form, m.
    pub center: Keyed<DVec3>,
    /// Axis; its keys have any length, and it rotates between keys by the shorter way.
    pub axis: Keyed<DVec3>,
    /// Core radius, m.
    pub core_radius: Keyed<f64>,
}

/// A tornado over time; units and ranges as in [`WindTornado`].
#[derive(Clone, Debug, PartialEq)]
pub struct KeyedTornado {
    /// Circulation, m^2/s.
    pub circulation: Keyed<f64>,
    /// Discharge in at the base and out at the top, m^3/s.
    pub discharge: Keyed<f64>,
    /// Center of the base, m.
    pub base: Keyed<DVec3>,
    /// Axis from base to top; its keys have any length.
    pub axis: Keyed<DVec3>,
    /// Height from base to top, m.
    pub height: Keyed<f64>,
    /// Core radius, m.
    pub core_radius: Keyed<f64>,
}

/// A primitive over time.
///
/// Numbers, positions and the velocity of a uniform wind are linear between their keys. Axes are interpolated along
/// straight lines between unit vectors and normalized again: the axis rotates in the plane of the two keys. A uniform
/// wind is keyed as a velocity, not as a speed with a direction, so between two keys its tip moves on a straight line:
/// a wind that reverses passes through calm, and one that keeps its speed while it rotates needs a key every few
/// degrees.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum WindPart {
    /// Uniform wind: its velocity, up to 200 m/s.
    Uniform(Keyed<DVec3>),
    /// Wind out of a line or a point.
    Source(KeyedSingularity),
    /// Wind into a line or a point.
    Sink(KeyedSingularity),
    /// Wind around an axis.
    Vortex(KeyedSingularity),
    /// Sink, source, vortex and updraft of a tornado.
    Tornado(KeyedTornado),
}

impl From<WindPrimitive> for WindPart {
    /// Converts a primitive to a constant part.
    fn from(primitive: WindPrimitive) -> Self {
        let single = |at: WindSingularity| KeyedSingularity {
            form: at.form,
            core: at.core,
            strength: f64::from(at.strength).into(),
            center: at.center.as_dvec3().into(),
            axis: at.axis.as_dvec3().into(),
            core_radius: f64::from(at.core_radius).into(),
        };
        match primitive {
            WindPrimitive::Uniform(wind) => {
                // An undefined direction becomes NaN, which the check finds.
                let direction = wind.direction.as_dvec3().try_normalize().unwrap_or(DVec3::NAN);
                Self::Uniform((direction * f64::from(wind.speed)).into())
            }
            WindPrimitive::Source(at) => Self::Source(single(at)),
            WindPrimitive::Sink(at) => Self::Sink(single(at)),
            WindPrimitive::Vortex(at) => Self::Vortex(single(at)),
            WindPrimitive::Tornado(tornado) => Self::Tornado(KeyedTornado {
                circulation: f64::from(tornado.circulation).into(),
                discharge: f64::from(tornado.discharge).into(),
                base: tornado.base.as_dvec3().into(),
                axis: tornado.axis.as_dvec3().into(),
                height: f64::from(tornado.height).into(),
                core_radius: f64::from(tornado.core_radius).into(),
            }),
        }
    }
}

impl WindPart {
    /// Creates a uniform wind of a speed, m/s, toward a direction. The velocity has the keys of both.
    ///
    /// # Errors
    /// [`WindError::ZeroAxis`] for an undefined direction; a speed is checked by [`Wind::new`](crate::Wind::new).
    pub fn uniform(speed: &Keyed<f64>, direction: &Keyed<DVec3>) -> Result<Self, WindError> {
        for &(_, vector) in direction.keys() {
            if !(1.0e-3..=1.0e9).contains(&vector.length()) {
                let found = vector.as_vec3().to_array();
                return Err(WindError::ZeroAxis { quantity: "direction of the wind", found });
            }
        }
        // A direction that reverses may be undefined at one time.
        let velocity = speed.with(direction, |speed, towards| towards.normalize_or_zero() * speed);
        Ok(Self::Uniform(velocity))
    }

    /// The primitive at a time, s. Axes have length 1.
    #[must_use]
    pub fn at(&self, time_s: f64) -> WindPrimitive {
        match self {
            Self::Uniform(velocity) => WindPrimitive::Uniform(uniform(velocity.at(time_s))),
            Self::Source(part) => WindPrimitive::Source(part.at(time_s)),
            Self::Sink(part) => WindPrimitive::Sink(part.at(time_s)),
            Self::Vortex(part) => WindPrimitive::Vortex(part.at(time_s)),
            Self::Tornado(part) => WindPrimitive::Tornado(part.at(time_s)),
        }
    }

    /// Minimum core radius at any time, m; `None` for a uniform wind.
    #[must_use]
    pub fn min_core_radius(&self) -> Option<f64> {
        let radius = match self {
            Self::Uniform(_) => return None,
            Self::Source(part) | Self::Sink(part) | Self::Vortex(part) => &part.core_radius,
            Self::Tornado(part) => &part.core_radius,
        };
        radius.keys().iter().map(|&(_, radius)| radius).reduce(f64::min)
    }

    /// Returns the part with axes of length 1, if it is in range at all times.
    ///
    /// All ranges are convex and all values are linear between keys, so a part that is in range at each key is always
    /// in range.
    pub(crate) fn checked(mut self) -> Result<Self, WindError> {
        let mut times = vec![0.0];
        match &mut self {
            Self::Uniform(velocity) => {
                for &(_, v) in velocity.keys() {
                    // Length of a rounded vector.
                    let speeds = 0.0..=MAX_SPEED_M_S * (1.0 + 1.0e-9);
                    in_range("wind speed", v.length(), "m/s", &speeds, 1.0, "0 to 200")?;
                }
                return Ok(self);
            }
            Self::Source(part) | Self::Sink(part) | Self::Vortex(part) => {
                part.axis = part.axis.directions("axis")?;
                part.strength.times(&mut times);
                part.center.times(&mut times);
                part.core_radius.times(&mut times);
            }
            Self::Tornado(part) => {
                part.axis = part.axis.directions("axis")?;
                for number in [&part.circulation, &part.discharge, &part.height, &part.core_radius] {
                    number.times(&mut times);
                }
                part.base.times(&mut times);
            }
        }
        sort_times(&mut times);
        times.into_iter().try_for_each(|time| self.at(time).check())?;
        Ok(self)
    }
}

impl KeyedSingularity {
    fn at(&self, time_s: f64) -> WindSingularity {
        WindSingularity {
            form: self.form,
            strength: self.strength.at(time_s) as f32,
            center: self.center.at(time_s).as_vec3(),
            axis: axis(self.axis.at(time_s)),
            core_radius: self.core_radius.at(time_s) as f32,
            core: self.core,
        }
    }
}

impl KeyedTornado {
    fn at(&self, time_s: f64) -> WindTornado {
        WindTornado {
            circulation: self.circulation.at(time_s) as f32,
            discharge: self.discharge.at(time_s) as f32,
            base: self.base.at(time_s).as_vec3(),
            axis: axis(self.axis.at(time_s)),
            height: self.height.at(time_s) as f32,
            core_radius: self.core_radius.at(time_s) as f32,
        }
    }
}

/// Returns the vector with length 1; still air gets an arbitrary direction.
fn axis(vector: DVec3) -> Vec3 {
    vector.try_normalize().unwrap_or(DVec3::X).as_vec3()
}

/// Converts a velocity to a primitive, 200 m/s at most.
pub(crate) fn uniform(velocity: DVec3) -> WindUniform {
    WindUniform { speed: velocity.length().min(MAX_SPEED_M_S) as f32, direction: axis(velocity) }
}
