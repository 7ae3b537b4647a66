//! Wind primitives as a user designs them.

use downpour_math::in_range;
use glam::Vec3;

use crate::error::WindError;

/// Spatial form of a source, sink or vortex.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WindForm {
    /// The same at every height along the axis, with a speed proportional to 1 / r (the printed formulas of Rousseau
    /// 2008).
    #[default]
    Line,
    /// Around one point, with a speed proportional to 1 / r^2 (the text of Rousseau 2008: "in all directions from this
    /// point").
    Point,
}

/// Core of a line form, which keeps the speed finite at its axis. Point forms have Rosenhead's core. The formulas are
/// in [`primitive`](crate::primitive).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WindCore {
    /// r / (r^2 + e^2): smooth, fastest at the core radius with half of the peak of Rankine's.
    #[default]
    Rosenhead,
    /// Solid-body rotation within the core radius; unchanged beyond it.
    Rankine,
    /// Normal distribution of vorticity or divergence, as viscosity spreads a line.
    LambOseen,
}

impl WindCore {
    /// All cores.
    pub const ALL: [Self; 3] = [Self::Rosenhead, Self::Rankine, Self::LambOseen];

    /// Name in files and arguments.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Rosenhead => "rosenhead",
            Self::Rankine => "rankine",
            Self::LambOseen => "lamb-oseen",
        }
    }

    /// Returns the core of a name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|core| core.name() == name)
    }
}

/// Uniform wind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindUniform {
    /// Speed, 0 to 200 m/s.
    pub speed: f32,
    /// Direction toward which the wind blows; any length.
    pub direction: Vec3,
}

/// A source, sink or vortex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindSingularity {
    /// Line or point.
    pub form: WindForm,
    /// Strength: m^2/s for a line (flow per length, or circulation), m^3/s for a point (flow, or circulation times
    /// length). 0 to 1e6 for sources and sinks; a vortex may be negative, and is right-handed about its axis if it is
    /// positive.
    pub strength: f32,
    /// A point of the axis, or the point of a point form. Meters, up to 1e6.
    pub center: Vec3,
    /// Axis; any length. A point source or sink has the same wind for every axis.
    pub axis: Vec3,
    /// Core radius, 0.01 to 1e4 m. At least two cells of a grid that has to resolve it.
    pub core_radius: f32,
    /// Core of a line form; points have Rosenhead's.
    pub core: WindCore,
}

/// A sink at the base, a source at the top, a vortex about the axis (Rousseau 2008, 3.1), and the updraft that carries
/// the air from the base to the top.
///
/// As line forms, sink and source would cancel; as point forms alone, the air would flow down from the source to the
/// sink.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindTornado {
    /// Circulation of the vortex, m^2/s, up to 1e6; right-handed about the axis if it is positive.
    pub circulation: f32,
    /// Discharge in at the base and out at the top, 0 to 1e6 m^3/s.
    pub discharge: f32,
    /// Center of the base. Meters, up to 1e6.
    pub base: Vec3,
    /// Axis from base to top; any length.
    pub axis: Vec3,
    /// Height from base to top, 2 core radii to 1e5 m.
    pub height: f32,
    /// Core radius, 0.01 to 1e4 m.
    pub core_radius: f32,
}

/// One of the five primitives of Rousseau 2008, 3.1.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum WindPrimitive {
    /// Constant wind.
    Uniform(WindUniform),
    /// Wind out of a line or a point.
    Source(WindSingularity),
    /// Wind into a line or a point.
    Sink(WindSingularity),
    /// Wind around an axis.
    Vortex(WindSingularity),
    /// Sink, source, vortex and updraft of a tornado.
    Tornado(WindTornado),
}

impl WindPrimitive {
    /// Checks that every number is in its range.
    ///
    /// # Errors
    /// [`WindError::OutOfRange`] or [`WindError::ZeroAxis`] for the first number that is not; [`WindError::CoreOfPoint`].
    pub fn check(&self) -> Result<(), WindError> {
        match self {
            Self::Uniform(wind) => {
                in_range("wind speed", wind.speed, "m/s", &(0.0..=200.0), 1.0, "0 to 200")?;
                unit("direction of the wind", wind.direction).map(|_| ())
            }
            Self::Source(at) | Self::Sink(at) => at.check(0.0, "0 to 1e6"),
            Self::Vortex(at) => at.check(-1.0e6, "-1e6 to 1e6"),
            Self::Tornado(tornado) => tornado.check(),
        }
    }
}

impl WindSingularity {
    fn check(&self, smallest: f32, allowed: &'static str) -> Result<(), WindError> {
        let unit_of_strength = match self.form {
            WindForm::Line => "m^2/s",
            WindForm::Point => "m^3/s",
        };
        in_range("strength", self.strength, unit_of_strength, &(smallest..=1.0e6), 1.0, allowed)?;
        check_position("center", self.center)?;
        core(self.core_radius)?;
        if self.form == WindForm::Point && self.core != WindCore::Rosenhead {
            return Err(WindError::CoreOfPoint { found: self.core.name() });
        }
        unit("axis", self.axis).map(|_| ())
    }
}

impl WindTornado {
    fn check(&self) -> Result<(), WindError> {
        in_range("circulation", self.circulation, "m^2/s", &(-1.0e6..=1.0e6), 1.0, "-1e6 to 1e6")?;
        in_range("discharge", self.discharge, "m^3/s", &(0.0..=1.0e6), 1.0, "0 to 1e6")?;
        check_position("base", self.base)?;
        core(self.core_radius)?;
        // Rounded numbers of a matrix must stay in the range that they had.
        let smallest = 2.0 * self.core_radius * (1.0 - 1.0e-6);
        in_range("height", self.height, "m", &(smallest..=1.0e5), 1.0, "2 core radii to 1e5")?;
        unit("axis", self.axis).map(|_| ())
    }
}

fn core(radius: f32) -> Result<(), WindError> {
    in_range("core radius", radius, "m", &(0.01..=1.0e4), 1.0, "0.01 to 1e4")?;
    Ok(())
}

fn check_position(quantity: &'static str, at: Vec3) -> Result<(), WindError> {
    for c in at.to_array() {
        in_range(quantity, c, "m", &(-1.0e6..=1.0e6), 1.0, "-1e6 to 1e6 in each direction")?;
    }
    Ok(())
}

/// Returns the vector with length 1. A unit vector, up to rounding, keeps its bits.
pub(crate) fn unit(quantity: &'static str, vector: Vec3) -> Result<Vec3, WindError> {
    for c in vector.to_array() {
        in_range(quantity, c, "(a component)", &(-1.0e6..=1.0e6), 1.0, "-1e6 to 1e6")?;
    }
    let squared = vector.dot(vector);
    if squared < 1.0e-6 {
        return Err(WindError::ZeroAxis { quantity, found: vector.to_array() });
    }
    if (squared - 1.0).abs() < 1.0e-6 { Ok(vector) } else { Ok(vector / squared.sqrt()) }
}
