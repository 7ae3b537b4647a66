//! Encoding of a primitive as the 3x3 matrix of Rousseau 2008, 3.1, and decoding.
//!
//! ```text
//! type       strength   core radius
//! center.x   center.y   center.z
//! up.x       up.y       up.z
//! ```
//!
//! The paper has 0 in the entry of the core radius, and prints no numbers of types: they are the constants
//! `WIND_PRIMITIVE_*` of `downpour-shaders`. The type of a line includes its core, unless it is Rosenhead's. A sink's
//! strength is negative, as in the paper's formula. A tornado is four matrices: updraft (its up leads from base to
//! top), point sink, point source, line vortex.

use downpour_shaders::wind::{
    WIND_PRIMITIVE_LAMB_OSEEN, WIND_PRIMITIVE_LINE_SINK, WIND_PRIMITIVE_LINE_SOURCE,
    WIND_PRIMITIVE_LINE_VORTEX, WIND_PRIMITIVE_POINT_SINK, WIND_PRIMITIVE_POINT_SOURCE,
    WIND_PRIMITIVE_POINT_VORTEX, WIND_PRIMITIVE_RANKINE, WIND_PRIMITIVE_UNIFORM, WIND_PRIMITIVE_UPDRAFT,
};
use glam::Vec3;

use crate::design::{WindCore, WindForm, WindPrimitive, WindSingularity, WindTornado, WindUniform, unit};
use crate::error::WindError;

/// A primitive in the layout of the shader. Matrices from [`WindMatrix::encode`] are in range; others are checked by
/// [`WindMatrix::decode`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WindMatrix {
    /// Rows of the paper's matrix.
    pub rows: [[f32; 3]; 3],
}

impl WindMatrix {
    fn new(kind: u32, strength: f32, core: f32, center: Vec3, up: Vec3) -> Self {
        Self { rows: [[kind as f32, strength, core], center.to_array(), up.to_array()] }
    }

    /// Encodes primitives as matrices, in their order: four for a tornado, one for the others.
    ///
    /// # Errors
    /// As [`WindPrimitive::check`].
    pub fn encode(primitives: &[WindPrimitive]) -> Result<Vec<Self>, WindError> {
        let mut matrices = Vec::with_capacity(primitives.len());
        for primitive in primitives {
            primitive.check()?;
            match primitive {
                WindPrimitive::Uniform(wind) => {
                    let up = unit("direction of the wind", wind.direction)?;
                    matrices.push(Self::new(WIND_PRIMITIVE_UNIFORM, wind.speed, 0.0, Vec3::ZERO, up));
                }
                WindPrimitive::Source(at) => {
                    let kinds = [WIND_PRIMITIVE_LINE_SOURCE, WIND_PRIMITIVE_POINT_SOURCE];
                    matrices.push(Self::singularity(at, kinds, 1.0)?);
                }
                WindPrimitive::Sink(at) => {
                    let kinds = [WIND_PRIMITIVE_LINE_SINK, WIND_PRIMITIVE_POINT_SINK];
                    matrices.push(Self::singularity(at, kinds, -1.0)?);
                }
                WindPrimitive::Vortex(at) => {
                    let kinds = [WIND_PRIMITIVE_LINE_VORTEX, WIND_PRIMITIVE_POINT_VORTEX];
                    matrices.push(Self::singularity(at, kinds, 1.0)?);
                }
                WindPrimitive::Tornado(tornado) => matrices.extend(Self::tornado(tornado)?),
            }
        }
        Ok(matrices)
    }

    fn singularity(at: &WindSingularity, kinds: [u32; 2], sign: f32) -> Result<Self, WindError> {
        let [line, point] = kinds;
        let kind = match at.form {
            WindForm::Line => line + number(at.core),
            WindForm::Point => point,
        };
        Ok(Self::new(kind, sign * at.strength, at.core_radius, at.center, unit("axis", at.axis)?))
    }

    fn tornado(tornado: &WindTornado) -> Result<[Self; 4], WindError> {
        let WindTornado { circulation, discharge, base, height, core_radius: core, .. } = *tornado;
        let up = unit("axis", tornado.axis)?;
        let top = base + up * height;
        Ok([
            Self::new(WIND_PRIMITIVE_UPDRAFT, discharge, core, base, up * height),
            Self::new(WIND_PRIMITIVE_POINT_SINK, -discharge, core, base, up),
            Self::new(WIND_PRIMITIVE_POINT_SOURCE, discharge, core, top, up),
            Self::new(WIND_PRIMITIVE_LINE_VORTEX, circulation, core, base, up),
        ])
    }

    /// Decodes matrices to primitives, in their order. Axes have length 1, the height of a tornado is exact to
    /// rounding.
    ///
    /// # Errors
    /// [`WindError::UnknownType`], [`WindError::LoneUpdraft`], or as [`WindPrimitive::check`].
    pub fn decode(matrices: &[Self]) -> Result<Vec<WindPrimitive>, WindError> {
        let mut primitives = Vec::new();
        let mut rest = matrices;
        while let [first, after @ ..] = rest {
            let index = matrices.len() - rest.len();
            rest = after;
            let [[number, strength, core_radius], center, up] = first.rows;
            let (kind, core) =
                type_and_core(number).ok_or(WindError::UnknownType { index, found: number })?;
            let (center, axis) = (Vec3::from(center), Vec3::from(up));
            let form = match kind {
                WIND_PRIMITIVE_POINT_SOURCE | WIND_PRIMITIVE_POINT_SINK | WIND_PRIMITIVE_POINT_VORTEX => {
                    WindForm::Point
                }
                _ => WindForm::Line,
            };
            let at = WindSingularity { form, strength, center, axis, core_radius, core };
            let primitive = match kind {
                WIND_PRIMITIVE_UNIFORM => {
                    WindPrimitive::Uniform(WindUniform { speed: strength, direction: axis })
                }
                WIND_PRIMITIVE_LINE_SOURCE | WIND_PRIMITIVE_POINT_SOURCE => WindPrimitive::Source(at),
                WIND_PRIMITIVE_LINE_SINK | WIND_PRIMITIVE_POINT_SINK => {
                    WindPrimitive::Sink(WindSingularity { strength: -strength, ..at })
                }
                WIND_PRIMITIVE_LINE_VORTEX | WIND_PRIMITIVE_POINT_VORTEX => WindPrimitive::Vortex(at),
                _ => {
                    let (tornado, after) = Self::decode_tornado(first, rest, index)?;
                    rest = after;
                    WindPrimitive::Tornado(tornado)
                }
            };
            primitive.check()?;
            primitives.push(with_unit_axis(primitive)?);
        }
        Ok(primitives)
    }

    /// Decodes the tornado of an updraft and of the parts that follow it; returns the remaining matrices too.
    fn decode_tornado<'a>(
        updraft: &Self,
        rest: &'a [Self],
        index: usize,
    ) -> Result<(WindTornado, &'a [Self]), WindError> {
        let lone = WindError::LoneUpdraft { index };
        let [sink, source, vortex, after @ ..] = rest else { return Err(lone) };
        let [[_, discharge, core_radius], base, up] = updraft.rows;
        let [[_, circulation, _], _, axis] = vortex.rows;
        let up = Vec3::from(up);
        let height = up.dot(up).sqrt();
        let tornado = WindTornado {
            circulation,
            discharge,
            base: Vec3::from(base),
            axis: Vec3::from(axis),
            height,
            core_radius,
        };
        WindPrimitive::Tornado(tornado).check()?;
        let close = |a: &Self, b: &Self| {
            let slack = 1.0e-5 * (height + Vec3::from(base).abs().max_element());
            a.rows[0] == b.rows[0]
                && (1..3).all(|k| Vec3::from(a.rows[k]).distance(Vec3::from(b.rows[k])) <= slack)
        };
        let [wanted_updraft, wanted @ ..] = Self::tornado(&tornado)?;
        let same = close(updraft, &wanted_updraft)
            && wanted.iter().zip([sink, source, vortex]).all(|(a, b)| close(a, b));
        if same { Ok((tornado, after)) } else { Err(lone) }
    }

    /// Matrix in the layout of a `mat3x3f` in a storage buffer: the rows, each padded to four numbers. A buffer needs
    /// at least one matrix; the default matrix is a uniform wind of speed 0.
    #[must_use]
    pub fn padded(&self) -> [[f32; 4]; 3] {
        self.rows.map(|[x, y, z]| [x, y, z, 0.0])
    }
}

/// Offset that a core adds to the type of a line.
fn number(core: WindCore) -> u32 {
    match core {
        WindCore::Rosenhead => 0,
        WindCore::Rankine => WIND_PRIMITIVE_RANKINE,
        WindCore::LambOseen => WIND_PRIMITIVE_LAMB_OSEEN,
    }
}

/// Splits the type of a matrix into the type without its core, and the core.
fn type_and_core(number: f32) -> Option<(u32, WindCore)> {
    let whole = number as u32;
    if whole as f32 != number {
        return None;
    }
    let core = match whole / WIND_PRIMITIVE_RANKINE {
        0 => return Some((whole, WindCore::Rosenhead)),
        1 => WindCore::Rankine,
        2 => WindCore::LambOseen,
        _ => return None,
    };
    let kind = whole % WIND_PRIMITIVE_RANKINE;
    let line =
        matches!(kind, WIND_PRIMITIVE_LINE_SOURCE | WIND_PRIMITIVE_LINE_SINK | WIND_PRIMITIVE_LINE_VORTEX);
    line.then_some((kind, core))
}

/// Returns the primitive with an axis of length 1.
fn with_unit_axis(primitive: WindPrimitive) -> Result<WindPrimitive, WindError> {
    let along = |at: WindSingularity| -> Result<WindSingularity, WindError> {
        Ok(WindSingularity { axis: unit("axis", at.axis)?, ..at })
    };
    Ok(match primitive {
        WindPrimitive::Uniform(wind) => WindPrimitive::Uniform(WindUniform {
            direction: unit("direction of the wind", wind.direction)?,
            ..wind
        }),
        WindPrimitive::Source(at) => WindPrimitive::Source(along(at)?),
        WindPrimitive::Sink(at) => WindPrimitive::Sink(along(at)?),
        WindPrimitive::Vortex(at) => WindPrimitive::Vortex(along(at)?),
        WindPrimitive::Tornado(tornado) => {
            WindPrimitive::Tornado(WindTornado { axis: unit("axis", tornado.axis)?, ..tornado })
        }
    })
}
