//! A weather with its files as a picture needs it: buffers, eye, and the part of space that it sees.
//!
//! Radiance, lamps and sun share one unit, that of the sky's radiance: where the weather gives the sky in cd/m^2, a lamp of
//! `I` candela lights a surface at a distance `r` with `I / r^2` lux and a sun is given in lux.
//!
//! Far from the world's origin single precision is coarse (1 m at 10 000 km), so that buffers there are relative to a
//! whole-number position near the eye, [`FrameScene::origin`].

mod error;
mod eye;
mod flash;
mod framing;
mod kept;
mod light;
mod sky;
#[cfg(test)]
mod tests;

use downpour_math::color::color_luminance;
use downpour_math::in_range;
use std::borrow::Cow;
use std::sync::Arc;

use downpour_scene::scene::Pose;
use downpour_sim::field::FallingDrop;
use downpour_sim::view::View;
use downpour_weather::{self as weather, Loaded, Reloaded, Weather, WetReflections};
use glam::DVec3;

use crate::assemble::SceneLooks;
use crate::data::SceneData;
use crate::glazing;
use crate::impostor;
use crate::sky_light::SkyLight;
use crate::wet::{KnownFall, SceneWetness};
use downpour_render::RenderError;
use downpour_render::camera::{EyeMotion, MAX_EXPOSURE_S, PictureEdge, Viewpoint, check_size};
use downpour_render::tone::{GRAY, tone_automatic_exposure};
pub use error::FrameSceneError;
pub use eye::CameraChoice;
use eye::CameraView;
use kept::KeptScene;

/// Maximum number of triangles of a scene, all copies counted.
pub const MAX_TRIANGLES: u64 = 1 << 22;

/// Maximum number of lamps of a scene: each surface samples all of them.
pub const MAX_LIGHTS: usize = 1024;

/// Memory per triangle, in bytes, while its hierarchy is built: the corners twice, and the builder's own lists.
const BYTES_PER_TRIANGLE: u64 = 540;

/// Farther than this from the world's origin, in meters, buffers are relative to a position near the eye.
const NEAR_ORIGIN_M: f64 = 1000.0;

/// Maximum absolute time of a picture, in seconds.
pub const LATEST_S: f64 = downpour_sim::field::MAX_TIME_S;

/// The eye's motion is taken over this time at least, s.
const MIN_INTERVAL_S: f64 = 1.0e-3;

/// Pixels darker than this part of the mean have no say in the exposure.
const UNLIT: f32 = 1.0e-4;

/// A pixel counts as no brighter than this multiple of the geometric mean, where the mean is taken.
const BRIGHTEST: f32 = 1.0e4;

/// A scene at one time: its buffers, light and camera.
#[derive(Clone, Debug)]
pub struct FrameScene {
    /// The scene's buffers, relative to `origin`.
    pub data: SceneData,
    /// The eye, relative to `origin`.
    pub viewpoint: Viewpoint,
    /// Origin of the buffers: 0 unless the eye is more than 1 km from it.
    pub origin: DVec3,
    /// Motion of the eye.
    pub motion: EyeMotion,
    /// Time for which drops move, s.
    pub shutter_s: f64,
    /// Columns and rows of the picture.
    pub size: [u32; 2],
    /// Exposure compensation in stops: the picture is multiplied by 2 to this power.
    pub exposure_ev: f32,
    /// Distances from the eye, in meters, between which drops are drawn.
    pub depth: [f64; 2],
    /// Choice of the camera.
    pub camera: CameraChoice,
    /// Triangles, all copies counted.
    pub triangles: usize,
    /// Mesh instances.
    pub instances: usize,
    /// Lamps, without the sun.
    pub lamps: usize,
    /// True if the last of the lights is the sun.
    pub has_sun: bool,
    /// Number of meshes left out because their transform has no inverse or is out of range.
    pub left_out: usize,
    /// What of a scene that moves is the same at all times.
    kept: Option<KeptScene>,
    /// Of the rain that wets it.
    fall: Arc<KnownFall>,
}

/// Sets light and water on surfaces to a time in seconds, and their reflections, which also depend on the eye.
///
/// # Errors
/// [`RenderError`] for an invalid eye.
fn set_time(
    data: &mut SceneData,
    weather: &Weather,
    loaded: &Loaded,
    (origin, viewpoint): (DVec3, &Viewpoint),
    time_s: f64,
    fall: &KnownFall,
) -> Result<(), RenderError> {
    light::relight(data, weather, loaded, origin, time_s);
    data.set_wetness(SceneWetness::of_falling(weather, time_s, origin, fall).as_ref());
    data.set_glazing(&glazing::rows(weather, &loaded.scene, time_s, origin));
    let before = data.impostors.take();
    if let (WetReflections::Tatarchuk2006 { edge }, true) =
        (weather.wetness.reflections, data.wetness > 0 || !weather.puddles.is_empty())
    {
        data.impostors = Some(impostor::list::find(data, viewpoint, edge as f32, before.as_ref())?);
    }
    Ok(())
}

impl FrameScene {
    /// Builds the scene of a weather's frame at a time in seconds: animated models, sky, sun, lamps, camera.
    ///
    /// # Errors
    /// [`FrameSceneError::OverLimit`] above [`MAX_TRIANGLES`] or [`MAX_LIGHTS`], [`FrameSceneError::Memory`], or
    /// [`RenderError`]: a picture outside [`PIXELS`](downpour_render::camera::PIXELS), a time beyond [`LATEST_S`], or an invalid camera.
    pub fn new(weather: &Weather, loaded: &Loaded, time_s: f64) -> Result<Self, FrameSceneError> {
        Self::with_kept(weather, loaded, time_s, None, Arc::default())
    }

    /// The same scene, which moves, at another time in seconds: materials, textures and what stands still are those of this one.
    ///
    /// # Errors
    /// As [`FrameScene::new`].
    pub fn moved(&self, weather: &Weather, loaded: &Loaded, time_s: f64) -> Result<Self, FrameSceneError> {
        Self::with_kept(weather, loaded, time_s, self.kept.as_ref(), Arc::clone(&self.fall))
    }

    fn with_kept(
        weather: &Weather,
        loaded: &Loaded,
        time_s: f64,
        kept: Option<&KeptScene>,
        fall: Arc<KnownFall>,
    ) -> Result<Self, FrameSceneError> {
        check_size(weather.size)?;
        in_range("time", time_s, "s", &(-LATEST_S..=LATEST_S), 1.0, "-1e6 to 1e6")
            .map_err(RenderError::from)?;
        let pose = loaded.pose(weather, time_s);
        check_cost(loaded, &pose)?;
        let seen = CameraView::of(weather, loaded, &pose, time_s);
        let anchor = seen.as_ref().map_or_else(|| middle(loaded, &pose), |seen| seen.eye);
        let origin = origin_near(anchor);
        let kept = loaded.is_animated().then(|| KeptScene::of(kept, loaded, &pose, origin));
        let mut builder = if let Some(kept) = &kept {
            kept.builder(loaded, &pose)
        } else {
            let mut looks = SceneLooks::new(&loaded.scene);
            let mut builder = looks.take_builder();
            builder.add_meshes(&looks, &loaded.scene, &pose, origin, |_| true);
            builder
        };
        builder.add_lamps(&loaded.scene, &pose, origin);
        if let Some(sun) = loaded.sun {
            builder.add_light(light::sun_light(&sun));
        }
        let triangles = builder.triangle_count();
        let mut data = builder.build(&sky::light(&loaded.sky));
        if let Some(sun) = loaded.sun {
            data.set_light_radius(data.light_count - 1, sun.angular_radius);
        }
        let fov =
            weather.camera.fov.unwrap_or_else(|| seen.as_ref().map_or(weather::FOV_RAD, |seen| seen.fov));
        let (camera, mut viewpoint) = match &seen {
            Some(seen) => (seen.choice.clone(), seen.viewpoint(fov, origin)),
            None if triangles > 0 => {
                (CameraChoice::Framing, framing::of_bounds(data.bounds(), weather.size, fov))
            }
            None => (CameraChoice::Standing, framing::standing(fov)),
        };
        set_fov(&mut viewpoint, weather, time_s);
        // An invalid camera is reported here, before the work begins.
        viewpoint.axes()?;
        set_time(&mut data, weather, loaded, (origin, &viewpoint), time_s, &fall)?;
        Ok(Self {
            data,
            viewpoint,
            origin,
            motion: motion(weather, loaded, time_s),
            shutter_s: weather.drop_exposure_s(time_s),
            size: weather.size,
            exposure_ev: weather.camera.exposure_ev as f32,
            depth: depth(weather, seen.as_ref()),
            camera,
            triangles,
            instances: pose.instances.len(),
            lamps: pose.lights.len(),
            has_sun: loaded.sun.is_some(),
            left_out: pose.left_out,
            kept,
            fall,
        })
    }

    /// The same scene, which stands still, seen by the weather's eye of another time in seconds: its buffers are shared.
    ///
    /// # Errors
    /// [`FrameSceneError::TooFar`] over 1 km from what the buffers are relative to; as [`Viewpoint::axes`].
    pub fn seen_at(&self, weather: &Weather, loaded: &Loaded, time_s: f64) -> Result<Self, FrameSceneError> {
        let Some(seen) = CameraView::of(weather, loaded, &loaded.pose(weather, time_s), time_s) else {
            let mut frame_scene = Self { shutter_s: weather.drop_exposure_s(time_s), ..self.clone() };
            set_fov(&mut frame_scene.viewpoint, weather, time_s);
            let eye = (self.origin, &frame_scene.viewpoint);
            set_time(&mut frame_scene.data, weather, loaded, eye, time_s, &self.fall)?;
            return Ok(frame_scene);
        };
        let distance_m = (seen.eye - self.origin).abs().max_element();
        if distance_m > NEAR_ORIGIN_M {
            return Err(FrameSceneError::TooFar { distance_m });
        }
        let mut viewpoint = seen.viewpoint(weather.camera.fov.unwrap_or(seen.fov), self.origin);
        set_fov(&mut viewpoint, weather, time_s);
        viewpoint.axes()?;
        let mut frame_scene = Self {
            viewpoint,
            motion: motion(weather, loaded, time_s),
            shutter_s: weather.drop_exposure_s(time_s),
            ..self.clone()
        };
        set_time(&mut frame_scene.data, weather, loaded, (self.origin, &viewpoint), time_s, &self.fall)?;
        Ok(frame_scene)
    }

    /// The same scene, which stands still, at a time in seconds in another weather over the same models: `before` is the weather of this
    /// scene and `loaded` has the files of the new one. A new lamp has no glass in the model, and one that is moved keeps its own, until
    /// the scene is built anew.
    ///
    /// # Errors
    /// As [`FrameScene::seen_at`]; [`RenderError::Size`].
    pub fn in_weather(
        &self,
        before: &Weather,
        weather: &Weather,
        loaded: &Loaded,
        reloaded: Reloaded,
        time_s: f64,
    ) -> Result<Self, FrameSceneError> {
        check_size(weather.size)?;
        let mut frame_scene = Self {
            size: weather.size,
            shutter_s: weather.drop_exposure_s(time_s),
            exposure_ev: weather.camera.exposure_ev as f32,
            ..self.clone()
        };
        let is_lit_alike = before.lights == weather.lights && before.keys == weather.keys;
        if reloaded.sky || !is_lit_alike {
            // A sun may have come or gone.
            let others = before.lights.len() as u32 + u32::from(self.has_sun);
            light::set_light(&mut frame_scene.data, weather, loaded, reloaded.sky, others, self.origin);
            frame_scene.has_sun = loaded.sun.is_some();
            frame_scene.lamps = (self.lamps + weather.lights.len()).saturating_sub(before.lights.len());
        }
        let seen = CameraView::of(weather, loaded, &loaded.pose(weather, time_s), time_s);
        if seen.is_some() || weather.camera.near.is_some() || weather.camera.far.is_some() {
            frame_scene.depth = depth(weather, seen.as_ref());
        }
        if let Some(seen) = &seen {
            frame_scene.camera = seen.choice.clone();
        }
        if let Some(fov) = weather.camera.fov {
            frame_scene.viewpoint.fov_y = fov as f32;
        }
        frame_scene.seen_at(weather, loaded, time_s)
    }

    /// What of the scene stands still, relative to `origin`, without light; all of it if nothing may move.
    pub(crate) fn standing(&self) -> Cow<'_, SceneData> {
        let without = |kept: &KeptScene| kept.standing().build(&SkyLight::new(1, 1, &[[0.0; 3]]));
        self.kept.as_ref().map_or(Cow::Borrowed(&self.data), |kept| Cow::Owned(without(kept)))
    }

    /// The part of space that the picture shows, in the world, for [`RainField`](downpour_sim::field::RainField).
    ///
    /// # Errors
    /// As [`Viewpoint::axes`].
    pub fn view(&self) -> Result<View, RenderError> {
        view_of(&self.viewpoint, self.origin, self.size, self.depth, self.shutter_s, &self.motion)
    }

    /// The part of space that a picture at a time in seconds would show: [`FrameScene::view`] of [`FrameScene::new`], without the scene
    /// where the eye does not depend on it.
    ///
    /// # Errors
    /// As [`FrameScene::new`].
    pub fn view_at(weather: &Weather, loaded: &Loaded, time_s: f64) -> Result<View, FrameSceneError> {
        let Some(seen) = CameraView::of(weather, loaded, &loaded.pose(weather, time_s), time_s) else {
            return Ok(Self::new(weather, loaded, time_s)?.view()?);
        };
        let origin = origin_near(seen.eye);
        let mut viewpoint = seen.viewpoint(weather.camera.fov.unwrap_or(seen.fov), origin);
        set_fov(&mut viewpoint, weather, time_s);
        let depth = depth(weather, Some(&seen));
        let motion = motion(weather, loaded, time_s);
        Ok(view_of(&viewpoint, origin, weather.size, depth, weather.drop_exposure_s(time_s), &motion)?)
    }

    /// [`FrameScene::view_at`] for a scene that stands still, whose camera may be that of its model: only the field of view changes then.
    ///
    /// # Errors
    /// As [`FrameScene::view_at`].
    pub fn seen_view_at(
        &self,
        weather: &Weather,
        loaded: &Loaded,
        time_s: f64,
    ) -> Result<View, FrameSceneError> {
        if weather.camera.path.is_some() {
            return Self::view_at(weather, loaded, time_s);
        }
        let mut viewpoint = self.viewpoint;
        set_fov(&mut viewpoint, weather, time_s);
        Ok(view_of(
            &viewpoint,
            self.origin,
            self.size,
            self.depth,
            weather.drop_exposure_s(time_s),
            &self.motion,
        )?)
    }

    /// Returns drops with their positions relative to `origin`.
    #[must_use]
    pub fn place<'a>(&self, drops: &'a [FallingDrop]) -> Cow<'a, [FallingDrop]> {
        if self.origin == DVec3::ZERO {
            return Cow::Borrowed(drops);
        }
        drops.iter().map(|drop| FallingDrop { position: drop.position - self.origin, ..*drop }).collect()
    }

    /// Returns the exposure factor for display: automatic exposure of the scene without rain, where there is light
    /// on it, times two to the power of `exposure_ev`.
    ///
    /// Pixels without light are left out: nothing comes from below the horizon of an overcast sky. So is the rain: drops
    /// before darkness are many, and not what a picture is exposed for.
    #[must_use]
    pub fn exposure(&self, clean: &[[f32; 4]]) -> f32 {
        let luminance = |&[r, g, b, _]: &[f32; 4]| color_luminance([r, g, b]);
        // The disk of the sun, a million times brighter than all else, is not to make that dark.
        let most = GRAY / tone_automatic_exposure(clean) * BRIGHTEST;
        let (sum, count) = clean
            .iter()
            .map(|pixel| luminance(pixel).min(most))
            .filter(|y| y.is_finite() && *y > 0.0)
            .fold((0.0f64, 0u32), |(sum, count), y| (sum + f64::from(y), count + 1));
        let least = (sum / f64::from(count.max(1))) as f32 * UNLIT;
        let lit: Vec<[f32; 4]> = clean.iter().filter(|pixel| luminance(pixel) > least).copied().collect();
        tone_automatic_exposure(&lit) * downpour_math::ops::exp2(self.exposure_ev)
    }

    /// Memory of the buffers, in bytes.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        let data = &self.data;
        [
            size_of_val(&data.nodes[..]),
            size_of_val(&data.triangles[..]),
            size_of_val(&data.corners[..]),
            data.row_count() * size_of::<[u32; 4]>(),
            size_of_val(&data.texels[..]),
            size_of_val(&data.sky[..]),
        ]
        .into_iter()
        .map(|bytes| bytes as u64)
        .sum()
    }
}

/// Sets the field of view to that of a time in seconds, if it changes.
fn set_fov(viewpoint: &mut Viewpoint, weather: &Weather, time_s: f64) {
    if weather.keys.has_fov()
        && let Some(fov) = weather.at(time_s).camera.fov
    {
        viewpoint.fov_y = fov as f32;
    }
}

/// Origin of the buffers for an eye at a position.
fn origin_near(eye: DVec3) -> DVec3 {
    if eye.abs().max_element() > NEAR_ORIGIN_M { eye.round() } else { DVec3::ZERO }
}

/// Distances from the eye between which drops are drawn, m.
fn depth(weather: &Weather, seen: Option<&CameraView>) -> [f64; 2] {
    let near = weather.camera.near.or_else(|| seen?.near).unwrap_or(weather::NEAR_M);
    let far = weather.camera.far.or_else(|| seen?.far).unwrap_or(weather::FAR_M);
    [near, far]
}

/// The part of space that a picture of `size` pixels shows, in the world, for
/// [`RainField`](downpour_sim::field::RainField): drops between the distances `depth` from the eye, m.
///
/// # Errors
/// As [`Viewpoint::axes`].
pub fn view_of(
    viewpoint: &Viewpoint,
    origin: DVec3,
    size: [u32; 2],
    depth: [f64; 2],
    shutter_s: f64,
    motion: &EyeMotion,
) -> Result<View, RenderError> {
    let PictureEdge { right, up, forward, half_width, half_height } = PictureEdge::new(viewpoint, size)?;
    let usual = View::default();
    // The drops that a picture can resolve end before the scene does.
    let near = depth[0].min(1000.0);
    let far = usual.far.min(depth[1]).max(near);
    Ok(View {
        eye: origin + viewpoint.eye.as_dvec3(),
        right,
        up,
        forward,
        half_width,
        half_height,
        pixel_angle: 2.0 * half_height / f64::from(size[1]),
        near,
        far,
        shutter_s: shutter_s.clamp(0.0, MAX_EXPOSURE_S),
        velocity: motion.velocity.as_dvec3(),
        turning: motion.turning.as_dvec3(),
        ..usual
    })
}

/// Motion of the eye at a time: from its positions when the shutter opens and closes.
fn motion(weather: &Weather, loaded: &Loaded, time_s: f64) -> EyeMotion {
    let moves = match &weather.camera.path {
        Some(path) => !path.is_still(),
        None => loaded.is_animated(),
    };
    if !moves {
        return EyeMotion::default();
    }
    let apart_s = weather.camera.shutter.max(MIN_INTERVAL_S);
    let at = |half: f64| {
        let time_s = time_s + half * apart_s;
        CameraView::of(weather, loaded, &loaded.pose(weather, time_s), time_s)
    };
    match (at(-0.5), at(0.5)) {
        (Some(before), Some(after)) => CameraView::motion(&before, &after, apart_s),
        _ => EyeMotion::default(),
    }
}

/// Refuses what would take the machine away.
fn check_cost(loaded: &Loaded, pose: &Pose) -> Result<(), FrameSceneError> {
    let of = |mesh: usize| -> u64 {
        let parts = loaded.scene.meshes.get(mesh).map_or(&[][..], |mesh| &mesh.primitives);
        parts.iter().map(|part| part.indices.len() as u64 / 3).sum()
    };
    let triangles: u64 = pose.instances.iter().map(|instance| of(instance.mesh)).sum();
    if triangles > MAX_TRIANGLES {
        return Err(FrameSceneError::OverLimit {
            quantity: "triangles of the scene, all copies counted",
            found: triangles,
            max: MAX_TRIANGLES,
            advice: "fewer copies, or simpler models",
        });
    }
    if pose.lights.len() > MAX_LIGHTS {
        return Err(FrameSceneError::OverLimit {
            quantity: "lamps of the scene, all copies counted",
            found: pose.lights.len() as u64,
            max: MAX_LIGHTS as u64,
            advice: "fewer copies of models with lamps",
        });
    }
    let bytes = triangles * BYTES_PER_TRIANGLE + sky::bytes(&loaded.sky);
    let mut room: Vec<u8> = Vec::new();
    if usize::try_from(bytes).is_ok_and(|bytes| room.try_reserve_exact(bytes).is_ok()) {
        return Ok(());
    }
    Err(FrameSceneError::Memory { mebibytes: bytes >> 20 })
}

/// The middle of all that there is.
fn middle(loaded: &Loaded, pose: &Pose) -> DVec3 {
    let bounds = pose.bounds(&loaded.scene);
    if bounds.is_empty() { DVec3::ZERO } else { (bounds.min.as_dvec3() + bounds.max.as_dvec3()) * 0.5 }
}
