//! `[[model]]`.

use super::fault::Positions;
use super::file::path;
use super::quantity::{AnimationSpeed, Exactly, In, PositionM, ScaleXyz, TurnDeg, Whole};
use super::wind::keys::{VectorKeys, vector_or};
use downpour_math::ops::f64 as ops;
use downpour_scene::error::SceneError;
use downpour_scene::uri::RelativePath;
use downpour_wind::Keyed;
use glam::{DAffine3, DQuat, DVec3};
use serde::Deserialize;

/// Maximum number of copies of one model.
const MAX_COPIES: u64 = 65_536;

/// A model with its transform.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// The glTF file, inside the folder of the weather file or an asset root.
    pub file: RelativePath,
    /// Position of its origin, in meters; with keys, that of time 0.
    pub translation: DVec3,
    /// Rotation; with keys, that of time 0.
    pub rotation: DQuat,
    /// Scale.
    pub scale: DVec3,
    /// Copies of the model.
    pub repeat: Repeat,
    /// Animation that plays; `None` for the first one.
    pub animation: Option<String>,
    /// Speed of the animation, as a multiple of the model's own.
    pub animation_speed: f64,
}

/// Position and rotation of a model over time.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ModelKeys {
    /// Meters.
    translation: Keyed<DVec3>,
    /// Degrees about x, y and z.
    rotation_deg: Keyed<DVec3>,
}

impl ModelKeys {
    /// The same, if any value changes.
    pub(super) fn moving(self) -> Option<Self> {
        let moves = [&self.translation, &self.rotation_deg].iter().any(|keyed| keyed.keys().len() > 1);
        moves.then_some(self)
    }
}

/// Copies on a lattice along the scene's axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Repeat {
    /// Number of copies along x, y and z; each at least 1.
    pub count: [u32; 3],
    /// Distance between copies, in meters.
    pub step: DVec3,
}

impl Default for Repeat {
    /// The model alone.
    fn default() -> Self {
        Self { count: [1; 3], step: DVec3::ZERO }
    }
}

impl Model {
    /// Transform of each copy, x running fastest: scale first, then rotation, then translation.
    ///
    /// ```
    /// use downpour_weather::Weather;
    /// let text = "[[model]]\nfile = 'a.glb'\nscale = 2\nrepeat = { count = [2, 1, 1], step_m = [5, 0, 0] }";
    /// let weather = Weather::parse("row.toml", text)?;
    /// let copies: Vec<_> = weather.models[0].transforms().collect();
    /// assert_eq!(copies[1].transform_point3([1.0, 0.0, 0.0].into()), [7.0, 0.0, 0.0].into());
    /// # Ok::<(), downpour_scene::SceneError>(())
    /// ```
    pub fn transforms(&self) -> impl Iterator<Item = DAffine3> + use<'_> {
        let [nx, ny, nz] = self.repeat.count;
        (0..nz).flat_map(move |z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z]))).map(|index| {
            #[expect(clippy::arithmetic_side_effects, reason = "of floats: at most 1e7 + 65536 * 1e7")]
            let moved = self.translation + self.repeat.step * DVec3::from_array(index.map(f64::from));
            DAffine3::from_scale_rotation_translation(self.scale, self.rotation, moved)
        })
    }
}

#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct ModelTable {
    file: String,
    translation_m: Option<VectorKeys<PositionM>>,
    rotation_deg: Option<VectorKeys<TurnDeg>>,
    scale: Option<ScaleXyz>,
    repeat: Option<RepeatTable>,
    animation: Option<String>,
    animation_speed: Option<In<AnimationSpeed>>,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
struct RepeatTable {
    count: Exactly<Whole<1, 65_536>, 3>,
    step_m: Exactly<In<PositionM>, 3>,
}

impl Model {
    /// The model at a time in seconds.
    pub(super) fn at(self, keys: &ModelKeys, time_s: f64) -> Self {
        let translation = keys.translation.at(time_s);
        Self { translation, rotation: rotation(keys.rotation_deg.at(time_s).to_array()), ..self }
    }

    /// The model at time 0, and where it is over time.
    pub(super) fn checked(
        i: usize,
        table: &ModelTable,
        positions: &Positions<'_>,
    ) -> Result<(Self, ModelKeys), SceneError> {
        let key = |name: &str| format!("model[{i}].{name}");
        let repeat = table.repeat.map_or_else(Repeat::default, |repeat| Repeat {
            count: repeat.count.0.map(|Whole(count)| count),
            step: DVec3::from_array(repeat.step_m.numbers()),
        });
        let copies = repeat.count.iter().map(|&count| u64::from(count)).fold(1, u64::saturating_mul);
        if copies > MAX_COPIES {
            let found = format!("{copies} copies");
            return Err(positions.limit(&key("repeat.count"), found, format!("at most {MAX_COPIES}")));
        }
        let (translation, turn) = (table.translation_m.as_ref(), table.rotation_deg.as_ref());
        let keys = ModelKeys {
            translation: vector_or(translation, DVec3::ZERO, &key("translation_m"), positions)?,
            rotation_deg: vector_or(turn, DVec3::ZERO, &key("rotation_deg"), positions)?,
        };
        let model = Self {
            file: path(&table.file, &key("file"), positions)?,
            translation: DVec3::ZERO,
            rotation: DQuat::IDENTITY,
            scale: table.scale.map_or(DVec3::ONE, |ScaleXyz(scale)| scale.into()),
            repeat,
            animation: table.animation.clone(),
            animation_speed: table.animation_speed.map_or(1.0, |speed| speed.0),
        };
        Ok((model.at(&keys, 0.0), keys))
    }
}

/// Rotation about z, then x, then y, in degrees.
fn rotation([x, y, z]: [f64; 3]) -> DQuat {
    let half = |degrees: f64| {
        let angle = degrees.to_radians() / 2.0;
        (ops::sin(angle), ops::cos(angle))
    };
    let ((sx, cx), (sy, cy), (sz, cz)) = (half(x), half(y), half(z));
    let about_x = DQuat::from_xyzw(sx, 0.0, 0.0, cx);
    let about_y = DQuat::from_xyzw(0.0, sy, 0.0, cy);
    let about_z = DQuat::from_xyzw(0.0, 0.0, sz, cz);
    about_y.mul_quat(about_x).mul_quat(about_z).normalize()
}
