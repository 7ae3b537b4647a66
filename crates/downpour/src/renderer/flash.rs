//! Lightning in a frame: a picture of its own for each part of the exposure in which flashes shine.
//!
//! Light adds up, also over time: what the shutter sees is the picture without flashes, and that of the flashes alone with the
//! shutter open for as long as they shine. The exposure of pictures is that without flashes.

use downpour_render::picture::PictureOptions;
use downpour_render::rain::{Exposure, TemporalResponse};
use downpour_sim::field::{EyeDrop, FallingDrop, VisibleDrops};
use downpour_trace::frame_scene::FrameScene;
use downpour_trace::kept::PlateUse;
use downpour_weather::{FlashExposure, Observer};

use super::computer::Painted;
use super::drops::Drops;
use super::{Progress, Renderer, RendererError};

/// A picture in the light of flashes alone, of a part of an exposure.
pub(super) struct FlashPicture {
    pub(super) frame_scene: FrameScene,
    pub(super) drops: Drops,
    pub(super) options: PictureOptions,
}

impl Renderer {
    /// True if a flash of lightning shines while the shutter of a frame is open: such a frame is drawn several times, each in the light of
    /// its part of the exposure.
    #[must_use]
    pub fn is_in_flash(&self, time_s: f64) -> bool {
        !self.flash_parts(time_s).is_empty()
    }

    /// Parts of the exposure of a time in which flashes shine.
    fn flash_parts(&self, time_s: f64) -> Vec<FlashExposure> {
        let half_s = 0.5 * self.weather.camera.shutter;
        let fades = self.weather.camera.observer == Observer::Eye;
        self.weather.at(time_s).lightning.exposure(time_s - half_s, time_s + half_s, fades)
    }

    /// The frame of a time in the light of its flashes alone, in parts; none without lightning. `drops` are those of the frame.
    pub(super) fn flashes(
        &mut self,
        time_s: f64,
        drops: &Drops,
        told: &mut dyn FnMut(Progress),
    ) -> Result<Vec<Painted>, RendererError> {
        let draw = |flash: FlashPicture| {
            self.draw(&flash.frame_scene, &flash.drops, &flash.options, PlateUse::default(), false)
        };
        self.flash_pictures(time_s, drops, told)?.into_iter().map(draw).collect()
    }

    /// The pictures of a time in the light of its flashes alone, of parts of its exposure. `drops` are those of the frame.
    pub(super) fn flash_pictures(
        &self,
        time_s: f64,
        drops: &Drops,
        told: &mut dyn FnMut(Progress),
    ) -> Result<Vec<FlashPicture>, RendererError> {
        let parts = self.flash_parts(time_s);
        if parts.is_empty() {
            return Ok(Vec::new());
        }
        told(Progress { what: "lightning", parts: [0; 2] });
        let frame_scene = self.frame_scene(time_s)?;
        parts.iter().map(|part| self.flash(&frame_scene, time_s, drops, part)).collect()
    }

    /// The picture of a part of the exposure in which flashes shine.
    fn flash(
        &self,
        frame_scene: &FrameScene,
        time_s: f64,
        drops: &Drops,
        part: &FlashExposure,
    ) -> Result<FlashPicture, RendererError> {
        let mut frame_scene = frame_scene.in_flash(&self.weather, time_s, &part.lights);
        if let Some(water) = &self.water {
            water.lay(&mut frame_scene)?;
        }
        let [begin_s, end_s] = part.lit_s;
        // Streaks that are longer than they should be are so in all of their parts.
        let length = self.weather.look_at(time_s).streak_length;
        let later_s = length * (0.5 * (begin_s + end_s) - time_s);
        frame_scene.shutter_s = length * (end_s - begin_s);
        let drops = match drops {
            Drops::Listed(drops) => Drops::Listed(later(drops, &frame_scene, later_s)),
            Drops::OfDevice(shown) => {
                // The picture has the eye of the frame, and drops relative to it.
                let mut moved = frame_scene.clone();
                moved.viewpoint.eye += moved.motion.velocity * later_s as f32;
                Drops::OfDevice(Box::new(self.shower.later(shown, &moved, time_s + later_s)?))
            }
        };
        let medium = self.shower.medium(&frame_scene, drops.resolved(), &self.masks, time_s + later_s)?;
        let mut options = self.picture_options(&frame_scene, time_s, medium)?;
        options.rain.exposure = Exposure {
            shutter_s: end_s - begin_s,
            time_s: time_s + later_s,
            response: TemporalResponse::Shutter,
            ..options.rain.exposure
        };
        Ok(FlashPicture { frame_scene, drops, options })
    }
}

/// Drops so many seconds later, as the eye of a frame sees them that moves with them meanwhile.
fn later(drops: &VisibleDrops, frame_scene: &FrameScene, later_s: f64) -> VisibleDrops {
    let eye = frame_scene.origin + frame_scene.viewpoint.eye.as_dvec3();
    let motion = frame_scene.motion;
    let moved = |drop: &FallingDrop| {
        let before = EyeDrop::new(drop, eye);
        let offset = before.eye_drop_position(motion.velocity, motion.turning, later_s as f32);
        let after = EyeDrop {
            offset: offset.into(),
            present: before.present.map(|time| time - later_s as f32),
            ..before
        };
        after.to_falling(eye, drop.kind)
    };
    VisibleDrops { drops: drops.drops.iter().map(moved).collect(), ..drops.clone() }
}
