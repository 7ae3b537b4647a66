//! What a wind is made of, as a person designs it.

use glam::Vec3;

use crate::error::{WindError, in_range};

/// How far a source, sink or vortex reaches.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WindForm {
    /// The same at every height along the axis, falling as 1 / r (the printed formulas of Rousseau 2008).
    #[default]
    Line,
    /// About one point, falling as 1 / r^2 (the text of Rousseau 2008: "in all directions from this point").
    Point,
}

/// How a line form is kept finite at its axis. Point forms have Rosenhead's core. The laws stand in
/// [`primitive`](crate::primitive).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WindCore {
    /// r / (r^2 + e^2): smooth, fastest at the core radius with half of what Rankine's has.
    #[default]
    Rosenhead,
    /// Turns as a solid within the core radius; beyond it nothing is changed.
    Rankine,
    /// A normal distribution of rotation or outflow: what viscosity makes of a line.
    LambOseen,
}

impl WindCore {
    /// Every core.
    pub const ALL: [Self; 3] = [Self::Rosenhead, Self::Rankine, Self::LambOseen];

    /// Its name in files and arguments.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Rosenhead => "rosenhead",
            Self::Rankine => "rankine",
            Self::LambOseen => "lamb-oseen",
        }
    }

    /// The core of a name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|core| core.name() == name)
    }
}

/// The same wind everywhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindUniform {
    /// 0 to 200 m/s.
    pub speed: f32,
    /// Where it blows to; any length.
    pub direction: Vec3,
}

/// A source, sink or vortex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindSingularity {
    /// Line or point.
    pub form: WindForm,
    /// m^2/s for a line (flow per length, or circulation), m^3/s for a point (flow, or circulation times length). 0 to 1e6
    /// for sources and sinks; a vortex may be negative, and turns right-handed about its axis if it is positive.
    pub strength: f32,
    /// Where it is: a point of the axis, or the point. Metres, up to 1e6.
    pub centre: Vec3,
    /// The axis; any length. A point source or sink has the same wind for every axis.
    pub axis: Vec3,
    /// 0.01 to 1e4 m. Two cells of a grid at least, if the grid is to show it.
    pub core_radius: f32,
    /// What the core is like; points have Rosenhead's.
    pub core: WindCore,
}

/// A sink at the base, a source at the top, a vortex about the axis (Rousseau 2008, 3.1), and the updraft that carries the
/// air from the base to the top.
///
/// With line forms sink and source would cancel; with point forms alone the air would flow down from the source to the
/// sink.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindTornado {
    /// Circulation of the vortex, m^2/s, up to 1e6; right-handed about the axis if it is positive.
    pub circulation: f32,
    /// Air that goes in at the base and out at the top, 0 to 1e6 m^3/s.
    pub discharge: f32,
    /// Middle of the base. Metres, up to 1e6.
    pub base: Vec3,
    /// From base to top; any length.
    pub axis: Vec3,
    /// From base to top, 2 core radii to 1e5 m.
    pub height: f32,
    /// 0.01 to 1e4 m.
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
    /// Wind round an axis.
    Vortex(WindSingularity),
    /// All of it.
    Tornado(WindTornado),
}

impl WindPrimitive {
    /// Nothing if every number is in its range.
    ///
    /// # Errors
    /// [`WindError::OutOfRange`] or [`WindError::ZeroAxis`] for the first that is not; [`WindError::CoreOfPoint`].
    pub fn check(&self) -> Result<(), WindError> {
        match self {
            Self::Uniform(wind) => {
                in_range("wind speed", wind.speed, "m/s", &(0.0..=200.0), "0 to 200")?;
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
        in_range("strength", self.strength, unit_of_strength, &(smallest..=1.0e6), allowed)?;
        place("centre", self.centre)?;
        core(self.core_radius)?;
        if self.form == WindForm::Point && self.core != WindCore::Rosenhead {
            return Err(WindError::CoreOfPoint { found: self.core.name() });
        }
        unit("axis", self.axis).map(|_| ())
    }
}

impl WindTornado {
    fn check(&self) -> Result<(), WindError> {
        in_range("circulation", self.circulation, "m^2/s", &(-1.0e6..=1.0e6), "-1e6 to 1e6")?;
        in_range("discharge", self.discharge, "m^3/s", &(0.0..=1.0e6), "0 to 1e6")?;
        place("base", self.base)?;
        core(self.core_radius)?;
        // Rounded numbers of a matrix must not fall out of the range that they were in.
        let smallest = 2.0 * self.core_radius * (1.0 - 1.0e-6);
        in_range("height", self.height, "m", &(smallest..=1.0e5), "2 core radii to 1e5")?;
        unit("axis", self.axis).map(|_| ())
    }
}

fn core(radius: f32) -> Result<(), WindError> {
    in_range("core radius", radius, "m", &(0.01..=1.0e4), "0.01 to 1e4")
}

fn place(quantity: &'static str, at: Vec3) -> Result<(), WindError> {
    at.to_array()
        .into_iter()
        .try_for_each(|c| in_range(quantity, c, "m", &(-1.0e6..=1.0e6), "-1e6 to 1e6 in each direction"))
}

/// The vector with length 1. One that has it to rounding keeps its bits.
pub(crate) fn unit(quantity: &'static str, vector: Vec3) -> Result<Vec3, WindError> {
    for c in vector.to_array() {
        in_range(quantity, c, "(a component)", &(-1.0e6..=1.0e6), "-1e6 to 1e6")?;
    }
    let squared = vector.dot(vector);
    if squared < 1.0e-6 {
        return Err(WindError::ZeroAxis { quantity, found: vector.to_array() });
    }
    if (squared - 1.0).abs() < 1.0e-6 { Ok(vector) } else { Ok(vector / squared.sqrt()) }
}
