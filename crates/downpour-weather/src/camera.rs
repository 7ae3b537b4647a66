//! `[camera]`.

use super::fault::Positions;
use super::quantity::{
    ApertureMm, DepthM, FocusM, FovDeg, In, PersistenceS, PitchDeg, PositionM, ShutterS, Stops, TurnDeg,
};
use super::wind::keys::{NumberKeys, VectorKeys, moving, number_given, number_or};
use downpour_math::ops::f64 as ops;
use downpour_scene::error::SceneError;
use downpour_wind::Keyed;
use glam::DVec3;
use serde::Deserialize;

/// Default vertical field of view if neither the file nor the model has one, in radians: 50 degrees.
pub const FOV_RAD: f64 = 50.0 * std::f64::consts::PI / 180.0;

/// Default near depth if neither the file nor the model has one, in meters.
pub const NEAR_M: f64 = 0.05;

/// Default far depth if neither the file nor the model has one, in meters.
pub const FAR_M: f64 = 2000.0;

/// Default persistence of an eye, in seconds, in which an image fades away: the middle of the 60 to 90 ms of
/// Rousseau 2006, section 5.
pub const PERSISTENCE_S: f64 = 0.075;

/// Observer of moving drops.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Observer {
    /// A camera: all light while its shutter is open has the same weight.
    #[default]
    Camera,
    /// An eye, which has no shutter: an image fades away linearly and is gone after the persistence.
    Eye,
}

/// Tone curve from radiance to the colors of a picture to look at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum ToneCurve {
    /// Bright colors keep their hue and go toward white by their stops, as on film.
    #[default]
    Hue,
    /// The neutral tone mapper of Khronos (2024).
    KhronosNeutral,
}

/// Filter of the edges of things brighter than white in pictures to look at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum ToneEdges {
    /// Both sides of an edge are mixed behind the tone curve, by the coverage of the pixel.
    #[default]
    ToneAware,
    /// The linear mean of both sides goes through the tone curve, and clips.
    Linear,
}

/// A camera, or an eye instead.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// Position and direction over time; `None` takes the model's camera.
    pub path: Option<CameraPath>,
    /// Vertical field of view in radians; `None` takes the model's, else [`FOV_RAD`].
    pub fov: Option<f64>,
    /// Near depth, in meters; `None` takes the model's, else [`NEAR_M`].
    pub near: Option<f64>,
    /// Far depth, in meters; `None` takes the model's, else [`FAR_M`].
    pub far: Option<f64>,
    /// The picture is multiplied by two to this power.
    pub exposure_ev: f64,
    /// Tone curve of pictures to look at.
    pub tone: ToneCurve,
    /// Filter of the edges of things brighter than white in pictures to look at.
    pub edges: ToneEdges,
    /// Observer of the moving drops.
    pub observer: Observer,
    /// Time in which light is collected, in seconds: opening time of a camera's shutter, 0 to 1 (0 freezes the drops), or
    /// the persistence of an eye, 0.06 to 0.09.
    pub shutter: f64,
    /// Diameter of the lens's pupil, in meters; 0: all is in focus.
    pub aperture: f64,
    /// Distance in focus, in meters; `None` for infinity.
    pub focus: Option<f64>,
}

/// Position and direction of the eye. Up is +Y; `forward` is never vertical.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraPose {
    /// Position of the eye, in meters.
    pub position: DVec3,
    /// Unit direction into the center of the picture.
    pub forward: DVec3,
}

/// Position and direction of the eye over time. It is constant before its first key and after its last.
///
/// ```
/// use downpour_weather::CameraPath;
/// use downpour_wind::Keyed;
/// use glam::DVec3;
/// let positions = Keyed::new(vec![(0.0, DVec3::new(0.0, 1.6, 8.0)), (4.0, DVec3::new(0.0, 1.6, 2.0))])?;
/// let path = CameraPath::looking_at(positions, DVec3::new(0.0, 1.0, -20.0));
/// assert_eq!(path.at(2.0).position.z, 5.0);
/// # Ok::<(), downpour_wind::WindError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct CameraPath {
    position: Keyed<DVec3>,
    aim: Aim,
}

/// Aim of an eye.
#[derive(Clone, Debug, PartialEq)]
enum Aim {
    /// A constant unit direction.
    Along(DVec3),
    /// Yaw and pitch, in degrees.
    Turned { yaw_deg: Keyed<f64>, pitch_deg: Keyed<f64> },
    /// A target.
    At(Keyed<DVec3>),
}

impl CameraPath {
    /// Creates the path of an eye that looks at a target, m. If that is straight above or below it, it looks slightly past it.
    #[must_use]
    pub fn looking_at(position: impl Into<Keyed<DVec3>>, target: impl Into<Keyed<DVec3>>) -> Self {
        Self { position: position.into(), aim: Aim::At(target.into()) }
    }

    /// Pose of the eye at a time in seconds.
    #[must_use]
    pub fn at(&self, time_s: f64) -> CameraPose {
        let position = self.position.at(time_s);
        let forward = match &self.aim {
            Aim::Along(forward) => *forward,
            Aim::Turned { yaw_deg, pitch_deg } => forward_of(yaw_deg.at(time_s), pitch_deg.at(time_s)),
            Aim::At(target) => forward_to(position, target.at(time_s)),
        };
        CameraPose { position, forward }
    }

    /// True if the pose is constant.
    #[must_use]
    pub fn is_still(&self) -> bool {
        let aims = match &self.aim {
            Aim::Along(_) => 1,
            Aim::Turned { yaw_deg, pitch_deg } => yaw_deg.keys().len().max(pitch_deg.keys().len()),
            Aim::At(target) => target.keys().len(),
        };
        self.position.keys().len() == 1 && aims == 1
    }
}

impl From<CameraPose> for CameraPath {
    /// Path of an eye at rest.
    fn from(pose: CameraPose) -> Self {
        Self { position: pose.position.into(), aim: Aim::Along(pose.forward) }
    }
}

/// Direction of an eye with a yaw and a pitch, in degrees.
fn forward_of(yaw_deg: f64, pitch_deg: f64) -> DVec3 {
    let (yaw, pitch) = (yaw_deg.to_radians(), pitch_deg.to_radians());
    let flat = ops::cos(pitch);
    DVec3::new(-flat * ops::sin(yaw), ops::sin(pitch), -flat * ops::cos(yaw))
}

/// True if a direction is so near to the vertical that left and right are undefined.
fn is_vertical(way: DVec3) -> bool {
    ops::hypot(way.x, way.z) <= 1e-4 * way.y.abs() || way.length() < 1e-6
}

/// Direction from an eye to a target, tilted slightly if it would be vertical.
#[expect(clippy::arithmetic_side_effects, reason = "of floats")]
fn forward_to(eye: DVec3, target: DVec3) -> DVec3 {
    let way = target - eye;
    let aside = DVec3::NEG_Z * (1.0e-3 * way.y.abs().max(1.0));
    if is_vertical(way) { (way + aside).normalize() } else { way.normalize() }
}

impl Default for Camera {
    /// The model's camera, 1/60 s.
    fn default() -> Self {
        Self {
            path: None,
            fov: None,
            near: None,
            far: None,
            exposure_ev: 0.0,
            tone: ToneCurve::Hue,
            edges: ToneEdges::ToneAware,
            observer: Observer::Camera,
            shutter: 1.0 / 60.0,
            aperture: 0.0,
            focus: None,
        }
    }
}

#[derive(Debug, Default, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct CameraTable {
    position_m: Option<VectorKeys<PositionM>>,
    look_at_m: Option<VectorKeys<PositionM>>,
    yaw_deg: Option<NumberKeys<TurnDeg>>,
    pitch_deg: Option<NumberKeys<PitchDeg>>,
    fov_deg: Option<NumberKeys<FovDeg>>,
    near_m: Option<In<DepthM>>,
    far_m: Option<In<DepthM>>,
    exposure_ev: Option<NumberKeys<Stops>>,
    tone: Option<ToneCurve>,
    edges: Option<ToneEdges>,
    observer: Option<Observer>,
    shutter_s: Option<In<ShutterS>>,
    persistence_s: Option<In<PersistenceS>>,
    aperture_mm: Option<In<ApertureMm>>,
    focus_m: Option<NumberKeys<FocusM>>,
}

impl Camera {
    /// The camera at a time in seconds, with the values of some keys. Position and direction are a path in any case.
    pub(super) fn at(self, keys: &CameraKeys, time_s: f64) -> Self {
        let at = |keyed: &Option<Keyed<f64>>| keyed.as_ref().map(|keyed| keyed.at(time_s));
        Self {
            fov: at(&keys.fov_deg).map_or(self.fov, |fov| Some(fov.to_radians())),
            exposure_ev: at(&keys.exposure_ev).unwrap_or(self.exposure_ev),
            focus: at(&keys.focus_m).or(self.focus),
            ..self
        }
    }

    pub(super) fn checked(
        table: &CameraTable,
        keys: &CameraKeys,
        positions: &Positions<'_>,
    ) -> Result<Self, SceneError> {
        let default = Self::default();
        let (near, far) = (table.near_m.map(|near| near.0), table.far_m.map(|far| far.0));
        let (nearest, farthest) = (near.unwrap_or(NEAR_M), far.unwrap_or(FAR_M));
        if nearest >= farthest && (near.is_some() || far.is_some()) {
            let key = if near.is_some() { "camera.near_m" } else { "camera.far_m" };
            let found = format!("{nearest} m to {farthest} m");
            return Err(positions.bad(key, found, "near_m below far_m"));
        }
        if table.focus_m.is_some() && table.aperture_mm.is_none() {
            let found = "a distance in focus of a lens in which all is in focus";
            return Err(positions.bad("camera.focus_m", found, "with aperture_mm"));
        }
        let observer = table.observer.unwrap_or_default();
        let camera = Self {
            path: table.path(positions)?,
            fov: None,
            near,
            far,
            exposure_ev: default.exposure_ev,
            tone: table.tone.unwrap_or_default(),
            edges: table.edges.unwrap_or_default(),
            observer,
            shutter: table.shutter(observer, positions)?,
            aperture: table.aperture_mm.map_or(default.aperture, |pupil| pupil.0 * 1.0e-3),
            focus: None,
        };
        Ok(camera.at(keys, 0.0))
    }
}

/// Values of the camera that the file gives, over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct CameraKeys {
    /// Vertical field of view, in degrees.
    pub(super) fov_deg: Option<Keyed<f64>>,
    /// Exposure compensation, in stops.
    pub(super) exposure_ev: Option<Keyed<f64>>,
    /// Distance in focus, in meters.
    pub(super) focus_m: Option<Keyed<f64>>,
}

impl CameraKeys {
    /// The same without constant values.
    pub(super) fn moving(self) -> Self {
        Self {
            fov_deg: moving(self.fov_deg),
            exposure_ev: moving(self.exposure_ev),
            focus_m: moving(self.focus_m),
        }
    }
}

impl CameraTable {
    /// Values over time.
    pub(super) fn keys(&self, positions: &Positions<'_>) -> Result<CameraKeys, SceneError> {
        Ok(CameraKeys {
            fov_deg: number_given(self.fov_deg.as_ref(), "camera.fov_deg", positions)?,
            exposure_ev: number_given(self.exposure_ev.as_ref(), "camera.exposure_ev", positions)?,
            focus_m: number_given(self.focus_m.as_ref(), "camera.focus_m", positions)?,
        })
    }

    /// Exposure time, s. Rejects the key of the other observer.
    fn shutter(&self, observer: Observer, positions: &Positions<'_>) -> Result<f64, SceneError> {
        match (observer, self.shutter_s, self.persistence_s) {
            (Observer::Camera, _, Some(_)) => Err(positions.bad(
                "camera.persistence_s",
                "with a camera, which has a shutter",
                "shutter_s, or persistence_s with observer = \"eye\"",
            )),
            (Observer::Eye, Some(_), _) => Err(positions.bad(
                "camera.shutter_s",
                "with observer = \"eye\", which has no shutter",
                "persistence_s, or shutter_s without observer = \"eye\"",
            )),
            (Observer::Camera, shutter, None) => Ok(shutter.map_or(Camera::default().shutter, |time| time.0)),
            (Observer::Eye, None, persistence) => Ok(persistence.map_or(PERSISTENCE_S, |time| time.0)),
        }
    }

    fn path(&self, positions: &Positions<'_>) -> Result<Option<CameraPath>, SceneError> {
        let given = [
            ("look_at_m", self.look_at_m.is_some()),
            ("yaw_deg", self.yaw_deg.is_some()),
            ("pitch_deg", self.pitch_deg.is_some()),
        ];
        let mut turned = given.into_iter().filter_map(|(key, given)| given.then_some(key));
        let Some(position) = &self.position_m else {
            return match turned.next() {
                None => Ok(None),
                Some(key) => Err(positions.bad(
                    &format!("camera.{key}"),
                    "without position_m",
                    "position_m is needed with it",
                )),
            };
        };
        let position = position.keyed("camera.position_m", positions)?;
        let Some(target) = &self.look_at_m else {
            let yaw_deg = number_or(self.yaw_deg.as_ref(), 0.0, "camera.yaw_deg", positions)?;
            let pitch_deg = number_or(self.pitch_deg.as_ref(), 0.0, "camera.pitch_deg", positions)?;
            let aim = if yaw_deg.keys().len().max(pitch_deg.keys().len()) > 1 {
                Aim::Turned { yaw_deg, pitch_deg }
            } else {
                Aim::Along(forward_of(yaw_deg.at(0.0), pitch_deg.at(0.0)))
            };
            return Ok(Some(CameraPath { position, aim }));
        };
        if let Some(key) = turned.find(|key| *key != "look_at_m") {
            let allowed = "look_at_m, or yaw_deg and pitch_deg";
            return Err(positions.bad(&format!("camera.{key}"), "beside look_at_m", allowed));
        }
        let target = target.keyed("camera.look_at_m", positions)?;
        let times = position.keys().iter().chain(target.keys().iter()).map(|&(time, _)| time);
        #[expect(clippy::arithmetic_side_effects, reason = "of floats: both are within 1e7")]
        let way = |time: f64| target.at(time) - position.at(time);
        if let Some(time) = times.into_iter().find(|&time| is_vertical(way(time))) {
            let still = position.keys().len() == 1 && target.keys().len() == 1;
            let when = if still { String::new() } else { format!(" at {time} s") };
            let found = format!("is where the eye is, or straight above or below it{when}");
            return Err(positions.bad(
                "camera.look_at_m",
                found,
                "a target beside the vertical, or yaw_deg and pitch_deg",
            ));
        }
        Ok(Some(CameraPath { position, aim: Aim::At(target) }))
    }
}
