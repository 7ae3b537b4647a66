//! `[camera]`.

use super::fault::Places;
use super::quantity::{
    ApertureMm, DepthM, Exactly, FocusM, FovDeg, In, PersistenceS, PitchDeg, PlaceM, ShutterS, Stops, TurnDeg,
};
use crate::error::SceneError;
use downpour_math::ops::f64 as ops;
use glam::DVec3;
use serde::Deserialize;

/// The vertical field of view where neither the file nor the model says one, in radians: 50 degrees.
pub const FOV_RAD: f64 = 50.0 * std::f64::consts::PI / 180.0;

/// The nearest depth where neither the file nor the model says one, in metres.
pub const NEAR_M: f64 = 0.05;

/// The farthest depth where neither the file nor the model says one, in metres.
pub const FAR_M: f64 = 2000.0;

/// Time in which what an eye has seen fades away where the file does not say it, in seconds: the middle of the 60 to 90 ms of
/// Rousseau 2006, section 5.
pub const PERSISTENCE_S: f64 = 0.075;

/// Observer of moving drops.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Observer {
    /// A camera: all light that comes while its shutter is open weighs the same.
    #[default]
    Camera,
    /// An eye, which has no shutter: what it has seen fades away evenly, and is gone after the time of its persistence.
    Eye,
}

/// The camera, or the eye in its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Where it is; `None` takes the model's own camera.
    pub pose: Option<CameraPose>,
    /// Vertical field of view in radians; `None` takes the model's, else [`FOV_RAD`].
    pub fov: Option<f64>,
    /// The nearest depth that is drawn, in metres; `None` takes the model's, else [`NEAR_M`].
    pub near: Option<f64>,
    /// The farthest depth that is drawn, in metres; `None` takes the model's, else [`FAR_M`].
    pub far: Option<f64>,
    /// The picture is multiplied by two to this power.
    pub exposure_ev: f64,
    /// Observer of the moving drops.
    pub observer: Observer,
    /// Time in which light is gathered, in seconds: opening time of a camera's shutter, 0 to 1 (0 freezes the drops), or
    /// the persistence of an eye, 0.06 to 0.09.
    pub shutter: f64,
    /// Diameter of the lens's pupil, in metres; 0: all is in focus.
    pub aperture: f64,
    /// The distance in focus, in metres; `None` for the far.
    pub focus: Option<f64>,
}

/// Where the eye is and looks. Up is +Y; `forward` is never vertical.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraPose {
    /// The eye, in metres.
    pub position: DVec3,
    /// The unit direction into the middle of the picture.
    pub forward: DVec3,
}

impl Default for Camera {
    /// The model's own camera, 1/60 s.
    fn default() -> Self {
        Self {
            pose: None,
            fov: None,
            near: None,
            far: None,
            exposure_ev: 0.0,
            observer: Observer::Camera,
            shutter: 1.0 / 60.0,
            aperture: 0.0,
            focus: None,
        }
    }
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CameraTable {
    position_m: Option<Exactly<In<PlaceM>, 3>>,
    look_at_m: Option<Exactly<In<PlaceM>, 3>>,
    yaw_deg: Option<In<TurnDeg>>,
    pitch_deg: Option<In<PitchDeg>>,
    fov_deg: Option<In<FovDeg>>,
    near_m: Option<In<DepthM>>,
    far_m: Option<In<DepthM>>,
    exposure_ev: Option<In<Stops>>,
    observer: Option<Observer>,
    shutter_s: Option<In<ShutterS>>,
    persistence_s: Option<In<PersistenceS>>,
    aperture_mm: Option<In<ApertureMm>>,
    focus_m: Option<In<FocusM>>,
}

impl Camera {
    pub(super) fn checked(table: &CameraTable, places: &Places<'_>) -> Result<Self, SceneError> {
        let default = Self::default();
        let (near, far) = (table.near_m.map(|near| near.0), table.far_m.map(|far| far.0));
        let (nearest, farthest) = (near.unwrap_or(NEAR_M), far.unwrap_or(FAR_M));
        if nearest >= farthest && (near.is_some() || far.is_some()) {
            let key = if near.is_some() { "camera.near_m" } else { "camera.far_m" };
            let found = format!("{nearest} m to {farthest} m");
            return Err(places.bad(key, found, "near_m below far_m"));
        }
        let observer = table.observer.unwrap_or_default();
        Ok(Self {
            pose: table.pose(places)?,
            fov: table.fov_deg.map(|fov| fov.0.to_radians()),
            near,
            far,
            exposure_ev: table.exposure_ev.map_or(default.exposure_ev, |ev| ev.0),
            observer,
            shutter: table.shutter(observer, places)?,
            aperture: table.aperture_mm.map_or(default.aperture, |pupil| pupil.0 * 1.0e-3),
            focus: table.focus_m.map(|focus| focus.0),
        })
    }
}

impl CameraTable {
    /// The time in which light is gathered, s. Refuses the key of the other observer.
    fn shutter(&self, observer: Observer, places: &Places<'_>) -> Result<f64, SceneError> {
        match (observer, self.shutter_s, self.persistence_s) {
            (Observer::Camera, _, Some(_)) => Err(places.bad(
                "camera.persistence_s",
                "with a camera, which has a shutter",
                "shutter_s, or persistence_s with observer = \"eye\"",
            )),
            (Observer::Eye, Some(_), _) => Err(places.bad(
                "camera.shutter_s",
                "with observer = \"eye\", which has no shutter",
                "persistence_s, or shutter_s without observer = \"eye\"",
            )),
            (Observer::Camera, shutter, None) => Ok(shutter.map_or(Camera::default().shutter, |time| time.0)),
            (Observer::Eye, None, persistence) => Ok(persistence.map_or(PERSISTENCE_S, |time| time.0)),
        }
    }

    fn pose(&self, places: &Places<'_>) -> Result<Option<CameraPose>, SceneError> {
        let given = [
            ("look_at_m", self.look_at_m.is_some()),
            ("yaw_deg", self.yaw_deg.is_some()),
            ("pitch_deg", self.pitch_deg.is_some()),
        ];
        let mut turned = given.into_iter().filter_map(|(key, given)| given.then_some(key));
        let Some(position) = self.position_m else {
            return match turned.next() {
                None => Ok(None),
                Some(key) => Err(places.bad(
                    &format!("camera.{key}"),
                    "without position_m",
                    "position_m is needed with it",
                )),
            };
        };
        let position = DVec3::from_array(position.numbers());
        let forward = if let Some(target) = self.look_at_m {
            if let Some(key) = turned.find(|key| *key != "look_at_m") {
                let allowed = "look_at_m, or yaw_deg and pitch_deg";
                return Err(places.bad(&format!("camera.{key}"), "beside look_at_m", allowed));
            }
            #[expect(clippy::arithmetic_side_effects, reason = "of floats: both are within 1e7")]
            let way = DVec3::from_array(target.numbers()) - position;
            // Nearer than this to the vertical, left and right are noise.
            let aside = ops::hypot(way.x, way.z);
            if aside <= 1e-4 * way.y.abs() || way.length() < 1e-6 {
                let found = "is where the eye is, or straight above or below it";
                return Err(places.bad("camera.look_at_m", found, "a place aside, or yaw_deg and pitch_deg"));
            }
            way.normalize()
        } else {
            let yaw = self.yaw_deg.map_or(0.0, |yaw| yaw.0).to_radians();
            let pitch = self.pitch_deg.map_or(0.0, |pitch| pitch.0).to_radians();
            let flat = ops::cos(pitch);
            DVec3::new(-flat * ops::sin(yaw), ops::sin(pitch), -flat * ops::cos(yaw))
        };
        Ok(Some(CameraPose { position, forward }))
    }
}
